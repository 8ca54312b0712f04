// Projection from clip space to the pixel grid, and clipping.
//
// Only triangles that reach behind the camera plane, out of the depth range, or 2^50 sub-pixels out of the picture are
// clipped; the image's rectangle cuts off the rest. Where an edge crosses a plane, the new vertex has the same bits
// whichever end it is computed from, and both triangles at the edge share it: no crack opens, however many planes cut.
//
// Based on: Ivan E. Sutherland, Gary W. Hodgman. Reentrant Polygon Clipping. Communications of the ACM 17(1), 1974.
#pragma once

#include <insonify/core/detail/portable.hpp>
#include <insonify/core/simd/lanes.hpp>
#include <insonify/raster/detail/setup.hpp>
#include <insonify/raster/draw_options.hpp>

#include <algorithm>
#include <array>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A corner of a clipped triangle: its clip position and its barycentric weights in the whole triangle.
struct clip_corner {
    glm::dvec4 position;
    glm::dvec3 weights;
};

/// The part of a triangle inside all planes: three corners and one more for each plane that cuts it. Where rounding
/// puts several corners across a plane, a cut adds more; those that exceed the array are dropped.
struct clip_polygon {
    static constexpr int planes = 7;
    std::array<clip_corner, 3 + planes> corners;
    int count = 0;
    bool was_cut = false;  ///< by any plane
};

/// From clip space to the fixed-point grid.
class projection {
  public:
    /// @param exact  whether to divide by w rather than multiply by 1 / w, which may be off in the last bit. Exact
    ///               positions are the nearest on the grid up to 2^27 sub-pixels from its centre, and within 2^-52 of
    ///               the distance beyond that
    projection(const pixel_grid& grid, depth_compare compare, bool exact)
        : grid_(grid),
          half_width_(0.5 * grid.width),
          half_height_(0.5 * grid.height),
          compact_x_(grid.reach(pixel_grid::compact_bits) / half_width_),
          compact_y_(grid.reach(pixel_grid::compact_bits) / half_height_),
          widest_x_(grid.reach(pixel_grid::widest_bits) / half_width_),
          widest_y_(grid.reach(pixel_grid::widest_bits) / half_height_),
          right_(grid, grid.width, half_width_),
          down_(grid, grid.height, -half_height_),
          sign_(compare == depth_compare::less ? 1.0 : -1.0),
          exact_(exact) {}

    /// Distance to a clipping plane in clip space, >= 0 inside. The first plane keeps w away from zero.
    double distance(int plane, const glm::dvec4& p) const {
        switch (plane) {
            case 0: return p.w - smallest_w;
            case 1: return p.z;
            case 2: return p.w - p.z;
            case 3: return widest_x_ * p.w + p.x;
            case 4: return widest_x_ * p.w - p.x;
            case 5: return widest_y_ * p.w + p.y;
            default: return widest_y_ * p.w - p.y;
        }
    }

    /// Depth is negated under `depth_compare::greater`: in a tile, smaller is always nearer.
    screen_vertex to_screen(const glm::dvec4& p) const {
        const double inverse_w = 1 / p.w;
        const glm::dvec3 over_w = exact_ ? glm::dvec3(p.x / p.w, p.y / p.w, p.z / p.w)
                                         : glm::dvec3(p.x * inverse_w, p.y * inverse_w, p.z * inverse_w);
        return {grid_.snap(over_w.x * half_width_, grid_.width), grid_.snap(-over_w.y * half_height_, grid_.height),
                sign_ * over_w.z, inverse_w};
    }

    /// The same for N positions, by axis. Vertices that are not compact (or NaN) are marked as off the grid, and so are
    /// those whose 1 / w, times an area of up to 2^61, may leave the range of a float: see lane_shading_kernel.
    template <int N>
    INSONIFY_INLINE void to_screen(const lanes<double, N> (&p)[4], lanes<std::int64_t, N>& x, lanes<std::int64_t, N>& y,
                                   lanes<double, N>& z, lanes<double, N>& inverse_w) const {
        using doubles = lanes<double, N>;
        using masks = lanes<std::int64_t, N>;
        const doubles& w = p[3];
        const doubles size_x = p[0] < 0.0 ? 0.0 - p[0] : p[0], size_y = p[1] < 0.0 ? 0.0 - p[1] : p[1];
        const masks compact = masks(w >= 0x1p-60) & masks(w <= 0x1p60) & masks(p[2] >= 0.0) & masks(p[2] <= w) &
                              masks(size_x <= compact_x_ * w) & masks(size_y <= compact_y_ * w);
        inverse_w = 1.0 / w;
        const auto over_w = [&](doubles& into, const doubles& value) INSONIFY_INLINE_LAMBDA {
            if (exact_)
                into = value / w;
            else
                into = value * inverse_w;
        };
        doubles right, down;
        over_w(right, p[0]);
        over_w(down, p[1]);
        over_w(z, p[2]);
        z = z * sign_;
        snap<N>(x, right * right_.units, right_.origin);
        snap<N>(y, down * down_.units, down_.origin);
        x = compact ? x : masks{} + std::int64_t{grid_position::off_grid};
        y = compact ? y : masks{};
    }

    /// Clips a triangle by all planes.
    clip_polygon clip(const std::array<glm::dvec4, 3>& triangle) const {
        clip_polygon polygon;
        polygon.corners[0] = {triangle[0], {1, 0, 0}};
        polygon.corners[1] = {triangle[1], {0, 1, 0}};
        polygon.corners[2] = {triangle[2], {0, 0, 1}};
        polygon.count = 3;
        for (int plane = 0; plane < clip_polygon::planes && polygon.count > 0; ++plane) polygon = cut(polygon, plane);
        for (int i = 0; i < polygon.count; ++i) move_inside(polygon.corners[static_cast<std::size_t>(i)].position);
        return polygon;
    }

  private:
    static constexpr double smallest_w = 1e-30;

    /// One axis of pixel_grid::snap; scaling by the width and the power of two at once changes no rounding.
    struct axis {
        double units;          ///< half the picture in sub-pixels
        std::uint64_t origin;  ///< of the picture, less the bits that the magic number leaves
        axis(const pixel_grid& grid, int extent, double half)
            : units(half * static_cast<double>(grid.unit())),
              origin(static_cast<std::uint64_t>(extent * grid.half() -
                                                numeric::bit_cast<std::int64_t>(pixel_grid::magic))) {}
    };
    template <int N>
    INSONIFY_INLINE static void snap(lanes<std::int64_t, N>& into, const lanes<double, N>& units,
                                     std::uint64_t origin) {
        const lanes<double, N> sum = units + pixel_grid::magic;
        lanes<std::uint64_t, N> bits;  // unsigned: vertices that are not compact may wrap around
        std::memcpy(&bits, &sum, sizeof bits);
        bits = bits + origin;
        std::memcpy(&into, &bits, sizeof into);
    }

    /// Clamps a corner that rounding left outside of a plane; close to the camera the error may be large. The result
    /// depends on the position alone, so that adjacent triangles keep their shared corner.
    void move_inside(glm::dvec4& p) const {
        p.w = (std::max)(p.w, smallest_w);
        p.x = std::clamp(p.x, -widest_x_ * p.w, widest_x_ * p.w);
        p.y = std::clamp(p.y, -widest_y_ * p.w, widest_y_ * p.w);
        p.z = std::clamp(p.z, 0.0, p.w);
    }

    clip_polygon cut(const clip_polygon& whole, int plane) const {
        clip_polygon kept;
        kept.was_cut = whole.was_cut;
        const auto keep = [&](const clip_corner& corner) {
            const auto count = static_cast<std::size_t>(kept.count);
            if (count == kept.corners.size()) return;
            kept.corners[count] = corner;
            ++kept.count;
        };
        for (int i = 0; i < whole.count; ++i) {
            const clip_corner& here = whole.corners[static_cast<std::size_t>(i)];
            const clip_corner& next = whole.corners[static_cast<std::size_t>((i + 1) % whole.count)];
            const double d_here = distance(plane, here.position), d_next = distance(plane, next.position);
            const bool here_inside = d_here >= 0, next_inside = d_next >= 0;
            if (here_inside) keep(here);
            kept.was_cut |= !here_inside;
            if (here_inside == next_inside) continue;
            clip_corner crossed = crossing(here, d_here, next, d_next);
            if (plane == 0) crossed.position = next_to_eye(here.position, next.position);
            keep(crossed);
        }
        return kept;
    }

    /// Where the edge between two corners on either side of a plane meets it. Both weights are positive, so that a
    /// crossing close to the camera loses no digits to a distant end. Exchanging the corners changes no bit.
    static clip_corner crossing(const clip_corner& a, double d_a, const clip_corner& b, double d_b) {
        const double weight_a = d_b / (d_b - d_a), weight_b = d_a / (d_a - d_b);
        return {weight_a * a.position + weight_b * b.position, weight_a * a.weights + weight_b * b.weights};
    }

    /// Where an edge crosses w = smallest_w. Interpolation would cancel: x, y and z are tiny beside those of the ends.
    /// Products of floats are exact in double, so that here an edge with z = w, or one through the eye, keeps its
    /// proportions. Exchanging the ends changes no bit.
    static glm::dvec4 next_to_eye(const glm::dvec4& a, const glm::dvec4& b) {
        const double run = b.w - a.w;
        glm::dvec4 p(0, 0, 0, smallest_w);
        for (int i = 0; i < 3; ++i) p[i] = ((a[i] * b.w - b[i] * a.w) + smallest_w * (b[i] - a[i])) / run;
        // A plane with both ends inside has everything between them inside.
        if (a.z >= 0 && b.z >= 0) p.z = (std::max)(p.z, 0.0);
        if (a.z <= a.w && b.z <= b.w) p.z = (std::min)(p.z, smallest_w);
        return p;
    }

    pixel_grid grid_;
    double half_width_, half_height_;
    double compact_x_, compact_y_;  ///< |x| / w and |y| / w up to which vertices are compact
    double widest_x_, widest_y_;    ///< and up to which they are not clipped
    axis right_, down_;
    double sign_;
    bool exact_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
