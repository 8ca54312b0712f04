// Tables of comma-separated values (RFC 4180).
#pragma once

#include <insonify/core/error.hpp>

#include <string>
#include <string_view>
#include <vector>

#include "../common/input_file.hpp"

namespace generator {

/// A cell, quoted if necessary.
inline std::string csv_cell(std::string_view text) {
    const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
    // Readers strip blanks around unquoted cells.
    const bool is_padded = !text.empty() && (is_blank(text.front()) || is_blank(text.back()));
    if (!is_padded && text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + '"';
}

/// Reads a table record by record. Lines end with LF or CR LF; empty lines are skipped, as are blanks around unquoted
/// cells.
class csv_reader {
  public:
    static constexpr std::size_t max_cells = 4096;  ///< per line

    /// @param name  of the table, for errors
    /// @param text  outlives the reader
    /// @param line  number of the first line of `text`, from 1
    csv_reader(std::string name, std::string_view text, std::size_t line = 1)
        : name_(std::move(name)), text_(text), next_line_(line) {
        if (line == 1 && text_.starts_with("\xEF\xBB\xBF")) at_ = 3;  // a byte-order mark
    }

    /// Reads the next record. @returns false at the end of the table
    /// @throws io_error, with the numbers of line and column, for malformed text
    bool next(std::vector<std::string>& cells) {
        while (at_ < text_.size() && (text_[at_] == '\n' || text_.substr(at_).starts_with("\r\n"))) end_line();
        if (at_ >= text_.size()) return false;
        begin_ = at_, line_ = next_line_;
        cells.clear();
        for (;;) {
            const std::size_t column = cells.size() + 1;
            if (column > max_cells) fail(column, "is one too many; a line has at most 4096 cells");
            cells.push_back(at_ < text_.size() && text_[at_] == '"' ? quoted(column) : plain(column));
            if (at_ >= text_.size()) return true;
            if (text_[at_] != ',') break;
            ++at_;
        }
        end_line();
        return true;
    }

    std::size_t line() const { return line_; }    ///< of the record, from 1
    std::size_t begin() const { return begin_; }  ///< of the record, bytes

  private:
    [[noreturn]] void fail(std::size_t column, const std::string& what) const {
        throw insonify::io_error(name_ + ": line " + std::to_string(line_) + ", column " + std::to_string(column) +
                                 ": " + what);
    }
    void end_line() {
        at_ += text_[at_] == '\r' ? 2u : 1u;
        ++next_line_;
    }
    bool at_end_of_cell() const {
        return at_ >= text_.size() || text_[at_] == ',' || text_[at_] == '\n' || text_.substr(at_, 2) == "\r\n";
    }
    void check(std::size_t column) const {
        if (examples::is_control(text_[at_])) fail(column, "holds a control character; a table is plain text");
    }
    std::string plain(std::size_t column) {
        const std::size_t begin = at_;
        for (; !at_end_of_cell(); ++at_) {
            check(column);
            if (text_[at_] == '"') fail(column, "has a quote within a cell; quote the whole cell and double the quote");
            if (text_[at_] == '\r')
                fail(column, "has a carriage return without a line feed; end lines with LF or CR LF");
        }
        std::string_view cell = text_.substr(begin, at_ - begin);
        while (!cell.empty() && (cell.front() == ' ' || cell.front() == '\t')) cell.remove_prefix(1);
        while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\t')) cell.remove_suffix(1);
        return std::string(cell);
    }
    std::string quoted(std::size_t column) {
        std::string cell;
        for (++at_;; ++at_) {
            if (at_ >= text_.size()) fail(column, "opens a quote that is never closed");
            check(column);
            if (text_[at_] == '"') {
                if (at_ + 1 >= text_.size() || text_[at_ + 1] != '"') break;
                ++at_;
            }
            if (text_[at_] == '\n') ++next_line_;
            cell += text_[at_];
        }
        ++at_;
        if (!at_end_of_cell()) fail(column, "goes on after the closing quote; quote the whole cell");
        return cell;
    }

    std::string name_;
    std::string_view text_;
    std::size_t at_ = 0, begin_ = 0, line_ = 1, next_line_ = 1;
};

}  // namespace generator
