// Pipes with open ends: lost pipeline joints, culvert pipes, spool pieces.
#pragma once

#include <insonify/geometry/creases.hpp>
#include <insonify/geometry/objects/detail/solids.hpp>
#include <insonify/geometry/revolution.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// A pipe along x, centred at the origin, open at both ends.
///
/// The defaults are a joint of line pipe NPS 24 (API Specification 5L, Line Pipe, and ASME B36.10M: 610 mm outside
/// diameter, double random length of about 12 m) with a concrete weight coating of 50 mm. A concrete culvert pipe has
/// a wall of about a tenth of its diameter and 2.5 m of length (EN 1916).
struct open_pipe {
    float diameter = 0.71f;  ///< outside, metres
    float length = 12;       ///< from end to end, metres
    float wall = 0.065f;     ///< thickness, metres, 1/10000 of the larger size to below 0.499 of the diameter
    /// Metres by which a flange at either end stands out, 1/10000 of the larger size to the diameter; 0: none.
    float flange = 0;
    float broken = 0;        ///< metres by which the +x end is ragged, at most half the length; 0: cut square
    int segments = 48;       ///< around the axis, 6 to 8192; see `segments_for`
    std::uint64_t seed = 1;  ///< of the ragged end
};

inline namespace INSONIFY_FLAGS {

/// @throws invalid_input for a value outside its range
inline void validate(const open_pipe& p) {
    detail::require_size("open_pipe.diameter", p.diameter);
    detail::require_size("open_pipe.length", p.length);
    const float larger = p.diameter > p.length ? p.diameter : p.length;
    detail::require(p.wall >= 1e-4f * larger && p.wall < 0.499f * p.diameter, "open_pipe.wall", p.wall,
                    "at least 1/10000 of the larger size, below 0.499 of the diameter");
    detail::require(p.flange == 0 || (p.flange >= 1e-4f * larger && p.flange <= p.diameter), "open_pipe.flange",
                    p.flange, "0, or from 1/10000 of the larger size to the diameter");
    detail::require_range("open_pipe.broken", p.broken, 0, 0.5f * p.length, "0 to half the length");
    detail::require_segments("open_pipe.segments", p.segments, 6, 8192);
}

/// 8 segments triangles without flanges. The outer surface is inscribed in its circle.
/// @throws invalid_input as `validate` does
inline mesh to_mesh(const open_pipe& p) {
    validate(p);
    const double radius = 0.5 * static_cast<double>(p.diameter), bore = radius - static_cast<double>(p.wall);
    const double half = 0.5 * static_cast<double>(p.length);
    random_sequence random(p.seed, 0x70697065);
    double ragged = 0;

    // Each section is the cut of the wall at one angle: a ring of them, closed on itself.
    struct corner {
        double radius, x;
    };
    std::vector<corner> outline = {{bore, -half}, {radius, -half}, {radius, half}, {bore, half}};
    if (p.flange > 0) {
        const double rim = radius + static_cast<double>(p.flange);
        const double thick = (std::min)(static_cast<double>(p.flange), 0.1 * static_cast<double>(p.length));
        outline = {{bore, -half},          {rim, -half},        {rim, -half + thick}, {radius, -half + thick},
                   {radius, half - thick}, {rim, half - thick}, {rim, half},          {bore, half}};
    }
    mesh body;
    const auto count = static_cast<std::uint32_t>(outline.size());
    const auto segments = static_cast<std::uint32_t>(p.segments);
    for (std::uint32_t i = 0; i < segments; ++i) {
        const auto [sine, cosine] = numeric::sin_cos_turns(static_cast<double>(i) / p.segments);
        // A broken edge tears in steps: a slow walk with a jump at every segment.
        ragged = 0.6 * ragged + 0.4 * random.uniform();
        const double torn = i == 0 ? 0.0 : static_cast<double>(p.broken) * ragged;
        for (const corner& c : outline) {
            const double x = c.x - (c.x > 0 ? torn : 0.0);
            body.positions.emplace_back(x, c.radius * cosine, c.radius * sine);
        }
        const std::uint32_t here = i * count, next = (i + 1) % segments * count;
        for (std::uint32_t k = 0; k < count; ++k) {
            const std::uint32_t l = (k + 1) % count;
            body.triangles.emplace_back(here + k, next + l, here + l);
            body.triangles.emplace_back(here + k, next + k, next + l);
        }
    }
    return with_creases(body);
}

/// Fewest segments with which the outside is nowhere farther than `deviation` from its circle.
/// @throws invalid_input as `segments_for(radius, chord_error)`, and for deviations that need more than 8192 segments
inline int segments_for(const open_pipe& p, float deviation) {
    return detail::ring_segments_for(0.5f * p.diameter + p.flange, deviation);
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
