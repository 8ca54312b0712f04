// Statistics of echoes, for noise filters and speckle by label: the intensity of a look, gamma-distributed averages and
// textures, mean amplitudes, and the correlation that a Gaussian field needs for intensities of a given correlation.
//
// Based on: Stephen O. Rice. Mathematical Analysis of Random Noise. Bell System Technical Journal 24, 1945. E. Jakeman,
// P. N. Pusey. A Model for Non-Rayleigh Sea Echo. IEEE Transactions on Antennas and Propagation 24, 1976 (the
// K-distribution). George Marsaglia, Wai Wan Tsang. A Simple Method for Generating Gamma Variables. ACM Transactions on
// Mathematical Software 26, 2000.
#pragma once

#include <insonify/core/detail/correlation.hpp>
#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/random.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Contribution of one look to the mean of `looks` Rician intensities of mean 1: |s + n|^2 / ((1 + s^2) looks).
/// @param re, im  of n, complex normal noise of unit power
/// @param steady  s^2, power of the steady echo; 0 for exponential intensities
inline float look_intensity(float re, float im, float steady, int looks) {
    const float real = re + numeric::square_root(steady);
    return (real * real + im * im) / ((1 + steady) * static_cast<float>(looks));
}

/// One rejection trial for N gamma-distributed numbers of mean one, from four words each. Sets `accepted` in the lanes
/// that pass, 19 of 20.
/// @param shape  above 0
template <int N>
INSONIFY_INLINE void try_gamma(lanes<double, N>& number, lanes<std::int64_t, N>& accepted,
                               const lanes<std::uint64_t, N> (&word)[4], const lanes<double, N>& shape) {
    using doubles = lanes<double, N>;
    using flags = lanes<std::int64_t, N>;
    // Shapes below one are those of one more, times a power of a uniform number.
    const doubles d = (shape < 1.0 ? shape + 1.0 : shape) - 1.0 / 3;
    doubles c, x, other, u, log_v;
    square_root<N>(c, 9.0 * d);
    c = 1.0 / c;
    normal_lanes<N>(x, other, word[0], word[1]);
    uniform_lanes<N>(u, word[2]);
    const doubles root = 1.0 + c * x, v = root * root * root;
    log_lanes<N>(u, u);
    log_lanes<N>(log_v, v > 0.0 ? v : doubles{} + 1.0);
    accepted = flags(v > 0.0) & flags(u < 0.5 * x * x + d * (1.0 - v + log_v));
    number = d * v / shape;
    for (int k = 0; k < N; ++k) {
        if (lane(shape, k) < 1) {
            const double power =
                numeric::pow(uniform_open(static_cast<std::uint32_t>(lane(word[3], k))), 1 / lane(shape, k));
            set_lane(number, k, lane(number, k) * power);
        }
    }
}

/// A gamma-distributed number of mean one.
/// @param draw  draw(trial) makes four fresh words
template <class Draw>
double gamma_of_mean_one(double shape, const Draw& draw) {
    for (std::uint32_t trial = 0;; ++trial) {
        const philox_counter words = draw(trial);
        const std::uint64_t word[4] = {words[0], words[1], words[2], words[3]};
        double number;
        std::int64_t accepted;
        try_gamma<1>(number, accepted, word, shape);
        if (accepted != 0) return number;
    }
}

/// The mean of the square root of a gamma-distributed number of mean one: Gamma(shape + 1/2) / (Gamma(shape)
/// sqrt(shape)), to a relative error of 5e-12, by its asymptotic series beyond 20.
inline double mean_root_of_gamma(double shape) {
    double factor = 1, x = shape;
    for (; x < 20; x += 1) factor *= x / (x + 0.5);
    const double i = 1 / x;
    const double series =
        1 + i * (-1.0 / 8 + i * (1.0 / 128 + i * (5.0 / 1024 + i * (-21.0 / 32768 + i * (-399.0 / 262144)))));
    return factor * numeric::square_root(x / shape) * series;
}

/// The mean of |s + n| over sqrt(1 + steady), where n is complex normal noise of unit power and s^2 = `steady`; error
/// below 5e-12 (Rice, eq. 3.10-12).
inline double mean_of_rice(double steady) {
    const double half_root_pi = 0.88622692545275801;
    if (steady > 300) {
        const double i = 1 / steady;
        return numeric::square_root(1 / (1 + i)) * (1 + i * (1.0 / 4 + i * (1.0 / 32 + i * (3.0 / 128))));
    }
    // exp(-steady) times the confluent hypergeometric function (3/2; 1; steady), whose terms are all positive.
    double term = 1, sum = 1;
    for (int n = 0; term > 1e-16 * sum; ++n) {
        term *= (n + 1.5) / (static_cast<double>(n + 1) * (n + 1)) * steady;
        sum += term;
    }
    return half_root_pi * sum * numeric::exp(-steady) / numeric::square_root(1 + steady);
}

/// Correlation length of the Gaussian field whose intensities have a correlation of 1 / e at `length`.
/// @param of_field  correlation of the intensities as a function of the field's; rises from 0 at 0 to 1 at 1
template <class Law>
double field_length(double length, const Law& of_field) {
    double low = 0, high = 1;
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        (of_field(middle) < 0.36787944117144233 ? low : high) = middle;
    }
    return length / numeric::square_root(-numeric::log(0.5 * (low + high)));
}

/// Correlation of Rician intensities |s + n|^2 as a function of the correlation r of n, a complex normal field of unit
/// power: r (r + 2 s^2) / (1 + 2 s^2). For s = 0, and for averages of looks, it is r^2.
/// @param steady  s^2
inline auto rice_correlation(double steady) {
    return [=](double field) { return field * (field + 2 * steady) / (1 + 2 * steady); };
}

/// Taps for fields of echoes without a steady part or texture, whose intensities have the given length.
inline dynamic_array<float> intensity_taps(double length) {
    return field_taps(field_length(length, rice_correlation(0)));
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
