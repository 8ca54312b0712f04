// Results of the trial on real images, as a table and as plots: ROC curves, learning curves, confusion.
#pragma once

#include <insonify/io/file.hpp>

#include "../../tests/benchmarks/svg.hpp"
#include "real_trial.hpp"

namespace recognition {

inline std::string fixed(double value) {
    return svg::number(value, 3);
}

/// @param apart  the result of `separability`, below 0 without a generated set
inline std::string real_markdown(const std::vector<trial_result>& results, std::size_t seeds, std::size_t tested,
                                 double apart) {
    std::string out =
        "Area under the ROC curve and balanced accuracy, object or bare bottom, on " + std::to_string(tested) +
        " real images outside the training set: means of " + std::to_string(seeds) +
        " seeds (lowest to highest), of the classifier with the larger area. The last column: plane, ship or "
        "bottom.\n\n| trained on | area under ROC | balanced accuracy | classifier | three classes |\n"
        "|---|---|---|---|---:|\n";
    for (const trial_result& l : results) {
        const std::size_t c = l.better();
        const auto cell = [](const std::vector<double>& values) {
            const spread s(values);
            return fixed(s.mean) + " (" + fixed(s.lowest) + " to " + fixed(s.highest) + ")";
        };
        out += "| " + l.name() + " | " + cell(l.area[c]) + " | " + cell(l.balanced[c]) + " | " +
               (c == 0 ? "SVM" : "forest") + " | " +
               fixed((std::max)(spread(l.three[0]).mean, spread(l.three[1]).mean)) + " |\n";
    }
    if (apart >= 0) out += "\nA forest tells generated from real bare bottoms with an area of " + fixed(apart) + ".\n";
    return out;
}

namespace detail {

/// A plot's frame with axes from `low` to `high`, ticks and their numbers.
struct axes {
    double left = 76, top = 30, width = 320, height = 320;
    double x_low = 0, x_high = 1, y_low = 0, y_high = 1;

    double x(double value) const { return left + (value - x_low) / (x_high - x_low) * width; }
    double y(double value) const { return top + height - (value - y_low) / (y_high - y_low) * height; }
    std::string grid(const std::vector<std::pair<double, std::string>>& x_ticks, const std::vector<double>& y_ticks,
                     int digits) const {
        std::string out;
        for (const auto& [value, name] : x_ticks)
            out += svg::line(x(value), top, x(value), top + height, "#ddd") +
                   svg::text(x(value), top + height + 18, name, " text-anchor='middle'");
        for (const double value : y_ticks)
            out += svg::line(left, y(value), left + width, y(value), "#ddd") +
                   svg::text(left - 6, y(value) + 4, svg::number(value, digits), " text-anchor='end'");
        return out + svg::line(left, top + height, left + width, top + height, "black") +
               svg::line(left, top, left, top + height, "black");
    }
    std::string titles(const std::string& x_title, const std::string& y_title) const {
        const double middle = top + height / 2;
        return svg::text(left + width / 2, top + height + 38, x_title, " text-anchor='middle'") +
               svg::text(16, middle, y_title,
                         " text-anchor='middle' transform='rotate(-90 16 " + svg::number(middle, 0) + ")'");
    }
    std::string curve(const std::vector<std::pair<double, double>>& points, const std::string& color,
                      bool dashed) const {
        std::string list;
        for (const auto& [a, b] : points) list += svg::number(x(a), 1) + "," + svg::number(y(b), 1) + " ";
        return "<polyline fill='none' stroke-width='2' stroke='" + color + "'" +
               (dashed ? " stroke-dasharray='6 4'" : "") + " points='" + list + "'/>\n";
    }
};

inline const char* color_of(std::size_t real) {
    return real == 0 ? "#000000" : real <= 20 ? "#b5651d" : real <= 80 ? "#1f77b4" : "#2ca02c";
}

/// The mean of several curves: detections at each rate of false alarms.
inline std::vector<std::pair<double, double>> mean_curve(const std::vector<std::vector<roc_point>>& curves) {
    std::vector<std::pair<double, double>> mean;
    for (int i = 0; i <= 200; ++i) {
        const double alarms = i / 200.0;
        double sum = 0;
        for (const std::vector<roc_point>& curve : curves) {
            std::size_t k = 1;
            while (k + 1 < curve.size() && curve[k].false_alarms <= alarms) ++k;
            const roc_point &a = curve[k - 1], &b = curve[k];
            const double run = b.false_alarms - a.false_alarms;
            const double share = run > 0 ? std::clamp((alarms - a.false_alarms) / run, 0.0, 1.0) : 1;
            sum += a.detections + share * (b.detections - a.detections);
        }
        mean.emplace_back(alarms, sum / static_cast<double>(curves.size()));
    }
    return mean;
}

/// One line of a legend.
inline std::string entry(double x, double y, const std::string& color, bool dashed, const std::string& what) {
    return svg::line(x, y - 4, x + 28, y - 4, color,
                     std::string(" stroke-width='2'") + (dashed ? " stroke-dasharray='6 4'" : "")) +
           svg::text(x + 34, y, what);
}

}  // namespace detail

/// Mean ROC curves, up to a rate of false alarms of 0.5.
inline std::string roc_svg(const std::vector<trial_result>& results) {
    detail::axes a{.x_high = 0.5, .y_low = 0.5};
    std::string body = a.grid({{0, "0"}, {0.1, "0.1"}, {0.2, "0.2"}, {0.3, "0.3"}, {0.4, "0.4"}, {0.5, "0.5"}},
                              {0.5, 0.6, 0.7, 0.8, 0.9, 1}, 1) +
                       a.titles("false alarms, share of bare bottoms", "detections, share of objects");
    double y = 50;
    for (const trial_result& l : results) {
        const std::size_t c = l.better();
        std::vector<std::pair<double, double>> shown;
        for (const auto& [x, detections] : detail::mean_curve(l.curves[c]))
            if (x <= 0.5) shown.emplace_back(x, (std::max)(detections, 0.5));
        body += a.curve(shown, detail::color_of(l.real), !l.generated);
        body += detail::entry(400, y, detail::color_of(l.real), !l.generated,
                              l.name() + ": " + fixed(spread(l.area[c]).mean));
        y += 22;
    }
    return svg::page(
        640, 420, svg::text(60, 18, "ROC, object or bare bottom; area under the curve", " font-weight='bold'") + body);
}

/// Areas over numbers of real images, with and without the generated set.
inline std::string curves_svg(const std::vector<trial_result>& results) {
    double lowest = 1;
    for (const trial_result& l : results) lowest = (std::min)(lowest, spread(l.area[l.better()]).lowest);
    lowest = (std::min)(std::floor(lowest * 50) / 50, 0.98);
    // Numbers of images on a logarithmic scale that has 0 at its left end.
    const auto place = [](std::size_t real) { return std::log2(1 + static_cast<double>(real) / 5); };
    std::vector<std::pair<double, std::string>> x_ticks;
    std::vector<double> y_ticks;
    for (const trial_result& l : results)
        if (x_ticks.empty() || x_ticks.back().first < place(l.real))
            x_ticks.emplace_back(place(l.real), std::to_string(l.real));
    for (int i = 0; i <= 5; ++i) y_ticks.push_back(lowest + (1 - lowest) * i / 5);
    detail::axes a{.x_low = -0.3, .x_high = place(results.back().real) + 0.3, .y_low = lowest};
    std::string body = a.grid(x_ticks, y_ticks, 3) + a.titles("real training images", "area under the ROC curve");
    for (const bool generated : {true, false}) {
        const std::string color = generated ? "#b5651d" : "#1f77b4";
        std::vector<std::pair<double, double>> means;
        for (const trial_result& l : results) {
            if (l.generated != generated) continue;
            const spread s(l.area[l.better()]);
            means.emplace_back(place(l.real), s.mean);
            body += svg::line(a.x(place(l.real)), a.y(s.lowest), a.x(place(l.real)), a.y(s.highest), color) +
                    svg::circle(a.x(place(l.real)), a.y(s.mean), 3.5, color);
        }
        body += a.curve(means, color, !generated) + detail::entry(400, generated ? 50 : 72, color, !generated,
                                                                  generated ? "real and generated" : "real only");
    }
    body += svg::text(400, 98, "bars: lowest to highest seed");
    return svg::page(640, 420,
                     svg::text(60, 18, "Learning curves, object or bare bottom", " font-weight='bold'") + body);
}

/// Predictions in per cent of the pictures of each true class, over all seeds.
inline std::string confusion_svg(const std::vector<trial_result>& results) {
    constexpr double cell = 52, left = 86, top = 70, width = left + 3 * cell + 24;
    std::string body;
    for (std::size_t n = 0; n < results.size(); ++n) {
        const trial_result& l = results[n];
        const std::size_t c = spread(l.three[0]).mean >= spread(l.three[1]).mean ? 0 : 1;
        const double x0 = static_cast<double>(n % 4) * width, y0 = static_cast<double>(n / 4) * (top + 3 * cell + 24);
        body += svg::text(x0 + left, y0 + 20, l.name() + ": " + fixed(spread(l.three[c]).mean), " font-weight='bold'") +
                svg::text(x0 + left, y0 + 40, "predicted, %") + svg::text(x0 + 10, y0 + top - 10, "true");
        for (std::size_t k = 0; k < 3; ++k) {
            const double middle = (static_cast<double>(k) + 0.5) * cell;
            body +=
                svg::text(x0 + left + middle, y0 + top - 6, real_classes[k], " text-anchor='middle' font-size='11'") +
                svg::text(x0 + left - 6, y0 + top + middle + 4, real_classes[k], " text-anchor='end' font-size='11'");
            const double shown = l.confusion[c].actual(k);
            for (std::size_t a = 0; a < 3; ++a) {
                const double share = shown > 0 ? l.confusion[c].counts[k][a] / shown : 0;
                const double x = x0 + left + static_cast<double>(a) * cell,
                             y = y0 + top + static_cast<double>(k) * cell;
                body +=
                    "<rect x='" + svg::number(x, 1) + "' y='" + svg::number(y, 1) +
                    "' width='52' height='52' fill='#b5651d' fill-opacity='" + svg::number(share, 3) +
                    "' stroke='#999'/>\n" +
                    svg::text(x + cell / 2, y + cell / 2 + 4, svg::number(100 * share, 0),
                              std::string(" text-anchor='middle' fill='") + (share > 0.6 ? "white" : "black") + "'");
            }
        }
    }
    const auto rows = (results.size() + 3) / 4;
    return svg::page(static_cast<int>(4 * width), static_cast<int>(static_cast<double>(rows) * (top + 3 * cell + 24)),
                     body);
}

}  // namespace recognition
