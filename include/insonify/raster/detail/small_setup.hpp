// Setup of small triangles, of which a fine mesh is made: N at a time, one per lane, in 32 bits.
//
// A triangle is small if (width | height) < 2^15 - 1 sub-pixels; both are then below 2^15 (128 pixels at the default 8
// sub-pixel bits), so edge functions are sums of two products of less than 2^30 each, and fit 32 bits. The integers are
// those of setup.hpp, and so are all decisions.
//
// Exact depths are the planes of setup.hpp, in double with a bound of the error. Quick depths are in float. Either way
// a pixel gets the same depth whichever tile evaluates it.
#pragma once

#include <insonify/core/simd/lanes.hpp>
#include <insonify/raster/detail/setup.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// N rectangles of pixels, half open.
template <int N>
struct rect_lanes {
    using ints = lanes<std::int32_t, N>;
    ints x0, y0, x1, y1;

    INSONIFY_INLINE void is_empty(ints& into) const { into = ints((x1 <= x0) | (y1 <= y0)); }
    /// Whether two rectangles have no column or no row in common.
    INSONIFY_INLINE void is_disjoint(const rect_lanes& other, ints& into) const {
        into = ints((x0 >= other.x1) | (x1 <= other.x0) | (y0 >= other.y1) | (y1 <= other.y0));
    }
    INSONIFY_INLINE void intersect(const rect_lanes& other) {
        x0 = x0 > other.x0 ? x0 : other.x0;
        y0 = y0 > other.y0 ? y0 : other.y0;
        x1 = x1 < other.x1 ? x1 : other.x1;
        y1 = y1 < other.y1 ? y1 : other.y1;
    }
};

/// The rectangle that triangles are drawn into, with its grid, broadcast to all lanes.
template <int N>
struct drawn_area {
    using ints = lanes<std::int32_t, N>;
    rect_lanes<N> pixels;
    ints half;    ///< half a pixel in sub-pixels
    ints before;  ///< half - 1
    int bits;     ///< of sub-pixels

    INSONIFY_INLINE drawn_area(const pixel_grid& grid, const rect& r)
        : pixels{ints{} + r.x0, ints{} + r.y0, ints{} + r.x1, ints{} + r.y1},
          half(ints{} + static_cast<std::int32_t>(grid.half())),
          before(half - 1),
          bits(grid.subpixel_bits) {}
};

inline constexpr std::int32_t small_limit = (1 << 15) - 1;

/// Whether a triangle of this extent in sub-pixels is drawn as a small one. This is a property of the triangle alone:
/// quick depths of small triangles are rounded differently, and must not depend on the triangles around it.
inline bool is_small(std::int64_t width, std::int64_t height) {
    return (width | height) < small_limit;
}

/// Whether a triangle is more than 2^12 times as long as wide. In float, weights have an error of 2^-24 of its length
/// squared, and so have its quick depths; neither is small beside its area then. It becomes a wide triangle, whose
/// weights and depths are computed in double.
/// @param area  twice the area
inline bool is_sliver(std::int64_t width, std::int64_t height, std::int64_t area) {
    return (width * width + height * height) >> 12 > numeric::abs(area);
}

/// The vertices of N triangles and their bounding boxes.
template <int N>
struct triangle_lanes {
    using ints = lanes<std::int32_t, N>;
    ints ax, ay, bx, by, cx, cy;
    ints west, north, east, south;

    /// @param read  read(i, x, y) sets the position of vertex i of each triangle
    template <class Read>
    INSONIFY_INLINE explicit triangle_lanes(const Read& read) {
        read(0, ax, ay);
        read(1, bx, by);
        read(2, cx, cy);
        range_of(west, east, ax, bx, cx);
        range_of(north, south, ay, by, cy);
    }

    INSONIFY_INLINE bool are_on_grid() const { return !any(ints(west == grid_position::off_grid)); }
    /// Whether all of them are small, see is_small; they must be on the grid.
    INSONIFY_INLINE bool are_small() const { return !any(ints(((east - west) | (south - north)) >= small_limit)); }
    /// Twice the areas, positive for clockwise on the screen; only of small triangles.
    INSONIFY_INLINE void area(ints& into) const { into = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax); }
    /// The same as is_sliver, only of small triangles: both squares are below 2^30.
    /// @param area  twice the areas
    INSONIFY_INLINE void is_sliver(const ints& area, ints& into) const {
        const ints width = east - west, height = south - north, twice = area < 0 ? 0 - area : area;
        into = ints((width * width + height * height) >> 12 > twice);
    }

    /// The pixels whose centres lie in the bounding boxes, see pixel_grid::first_centre.
    INSONIFY_INLINE void centres(const drawn_area<N>& area, rect_lanes<N>& into) const {
        into.x0 = (west + area.before) >> area.bits;
        into.y0 = (north + area.before) >> area.bits;
        into.x1 = (east + area.before) >> area.bits;
        into.y1 = (south + area.before) >> area.bits;
    }
};

/// Edge functions and pixels of N small triangles, in memory: the pixel loop reads them one by one.
template <int N>
struct small_setup {
    using ints = lanes<std::int32_t, N>;
    struct edge_lanes {
        std::int32_t origin[static_cast<unsigned>(N)], dx[static_cast<unsigned>(N)], dy[static_cast<unsigned>(N)];
    };
    edge_lanes bc, ca, ab;
    std::int32_t x0[static_cast<unsigned>(N)], y0[static_cast<unsigned>(N)], x1[static_cast<unsigned>(N)],
        y1[static_cast<unsigned>(N)];
    std::int32_t right[static_cast<unsigned>(N)], down[static_cast<unsigned>(N)];  ///< from a to the first centre

    /// @param t  vertices in clockwise order
    INSONIFY_INLINE small_setup(const triangle_lanes<N>& t, const drawn_area<N>& area) {
        rect_lanes<N> pixels;
        t.centres(area, pixels);
        pixels.intersect(area.pixels);
        store(x0, pixels.x0);
        store(y0, pixels.y0);
        store(x1, pixels.x1);
        store(y1, pixels.y1);
        const ints x = (pixels.x0 << area.bits) + area.half, y = (pixels.y0 << area.bits) + area.half;
        store(right, ints(x - t.ax));
        store(down, ints(y - t.ay));
        edge(bc, t.bx, t.by, t.cx, t.cy, x, y, area.bits);
        edge(ca, t.cx, t.cy, t.ax, t.ay, x, y, area.bits);
        edge(ab, t.ax, t.ay, t.bx, t.by, x, y, area.bits);
    }

  private:
    INSONIFY_INLINE static void edge(edge_lanes& e, const ints& from_x, const ints& from_y, const ints& to_x,
                                     const ints& to_y, const ints& x, const ints& y, int bits) {
        const ints edge_x = to_x - from_x, edge_y = to_y - from_y, none = ints{};
        const ints top_left = ints((edge_y < none) | ((edge_y == none) & (edge_x > none)));
        const ints inner = top_left ? none : none - 1;
        store(e.origin, ints((edge_x * (y - from_y) - edge_y * (x - from_x) + inner) >> bits));
        store(e.dx, ints(none - edge_y));
        store(e.dy, edge_x);
    }
};

/// Depth planes of N small triangles, in memory. Real is double for exact depths and float for quick ones.
template <int N, class Real>
struct small_planes {
    static constexpr bool exact = std::is_same_v<Real, double>;
    using reals = lanes<Real, N>;
    static constexpr auto count = static_cast<std::size_t>(N);

    Real z[count];              ///< at vertex a
    Real dx[count], dy[count];  ///< per sub-pixel
    Real error[count];          ///< bound, see depth_plane; only of exact planes
    float lowest[count], highest[count];

    /// @param t     vertices in clockwise order
    /// @param area  twice the triangles' areas in squared sub-pixels; planes of triangles without area are not read
    INSONIFY_INLINE small_planes(const triangle_lanes<N>& t, const lanes<std::int32_t, N>& area, const reals& az,
                                 const reals& bz, const reals& cz) {
        reals bx, by, cx, cy, scale;
        convert(bx, t.bx - t.ax);
        convert(by, t.by - t.ay);
        convert(cx, t.cx - t.ax);
        convert(cy, t.cy - t.ay);
        convert(scale, area);
        scale = Real{1} / scale;
        const reals b_dz = bz - az, c_dz = cz - az;
        store(z, az);
        store(dx, reals(scale * (b_dz * cy - c_dz * by)));
        store(dy, reals(scale * (c_dz * bx - b_dz * cx)));

        reals low, high;
        range_of(low, high, az, bz, cz);
        lanes<float, N> narrow;
        convert(narrow, low);
        store(lowest, narrow);
        convert(narrow, high);
        store(highest, narrow);
        if constexpr (exact) {
            // See depth_plane::through.
            reals wide, tall;
            convert(wide, t.east - t.west);
            convert(tall, t.south - t.north);
            const reals above = high < 0.0 ? 0.0 - high : high, below = low < 0.0 ? 0.0 - low : low;
            const reals largest = above > below ? above : below;
            store(error, reals(0x1p-49 * (4 * (high - low) * wide * tall * scale + largest)));
        }
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
