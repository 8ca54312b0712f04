// Fills a triangle of any size into a tile, row by row: coverage, depth, depth test. See small_fill.hpp for small ones.
#pragma once

#include <insonify/raster/detail/setup.hpp>
#include <insonify/raster/detail/tile_buffer.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Fills one triangle of any size, N pixels of a row at a time. Where Exact, depths that a double cannot round with
/// certainty are replaced by `rounded_depth(x, y)`.
template <int N, class Int, bool HasIds, bool Exact, class RoundedDepth>
INSONIFY_INLINE void fill(const triangle_setup& t, tile_buffer<HasIds>& tile, std::uint32_t id,
                          const RoundedDepth& rounded_depth) {
    using ints = lanes<Int, N>;
    using floats = lanes<float, N>;
    using doubles = lanes<double, N>;
    using masks = lanes<std::int32_t, N>;
    ints column;
    doubles column_x;
    iota<Int, N>(column);
    iota<double, N>(column_x);
    const floats lowest = floats{} + t.depth.lowest, highest = floats{} + t.depth.highest;
    const doubles error = doubles{} + t.depth.error;
    const lanes<std::uint32_t, N> drawn = lanes<std::uint32_t, N>{} + id;

    ints row_bc = static_cast<Int>(t.bc.origin) + column * static_cast<Int>(t.bc.dx);
    ints row_ca = static_cast<Int>(t.ca.origin) + column * static_cast<Int>(t.ca.dx);
    ints row_ab = static_cast<Int>(t.ab.origin) + column * static_cast<Int>(t.ab.dx);

    for (int y = t.pixels.y0; y < t.pixels.y1; ++y) {
        const double row_z = t.depth.row(y);
        float* const depths = tile.depth_at(t.pixels.x0, y);
        std::uint32_t* const ids = tile.id_at(t.pixels.x0, y);
        ints bc = row_bc, ca = row_ca, ab = row_ab;
        bool entered = false;
        for (int x = t.pixels.x0; x < t.pixels.x1; x += N) {
            masks covered;
            convert(covered, ints((bc | ca | ab) >= 0));
            bc += static_cast<Int>(N * t.bc.dx);
            ca += static_cast<Int>(N * t.ca.dx);
            ab += static_cast<Int>(N * t.ab.dx);
            if (!any(covered)) {
                if (entered) break;  // the covered pixels of a row are contiguous
                continue;
            }
            entered = true;
            const doubles plane = row_z + t.depth.dx * (column_x + (static_cast<double>(x) - t.depth.x));
            floats z;
            convert(z, plane);
            if constexpr (Exact) {
                floats below, above;
                convert(below, doubles(plane - error));
                convert(above, doubles(plane + error));
                const masks ambiguous = covered & masks(below != above);
                if (any(ambiguous))
                    for (int i = 0; i < N; ++i)
                        if (lane(ambiguous, i) != 0) set_lane(z, i, rounded_depth(x + i, y));
            }
            z = z > lowest ? z : lowest;
            z = z < highest ? z : highest;
            const std::ptrdiff_t at = x - t.pixels.x0;
            test_depth<N, HasIds>(depths + at, HasIds ? ids + at : nullptr, covered, z, drawn);
        }
        row_bc += static_cast<Int>(t.bc.dy);
        row_ca += static_cast<Int>(t.ca.dy);
        row_ab += static_cast<Int>(t.ab.dy);
    }
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
