// Pixels of small triangles: several triangles' set-up at hand, one per lane.
//
// A triangle of a fine mesh covers two or three pixels. Rows of eight would mostly miss, so where a group's triangles
// are tiny, each lane walks over the box of its own triangle, and only the pixels that came out covered are compared
// with the tile, triangle after triangle. Others go row by row. Both ways give the same bits.
#pragma once

#include <insonify/raster/detail/small_depth.hpp>
#include <insonify/raster/detail/tile_buffer.hpp>

#include <bit>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Draws up to N small triangles into a tile, in order.
template <int N, class Real, bool Winners>
struct small_fill {
    const small_setup<N>& t;
    const small_planes<N, Real>& planes;
    int unit;  ///< sub-pixels a pixel
    tile_buffer<Winners>& tile;
    const std::uint32_t* names;
    int count;

    /// @param nearest  nearest(k, x, y): depth of triangle k where a double can't round it with certainty
    template <class Nearest>
    INSONIFY_INLINE void operator()(const Nearest& nearest) const {
        ints wide, tall;
        extent(wide, tall);
        if (!any(ints((wide > 2) | (tall > 2))))
            fill_boxes<3>(wide, tall, nearest);
        else if (!any(ints((wide > 3) | (tall > 3))))
            fill_boxes<4>(wide, tall, nearest);
        else
            for (int k = 0; k < count; ++k) fill_rows(k, nearest);
    }

  private:
    static constexpr bool exact = small_planes<N, Real>::exact;
    static constexpr int block = tile_buffer<Winners>::block;
    static constexpr auto lane_count = static_cast<std::size_t>(N);
    using ints = lanes<std::int32_t, N>;
    using floats = lanes<float, N>;
    using reals = lanes<Real, N>;

    /// Columns and rows of the boxes, without the first; lanes without a triangle have less than none.
    INSONIFY_INLINE void extent(ints& wide, ints& tall) const {
        ints first, last, number;
        load(first, t.x0);
        load(last, t.x1);
        wide = last - first;
        load(first, t.y0);
        load(last, t.y1);
        tall = last - first;
        count_up<std::int32_t, N>(number);
        wide = number < count ? wide : ints{} - 1;
    }

    /// Depths as the plane has them, and which of them it isn't sure of.
    INSONIFY_INLINE static void round(floats& z, ints& doubtful, const reals& plane, const reals& error) {
        if constexpr (exact) {
            floats above;
            convert(z, reals(plane - error));
            convert(above, reals(plane + error));
            doubtful = ints(z != above);
        } else {
            z = plane;
        }
    }

    /// What lies in N boxes: bit 4 row + column of a lane is about that pixel of its box, and so is the depth there.
    struct box_pixels {
        ints covered{}, doubtful{};
        float depth[static_cast<unsigned>(block * block * N)];
    };

    /// One pixel of N boxes at a time, each no larger than Size x Size.
    template <int Size, class Nearest>
    INSONIFY_INLINE void fill_boxes(const ints& wide, const ints& tall, const Nearest& nearest) const {
        static_assert(Size <= block);
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
        reals rise[static_cast<unsigned>(Size)];
        unroll<Size>([&](int column) INSONIFY_INLINE_LAMBDA {
            convert(rise[column], ints(right + column * unit));
            rise[column] = rise[column] * dx;
        });

        box_pixels found;
        unroll<Size>([&](int row) INSONIFY_INLINE_LAMBDA {
            ints bc_x = bc, ca_x = ca, ab_x = ab;
            reals drop;
            convert(drop, ints(down + row * unit));
            drop = z_a + dy * drop;
            unroll<Size>([&](int column) INSONIFY_INLINE_LAMBDA {
                const int pixel = row * block + column;
                const std::int32_t own = 1 << pixel;
                const ints bit = ints{} + own;
                const ints outside = bc_x | ca_x | ab_x | (wide - column) | (tall - row);
                found.covered |= outside >= 0 ? bit : ints{};
                floats z;
                ints in_doubt = ints{};
                round(z, in_doubt, rise[column] + drop, error);
                if constexpr (exact) found.doubtful |= in_doubt ? bit : ints{};
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
            found.doubtful &= found.covered;
            if (any(ints(found.doubtful != 0))) settle(found, nearest);
        }
        keep_covered(found);
    }

    /// Compares what is covered with the tile: triangle after triangle, so that who comes first keeps a tie.
    INSONIFY_INLINE void keep_covered(const box_pixels& found) const {
        std::uint32_t start[lane_count];
        ints x0, y0, index;
        load(x0, t.x0), load(y0, t.y0);
        tile.template index<N>(index, x0, y0);
        store(start, index);
        const std::uint32_t* const in_block = tile.in_block();
        float* const depths = tile.depths();
        std::uint32_t* const winners = tile.winners();
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
                // Unsigned throughout, so that no index has to be widened.
                const auto bit = static_cast<unsigned>(std::countr_zero(left));
                const std::size_t k = static_cast<unsigned>(word) * per_word + bit / pixels, pixel = bit % pixels;
                const std::size_t at = start[k] + in_block[pixel];
                const float z = found.depth[pixel * lane_count + k];
                if (!(z < depths[at])) continue;
                depths[at] = z;
                if constexpr (Winners) winners[at] = names[k];
            }
        });
    }

    template <class Nearest>
    INSONIFY_INLINE void settle(box_pixels& found, const Nearest& nearest) const {
        for (int k = 0; k < count; ++k)
            for (auto left = static_cast<std::uint32_t>(lane(found.doubtful, k)); left != 0; left &= left - 1) {
                const int pixel = std::countr_zero(left);
                const float z = nearest(k, t.x0[k] + pixel % block, t.y0[k] + pixel / block);
                found.depth[pixel * N + k] = (std::min)((std::max)(z, planes.lowest[k]), planes.highest[k]);
            }
    }

    /// Triangle k, N columns at a time. Most have no more: what is the same for those that follow is left alone for the
    /// first.
    template <class Nearest>
    INSONIFY_INLINE void fill_rows(int k, const Nearest& nearest) const {
        if (t.x0[k] > t.x1[k]) return;
        fill_columns(k, 0, nearest);
        for (int right = N; right <= t.x1[k] - t.x0[k]; right += N) fill_columns(k, right, nearest);
    }

    /// N columns of triangle k, `first` columns into its box, row by row. What is read in the loop is copied before:
    /// the compiler can't know that nothing of it is what the loop stores.
    template <class Nearest>
    INSONIFY_INLINE void fill_columns(int k, int first, const Nearest& nearest) const {
        ints at;
        count_up<std::int32_t, N>(at);
        at = at + first;
        ints bc = t.bc.origin[k] + at * t.bc.dx[k];
        ints ca = t.ca.origin[k] + at * t.ca.dx[k];
        ints ab = t.ab.origin[k] + at * t.ab.dx[k];
        const ints bc_dy = ints{} + t.bc.dy[k], ca_dy = ints{} + t.ca.dy[k], ab_dy = ints{} + t.ab.dy[k];
        reals rise, error{};
        convert(rise, ints(at * unit + t.right[k]));
        rise = rise * planes.dx[k];
        if constexpr (exact) error = error + planes.error[k];
        const Real z_a = planes.z[k], dy = planes.dy[k], step = static_cast<Real>(unit);
        const floats lowest = floats{} + planes.lowest[k], highest = floats{} + planes.highest[k];
        const lanes<std::uint32_t, N> drawn = lanes<std::uint32_t, N>{} + names[k];
        const int x = t.x0[k] + first, last = t.y1[k];
        const std::ptrdiff_t start = tile.index(x, t.y0[k]), stride = tile.stride();
        float* depth = tile.depths() + start;
        std::uint32_t* winner = Winners ? tile.winners() + start : nullptr;
        auto down = static_cast<Real>(t.down[k]);  // goes on exactly: whole numbers of few bits
        for (int y = t.y0[k]; y <= last; ++y) {
            const ints covered = ints((bc | ca | ab) >= 0);
            floats z;
            ints doubtful = ints{};
            round(z, doubtful, rise + (z_a + dy * down), error);
            if constexpr (exact) {
                doubtful &= covered;
                if (any(doubtful))
                    for (int i = 0; i < N; ++i)
                        if (lane(doubtful, i) != 0) set_lane(z, i, nearest(k, x + i, y));
            }
            z = z > lowest ? z : lowest;
            z = z < highest ? z : highest;
            keep_nearer<N, Winners>(depth, winner, covered, z, drawn);
            depth += stride;
            if constexpr (Winners) winner += stride;
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
