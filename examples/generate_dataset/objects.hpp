// Objects of the recipe `sonar`: meshes from a kind, a length, the damage and a seed for all other dimensions.
#pragma once

#include <insonify/geometry/objects/aeroplane.hpp>
#include <insonify/geometry/objects/boulder.hpp>
#include <insonify/geometry/objects/compound.hpp>
#include <insonify/geometry/objects/crate.hpp>
#include <insonify/geometry/objects/hull.hpp>
#include <insonify/geometry/objects/lobster_pot.hpp>
#include <insonify/geometry/objects/open_pipe.hpp>
#include <insonify/geometry/objects/truncated_cone.hpp>
#include <insonify/geometry/objects/tyre.hpp>
#include <insonify/geometry/objects/wedge.hpp>
#include <insonify/insonify.hpp>

#include <string>

#include "object_kinds.hpp"

namespace generator {

namespace in = insonify;

/// Parameters of one object; damage is 0 for an intact one, 1 for the worst.
struct object_form {
    std::string kind;
    double length = 10, damage = 0;
    std::uint32_t seed = 1;
};

namespace detail {

inline float between(in::random_sequence& draw, double low, double high) {
    return static_cast<float>(draw.uniform(low, high));
}

/// Barges, pontoons and lighters: an open box of plates with bulkheads and side decks. Damage removes plates.
inline in::mesh barge_of(const object_form& f, in::random_sequence& draw) {
    const auto length = static_cast<float>(f.length);
    const float beam = length / between(draw, 2.2, 5), depth = beam * between(draw, 0.15, 0.4);
    const float plate = beam / 16, deck = beam * between(draw, 0.08, 0.2);
    const double loss = 0.7 * (std::max)(f.damage - 0.4, 0.0);
    in::compound parts;
    const auto box = [&](const glm::vec3& size, const glm::vec3& at) {
        if (draw.uniform() >= loss) parts.add(in::cube{.size = size}, {.position = glm::dvec3(at)});
    };
    constexpr int plates = 8;
    const float pitch = length / plates;
    for (int i = 0; i < plates; ++i)
        for (const float side : {-0.5f, 0.5f}) {
            const float x = (static_cast<float>(i) + 0.5f) * pitch - 0.5f * length;
            box({pitch, plate, depth}, {x, side * (beam - plate), 0.5f * depth});
            box({pitch, deck, plate}, {x, side * (beam - deck - 2.2f * plate), depth - 0.6f * plate});
        }
    const int holds = 1 + static_cast<int>(draw.below(6));
    for (int i = 0; i <= holds; ++i) {
        const float x = (length - plate) * (static_cast<float>(i) / static_cast<float>(holds) - 0.5f);
        box({plate, beam - 2.1f * plate, 0.95f * depth}, {x, 0, 0.475f * depth});
    }
    const glm::vec3 bottom(0.99f * length, 0.97f * beam, 0.1f * depth);
    parts.add(in::cube{.size = bottom}, {.position = glm::dvec3(0, 0, bottom.z / 2)});
    if (draw.uniform() < 0.3)
        box({0.14f * length, 0.6f * beam, 0.6f * beam}, {between(draw, -0.4, 0.4) * length, 0, depth + 0.3f * beam});
    return in::merge(parts).shape;
}

/// Boats, trawlers, coasters and steamers: proportions as geometry/objects/detail/hull_form.hpp cites them.
inline in::mesh ship_of(const object_form& f, in::random_sequence& draw) {
    if (draw.uniform() < 0.2) return barge_of(f, draw);
    const auto length = static_cast<float>(f.length);
    in::hull h{.length = length};
    h.beam = length / between(draw, length > 60 ? 4.0 : 2.2, length > 60 ? 7.0 : 4.5);
    h.depth = h.beam / between(draw, 1.6, 2.8);
    h.bulwark = (std::min)(between(draw, 0.3, 1.2), 0.3f * h.depth);
    h.sheer = between(draw, 0, 2);
    h.stern = draw.uniform() < 0.5 ? in::stern_type::cruiser : in::stern_type::transom;
    h.plating = (std::max)((std::min)(between(draw, 0.006, 0.02) * h.beam, h.beam / 17), length / 1900);
    const double style = draw.uniform();
    if (style < 0.25) {  // open boat or lighter
        h.house_length = 0, h.has_funnel = false, h.masts = 0, h.hatches = static_cast<int>(draw.below(7));
        h.mast_height = 0.1f * length;
    } else {
        h.house_length = between(draw, 0.1, 0.35);
        h.house_position = between(draw, -0.33, 0.28);
        h.house_tiers = 1 + static_cast<int>(draw.below(length > 40 ? 4 : 2));
        h.has_funnel = draw.uniform() < 0.6;
        h.hatches = static_cast<int>(draw.below(6));
        h.masts = static_cast<int>(draw.below(4));
        h.mast_height = length * between(draw, 0.08, 0.3);
    }
    if (f.damage > 0.35 && f.damage <= 0.6) {
        h.break_gap = length * between(draw, 0.01, 0.15);
        h.break_position = between(draw, -0.35, 0.35);
        h.break_yaw = between(draw, -0.7, 0.7);
        h.break_roll = between(draw, -0.6, 0.6);
    }
    if (f.damage > 0.4) h.collapse = static_cast<float>((std::min)(2 * (f.damage - 0.4), 1.0));
    h.segments = 48;
    h.seed = f.seed;
    return in::to_mesh(h);
}

/// Fighters, bombers with two and four engines, and jets.
inline in::mesh plane_of(const object_form& f, in::random_sequence& draw) {
    const auto length = static_cast<float>(f.length);
    in::aeroplane a{.length = length};
    a.span = length * between(draw, 1.15, 1.6);
    a.fuselage_diameter = length * between(draw, 0.085, 0.15);
    a.root_chord = length * between(draw, 0.16, 0.3);
    a.tip_chord = a.root_chord * between(draw, 0.25, 0.75);
    a.sweep = draw.uniform() < 0.8 ? between(draw, -0.02, 0.2) : between(draw, 0.3, 0.7);
    if (draw.uniform() < 0.12) {  // delta wing
        a.span = length * between(draw, 0.7, 1.1);
        a.root_chord = length * between(draw, 0.4, 0.5);
        a.tip_chord = length * between(draw, 0.03, 0.1);
        a.sweep = between(draw, 0.65, 0.8);
    }
    a.dihedral = between(draw, 0, 0.12);
    a.wing_position = between(draw, 0.05, 0.3);
    a.tail_span = (std::max)(a.span * between(draw, 0.28, 0.42), 1.3f * a.fuselage_diameter);
    a.fin_height = length * between(draw, 0.07, 0.16);
    a.engines = length < 12 ? 1 + static_cast<int>(draw.below(2)) : static_cast<int>(2 * (1 + draw.below(2)));
    a.propeller_diameter = draw.uniform() < 0.8 ? length * between(draw, 0.13, 0.25) : 0.0f;
    a.is_inverted = draw.uniform() < 0.35;
    if (f.damage > 0.55) {
        a.port_wing = draw.uniform() < 0.5 ? 1.0f : between(draw, 0.1, 0.9);
        a.starboard_wing = draw.uniform() < 0.5 ? 1.0f : between(draw, 0.1, 0.9);
        a.torn_off = draw.uniform() < 0.5 ? 0.0f : (std::min)(between(draw, 0.3, 3), 2 * length);
        if (f.damage > 0.8) a.tail_gap = between(draw, 0.1, 0.15 * f.length), a.tail_yaw = between(draw, -1, 1);
    }
    a.segments = 20;
    a.seed = f.seed;
    return in::to_mesh(a);
}

}  // namespace detail

/// @throws insonify::io_error for an unknown kind
inline in::mesh mesh_of(const object_form& f) {
    using detail::between;
    in::random_sequence draw(f.seed, 0x6F626A00);
    const auto l = static_cast<float>(f.length);
    if (f.kind == "ship") return detail::ship_of(f, draw);
    if (f.kind == "plane") return detail::plane_of(f, draw);
    if (f.kind == "truncated_cone")
        return to_mesh(in::truncated_cone{.diameter = l,
                                          .top_diameter = 0.53f * l,
                                          .height = 0.48f * l,
                                          .shoulder = 0.04f * l,
                                          .boss_diameter = 0.2f * l,
                                          .boss_height = 0.04f * l});
    if (f.kind == "wedge")
        return to_mesh(in::wedge{.length = l,
                                 .width = 0.78f * l,
                                 .height = 0.38f * l,
                                 .nose_height = 0.06f * l,
                                 .nose_width = 0.45f * l,
                                 .tail_height = 0.2f * l,
                                 .ridge = 0.2f * l});
    if (f.kind == "tyre")
        return to_mesh(in::tyre{.diameter = l,
                                .width = l * between(draw, 0.28, 0.38),
                                .rim_diameter = 0.58f * l,
                                .wall = 0.025f * l,
                                .fill = draw.uniform() < 0.5 ? 0.0f : between(draw, 0.1, 0.9)});
    if (f.kind == "pipe") {
        const float diameter = (std::min)(between(draw, 0.3, 1.2), l / 4);
        return to_mesh(in::open_pipe{.diameter = diameter,
                                     .length = l,
                                     .wall = 0.09f * diameter,
                                     .broken = f.damage > 0.5 ? 0.1f * l : 0.0f,
                                     .seed = f.seed});
    }
    if (f.kind == "boulder")
        return to_mesh(in::boulder{.size = {l, l * between(draw, 0.6, 1), l * between(draw, 0.4, 0.9)},
                                   .angularity = between(draw, 0.2, 0.9),
                                   .segments = 8,
                                   .seed = f.seed});
    if (f.kind == "crate")
        return to_mesh(in::crate{.size = {l, l * between(draw, 0.4, 0.9), l * between(draw, 0.35, 0.8)},
                                 .board = 0.018f * l,
                                 .is_open = draw.uniform() < 0.4,
                                 .damage = static_cast<float>(f.damage),
                                 .seed = f.seed});
    if (f.kind == "lobster_pot")
        return to_mesh(in::lobster_pot{.length = l,
                                       .width = 0.62f * l,
                                       .height = 0.45f * l,
                                       .bar = 0.018f * l,
                                       .mesh_size = 0,
                                       .twine = 0.006f * l,
                                       .crushed = static_cast<float>(0.8 * f.damage)});
    if (f.kind == "cylinder") return to_mesh(in::cylinder{.radius = 0.5f * l / between(draw, 2.2, 4), .length = l});
    if (f.kind == "cube") return to_mesh(in::cube{.size = {l, l * between(draw, 0.8, 1.25), l}});
    if (f.kind == "cone") return to_mesh(in::cone{.radius = 0.5f * l, .height = l * between(draw, 0.7, 1.2)});
    if (f.kind == "sphere") return to_mesh(in::sphere{.radius = 0.5f * l});
    throw in::io_error("'" + f.kind + "' is not a kind of object");
}

}  // namespace generator
