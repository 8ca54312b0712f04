// Depths of small triangles: the set-up of several planes at a time, one per lane, and their values along a row.
//
// In double they are depth.hpp's planes, with a bound of the error, so that depths come out correctly rounded. In float
// they are off by a few units in the last place of the largest corner's depth, held between the corners' depths, and
// cost a third less. Both give a pixel the same depth whichever tile asks.
#pragma once

#include <insonify/raster/detail/small.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Planes through the corners of N small triangles, in memory.
template <int N, class Real>
struct small_planes {
    static constexpr bool exact = std::is_same_v<Real, double>;
    using reals = lanes<Real, N>;
    static constexpr auto count = static_cast<std::size_t>(N);

    Real z[count];              ///< at corner a
    Real dx[count], dy[count];  ///< per sub-pixel
    Real error[count];          ///< bound of what a value is off by; only of exact ones
    float lowest[count], highest[count];

    /// @param at    corners in clockwise order
    /// @param area  twice the triangles' areas in squared sub-pixels; what has none is never asked for
    INSONIFY_INLINE small_planes(const corner_lanes<N>& at, const lanes<std::int32_t, N>& area, const reals& az,
                                 const reals& bz, const reals& cz) {
        reals bx, by, cx, cy, scale;
        convert(bx, at.bx - at.ax);
        convert(by, at.by - at.ay);
        convert(cx, at.cx - at.ax);
        convert(cy, at.cy - at.ay);
        convert(scale, area);
        scale = Real{1} / scale;
        const reals b_rise = bz - az, c_rise = cz - az;
        store(z, az);
        store(dx, reals(scale * (b_rise * cy - c_rise * by)));
        store(dy, reals(scale * (c_rise * bx - b_rise * cx)));

        reals low = az < bz ? az : bz, high = az > bz ? az : bz;
        low = low < cz ? low : cz;
        high = high > cz ? high : cz;
        lanes<float, N> narrow;
        convert(narrow, low);
        store(lowest, narrow);
        convert(narrow, high);
        store(highest, narrow);
        if constexpr (exact) {
            // See depth_plane::through.
            reals wide, tall;
            convert(wide, at.east - at.west);
            convert(tall, at.south - at.north);
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
