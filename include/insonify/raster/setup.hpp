// From three snapped vertices to what the pixel loop needs: three edge functions and a depth plane.
//
// Positions are snapped to fixed point first; everything after is decided with integers, so two triangles that share
// an edge agree about every pixel on it. Fixed-point numbers count 2^-s pixels, s = subpixel bits (8 by default), from
// the image's top left corner; pixel (i, j) has its centre at (i + 1/2, j + 1/2).
//
// Fill rule: top-left, as in the Direct3D 11.3 functional specification, 3.4.2.1: a centre exactly on an edge belongs
// to the triangle if that edge is a top edge (horizontal, above the interior) or a left edge.
//
// This work is based on:
// Juan Pineda. A Parallel Algorithm for Polygon Rasterization. SIGGRAPH 1988
// Nicolas Capens. Advanced Rasterization. 2004
#pragma once

#include <insonify/core/numeric.hpp>
#include <insonify/raster/framebuffer.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>

namespace insonify::inline INSONIFY_ABI::detail {

/// A vertex on the screen: position in fixed point, z / w and 1 / w.
struct screen_vertex {
    std::int32_t x, y;
    float z;
    float inverse_w;
};

/// A pixel rectangle, ends included; empty if last < first.
struct pixel_box {
    int x0, y0, x1, y1;
    bool empty() const { return x1 < x0 || y1 < y0; }
};

inline pixel_box intersect(const pixel_box& a, const pixel_box& b) {
    return {(std::max)(a.x0, b.x0), (std::max)(a.y0, b.y0), (std::min)(a.x1, b.x1), (std::min)(a.y1, b.y1)};
}

/// The fixed-point grid of an image.
struct pixel_grid {
    int subpixel_bits;
    int width, height;

    std::int32_t half() const { return 1 << (subpixel_bits - 1); }
    std::int64_t center(int pixel) const { return (std::int64_t{pixel} << subpixel_bits) + half(); }
    /// First and last pixel whose centre is within [low, high].
    int first_center(std::int32_t low) const {
        return static_cast<int>((std::int64_t{low} + half() - 1) >> subpixel_bits);
    }
    int last_center(std::int32_t high) const {
        return static_cast<int>((std::int64_t{high} - half()) >> subpixel_bits);
    }
    /// Fixed-point coordinates stay within +-2^29 of the image's centre, so that an edge function fits 64 bits.
    double guard_pixels() const { return static_cast<double>(1 << (29 - subpixel_bits)); }

    /// Rounds a distance in pixels from the centre of an axis, to nearest, ties to even; |pixels| <= guard_pixels().
    std::int32_t snap(double pixels, int extent) const {
        // Adding 1.5 * 2^52 leaves the rounded integer in the low bits of the sum.
        constexpr double magic = 0x1.8p52;
        const double scaled = pixels * static_cast<double>(1 << subpixel_bits);
        const auto rounded = std::bit_cast<std::int64_t>(scaled + magic) - std::bit_cast<std::int64_t>(magic);
        return static_cast<std::int32_t>(rounded + (std::int64_t{extent} << (subpixel_bits - 1)));
    }
};

/// Twice the signed area in squared fixed-point units; positive for triangles that run clockwise on the screen.
inline std::int64_t doubled_area(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c) {
    return (std::int64_t{b.x} - a.x) * (std::int64_t{c.y} - a.y) -
           (std::int64_t{b.y} - a.y) * (std::int64_t{c.x} - a.x);
}

/// The pixels whose centres a triangle's bounding box holds.
inline pixel_box center_box(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c,
                            const pixel_grid& grid) {
    return {grid.first_center((std::min)({a.x, b.x, c.x})), grid.first_center((std::min)({a.y, b.y, c.y})),
            grid.last_center((std::max)({a.x, b.x, c.x})), grid.last_center((std::max)({a.y, b.y, c.y}))};
}

/// E(x, y) >= 0 at the centre of pixel (x, y) exactly if the pixel is on the inner side, fill rule included.
struct edge_function {
    std::int64_t origin;  ///< E at pixel (0, 0) of the box it was set up for
    std::int64_t dx, dy;  ///< per pixel to the right and down

    /// The edge from a to b of a clockwise triangle, at the pixels right of and below (x, y).
    static edge_function through(const screen_vertex& a, const screen_vertex& b, const pixel_grid& grid, int x, int y) {
        const std::int64_t run = std::int64_t{b.x} - a.x, rise = std::int64_t{b.y} - a.y;
        const bool top_left = rise < 0 || (rise == 0 && run > 0);
        const std::int64_t e = run * (grid.center(y) - a.y) - rise * (grid.center(x) - a.x) - (top_left ? 0 : 1);
        // A pixel is 2^s units wide, so E changes by multiples of 2^s and its sign survives the shift.
        return {e >> grid.subpixel_bits, -rise, run};
    }

    /// Whether E fits 32 bits everywhere in a box of that size.
    bool is_narrow(int width, int height) const {
        const auto size = [](std::int64_t v) { return v < 0 ? -v : v; };
        return size(origin) + size(dx) * width + size(dy) * height < (std::int64_t{1} << 31);
    }
};

/// z(x, y) over a triangle, anchored at a pixel of its own, so that the value doesn't depend on tiles.
/// Kept within the range of the three corners: slivers can't reach out.
struct depth_plane {
    float value, dx, dy;
    int x, y;
    float lowest, highest;

    /// `area` is doubled_area(a, b, c), not zero.
    static depth_plane through(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c,
                               std::int64_t area, const pixel_grid& grid) {
        const double unit = static_cast<double>(1 << grid.subpixel_bits);
        const double scale = unit / static_cast<double>(area);
        const double b_rise = static_cast<double>(b.z) - static_cast<double>(a.z);
        const double c_rise = static_cast<double>(c.z) - static_cast<double>(a.z);
        const auto difference = [](std::int32_t to, std::int32_t from) {
            return static_cast<double>(std::int64_t{to} - from);
        };
        const double dx = scale * (b_rise * difference(c.y, a.y) - c_rise * difference(b.y, a.y));
        const double dy = scale * (c_rise * difference(b.x, a.x) - b_rise * difference(c.x, a.x));
        const int x = a.x >> grid.subpixel_bits, y = a.y >> grid.subpixel_bits;
        const double value = static_cast<double>(a.z) + dx * (static_cast<double>(grid.center(x) - a.x) / unit) +
                             dy * (static_cast<double>(grid.center(y) - a.y) / unit);
        const auto [lowest, highest] = std::minmax({a.z, b.z, c.z});
        return {static_cast<float>(value), static_cast<float>(dx), static_cast<float>(dy), x, y, lowest, highest};
    }

    /// The same sequence of operations as the pixel kernel's, hence the same bits.
    float at(int px, int py) const {
        const float z = (value + dy * static_cast<float>(py - y)) + dx * static_cast<float>(px - x);
        const float raised = z > lowest ? z : lowest;
        return raised < highest ? raised : highest;
    }
};

}  // namespace insonify::inline INSONIFY_ABI::detail
