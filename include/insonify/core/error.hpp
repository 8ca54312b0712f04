// The library's two exceptions, and the functions that throw them.
//
// Bad elements of large data (a NaN vertex, a degenerate triangle) are not errors: they are skipped and counted.
#pragma once

#include <insonify/config.hpp>
#include <insonify/core/detail/portable.hpp>

#if !defined(__cpp_exceptions)
#include <cstdio>
#endif
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

namespace insonify {
inline namespace INSONIFY_ABI {

/// An argument outside its documented range. `what()` names the argument, its value, and what was expected.
struct invalid_input : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

/// A file that could not be read or written. `what()` names the file and the reason.
struct io_error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

namespace detail::inline INSONIFY_FLAGS {

/// Throws the error. Without exceptions it calls INSONIFY_THROW, or else writes the message to stderr and terminates.
template <class Error>
[[noreturn]] void throw_error(Error error) {
#if defined(__cpp_exceptions)
    throw error;
#elif defined(INSONIFY_THROW)
    INSONIFY_THROW(error);
    std::terminate();
#else
    std::fputs(error.what(), stderr), std::fputs("\n", stderr);
    std::terminate();
#endif
}

template <class T>
concept arithmetic = std::is_arithmetic_v<T>;

/// Shortest text that reads back as the same number, whatever the locale.
template <arithmetic Number>
std::string to_text(Number value) {
    if constexpr (std::is_same_v<Number, bool>) {
        return value ? "true" : "false";
    } else {
        char buffer[64];  // holds any number
        return {buffer, format_number(buffer, buffer + sizeof buffer, value)};
    }
}

/// A quoted word of the input for an error message, cut to its first 40 bytes.
inline std::string quoted(std::string_view word) {
    std::string text(1, '\'');
    text += word.substr(0, 40);
    text += word.size() > 40 ? "...'" : "'";
    return text;
}

/// The name of a list's element in an error, as in "track[17]".
template <arithmetic Number>
std::string element_name(std::string_view list, Number i) {
    return std::string(list).append(1, '[').append(to_text(i)).append(1, ']');
}

[[noreturn]] inline void refuse_text(std::string_view argument, std::string_view value, std::string_view expected) {
    std::string message(argument);
    message.append(" is ").append(value).append(", expected ").append(expected);
    throw_error(invalid_input(message));
}
template <arithmetic Number>
[[noreturn]] void refuse(std::string_view argument, Number value, std::string_view expected) {
    refuse_text(argument, to_text(value), expected);
}

/// Checks a precondition of a public function: `require(width > 0, "width", width, "at least 1")`.
template <arithmetic Number>
void require(bool holds, std::string_view argument, Number value, std::string_view expected) {
    if (!holds) refuse(argument, value, expected);
}
/// For a member of the value that `owner` names; the two are joined only for an error.
template <arithmetic Number>
void require_member(bool holds, std::string_view owner, std::string_view member, Number value,
                    std::string_view expected) {
    if (!holds) refuse(std::string(owner).append(member), value, expected);
}
/// For sizes that must agree: `require_equal("to.width()", to.width(), from.width(), "the width of the result")`.
template <arithmetic Number>
void require_equal(std::string_view argument, Number value, Number expected, std::string_view what) {
    if (value != expected) refuse(argument, value, to_text(expected).append(", ").append(what));
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify
