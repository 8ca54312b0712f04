// Histograms of oriented gradients and a linear support vector machine, both OpenCV's.
//
// Based on: Navneet Dalal, Bill Triggs. Histograms of Oriented Gradients for Human Detection. CVPR 2005.
#pragma once

#include "recipes.hpp"
#include <opencv2/imgproc.hpp>
#include <opencv2/ml.hpp>
#include <opencv2/objdetect.hpp>

namespace recognition {

/// A row of features per picture. Each is made of its picture alone.
struct features {
    cv::Mat rows;
    std::vector<std::size_t> kinds;
};

/// Pictures of any size are brought to 64 x 64: cells of 8 pixels, blocks of 2 x 2 cells, 9 directions.
inline features features_of(const std::vector<example>& set) {
    const cv::HOGDescriptor hog({64, 64}, {16, 16}, {8, 8}, {8, 8}, 9);
    features f{cv::Mat(static_cast<int>(set.size()), static_cast<int>(hog.getDescriptorSize()), CV_32F), {}};
    for (std::size_t i = 0; i < set.size(); ++i) {
        const in::image<std::uint8_t>& p = set[i].picture;
        const cv::Mat whole(p.height(), p.width(), CV_8U, const_cast<std::uint8_t*>(p.pixels().data()));
        cv::Mat reduced;
        cv::resize(whole, reduced, {64, 64}, 0, 0, cv::INTER_AREA);
        std::vector<float> row;
        hog.compute(reduced, row);
        cv::Mat(row).reshape(1, 1).copyTo(f.rows.row(static_cast<int>(i)));
        f.kinds.push_back(set[i].kind);
    }
    return f;
}

/// The rows of `f` with these numbers.
inline features subset(const features& f, const std::vector<std::size_t>& numbers) {
    features s;
    for (const std::size_t i : numbers) {
        s.rows.push_back(f.rows.row(static_cast<int>(i)));
        s.kinds.push_back(f.kinds[i]);
    }
    return s;
}

class classifier {
  public:
    /// Trains on all rows; the penalty is that of the best of five-fold cross-validation on the same rows.
    explicit classifier(const features& f) : machine_(cv::ml::SVM::create()) {
        machine_->setType(cv::ml::SVM::C_SVC);
        machine_->setKernel(cv::ml::SVM::LINEAR);
        machine_->setTermCriteria({cv::TermCriteria::MAX_ITER + cv::TermCriteria::EPS, 20000, 1e-4});
        cv::Mat labels(f.rows.rows, 1, CV_32S);
        for (int i = 0; i < labels.rows; ++i)
            labels.at<int>(i) = static_cast<int>(f.kinds[static_cast<std::size_t>(i)]);
        const auto data = cv::ml::TrainData::create(f.rows, cv::ml::ROW_SAMPLE, labels);
        const auto fixed = [](int parameter) {
            auto grid = cv::ml::SVM::getDefaultGrid(parameter);
            grid.logStep = 0;
            return grid;
        };
        machine_->trainAuto(data, 5, {1e-3, 30, 10}, fixed(cv::ml::SVM::GAMMA), fixed(cv::ml::SVM::P),
                            fixed(cv::ml::SVM::NU), fixed(cv::ml::SVM::COEF), fixed(cv::ml::SVM::DEGREE), true);
    }

    std::vector<std::size_t> operator()(const features& f) const {
        cv::Mat answers;
        machine_->predict(f.rows, answers);
        std::vector<std::size_t> kinds;
        for (int i = 0; i < answers.rows; ++i) kinds.push_back(static_cast<std::size_t>(answers.at<float>(i)));
        return kinds;
    }

  private:
    cv::Ptr<cv::ml::SVM> machine_;
};

}  // namespace recognition
