// Small triangles, of which a fine mesh is made: several go through the set-up at a time, one per lane, in 32 bits.
//
// A triangle is small if it extends less than 2^15 sub-pixels, 8 pixels at 12 sub-pixel bits: then edge functions are
// sums of two products of less than 2^30 each, and fit 32 bits. What is decided here is what setup.hpp decides for
// triangles of any size, in the same integers.
#pragma once

#include <insonify/core/simd/lanes.hpp>
#include <insonify/raster/detail/setup.hpp>

#include <limits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// N boxes of pixels.
template <int N>
struct box_lanes {
    using ints = lanes<std::int32_t, N>;
    ints x0, y0, x1, y1;

    INSONIFY_INLINE void is_empty(ints& into) const { into = ints((x1 < x0) | (y1 < y0)); }
    /// Which share no column or no row with another, each being a box.
    INSONIFY_INLINE void is_beside(const box_lanes& other, ints& into) const {
        into = ints((x0 > other.x1) | (x1 < other.x0) | (y0 > other.y1) | (y1 < other.y0));
    }
    INSONIFY_INLINE void cut_to(const box_lanes& other) {
        x0 = x0 > other.x0 ? x0 : other.x0;
        y0 = y0 > other.y0 ? y0 : other.y0;
        x1 = x1 < other.x1 ? x1 : other.x1;
        y1 = y1 < other.y1 ? y1 : other.y1;
    }
};

/// Where triangles are looked for: what is the same for all of them, ready to be compared with.
template <int N>
struct drawn_area {
    using ints = lanes<std::int32_t, N>;
    box_lanes<N> box;
    ints half;           ///< of a pixel, in sub-pixels
    ints before, after;  ///< a sub-pixel less and more
    int bits;            ///< of sub-pixels

    INSONIFY_INLINE drawn_area(const pixel_grid& grid, const pixel_box& pixels)
        : box{ints{} + pixels.x0, ints{} + pixels.y0, ints{} + pixels.x1, ints{} + pixels.y1},
          half(ints{} + static_cast<std::int32_t>(grid.half())),
          before(half - 1),
          after(half + 1),
          bits(grid.subpixel_bits) {}
};

/// Where the corners of N triangles lie, and how far they extend.
template <int N>
struct corner_lanes {
    using ints = lanes<std::int32_t, N>;
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
    /// Whether all of them are small; of those on the grid.
    INSONIFY_INLINE bool are_small() const {
        constexpr std::int32_t most = (1 << 15) - 1;
        return !any(ints(((east - west) | (south - north)) >= most));
    }
    /// Twice the area, positive for clockwise on the screen; of small ones.
    INSONIFY_INLINE void area(ints& into) const { into = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax); }

    /// The pixels whose centres the triangles' bounding boxes hold, see pixel_grid::first_center.
    INSONIFY_INLINE void centers(const drawn_area<N>& area, box_lanes<N>& into) const {
        into.x0 = (west + area.before) >> area.bits;
        into.y0 = (north + area.before) >> area.bits;
        into.x1 = (east - area.after) >> area.bits;
        into.y1 = (south - area.after) >> area.bits;
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
    INSONIFY_INLINE small_setup(const corner_lanes<N>& at, const drawn_area<N>& area) {
        box_lanes<N> box;
        at.centers(area, box);
        box.cut_to(area.box);
        store(x0, box.x0);
        store(y0, box.y0);
        store(x1, box.x1);
        store(y1, box.y1);
        const ints x = (box.x0 << area.bits) + area.half, y = (box.y0 << area.bits) + area.half;
        store(right, ints(x - at.ax));
        store(down, ints(y - at.ay));
        edge(bc, at.bx, at.by, at.cx, at.cy, x, y, area.bits);
        edge(ca, at.cx, at.cy, at.ax, at.ay, x, y, area.bits);
        edge(ab, at.ax, at.ay, at.bx, at.by, x, y, area.bits);
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

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
