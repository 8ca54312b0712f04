// Loads rows of two, three or four values and transposes them into lanes.
#pragma once

#include <insonify/core/simd/lanes.hpp>

#include <cstdint>
#include <cstring>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Whether arrays of a vector of three values have no padding. GLM's aligned types have some.
template <class Vector>
inline constexpr bool is_packed = sizeof(Vector) == 3 * sizeof(std::declval<Vector&>().x);

/// Gathers pairs of adjacent 32-bit values: lane k of `first` and of `second` are the two values at from(k).
template <int N, class Lanes, class From>
INSONIFY_INLINE void gather_pairs(Lanes& first, Lanes& second, const From& from) {
#if INSONIFY_SIMD
    if constexpr (N > 1) {
        // Pairs 0 1 4 5 ... and 2 3 6 7 ...: so both shuffles stay within sixteen bytes, where they are cheap.
        constexpr int half = N / 2, run = half < 2 ? half : 2;
        lanes<std::int64_t, half> low, high;
        const auto pair = [&](int k) INSONIFY_INLINE_LAMBDA {
            std::int64_t bits;
            std::memcpy(&bits, from(k), sizeof bits);
            return bits;
        };
        gather<half>(low, [&](int k) INSONIFY_INLINE_LAMBDA { return pair(k / run * 2 * run + k % run); });
        gather<half>(high, [&](int k) INSONIFY_INLINE_LAMBDA { return pair((k / run * 2 + 1) * run + k % run); });
        [&]<int... I>(std::integer_sequence<int, I...>) INSONIFY_INLINE_LAMBDA {
            constexpr auto at = [](int k) { return k / run % 2 * N + k / (2 * run) * 2 * run + k % run * 2; };
            pick<at(I)...>(first, Lanes(low), Lanes(high));
            pick<(at(I) + 1)...>(second, Lanes(low), Lanes(high));
        }
        (std::make_integer_sequence<int, N>{});
    } else
#endif
    {
        std::memcpy(&first, from(0), sizeof first);
        std::memcpy(&second, from(0) + 1, sizeof second);
    }
}

#if INSONIFY_SIMD
/// Loads four values from each of N / 4 addresses.
template <int N, class From>
INSONIFY_INLINE void load_fours(lanes<float, N>& into, const From& from) {
    if constexpr (N == 4) {
        load(into, from(0));
    } else {
        lanes<float, N / 2> low, high;
        load_fours<N / 2>(low, from);
        load_fours<N / 2>(high, [&](int i) { return from(N / 8 + i); });
        join<N>(into, low, high);
    }
}

/// Within every four lanes, lane i of row[k] becomes lane k of into[i]; for N of 4, 8 or 16.
template <int N>
INSONIFY_INLINE void transpose_fours(lanes<float, N>* into, const lanes<float, N> (&row)[4]) {
    lanes<float, N> low[2], high[2];
    unroll<2>([&](int k) INSONIFY_INLINE_LAMBDA {
        const auto &a = row[2 * k], &b = row[2 * k + 1];
        shuffle<N>(low[k], a, b, [](int i) { return i % 2 * N + i / 4 * 4 + i % 4 / 2; });
        shuffle<N>(high[k], a, b, [](int i) { return i % 2 * N + i / 4 * 4 + i % 4 / 2 + 2; });
    });
    unroll<2>([&](int k) INSONIFY_INLINE_LAMBDA {
        const auto &a = k == 0 ? low[0] : high[0], &b = k == 0 ? low[1] : high[1];
        shuffle<N>(into[2 * k], a, b, [](int i) { return i % 4 / 2 * N + i / 4 * 4 + i % 2; });
        shuffle<N>(into[2 * k + 1], a, b, [](int i) { return i % 4 / 2 * N + i / 4 * 4 + i % 2 + 2; });
    });
}
#endif

/// Transposes N rows of four floats: lane k of into[i] is rows(k)[i]; N is 1, 4, 8 or 16.
template <int N, class Rows>
INSONIFY_INLINE void transpose(lanes<float, N>* into, const Rows& rows) {
#if INSONIFY_SIMD
    if constexpr (N > 1) {
        // Groups of four lanes are transposed independently.
        lanes<float, N> row[4];
        unroll<4>([&](int k) INSONIFY_INLINE_LAMBDA { load_fours<N>(row[k], [&](int i) { return rows(k + 4 * i); }); });
        transpose_fours<N>(into, row);
    } else
#endif
        std::memcpy(into, rows(0), 4 * sizeof(float));
}

#if INSONIFY_SIMD
/// Transposes four consecutive rows of three floats.
template <class Vector>
INSONIFY_INLINE void transpose_threes(lanes<float, 4> (&into)[3], const Vector* rows) {
    if constexpr (!is_packed<Vector>) {
        lanes<float, 4> padded[4];
        transpose<4>(padded, [&](int k) { return &rows[k].x; });
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA { into[i] = padded[i]; });
        return;
    }
    lanes<float, 4> a, b, c;  // xyzx yzxy zxyz
    const float* const values = &rows->x;
    load(a, values), load(b, values + 4), load(c, values + 8);
    lanes<float, 4> xy, yz;
    pick<2, 5, 3, 6>(xy, b, c);
    pick<1, 4, 2, 5>(yz, a, b);
    pick<0, 3, 4, 5>(into[0], a, xy);
    pick<0, 1, 6, 7>(into[1], yz, xy);
    pick<2, 3, 4, 7>(into[2], yz, c);
}
#endif

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
