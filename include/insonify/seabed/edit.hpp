// Edits of a seabed: hills, furrows, ramps, deposits; moat.hpp adds scour moats. sculpt.hpp applies them.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/linear.hpp>
#include <insonify/geometry/bounds.hpp>
#include <insonify/seabed/area.hpp>
#include <insonify/seabed/moat.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// Adds a round hill with soft edges, or with a negative height a hollow.
struct raise {
    glm::dvec2 centre{0.0, 0.0};
    float radius = 1;     ///< metres, > 0
    float height = 0.1f;  ///< metres, in the middle
};

/// Levels the ground.
struct flatten {
    glm::dvec2 centre{0.0, 0.0};
    float radius = 1;  ///< metres, > 0: of the plain, whose outer quarter is its edge
    float level = 0;   ///< metres above the datum
};

/// Smooths the ground by a cubic B-spline: of waves of one length nothing is left, of two lengths 17 %, of four 66 %.
/// Beside gaps the ground stays as it is. Each row takes 16 rows of the ground below it: n edits on top of each other
/// take 16^n times as long.
struct smooth {
    glm::dvec2 centre{0.0, 0.0};
    float radius = 1;      ///< metres, > 0 and at most 2^17 lengths: with its edge
    float length = 0.25f;  ///< metres, from 0.001; rounded to eight bits, so that its multiples are exact
};

/// A straight slope between two points, like a slipway.
struct ramp {
    glm::dvec2 from{0.0, 0.0}, to{1.0, 0.0};
    float width = 1;                          ///< metres, > 0: with its edges, an eighth of it each
    float from_height = 0, to_height = 0.5f;  ///< metres above the datum
};

/// A furrow or ridge along a path, or a row of marks.
struct stamp {
    std::vector<glm::dvec2> path;  ///< at least one point
    float radius = 0.3f;           ///< metres, > 0: half the width of a furrow, with its edges
    float height = -0.1f;          ///< metres, in the middle; negative to dig
    float every = 0;               ///< metres along the path from mark to mark, from 0.001; 0: a continuous furrow
};

/// Sediment heaped up to a level, to half bury a target. Higher ground stays. The slopes end 100 m below the
/// level, radius + 100 / slope from the centre along x and y: over deeper ground the heap ends in a cliff.
struct heap {
    glm::dvec2 centre{0.0, 0.0};
    float radius = 0.5f;  ///< metres, >= 0: of its level top
    float level = 0.2f;   ///< metres above the datum
    float slope = 0.6f;   ///< from 0.001: of its sides; sand lies at 0.6, mud flatter
};

/// One change of a seabed.
using edit = std::variant<raise, flatten, smooth, ramp, stamp, heap, moat>;

namespace detail::inline INSONIFY_FLAGS {

/// 1 up to three quarters of the way, then down to 0.
constexpr float plateau(float r) {
    return fade(saturate(4 - 4 * r));
}

inline float length(double x, double y) {
    return static_cast<float>(numeric::square_root(x * x + y * y));
}

using insonify::detail::ground_rect;

inline ground_rect rect_around(std::span<const glm::dvec2> points, double reach) {
    ground_rect all;
    for (const glm::dvec2& p : points) all.include(p, reach);
    return all;
}

inline void require_height(const char* name, float value) {
    require(value > -1e6f && value < 1e6f, name, value, "metres between -10^6 and 10^6");
}

/// Bounding rectangle of the ground that an edit changes.
/// @throws invalid_input for a parameter out of its range
inline ground_rect ground_of(const raise& e) {
    require_position("raise.centre", e.centre);
    require_positive_metres("raise.radius", e.radius);
    require_height("raise.height", e.height);
    return rect_around({&e.centre, 1}, static_cast<double>(e.radius));
}
inline ground_rect ground_of(const flatten& e) {
    require_position("flatten.centre", e.centre);
    require_positive_metres("flatten.radius", e.radius);
    require_height("flatten.level", e.level);
    return rect_around({&e.centre, 1}, static_cast<double>(e.radius));
}
inline ground_rect ground_of(const smooth& e) {
    require_position("smooth.centre", e.centre);
    require_positive_metres("smooth.radius", e.radius);
    require(e.length >= 1e-3f && e.length < 1e6f, "smooth.length", e.length, "metres, at least 0.001 and below 10^6");
    // A row of the smoothed area takes two arrays of a float for each quarter of a length.
    require(e.radius <= 0x1p17f * e.length, "smooth.radius", e.radius, "at most 2^17 times smooth.length");
    return rect_around({&e.centre, 1}, static_cast<double>(e.radius));
}
inline ground_rect ground_of(const ramp& e) {
    require_position("ramp.from", e.from);
    require_position("ramp.to", e.to);
    require_positive_metres("ramp.width", e.width);
    require_height("ramp.from_height", e.from_height);
    require_height("ramp.to_height", e.to_height);
    const float run = length(e.to.x - e.from.x, e.to.y - e.from.y);
    require(run >= 1e-3f, "distance of ramp.to from ramp.from", run, "metres from 0.001");
    return rect_around(std::array{e.from, e.to}, static_cast<double>(e.width));
}
inline ground_rect ground_of(const stamp& e) {
    require(!e.path.empty(), "stamp.path.size()", e.path.size(), "at least 1");
    for (const glm::dvec2& p : e.path) require_position("stamp.path", p);
    require_positive_metres("stamp.radius", e.radius);
    require_height("stamp.height", e.height);
    require(e.every == 0 || (e.every >= 1e-3f && e.every < 1e6f), "stamp.every", e.every,
            "0, or metres, at least 0.001 and below 10^6");
    return rect_around(e.path, static_cast<double>(e.radius));
}
inline ground_rect ground_of(const heap& e) {
    require_position("heap.centre", e.centre);
    require_metres("heap.radius", e.radius);
    require_height("heap.level", e.level);
    require(e.slope >= 1e-3f && e.slope < 1e6f, "heap.slope", e.slope, "a slope, at least 0.001 and below 10^6");
    // Bounds cover ground down to a hundred metres below the top.
    return rect_around({&e.centre, 1}, static_cast<double>(e.radius) + 100 / static_cast<double>(e.slope));
}

inline ground_rect ground_of(const moat& e) {
    validate(e);
    return rect_around(e.outline, moat_reach(e));
}

/// The height at a position after an edit.
inline float height_after(const raise& e, const glm::dvec2& p, float height) {
    return height + e.height * biweight(length(p.x - e.centre.x, p.y - e.centre.y) / e.radius);
}
inline float height_after(const flatten& e, const glm::dvec2& p, float height) {
    return lerp(height, e.level, plateau(length(p.x - e.centre.x, p.y - e.centre.y) / e.radius));
}
inline float height_after(const ramp& e, const glm::dvec2& p, float height) {
    const glm::dvec2 way = e.to - e.from, offset = p - e.from;
    const double span = numeric::length(way), t = numeric::dot(way, offset) / numeric::dot(way, way);
    const double side = numeric::cross(way, offset) / span;
    // Beyond its ends the ramp is level and fades within a quarter of its width.
    const double past = (t < 0 ? -t : t > 1 ? t - 1 : 0.0) * span;
    const float weight = plateau(static_cast<float>(2 * numeric::abs(side)) / e.width) *
                         fade(saturate(1 - 4 * static_cast<float>(past) / e.width));
    return lerp(height, lerp(e.from_height, e.to_height, saturate(static_cast<float>(t))), weight);
}
inline float height_after(const stamp& e, const glm::dvec2& p, float height) {
    if (e.every <= 0) return height + e.height * biweight(static_cast<float>(distance_to_path(p, e.path)) / e.radius);
    // On each segment of the path, the mark nearest to the point, by arc length.
    const double every = static_cast<double>(e.every);
    double before = 0, nearest = square_distance(p, e.path[0], e.path[0]);
    for (std::size_t i = 1; i < e.path.size(); ++i) {
        const glm::dvec2 &a = e.path[i - 1], way = e.path[i] - a, offset = p - a;
        const double span = numeric::length(way);
        if (span == 0) continue;
        const double along = before + numeric::dot(way, offset) / span;
        const double last = static_cast<double>(numeric::floor_to_int((before + span) / every)) * every;
        const double first = -static_cast<double>(numeric::floor_to_int(-before / every)) * every;
        const double mark = static_cast<double>(numeric::floor_to_int(along / every + 0.5)) * every;
        const double place = ((std::min)((std::max)(mark, first), last) - before) / span;
        const glm::dvec2 at = a + way * place;
        if (first <= last) nearest = (std::min)(nearest, square_distance(p, at, at));
        before += span;
    }
    return height + e.height * biweight(static_cast<float>(numeric::square_root(nearest)) / e.radius);
}
inline float height_after(const moat& e, const glm::dvec2& p, float height) {
    return height + static_cast<float>(moat_change(e, p));
}
inline float height_after(const heap& e, const glm::dvec2& p, float height) {
    const float beyond = length(p.x - e.centre.x, p.y - e.centre.y) - e.radius;
    return (std::max)(height, e.level - e.slope * (std::max)(beyond, 0.0f));
}

/// The range of heights after an edit, for heights in a given range before it.
inline height_range added(const height_range& ground, double lowest, double highest) {
    return with_rounding(
        {ground.lowest + (std::min)(1.00001 * lowest, 0.0), ground.highest + (std::max)(1.00001 * highest, 0.0)});
}
inline height_range including(const height_range& ground, double to) {
    return merge(ground, {to, to});
}
inline height_range range_after(const raise& e, const height_range& ground) {
    return added(ground, static_cast<double>(e.height), static_cast<double>(e.height));
}
inline height_range range_after(const flatten& e, const height_range& ground) {
    return with_rounding(including(ground, static_cast<double>(e.level)));
}
/// Means stay within the range.
inline height_range range_after(const smooth&, const height_range& ground) {
    return with_rounding(ground);
}
inline height_range range_after(const ramp& e, const height_range& ground) {
    return with_rounding(
        including(including(ground, static_cast<double>(e.from_height)), static_cast<double>(e.to_height)));
}
inline height_range range_after(const stamp& e, const height_range& ground) {
    return added(ground, static_cast<double>(e.height), static_cast<double>(e.height));
}
inline height_range range_after(const moat& e, const height_range& ground) {
    return added(ground, -static_cast<double>(e.depth), static_cast<double>(e.mound));
}
inline height_range range_after(const heap& e, const height_range& ground) {
    return {ground.lowest, (std::max)(ground.highest, static_cast<double>(e.level))};
}

/// Weights of the 16 nodes around a coordinate, four to a length, in the smoothed value: a cubic B-spline, which
/// preserves slopes.
inline std::array<float, 16> spline_weights(float fraction) {
    std::array<float, 16> weights;
    for (std::size_t n = 0; n < 16; ++n) {
        const float t = numeric::abs(0.25f * (fraction + 7 - static_cast<float>(n)));
        const float s = 2 - t;
        weights[n] = 0.25f * (t < 1 ? 2.0f / 3 - 0.5f * t * t * s : s > 0 ? s * s * s / 6 : 0.0f);
    }
    return weights;
}

/// Smooths a row of the ground.
/// @param ground  fills the heights of rows
template <class Ground>
void smooth_row(const smooth& e, const scanline& line, std::span<float> heights, Ground&& ground) {
    const double step = numeric::rounded_to_eight_bits(static_cast<double>(e.length)) / 4;
    const lattice_coordinate v(line.y / step);
    const std::int64_t first = numeric::floor_to_int(line.x(0) / step) - 7;
    const std::int64_t last = numeric::floor_to_int(line.x(heights.size() - 1) / step) + 8;
    dynamic_array<float> nodes(static_cast<std::size_t>(last - first + 1)), column(nodes.size(), 0.0f);
    const auto up = spline_weights(v.fraction);
    for (std::size_t j = 0; j < 16; ++j) {
        const double y = step * static_cast<double>(v.cell - 7 + static_cast<std::int64_t>(j));
        ground(scanline{.y = y,
                        .origin = step * static_cast<double>(first),
                        .spacing = step,
                        // Relief shorter than two nodes, which the spline removes anyway, would alias.
                        .grid_spacing = (std::max)(line.grid_spacing, step)},
               std::span(nodes));
        for (std::size_t n = 0; n < nodes.size(); ++n) column[n] += up[j] * nodes[n];
    }
    for (std::size_t i = 0; i < heights.size(); ++i) {
        const double x = line.x(i);
        const lattice_coordinate u(x / step);
        const float* const from = &column[static_cast<std::size_t>(u.cell - 7 - first)];
        const auto across = spline_weights(u.fraction);
        float even = 0;
        for (std::size_t n = 0; n < 16; ++n) even += across[n] * from[n];
        if (numeric::is_finite(even))
            heights[i] = lerp(heights[i], even, plateau(length(x - e.centre.x, line.y - e.centre.y) / e.radius));
    }
}

}  // namespace detail::inline INSONIFY_FLAGS

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
