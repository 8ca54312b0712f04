#include "plan_table.hpp"

#include <algorithm>
#include <unordered_map>

#include "../common/parse.hpp"
#include "csv.hpp"
#include "layout.hpp"

namespace generator {

namespace {

/// Columns of a table of targets, and their names in a manifest.
constexpr const char* manifest_names[][2] = {{"id", "target_id"},
                                             {"shape", "class"},
                                             {"length", "length_m"},
                                             {"width", "width_m"},
                                             {"height", "height_m"},
                                             {"volume_factor", ""},
                                             {"orientation", "orientation_deg"}};

/// The published generator's table: number, group and number within it, shape, extents, their geometric mean,
/// orientation in degrees. Its program also writes a shorter one.
const std::vector<std::string> published_columns{"target_id", "",         "", "class",          "length_m",
                                                 "width_m",   "height_m", "", "orientation_deg"};
const std::vector<std::string> published_short{"target_id", "class", "length_m",       "width_m",
                                               "height_m",  "",      "orientation_deg"};
/// Its shapes by number.
const std::vector<std::string> published_shapes{"", "cylinder", "cube", "sphere", "cone"};

using examples::parse;

bool is_number(const std::string& text) {
    double value = 0;
    return parse(text, value);
}

/// Replaces the number of a shape, as the published table has it, by its name.
void name_shape(plan_row& row) {
    const std::string* const shape = row.find("class");
    if (shape != nullptr && is_number(*shape))
        row.cells["class"] = published_shapes[row.whole("class", 0, 1, published_shapes.size() - 1)];
}

}  // namespace

void plan_row::refuse(const std::string& column, const std::string& expected) const {
    const std::string* const value = find(column);
    throw plan_error("--plan " + table + ": line " + std::to_string(line) + ": column " + column + " has '" +
                     (value == nullptr     ? ""
                      : value->size() > 60 ? value->substr(0, 60) + "..."
                                           : *value) +
                     "', expected " + expected);
}

double plan_row::number(const std::string& column, double otherwise, double low, double high) const {
    const std::string* const text = find(column);
    if (text == nullptr) return otherwise;
    double value = 0;
    if (!parse(*text, value) || !(value >= low && value <= high))
        refuse(column, "a number from " + insonify::detail::to_text(low) + " to " + insonify::detail::to_text(high));
    return value;
}

std::uint64_t plan_row::whole(const std::string& column, std::uint64_t otherwise, std::uint64_t low,
                              std::uint64_t high) const {
    const std::string* const text = find(column);
    if (text == nullptr) return otherwise;
    std::uint64_t value = 0;
    if (!parse(*text, value) || value < low || value > high)
        refuse(column, "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    return value;
}

plan_table::plan_table(std::string name, std::string text) : name_(std::move(name)), text_(std::move(text)) {
    scan();
}

bool plan_table::has(const std::string& column) const {
    return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

void plan_table::name_columns(std::vector<std::string>& first, std::size_t line) {
    const auto fail = [&](const std::string& what) {
        throw plan_error("--plan " + name_ + ": line " + std::to_string(line) + ": " + what);
    };
    const bool all_numbers = std::all_of(first.begin(), first.end(),
                                         [](const std::string& cell) { return cell.empty() || is_number(cell); });
    if (all_numbers) {
        // The published generator ends each line with a comma.
        const std::size_t cells = first.size() - (first.back().empty() ? 1 : 0);
        is_named_ = false;
        columns_ = cells == published_columns.size() ? published_columns : published_short;
        if (cells != columns_.size())
            fail("has " + std::to_string(cells) +
                 " cells, all numbers; add a header line, or give the 9 or 7 columns of the published table");
        columns_.resize(first.size());
        return;
    }
    for (std::string& column : first) {
        for (const auto& [from, to] : manifest_names)
            if (column == from) column = to;
        if (!column.empty() && std::count(columns_.begin(), columns_.end(), column) > 0)
            fail("names the column '" + column + "' twice");
        columns_.push_back(column);
    }
    if (first.size() == 1 && first[0].find(';') != std::string::npos) fail("has one column; separate cells by commas");
    if (!has("class")) fail("has no column class or shape; it has '" + columns_.front() + "' and others");
}

void plan_table::scan() {
    csv_reader reader("--plan " + name_, text_);
    std::vector<std::string> cells;
    if (!reader.next(cells)) throw plan_error("--plan " + name_ + ": is empty, expected a header line");
    name_columns(cells, reader.line());
    std::unordered_map<std::string, std::size_t> lines_of_targets;
    for (bool more = !is_named_ || reader.next(cells); more; more = reader.next(cells)) {
        check_length(cells, reader.line());
        // Reads only the columns that identify the image and its class.
        plan_row row{name_, reader.line(), {}};
        for (const char* const name : {"index", "class", "target_id", "categories"})
            for (std::size_t i = 0; i < columns_.size(); ++i)
                if (columns_[i] == name) row.cells[name] = cells[i];
        name_shape(row);
        const std::string* const target = row.find("target_id");
        if (row.find("class") == nullptr) row.refuse("class", "the name of a class");
        if (has_ids() && row.find("index") == nullptr) row.refuse("index", "the number of an image");
        // Ids are unique in a table of targets; in a manifest many lines share a target.
        if (target != nullptr && !has_ids()) {
            const auto [known, is_new] = lines_of_targets.try_emplace(*target, reader.line());
            if (!is_new)
                row.refuse("target_id", "a value that line " + std::to_string(known->second) + " does not have");
        }
        add_classes(row);
        rows_.push_back({row.whole("index", rows_.size(), 0, max_images - 1), reader.begin(), reader.line()});
    }
    if (rows_.empty()) throw plan_error("--plan " + name_ + ": has a header and no other line");
    std::sort(rows_.begin(), rows_.end(),
              [](const line_entry& a, const line_entry& b) { return a.id != b.id ? a.id < b.id : a.line < b.line; });
    for (std::size_t i = 1; i < rows_.size(); ++i)
        if (rows_[i].id == rows_[i - 1].id)
            row(i).refuse("index", "a value that line " + std::to_string(rows_[i - 1].line) + " does not have");
}

void plan_table::check_length(const std::vector<std::string>& cells, std::size_t line) const {
    if (cells.size() == columns_.size()) return;
    const std::string expected =
        "has " + std::to_string(cells.size()) + " cells for " + std::to_string(columns_.size()) + " columns: ";
    const std::size_t first = cells.size();
    throw plan_error(
        "--plan " + name_ + ": line " + std::to_string(line) + ": " + expected +
        (first < columns_.size()
             ? "column " + (columns_[first].empty() ? std::to_string(first + 1) : columns_[first]) + " is missing"
             : "'" + cells[columns_.size()] + "' is too many"));
}

void plan_table::add_classes(const plan_row& row) {
    const auto add = [&](const std::string& name) {
        if (!name.empty() && std::find(classes_.begin(), classes_.end(), name) == classes_.end())
            classes_.push_back(name);
    };
    const std::string* const categories = row.find("categories");
    for (std::string_view list = categories == nullptr ? std::string_view() : *categories; !list.empty();) {
        const std::size_t end = (std::min)(list.find(';'), list.size());
        add(std::string(list.substr(0, end)));
        list.remove_prefix((std::min)(end + 1, list.size()));
    }
    add(row.cells.at("class"));  // which the list may lack if the line was edited
}

plan_row plan_table::row(std::size_t i) const {
    const line_entry& at = rows_[i];
    csv_reader reader("--plan " + name_, std::string_view(text_).substr(at.begin), at.line);
    std::vector<std::string> cells;
    reader.next(cells);
    plan_row row{name_, at.line, {}};
    for (std::size_t c = 0; c < columns_.size() && c < cells.size(); ++c)
        if (!columns_[c].empty()) row.cells.emplace(columns_[c], std::move(cells[c]));
    name_shape(row);
    return row;
}

}  // namespace generator
