// Triangulates polygons: convex ones as a fan, others by ear clipping.
//
// Based on: Joseph O'Rourke. Computational Geometry in C, 2nd edition, 1998, section 1.6 (clipping an ear changes
// whether the two adjacent corners are ears, and no other: quadratic in all).
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/error.hpp>
#include <insonify/core/linear.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

/// Corners up to which concave polygons are cut. Two facing arcs of 2048 corners each, the slowest polygon found, take
/// 0.4 s; twice as many corners take four times as long.
inline constexpr std::size_t ear_clipping_limit = 4096;

/// A polygon projected along the axis closest to its normal, so that it is counter-clockwise.
class flat_polygon {
  public:
    explicit flat_polygon(std::span<const glm::vec3> corners) : corners_(corners) {
        // Newell's area vector, relative to the first corner: precise far from the origin.
        glm::dvec3 area(0);
        const glm::dvec3 origin(corners[0]);
        for (std::size_t i = 2; i < corners.size(); ++i)
            area += numeric::cross(glm::dvec3(corners[i - 1]) - origin, glm::dvec3(corners[i]) - origin);
        const int away = numeric::dominant_axis(area);
        u_ = (away + (area[away] < 0 ? 2 : 1)) % 3;
        v_ = (away + (area[away] < 0 ? 1 : 2)) % 3;
    }

    /// Twice the area of the triangle, positive for a left turn at b.
    double orient2d(std::size_t a, std::size_t b, std::size_t c) const {
        const glm::dvec2 p = at(a), q = at(b), r = at(c);
        return (q.x - p.x) * (r.y - q.y) - (q.y - p.y) * (r.x - q.x);
    }
    /// Whether a point lies inside or on the border of a triangle, and not at one of its corners.
    bool covered(std::size_t point, std::size_t a, std::size_t b, std::size_t c) const {
        const glm::dvec2 p = at(point);
        return orient2d(a, b, point) >= 0 && orient2d(b, c, point) >= 0 && orient2d(c, a, point) >= 0 && p != at(a) &&
               p != at(b) && p != at(c);
    }

  private:
    glm::dvec2 at(std::size_t i) const { return {corners_[i][u_], corners_[i][v_]}; }

    std::span<const glm::vec3> corners_;
    int u_, v_;
};

/// Appends the triangles of a concave polygon by ear clipping.
inline void clip_ears(const flat_polygon& polygon, std::uint32_t count, std::vector<glm::uvec3>& triangles) {
    struct corner {
        std::uint32_t previous, next;
        bool reflex, ear;
    };
    dynamic_array<corner> ring(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        ring[i] = {(i + count - 1) % count, (i + 1) % count, false, false};
        ring[i].reflex = polygon.orient2d(ring[i].previous, i, ring[i].next) < 0;
    }

    // The diagonal of an ear lies inside the polygon, which is so if no reflex corner lies in the ear.
    const auto is_ear = [&](std::uint32_t i) {
        const auto [previous, next, reflex, ear] = ring[i];
        if (reflex) return false;
        for (std::uint32_t r = ring[next].next; r != previous; r = ring[r].next)
            if (ring[r].reflex && polygon.covered(r, previous, i, next)) return false;
        return true;
    };
    for (std::uint32_t i = 0; i < count; ++i) ring[i].ear = is_ear(i);

    std::uint32_t tip = 0;
    for (std::uint32_t left = count; left > 3; --left) {
        // A simple polygon always has an ear. A self-intersecting one may not: then any corner is cut off.
        for (std::uint32_t walked = 0; !ring[tip].ear && walked < left; ++walked) tip = ring[tip].next;
        const std::uint32_t a = ring[tip].previous, b = ring[tip].next;
        triangles.emplace_back(a, tip, b);
        ring[a].next = b;
        ring[b].previous = a;
        for (const std::uint32_t i : {a, b}) ring[i].reflex = polygon.orient2d(ring[i].previous, i, ring[i].next) < 0;
        for (const std::uint32_t i : {a, b}) ring[i].ear = is_ear(i);
        tip = ring[b].next;  // every other ear first: fewer slivers
    }
    triangles.emplace_back(ring[tip].previous, tip, ring[tip].next);
}

/// See triangulate.
/// @returns false for a concave polygon beyond ear_clipping_limit, of which nothing is appended
inline bool append_triangles(std::span<const glm::vec3> corners, std::vector<glm::uvec3>& triangles) {
    const auto count = static_cast<std::uint32_t>(corners.size());
    std::uint32_t start = 0;
    if (count > 3) {
        const flat_polygon polygon(corners);
        const auto turn_at = [&](std::uint32_t i) {
            return polygon.orient2d((i + count - 1) % count, i, (i + 1) % count);
        };
        for (std::uint32_t i = 0; i < count; ++i) {
            if (!(turn_at(i) < 0)) continue;
            if (count > ear_clipping_limit) return false;
            clip_ears(polygon, count, triangles);
            return true;
        }
        // A fan from a corner beside a straight one would have a triangle without area.
        for (std::uint32_t i = 0; i < count; ++i)
            if (turn_at((i + count - 1) % count) > 0 && turn_at((i + 1) % count) > 0) {
                start = i;
                break;
            }
    }
    for (std::uint32_t i = 2; i < count; ++i)
        triangles.emplace_back(start, (start + i - 1) % count, (start + i) % count);
    return true;
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Appends `corners.size() - 2` triangles that cover the polygon and face as it does, as indices of its corners.
/// Exact for simple polygons, also slightly non-planar ones, of which straight corners may yield triangles without
/// area; a self-intersecting one gets some triangulation. Nothing is appended for fewer than three corners. The time is
/// quadratic for concave polygons, which may have 4096 corners, and linear for convex ones, which may have any number.
/// @throws invalid_input for a concave polygon with more than 4096 corners
inline void triangulate(std::span<const glm::vec3> corners, std::vector<glm::uvec3>& triangles) {
    if (!detail::append_triangles(corners, triangles))
        detail::refuse("corners of a concave polygon", corners.size(),
                       "at most " + detail::to_text(detail::ear_clipping_limit) + ": cut it");
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
