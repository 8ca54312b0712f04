// SIMD versions of random.hpp to the same bits: Philox blocks, uniform and normal draws.
#pragma once

#include <insonify/core/numeric.hpp>
#include <insonify/core/simd/dispatch.hpp>
#include <insonify/core/simd/lanes.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// The products of the lower halves of the lanes with a word. Four lanes are for AVX2, eight for AVX-512: kernels of W
/// lanes of 32 bits have W / 2 of these.
template <int N>
INSONIFY_INLINE void multiply_words(lanes<std::uint64_t, N>& into, const lanes<std::uint64_t, N>& a, std::uint32_t b) {
    // One instruction, which clang sees for itself and g++ has to be told. dispatch.hpp has made it known.
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
/// upper half is of no meaning. Several counters run side by side because each waits for its products.
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
    unroll<10>([&](int i) INSONIFY_INLINE_LAMBDA { tail = tail * t + 1.0 / (21 - 2 * i); });
    const doubles half_square = 0.5 * f * f;
    constexpr double ln2_high = 0x1.62e42feep-1;
    constexpr double ln2_low = 0x1.a39ef35793c76p-33;
    into = k * ln2_high - ((half_square - (s * (half_square + 2.0 * t * tail) + k * ln2_low)) - f);
}

/// The largest whole number not above x, for |x| < 2^51.
template <int N>
INSONIFY_INLINE void floor_lanes(lanes<double, N>& into, const lanes<double, N>& x) {
    const lanes<double, N> nearest = (x + 0x1.8p52) - 0x1.8p52;
    into = nearest > x ? nearest - 1.0 : nearest;
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
    unroll<8>([&](int i) INSONIFY_INLINE_LAMBDA {
        const int n = 16 - 2 * i;
        odd = 1.0 - odd * t * (1.0 / (n * (n + 1)));
        even = 1.0 - even * t * (1.0 / (n * (n - 1)));
    });
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
    } else if constexpr (N % 2 == 0) {
        in_halves<N>(into, of, [](auto& half, const auto& from) { square_root<N / 2>(half, from); });
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

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
