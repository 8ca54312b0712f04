// The trial on real images: accuracy by number of real training images, with a generated set and without.
#pragma once

#include <insonify/core/random.hpp>
#include <insonify/core/thread_pool.hpp>

#include "chips.hpp"
#include "learners.hpp"
#include "score.hpp"

namespace recognition {

/// Real chips by class, and generated ones: planes, ships, bare bottoms.
struct collection {
    std::array<std::vector<chip>, 3> of_class;

    std::size_t objects() const { return of_class[0].size() + of_class[1].size(); }
};
inline const std::array<std::string, 3> real_classes{"plane", "ship", "seafloor"};

/// One point of a learning curve, with a run for each seed.
struct trial_result {
    std::size_t real;
    bool generated;
    std::vector<double> area[2], balanced[2];  ///< of the support vector machine, of the forest
    std::vector<std::vector<roc_point>> curves[2];
    std::vector<double> three[2];  ///< balanced accuracy of plane, ship or bottom
    recognition::confusion<3> confusion[2]{};

    std::string name() const {
        return real == 0 ? "generated alone" : std::to_string(real) + " real" + (generated ? " and generated" : "");
    }
    /// Index of the classifier with the larger mean area.
    std::size_t better() const { return spread(area[0]).mean >= spread(area[1]).mean ? 0 : 1; }
};

/// Splits the real chips into training and test chips by a seed: as many objects as bare bottoms train, the rest
/// tests.
struct division {
    struct item {
        std::size_t of_class, number;
    };
    std::vector<item> objects, bare;  ///< training chips, in the order of use
    std::vector<item> test;

    division(const collection& real, std::size_t max_real, std::uint64_t seed) {
        insonify::random_sequence random(seed, 0x7265616Cu);
        std::vector<item> all_objects, all_bare;
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < real.of_class[k].size(); ++i)
                (k < 2 ? all_objects : all_bare).push_back({k, i});
        for (auto* const items : {&all_objects, &all_bare}) {
            for (std::size_t i = items->size(); i > 1; --i)
                std::swap((*items)[i - 1], (*items)[random.below(static_cast<std::uint32_t>(i))]);
            std::vector<item>& train = items == &all_objects ? objects : bare;
            train.assign(items->begin(), items->begin() + static_cast<std::ptrdiff_t>(max_real / 2));
            test.insert(test.end(), items->begin() + static_cast<std::ptrdiff_t>(max_real / 2), items->end());
        }
    }
};

/// Real chips are repeated up to the number of generated ones, ten times at most.
inline int repeats_of(std::size_t real, std::size_t generated) {
    return real == 0 || generated == 0 ? 1 : static_cast<int>(std::clamp<std::size_t>(generated / real, 1, 10));
}

/// Trains and tests one point of the curve with one seed.
/// @param three  classes are plane, ship and bottom instead of object and bottom
inline std::array<predictions, 2> train_and_test(const collection& real, const collection& made, const division& d,
                                                 std::size_t count, bool generated, bool three, std::uint64_t seed,
                                                 std::vector<int>& truth) {
    const auto label = [&](std::size_t k) { return three ? static_cast<int>(k) : k < 2 ? 1 : 0; };
    sample train;
    if (generated)
        for (std::size_t k = 0; k < 3; ++k)
            for (const chip& c : made.of_class[k]) train.add(c.shape, label(k));
    const std::size_t all_made = made.objects() + made.of_class[2].size();
    const int times = repeats_of(count, generated ? all_made : 0);
    for (const auto* const items : {&d.objects, &d.bare})
        for (std::size_t i = 0; i < count / 2; ++i) {
            const auto [k, number] = (*items)[i];
            train.add(real.of_class[k][number].shape, label(k), times);
        }
    cv::Mat test;
    truth.clear();
    for (const auto& [k, number] : d.test) test.push_back(real.of_class[k][number].shape), truth.push_back(label(k));
    return {svm_predictions(train, test), forest_predictions(train, test, seed)};
}

inline trial_result run_trial(const collection& real, const collection& made, std::size_t count, bool generated,
                              std::size_t max_real, std::size_t seeds) {
    trial_result l{count, generated, {}, {}, {}, {}};
    for (std::size_t seed = 1; seed <= seeds; ++seed) {
        const division d(real, max_real, seed);
        std::vector<int> truth;
        const std::array<predictions, 2> two_classes =
            train_and_test(real, made, d, count, generated, false, seed, truth);
        for (std::size_t c = 0; c < 2; ++c) {
            const std::vector<roc_point> curve = roc_of(truth, two_classes[c].scores);
            std::vector<int> predicted;
            for (const double score : two_classes[c].scores) predicted.push_back(score > 0 ? 1 : 0);
            l.area[c].push_back(area_under(curve));
            l.balanced[c].push_back(confusion<2>(truth, predicted).balanced_accuracy());
            l.curves[c].push_back(curve);
        }
        const std::array<predictions, 2> three_classes =
            train_and_test(real, made, d, count, generated, true, seed, truth);
        for (std::size_t c = 0; c < 2; ++c) {
            const confusion<3> run(truth, three_classes[c].classes);
            l.three[c].push_back(run.balanced_accuracy());
            l.confusion[c] += run;
        }
    }
    return l;
}

/// How well a forest separates generated bare bottoms from real ones by texture: the area under its ROC curve in
/// five-fold cross-validation. 0.5: not at all, 1: perfectly.
inline double separability(const std::vector<chip>& real, const std::vector<chip>& made) {
    std::vector<std::pair<const chip*, int>> all;
    for (const chip& c : real) all.emplace_back(&c, 1);
    for (const chip& c : made) all.emplace_back(&c, 0);
    insonify::random_sequence random(1, 0x61706172u);
    for (std::size_t i = all.size(); i > 1; --i)
        std::swap(all[i - 1], all[random.below(static_cast<std::uint32_t>(i))]);
    std::vector<int> truth;
    std::vector<double> scores;
    for (std::size_t part = 0; part < 5; ++part) {
        sample train;
        cv::Mat test;
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (i % 5 == part)
                test.push_back(all[i].first->texture), truth.push_back(all[i].second);
            else
                train.add(all[i].first->texture, all[i].second);
        }
        for (const double score : forest_predictions(train, test, part + 1).scores) scores.push_back(score);
    }
    return area_under(roc_of(truth, scores));
}

}  // namespace recognition
