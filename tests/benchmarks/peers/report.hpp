// Results of a run as a table, as JSON and as a chart.
#pragma once

#include <insonify/core/error.hpp>

#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "../svg.hpp"

namespace report {

/// Difference of a picture from the exact one.
struct distance {
    double psnr_db = 0;
    double off_by_8_percent = 0;  ///< pixels that differ by more than 8 of 255
};

/// One renderer on one size of a workload.
struct row {
    std::string workload;
    char size;
    std::string renderer;
    double ms_median = 0, ms_fastest = 0;
    std::optional<distance> from_exact;  ///< absent without an exact picture

    bool is_beside(const row& other) const { return workload == other.workload && size == other.size; }
};

/// The library's row beside another renderer's.
inline const row* own_beside(const std::vector<row>& rows, const row& of) {
    for (const row& r : rows)
        if (r.is_beside(of) && r.renderer == "insonify") return &r;
    return nullptr;
}

using svg::number;

inline void print_table(const std::vector<row>& rows) {
    std::printf("%-8s %-5s %-22s %10s %10s %12s %9s %11s\n", "workload", "size", "renderer", "median ms", "fastest",
                "to insonify", "PSNR dB", "off by > 8");
    for (const row& r : rows) {
        const row* const own = own_beside(rows, r);
        std::printf("%-8s %-5c %-22s %10.1f %10.1f %12s %9s %11s\n", r.workload.c_str(), r.size, r.renderer.c_str(),
                    r.ms_median, r.ms_fastest,
                    own != nullptr ? (number(r.ms_median / own->ms_median, 2) + " x").c_str() : "-",
                    r.from_exact ? number(r.from_exact->psnr_db, 1).c_str() : "-",
                    r.from_exact ? (number(r.from_exact->off_by_8_percent, 3) + " %").c_str() : "-");
    }
}

/// JSON has no infinity; a number beyond the range of doubles is read as one.
inline std::string json_number(double value, int digits) {
    return value <= (std::numeric_limits<double>::max)() ? number(value, digits) : "1e999";
}

inline std::string to_json(const std::vector<row>& rows) {
    std::string text = "[";
    for (const row& r : rows) {
        text += text.size() == 1 ? "\n" : ",\n";
        text += R"(  {"workload": ")" + r.workload + R"(", "size": ")" + std::string(1, r.size) +
                R"(", "renderer": ")" + r.renderer + R"(", "ms_median": )" + number(r.ms_median, 3) +
                R"(, "psnr_db": )" + (r.from_exact ? json_number(r.from_exact->psnr_db, 3) : "null") +
                R"(, "off_by_8_percent": )" + (r.from_exact ? number(r.from_exact->off_by_8_percent, 4) : "null") + "}";
    }
    return text + "\n]\n";
}

/// Bars of the medians, one group for each workload and size, each group to a scale of its own.
inline std::string to_svg(const std::vector<row>& rows) {
    constexpr int left = 190, longest = 480, line = 24, width = 780;
    std::string bars;
    int y = 20;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const row& r = rows[i];
        if (i == 0 || !rows[i - 1].is_beside(r)) {
            y += 18;
            bars +=
                svg::text("16", std::to_string(y), r.workload + " in size " + std::string(1, r.size) + ", ms per frame",
                          " font-weight='bold'");
            y += 10;
        }
        double slowest = 0;
        for (const row& other : rows)
            if (other.is_beside(r) && other.ms_median > slowest) slowest = other.ms_median;
        const row* const own = own_beside(rows, r);
        const double length = longest * r.ms_median / slowest;
        std::string label = number(r.ms_median, r.ms_median < 100 ? 1 : 0);
        if (own != nullptr && own != &r) label += "  (" + number(r.ms_median / own->ms_median, 1) + " x)";
        const std::string base = std::to_string(y + 16);
        bars += svg::text(std::to_string(left - 8), base, r.renderer, " text-anchor='end'") +
                svg::rectangle(std::to_string(left), std::to_string(y + 3), number(length, 1), std::to_string(line - 6),
                               r.renderer == "insonify" ? "#b5651d" : "#8a9ba8") +
                svg::text(number(left + length + 6, 1), base, label);
        y += line;
    }
    return svg::page(width, y + 16, bars);
}

}  // namespace report
