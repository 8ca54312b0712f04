// Moments and correlations of pictures, and distances of samples from a law, for tests of random numbers.
#pragma once

#include <insonify/core/image.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "larger.hpp"

namespace moments {

namespace in = insonify;

struct first_two {
    double mean, index;  ///< index: variance / mean^2
};

inline first_two of(const in::image<float>& picture) {
    double sum = 0, squares = 0;
    for (const float v : picture.pixels()) {
        sum += static_cast<double>(v);
        squares += static_cast<double>(v) * static_cast<double>(v);
    }
    const double mean = sum / static_cast<double>(picture.size());
    return {mean, squares / static_cast<double>(picture.size()) / (mean * mean) - 1};
}

/// Correlation of a picture with another that is shifted by (dx, dy).
inline double correlation(const in::image<float>& a, const in::image<float>& b, int dx = 0, int dy = 0) {
    const first_two ma = of(a), mb = of(b);
    double sum = 0;
    for (int y = 0; y + dy < a.height(); ++y)
        for (int x = 0; x + dx < a.width(); ++x)
            sum += (static_cast<double>(a(x, y)) - ma.mean) * (static_cast<double>(b(x + dx, y + dy)) - mb.mean);
    const double deviations = ma.mean * std::sqrt(ma.index) * mb.mean * std::sqrt(mb.index);
    return sum / ((a.width() - dx) * (a.height() - dy)) / deviations;
}

/// Kolmogorov and Smirnov's statistic: the largest distance between the distribution of samples and a cumulative one,
/// times the root of their number. Samples of that law exceed x with a probability of 2 exp(-2 x^2).
template <class Number, class Cumulative>
double kolmogorov_smirnov(std::span<Number> samples, const Cumulative& cumulative) {
    std::vector<double> sorted(samples.begin(), samples.end());
    std::sort(sorted.begin(), sorted.end());
    const auto count = static_cast<double>(sorted.size());
    double distance = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const double expected = cumulative(sorted[i]), before = static_cast<double>(i) / count;
        distance = larger(distance, larger(std::abs(expected - before), std::abs(before + 1 / count - expected)));
    }
    return distance * std::sqrt(count);
}
inline constexpr double once_in_1000 = 1.95;  ///< this statistic exceeds it once in a thousand tests
inline constexpr double once_in_100000 = 2.47;

}  // namespace moments
