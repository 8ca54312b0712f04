// Two of OpenCV's classifiers and their scores: a linear support vector machine and a forest of random trees.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/ml.hpp>

namespace recognition {

/// Rows of features, and the class of each.
struct sample {
    cv::Mat rows;
    std::vector<int> classes;

    void add(const cv::Mat& row, int of_class, int times = 1) {
        for (int i = 0; i < times; ++i) rows.push_back(row), classes.push_back(of_class);
    }
};

/// Predictions of a classifier: a class each, and for two classes the score of class 1.
struct predictions {
    std::vector<int> classes;
    std::vector<double> scores;
};

namespace detail {

inline cv::Ptr<cv::ml::TrainData> train_data(const cv::Mat& rows, const std::vector<int>& classes) {
    return cv::ml::TrainData::create(rows, cv::ml::ROW_SAMPLE, cv::Mat(classes, true));
}

}  // namespace detail

/// Trains a linear support vector machine and classifies the test rows. Features are scaled to mean 0 and standard
/// deviation 1 over the training rows.
inline predictions svm_predictions(const sample& train, const cv::Mat& test) {
    cv::Mat mean, scale;
    for (int column = 0; column < train.rows.cols; ++column) {
        cv::Scalar m, d;
        cv::meanStdDev(train.rows.col(column), m, d);
        mean.push_back(static_cast<float>(m[0]));
        scale.push_back(static_cast<float>(1 / (d[0] + 1e-6)));
    }
    const auto scaled = [&](const cv::Mat& rows) {
        cv::Mat out = rows.clone();
        for (int i = 0; i < out.rows; ++i) out.row(i) = (out.row(i) - mean.t()).mul(scale.t());
        return out;
    };
    const auto machine = cv::ml::SVM::create();
    machine->setType(cv::ml::SVM::C_SVC);
    machine->setKernel(cv::ml::SVM::LINEAR);
    machine->setC(0.003);
    machine->setTermCriteria({cv::TermCriteria::MAX_ITER + cv::TermCriteria::EPS, 10000, 1e-4});
    machine->train(detail::train_data(scaled(train.rows), train.classes));
    const cv::Mat rows = scaled(test);
    cv::Mat classes, raw;
    machine->predict(rows, classes);
    machine->predict(rows, raw, cv::ml::StatModel::RAW_OUTPUT);
    predictions out;
    // The raw output is positive for the first class.
    for (int i = 0; i < rows.rows; ++i) {
        out.classes.push_back(static_cast<int>(classes.at<float>(i)));
        out.scores.push_back(-static_cast<double>(raw.at<float>(i)));
    }
    return out;
}

/// Trains a forest of random trees and classifies the test rows.
inline predictions forest_predictions(const sample& train, const cv::Mat& test, std::uint64_t seed) {
    cv::setRNGSeed(static_cast<int>(seed));
    const auto forest = cv::ml::RTrees::create();
    forest->setMaxDepth(20);
    forest->setMinSampleCount(2);
    forest->setTermCriteria({cv::TermCriteria::MAX_ITER, 200, 0});
    forest->train(detail::train_data(train.rows, train.classes));
    cv::Mat votes;
    forest->getVotes(test, votes, 0);  // the first row: classes
    predictions out;
    for (int i = 1; i < votes.rows; ++i) {
        int most = 0, all = 0;
        for (int k = 0; k < votes.cols; ++k) {
            all += votes.at<int>(i, k);
            if (votes.at<int>(i, k) > votes.at<int>(i, most)) most = k;
        }
        out.classes.push_back(votes.at<int>(0, most));
        out.scores.push_back(static_cast<double>(votes.at<int>(i, votes.cols - 1)) / all - 0.5);
    }
    return out;
}

/// A point of a ROC curve for each threshold: rates of false alarms and of detections.
struct roc_point {
    double false_alarms, detections;
};
inline std::vector<roc_point> roc_of(const std::vector<int>& truth, const std::vector<double>& scores) {
    std::vector<std::size_t> order(truth.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return scores[a] > scores[b]; });
    const auto objects = static_cast<double>(std::count(truth.begin(), truth.end(), 1));
    const double others = static_cast<double>(truth.size()) - objects;
    std::vector<roc_point> curve{{0, 0}};
    double hits = 0, alarms = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        (truth[order[i]] == 1 ? hits : alarms) += 1;
        // Equal scores are one threshold.
        if (i + 1 == order.size() || scores[order[i + 1]] != scores[order[i]])
            curve.push_back({alarms / others, hits / objects});
    }
    return curve;
}

inline double area_under(const std::vector<roc_point>& curve) {
    double area = 0;
    for (std::size_t i = 1; i < curve.size(); ++i)
        area +=
            (curve[i].false_alarms - curve[i - 1].false_alarms) * (curve[i].detections + curve[i - 1].detections) / 2;
    return area;
}

}  // namespace recognition
