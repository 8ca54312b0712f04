// Scores of predictions: confusion matrices and statistics over runs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace recognition {

/// Rows: true classes; columns: predictions.
template <std::size_t Classes>
struct confusion {
    std::array<std::array<double, Classes>, Classes> counts{};

    confusion() = default;
    /// @param truth, predictions  numbers of classes
    template <class Number>
    confusion(const std::vector<Number>& truth, const std::vector<Number>& predictions) {
        for (std::size_t i = 0; i < truth.size(); ++i)
            counts[static_cast<std::size_t>(truth[i])][static_cast<std::size_t>(predictions[i])] += 1;
    }
    confusion& operator+=(const confusion& other) {
        for (std::size_t i = 0; i < Classes; ++i)
            for (std::size_t k = 0; k < Classes; ++k) counts[i][k] += other.counts[i][k];
        return *this;
    }
    double actual(std::size_t kind) const {
        return sum([&](std::size_t k) { return counts[kind][k]; });
    }
    double predicted(std::size_t kind) const {
        return sum([&](std::size_t k) { return counts[k][kind]; });
    }
    double recall(std::size_t kind) const { return actual(kind) > 0 ? counts[kind][kind] / actual(kind) : 0; }

    double accuracy() const {
        return sum([&](std::size_t k) { return counts[k][k]; }) / sum([&](std::size_t k) { return actual(k); });
    }
    /// The mean recall of the classes that have test chips. Where all have some, guessing and one constant answer give
    /// 1 / Classes.
    double balanced_accuracy() const {
        return sum([&](std::size_t k) { return recall(k); }) / sum([&](std::size_t k) { return actual(k) > 0; });
    }
    double macro_f1() const {
        return sum([&](std::size_t k) {
                   const double either = actual(k) + predicted(k);
                   return either > 0 ? 2 * counts[k][k] / either : 0;
               }) /
               static_cast<double>(Classes);
    }

  private:
    template <class Of>
    static double sum(const Of& of) {
        double all = 0;
        for (std::size_t k = 0; k < Classes; ++k) all += of(k);
        return all;
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
