// Elementary functions over SIMD lanes: logarithms, cosine and sine, floor, square root of doubles.
//
// Every function gives the same bits at every N; its comment states its accuracy.
#pragma once

#include <insonify/core/numeric.hpp>
#include <insonify/core/simd/lanes.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Converts integers below 2^52: puts them into the mantissa of 2^52, then subtracts 2^52.
template <int N>
INSONIFY_INLINE void to_double(lanes<double, N>& into, const lanes<std::uint64_t, N>& number) {
    const lanes<std::uint64_t, N> bits = number | std::uint64_t{0x4330000000000000u};
    std::memcpy(&into, &bits, sizeof into);
    into = into - 0x1p52;
}

/// Natural logarithm of normal numbers above 0, by the operations of numeric::log, to the same bits.
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
    into = k * numeric::ln2_high - ((half_square - (s * (half_square + 2.0 * t * tail) + k * numeric::ln2_low)) - f);
}

/// ln(2^k (1 + f)) for whole k and sqrt(1/2) - 1 <= f <= sqrt(2) - 1, relative error below 2e-7; summed in
/// the order of numeric::log.
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

/// The largest whole number not above x, for |x| < 2^51.
template <int N>
INSONIFY_INLINE void floor_lanes(lanes<double, N>& into, const lanes<double, N>& x) {
    const lanes<double, N> nearest = (x + 0x1.8p52) - 0x1.8p52;
    into = nearest > x ? nearest - 1.0 : nearest;
}

/// Cosine and sine of x turns, 0 < x < 1, by Taylor series around the nearest quarter turn; absolute error below 4e-16.
template <int N>
INSONIFY_INLINE void cos_sin_turns(lanes<double, N>& cosine, lanes<double, N>& sine, const lanes<double, N>& x) {
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

/// Cosine and sine of word / 2^32 turns, absolute error below 1.2e-7.
template <int N>
INSONIFY_INLINE void cos_sin_turns(lanes<float, N>& cosine, lanes<float, N>& sine,
                                   const lanes<std::uint32_t, N>& word) {
    using floats = lanes<float, N>;
    using words = lanes<std::uint32_t, N>;
    // The two leading bits are the nearest quarter turn; the angle from there is in the rest of the word.
    const words quarter = word + std::uint32_t{0x20000000u};
    floats angle;
    convert(angle, lanes<std::int32_t, N>(word << 2));
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

/// Cosine and sine of x turns, |x| <= 1/2, absolute error below 1e-6.
template <int N>
INSONIFY_INLINE void cos_sin_turns(lanes<float, N>& cosine, lanes<float, N>& sine, const lanes<float, N>& x) {
    using floats = lanes<float, N>;
    // Taylor series of the half angle, which is at most pi / 2, then the double-angle formulas.
    const floats a = x * static_cast<float>(numeric::pi);
    const floats t = a * a;
    const floats s =
        a *
        (1.0f + t * (-1.0f / 6 + t * (1.0f / 120 + t * (-1.0f / 5040 + t * (1.0f / 362880 - t * (1.0f / 39916800))))));
    const floats c =
        1.0f +
        t * (-0.5f +
             t * (1.0f / 24 + t * (-1.0f / 720 + t * (1.0f / 40320 + t * (-1.0f / 3628800 + t * (1.0f / 479001600))))));
    sine = 2.0f * s * c;
    cosine = 1.0f - 2.0f * s * s;
}

/// Square root, correctly rounded.
template <int N>
INSONIFY_INLINE void square_root(lanes<double, N>& into, const lanes<double, N>& of) {
#if INSONIFY_SIMD && defined(__SSE2__)
    if constexpr (N == 2)
        into = __builtin_ia32_sqrtpd(of);
    else if constexpr (N % 2 == 0)
        in_halves<N>(into, of, [](auto& half, const auto& from) { square_root<N / 2>(half, from); });
    else
#endif
        gather<N>(into, [&](int k) { return numeric::square_root(lane(of, k)); });
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
