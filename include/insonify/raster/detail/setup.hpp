// From three snapped vertices to what the pixel loop needs: three edge functions, and the pixels to try.
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

#include <insonify/core/detail/int128.hpp>
#include <insonify/core/detail/portable.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/raster/framebuffer.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A vertex on the screen: position in fixed point, z / w and 1 / w.
struct screen_vertex {
    std::int64_t x, y;
    double z;
    double inverse_w;
};

/// A vertex's place on the grid, as millions of them are kept.
struct grid_place {
    std::int32_t x, y;

    /// Not compact: has to be placed and clipped triangle by triangle.
    static constexpr std::int32_t no_x = (std::numeric_limits<std::int32_t>::min)();
    static constexpr grid_place off_grid() { return {no_x, 0}; }
    bool is_off_grid() const { return x == no_x; }
};

/// A pixel rectangle, ends included; empty if last < first.
struct pixel_box {
    int x0, y0, x1, y1;
    bool empty() const { return x1 < x0 || y1 < y0; }
    int width() const { return x1 - x0 + 1; }
    int height() const { return y1 - y0 + 1; }
};

inline pixel_box intersect(const pixel_box& a, const pixel_box& b) {
    return {(std::max)(a.x0, b.x0), (std::max)(a.y0, b.y0), (std::min)(a.x1, b.x1), (std::min)(a.y1, b.y1)};
}

/// The fixed-point grid of an image.
struct pixel_grid {
    int subpixel_bits;
    int width, height;

    /// Coordinates within 2^29 of the image's centre are compact: 32 bits hold them and 64 bits an edge function.
    /// Beyond 2^50 nothing is held, and triangles are clipped; between the two, 128 bits decide.
    static constexpr int compact_bits = 29, widest_bits = 50;

    std::int64_t unit() const { return std::int64_t{1} << subpixel_bits; }
    std::int64_t half() const { return std::int64_t{1} << (subpixel_bits - 1); }
    std::int64_t center(int pixel) const { return pixel * unit() + half(); }
    /// First and last pixel of an axis whose centre is within [low, high), as far as it is one of [-1, extent]: by the
    /// fill rule no centre at the high end belongs.
    int first_center(std::int64_t low, int extent) const {
        return static_cast<int>(std::clamp<std::int64_t>((low + half() - 1) >> subpixel_bits, -1, extent));
    }
    int last_center(std::int64_t high, int extent) const {
        return static_cast<int>(std::clamp<std::int64_t>((high - half() - 1) >> subpixel_bits, -1, extent));
    }
    /// Pixels from the image's centre to where coordinates of so many bits end.
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
        constexpr std::int64_t most = std::int64_t{1} << compact_bits;
        const std::int64_t x = v.x - width * half(), y = v.y - height * half();
        return -most <= x && x <= most && -most <= y && y <= most;
    }
};

/// run * down - rise * right: positive for what lies on the inner side of an edge of a clockwise triangle.
/// Compact differences stay within 2^30, so 64 bits hold the result.
inline std::int64_t compact_side(std::int64_t run, std::int64_t rise, std::int64_t right, std::int64_t down) {
    return run * down - rise * right;
}
inline int128 wide_side(std::int64_t run, std::int64_t rise, std::int64_t right, std::int64_t down) {
    return int128::product(run, down) - int128::product(rise, right);
}

/// Twice the signed area in squared fixed-point units; positive for triangles that run clockwise on the screen.
inline std::int64_t compact_area(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c) {
    return compact_side(b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y);
}
inline int128 wide_area(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c) {
    return wide_side(b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y);
}

/// Whether a triangle's bounding box lies beyond all centres of the picture on one side of it.
inline bool is_outside(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c, const pixel_grid& grid) {
    return grid.first_center((std::min)({a.x, b.x, c.x}), grid.width) == grid.width ||
           grid.first_center((std::min)({a.y, b.y, c.y}), grid.height) == grid.height ||
           grid.last_center((std::max)({a.x, b.x, c.x}), grid.width) == -1 ||
           grid.last_center((std::max)({a.y, b.y, c.y}), grid.height) == -1;
}

/// The pixels of an image whose centres a triangle's bounding box holds.
inline pixel_box center_box(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c,
                            const pixel_grid& grid) {
    const pixel_box box{grid.first_center((std::min)({a.x, b.x, c.x}), grid.width),
                        grid.first_center((std::min)({a.y, b.y, c.y}), grid.height),
                        grid.last_center((std::max)({a.x, b.x, c.x}), grid.width),
                        grid.last_center((std::max)({a.y, b.y, c.y}), grid.height)};
    return intersect(box, {0, 0, grid.width - 1, grid.height - 1});
}

/// E(x, y) >= 0 at the centre of pixel (x, y) exactly if the pixel is on the inner side, fill rule included.
struct edge_function {
    std::int64_t origin;  ///< E at the first pixel of the box it was set up for
    std::int64_t dx, dy;  ///< per pixel to the right and down

    /// The edge from a to b of a clockwise triangle, at the pixels right of and below (x, y).
    static edge_function through(const screen_vertex& a, const screen_vertex& b, const pixel_grid& grid, int x, int y,
                                 bool compact) {
        const std::int64_t run = b.x - a.x, rise = b.y - a.y;
        const std::int64_t right = grid.center(x) - a.x, down = grid.center(y) - a.y;
        const bool top_left = rise < 0 || (rise == 0 && run > 0);
        const std::int64_t inner = top_left ? 0 : -1;
        // A pixel is 2^s units wide, so E changes by multiples of 2^s and its sign survives the shift.
        if (compact) return {(compact_side(run, rise, right, down) + inner) >> grid.subpixel_bits, -rise, run};
        return {(wide_side(run, rise, right, down) + int128::from(inner)).shifted_down(grid.subpixel_bits), -rise, run};
    }

    /// Whether E fits 32 bits everywhere in a box of that size.
    bool is_narrow(int width, int height) const {
        constexpr std::int64_t most = std::int64_t{1} << 31;
        return numeric::magnitude(dx) < most && numeric::magnitude(dy) < most && -most < origin && origin < most &&
               numeric::magnitude(origin) + numeric::magnitude(dx) * width + numeric::magnitude(dy) * height < most;
    }

    /// The same decision for the pixels of a box of that size, in numbers as small as they can be: where E has one
    /// sign, only the sign is kept. Else E is below 2^62 all over a tile, however far away the edge's ends are.
    edge_function simplified(int width, int height) const {
        const std::int64_t across = dx * (width - 1), along = dy * (height - 1);
        constexpr std::int64_t none = 0;
        const std::int64_t falls = (std::min)(across, none) + (std::min)(along, none);
        const std::int64_t rises = (std::max)(across, none) + (std::max)(along, none);
        if (origin >= -falls) return {0, 0, 0};
        if (origin < -rises) return {-1, 0, 0};
        return *this;
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
