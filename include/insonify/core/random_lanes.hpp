// The numbers of random.hpp, several at a time and to the same bits: blocks of Philox, uniform and normal draws.
#pragma once

#include <insonify/core/lanes.hpp>
#include <insonify/core/numeric.hpp>

#include <numbers>

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // wide vectors stay inside always-inlined code
#endif

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::detail {

/// The words of N counters under one key, Philox4x32-10, in place; each lane of 64 bits holds a word.
template <int N>
INSONIFY_INLINE void philox_lanes(lanes<std::uint64_t, N> (&counter)[4], std::uint32_t key_0, std::uint32_t key_1) {
    using words = lanes<std::uint64_t, N>;
    const words low = words{} + std::uint64_t{0xFFFFFFFFu};
    for (int round = 0; round < 10; ++round) {
        const words a = counter[0] * std::uint64_t{0xD2511F53u}, b = counter[2] * std::uint64_t{0xCD9E8D57u};
        counter[0] = (b >> 32) ^ counter[1] ^ std::uint64_t{key_0};
        counter[1] = b & low;
        counter[2] = (a >> 32) ^ counter[3] ^ std::uint64_t{key_1};
        counter[3] = a & low;
        key_0 += 0x9E3779B9u;
        key_1 += 0xBB67AE85u;
    }
}

/// A number below 2^52 as a double: put where a double of 2^52 has its last bits, it becomes that much more.
template <int N>
INSONIFY_INLINE void to_double(lanes<double, N>& into, const lanes<std::uint64_t, N>& number) {
    const lanes<std::uint64_t, N> bits = number | std::uint64_t{0x4330000000000000u};
    std::memcpy(&into, &bits, sizeof into);
    into = into - 0x1p52;
}

/// See uniform_open.
template <int N>
INSONIFY_INLINE void uniform_lanes(lanes<double, N>& into, const lanes<std::uint64_t, N>& word) {
    to_double<N>(into, word);
    into = (into + 0.5) * 0x1p-32;
}

/// numeric::log for normal numbers above 0, operation by operation.
template <int N>
INSONIFY_INLINE void log_lanes(lanes<double, N>& into, const lanes<double, N>& x) {
    using doubles = lanes<double, N>;
    using words = lanes<std::uint64_t, N>;
    words bits;
    std::memcpy(&bits, &x, sizeof bits);
    const words shifted = bits + (std::uint64_t{0x3FF0000000000000u} - std::uint64_t{0x3FE6A09E667F3BCDu});
    doubles k;
    to_double<N>(k, words(shifted >> 52));
    k = k - 1023.0;
    const words mantissa = (shifted & std::uint64_t{0x000FFFFFFFFFFFFFu}) + std::uint64_t{0x3FE6A09E667F3BCDu};
    doubles m;
    std::memcpy(&m, &mantissa, sizeof m);
    const doubles f = m - 1.0;
    const doubles s = f / (m + 1.0);
    const doubles t = s * s;
    doubles tail = doubles{} + 1.0 / 23;
    for (int n = 21; n >= 3; n -= 2) tail = tail * t + 1.0 / n;
    const doubles half_square = 0.5 * f * f;
    constexpr double ln2_high = 0x1.62e42feep-1;
    constexpr double ln2_low = 0x1.a39ef35793c76p-33;
    into = k * ln2_high - ((half_square - (s * (half_square + 2.0 * t * tail) + k * ln2_low)) - f);
}

/// Cosine and sine of x turns, 0 < x < 1, by Taylor's series around the nearest quarter; absolute error < 3e-16.
template <int N>
INSONIFY_INLINE void circle_lanes(lanes<double, N>& cosine, lanes<double, N>& sine, const lanes<double, N>& x) {
    using doubles = lanes<double, N>;
    using quarters = lanes<std::int64_t, N>;
    doubles rounded = 4.0 * x + 0x1p52;  // the nearest quarter in its last bits
    quarters bits;
    std::memcpy(&bits, &rounded, sizeof bits);
    rounded = rounded - 0x1p52;
    const doubles angle = (x - 0.25 * rounded) * (2 * numeric::pi);
    const doubles t = angle * angle;
    doubles odd = doubles{} + 1.0, even = doubles{} + 1.0;
    for (int n = 16; n >= 2; n -= 2) {
        odd = 1.0 - odd * t * (1.0 / (n * (n + 1)));
        even = 1.0 - even * t * (1.0 / (n * (n - 1)));
    }
    odd = odd * angle;
    const quarters is_odd = quarters((bits & 1) != 0);
    const doubles first = is_odd ? odd : even, second = is_odd ? even : odd;
    cosine = quarters(((bits + 1) & 2) != 0) ? 0.0 - first : first;
    sine = quarters((bits & 2) != 0) ? 0.0 - second : second;
}

template <int N>
INSONIFY_INLINE void square_root(lanes<double, N>& into, const lanes<double, N>& of) {
#if INSONIFY_SIMD && defined(__SSE2__)
    if constexpr (N == 2) {
        into = __builtin_ia32_sqrtpd(of);
    } else if constexpr (N == 4) {
        const lanes<double, 2> low = __builtin_ia32_sqrtpd(__builtin_shufflevector(of, of, 0, 1));
        const lanes<double, 2> high = __builtin_ia32_sqrtpd(__builtin_shufflevector(of, of, 2, 3));
        into = __builtin_shufflevector(low, high, 0, 1, 2, 3);
    } else
#endif
        gather<N>(into, [&](int k) { return numeric::square_root(lane(of, k)); });
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
    circle_lanes<N>(first, second, v);
    first = radius * first;
    second = radius * second;
}

}  // namespace insonify::inline INSONIFY_ABI::detail

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

INSONIFY_ARITHMETIC_END
