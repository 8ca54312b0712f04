// Gamma-distributed numbers: what averages of looks and textures of the seabed are.
//
// Based on: George Marsaglia, Wai Wan Tsang. A Simple Method for Generating Gamma Variables. ACM Transactions on
// Mathematical Software 26, 2000.
#pragma once

#include <insonify/core/random.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::detail {

/// A gamma-distributed number of mean one.
///
/// @param draw  draw(trial) makes four fresh words
template <class Draw>
double gamma_of_mean_one(double shape, const Draw& draw) {
    // Shapes below one are those of one more, times a power of a uniform number.
    const double d = (shape < 1 ? shape + 1 : shape) - 1.0 / 3, c = 1 / numeric::square_root(9 * d);
    for (std::uint32_t trial = 0;; ++trial) {
        const philox_counter words = draw(trial);
        const double x = normal_pair(words[0], words[1])[0], u = uniform_open(words[2]);
        const double root = 1 + c * x, v = root * root * root;
        if (!(v > 0) || !(numeric::log(u) < 0.5 * x * x + d * (1 - v + numeric::log(v)))) continue;
        return d * v / shape * (shape < 1 ? numeric::pow(uniform_open(words[3]), 1 / shape) : 1);
    }
}

/// The mean of the square root of a gamma-distributed number of mean one: Gamma(shape + 1/2) / (Gamma(shape)
/// sqrt(shape)), to 1e-12, by its asymptotic series beyond 20.
inline double mean_root_of_gamma(double shape) {
    double factor = 1, x = shape;
    for (; x < 20; x += 1) factor *= x / (x + 0.5);
    const double i = 1 / x;
    const double series =
        1 + i * (-1.0 / 8 + i * (1.0 / 128 + i * (5.0 / 1024 + i * (-21.0 / 32768 + i * (-399.0 / 262144)))));
    return factor * numeric::square_root(x / shape) * series;
}

}  // namespace insonify::inline INSONIFY_ABI::detail

INSONIFY_ARITHMETIC_END
