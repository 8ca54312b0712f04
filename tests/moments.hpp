// Moments and correlations of pictures, for tests of random textures.
#pragma once

#include <insonify/core/image.hpp>

#include <cmath>

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

}  // namespace moments
