// Double-double arithmetic: the unevaluated sum of two doubles, for the few pixels whose depth a double cannot round
// with certainty. Relative error of each operation below 2^-100.
//
// This work is based on:
// T. J. Dekker. A Floating-Point Technique for Extending the Available Precision. 1971
// Jonathan R. Shewchuk. Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. 1997
#pragma once

#include <insonify/core/detail/int128.hpp>
#include <insonify/core/detail/portable.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

struct double_double {
    double high = 0, low = 0;

    /// a + b exactly.
    static double_double sum(double a, double b) {
        const double s = a + b, part = s - a;
        return {s, (a - (s - part)) + (b - part)};
    }
    /// a b exactly, for |a|, |b| < 2^995 and 2^-960 < |a b| < 2^1023, or a b = 0.
    static double_double product(double a, double b) {
        const double p = a * b;
        const auto [a1, a0] = halves(a);
        const auto [b1, b0] = halves(b);
        return {p, ((a1 * b1 - p) + a1 * b0 + a0 * b1) + a0 * b0};
    }
    static double_double from(const int128& value) {
        constexpr double word = 0x1p32;
        const auto part = [](std::uint64_t bits) { return static_cast<double>(bits & 0xFFFFFFFFu); };
        const double_double upper = sum(static_cast<double>(value.high >> 32) * (word * word * word),
                                        part(static_cast<std::uint64_t>(value.high)) * (word * word));
        return upper + (sum(part(value.low >> 32) * word, part(value.low)));
    }

    friend double_double operator+(const double_double& a, const double_double& b) {
        const double_double s = sum(a.high, b.high), t = sum(a.low, b.low);
        const double_double u = quick_sum(s.high, s.low + t.high);
        return quick_sum(u.high, u.low + t.low);
    }
    friend double_double operator*(const double_double& a, double b) {
        const double_double p = product(a.high, b);
        return quick_sum(p.high, p.low + a.low * b);
    }
    friend double_double operator/(const double_double& a, const double_double& b) {
        const double q1 = a.high / b.high;
        const double_double r1 = a + b * -q1;
        const double q2 = r1.high / b.high;
        const double_double r2 = r1 + b * -q2;
        return quick_sum(q1, q2) + double_double{r2.high / b.high, 0};
    }

    /// The nearest float. The upper half is first rounded to odd, so that the lower half decides ties.
    float to_float() const {
        auto bits = numeric::bit_cast<std::uint64_t>(high);
        if (low != 0 && (bits & 1) == 0) bits += (low > 0) == (high > 0) ? 1u : ~std::uint64_t{0};
        return static_cast<float>(numeric::bit_cast<double>(bits));
    }

  private:
    /// a + b exactly if |a| >= |b|.
    static double_double quick_sum(double a, double b) {
        const double s = a + b;
        return {s, b - (s - a)};
    }
    struct parts {
        double upper, lower;
    };
    /// Splits a number into halves of 26 bits, whose products are exact.
    static parts halves(double a) {
        const double c = 134217729.0 * a;
        const double upper = c - (c - a);
        return {upper, a - upper};
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
