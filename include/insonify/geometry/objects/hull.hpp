// Ships, whole, broken in two or collapsed.
#pragma once

#include <insonify/geometry/creases.hpp>
#include <insonify/geometry/objects/compound.hpp>
#include <insonify/geometry/objects/detail/hull_fittings.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

enum class hull_part : std::size_t { plating, decks, house, rigging, machinery, debris, count };
using hull_parts = std::array<mesh, static_cast<std::size_t>(hull_part::count)>;

/// Hatch openings, distributed over the deck fore and aft of the deckhouse.
inline std::vector<deck_plate> hatches_of(const hull& h) {
    const stretch_of_hull house = h.house_length > 0 ? house_of(h) : stretch_of_hull{0.07, 0.07};
    const stretch_of_hull free[2] = {{0.1, house.from - 0.01}, {house.to + 0.02, 0.87}};
    const auto room = [](const stretch_of_hull& s) { return (std::max)(s.to - s.from, 0.0); };
    const double all = room(free[0]) + room(free[1]);
    const int aft = all > 0 ? static_cast<int>(numeric::floor_to_int(h.hatches * room(free[0]) / all + 0.5)) : 0;
    std::vector<deck_plate> out;
    for (int i = 0; i < h.hatches; ++i) {
        const stretch_of_hull& s = free[i < aft ? 0 : 1];
        const int place = i < aft ? i : i - aft, count = i < aft ? aft : h.hatches - aft;
        const double pitch = room(s) / count;
        if (pitch < 0.03) continue;
        out.push_back({s.from + pitch * (place + 0.14), s.from + pitch * (place + 0.86), -0.52, 0.52});
    }
    return out;
}

/// Deck beams of a collapsed ship, which outlast the planks above them.
inline void append_beams(mesh& into, const hull_lines& lines, const stretch_of_hull& part, random_sequence& random) {
    const double c = lines.collapse();
    const int beams = 28;
    for (int i = 1; c > 0 && i < beams; ++i) {
        const double u = 0.04 + 0.9 * (i + 0.31) / beams, drop = random.uniform();
        if (random.uniform() < c * c * 1.1 || !part.contains(u)) continue;
        const double low = lines.deck_height(u) * (1 - 0.25 * c * drop) - 2 * lines.plating(),
                     w = 0.85 * lines.deck_w(u);
        const glm::dvec3 port = lines.between(u, w, 0.98, low), starboard = lines.between(u, w, -0.98, low);
        const glm::dvec3 along(0.5 * lines.plating(), 0, 0), up(0, 0, lines.plating());
        append_block(into, {{port - along, port + along, port + along + up, port - along + up}},
                     {{starboard - along, starboard + along, starboard + along + up, starboard - along + up}});
    }
}

/// Decks with hatch openings and coamings. In a collapsed ship the plating is in pieces, some of which are missing.
inline void append_decks(mesh& into, const hull& h, const hull_lines& lines, const stretch_of_hull& part,
                         random_sequence& random) {
    const std::vector<deck_plate> hatches = hatches_of(h);
    const double c = lines.collapse();
    std::vector<deck_plate> plates;
    double reached = 0.004;
    for (const deck_plate& hatch : hatches) {
        plates.push_back({reached, hatch.from});
        plates.push_back({hatch.from - 0.001, hatch.to + 0.001, -1, hatch.starboard, true});
        plates.push_back({hatch.from - 0.001, hatch.to + 0.001, hatch.port, 1, true});
        reached = hatch.to;
    }
    plates.push_back({reached, 0.985});
    for (const deck_plate& whole : plates) {
        const int pieces = c > 0 ? (std::max)(static_cast<int>(24 * (whole.to - whole.from)), 1) : 1;
        for (int i = 0; i < pieces; ++i) {
            deck_plate plate = whole;
            const double pitch = (whole.to - whole.from) / pieces;
            plate.from = (std::max)(whole.from + pitch * (i + (c > 0 ? 0.02 : 0.0)), part.from);
            plate.to = (std::min)(whole.from + pitch * (i + 1 - (c > 0 ? 0.02 : 0.0)), part.to);
            if (random.uniform() < 1.15 * c || plate.to - plate.from < 0.002) continue;
            append_deck(into, lines, plate, h.segments);
        }
    }
    if (c < 0.6)
        for (const deck_plate& hatch : hatches)
            if (part.contains(hatch.from) && part.contains(hatch.to))
                append_coaming(into, lines, hatch, 0.18 * lines.depth());
}

/// Builds the stretch of a ship between two stations.
inline hull_parts build_hull(const hull& h, const stretch_of_hull& part) {
    const hull_lines lines(h);
    hull_parts out;
    const auto of = [&](hull_part p) -> mesh& { return out[static_cast<std::size_t>(p)]; };
    random_sequence random(h.seed, 0x77726563);

    append_plating(of(hull_part::plating), lines, part, h.segments);
    if (part.from <= 0)
        append_bulkhead(of(hull_part::plating), lines, (std::max)(0.004, 0.6 * lines.plating() / lines.length()),
                        0.985 * (std::min)(lines.standing(0, 1), lines.standing(0, -1)));
    for (const double u : {0.065, 0.31, 0.6, 0.93})
        if (part.contains(u))
            append_bulkhead(of(hull_part::plating), lines, u, lines.deck_w(u) * 0.97 * (1 - 0.55 * lines.collapse()));
    const int frames = 36;
    for (int i = 0; i < frames; ++i) {
        const double u = 0.03 + 0.93 * (i + 0.17) / frames;
        for (const double side : {-1.0, 1.0}) {
            // Frames outlast the plates between them.
            const double extra = 0.3 * lines.collapse() * random.uniform();
            if (part.contains(u))
                append_frame(of(hull_part::plating), lines, u, side,
                             (std::min)(lines.standing(u, side) + extra - 0.02, 0.97 * lines.deck_w(u)),
                             (std::max)(0.05 * lines.half_beam(), lines.plating()));
        }
    }
    append_decks(of(hull_part::decks), h, lines, part, random);
    append_beams(of(hull_part::decks), lines, part, random);
    append_house(of(hull_part::house), h, lines, part);
    const stretch_of_hull house = house_of(h);
    for (int i = 0; i < h.masts; ++i) {
        // From the bow aft, between the hatches, clear of the house.
        const double u =
            i == 0 ? 0.885 : house.to + (0.885 - house.to) * (1 - static_cast<double>(i) / h.masts) - 0.012 * (i + 1);
        if (part.contains(u)) append_mast(of(hull_part::rigging), h, lines, u, i % 2 == 0 ? 1 : -1);
    }
    if (lines.collapse() > 0.25 && h.has_funnel) append_machinery(of(hull_part::machinery), h, lines, part);
    append_debris(of(hull_part::debris), lines, part, static_cast<int>(60 * lines.collapse()), random);
    return out;
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// The parts of the ship in the order plating, decks, deckhouse, rigging, machinery, debris; empty parts are left out.
/// Reflectivities are illustrative: steel 1, decks covered by silt and planks less. Each part is solid, and so is the
/// merged mesh.
///
/// An intact ship spans exactly `length` and `beam`, with the lower side of the keel at z = 0. The stern half of a
/// broken ship stays in place; the bow half is moved, yawed and rolled.
/// @throws invalid_input as `validate` does
inline compound to_compound(const hull& h) {
    validate(h);
    detail::hull_parts all;
    if (h.break_gap > 0) {
        const double at = 0.5 + static_cast<double>(h.break_position);
        all = detail::build_hull(h, {0, at});
        // The bow half turns about the break, and rises by what its roll would sink into the bottom.
        const double x = (at - 0.5) * static_cast<double>(h.length);
        const auto rolled = [&](float roll) {
            return compose(
                to_world({.position = {x + static_cast<double>(h.break_gap), 0, 0}, .yaw = h.break_yaw, .roll = roll}),
                {glm::dmat3(1), {-x, 0, 0}});
        };
        const detail::hull_parts bow = detail::build_hull(h, {at, 1});
        // What collapsed lies flatter, and what fell off it lies on the bottom.
        const affine turn = rolled(h.break_roll * (1 - h.collapse)), level = rolled(0);
        double lowest = 0;
        for (const glm::vec3& p : bow[static_cast<std::size_t>(detail::hull_part::plating)].positions)
            lowest = (std::min)(lowest, transform_point(turn, glm::dvec3(p)).z);
        const affine raised{turn.linear, turn.offset - glm::dvec3(0, 0, lowest)};
        for (std::size_t i = 0; i < all.size(); ++i) {
            const auto part = static_cast<detail::hull_part>(i);
            const bool has_fallen = part == detail::hull_part::debris ||
                                    (part == detail::hull_part::rigging && h.collapse > detail::masts_fall);
            detail::append(all[i], bow[i], has_fallen ? level : raised);
        }
    } else {
        all = detail::build_hull(h, {0, 1});
    }
    compound out;
    constexpr float reflectivity[] = {1, 0.7f, 0.9f, 0.8f, 1, 0.8f};
    for (std::size_t i = 0; i < all.size(); ++i)
        if (!all[i].triangles.empty()) out.parts.push_back({with_creases(all[i]), {}, reflectivity[i]});
    return out;
}

/// The parts as one mesh.
/// @throws invalid_input as `validate` does
inline mesh to_mesh(const hull& h) {
    return to_mesh(to_compound(h));
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
