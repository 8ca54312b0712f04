// Small triangles, of which a fine mesh is made: several go through the set-up at a time, one per lane, in 32 bits.
//
// A triangle is small if it extends less than 2^14 sub-pixels; then differences of its corners have 15 bits and edge
// functions 30. What is decided here is what setup.hpp decides for triangles of any size, in the same integers.
#pragma once

#include <insonify/core/lanes.hpp>
#include <insonify/raster/setup.hpp>

#include <limits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::detail {

/// Where the corners of N triangles lie, and how far they extend.
template <int N>
struct corner_lanes {
    using ints = lanes<std::int32_t, N>;
    using uints = lanes<std::uint32_t, N>;
    ints ax, ay, bx, by, cx, cy;
    ints west, north, east, south;

    /// @param read  read(i, x, y): sets where corner i of each triangle lies
    template <class Read>
    INSONIFY_INLINE explicit corner_lanes(const Read& read) {
        read(0, ax, ay);
        read(1, bx, by);
        read(2, cx, cy);
        extend(west, east, ax, bx, cx);
        extend(north, south, ay, by, cy);
    }

    INSONIFY_INLINE bool are_on_grid() const { return !any(ints(west == grid_place::no_x)); }
    /// Which lie outside of the picture, see is_outside; of those on the grid.
    INSONIFY_INLINE void outside(const pixel_grid& grid, ints& into) const {
        const auto half = static_cast<std::int32_t>(grid.half());
        const std::int32_t right = (grid.width << grid.subpixel_bits) - half,
                           bottom = (grid.height << grid.subpixel_bits) - half;
        into = ints((west > right) | (east <= half) | (north > bottom) | (south <= half));
    }
    /// Whether all of them are small; of those on the grid.
    INSONIFY_INLINE bool are_small() const {
        const uints most = uints{} + (1u << 14);
        return !any(ints((uints(east) - uints(west) >= most) | (uints(south) - uints(north) >= most)));
    }
    /// Twice the area, positive for clockwise on the screen; of small ones.
    INSONIFY_INLINE void area(ints& into) const { into = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax); }

    /// The pixels of a box that the triangles' bounding boxes hold, see center_box.
    INSONIFY_INLINE void centers(const pixel_grid& grid, const pixel_box& box, ints& x0, ints& y0, ints& x1,
                                 ints& y1) const {
        const auto half = static_cast<std::int32_t>(grid.half());
        x0 = (west + (half - 1)) >> grid.subpixel_bits;
        y0 = (north + (half - 1)) >> grid.subpixel_bits;
        x1 = (east - (half + 1)) >> grid.subpixel_bits;
        y1 = (south - (half + 1)) >> grid.subpixel_bits;
        const ints left = ints{} + box.x0, top = ints{} + box.y0, right = ints{} + box.x1, bottom = ints{} + box.y1;
        x0 = x0 > left ? x0 : left;
        y0 = y0 > top ? y0 : top;
        x1 = x1 < right ? x1 : right;
        y1 = y1 < bottom ? y1 : bottom;
    }

  private:
    INSONIFY_INLINE static void extend(ints& low, ints& high, const ints& a, const ints& b, const ints& c) {
        low = a < b ? a : b;
        low = low < c ? low : c;
        high = a > b ? a : b;
        high = high > c ? high : c;
    }
};

/// Edge functions and pixels of N small triangles, in memory: the pixel loop takes them one by one.
template <int N>
struct small_setup {
    using ints = lanes<std::int32_t, N>;
    struct edge_lanes {
        std::int32_t origin[static_cast<unsigned>(N)], dx[static_cast<unsigned>(N)], dy[static_cast<unsigned>(N)];
    };
    edge_lanes bc, ca, ab;
    std::int32_t x0[static_cast<unsigned>(N)], y0[static_cast<unsigned>(N)], x1[static_cast<unsigned>(N)],
        y1[static_cast<unsigned>(N)];
    std::int32_t right[static_cast<unsigned>(N)], down[static_cast<unsigned>(N)];  ///< from a to the first pixel

    /// @param at  corners in clockwise order
    INSONIFY_INLINE small_setup(const corner_lanes<N>& at, const pixel_grid& grid, const pixel_box& box) {
        ints left, top, last_x, last_y;
        at.centers(grid, box, left, top, last_x, last_y);
        store(x0, left);
        store(y0, top);
        store(x1, last_x);
        store(y1, last_y);
        const auto half = static_cast<std::int32_t>(grid.half());
        const ints x = (left << grid.subpixel_bits) + half, y = (top << grid.subpixel_bits) + half;
        store(right, ints(x - at.ax));
        store(down, ints(y - at.ay));
        edge(bc, at.bx, at.by, at.cx, at.cy, x, y, grid.subpixel_bits);
        edge(ca, at.cx, at.cy, at.ax, at.ay, x, y, grid.subpixel_bits);
        edge(ab, at.ax, at.ay, at.bx, at.by, x, y, grid.subpixel_bits);
    }

  private:
    INSONIFY_INLINE static void edge(edge_lanes& e, const ints& from_x, const ints& from_y, const ints& to_x,
                                     const ints& to_y, const ints& x, const ints& y, int bits) {
        const ints run = to_x - from_x, rise = to_y - from_y, none = ints{};
        const ints top_left = ints((rise < none) | ((rise == none) & (run > none)));
        const ints inner = top_left ? none : none - 1;
        store(e.origin, ints((run * (y - from_y) - rise * (x - from_x) + inner) >> bits));
        store(e.dx, ints(none - rise));
        store(e.dy, run);
    }
};

}  // namespace insonify::inline INSONIFY_ABI::detail

INSONIFY_ARITHMETIC_END
