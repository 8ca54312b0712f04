// The table of `--plan`: a line for each image or each target, whose cells give what is drawn at random otherwise.
//
// Three tables are plans: the manifest.csv of a set, which makes it again; a table of targets with names of columns, of
// which each is shown at every aspect on every seabed; and the published generator's table, which has no names.
// docs/dataset.md lists the columns.
#pragma once

#include <insonify/core/error.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace generator {

/// A plan that is wrong; says where: file, line, column and value.
struct plan_error : insonify::io_error {
    using insonify::io_error::io_error;
};

/// A line of a plan: cells by the names of their columns. An empty cell gives nothing.
struct plan_row {
    std::string table;     ///< name of the file
    std::size_t line = 0;  ///< from 1
    std::map<std::string, std::string> cells;

    /// The cell of a column, or null where nothing is given.
    const std::string* find(const std::string& column) const {
        const auto found = cells.find(column);
        return found == cells.end() || found->second.empty() ? nullptr : &found->second;
    }
    /// @throws plan_error that names line, column and value
    [[noreturn]] void refuse(const std::string& column, const std::string& expected) const;
    /// The number in a column, or null where nothing is given.
    /// @throws plan_error unless it is a number within [low, high]
    double number(const std::string& column, double otherwise, double low, double high) const;
    /// A whole number in [low, high].
    std::uint64_t whole(const std::string& column, std::uint64_t otherwise, std::uint64_t low,
                        std::uint64_t high) const;
};

class plan_table {
  public:
    /// @param name  of the file
    /// @throws plan_error, with line, column and value, for text that is no plan
    plan_table(std::string name, std::string text);

    /// Lines that say something, in the order of their images.
    std::size_t size() const { return rows_.size(); }
    plan_row row(std::size_t i) const;

    /// Whether lines say which image they are: then each is one image.
    bool has_ids() const { return has("index"); }
    std::uint64_t id(std::size_t i) const { return rows_[i].id; }

    /// Whether this is the published generator's table, without names of columns.
    bool is_published() const { return !is_named_; }
    bool has(const std::string& column) const;
    /// By their names in a manifest; those that nothing is read from are empty.
    const std::vector<std::string>& columns() const { return columns_; }
    /// The classes of all lines, in the order of their category numbers.
    const std::vector<std::string>& classes() const { return classes_; }
    const std::string& name() const { return name_; }
    const std::string& text() const { return text_; }

  private:
    struct place {
        std::uint64_t id, begin;
        std::size_t line;
    };
    plan_row row_at(const place& at) const;
    void name_columns(std::vector<std::string>& first, std::size_t line);
    void scan();
    void check_length(const std::vector<std::string>& cells, std::size_t line) const;
    void add_classes(const plan_row& row);

    std::string name_, text_;
    std::vector<std::string> columns_;
    std::vector<std::string> classes_;
    std::vector<place> rows_;
    bool is_named_ = true;  ///< has a line with the names of its columns
};

}  // namespace generator
