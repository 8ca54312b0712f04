// Splits the text of a survey into words and numbers.
#pragma once

#include <insonify/core/detail/file.hpp>
#include <insonify/core/numeric.hpp>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed::detail::inline INSONIFY_FLAGS {

/// Whether two words are equal, ignoring case.
inline bool same_word(std::string_view a, std::string_view b) {
    const auto low = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return low(x) == low(y); });
}

/// Reads words and numbers in order. Errors name the line.
class survey_reader {
  public:
    survey_reader(std::string_view text, std::string_view name) : text_(text), name_(name) {
        if (text_.substr(0, 3) == "\xEF\xBB\xBF") at_ = 3;  // byte order mark
    }

    /// The next word, on this line or a later one; empty at the end. Commas and semicolons separate words like blanks.
    std::string_view word() {
        for (; at_ < text_.size() && is_blank(text_[at_]); ++at_) line_ += ends_line(at_) ? 1u : 0u;
        return word_here();
    }
    /// The first word of this line or a later one; a comma or semicolon if its first field is empty.
    std::string_view first_word() {
        for (; at_ < text_.size() && is_blank(text_[at_]) && !is_comma(text_[at_]); ++at_)
            line_ += ends_line(at_) ? 1u : 0u;
        return at_ < text_.size() && is_comma(text_[at_]) ? text_.substr(at_, 1) : word_here();
    }
    /// A field of a line, and what stands before it: ',', ';' or, for blanks alone, ' '.
    struct field {
        std::string_view text;
        char separator;
    };
    /// The next field of this line; empty at its end, and between two commas or semicolons.
    field field_of_line() {
        const auto skip_spaces = [&] {
            while (at_ < text_.size() && is_blank(text_[at_]) && !is_line_break(text_[at_]) && !is_comma(text_[at_]))
                ++at_;
        };
        skip_spaces();
        char separator = ' ';
        if (at_ < text_.size() && is_comma(text_[at_])) separator = text_[at_++];
        skip_spaces();
        return {word_here(), separator};
    }
    /// The next word, which is not consumed.
    std::string_view peek() {
        const std::size_t at = at_, line = line_;
        const std::string_view next = word();
        at_ = at, line_ = line;
        return next;
    }
    void skip_line() {
        while (at_ < text_.size() && !is_line_break(text_[at_])) ++at_;
    }

    /// @param what  for the error
    double number(const char* what) { return number(word(), what); }
    double number(std::string_view digits, const char* what) const {
        if (digits.empty())
            fail(at_ < text_.size() ? std::string(what) + " is missing" : "the text ends before " + std::string(what));
        double value = 0;
        if (!insonify::detail::parse_number(digits, value))
            fail(insonify::detail::quoted(digits) + " is not a number, expected " + what);
        return value;  // may be infinite: files mark missing data by DBL_MAX in few digits, which overflows
    }
    double finite(const char* what) {
        const double value = number(what);
        if (!numeric::is_finite(value)) fail(std::string(what) + " is not finite");
        return value;
    }

    std::size_t left() const { return text_.size() - at_; }

    [[noreturn]] void fail(const std::string& reason) const {
        insonify::detail::raise_io(std::string(name_) + ":" + insonify::detail::to_text(line_), reason);
    }

  private:
    std::string_view word_here() {
        const std::size_t begin = at_;
        while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
        return text_.substr(begin, at_ - begin);
    }
    static bool is_line_break(char c) { return c == '\n' || c == '\r'; }
    /// LF, CR LF and CR each end one line.
    bool ends_line(std::size_t at) const {
        return text_[at] == '\n' || (text_[at] == '\r' && text_.substr(at + 1, 1) != "\n");
    }
    static bool is_comma(char c) { return c == ',' || c == ';'; }
    static bool is_blank(char c) { return (c >= '\t' && c <= '\r') || c == ' ' || is_comma(c); }

    std::string_view text_, name_;
    std::size_t at_ = 0, line_ = 1;
};

}  // namespace seabed::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
