// Tyres that lie flat on the bottom.
#pragma once

#include <insonify/geometry/creases.hpp>
#include <insonify/geometry/objects/detail/solids.hpp>
#include <insonify/geometry/revolution.hpp>

#include <algorithm>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// A tyre without its wheel, its axis along z, lying on z = 0: a hollow ring that is open towards its axis.
///
/// The defaults are a car's 195/65 R15 (ISO 4000-1): 195 mm wide, on a rim of 15 inches, and as high as 65 % of its
/// width, so 381 + 2 * 0.65 * 195 = 634.5 mm across. A lorry's 315/80 R22.5 (ISO 4209-1) is 1.076 m, 0.315 m, 0.572 m.
struct tyre {
    float diameter = 0.634f;      ///< outside, metres
    float width = 0.195f;         ///< metres, 0.001 to 10 diameters
    float rim_diameter = 0.381f;  ///< of the hole, metres, 0.001 to 0.95 diameters
    float wall = 0.015f;          ///< thickness, metres, at most 0.45 of the width and of diameter - rim_diameter
    float fill = 0;     ///< level of sediment in the hole: 0: none; 0.001 to 1: from 0.05 to 0.95 of the inner height
    int segments = 64;  ///< around the axis, 6 to 8192; a quarter as many across the tread
};

inline namespace INSONIFY_FLAGS {

/// @throws invalid_input for a value outside its range
inline void validate(const tyre& t) {
    detail::require_size("tyre.diameter", t.diameter);
    detail::require_range("tyre.width", t.width, 1e-3f * t.diameter, 10 * t.diameter, "1/1000 to 10 diameters");
    detail::require_range("tyre.rim_diameter", t.rim_diameter, 1e-3f * t.diameter, 0.95f * t.diameter,
                          "0.001 to 0.95 diameters");
    detail::require(t.wall >= 1e-4f * (std::max)(t.diameter, t.width) && t.wall <= 0.45f * t.width &&
                        t.wall <= 0.45f * (t.diameter - t.rim_diameter),
                    "tyre.wall", t.wall,
                    "at least 1/10000 of the size, at most 0.45 of width and of diameter - rim_diameter");
    detail::require(t.fill == 0 || (t.fill >= 0.001f && t.fill <= 1), "tyre.fill", t.fill, "0, or 0.001 to 1");
    detail::require_segments("tyre.segments", t.segments, 6, 8192);
}

/// The tread's section is a superellipse of exponent 3.2, outside and inside.
/// @throws invalid_input as `validate` does
inline mesh to_mesh(const tyre& t) {
    validate(t);
    const double rim = 0.5 * static_cast<double>(t.rim_diameter), wall = static_cast<double>(t.wall);
    const double ring = 0.5 * static_cast<double>(t.diameter) - rim, half = 0.5 * static_cast<double>(t.width);
    const int steps = 2 * ((std::max)(t.segments / 8, 3));  // even: one point lies on the widest circle
    std::vector<profile_point> profile;
    const auto add_arc = [&](double radial, double axial, bool upwards) {
        for (int i = 0; i <= steps; ++i) {
            const double turns = (upwards ? 1 : -1) * (0.5 * i / steps - 0.25);
            auto [sine, cosine] = numeric::sin_cos_turns(turns);
            if (i == 0 || i == steps) cosine = 0;
            const double out = cosine > 0 ? numeric::pow(cosine, 2 / 3.2) : 0.0;
            const double up = numeric::pow(numeric::abs(sine), 2 / 3.2);
            profile.push_back({rim + radial * out, half + (sine < 0 ? -up : up) * axial, 1, 0});
        }
    };
    add_arc(ring, half, true);
    add_arc(ring - wall, half - wall, false);
    profile.push_back(profile.front());
    mesh body = revolve(profile, t.segments);

    if (t.fill > 0) {
        // The sediment ends in the cavity, at 0.3 of its depth, where the cavity is higher than the sediment ever is.
        const double inner = 0.9 * (half - wall), bottom = half - inner, reach = rim + 0.3 * (ring - wall);
        const double surface = bottom + 2 * inner * static_cast<double>(t.fill);
        const std::vector<profile_point> sediment = {
            {0, bottom, 0, -1}, {reach, bottom, 1, 0}, {reach, surface, 1, 0}, {0, surface, 0, 1}};
        detail::append(body, revolve(sediment, t.segments));
    }
    body.normals.clear();
    return with_creases(body);
}

/// Fewest segments with which the tread is nowhere farther than `deviation` from its circle.
/// @throws invalid_input as `segments_for(radius, chord_error)`, and for deviations that need more than 8192 segments
inline int segments_for(const tyre& t, float deviation) {
    return detail::ring_segments_for(0.5f * t.diameter, deviation);
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
