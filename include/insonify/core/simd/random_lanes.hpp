// SIMD versions of random.hpp: Philox blocks, uniform and normal draws, as doubles and as floats.
//
// Doubles are bit-identical to the draws of random.hpp. Floats have the same distribution up to rounding: a normal draw
// differs from exact arithmetic on its two words by less than 6e-7 within 4 sigma and 1.1e-6 at the far end, and no
// probability differs by more than 6e-8. Both give the same bits at every N.
#pragma once

#include <insonify/core/simd/dispatch.hpp>
#include <insonify/core/simd/elementary.hpp>
#include <insonify/core/simd/transpose.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Multiplies the lower halves of the lanes by a word. N is 2, 4 or 8 for SSE2, AVX2 and AVX-512: half as many as lanes
/// of 32 bits.
template <int N>
INSONIFY_INLINE void multiply_words(lanes<std::uint64_t, N>& into, const lanes<std::uint64_t, N>& a, std::uint32_t b) {
    // One instruction, which clang selects by itself and g++ does not.
#if INSONIFY_DISPATCH && INSONIFY_WHOLE_KERNELS && !defined(__clang__)
    using halves = lanes<std::int32_t, 2 * N>;
    const lanes<std::uint64_t, N> factor = lanes<std::uint64_t, N>{} + std::uint64_t{b};
    if constexpr (N == 8) {
        using signed_lanes = lanes<long long, N>;
        into = lanes<std::uint64_t, N>(__builtin_ia32_pmuludq512_mask(halves(a), halves(factor), signed_lanes{},
                                                                      static_cast<unsigned char>(0xFF)));
    } else if constexpr (N == 4) {
        into = lanes<std::uint64_t, N>(__builtin_ia32_pmuludq256(halves(a), halves(factor)));
    } else if constexpr (N == 2) {
        into = lanes<std::uint64_t, N>(__builtin_ia32_pmuludq128(halves(a), halves(factor)));
    } else
#endif
        into = (a & std::uint64_t{0xFFFFFFFFu}) * std::uint64_t{b};
}

/// Philox4x32-10 of `Count` times N counters under one key, in place; the lower half of each lane holds a word, the
/// upper half is unspecified. Several counters interleave, to hide the latency of the products.
template <int N, std::size_t Count>
INSONIFY_INLINE void philox_rounds(lanes<std::uint64_t, N> (&counter)[Count][4], std::uint32_t key_0,
                                   std::uint32_t key_1) {
    using words = lanes<std::uint64_t, N>;
    words keys_0 = words{} + std::uint64_t{key_0}, keys_1 = words{} + std::uint64_t{key_1};
    unroll<10>([&](int) INSONIFY_INLINE_LAMBDA {
        unroll<static_cast<int>(Count)>([&](int i) INSONIFY_INLINE_LAMBDA {
            words a, b;
            multiply_words<N>(a, counter[i][0], 0xD2511F53u);
            multiply_words<N>(b, counter[i][2], 0xCD9E8D57u);
            counter[i][0] = (b >> 32) ^ counter[i][1] ^ keys_0;
            counter[i][1] = b;
            counter[i][2] = (a >> 32) ^ counter[i][3] ^ keys_1;
            counter[i][3] = a;
        });
        keys_0 = keys_0 + std::uint64_t{0x9E3779B9u};
        keys_1 = keys_1 + std::uint64_t{0xBB67AE85u};
    });
}

/// The words of N counters under one key, Philox4x32-10, in place; each lane of 64 bits holds a word.
template <int N>
INSONIFY_INLINE void philox_lanes(lanes<std::uint64_t, N> (&counter)[4], std::uint32_t key_0, std::uint32_t key_1) {
    lanes<std::uint64_t, N> all[1][4] = {{counter[0], counter[1], counter[2], counter[3]}};
    philox_rounds<N, 1>(all, key_0, key_1);
    for (int i = 0; i < 4; ++i) counter[i] = all[0][i] & std::uint64_t{0xFFFFFFFFu};
}

/// See uniform_open.
template <int N>
INSONIFY_INLINE void uniform_lanes(lanes<double, N>& into, const lanes<std::uint64_t, N>& word) {
    to_double<N>(into, word);
    into = (into + 0.5) * 0x1p-32;
}

/// See normal_pair.
template <int N>
INSONIFY_INLINE void normal_lanes(lanes<double, N>& first, lanes<double, N>& second, const lanes<std::uint64_t, N>& a,
                                  const lanes<std::uint64_t, N>& b) {
    lanes<double, N> u, v, radius;
    uniform_lanes<N>(u, a);
    uniform_lanes<N>(v, b);
    log_lanes<N>(u, u);
    square_root<N>(radius, -2.0 * u);
    cos_sin_turns<N>(first, second, v);
    first = radius * first;
    second = radius * second;
}

/// The block, of N, that lane k of words and draws belongs to: an order in which store_draws needs no shuffle across
/// 128 bits.
template <int N>
constexpr int block_of_lane(int k) {
    return N / 4 * (k % 4) + k / 4;
}

/// The 4 N words of N blocks of Philox in a row: word[i] holds word i of each; see block_of_lane.
///
/// @param counter  of the first block; its first word counts up from block to block
template <int N>
INSONIFY_INLINE void philox_words(lanes<std::uint32_t, N> (&word)[4], const std::uint32_t (&counter)[4],
                                  std::uint32_t key_0, std::uint32_t key_1) {
    if constexpr (N == 1) {
        std::uint64_t block[4] = {counter[0], counter[1], counter[2], counter[3]};
        philox_lanes<1>(block, key_0, key_1);
        for (int i = 0; i < 4; ++i) word[i] = static_cast<std::uint32_t>(block[i]);
    } else {
        constexpr int half = N / 2;
        using doubled = lanes<std::uint64_t, half>;
        doubled step;
        gather<half>(step, [](int k) { return static_cast<std::uint64_t>(block_of_lane<N>(k / 2 * 4 + k % 2)); });
        // First words may exceed 2^32: the rounds ignore upper halves.
        const doubled first = step + std::uint64_t{counter[0]}, second = doubled{} + std::uint64_t{counter[1]},
                      third = doubled{} + std::uint64_t{counter[2]}, fourth = doubled{} + std::uint64_t{counter[3]};
        doubled block[2][4] = {{first, second, third, fourth}, {first + std::uint64_t{half}, second, third, fourth}};
        philox_rounds<half, 2>(block, key_0, key_1);
        using words = lanes<std::uint32_t, N>;
        unroll<4>([&](int i) INSONIFY_INLINE_LAMBDA {
            shuffle<N>(word[i], words(block[0][i]), words(block[1][i]),
                       [](int k) { return k % 4 / 2 * N + k / 4 * 4 + k % 2 * 2; });
        });
    }
}

/// 4 N draws in the order of their words: those of the first block, then those of the next.
template <int N>
INSONIFY_INLINE void store_draws(float* into, const lanes<float, N> (&draw)[4]) {
    if constexpr (N == 1) {
        for (int i = 0; i < 4; ++i) into[i] = draw[i];
    } else {
        lanes<float, N> row[4];
        transpose_fours<N>(row, draw);
        unroll<4>([&](int i) INSONIFY_INLINE_LAMBDA { store(into + i * N, row[i]); });
    }
}

/// Uniform in [-1, 1], symmetric to 2^-32.
template <int N>
INSONIFY_INLINE void symmetric_lanes(lanes<float, N>& into, const lanes<std::uint32_t, N>& word) {
    convert(into, lanes<std::int32_t, N>(word ^ std::uint32_t{0x80000000u}));
    into = into * 0x1p-31f;
}

/// Uniform in (0, 1]: 31 bits, rounded to 24.
template <int N>
INSONIFY_INLINE void unit_lanes(lanes<float, N>& into, const lanes<std::uint32_t, N>& word) {
    convert(into, lanes<std::int32_t, N>(word >> 1));
    into = (into + 0.5f) * 0x1p-31f;
}

/// ln u for u = (word + 1/2) / 2^32, relative error below 3e-7 both near 0 and near 1.
template <int N>
INSONIFY_INLINE void log_uniform_lanes(lanes<float, N>& into, const lanes<std::uint32_t, N>& word) {
    using floats = lanes<float, N>;
    using ints = lanes<std::int32_t, N>;
    constexpr std::int32_t root_half = 0x3F3504F3;  // the bits of sqrt(1/2)
    const ints upper = ints(word) >> 31;
    floats from_end;  // 0 or 1, whichever is closer
    convert(from_end, ints(word) ^ upper);
    from_end = (from_end + 0.5f) * 0x1p-32f;
    const floats u = upper != 0 ? 1.0f - from_end : from_end;
    ints bits;
    std::memcpy(&bits, &u, sizeof bits);
    const ints shifted = bits - root_half;
    floats k;
    convert(k, ints(shifted >> 23));
    const ints mantissa = (shifted & 0x007FFFFF) + root_half;
    floats m;
    std::memcpy(&m, &mantissa, sizeof m);
    log_lanes<N>(into, k, floats(shifted >= 0 ? 0.0f - from_end : m - 1.0f));
}

/// Two independent standard normal draws from two words, as `normal_pair`.
template <int N>
INSONIFY_INLINE void normal_lanes(lanes<float, N>& first, lanes<float, N>& second, const lanes<std::uint32_t, N>& a,
                                  const lanes<std::uint32_t, N>& b) {
    lanes<float, N> radius;
    log_uniform_lanes<N>(radius, a);
    square_root<N>(radius, -2.0f * radius);
    cos_sin_turns<N>(first, second, b);
    first = radius * first;
    second = radius * second;
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
