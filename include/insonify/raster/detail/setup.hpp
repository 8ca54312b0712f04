// Triangle setup: edge functions and a depth plane from three snapped vertices.
//
// Vertices are snapped to fixed point first. Everything after is decided with integers, so two triangles that share an
// edge agree about every pixel on it. Fixed-point numbers count 2^-s pixels, s = subpixel bits (8 by default), from the
// image's top left corner; pixel (i, j) has its centre at (i + 1/2, j + 1/2).
//
// Fill rule: top-left, as in the Direct3D 11.3 functional specification, 3.4.2.1: a centre exactly on an edge belongs
// to the triangle if that edge is a top edge (horizontal, above the interior) or a left edge.
//
// Exact depth is correctly rounded: the plane is evaluated in double, with a bound of its error. Where the bound leaves
// two floats to choose from (close to the midpoint between them, or on slivers, whose gradients are differences of
// almost equal numbers), the barycentric weights decide: they are integers, so the quotient is known to a hundred bits.
//
// Based on:
// Juan Pineda. A Parallel Algorithm for Polygon Rasterization. SIGGRAPH 1988
// Nicolas Capens. Advanced Rasterization. 2004
// Abraham Ziv. Fast Evaluation of Elementary Mathematical Functions with Correctly Rounded Last Bit. 1991
#pragma once

#include <insonify/core/detail/double_double.hpp>
#include <insonify/core/detail/int128.hpp>
#include <insonify/core/detail/portable.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/core/rect.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A vertex on the screen: its snapped position, z / w and 1 / w.
struct screen_vertex {
    std::int64_t x, y;
    double z;
    double inverse_w;
};

/// A snapped position in 32 bits.
struct grid_position {
    std::int32_t x, y;

    /// Marks vertices that are not compact; their triangles are transformed and clipped one by one.
    static constexpr std::int32_t off_grid = (std::numeric_limits<std::int32_t>::min)();
    bool is_off_grid() const { return x == off_grid; }
};

/// The fixed-point grid of an image.
struct pixel_grid {
    int subpixel_bits;
    int width, height;

    /// Coordinates within 2^29 of the image's centre are compact: 32 bits hold them, and 64 bits an edge function.
    /// Triangles are clipped at 2^50; between the two, edge functions take 128 bits.
    static constexpr int compact_bits = 29, widest_bits = 50;

    rect pixels() const { return {0, 0, width, height}; }
    std::int64_t unit() const { return std::int64_t{1} << subpixel_bits; }
    std::int64_t half() const { return std::int64_t{1} << (subpixel_bits - 1); }
    std::int64_t centre(int pixel) const { return pixel * unit() + half(); }
    /// The first pixel of an axis whose centre is at a coordinate or beyond, clamped to [0, extent]. By the fill rule
    /// this is also the exclusive end of the pixels below an upper bound.
    int first_centre(std::int64_t coordinate, int extent) const {
        return static_cast<int>(std::clamp<std::int64_t>((coordinate + half() - 1) >> subpixel_bits, 0, extent));
    }
    /// Pixels from the image's centre to the end of coordinates of so many bits.
    double reach(int bits) const { return static_cast<double>(std::int64_t{1} << bits) / static_cast<double>(unit()); }

    /// Added to a number below 2^51, it leaves the rounded integer in the low bits of the sum.
    static constexpr double magic = 0x1.8p52;

    /// Rounds a distance in pixels from the centre of an axis, to nearest, ties to even; |pixels| < reach(51).
    std::int64_t snap(double pixels, int extent) const {
        const double scaled = pixels * static_cast<double>(unit());
        const auto rounded = numeric::bit_cast<std::int64_t>(scaled + magic) - numeric::bit_cast<std::int64_t>(magic);
        return rounded + extent * half();
    }
    bool is_compact(const screen_vertex& v) const {
        constexpr std::int64_t limit = std::int64_t{1} << compact_bits;
        const std::int64_t x = v.x - width * half(), y = v.y - height * half();
        return -limit <= x && x <= limit && -limit <= y && y <= limit;
    }
};

/// edge_x * down - edge_y * right: positive on the inner side of an edge of a clockwise triangle. Compact differences
/// stay within 2^30, so 64 bits hold the result.
inline std::int64_t compact_side(std::int64_t edge_x, std::int64_t edge_y, std::int64_t right, std::int64_t down) {
    return edge_x * down - edge_y * right;
}
inline int128 wide_side(std::int64_t edge_x, std::int64_t edge_y, std::int64_t right, std::int64_t down) {
    return int128::product(edge_x, down) - int128::product(edge_y, right);
}

/// Twice the signed area in squared fixed-point units; positive for triangles that run clockwise on the screen.
inline std::int64_t compact_area(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c) {
    return compact_side(b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y);
}
inline int128 wide_area(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c) {
    return wide_side(b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y);
}

/// The pixels of an image whose centres lie in a triangle's bounding box.
inline rect centre_rect(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c,
                        const pixel_grid& grid) {
    return {grid.first_centre((std::min)({a.x, b.x, c.x}), grid.width),
            grid.first_centre((std::min)({a.y, b.y, c.y}), grid.height),
            grid.first_centre((std::max)({a.x, b.x, c.x}), grid.width),
            grid.first_centre((std::max)({a.y, b.y, c.y}), grid.height)};
}

/// Whether the centres in a triangle's bounding box all lie beyond the same side of the image.
inline bool is_outside(const rect& centres, const pixel_grid& grid) {
    return centres.x0 == grid.width || centres.y0 == grid.height || centres.x1 == 0 || centres.y1 == 0;
}

/// E(x, y) >= 0 at the centre of pixel (x, y) if and only if the pixel is on the inner side, fill rule included.
struct edge_function {
    std::int64_t origin;  ///< E at the first pixel of the rectangle that it was set up for
    std::int64_t dx, dy;  ///< per pixel to the right and down

    /// The edge from a to b of a clockwise triangle, for the pixels right of and below (x, y).
    static edge_function through(const screen_vertex& a, const screen_vertex& b, const pixel_grid& grid, int x, int y,
                                 bool compact) {
        const std::int64_t edge_x = b.x - a.x, edge_y = b.y - a.y;
        const std::int64_t right = grid.centre(x) - a.x, down = grid.centre(y) - a.y;
        const bool top_left = edge_y < 0 || (edge_y == 0 && edge_x > 0);
        const std::int64_t inner = top_left ? 0 : -1;
        // A pixel is 2^s units wide, so E changes by multiples of 2^s and its sign survives the shift.
        if (compact)
            return {(compact_side(edge_x, edge_y, right, down) + inner) >> grid.subpixel_bits, -edge_y, edge_x};
        return {(wide_side(edge_x, edge_y, right, down) + int128::from(inner)).shifted_down(grid.subpixel_bits),
                -edge_y, edge_x};
    }

    /// Whether E fits 32 bits everywhere in a rectangle of that size.
    bool is_narrow(int width, int height) const {
        constexpr std::int64_t limit = std::int64_t{1} << 31;
        return numeric::abs(dx) < limit && numeric::abs(dy) < limit && -limit < origin && origin < limit &&
               numeric::abs(origin) + numeric::abs(dx) * width + numeric::abs(dy) * height < limit;
    }

    /// An equivalent function for a rectangle of that size. Where E has the same sign at all pixels, it is replaced by
    /// a constant; otherwise E is below 2^62 all over a tile, however far away the ends of the edge are.
    edge_function simplified(int width, int height) const {
        const std::int64_t across = dx * (width - 1), along = dy * (height - 1);
        constexpr std::int64_t none = 0;
        const std::int64_t smallest_change = (std::min)(across, none) + (std::min)(along, none);
        const std::int64_t largest_change = (std::max)(across, none) + (std::max)(along, none);
        if (origin >= -smallest_change) return {0, 0, 0};
        if (origin < -largest_change) return {-1, 0, 0};
        return *this;
    }
};

/// z(x, y) at pixel centres.
struct depth_plane {
    double x, y, z;         ///< the vertex that the plane is anchored at, in pixels from the first pixel's centre
    double dx, dy;          ///< per pixel
    float lowest, highest;  ///< of the vertices; depths are clamped to these
    double error;           ///< bound of the plane's error within the triangle's bounding box

    /// @param area  twice the triangle's area in squared fixed-point units, positive
    static depth_plane through(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c, double area,
                               const pixel_grid& grid) {
        const auto unit = static_cast<double>(grid.unit()), pixel = 1 / unit;
        const double scale = unit / area;
        const double b_dz = b.z - a.z, c_dz = c.z - a.z;
        const auto bx = static_cast<double>(b.x - a.x), by = static_cast<double>(b.y - a.y);
        const auto cx = static_cast<double>(c.x - a.x), cy = static_cast<double>(c.y - a.y);
        const auto [lowest, highest] = std::minmax({a.z, b.z, c.z});
        depth_plane plane;
        plane.x = static_cast<double>(a.x - grid.half()) * pixel;
        plane.y = static_cast<double>(a.y - grid.half()) * pixel;
        plane.z = a.z;
        plane.dx = scale * (b_dz * cy - c_dz * by);
        plane.dy = scale * (c_dz * bx - b_dz * cx);
        plane.lowest = static_cast<float>(lowest);
        plane.highest = static_cast<float>(highest);

        // Each product of a gradient has a relative error of 2^-53, multiplied by the box's width or height.
        const auto span = [](double u, double v) { return (std::max)({u, v, 0.0}) - (std::min)({u, v, 0.0}); };
        const double swing = 4 * (highest - lowest) * span(bx, cx) * span(by, cy);
        const double largest = (std::max)(numeric::abs(lowest), numeric::abs(highest)) * area;
        plane.error = 0x1p-49 * (swing + largest) / area;
        return plane;
    }

    /// The plane at the start of a pixel row. Every kernel uses the same operations, hence gets the same bits.
    double row(int py) const { return z + dy * (static_cast<double>(py) - y); }
};

/// The float nearest to the plane through three vertices, at a pixel that they cover.
inline float rounded_depth(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c, int px, int py,
                           const pixel_grid& grid) {
    // Barycentric weights times twice the area, exact.
    const auto opposite = [&](const screen_vertex& from, const screen_vertex& to) {
        return wide_side(to.x - from.x, to.y - from.y, grid.centre(px) - from.x, grid.centre(py) - from.y);
    };
    const int128 weights[3] = {opposite(b, c), opposite(c, a), opposite(a, b)};
    const auto wide = [](const int128& v) { return double_double::from(v); };
    const double_double sum = wide(weights[0]) * a.z + wide(weights[1]) * b.z + wide(weights[2]) * c.z;
    return (sum / wide(weights[0] + weights[1] + weights[2])).to_float();
}

/// A triangle of any size, ready for the pixels of a rectangle. The vertices run clockwise on the screen; edges are
/// named by their ends.
struct triangle_setup {
    edge_function bc, ca, ab;
    depth_plane depth;
    rect pixels;
    bool narrow;  ///< the edge functions fit 32 bits all over the rectangle

    /// The vertices must not be collinear.
    /// @param slack  pixels beyond the end of a row that the pixel loop may evaluate
    static triangle_setup of(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c,
                             const pixel_grid& grid, const rect& pixels, int slack) {
        const bool compact = grid.is_compact(a) && grid.is_compact(b) && grid.is_compact(c);
        const double area =
            compact ? static_cast<double>(compact_area(a, b, c)) : double_double::from(wide_area(a, b, c)).high;
        triangle_setup t{edge_function::through(b, c, grid, pixels.x0, pixels.y0, compact),
                         edge_function::through(c, a, grid, pixels.x0, pixels.y0, compact),
                         edge_function::through(a, b, grid, pixels.x0, pixels.y0, compact),
                         depth_plane::through(a, b, c, area, grid),
                         pixels,
                         true};
        if (t.is_narrow(slack)) return t;
        const int width = pixels.width() + slack, height = pixels.height();
        t.bc = t.bc.simplified(width, height);
        t.ca = t.ca.simplified(width, height);
        t.ab = t.ab.simplified(width, height);
        t.narrow = t.is_narrow(slack);
        return t;
    }

    /// Covers all pixels of the rectangle, and none to its right.
    void cover_all() {
        bc = ca = {0, 0, 0};
        ab = {pixels.width() - 1, -1, 0};
        narrow = true;
    }

  private:
    bool is_narrow(int slack) const {
        const int width = pixels.width() + slack, height = pixels.height();
        return bc.is_narrow(width, height) && ca.is_narrow(width, height) && ab.is_narrow(width, height);
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
