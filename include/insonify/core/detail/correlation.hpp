// Filters that turn white Gaussian noise into noise with a Gaussian autocorrelation exp(-(d / length)^2), exact at
// every whole distance d and for every length, and the field lengths that give echo intensities theirs.
#pragma once

#include <insonify/core/numeric.hpp>

#include <algorithm>
#include <array>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Half of the symmetric taps, from the middle outwards; white noise keeps its variance. They are the Fourier transform
/// of the root of the autocorrelation's spectrum: a sampled Gaussian would correlate too little below a length of 2.
/// @param length  distance at which the autocorrelation has fallen to 1 / e, 0 to 50; 0: white
inline std::vector<float> field_taps(double length) {
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
    for (std::size_t d = 0; d <= half; ++d) {
        const double ratio = static_cast<double>(d) / length;
        correlation[d] = numeric::exp(-ratio * ratio);
    }
    for (std::size_t k = 0; k <= half; ++k) {
        double power = correlation[0];
        for (std::size_t d = 1; d <= half; ++d) power += 2 * correlation[d] * cosine[k * d % period];
        root[k] = numeric::square_root((std::max)(power, 0.0));
    }
    const std::size_t reach = static_cast<std::size_t>(1.5 * length) + 3;
    std::vector<double> taps;
    double sum = 0;
    for (std::size_t j = 0; j <= reach; ++j) {
        double tap = root[0] + root[half] * cosine[half * j % period];
        for (std::size_t k = 1; k < half; ++k) tap += 2 * root[k] * cosine[k * j % period];
        taps.push_back(tap);
        sum += (j == 0 ? 1 : 2) * tap * tap;
    }
    std::vector<float> result;
    for (const double tap : taps) result.push_back(static_cast<float>(tap / numeric::square_root(sum)));
    return result;
}

/// Length of a field whose law makes intensities with a correlation of 1 / e at `length`.
/// @param of_field  the intensities' correlation for a correlation of the field; rises from 0 at 0 to 1 at 1
template <class Law>
double field_length(double length, const Law& of_field) {
    double low = 0, high = 1;
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        (of_field(middle) < 0.36787944117144233 ? low : high) = middle;
    }
    return length / numeric::square_root(-numeric::log(0.5 * (low + high)));
}

/// Correlation of Rician intensities |s + n|^2, n a complex normal field of unit power, for one of the field. Without a
/// steady part, and for averages of looks, it is the field's square.
/// @param steady  s^2
inline auto rice_correlation(double steady) {
    return [=](double field) { return field * (field + 2 * steady) / (1 + 2 * steady); };
}

/// Taps for fields of echoes without a steady part or texture, whose intensities have the given length.
inline std::vector<float> intensity_taps(double length) {
    return field_taps(field_length(length, rice_correlation(0)));
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
