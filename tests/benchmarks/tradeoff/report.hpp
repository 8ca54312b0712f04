// The report on speed against accuracy: a page of tables, and charts.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "../svg.hpp"

namespace report {

/// One configuration of the renderer, measured on a picture of a seabed.
struct configuration {
    std::string seabed, policy;
    double cells = 0;   ///< per pixel
    double texels = 0;  ///< per pixel, 0 where there are none
    double ms = 0, mebibytes = 0;
    double edge = 0;        ///< mean displacement of shadow edges, pixels
    double intensity = 0;   ///< RMSE of the linear picture
    std::string name{};     ///< of a preset
    bool on_front = false;  ///< Pareto front: no other is both faster and more accurate
};

/// Another knob at one of its settings.
struct knob {
    std::string name, oracle, setting{}, error{};
    double ms = 0, mebibytes = 0;
};

/// A shadow policy, measured on a foreign mesh.
struct mesh_configuration {
    std::string mesh, policy;
    std::size_t triangles = 0;
    double texels = 0;  ///< per pixel, 0 where there are none
    double ms = 0, mebibytes = 0;
    double wrong = 0;  ///< pixels per million
    double edge = 0;   ///< mean displacement of shadow edges, pixels
};

/// All measurements of the report.
struct contents {
    int pixels = 0;
    double grazing_degrees = 0;
    std::vector<std::string> seabeds{};
    std::vector<configuration> configurations{};
    std::vector<mesh_configuration> mesh_configurations{};
    std::vector<knob> knobs{};
};

inline constexpr std::array tolerances{0.25, 0.5, 1.0, 2.0, 4.0};

inline void mark_front(std::vector<configuration>& configurations) {
    for (configuration& w : configurations) {
        w.on_front = true;
        for (const configuration& other : configurations)
            if (other.seabed == w.seabed && other.ms <= w.ms && other.edge <= w.edge &&
                (other.ms < w.ms || other.edge < w.edge))
                w.on_front = false;
    }
}

/// The fastest configuration whose error of shadow edges is at most `edge`, or null.
inline const configuration* cheapest(const contents& c, const std::string& seabed, double edge) {
    const configuration* best = nullptr;
    for (const configuration& w : c.configurations)
        if (w.seabed == seabed && w.edge <= edge && (best == nullptr || w.ms < best->ms)) best = &w;
    return best;
}

inline std::string color_of(const std::string& policy) {
    static const std::map<std::string, std::string> colors{
        {"none", "#7a7a7a"}, {"map", "#3b75af"}, {"pcf", "#5aa469"}, {"exact", "#8e44ad"}};
    const auto found = colors.find(policy);
    return found == colors.end() ? "#000000" : found->second;
}

/// A rectangle of a chart, in its pixels.
struct area {
    double x0, y0, x1, y1;
    bool overlaps(const area& o) const { return x0 < o.x1 && o.x0 < x1 && y0 < o.y1 && o.y0 < y1; }
    /// Whether the segment from a to b passes through, by 32 points of it.
    bool is_crossed(const std::array<double, 2>& a, const std::array<double, 2>& b) const {
        for (int i = 0; i <= 32; ++i) {
            const double t = i / 32.0, x = a[0] + t * (b[0] - a[0]), y = a[1] + t * (b[1] - a[1]);
            if (x0 < x && x < x1 && y0 < y && y < y1) return true;
        }
        return false;
    }
};

/// Names beside the points of a panel: each where it covers no other name, no ring of a named point and no line.
/// @param points  in pixels, with their names
/// @param line    corners of the panel's line
inline std::string names_beside(const std::vector<std::pair<std::array<double, 2>, std::string>>& points,
                                const std::vector<std::array<double, 2>>& line) {
    constexpr double letter = 8.5, height = 13, beside = 10;
    std::vector<area> taken;
    for (const auto& [at, name] : points) taken.push_back({at[0] - 8, at[1] - 8, at[0] + 8, at[1] + 8});
    std::string body;
    for (const auto& [at, name] : points) {
        const double width = letter * static_cast<double>(name.size());
        struct place {
            area where;
            bool is_left;
        };
        std::array<place, 4> places{};
        for (std::size_t i = 0; i < places.size(); ++i) {
            const bool is_left = i % 2 == 1;
            const double x = is_left ? at[0] - beside - width : at[0] + beside, y = i < 2 ? at[1] - 8 : at[1] + 18;
            places[i] = {{x, y - height + 2, x + width, y + 3}, is_left};
        }
        const auto cost = [&](const place& p) {
            double sum = 0;
            for (const area& other : taken) sum += p.where.overlaps(other) ? 10 : 0;
            for (std::size_t i = 1; i < line.size(); ++i) sum += p.where.is_crossed(line[i - 1], line[i]) ? 1 : 0;
            return sum;
        };
        const place& best = *std::min_element(places.begin(), places.end(),
                                              [&](const place& a, const place& b) { return cost(a) < cost(b); });
        taken.push_back(best.where);
        body +=
            svg::text(best.is_left ? best.where.x1 : best.where.x0, best.where.y1 - 3, name,
                      std::string(" fill='#c0392b' font-weight='bold'") + (best.is_left ? " text-anchor='end'" : ""));
    }
    return body;
}

/// Time against error, one panel per seabed: configurations as dots, the Pareto front as a line, presets ringed.
inline std::string trade_chart(const contents& c) {
    constexpr double width = 330, height = 300, left = 80, top = 64, gap = 30;
    double fastest = 1e30, slowest = 0;
    for (const configuration& w : c.configurations)
        fastest = std::min(fastest, w.ms), slowest = std::max(slowest, w.ms);
    const double low_ms = std::log10(fastest) - 0.05, high_ms = std::log10(slowest) + 0.05;
    constexpr double low_edge = -1.5, high_edge = 1.2;  // powers of ten of pixels
    std::string body = svg::text(
        left, 24, "CPU time of a frame against the error of shadow edges: lower is faster, left is more accurate",
        " font-size='16' font-weight='bold'");
    double x0 = left;
    for (const std::string& seabed : c.seabeds) {
        const auto x = [&](double edge) {
            const double at = std::log10(std::max(edge, 1e-9));
            return x0 + width * (std::min(std::max(at, low_edge), high_edge) - low_edge) / (high_edge - low_edge);
        };
        const auto y = [&](double ms) { return top + height * (high_ms - std::log10(ms)) / (high_ms - low_ms); };
        body += svg::text(x0 + width / 2, top - 12, seabed, " text-anchor='middle' font-weight='bold'");
        for (const double edge : {0.05, 0.25, 1.0, 4.0}) {
            body += svg::line(x(edge), top, x(edge), top + height, edge == 1.0 ? "#999999" : "#e2e2e2");
            body += svg::text(x(edge), top + height + 18, svg::number(edge, edge < 1 ? 2 : 0) + " px",
                              " text-anchor='middle'");
        }
        for (double ms : {1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0}) {
            if (std::log10(ms) < low_ms || std::log10(ms) > high_ms) continue;
            body += svg::line(x0, y(ms), x0 + width, y(ms), "#e2e2e2");
            if (x0 == left)
                body += svg::text(x0 - 6, y(ms) + 4,
                                  ms < 1000 ? svg::number(ms, 0) + " ms" : svg::number(ms / 1000, 0) + " s",
                                  " text-anchor='end'");
        }
        std::vector<const configuration*> front;
        for (const configuration& w : c.configurations) {
            if (w.seabed != seabed) continue;
            if (w.on_front) front.push_back(&w);
            if (w.name.empty())
                body += svg::circle(x(w.edge), y(w.ms), w.on_front ? 4.5 : 2.8, color_of(w.policy),
                                    w.on_front ? "" : " opacity='0.45'");
        }
        std::sort(front.begin(), front.end(),
                  [](const configuration* a, const configuration* b) { return a->ms < b->ms; });
        for (std::size_t i = 1; i < front.size(); ++i)
            body += svg::line(x(front[i - 1]->edge), y(front[i - 1]->ms), x(front[i]->edge), y(front[i]->ms), "#333333",
                              " stroke-width='1.5'");
        std::vector<std::pair<std::array<double, 2>, std::string>> named;
        for (const configuration& w : c.configurations)
            if (w.seabed == seabed && !w.name.empty()) named.push_back({{x(w.edge), y(w.ms)}, w.name});
        for (const auto& [at, name] : named)
            body += svg::circle(at[0], at[1], 7, "none", " stroke='#c0392b' stroke-width='2'");
        std::vector<std::array<double, 2>> line;
        for (const configuration* const w : front) line.push_back({x(w->edge), y(w->ms)});
        body += names_beside(named, line);
        body += svg::text(x0 + width / 2, top + height + 38, "error of shadow edges, pixels (mean displacement)",
                          " text-anchor='middle'");
        x0 += width + gap;
    }
    body += "<text transform='translate(16 " + svg::number(top + height / 2, 0) +
            ") rotate(-90)' text-anchor='middle'>CPU time of a frame</text>\n";
    double key = left;
    for (const std::string policy : {"exact", "map", "pcf", "none"}) {
        body += svg::circle(key, top + height + 66, 5, color_of(policy)) +
                svg::text(key + 10, top + height + 70, policy == "none" ? "no shadows" : policy);
        key += 110;
    }
    body += svg::line(key, top + height + 66, key + 26, top + height + 66, "#333333", " stroke-width='1.5'") +
            svg::text(key + 34, top + height + 70, "Pareto front") +
            svg::circle(key + 270, top + height + 66, 7, "none", " stroke='#c0392b' stroke-width='2'") +
            svg::text(key + 284, top + height + 70, "presets");
    return svg::page(static_cast<int>(left + 3 * width + 2 * gap + 30), static_cast<int>(top + height + 88), body);
}

/// Tick spacing of an axis from 0 to `end`: 1, 2 or 5 times a power of ten, at most half of `end`.
inline double axis_step(double end) {
    const double ten = std::pow(10.0, std::floor(std::log10(end / 2))), lead = end / 2 / ten;
    return ten * (lead >= 5 ? 5 : lead >= 2 ? 2 : 1);
}

/// CPU time of the fastest configuration within each tolerance, as bars.
inline std::string savings_chart(const contents& c) {
    constexpr double left = 130, longest = 210, line = 26, gap = 90;
    std::string body = svg::text(20, 26, "CPU time saved by tolerating an error of shadow edges",
                                 " font-size='16' font-weight='bold'");
    double x0 = left, bottom = 0;
    for (const std::string& seabed : c.seabeds) {
        double slowest = 0, y = 74;
        const configuration* reference = nullptr;
        for (const double edge : tolerances)
            if (const configuration* w = cheapest(c, seabed, edge)) {
                slowest = std::max(slowest, w->ms);
                if (reference == nullptr) reference = w;
            }
        body += svg::text(x0, 58, seabed, " font-weight='bold'");
        for (const double edge : tolerances) {
            if (x0 == left)
                body += svg::text(x0 - 10, y + 17, "up to " + svg::number(edge, edge < 1 ? 2 : 0) + " px",
                                  " text-anchor='end'");
            const configuration* const w = cheapest(c, seabed, edge);
            if (w == nullptr) {
                body += svg::text(x0 + 4, y + 17, "not reached", " fill='#7a7a7a'");
            } else {
                const double length = longest * w->ms / slowest;
                const double saved = 100 * (1 - w->ms / reference->ms);
                body += svg::rectangle(svg::number(x0, 1), svg::number(y + 3, 1), svg::number(length, 1),
                                       svg::number(line - 6, 1), edge == 1.0 ? "#b5651d" : "#8a9ba8") +
                        svg::text(x0 + length + 6, y + 17,
                                  svg::number(w->ms, w->ms < 10 ? 1 : 0) + " ms" +
                                      (w == reference ? "" : ", " + svg::number(saved, 0) + " % less"));
            }
            y += line;
        }
        bottom = y + 4;
        body += svg::line(x0, bottom, x0 + longest, bottom, "#7a7a7a");
        for (double ms = 0; ms <= slowest; ms += axis_step(slowest)) {
            const double x = x0 + longest * ms / slowest;
            body += svg::line(x, bottom, x, bottom + 5, "#7a7a7a") +
                    svg::text(x, bottom + 19, svg::number(ms, ms > 0 && ms < 1 ? 1 : 0), " text-anchor='middle'");
        }
        body += svg::text(x0 + longest / 2, bottom + 37, "CPU time of a frame, ms", " text-anchor='middle'");
        x0 += longest + gap + 40;
    }
    body += svg::text(left - 10, 58, "edge error", " text-anchor='end'");
    return svg::page(static_cast<int>(x0), static_cast<int>(bottom + 46), body);
}

inline std::string per_pixel(double value) {
    return value == 0 ? "" : value >= 1 ? svg::number(value, 0) : "1/" + svg::number(1 / value, 0);
}

inline std::string row_of(const configuration& w) {
    return "| " + w.seabed + " | " + w.policy + (w.name.empty() ? "" : " (**" + w.name + "**)") + " | " +
           per_pixel(w.cells) + " | " + per_pixel(w.texels) + " | " + svg::number(w.ms, 1) + " | " +
           svg::number(w.mebibytes, 1) + " | " + svg::number(w.edge, 3) + " | " + svg::number(w.intensity, 4) + " |\n";
}

inline std::string row_of(const mesh_configuration& w) {
    return "| " + w.mesh + " | " + std::to_string(w.triangles) + " | " + w.policy + " | " + per_pixel(w.texels) +
           " | " + svg::number(w.ms, 1) + " | " + svg::number(w.mebibytes, 1) + " | " + svg::number(w.wrong, 1) +
           " | " + svg::number(w.edge, 3) + " |\n";
}

inline std::string page(const contents& c) {
    const std::string pixels = std::to_string(c.pixels);
    std::string text =
        "# Speed against accuracy\n\n"
        "Written by `./tools/tradeoff`, which measures every knob that trades accuracy for speed in one run. "
        "Pictures\n"
        "are " +
        pixels + " x " + pixels + " pixels, lit at " + svg::number(c.grazing_degrees, 0) +
        " degrees above the horizon. Times are CPU times of a whole frame with nothing\n"
        "reused from earlier frames, the minimum over all runs; memory is the peak of what a frame allocates. Compare "
        "figures\n"
        "within one run only.\n\n"
        "![Time against the error of shadow edges, on three seabeds](tradeoff.svg)\n\n"
        "The edge error is the mean displacement of shadow edges: the wrong pixels of the shadow mask divided by the "
        "pixels\n"
        "along its border (`accuracy::compare_masks`). The oracle marches a ray per pixel, and another from its hit "
        "to the light,\n"
        "in double over the seabed at four vertices per pixel (`tests/marching.hpp`). RMSE is that of the linear "
        "picture against\n"
        "one with exact shadows and four vertices per pixel.\n\n"
        "![CPU time saved by tolerating an error](tradeoff_saved.svg)\n\n"
        "`accuracy::settings_for` finds the settings for an error budget; `accuracy::fast`, `balanced` and `exact` "
        "are presets.\n\n"
        "## Pareto front\n\n"
        "The configurations that no other beats in both time and edge error, and the presets.\n\n"
        "| seabed | shadow | cells per pixel | texels per pixel | ms | MiB | edge error, px | RMSE |\n"
        "|---|---|---:|---:|---:|---:|---:|---:|\n";
    std::vector<configuration> sorted = c.configurations;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const configuration& a, const configuration& b) { return a.ms < b.ms; });
    for (const std::string& seabed : c.seabeds)
        for (const configuration& w : sorted)
            if (w.seabed == seabed && (w.on_front || !w.name.empty())) text += row_of(w);
    text +=
        "\n## Foreign meshes\n\n"
        "Open, dense and shuffled meshes, generated by `tests/foreign_scenes.hpp`, lit at 6 and at 33 degrees: times "
        "and errors are\n"
        "means of both. The oracle casts a ray in long double from the surface point that each pixel shows "
        "(`tests/shadow_oracle.hpp`);\n"
        "`benchmark_shadow_accuracy` covers more scenes, sizes and lights.\n\n"
        "| mesh | triangles | shadow | texels per pixel | ms | MiB | wrong pixels per million | edge error, px |\n"
        "|---|---:|---|---:|---:|---:|---:|---:|\n";
    for (const mesh_configuration& w : c.mesh_configurations) text += row_of(w);
    text +=
        "\n## One knob at a time\n\n"
        "| knob | setting | ms | MiB | error | against |\n|---|---|---:|---:|---|---|\n";
    for (const knob& k : c.knobs)
        text += "| " + k.name + " | " + k.setting + " | " + svg::number(k.ms, k.ms < 10 ? 2 : 1) + " | " +
                svg::number(k.mebibytes, 1) + " | " + k.error + " | " + k.oracle + " |\n";
    text +=
        "\n## All configurations\n\n"
        "| seabed | shadow | cells per pixel | texels per pixel | ms | MiB | edge error, px | RMSE |\n"
        "|---|---|---:|---:|---:|---:|---:|---:|\n";
    for (const configuration& w : c.configurations) text += row_of(w);
    return text;
}

}  // namespace report
