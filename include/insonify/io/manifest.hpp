// CSV tables as in RFC 4180, such as the manifest of a data set, written atomically.
//
// Based on: Yakov Shafranovich. Common Format and MIME Type for Comma-Separated Values (CSV) Files. RFC 4180, 2005.
#pragma once

#include <insonify/io/file.hpp>

#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {
template <class T>
concept csv_text = std::convertible_to<const T&, std::string_view>;
template <class T>
concept csv_number = std::is_arithmetic_v<T> && !std::same_as<T, char>;
}  // namespace detail::inline INSONIFY_FLAGS

/// What a cell may hold: text, true or false, or a number, which is written so that it reads back as the same one.
template <class T>
concept csv_cell = detail::csv_text<T> || detail::csv_number<T>;

inline namespace INSONIFY_FLAGS {

/// A table with named columns, kept as text. Cells with commas, quotes or line breaks are quoted; lines end with CR LF.
class csv_table {
  public:
    /// @throws invalid_input for a table without columns
    explicit csv_table(std::initializer_list<std::string_view> columns) : columns_(columns.size()) {
        detail::require(columns_ > 0, "columns", columns_, "at least 1");
        std::size_t index = 0;
        for (const std::string_view name : columns) append(text_, name, index++);
        text_ += "\r\n";
    }

    /// Adds a line: `table.add("image_0001.png", 12, 0.25f)`.
    /// @throws invalid_input if there isn't one cell for each column
    template <csv_cell... Cells>
    void add(const Cells&... cells) {
        detail::require_equal("number of cells in a row", sizeof...(cells), columns_, "one for each column");
        // The line is whole before it is added, should memory run out. A row without cells uses no index.
        std::string line;
        [[maybe_unused]] std::size_t index = 0;
        (append(line, cells, index++), ...);
        line += "\r\n";
        text_ += line;
    }

    const std::string& text() const { return text_; }

    /// @throws io_error, naming the file, if it can't be written
    void write(const std::string& path) const { write_file(path, text_); }

  private:
    template <csv_cell Cell>
    void append(std::string& line, const Cell& cell, std::size_t index) const {
        if (index > 0) line += ',';
        if constexpr (detail::csv_text<Cell>)
            append_text(line, cell);
        else
            line += detail::to_text(cell);
    }
    void append_text(std::string& line, std::string_view cell) const {
        // An empty cell alone would make an empty line, which readers skip.
        const bool quote = cell.find_first_of(",\"\r\n") != std::string_view::npos || (cell.empty() && columns_ == 1);
        if (!quote) {
            line += cell;
            return;
        }
        line += '"';
        for (const char c : cell) {
            if (c == '"') line += '"';
            line += c;
        }
        line += '"';
    }

    std::size_t columns_;
    std::string text_;
};

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify
