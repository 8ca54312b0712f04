// Depth between the vertices, correctly rounded: the float nearest to the plane through the three snapped corners.
//
// The plane is computed in double and goes with a bound of its error. Where that leaves two floats to choose from (near
// the middle between them, or on slivers, whose gradients are differences of almost equal numbers) the shares of the
// corners decide: they are integers, so the quotient is known to a hundred bits. That a pixel's depth doesn't depend on
// how it was reached follows from that.
//
// This work is based on:
// Abraham Ziv. Fast Evaluation of Elementary Mathematical Functions with Correctly Rounded Last Bit. 1991
#pragma once

#include <insonify/core/detail/double_double.hpp>
#include <insonify/raster/detail/setup.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// z(x, y) at pixel centres of a triangle's own box.
struct depth_plane {
    double x, y, z;         ///< the vertex it is anchored at, in pixels from the first pixel's centre
    double dx, dy;          ///< per pixel
    float lowest, highest;  ///< of the corners: nothing between them reaches out
    double error;           ///< bound of what the plane is off by, anywhere in the triangle's box

    /// @param area  twice the triangle's area in squared fixed-point units, positive
    static depth_plane through(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c, double area,
                               const pixel_grid& grid) {
        const auto unit = static_cast<double>(grid.unit()), pixel = 1 / unit;
        const double scale = unit / area;
        const double b_rise = b.z - a.z, c_rise = c.z - a.z;
        const auto bx = static_cast<double>(b.x - a.x), by = static_cast<double>(b.y - a.y);
        const auto cx = static_cast<double>(c.x - a.x), cy = static_cast<double>(c.y - a.y);
        const auto [lowest, highest] = std::minmax({a.z, b.z, c.z});
        depth_plane plane;
        plane.x = static_cast<double>(a.x - grid.half()) * pixel;
        plane.y = static_cast<double>(a.y - grid.half()) * pixel;
        plane.z = a.z;
        plane.dx = scale * (b_rise * cy - c_rise * by);
        plane.dy = scale * (c_rise * bx - b_rise * cx);
        plane.lowest = static_cast<float>(lowest);
        plane.highest = static_cast<float>(highest);

        // A gradient's two products are off by 2^-53 of themselves, and count as many times as the box is wide or high.
        const auto span = [](double u, double v) { return (std::max)({u, v, 0.0}) - (std::min)({u, v, 0.0}); };
        const double swing = 4 * (highest - lowest) * span(bx, cx) * span(by, cy);
        const double largest = (std::max)(numeric::magnitude(lowest), numeric::magnitude(highest)) * area;
        plane.error = 0x1p-49 * (swing + largest) / area;
        return plane;
    }

    /// The plane at the start of a pixel row, and along it: the same operations in every kernel, hence the same bits.
    double row(int py) const { return z + dy * (static_cast<double>(py) - y); }
};

/// Which share each corner has in a pixel's centre, times twice the area: exact.
struct corner_shares {
    int128 a, b, c;

    static corner_shares at(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c, int px, int py,
                            const pixel_grid& grid) {
        const auto opposite = [&](const screen_vertex& from, const screen_vertex& to) {
            return wide_side(to.x - from.x, to.y - from.y, grid.center(px) - from.x, grid.center(py) - from.y);
        };
        return {opposite(b, c), opposite(c, a), opposite(a, b)};
    }
};

/// The float nearest to the plane through three corners at a pixel that they cover.
inline float nearest_depth(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c, int px, int py,
                           const pixel_grid& grid) {
    const corner_shares share = corner_shares::at(a, b, c, px, py, grid);
    const auto wide = [](const int128& v) { return double_double::from(v); };
    const double_double sum = wide(share.a) * a.z + wide(share.b) * b.z + wide(share.c) * c.z;
    return (sum / wide(share.a + share.b + share.c)).to_float();
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
