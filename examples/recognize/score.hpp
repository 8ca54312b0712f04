// Scores of predictions: confusion matrices and statistics over runs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace recognition {

/// Rows: true classes; columns: predictions.
struct confusion {
    std::array<std::array<double, 3>, 3> counts{};

    confusion() = default;
    confusion(const std::vector<std::size_t>& truth, const std::vector<std::size_t>& predictions) {
        for (std::size_t i = 0; i < truth.size(); ++i) counts[truth[i]][predictions[i]] += 1;
    }
    confusion& operator+=(const confusion& other) {
        for (std::size_t i = 0; i < 9; ++i) counts[i / 3][i % 3] += other.counts[i / 3][i % 3];
        return *this;
    }
    double actual(std::size_t kind) const { return counts[kind][0] + counts[kind][1] + counts[kind][2]; }
    double predicted(std::size_t kind) const { return counts[0][kind] + counts[1][kind] + counts[2][kind]; }
    double total() const { return actual(0) + actual(1) + actual(2); }
    double recall(std::size_t kind) const { return actual(kind) > 0 ? counts[kind][kind] / actual(kind) : 0; }

    double accuracy() const { return (counts[0][0] + counts[1][1] + counts[2][2]) / total(); }
    /// The mean of the classes' recalls: a third for guessing and for one constant answer.
    double balanced_accuracy() const { return (recall(0) + recall(1) + recall(2)) / 3; }
    double macro_f1() const {
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double either = actual(k) + predicted(k);
            sum += either > 0 ? 2 * counts[k][k] / either / 3 : 0;
        }
        return sum;
    }
};

/// Statistics over several runs.
struct spread {
    double mean = 0, deviation = 0, lowest = 0, highest = 0;

    explicit spread(const std::vector<double>& values) {
        const auto n = static_cast<double>(values.size());
        for (const double v : values) mean += v / n;
        for (const double v : values) deviation += (v - mean) * (v - mean);
        deviation = values.size() > 1 ? std::sqrt(deviation / (n - 1)) : 0;
        lowest = *std::min_element(values.begin(), values.end());
        highest = *std::max_element(values.begin(), values.end());
    }
};

}  // namespace recognition
