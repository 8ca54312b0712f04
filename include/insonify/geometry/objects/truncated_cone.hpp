// Truncated cones that lie on the bottom: ground mines of the Manta kind, sinkers, mooring blocks.
#pragma once

#include <insonify/geometry/creases.hpp>
#include <insonify/geometry/objects/detail/solids.hpp>
#include <insonify/geometry/revolution.hpp>

#include <algorithm>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// A truncated cone standing on z = 0 with a rounded shoulder, a boss on its top and lifting lugs on its side.
///
/// The defaults are the size published for the Manta ground mine, 0.98 m across and 0.47 m high (Jane's Underwater
/// Warfare Systems); shoulder, boss and lugs are estimates from photographs. Without those three it is a plain frustum
/// of volume pi / 12 (D^2 + D d + d^2) h.
struct truncated_cone {
    float diameter = 0.98f;      ///< of the base, metres
    float top_diameter = 0.52f;  ///< metres, diameter / 10000 to diameter
    float height = 0.47f;        ///< with the boss, metres, at least diameter / 10000
    /// Metres that the edge of the top is rounded by, at most a fifth of height and of top_diameter; 0: sharp.
    float shoulder = 0.05f;
    float boss_diameter = 0.22f;  ///< metres, at most 0.8 of the flat top, inside the shoulder; 0: none
    float boss_height = 0.04f;    ///< metres, at most a quarter of the height; 0: none
    int lugs = 2;                 ///< 0 to 8
    int segments = 64;            ///< around the axis, 6 to 8192; see `segments_for`
};

inline namespace INSONIFY_FLAGS {

/// @throws invalid_input for a value outside its range
inline void validate(const truncated_cone& c) {
    detail::require_size("truncated_cone.diameter", c.diameter);
    detail::require_size("truncated_cone.height", c.height);
    detail::require_thickness("truncated_cone.height", c.height, (std::max)(c.height, c.diameter));
    detail::require_thickness("truncated_cone.top_diameter", c.top_diameter, c.diameter);
    detail::require(c.shoulder >= 0 && c.shoulder <= 0.2f * (std::min)(c.height, c.top_diameter),
                    "truncated_cone.shoulder", c.shoulder, "0 to a fifth of height and top_diameter");
    detail::require(c.boss_diameter >= 0 && c.boss_diameter <= 0.8f * (c.top_diameter - 2 * c.shoulder),
                    "truncated_cone.boss_diameter", c.boss_diameter, "0 to 0.8 (top_diameter - 2 shoulder)");
    detail::require(c.boss_height >= 0 && c.boss_height <= 0.25f * c.height, "truncated_cone.boss_height",
                    c.boss_height, "0 to a quarter of the height");
    detail::require_range("truncated_cone.lugs", c.lugs, 0, 8, "0 to 8");
    detail::require_segments("truncated_cone.segments", c.segments, 6, 8192);
}

/// 16 segments triangles, 8 segments with a sharp shoulder, 4 segments fewer without a boss; and 44 for each lug.
/// @throws invalid_input as `validate` does
inline mesh to_mesh(const truncated_cone& c) {
    validate(c);
    const double base = 0.5 * static_cast<double>(c.diameter), top = 0.5 * static_cast<double>(c.top_diameter);
    const bool has_boss = c.boss_height > 0 && c.boss_diameter > 0;
    const double deck = static_cast<double>(c.height) - (has_boss ? static_cast<double>(c.boss_height) : 0.0);
    const double slant = numeric::square_root(deck * deck + (base - top) * (base - top));

    // Normals come from the creases; those of the two poles make one vertex of each.
    std::vector<profile_point> profile = {{0, 0, 0, -1}, {base, 0, 1, 0}};
    if (c.shoulder > 0) {
        // A quadratic curve from the side to the top, tangent to both.
        const double cut = static_cast<double>(c.shoulder);
        const double from_r = top + cut * (base - top) / slant, from_z = deck - cut * deck / slant;
        for (int i = 0; i <= 4; ++i) {
            const double t = i / 4.0, a = (1 - t) * (1 - t), b = 2 * t * (1 - t), d = t * t;
            profile.push_back({a * from_r + b * top + d * (top - cut), a * from_z + (b + d) * deck, 1, 0});
        }
    } else {
        profile.push_back({top, deck, 1, 0});
    }
    if (has_boss) {
        const double boss = 0.5 * static_cast<double>(c.boss_diameter);
        profile.push_back({boss, deck, 1, 0});
        profile.push_back({0.9 * boss, static_cast<double>(c.height), 1, 0});
    }
    profile.push_back({0, static_cast<double>(c.height), 0, 1});
    mesh body = revolve(profile, c.segments);

    // Lugs are half rings that stand out of the side above its middle.
    for (int i = 0; i < c.lugs; ++i) {
        const auto [sine, cosine] = numeric::sin_cos_turns((i + 0.25) / c.lugs);
        const double at = base + 0.6 * (top - base), size = 0.09 * static_cast<double>(c.height);
        const glm::dvec3 out(cosine, sine, 0), foot = at * out + glm::dvec3(0, 0, 0.6 * deck);
        const glm::dvec3 path[] = {
            foot - size * out + glm::dvec3(0, 0, size), foot + size * out + glm::dvec3(0, 0, size),
            foot + size * out - glm::dvec3(0, 0, size), foot - size * out - glm::dvec3(0, 0, size)};
        detail::append_bent_bar(body, path, 0.3 * size);
    }
    body.normals.clear();
    return with_creases(body);
}

/// Fewest segments with which the base is nowhere farther than `deviation` from its circle.
/// @throws invalid_input as `segments_for(radius, chord_error)`, and for deviations that need more than 8192 segments
inline int segments_for(const truncated_cone& c, float deviation) {
    return detail::ring_segments_for(0.5f * c.diameter, deviation);
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
