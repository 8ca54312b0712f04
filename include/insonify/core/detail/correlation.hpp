// Filters that make neighbours of white noise alike.
#pragma once

#include <insonify/core/numeric.hpp>

#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// The taps of a Gaussian filter under which white noise keeps its variance, from the middle outwards.
///
/// @param deviation  of the filter; the correlation of what it makes is exp(-(d / deviation)^2 / 4) at distance d
inline std::vector<float> gaussian_taps(double deviation) {
    std::vector<double> taps{1};
    double square = 1;
    for (int i = 1; i <= 3 * deviation; ++i) {
        taps.push_back(numeric::exp(-0.5 * i * i / (deviation * deviation)));
        square += 2 * taps.back() * taps.back();
    }
    std::vector<float> result;
    for (const double tap : taps) result.push_back(static_cast<float>(tap / numeric::square_root(square)));
    return result;
}

/// Taps for fields whose correlation falls to 1 / e at `length`.
inline std::vector<float> field_taps(double length) {
    return gaussian_taps(length * 0.5);
}

/// Taps for fields whose intensity, the sum of two squares, has a correlation that falls to 1 / e at `length`: the
/// correlation of an intensity is the square of that of its field.
inline std::vector<float> intensity_taps(double length) {
    return gaussian_taps(length * 0.70710678118654752);
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
