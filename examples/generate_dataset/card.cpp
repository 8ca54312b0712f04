#include "card.hpp"

#include <insonify/core/error.hpp>

#include <algorithm>

namespace generator {

namespace {

constexpr std::size_t max_words = 50;

std::string shown(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

/// Escapes text for a cell of a Markdown table.
std::string cell(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        if (c == '|' || c == '`' || c == '<' || c == '[' || c == '\\' || c == '*') safe += '\\';
        safe += c == '\n' || c == '\r' ? ' ' : c;
    }
    return safe;
}

}  // namespace

void data_card::add(const json& record) {
    ++images_;
    for (const json& entry : record.at("files")) ++files_, bytes_ += entry.at("bytes").get<std::uint64_t>();
    for (const auto& [name, value] : record.at("parameters").items()) {
        if (value.is_null()) continue;
        const auto [found, is_new] = columns_.try_emplace(name);
        if (is_new) names_.push_back(name);
        column& c = found->second;
        if (is_new) c.first = value;
        c.is_constant = c.is_constant && value == c.first;
        if (value.is_number()) {
            const double v = value.get<double>();
            c.lowest = c.count == 0 ? v : std::min(c.lowest, v);
            c.highest = c.count == 0 ? v : std::max(c.highest, v);
            c.sum += v;
        } else {
            const std::string word = value.is_string() ? value.get<std::string>() : value.dump();
            if (c.words.size() < max_words || c.words.contains(word))
                ++c.words[word];
            else
                c.has_more_words = true;
        }
        ++c.count;
    }
    const std::string image = record.at("files").at(0).at("path").get<std::string>();
    samples_.try_emplace(image.substr(7, image.find('/', 7) - 7), image);
}

std::string data_card::text(const json& config) const {
    const auto number = [](auto n) { return std::to_string(n); };
    // A plan may have other sizes and seeds than the options.
    const auto range_of = [&](const std::string& name) {
        const column& c = columns_.at(name);
        return c.is_constant ? c.first.dump() : shown(c.lowest) + " to " + shown(c.highest);
    };
    const std::string size = range_of("size_px");
    std::string t = "# A synthetic side-scan sonar data set\n\n" + number(images_) + " images of " + size + " x " +
                    size + " pixels, with masks, boxes and parameters; " + number(files_) +
                    " files of images and masks, " + number(bytes_) + " bytes. Made by `generate_dataset`, " +
                    config.at("version").get<std::string>() + ", recipe " + config.value("recipe", "published") +
                    ", seed " + range_of("seed") +
                    ".\nEvery pixel is computed; none comes from a recording.\n\n"
                    "`config.json` decides every byte; image i depends on it and on i alone. "
                    "`sha256sum -c SHA256SUMS`\nchecks the tables, `generate_dataset ... --verify` each file.\n";
    t += "\n## Samples\n\n| class | first image |\n|---|---|\n";
    for (const auto& [name, image] : samples_) t += "| " + cell(name) + " | ![" + cell(name) + "](" + image + ") |\n";
    std::string counts, numbers;
    for (const std::string& name : names_) {
        const column& c = columns_.at(name);
        if (c.words.empty()) {
            numbers += "| " + cell(name) + " | " + number(c.count) + " | " + shown(c.lowest) + " | " +
                       shown(c.sum / static_cast<double>(c.count)) + " | " + shown(c.highest) + " |\n";
            continue;
        }
        std::string list;
        for (const auto& [word, count] : c.words) list += (list.empty() ? "" : ", ") + cell(word) + " " + number(count);
        counts += "| " + cell(name) + " | " + list + (c.has_more_words ? ", and others" : "") + " |\n";
    }
    t += "\n## Counts\n\n| parameter | images |\n|---|---|\n" + counts;
    t += "\n## Sampled parameters\n\n| parameter | images | lowest | mean | highest |\n|---|---|---|---|---|\n" +
         numbers;
    t += "\n## Recipe\n\n| option | value |\n|---|---|\n";
    for (const auto& [name, value] : config.items())
        if (name != "inputs") t += "| " + cell(name) + " | " + cell(value.dump()) + " |\n";
    if (const json inputs = config.value("inputs", json::object()); !inputs.empty()) {
        t += "\n## Inputs\n\n| input | bytes | SHA-256 |\n|---|---|---|\n";
        for (const auto& [name, value] : inputs.items())
            t += "| " + cell(name) + " | " + value.at("bytes").dump() + " | " + value.at("sha256").get<std::string>() +
                 " |\n";
    }
    return t;
}

}  // namespace generator
