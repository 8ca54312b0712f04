// Fills small triangles into a tile, N at a time.
//
// A triangle of a fine mesh covers two or three pixels, so rows of eight would mostly miss. Where all triangles of a
// group are tiny, each lane evaluates the pixels of its own triangle, and only covered pixels are compared with the
// tile, triangle after triangle. Larger ones are filled row by row. Both ways give the same bits.
#pragma once

#include <insonify/raster/detail/small_setup.hpp>
#include <insonify/raster/detail/tile_buffer.hpp>

#include <bit>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Fills up to N small triangles, in order.
template <int N, class Real, bool HasIds>
struct small_fill {
    const small_setup<N>& t;
    const small_planes<N, Real>& planes;
    int unit;  ///< sub-pixels of a pixel
    tile_buffer<HasIds>& tile;
    const std::uint32_t* ids;
    int count;

    /// @param rounded_depth  rounded_depth(k, x, y): depth of triangle k where a double can't round it with certainty
    template <class RoundedDepth>
    INSONIFY_INLINE void operator()(const RoundedDepth& rounded_depth) const {
        ints width, height;
        extent(width, height);
        if (!any(ints((width > side) | (height > side))))
            fill_blocks(width, height, rounded_depth);
        else
            for (int k = 0; k < count; ++k) fill_rows(k, rounded_depth);
    }

  private:
    static constexpr bool exact = small_planes<N, Real>::exact;
    static constexpr int side = 3, block = tile_buffer<HasIds>::block;  ///< pixels of blocks, and their stride
    static constexpr auto lane_count = static_cast<std::size_t>(N);
    using ints = lanes<std::int32_t, N>;
    using floats = lanes<float, N>;
    using reals = lanes<Real, N>;

    /// Columns and rows of each lane's pixels; no columns in lanes without a triangle.
    INSONIFY_INLINE void extent(ints& width, ints& height) const {
        ints first, end, number;
        load(first, t.x0);
        load(end, t.x1);
        width = end - first;
        load(first, t.y0);
        load(end, t.y1);
        height = end - first;
        iota<std::int32_t, N>(number);
        width = number < count ? width : ints{};
    }

    /// Rounds depths to float, and marks those that the plane's error leaves ambiguous.
    INSONIFY_INLINE static void round(floats& z, ints& ambiguous, const reals& plane, const reals& error) {
        if constexpr (exact) {
            floats above;
            convert(z, reals(plane - error));
            convert(above, reals(plane + error));
            ambiguous = ints(z != above);
        } else {
            z = plane;
        }
    }

    /// The pixels of N blocks, one per lane: bit 4 row + column of a mask is that pixel of the lane's block.
    struct block_pixels {
        ints covered{}, ambiguous{};
        float depth[static_cast<unsigned>(block * block * N)];
    };

    /// Evaluates one pixel of all triangles at a time, each no larger than side x side pixels.
    template <class RoundedDepth>
    INSONIFY_INLINE void fill_blocks(const ints& width, const ints& height, const RoundedDepth& rounded_depth) const {
        static_assert(side <= block);
        ints bc, bc_dx, bc_dy, ca, ca_dx, ca_dy, ab, ab_dx, ab_dy, right, down;
        load(bc, t.bc.origin), load(bc_dx, t.bc.dx), load(bc_dy, t.bc.dy);
        load(ca, t.ca.origin), load(ca_dx, t.ca.dx), load(ca_dy, t.ca.dy);
        load(ab, t.ab.origin), load(ab_dx, t.ab.dx), load(ab_dy, t.ab.dy);
        load(right, t.right), load(down, t.down);
        reals z_a, dx, dy, error{};
        load(z_a, planes.z), load(dx, planes.dx), load(dy, planes.dy);
        if constexpr (exact) load(error, planes.error);
        floats lowest, highest;
        load(lowest, planes.lowest), load(highest, planes.highest);
        const ints last_column = width - 1, last_row = height - 1;
        reals z_across[static_cast<unsigned>(side)];
        unroll<side>([&](int column) INSONIFY_INLINE_LAMBDA {
            convert(z_across[column], ints(right + column * unit));
            z_across[column] = z_across[column] * dx;
        });

        block_pixels found;
        unroll<side>([&](int row) INSONIFY_INLINE_LAMBDA {
            ints bc_x = bc, ca_x = ca, ab_x = ab;
            reals z_down;
            convert(z_down, ints(down + row * unit));
            z_down = z_a + dy * z_down;
            unroll<side>([&](int column) INSONIFY_INLINE_LAMBDA {
                const int pixel = row * block + column;
                const std::int32_t mask = 1 << pixel;
                const ints bit = ints{} + mask;
                const ints outside = bc_x | ca_x | ab_x | (last_column - column) | (last_row - row);
                found.covered |= outside >= 0 ? bit : ints{};
                floats z;
                ints ambiguous = ints{};
                round(z, ambiguous, z_across[column] + z_down, error);
                if constexpr (exact) found.ambiguous |= ambiguous ? bit : ints{};
                z = z > lowest ? z : lowest;
                z = z < highest ? z : highest;
                store(found.depth + pixel * N, z);
                bc_x += bc_dx;
                ca_x += ca_dx;
                ab_x += ab_dx;
            });
            bc += bc_dy;
            ca += ca_dy;
            ab += ab_dy;
        });
        if constexpr (exact) {
            found.ambiguous &= found.covered;
            if (any(ints(found.ambiguous != 0))) resolve(found, rounded_depth);
        }
        test_covered(found);
    }

    /// The depth test of covered pixels: triangle after triangle, so that the first one keeps a tie.
    INSONIFY_INLINE void test_covered(const block_pixels& found) const {
        std::uint32_t start[lane_count];
        ints x0, y0, index;
        load(x0, t.x0), load(y0, t.y0);
        tile.template index<N>(index, x0, y0);
        store(start, index);
        const std::uint32_t* const offsets = tile.block_offsets();
        float* const depths = tile.depths();
        std::uint32_t* const shown = tile.ids();
        // Sixteen bits a triangle, four triangles a word.
        constexpr unsigned pixels = block * block, per_word = 64 / pixels;
        constexpr int word_count = (N + static_cast<int>(per_word) - 1) / static_cast<int>(per_word);
        lanes<std::uint16_t, N> bits;
        convert(bits, found.covered);
        std::uint64_t words[static_cast<unsigned>(word_count)] = {};
        if constexpr (N == 1)
            words[0] = bits;
        else
            std::memcpy(words, &bits, sizeof bits);
        unroll<word_count>([&](int word) INSONIFY_INLINE_LAMBDA {
            for (std::uint64_t left = words[word]; left != 0; left &= left - 1) {
                // Unsigned throughout: indices need no sign extension.
                const auto bit = static_cast<unsigned>(std::countr_zero(left));
                const std::size_t k = static_cast<unsigned>(word) * per_word + bit / pixels, pixel = bit % pixels;
                const std::size_t at = start[k] + offsets[pixel];
                const float z = found.depth[pixel * lane_count + k];
                if (!(z < depths[at])) continue;
                depths[at] = z;
                if constexpr (HasIds) shown[at] = ids[k];
            }
        });
    }

    template <class RoundedDepth>
    INSONIFY_INLINE void resolve(block_pixels& found, const RoundedDepth& rounded_depth) const {
        for (int k = 0; k < count; ++k)
            for (auto left = static_cast<std::uint32_t>(lane(found.ambiguous, k)); left != 0; left &= left - 1) {
                const int pixel = std::countr_zero(left);
                const float z = rounded_depth(k, t.x0[k] + pixel % block, t.y0[k] + pixel / block);
                found.depth[pixel * N + k] = (std::min)((std::max)(z, planes.lowest[k]), planes.highest[k]);
            }
    }

    /// Triangle k, N columns at a time; most triangles have no more.
    template <class RoundedDepth>
    INSONIFY_INLINE void fill_rows(int k, const RoundedDepth& rounded_depth) const {
        if (t.x0[k] >= t.x1[k]) return;
        fill_columns(k, 0, rounded_depth);
        for (int right = N; right < t.x1[k] - t.x0[k]; right += N) fill_columns(k, right, rounded_depth);
    }

    /// N columns of triangle k, `first` columns into its pixels, row by row. The loop reads local copies, so that its
    /// stores cannot alias them.
    template <class RoundedDepth>
    INSONIFY_INLINE void fill_columns(int k, int first, const RoundedDepth& rounded_depth) const {
        ints at;
        iota<std::int32_t, N>(at);
        at = at + first;
        ints bc = t.bc.origin[k] + at * t.bc.dx[k];
        ints ca = t.ca.origin[k] + at * t.ca.dx[k];
        ints ab = t.ab.origin[k] + at * t.ab.dx[k];
        const ints bc_dy = ints{} + t.bc.dy[k], ca_dy = ints{} + t.ca.dy[k], ab_dy = ints{} + t.ab.dy[k];
        reals z_across, error{};
        convert(z_across, ints(at * unit + t.right[k]));
        z_across = z_across * planes.dx[k];
        if constexpr (exact) error = error + planes.error[k];
        const Real z_a = planes.z[k], dy = planes.dy[k], step = static_cast<Real>(unit);
        const floats lowest = floats{} + planes.lowest[k], highest = floats{} + planes.highest[k];
        const lanes<std::uint32_t, N> drawn = lanes<std::uint32_t, N>{} + ids[k];
        const int x = t.x0[k] + first, end = t.y1[k];
        const std::ptrdiff_t stride = tile.stride();
        float* depth = tile.depth_at(x, t.y0[k]);
        std::uint32_t* shown = tile.id_at(x, t.y0[k]);
        auto down = static_cast<Real>(t.down[k]);  // increments exactly: integers of few bits
        for (int y = t.y0[k]; y < end; ++y) {
            const ints covered = ints((bc | ca | ab) >= 0);
            floats z;
            ints ambiguous = ints{};
            round(z, ambiguous, z_across + (z_a + dy * down), error);
            if constexpr (exact) {
                ambiguous &= covered;
                if (any(ambiguous))
                    for (int i = 0; i < N; ++i)
                        if (lane(ambiguous, i) != 0) set_lane(z, i, rounded_depth(k, x + i, y));
            }
            z = z > lowest ? z : lowest;
            z = z < highest ? z : highest;
            test_depth<N, HasIds>(depth, shown, covered, z, drawn);
            depth += stride;
            if constexpr (HasIds) shown += stride;
            down += step;
            bc += bc_dy;
            ca += ca_dy;
            ab += ab_dy;
        }
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
