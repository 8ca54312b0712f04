// The sections of an aeroplane's wings, and the bodies it is built from.
//
// Based on: Eastman N. Jacobs, Kenneth E. Ward, Robert M. Pinkerton. The Characteristics of 78 Related Airfoil
// Sections. NACA Report 460, 1933 (thickness of the four-digit sections).
#pragma once

#include <insonify/geometry/objects/aeroplane_parameters.hpp>
#include <insonify/geometry/objects/detail/lattice_noise.hpp>
#include <insonify/geometry/objects/detail/solids.hpp>

#include <algorithm>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A wing, tailplane or fin: straight edges from root to tip, the tip rounded. `out` is a unit vector along its span,
/// `up` across its chord; the chord runs towards -x. Lengths are metres.
struct aerofoil_surface {
    glm::dvec3 leading_edge;  // at the root
    glm::dvec3 out, up;
    double span, root_chord, tip_chord, sweep_tangent, thickness;  // the last as a share of the chord
};

/// One wing's cross section, from the upper trailing edge round the nose to the lower one.
inline section aerofoil(const aerofoil_surface& wing, double t) {
    const double tip = (std::max)((t - 0.9) / 0.1, 0.0);
    const double rounded = numeric::square_root(1 - 0.9 * tip * tip);
    const double full = wing.root_chord + (wing.tip_chord - wing.root_chord) * t, chord = full * rounded;
    const glm::dvec3 nose = wing.leading_edge + t * wing.span * wing.out -
                            glm::dvec3(t * wing.span * wing.sweep_tangent + 0.4 * (full - chord), 0, 0);
    constexpr double stations[] = {1, 0.75, 0.5, 0.3, 0.15, 0.05, 0.0125};
    section out;
    const auto add = [&](double x, double side) {
        const double half = 5 * wing.thickness *
                            (0.2969 * numeric::square_root(x) - 0.126 * x - 0.3516 * x * x + 0.2843 * x * x * x -
                             0.0936 * x * x * x * x);  // a trailing edge of 1/10 of the thickness instead of 1/50
        out.push_back(nose + glm::dvec3(-x * chord, 0, 0) + side * half * chord * wing.up);
    };
    for (const double x : stations) add(x, 1);
    for (int i = 6; i >= 0; --i) add(stations[i], -1);
    return out;
}

/// Appends the part of a wing between two shares of its span; ends that are not the wing's own are torn.
inline void append_wing(mesh& into, const aerofoil_surface& wing, double from, double to, int segments,
                        const philox_key& key, const affine& map = {}) {
    const int steps = (std::max)(static_cast<int>(segments * (to - from)), 4);
    std::vector<section> sections;
    for (int k = 0; k <= steps; ++k) {
        // Half of the stations go to the rounded tip.
        double t = static_cast<double>(k) / steps;
        if (to >= 1) t = t < 0.5 ? 1.7 * t : 0.85 + 0.15 * (1 - 4 * (1 - t) * (1 - t));
        section ring = aerofoil(wing, from + (to - from) * t);
        const bool is_torn = (k == 0 && from > 0) || (k == steps && to < 1);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const double torn = 0.4 * (to - from) / steps * wing.span *
                                (1 + lattice_noise({0.8 * static_cast<double>(i), 3.5, k == 0 ? 1.5 : 0.5}, key));
            if (is_torn) ring[i] += (k == 0 ? torn : -torn) * wing.out;
            ring[i] = transform_point(map, ring[i]);
        }
        sections.push_back(std::move(ring));
    }
    append_loft(into, sections);
}

/// A section across the x axis: an ellipse, optionally torn.
struct body_section {
    double x, half_width, half_height, z;
    double torn = 0;  // metres along x
};
inline void append_body(mesh& into, std::span<const body_section> stations, double y, int corners,
                        const philox_key& key, const affine& map = {}) {
    std::vector<section> sections;
    for (const body_section& s : stations) {
        section ring = circle({s.x, y, s.z}, {0, s.half_width, 0}, {0, 0, s.half_height}, corners);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            if (s.torn != 0)
                ring[i].x +=
                    s.torn *
                    (0.5 +
                     0.5 * lattice_noise({9.0 * static_cast<double>(i) / corners, 7.5, s.torn > 0 ? 2.5 : 4.5}, key));
            ring[i] = transform_point(map, ring[i]);
        }
        sections.push_back(std::move(ring));
    }
    append_loft(into, sections);
}

/// A spinner with blades in front of a hub.
struct propeller {
    glm::dvec3 hub;
    double diameter, hub_radius, length, turn;  // the last as a share of the angle between blades
    double up, clearance;                       // +1 or -1: where up is; height of the hub above the bottom
};

/// Blades that would reach into the bottom are as short as a crash landing leaves them.
inline void append_propeller(mesh& into, const propeller& p, int corners) {
    std::vector<section> sections;
    for (const double t : {0.0, 0.35, 0.65, 0.85, 1.0}) {
        const double radius = p.hub_radius * numeric::square_root(1 - 0.97 * t * t);
        sections.push_back(circle(p.hub + glm::dvec3(t * p.length, 0, 0), {0, radius, 0}, {0, 0, radius}, corners));
    }
    append_loft(into, sections);
    constexpr int blades = 3;
    for (int i = 0; i < blades; ++i) {
        const auto [sine, cosine] = numeric::sin_cos_turns((i + p.turn) / blades);
        const glm::dvec3 out(0, cosine, sine), over(0, -sine, cosine);
        const double drop = -p.up * sine * 0.5 * p.diameter;
        const double room = 0.85 * (std::max)(p.clearance, 0.0);
        const double reach = 0.5 * p.diameter * (drop > room ? (std::max)(room / drop, 0.25) : 1.0);
        const double wide = 0.045 * p.diameter, thick = 0.012 * p.diameter;
        std::vector<section> blade;
        for (const double t : {0.05, 0.4, 0.75, 1.0}) {
            const double pitch = 0.9 - 0.6 * t;
            const glm::dvec3 at = p.hub + glm::dvec3(0.4 * p.length, 0, 0) + reach * t * out;
            const glm::dvec3 chord = wide * (t < 0.9 ? 1.0 : 0.45) * (over + glm::dvec3(pitch, 0, 0));
            const glm::dvec3 normal = thick * (glm::dvec3(1, 0, 0) - pitch * over);
            blade.push_back({at - chord - normal, at + chord - normal, at + chord + normal, at - chord + normal});
        }
        append_loft(into, blade);
    }
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
