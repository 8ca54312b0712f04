// Elementary functions with the same bits on every machine, and the `deg` literal.
//
// log, sin and exp of C libraries differ between versions and between processors, so values that reach a pixel are
// computed here, from + - * / and the correctly rounded square root in a fixed order.
#pragma once

#include <insonify/core/detail/portable.hpp>
#include <insonify/core/error.hpp>

#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string_view>
#include <type_traits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace literals {

inline namespace INSONIFY_FLAGS {

/// Angles are radians in the API: `6_deg` is 0.10472.
constexpr float operator""_deg(long double degrees) {
    return static_cast<float>(degrees * std::numbers::pi_v<long double> / 180);
}
constexpr float operator""_deg(unsigned long long degrees) {
    return operator""_deg(static_cast<long double>(degrees));
}

}  // namespace INSONIFY_FLAGS

}  // namespace literals

namespace numeric {

/// Half a turn, in radians.
inline constexpr double pi = std::numbers::pi;

/// Sine and cosine of one angle.
struct sine_cosine {
    double sine;
    double cosine;
};

inline namespace INSONIFY_FLAGS {

/// Radians of an angle in degrees.
constexpr double to_radians(double degrees) {
    return degrees * (pi / 180);
}
/// Degrees of an angle in radians.
constexpr double to_degrees(double radians) {
    return radians * (180 / pi);
}
/// Converts a float to double behind an optimization barrier, for values that callers may have rounded from a double:
/// g++ 12 at -O2 vectorizes pairs of such conversions and drops the rounding (a rig at 0.1f ended up at 0.1).
inline double widened(float value) {
#if defined(__GNUC__) && !defined(__clang__)
    __asm__("" : "+g"(value));
#endif
    return static_cast<double>(value);
}

/// Whether a value is neither infinite nor NaN. Tests the exponent bits, so that no compiler flag can remove the test.
constexpr bool is_finite(float value) {
    return (numeric::bit_cast<std::uint32_t>(value) & 0x7F800000u) != 0x7F800000u;
}
/// The same for a double.
constexpr bool is_finite(double value) {
    return (numeric::bit_cast<std::uint64_t>(value) & 0x7FF0000000000000u) != 0x7FF0000000000000u;
}

/// Absolute value; -0 stays -0.
template <class T>
constexpr T abs(T value) {
    return value < 0 ? -value : value;
}
/// Clamps to [0, 1]; NaN stays NaN.
constexpr float saturate(float value) {
    return value < 0 ? 0 : value > 1 ? 1 : value;
}

/// IEEE 754 square root, correctly rounded everywhere.
inline double square_root(double value) {
    return std::sqrt(value);
}
/// The correctly rounded square root.
inline float square_root(float value) {
    return std::sqrt(value);
}

/// Largest integer not above the value, for |value| < 2^62; a truncation and a comparison, no library call.
constexpr std::int64_t floor_to_int(double value) {
    const auto truncated = static_cast<std::int64_t>(value);
    return truncated - (static_cast<double>(truncated) > value ? 1 : 0);
}

/// The index of a cell of length 1 that holds a coordinate, or of the nearest of `count` cells; 0 for NaN.
template <std::floating_point Real>
constexpr int clamped_index(Real at, int count) {
    const auto last = static_cast<Real>(count - 1);
    return at > 0 ? static_cast<int>(at < last ? at : last) : 0;
}

/// Rounds a length, a positive normal number, to eight significant bits: its multiples are exact in double, so that
/// nodes at multiples of it are the same in every row.
inline double rounded_to_eight_bits(double length) {
    double unit = 1;
    while (unit * 256 <= length) unit *= 2;
    while (unit * 128 > length) unit /= 2;
    return static_cast<double>(floor_to_int(length / unit + 0.5)) * unit;
}

/// The first part of ln 2; its last bits are 0, so that its product with a small whole number is exact.
inline constexpr double ln2_high = 0x1.62e42feep-1;
/// The rest of ln 2.
inline constexpr double ln2_low = 0x1.a39ef35793c76p-33;

/// Natural logarithm, <= 1 ulp. log(0) = -infinity, negative and NaN give NaN.
///
/// x = 2^k m with m in [sqrt(1/2), sqrt(2)); log m = 2 atanh((m - 1) / (m + 1)) as a series.
constexpr double log(double x) {
    if (!(x > 0)) return x == 0 ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
    if (!is_finite(x)) return x;
    int k = 0;
    if (x < 0x1p-1022) {  // subnormal
        x *= 0x1p54;
        k = -54;
    }
    const auto bits = numeric::bit_cast<std::uint64_t>(x);
    // Adding the distance from sqrt(1/2) to 1 moves the cut between exponents to sqrt(2).
    const std::uint64_t shifted = bits + (0x3FF0000000000000u - 0x3FE6A09E667F3BCDu);
    k += static_cast<int>(shifted >> 52) - 1023;
    const auto m = numeric::bit_cast<double>((shifted & 0x000FFFFFFFFFFFFFu) + 0x3FE6A09E667F3BCDu);
    // m - 1 is exact and carries the result; what is added to it is smaller, so that errors stay in the last bit.
    const double f = m - 1;
    const double s = f / (m + 1);
    const double t = s * s;
    double tail = 1.0 / 23;
    for (int n = 21; n >= 3; n -= 2) tail = tail * t + 1.0 / n;
    const double half_square = 0.5 * f * f;
    return k * ln2_high - ((half_square - (s * (half_square + 2 * t * tail) + k * ln2_low)) - f);
}

/// Exponential, <= 2 ulp; overflow gives infinity, underflow 0 (gradually), NaN gives NaN.
constexpr double exp(double x) {
    if (x > 709.8) return std::numeric_limits<double>::infinity();
    if (x < -745.2) return 0;
    if (!(x == x)) return x;
    const std::int64_t k = floor_to_int(x * std::numbers::log2e + 0.5);
    const double r = (x - static_cast<double>(k) * ln2_high) - static_cast<double>(k) * ln2_low;
    double sum = 1.0;
    for (int n = 14; n >= 1; --n) sum = sum * r / n + 1.0;
    // 2^k in two steps, so that results below the normal range are reached without losing the factor.
    const std::int64_t half = k / 2;
    const auto power = [](std::int64_t e) {
        return numeric::bit_cast<double>(static_cast<std::uint64_t>(e + 1023) << 52);
    };
    return sum * power(half) * power(k - half);
}

/// Sine and cosine of 2 pi x, absolute error < 2e-16; x in turns, so that the reduction is exact. |x| < 2^50.
inline sine_cosine sin_cos_turns(double x) {
    // Reduce to [-1/8, 1/8] turn around the nearest quarter.
    const std::int64_t quarter = floor_to_int(4 * x + 0.5);
    const double angle = (x - 0.25 * static_cast<double>(quarter)) * (2 * pi);
    const double t = angle * angle;
    double sine = 1.0, cosine = 1.0;
    for (int n = 16; n >= 2; n -= 2) {
        sine = 1.0 - sine * t / (n * (n + 1));
        cosine = 1.0 - cosine * t / (n * (n - 1));
    }
    sine *= angle;
    switch (quarter & 3) {
        case 0: return {sine, cosine};
        case 1: return {cosine, -sine};
        case 2: return {-sine, -cosine};
        default: return {-cosine, sine};
    }
}

/// Sine and cosine of an angle in radians, |x| < 2^50; the reduction adds |x| * 2e-16 of absolute error.
inline sine_cosine sin_cos(double radians) {
    return sin_cos_turns(radians * (0.5 * std::numbers::inv_pi));
}
/// Tangent of an angle in radians, from sin_cos. Meaningless within 1e-15 of odd multiples of pi / 2, where it may be
/// infinite with the wrong sign.
inline double tan(double radians) {
    const auto [sine, cosine] = sin_cos(radians);
    return sine / cosine;
}

/// x to the power y for x >= 0, relative error below (|y log x| + 2) * 3e-16; pow(0, y > 0) = 0,
/// pow(0, y < 0) = infinity, pow(x, 0) = 1.
constexpr double pow(double x, double y) {
    if (y == 0) return 1;
    if (x == 0) return y > 0 ? 0.0 : y < 0 ? std::numeric_limits<double>::infinity() : y;
    return exp(y * log(x));
}

/// Arc tangent of y / x in [-pi, pi], absolute error < 1e-15; (0, 0) gives 0, two infinities NaN.
inline double atan2(double y, double x) {
    const double ax = x < 0 ? -x : x, ay = y < 0 ? -y : y;
    const double larger = ax > ay ? ax : ay, smaller = ax > ay ? ay : ax;
    if (larger == 0) return ax;  // zero, or NaN beside a zero
    // Reduce to |t| <= tan(pi / 16) by subtracting a known angle: atan t = atan c + atan((t - c) / (1 + t c)).
    struct step {
        double tangent, angle;
    };
    constexpr step steps[] = {{0.0, 0.0}, {0.41421356237309503, pi / 8}, {1.0, pi / 4}};
    const double ratio = smaller / larger;
    const step& near_step = steps[ratio < 0.19891236737965800 ? 0 : ratio < 0.66817863791929891 ? 1 : 2];
    const double t = (ratio - near_step.tangent) / (1 + ratio * near_step.tangent);
    const double square = t * t;
    double series = 0;
    for (int n = 25; n >= 3; n -= 2) series = (1.0 / n - series) * square;
    double angle = near_step.angle + t * (1.0 - series);
    if (ay > ax) angle = pi / 2 - angle;
    if (x < 0) angle = pi - angle;
    return y < 0 ? -angle : angle;
}

/// Quantile of the standard normal distribution, absolute error < 4.5e-4, for probabilities above 0 and below 1.
/// M. Abramowitz, I. A. Stegun. Handbook of Mathematical Functions, 1964, 26.2.23 (after C. Hastings, 1955).
inline double normal_quantile(double probability) {
    const double tail = probability < 0.5 ? probability : 1 - probability, t = square_root(-2 * log(tail));
    const double z =
        t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
    return probability < 0.5 ? -z : z;
}

}  // namespace INSONIFY_FLAGS

}  // namespace numeric
namespace detail::inline INSONIFY_FLAGS {

template <std::floating_point Number>
void require_finite(std::string_view argument, Number value) {
    require(numeric::is_finite(value), argument, value, "finite");
}
template <std::floating_point Number>
void require_positive(std::string_view argument, Number value) {
    require(numeric::is_finite(value) && value > 0, argument, value, "finite and positive");
}
template <std::floating_point Number>
void require_not_negative(std::string_view argument, Number value) {
    require(numeric::is_finite(value) && value >= 0, argument, value, "0 or more, finite");
}
template <arithmetic Number>
void require_range(std::string_view argument, Number value, std::type_identity_t<Number> low,
                   std::type_identity_t<Number> high, std::string_view expected) {
    require(value >= low && value <= high, argument, value, expected);
}
template <std::floating_point Number>
void require_fraction(std::string_view argument, Number value) {
    require_range(argument, value, 0, 1, "0 to 1");
}

/// Refuses angles of so many turns that they can only be a mistake; sin_cos takes |x| < 2^50.
/// @param member  appended to the argument's name
template <std::floating_point Number>
void require_angle(std::string_view argument, Number value, std::string_view member = {}) {
    require_member(value >= Number(-1e6) && value <= Number(1e6), argument, member, value,
                   "finite radians, from -10^6 to 10^6");
}

/// Calls `validate(value)` if the type has one.
template <class T>
void validate_if_possible(const T& value) {
    if constexpr (requires { validate(value); }) validate(value);
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
