// Results as a table and as a picture of the confusion matrices.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "recipes.hpp"
#include "score.hpp"

namespace recognition {

/// The runs of one recipe at one size: one for each training seed.
struct outcome {
    std::string name, description;
    std::size_t images;
    std::vector<confusion<3>> transfer;  ///< on the simulator's pictures
    std::vector<confusion<3>> own;       ///< on pictures of the same recipe, if any
};

inline spread balanced(const std::vector<confusion<3>>& runs) {
    std::vector<double> values;
    for (const confusion<3>& c : runs) values.push_back(c.balanced_accuracy());
    return spread(values);
}
inline confusion<3> sum(const std::vector<confusion<3>>& runs) {
    confusion<3> all;
    for (const confusion<3>& c : runs) all += c;
    return all;
}

template <class... Values>
std::string text(const char* format, const Values&... values) {
    std::string out(static_cast<std::size_t>(std::snprintf(nullptr, 0, format, values...)), '\0');
    std::snprintf(out.data(), out.size() + 1, format, values...);
    return out;
}

/// @param counts  of the test set, by class
inline std::string markdown(const std::vector<outcome>& outcomes, const class_counts& counts) {
    const double total = static_cast<double>(counts[0] + counts[1] + counts[2]);
    const double largest_class = static_cast<double>(*std::max_element(counts.begin(), counts.end()));
    const double seeds = static_cast<double>(outcomes.front().transfer.size());
    std::string out = text(
        "Balanced accuracy over %.0f training seeds: mean ± standard deviation (lowest to highest).\n\n"
        "| training pictures | number | on its own kind | on the simulator's | plain accuracy | macro F1 |\n"
        "|---|---:|---|---|---:|---:|\n",
        seeds);
    const auto cell = [](const std::vector<confusion<3>>& runs) {
        if (runs.empty()) return std::string("-");
        const spread s = balanced(runs);
        return text("%.3f ± %.3f (%.3f to %.3f)", s.mean, s.deviation, s.lowest, s.highest);
    };
    for (const outcome& o : outcomes)
        out += text("| %s | %zu | %s | %s | %.3f | %.3f |\n", o.description.c_str(), o.images, cell(o.own).c_str(),
                    cell(o.transfer).c_str(), sum(o.transfer).accuracy(), sum(o.transfer).macro_f1());
    out += text(
        "| none: guessing | - | 0.333 | 0.333 | 0.333 | - |\n| none: always the largest class | - | 0.333 | 0.333 | "
        "%.3f | - |\n",
        largest_class / total);

    out += "\nRecalls on the simulator's test set over all seeds; rows are true classes, columns predictions.\n";
    for (const outcome& o : outcomes) {
        const confusion<3> c = sum(o.transfer);
        out += text("\n| %s, %zu | cylinder | cube | sphere |\n|---|---:|---:|---:|\n", o.name.c_str(), o.images);
        for (std::size_t k = 0; k < 3; ++k)
            out +=
                text("| %s | %.1f %% | %.1f %% | %.1f %% |\n", classes[k].c_str(), 100 * c.counts[k][0] / c.actual(k),
                     100 * c.counts[k][1] / c.actual(k), 100 * c.counts[k][2] / c.actual(k));
    }
    return out;
}

/// Confusion matrices side by side, darker squares for more chips.
inline std::string svg(const std::vector<outcome>& outcomes) {
    constexpr int cell = 44, left = 62, top = 58, width = left + 3 * cell + 40, height = top + 3 * cell + 14;
    constexpr std::size_t columns = 4;
    const auto rows = static_cast<int>((outcomes.size() + columns - 1) / columns);
    const int across = static_cast<int>((std::min)(columns, outcomes.size()));
    std::string out = text(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" font-family=\"sans-serif\" "
        "font-size=\"11\">\n"
        "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
        across * width, rows * height);
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        const confusion<3> c = sum(outcomes[i].transfer);
        out += text("<g transform=\"translate(%d %d)\">\n", static_cast<int>(i % columns) * width,
                    static_cast<int>(i / columns) * height);
        out += text("<text x=\"%d\" y=\"16\" font-weight=\"bold\">%s, %zu: %.2f</text>\n", left,
                    outcomes[i].name.c_str(), outcomes[i].images, balanced(outcomes[i].transfer).mean);
        out += text("<text x=\"%d\" y=\"32\">predicted, %% of the true class</text>\n", left);
        out += text("<text x=\"%d\" y=\"%d\" text-anchor=\"end\">true</text>\n", left - 6, top - 8);
        for (int k = 0; k < 3; ++k) {
            const std::string& name = classes[static_cast<std::size_t>(k)];
            out += text("<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">%s</text>\n", left + k * cell + cell / 2,
                        top - 8, name.c_str());
            out += text("<text x=\"%d\" y=\"%d\" text-anchor=\"end\">%s</text>\n", left - 6,
                        top + k * cell + cell / 2 + 4, name.c_str());
            for (int a = 0; a < 3; ++a) {
                const auto actual = static_cast<std::size_t>(k), predicted = static_cast<std::size_t>(a);
                const double share = c.counts[actual][predicted] / c.actual(actual);
                out += text(
                    "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"#b5651d\" fill-opacity=\"%.3f\" "
                    "stroke=\"#999\"/>\n",
                    left + a * cell, top + k * cell, cell, cell, share);
                out += text("<text x=\"%d\" y=\"%d\" text-anchor=\"middle\" fill=\"%s\">%.0f %%</text>\n",
                            left + a * cell + cell / 2, top + k * cell + cell / 2 + 4, share > 0.6 ? "white" : "black",
                            100 * share);
            }
        }
        out += "</g>\n";
    }
    return out + "</svg>\n";
}

}  // namespace recognition
