// Texture statistics of a patch of a sonar picture, to compare with real ones.
#pragma once

#include <insonify/core/image.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace gallery {

struct texture {
    double deviation;    ///< of the gray values, over their mean
    double skewness;     ///< of the gray values
    double kurtosis;     ///< of the gray values
    double across;       ///< correlation of adjacent pixels across the track
    double along;        ///< correlation of adjacent pixels along the track
    double contrast;     ///< of the gray-level co-occurrence matrix, 8 equally frequent levels, 2 pixels apart
    double homogeneity;  ///< of that matrix
    double slope;        ///< of the radially averaged periodogram, from 4 to n / 8 cycles
    double direction;    ///< of the periodogram's longer axis below n / 8 cycles, degrees
    double anisotropy;   ///< of the periodogram there: 0 for a round one, 1 for a line
};

/// Discrete Fourier transform of 2^k values, in place.
inline void transform(std::vector<std::complex<double>>& values) {
    const std::size_t n = values.size();
    for (std::size_t i = 1, j = 0; i < n; ++i) {
        std::size_t bit = n >> 1;
        for (; (j & bit) != 0; bit >>= 1) j ^= bit;
        j ^= bit;
        if (i < j) std::swap(values[i], values[j]);
    }
    for (std::size_t length = 2; length <= n; length *= 2)
        for (std::size_t start = 0; start < n; start += length)
            for (std::size_t k = 0; k < length / 2; ++k) {
                const auto turned =
                    std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(length)) *
                    values[start + k + length / 2];
                values[start + k + length / 2] = values[start + k] - turned;
                values[start + k] += turned;
            }
}

/// |F|^2 of the middle n x n pixels, 2^k of them, through a Hann window; frequency 0 in the corner.
inline insonify::image<double> periodogram(insonify::image_view<const float> picture, int n) {
    const int left = (picture.width() - n) / 2, top = (picture.height() - n) / 2;
    double mean = 0;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) mean += static_cast<double>(picture(left + x, top + y)) / n / n;
    const auto window = [&](int i) { return 1 - std::cos(2 * std::numbers::pi * (i + 0.5) / n); };
    insonify::image<std::complex<double>> f(n, n);
    std::vector<std::complex<double>> line(static_cast<std::size_t>(n));
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x)
            line[at(x)] = (static_cast<double>(picture(left + x, top + y)) - mean) * window(x) * window(y);
        transform(line);
        for (int x = 0; x < n; ++x) f(x, y) = line[at(x)];
    }
    insonify::image<double> power(n, n);
    for (int x = 0; x < n; ++x) {
        for (int y = 0; y < n; ++y) line[at(y)] = f(x, y);
        transform(line);
        for (int y = 0; y < n; ++y) power(x, y) = std::norm(line[at(y)]);
    }
    return power;
}

/// The largest 2^k that fits.
inline int square_in(int width, int height) {
    int n = 1;
    while (2 * n <= width && 2 * n <= height) n *= 2;
    return n;
}

inline texture texture_of(insonify::image_view<const float> picture) {
    texture t{};
    const int width = picture.width(), height = picture.height();
    const double count = static_cast<double>(width) * height;
    const auto value = [&](int x, int y) { return static_cast<double>(picture(x, y)); };
    const auto mean_of = [&](int dx, int dy, auto&& fn) {
        double sum = 0;
        for (int y = 0; y + dy < height; ++y)
            for (int x = 0; x + dx < width; ++x) sum += fn(value(x, y), value(x + dx, y + dy));
        return sum / (static_cast<double>(width - dx) * (height - dy));
    };
    const double mean = mean_of(0, 0, [](double a, double) { return a; });
    const auto product = [&](double a, double b) { return (a - mean) * (b - mean); };
    const double variance = mean_of(0, 0, product);
    t.deviation = std::sqrt(variance) / mean;
    t.skewness = mean_of(0, 0, [&](double a, double) { return std::pow(a - mean, 3); }) / std::pow(variance, 1.5);
    t.kurtosis = mean_of(0, 0, [&](double a, double) { return std::pow(a - mean, 4); }) / (variance * variance);
    t.across = mean_of(1, 0, product) / variance;
    t.along = mean_of(0, 1, product) / variance;

    std::vector<float> sorted(static_cast<std::size_t>(count));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) sorted[static_cast<std::size_t>(y * width + x)] = picture(x, y);
    std::sort(sorted.begin(), sorted.end());
    const auto level = [&](double v) {
        const auto rank = std::lower_bound(sorted.begin(), sorted.end(), static_cast<float>(v)) - sorted.begin();
        return std::floor(8 * static_cast<double>(rank) / count);
    };
    t.contrast = mean_of(2, 0, [&](double a, double b) { return std::pow(level(a) - level(b), 2); });
    t.homogeneity = mean_of(2, 0, [&](double a, double b) { return 1 / (1 + std::abs(level(a) - level(b))); });

    const int n = square_in(width, height);
    const insonify::image<double> power = periodogram(picture, n);
    std::vector<double> ring(static_cast<std::size_t>(n)), members(static_cast<std::size_t>(n));
    double xx = 0, xy = 0, yy = 0;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const int u = x < n / 2 ? x : x - n, v = y < n / 2 ? y : y - n;
            const double radius = std::sqrt(static_cast<double>(u * u + v * v));
            const auto index = static_cast<std::size_t>(radius + 0.5);
            ring[index] += power(x, y);
            members[index] += 1;
            if (radius < 2 || radius > n / 8) continue;
            xx += power(x, y) * u * u / (radius * radius);
            xy += power(x, y) * u * v / (radius * radius);
            yy += power(x, y) * v * v / (radius * radius);
        }
    double s = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t r = 4; r <= static_cast<std::size_t>(n / 8); ++r) {
        // Rings are weighted by their inverse radius, so that every octave has the same weight.
        const double w = 1 / static_cast<double>(r), a = std::log(static_cast<double>(r)),
                     b = std::log(ring[r] / members[r]);
        s += w, sx += w * a, sy += w * b, sxx += w * a * a, sxy += w * a * b;
    }
    t.slope = (s * sxy - sx * sy) / (s * sxx - sx * sx);
    t.direction = 0.5 * std::atan2(2 * xy, xx - yy) * 180 / std::numbers::pi;
    t.anisotropy = std::hypot(xx - yy, 2 * xy) / (xx + yy);
    return t;
}

}  // namespace gallery
