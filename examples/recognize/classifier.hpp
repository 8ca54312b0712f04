// Histograms of oriented gradients and a linear support vector machine, both OpenCV's.
//
// Based on: Navneet Dalal, Bill Triggs. Histograms of Oriented Gradients for Human Detection. CVPR 2005.
#pragma once

#include "recipes.hpp"
#include <opencv2/imgproc.hpp>
#include <opencv2/ml.hpp>
#include <opencv2/objdetect.hpp>

namespace recognition {

/// Features by picture, a row each, computed from that picture alone.
struct features {
    cv::Mat rows;      ///< of the pictures
    cv::Mat mirrored;  ///< of their mirror images along the track, which are as plausible
    std::vector<std::size_t> kinds;
};

/// Position of the target in a picture of 128 x 128: where the contrast to the pixels behind it is largest.
inline cv::Point target_in(const cv::Mat& picture) {
    cv::Mat sums;
    cv::integral(picture, sums, CV_64F);
    const auto mean = [&](int left, int right, int y) {
        const int top = y - 6, bottom = y + 6;
        return (sums.at<double>(bottom, right) - sums.at<double>(top, right) - sums.at<double>(bottom, left) +
                sums.at<double>(top, left)) /
               ((right - left) * (bottom - top));
    };
    cv::Point best(43, 64);
    double largest = -1e30;
    for (int y = 46; y < 82; ++y)
        for (int x = 26; x < 60; ++x) {
            const double contrast = mean(x - 5, x + 5, y) - mean(x + 7, x + 27, y);
            if (contrast > largest) largest = contrast, best = {x, y};
        }
    return best;
}

/// Histograms of gradients in the 80 x 64 pixels around the target and its shadow, smoothed to reduce speckle: cells of
/// 8 pixels, blocks of 2 x 2 cells, 9 directions.
inline std::vector<float> gradients_of(const cv::Mat& picture) {
    static const cv::HOGDescriptor hog({80, 64}, {16, 16}, {8, 8}, {8, 8}, 9);
    cv::Mat scaled, smooth;
    cv::resize(picture, scaled, {128, 128}, 0, 0, cv::INTER_AREA);
    const cv::Point at = target_in(scaled);
    cv::GaussianBlur(scaled, smooth, {}, 2.5);
    std::vector<float> row;
    hog.compute(smooth(cv::Rect(at.x - 20, at.y - 32, 80, 64)), row);
    return row;
}

inline features features_of(const std::vector<example>& set) {
    features f;
    for (const example& e : set) {
        const in::image<std::uint8_t>& p = e.picture;
        const cv::Mat picture(p.height(), p.width(), CV_8U, const_cast<std::uint8_t*>(p.pixels().data()));
        cv::Mat upside_down;
        cv::flip(picture, upside_down, 0);
        f.rows.push_back(cv::Mat(gradients_of(picture)).reshape(1, 1));
        f.mirrored.push_back(cv::Mat(gradients_of(upside_down)).reshape(1, 1));
        f.kinds.push_back(e.kind);
    }
    return f;
}

/// The rows of `f` at these indices.
inline features subset(const features& f, const std::vector<std::size_t>& numbers) {
    features s;
    for (const std::size_t i : numbers) {
        s.rows.push_back(f.rows.row(static_cast<int>(i)));
        s.mirrored.push_back(f.mirrored.row(static_cast<int>(i)));
        s.kinds.push_back(f.kinds[i]);
    }
    return s;
}

class classifier {
  public:
    /// Trains on all rows and their mirror images, with the penalty that is best in five-fold cross-validation of the
    /// rows.
    explicit classifier(const features& f) : machine_(cv::ml::SVM::create()) {
        using cv::ml::SVM;
        machine_->setType(SVM::C_SVC);
        machine_->setKernel(SVM::LINEAR);
        machine_->setTermCriteria({cv::TermCriteria::MAX_ITER + cv::TermCriteria::EPS, 20000, 1e-4});
        const cv::Mat kinds(std::vector<int>(f.kinds.begin(), f.kinds.end()), true);
        const auto set_of = [](const cv::Mat& rows, const cv::Mat& labels) {
            return cv::ml::TrainData::create(rows, cv::ml::ROW_SAMPLE, labels);
        };
        const cv::ml::ParamGrid fixed(0, 0, 0), penalties(1e-3, 30, 10);
        machine_->trainAuto(set_of(f.rows, kinds), 5, penalties, fixed, fixed, fixed, fixed, fixed, true);
        cv::Mat both_rows, both_kinds;
        cv::vconcat(f.rows, f.mirrored, both_rows);
        cv::vconcat(kinds, kinds, both_kinds);
        machine_->train(set_of(both_rows, both_kinds));
    }

    std::vector<std::size_t> operator()(const features& f) const {
        cv::Mat predictions;
        machine_->predict(f.rows, predictions);
        std::vector<std::size_t> kinds;
        for (int i = 0; i < predictions.rows; ++i) kinds.push_back(static_cast<std::size_t>(predictions.at<float>(i)));
        return kinds;
    }

  private:
    cv::Ptr<cv::ml::SVM> machine_;
};

}  // namespace recognition
