#include "summary.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>

#include "pictures.hpp"
#include "plan_options.hpp"
#include "views.hpp"

namespace generator {

namespace {

std::string class_of(const options& o, std::uint64_t i) {
    const std::string name = (o.is_sonar() ? view_of_sonar(o, i) : view_of(o, i)).class_name;
    return name.empty() ? "named by the plan" : name;
}

/// "ship 300, plane 300": exact, or scaled up from a hundred thousand images spread over the set.
std::string classes_text(const options& o, const index_range& work) {
    constexpr std::uint64_t limit = 100'000;
    const std::uint64_t sampled = (std::min)(work.size(), limit);
    const auto spread = [](std::uint64_t i, std::uint64_t n, std::uint64_t over) {
        return over / n * i + over % n * i / n;
    };
    std::map<std::string, std::uint64_t> counts;
    for (std::uint64_t i = 0; i < sampled; ++i) ++counts[class_of(o, work.first + spread(i, sampled, work.size()))];
    std::string text;
    for (const auto& [name, count] : counts) {
        const double share = static_cast<double>(count) / static_cast<double>(sampled);
        const auto all = static_cast<std::uint64_t>(share * static_cast<double>(work.size()) + 0.5);
        text += (text.empty() ? "" : ", ") + name + " " + std::to_string(all);
    }
    return text;
}

std::string with_unit(double value, const char* unit) {
    char text[64];
    std::snprintf(text, sizeof text, value < 10 ? "%.1f %s" : "%.0f %s", value, unit);
    return text;
}

std::string bytes_text(double bytes) {
    const char* const units[] = {"kB", "MB", "GB", "TB"};
    std::size_t unit = 0;
    for (bytes /= 1000; bytes >= 1000 && unit + 1 < std::size(units); ++unit) bytes /= 1000;
    return with_unit(bytes, units[unit]);
}

std::string time_text(double seconds) {
    if (seconds < 1) return "less than a second";
    if (seconds < 120) return with_unit(seconds, "seconds");
    if (seconds < 120 * 60) return with_unit(seconds / 60, "minutes");
    if (seconds < 48 * 3600) return with_unit(seconds / 3600, "hours");
    return with_unit(seconds / 86400, "days");
}

}  // namespace

image_cost measured_cost(const options& o, const index_range& work, const shared_inputs& shared) {
    using clock = std::chrono::steady_clock;
    const auto start = clock::now();
    image_cost cost;
    const auto elapsed = [&] { return std::chrono::duration<double>(clock::now() - start).count(); };
    double first = 0;  // includes allocations and tables that later images reuse
    while (cost.images < 2 || (cost.images < 4 && elapsed() < 0.5)) {
        const std::uint64_t step = work.size() / 4;
        const std::uint64_t index = work.first + step * static_cast<std::uint64_t>(cost.images);
        for (const file& f : files_of(o, index, shared)) cost.bytes += static_cast<double>(f.bytes.size());
        if (++cost.images == 1) first = elapsed();
    }
    cost.seconds = (elapsed() - first) / (cost.images - 1);
    cost.bytes /= cost.images;
    // Tar files hold a second copy.
    if (std::find(o.formats.begin(), o.formats.end(), "webdataset") != o.formats.end()) cost.bytes *= 2;
    return cost;
}

std::string summary_of(const options& o, const index_range& work, const image_cost& cost, int threads) {
    const options first = o.table ? with_line(o, line_of_plan(o, work.first)) : o;
    const std::string side = std::to_string(first.size);
    std::string text = o.out + ": " + std::to_string(work.size()) + " images of " + side + " x " + side +
                       " pixels, recipe " + o.recipe + ", seed " + std::to_string(first.seed);
    if (work.first > 0) text += ", from index " + std::to_string(work.first) + " on";
    text += "\n  classes: " + classes_text(o, work) + "\n";
    if (cost.images == 0) return text;
    const auto count = static_cast<double>(work.size());
    return text + "  about " + bytes_text(count * cost.bytes) + ", " + time_text(count * cost.seconds / threads) +
           " on " + std::to_string(threads) + (threads == 1 ? " thread" : " threads") +
           ", less for images that exist already\n";
}

std::string where_to_look(const options& o) {
    std::string text =
        "  images in " + o.out + "/images, masks in " + o.out + "/masks, boxes in " + o.out + "/annotations.json\n";
    if (o.preview) return text + "  open " + o.out + "/preview.html in a browser to look through them\n";
    return text + "  --preview adds a page to look through them\n";
}

}  // namespace generator
