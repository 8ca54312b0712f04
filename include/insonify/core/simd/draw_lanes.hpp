// Random floats, 16 or 32 at a time, for image noise.
//
// The law is that of the draws in random.hpp to a float's rounding: a normal draw is off by less than 6e-7 of what
// exact arithmetic makes of its two words, and no probability by more than 6e-8. Same bits at every N.
#pragma once

#include <insonify/core/simd/dispatch.hpp>
#include <insonify/core/simd/random_lanes.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Which of N blocks lane k of their words and draws belongs to, so that store_draws gets by with shuffles inside of
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
        // The first words count past 2^32 as they should: the rounds don't look at upper halves.
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

/// Words as whole numbers from -2^31 to 2^31 - 1, rounded to floats.
template <int N>
INSONIFY_INLINE void signed_float(lanes<float, N>& into, const lanes<std::uint32_t, N>& bits) {
    convert(into, lanes<std::int32_t, N>(bits));
}

/// Uniform in [-1, 1], symmetric to 2^-32.
template <int N>
INSONIFY_INLINE void symmetric_lanes(lanes<float, N>& into, const lanes<std::uint32_t, N>& word) {
    signed_float<N>(into, word ^ std::uint32_t{0x80000000u});
    into = into * 0x1p-31f;
}

/// Uniform in (0, 1]: 31 bits, rounded to 24.
template <int N>
INSONIFY_INLINE void unit_lanes(lanes<float, N>& into, const lanes<std::uint32_t, N>& word) {
    signed_float<N>(into, word >> 1);
    into = (into + 0.5f) * 0x1p-31f;
}

/// ln(2^k (1 + f)) for whole k and sqrt(1/2) - 1 <= f <= sqrt(2) - 1, relative error below 2e-7; the sum of
/// numeric::log.
template <int N>
INSONIFY_INLINE void log_lanes(lanes<float, N>& into, const lanes<float, N>& k, const lanes<float, N>& f) {
    using floats = lanes<float, N>;
    const floats s = f / (f + 2.0f);
    const floats t = s * s;
    const floats tail = t * (2 / 3.0f + t * (2 / 5.0f + t * (2 / 7.0f + t * (2 / 9.0f))));
    const floats half_square = 0.5f * f * f;
    constexpr float ln2_high = 0x1.62ep-1f, ln2_low = 0x1.0bfbe8p-15f;
    into = k * ln2_high - ((half_square - (s * (half_square + tail) + k * ln2_low)) - f);
}

/// ln u of u = (word + 1/2) / 2^32; next to 1, where the logarithm is small, it is as exact as next to 0.
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

/// Cosine and sine of word / 2^32 turns, absolute error below 1.2e-7.
template <int N>
INSONIFY_INLINE void circle_lanes(lanes<float, N>& cosine, lanes<float, N>& sine, const lanes<std::uint32_t, N>& word) {
    using floats = lanes<float, N>;
    using words = lanes<std::uint32_t, N>;
    // The two leading bits of this are the nearest quarter, the rest of the word is what is left of the angle.
    const words quarter = word + std::uint32_t{0x20000000u};
    floats angle;
    signed_float<N>(angle, word << 2);
    angle = angle * static_cast<float>(2 * numeric::pi / 0x1p34);
    const floats t = angle * angle;
    const floats odd = angle + angle * t * (-1 / 6.0f + t * (1 / 120.0f + t * (-1 / 5040.0f + t * (1 / 362880.0f))));
    const floats even = 1.0f + t * (-0.5f + t * (1 / 24.0f + t * (-1 / 720.0f + t * (1 / 40320.0f))));
    const auto is_odd = (quarter & std::uint32_t{0x40000000u}) != 0;
    floats first = is_odd ? odd : even, second = is_odd ? even : odd;
    words bits;
    std::memcpy(&bits, &first, sizeof bits);
    bits = bits ^ ((quarter + std::uint32_t{0x40000000u}) & std::uint32_t{0x80000000u});
    std::memcpy(&cosine, &bits, sizeof bits);
    std::memcpy(&bits, &second, sizeof bits);
    bits = bits ^ (quarter & std::uint32_t{0x80000000u});
    std::memcpy(&sine, &bits, sizeof bits);
}

/// sqrt(-2 ln u) of a uniform number: 0 to 6.66.
template <int N>
INSONIFY_INLINE void radius_lanes(lanes<float, N>& into, const lanes<std::uint32_t, N>& word) {
    log_uniform_lanes<N>(into, word);
    square_root<N>(into, -2.0f * into);
}

/// Two independent standard normal draws of two words, as normal_pair's.
template <int N>
INSONIFY_INLINE void normal_lanes(lanes<float, N>& first, lanes<float, N>& second, const lanes<std::uint32_t, N>& a,
                                  const lanes<std::uint32_t, N>& b) {
    lanes<float, N> radius;
    radius_lanes<N>(radius, a);
    circle_lanes<N>(first, second, b);
    first = radius * first;
    second = radius * second;
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
