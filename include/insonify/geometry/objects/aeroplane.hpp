// Aeroplanes: whole, with wings or tail torn off, or inverted.
#pragma once

#include <insonify/geometry/creases.hpp>
#include <insonify/geometry/objects/compound.hpp>
#include <insonify/geometry/objects/detail/aeroplane_form.hpp>

#include <algorithm>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

class aeroplane_builder {
  public:
    explicit aeroplane_builder(const aeroplane& a)
        : a_(a),
          length_(static_cast<double>(a.length)),
          radius_(0.5 * static_cast<double>(a.fuselage_diameter)),
          key_(stream_key(a.seed, 0x706C616E)) {
        spinner_ = a.engines % 2 == 1 && a.propeller_diameter > 0 ? 0.045 * length_ : 0.0;
        if (a.tail_gap > 0) {
            const double x = station_x(break_at);
            tail_ = compose(to_world({.position = {x - static_cast<double>(a.tail_gap), 0, 0}, .yaw = a.tail_yaw}),
                            {glm::dmat3(1), {-x, 0, 0}});
        }
        build_fuselage();
        build_wings();
        build_tail();
    }

    mesh fuselage, wings, propellers;

  private:
    static constexpr double break_at = 0.62;  // share of the fuselage from its nose, behind the wings

    double station_x(double s) const { return 0.5 * length_ - spinner_ - s * (length_ - spinner_); }
    body_section station(double s) const {
        double r = 1;
        if (s < 0.28) {
            const double t = (0.28 - s) / 0.28, blunt = a_.engines % 2 == 1 ? 0.55 : 0.96;
            r = numeric::square_root(1 - blunt * t * t);
        } else if (s > 0.45) {
            r = 1 - 0.87 * numeric::pow((s - 0.45) / 0.55, 1.3);
        }
        // The upper side runs straight, so the tail rises.
        return {station_x(s), 0.92 * radius_ * r, 1.08 * radius_ * r, 0.75 * radius_ * (1 - r) * (s > 0.45 ? 1 : 0.2)};
    }

    void build_fuselage() {
        std::vector<body_section> front, aft;
        const int steps = 2 * a_.segments;
        const bool is_broken = a_.tail_gap > 0;
        for (int k = 0; k <= steps; ++k) {
            // Denser at the nose.
            const double t = static_cast<double>(k) / steps, s = 0.25 * t + 0.75 * t * t;
            (is_broken && s > break_at ? aft : front).push_back(station(s));
        }
        if (is_broken) {
            front.push_back(station(break_at + 1e-4));
            front.back().torn = -0.02 * length_;
            aft.insert(aft.begin(), station(break_at + 2e-4));
            aft.front().torn = 0.02 * length_;
            append_body(fuselage, aft, 0, a_.segments, key_, tail_);
        }
        append_body(fuselage, front, 0, a_.segments, key_);

        // A canopy or cockpit, half sunk.
        std::vector<body_section> canopy;
        const double middle = a_.engines % 2 == 1 ? 0.4 : 0.2, long_half = 0.09;
        for (int k = 0; k <= 10; ++k) {
            const double t = k / 5.0 - 1, size = numeric::square_root(1 - 0.96 * t * t), s = middle + long_half * t;
            canopy.push_back({station_x(s), 0.42 * radius_ * size, 0.6 * radius_ * size,
                              0.85 * radius_ * station(s).half_height / (1.08 * radius_)});
        }
        append_body(fuselage, canopy, 0, (std::max)(a_.segments / 2, 8), key_);
        if (spinner_ > 0)
            add_propeller({station_x(0) - 0.02 * length_, 0, station(0).z}, 0.45 * radius_, spinner_ + 0.02 * length_,
                          0.3);
    }

    aerofoil_surface wing(double side) const {
        const auto [sine, cosine] = numeric::sin_cos(static_cast<double>(a_.dihedral));
        const double half = 0.5 * static_cast<double>(a_.span), inner = 0.15 * radius_;
        // Roots of both wings lie inside the fuselage, apart from each other.
        return {.leading_edge = {static_cast<double>(a_.wing_position) * length_, side * inner, -0.45 * radius_},
                .out = {0, side * cosine, sine},
                .up = {0, 0, 1},  // sections stay upright, so that the tips lie at the span
                .span = (half - inner) / cosine,
                .root_chord = static_cast<double>(a_.root_chord),
                .tip_chord = static_cast<double>(a_.tip_chord),
                .sweep_tangent = numeric::tan(static_cast<double>(a_.sweep)) * cosine,
                .thickness = 0.15};
    }

    void build_wings() {
        for (const double side : {1.0, -1.0}) {
            const aerofoil_surface w = wing(side);
            const double left = static_cast<double>(side > 0 ? a_.port_wing : a_.starboard_wing);
            const double stump = 0.3 * radius_ / w.span;
            if (left > stump) append_wing(wings, w, 0, left, 2 * a_.segments, key_);
            if (left < 1 && a_.torn_off > 0) {
                const double from = (std::min)((std::max)(left, 1.2 * radius_ / w.span), 0.97);
                // Lies flat, turned and away from its root.
                const glm::dvec3 root = w.leading_edge + from * w.span * w.out;
                const affine off =
                    to_world({.position = root + glm::dvec3(0.3, side, 0) * static_cast<double>(a_.torn_off),
                              .yaw = static_cast<float>(side) * 0.45f,
                              .roll = static_cast<float>(-side) * a_.dihedral});
                affine fallen = compose(off, {glm::dmat3(1), -root});
                fallen.offset.z += -0.98 * radius_ - transform_point(fallen, root).z + 0.06 * w.root_chord;
                append_wing(wings, w, from, 1, 2 * a_.segments, key_, fallen);
            }
            for (int i = 0; i < a_.engines / 2; ++i) {
                const double t = 0.3 + 0.25 * i;
                if (t < left) nacelle(w, t, i == 0 ? 0.15 : 0.6);
            }
        }
    }

    void nacelle(const aerofoil_surface& w, double t, double turn) {
        const section s = aerofoil(w, t);
        const glm::dvec3 nose = 0.5 * (s[6] + s[7]), trailing = 0.5 * (s.front() + s.back());
        const double chord = nose.x - trailing.x, radius = (std::min)(0.3 * chord, 0.62 * radius_),
                     ahead = 0.65 * chord;
        std::vector<body_section> body;
        for (int k = 0; k <= 14; ++k) {
            const double u = k / 14.0, x = nose.x + ahead - u * (ahead + 0.75 * chord);
            const double r =
                radius * (u < 0.15  ? 0.75 + 0.25 * numeric::square_root(1 - (1 - u / 0.15) * (1 - u / 0.15))
                          : u > 0.5 ? 1 - 0.85 * numeric::pow((u - 0.5) / 0.5, 1.6)
                                    : 1.0);
            body.push_back({x, r, r, nose.z});
        }
        append_body(wings, body, nose.y, (std::max)(a_.segments / 2, 8), key_);
        if (a_.propeller_diameter > 0)
            add_propeller({nose.x + ahead - 0.05 * chord, nose.y, nose.z}, 0.45 * radius, 0.25 * chord, turn);
    }

    void add_propeller(const glm::dvec3& hub, double hub_radius, double length, double turn) {
        const double up = a_.is_inverted ? -1 : 1;
        append_propeller(propellers,
                         {.hub = hub,
                          .diameter = static_cast<double>(a_.propeller_diameter),
                          .hub_radius = hub_radius,
                          .length = length,
                          .turn = turn,
                          .up = up,
                          .clearance = up * hub.z + radius_},
                         (std::max)(a_.segments / 3, 8));
    }

    void build_tail() {
        const body_section root = station(0.9);
        const double chord = 0.115 * length_, end = -0.5 * length_;
        for (const double side : {1.0, -1.0}) {
            const double inner = 0.1 * root.half_width;
            const aerofoil_surface plane{
                .leading_edge = {end + 0.015 * length_ + 1.05 * chord, side * inner, root.z + 0.3 * root.half_height},
                .out = {0, side, 0},
                .up = {0, 0, 1},
                .span = 0.5 * static_cast<double>(a_.tail_span) - inner,
                .root_chord = 1.05 * chord,
                .tip_chord = 0.6 * chord,
                .sweep_tangent = 0.2 * chord / static_cast<double>(a_.tail_span),
                .thickness = 0.1};
            append_wing(fuselage, plane, 0, 1, a_.segments, key_, tail_);
        }
        const double fin = static_cast<double>(a_.fin_height) * (a_.is_inverted ? 0.33 : 1.0);
        const double foot = 0.5 * root.half_height;
        const aerofoil_surface rudder{.leading_edge = {end + 1.35 * chord, 0, root.z + foot},
                                      .out = {0, 0, 1},
                                      .up = {0, 1, 0},
                                      .span = fin + root.half_height - foot,
                                      .root_chord = 1.3 * chord,
                                      .tip_chord = 0.75 * chord,
                                      .sweep_tangent = 0.45 * chord / (fin + root.half_height),
                                      .thickness = 0.1};
        append_wing(fuselage, rudder, 0, 1, a_.segments, key_, tail_);
    }

    const aeroplane& a_;
    double length_, radius_, spinner_ = 0;
    affine tail_;
    philox_key key_;
};

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// The parts: fuselage with tail, wings with engine nacelles, propellers. Reflectivities are illustrative: aluminium
/// sheet 0.9, steel 1. Each part is solid, and so is the merged mesh.
///
/// A whole aeroplane spans exactly `span` unless its propellers or tail reach beyond the wing, and is exactly `length`
/// long unless wings or wing engines reach ahead of its nose or behind its tail.
/// @throws invalid_input as `validate` does
inline compound to_compound(const aeroplane& a) {
    validate(a);
    detail::aeroplane_builder built(a);
    affine map;
    if (a.is_inverted) map.linear = glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, -1));
    double lowest = 1e9;
    for (const mesh* m : {&built.fuselage, &built.wings, &built.propellers})
        for (const glm::vec3& p : m->positions) lowest = (std::min)(lowest, transform_point(map, glm::dvec3(p)).z);
    map.offset.z = -lowest;
    compound out;
    const auto add = [&](const mesh& m, float reflectivity) {
        if (!m.triangles.empty()) out.parts.push_back({with_creases(transformed(m, map)), {}, reflectivity});
    };
    add(built.fuselage, 0.9f);
    add(built.wings, 0.9f);
    add(built.propellers, 1);
    return out;
}

/// The parts as one mesh.
/// @throws invalid_input as `validate` does
inline mesh to_mesh(const aeroplane& a) {
    return to_mesh(to_compound(a));
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
