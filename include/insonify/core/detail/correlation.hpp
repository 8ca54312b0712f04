// Filters that turn white Gaussian noise into noise with a Gaussian autocorrelation exp(-(d / length)^2), to within
// 0.003 at every whole distance d: the taps are truncated at 1.5 length + 3.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/numeric.hpp>

#include <algorithm>
#include <array>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Taps from the middle outwards, half of a symmetric filter that preserves the variance of white noise. They are the
/// Fourier transform of the root of the autocorrelation's spectrum: a sampled Gaussian would correlate too little below
/// a length of 2.
/// @param length  distance at which the autocorrelation has fallen to 1 / e, 0 to 50; 0: white
inline dynamic_array<float> field_taps(double length) {
    constexpr std::size_t period = 512, half = period / 2;
    if (!(length > 0)) return {1.0f};
    std::array<double, period> cosine{};
    double c = 1, s = 0;
    for (double& value : cosine) {
        value = c;
        constexpr double turn_c = 0.99992470183914450, turn_s = 0.012271538285719925;  // of 2 pi / 512
        const double next = c * turn_c - s * turn_s;
        s = c * turn_s + s * turn_c;
        c = next;
    }
    std::array<double, half + 1> correlation{}, root{};
    std::size_t correlated = 0;  // the largest distance whose autocorrelation is not 0 in double precision
    for (std::size_t d = 0; d <= half; ++d) {
        const double ratio = static_cast<double>(d) / length;
        correlation[d] = numeric::exp(-ratio * ratio);
        if (correlation[d] > 0) correlated = d;
    }
    for (std::size_t k = 0; k <= half; ++k) {
        double power = correlation[0];
        for (std::size_t d = 1; d <= correlated; ++d) power += 2 * correlation[d] * cosine[k * d % period];
        root[k] = numeric::square_root((std::max)(power, 0.0));
    }
    const std::size_t reach = static_cast<std::size_t>(1.5 * length) + 3;
    dynamic_array<double> taps;
    double sum = 0;
    for (std::size_t j = 0; j <= reach; ++j) {
        double tap = root[0] + root[half] * cosine[half * j % period];
        for (std::size_t k = 1; k < half; ++k) tap += 2 * root[k] * cosine[k * j % period];
        taps.push_back(tap);
        sum += (j == 0 ? 1 : 2) * tap * tap;
    }
    dynamic_array<float> result;
    for (const double tap : taps) result.push_back(static_cast<float>(tap / numeric::square_root(sum)));
    return result;
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
