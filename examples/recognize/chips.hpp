// Chips of a folder and their features: gradients, moments, spectrum and co-occurrence.
//
// Each chip is prepared the same way and by itself: 64 x 64 pixels, gray values from its first to its last percentile.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "../common/pictures.hpp"
#include <opencv2/imgproc.hpp>
#include <opencv2/objdetect.hpp>

namespace recognition {

struct chip {
    std::string kind;
    cv::Mat shape;    ///< features to recognise objects, one row, CV_32F
    cv::Mat texture;  ///< features to separate generated bottoms from real ones, one row, CV_32F
};

namespace detail {

inline constexpr int side = 64;

inline cv::Mat prepared(const insonify::image<float>& picture) {
    const cv::Mat whole(picture.height(), picture.width(), CV_32F, const_cast<float*>(picture.pixels().data()));
    cv::Mat chip;
    cv::resize(whole, chip, {side, side}, 0, 0, cv::INTER_AREA);
    std::vector<float> sorted(chip.begin<float>(), chip.end<float>());
    std::sort(sorted.begin(), sorted.end());
    const float low = sorted[sorted.size() / 100], high = sorted[sorted.size() - 1 - sorted.size() / 100];
    chip = (chip - low) / (high - low + 1e-9f);
    return cv::min(cv::max(chip, 0), 1);
}

inline cv::Mat smoothed(const cv::Mat& chip, double sigma) {
    cv::Mat smooth;
    cv::GaussianBlur(chip, smooth, {}, sigma, sigma, cv::BORDER_REFLECT);
    return smooth;
}

/// Mean, deviation, skewness and kurtosis.
inline std::array<float, 4> moments_of(const cv::Mat& m) {
    cv::Scalar mean, deviation;
    cv::meanStdDev(m, mean, deviation);
    double third = 0, fourth = 0;
    for (auto at = m.begin<float>(); at != m.end<float>(); ++at) {
        const double d = (static_cast<double>(*at) - mean[0]) / (deviation[0] + 1e-9);
        third += d * d * d, fourth += d * d * d * d;
    }
    const auto n = static_cast<double>(m.total());
    return {static_cast<float>(mean[0]), static_cast<float>(deviation[0]), static_cast<float>(third / n),
            static_cast<float>(fourth / n)};
}

/// Histograms of oriented gradients of the smoothed chip, and at four scales its spread, its extremes and moments.
inline cv::Mat shape_of(const cv::Mat& chip) {
    static const cv::HOGDescriptor gradients({side, side}, {32, 32}, {16, 16}, {16, 16}, 9);
    cv::Mat codes;
    smoothed(chip, 1.5).convertTo(codes, CV_8U, 255);
    std::vector<float> row;
    gradients.compute(codes, row);
    for (const double scale : {1, 2, 4, 8}) {
        const cv::Mat smooth = smoothed(chip, scale);
        double lowest = 0, highest = 0;
        cv::minMaxLoc(smooth, &lowest, &highest);
        const auto [mean, deviation, skewness, kurtosis] = moments_of(smooth);
        row.insert(row.end(), {deviation, static_cast<float>(highest) - mean, mean - static_cast<float>(lowest),
                               skewness, kurtosis});
    }
    return cv::Mat(row, true).reshape(1, 1);
}

/// Energy of six rings of the spectrum.
inline void add_spectrum(const cv::Mat& chip, std::vector<float>& row) {
    constexpr std::array<int, 7> rings{1, 3, 6, 10, 16, 24, 32};
    cv::Mat waves;
    cv::dft(chip - cv::mean(chip)[0], waves, cv::DFT_COMPLEX_OUTPUT);
    std::array<double, 6> energy{}, count{};
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double radius = std::hypot(x < side / 2 ? x : x - side, y < side / 2 ? y : y - side);
            const cv::Vec2f wave = waves.at<cv::Vec2f>(y, x);
            for (std::size_t i = 0; i < 6; ++i)
                if (radius >= rings[i] && radius < rings[i + 1])
                    energy[i] += static_cast<double>(wave.dot(wave)), count[i] += 1;
        }
    for (std::size_t i = 0; i < 6; ++i) row.push_back(static_cast<float>(std::log(energy[i] / count[i] + 1e-9)));
}

/// Statistics of pairs of pixels at an offset, in 32 gray levels: contrast, homogeneity, energy and correlation.
inline void add_cooccurrence(const cv::Mat& chip, int across, int down, std::vector<float>& row) {
    std::array<std::array<double, 32>, 32> pairs{};
    double total = 0;
    for (int y = 0; y + down < side; ++y)
        for (int x = 0; x + across < side; ++x) {
            const auto a = static_cast<std::size_t>(31 * chip.at<float>(y, x)),
                       b = static_cast<std::size_t>(31 * chip.at<float>(y + down, x + across));
            pairs[a][b] += 1, pairs[b][a] += 1, total += 2;
        }
    double contrast = 0, homogeneity = 0, energy = 0, mean = 0, square = 0, product = 0;
    for (std::size_t a = 0; a < 32; ++a)
        for (std::size_t b = 0; b < 32; ++b) {
            const double share = pairs[a][b] / total, i = static_cast<double>(a), j = static_cast<double>(b);
            contrast += share * (i - j) * (i - j), homogeneity += share / (1 + (i - j) * (i - j));
            energy += share * share, mean += share * i, square += share * i * i, product += share * i * j;
        }
    const double variance = square - mean * mean;
    for (const double value : {contrast, homogeneity, std::sqrt(energy), (product - mean * mean) / (variance + 1e-9)})
        row.push_back(static_cast<float>(value));
}

inline cv::Mat texture_of(const cv::Mat& chip) {
    std::vector<float> row;
    for (const double scale : {0.5, 1.0, 2.0, 4.0})
        for (const float value : moments_of(smoothed(chip, scale))) row.push_back(value);
    add_spectrum(chip, row);
    for (const int apart : {1, 2, 4}) add_cooccurrence(chip, apart, 0, row), add_cooccurrence(chip, 0, apart, row);
    return cv::Mat(row, true).reshape(1, 1);
}

}  // namespace detail

/// The pictures in a folder, at any depth, sorted by path.
inline std::vector<std::string> pictures_in(const std::string& folder) {
    std::set<std::string> paths;
    if (std::filesystem::is_directory(folder))
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
            if (entry.is_regular_file() && !entry.path().filename().string().starts_with('.'))
                paths.insert(entry.path().string());
    return {paths.begin(), paths.end()};
}

/// The chips of a class.
/// @throws io_error for a folder without pictures
inline std::vector<chip> chips_in(const std::string& folder, const std::string& kind) {
    std::vector<chip> chips;
    for (const std::string& path : pictures_in(folder)) {
        const cv::Mat picture = detail::prepared(examples::read_gray(path));
        chips.push_back({kind, detail::shape_of(picture), detail::texture_of(picture)});
    }
    if (chips.empty()) throw insonify::io_error(folder + ": holds no picture");
    return chips;
}

}  // namespace recognition
