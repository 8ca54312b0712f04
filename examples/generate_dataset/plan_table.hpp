// The table of `--plan`: a line for each image or target, whose cells replace random values.
//
// Three kinds of tables are plans: the manifest.csv of a set, which makes it again; a table of targets with a header,
// each of which is shown at every aspect on every seabed; and the published generator's table, which has no header.
// docs/dataset.md lists the columns.
#pragma once

#include <insonify/core/error.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace generator {

/// An invalid plan; the message names file, line, column and value.
struct plan_error : insonify::io_error {
    using insonify::io_error::io_error;
};

/// A line of a plan: cells by column. An empty cell gives no value.
struct plan_row {
    std::string table;     ///< name of the file
    std::size_t line = 0;  ///< from 1
    std::map<std::string, std::string> cells;

    /// The cell of a column; null if it is empty or absent.
    const std::string* find(const std::string& column) const {
        const auto found = cells.find(column);
        return found == cells.end() || found->second.empty() ? nullptr : &found->second;
    }
    /// @throws plan_error that names line, column and value
    [[noreturn]] void refuse(const std::string& column, const std::string& expected) const;
    /// The number in a column, or `otherwise` if there is none.
    /// @throws plan_error if it is not a number in [low, high]
    double number(const std::string& column, double otherwise, double low, double high) const;
    /// An integer in [low, high], or `otherwise`.
    std::uint64_t whole(const std::string& column, std::uint64_t otherwise, std::uint64_t low,
                        std::uint64_t high) const;
};

/// A parsed plan.
class plan_table {
  public:
    /// @param name  of the file
    /// @throws plan_error, with line, column and value, for an invalid plan
    plan_table(std::string name, std::string text);

    /// Number of images or targets: lines after the header.
    std::size_t size() const { return rows_.size(); }
    /// The i-th line, sorted by index.
    plan_row row(std::size_t i) const;

    /// Whether lines have an index; each of them is then one image.
    bool has_ids() const { return has("index"); }
    std::uint64_t id(std::size_t i) const { return rows_[i].id; }

    /// Whether this is the published generator's table, which has no header.
    bool is_published() const { return !is_named_; }
    bool has(const std::string& column) const;
    /// Columns by their names in a manifest; ignored ones are empty.
    const std::vector<std::string>& columns() const { return columns_; }
    /// The classes of all lines, in the order of their category numbers.
    const std::vector<std::string>& classes() const { return classes_; }
    const std::string& name() const { return name_; }
    const std::string& text() const { return text_; }

  private:
    struct line_entry {
        std::uint64_t id, begin;
        std::size_t line;
    };
    void name_columns(std::vector<std::string>& first, std::size_t line);
    void scan();
    void check_length(const std::vector<std::string>& cells, std::size_t line) const;
    void add_classes(const plan_row& row);

    std::string name_, text_;
    std::vector<std::string> columns_;
    std::vector<std::string> classes_;
    std::vector<line_entry> rows_;
    bool is_named_ = true;  ///< has a header
};

}  // namespace generator
