// Parts of the C++20 library that some standard libraries lack: libc++ has std::bit_cast from version 14 on, floats in
// std::from_chars from 20 on and in std::to_chars from 14 on.
#pragma once

#include <insonify/config.hpp>

#include <bit>
#include <charconv>
#include <clocale>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

namespace insonify {
inline namespace INSONIFY_ABI {

namespace numeric {

inline namespace INSONIFY_FLAGS {

/// The value of type To that has the same bits.
template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
    static_assert(sizeof(To) == sizeof(From) && std::is_trivially_copyable_v<To> && std::is_trivially_copyable_v<From>);
#if defined(__cpp_lib_bit_cast)
    return std::bit_cast<To>(from);
#else
    return __builtin_bit_cast(To, from);
#endif
}

}  // namespace INSONIFY_FLAGS

}  // namespace numeric

namespace detail::inline INSONIFY_FLAGS {

/// Outcome of parsing a number.
enum class number_text { fine, malformed, out_of_range };

/// Reads all of a text as a decimal number, with a sign or without, whatever the locale.
inline number_text parse_number(std::string_view text, double& value) {
    // from_chars does not accept a plus sign.
    if (text.substr(0, 1) == "+" && text.substr(1, 1) != "-") text.remove_prefix(1);
    const char *const first = text.data(), *const last = first + text.size();
#if defined(__cpp_lib_to_chars)
    const auto [end, status] = std::from_chars(first, last, value);
    if (status == std::errc::invalid_argument || end != last) return number_text::malformed;
    return status == std::errc{} ? number_text::fine : number_text::out_of_range;
#else
    // strtod also takes white space and hexadecimal numbers, and expects the locale's decimal point.
    const auto is_taken = [](char c) {
        return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e' || c == 'E';
    };
    std::string copy;
    for (const char* c = first; c != last; ++c) {
        const bool is_word = text.find_first_of("nN") != text.npos && *c != 'x' && *c != 'X' && *c > ' ';  // inf, nan
        if (!is_taken(*c) && !is_word) return number_text::malformed;
        if (*c == '.')
            copy += std::localeconv()->decimal_point;
        else
            copy += *c;
    }
    if (copy.empty() || copy[0] == '+') return number_text::malformed;
    char* end = nullptr;
    value = std::strtod(copy.c_str(), &end);
    if (end != copy.c_str() + copy.size()) return number_text::malformed;
    const bool names_infinity = text.find_first_of("iI") != text.npos;
    const bool overflowed =
        (value > (std::numeric_limits<double>::max)() || value < std::numeric_limits<double>::lowest());
    return overflowed && !names_infinity ? number_text::out_of_range : number_text::fine;
#endif
}

/// The shortest text that reads back as the same number, without the locale; returns its end.
template <class Number>
char* format_number(char* first, char* last, Number value) {
#if !defined(__cpp_lib_to_chars)
    if constexpr (std::is_floating_point_v<Number>) {
        for (int digits = 1; digits <= std::numeric_limits<Number>::max_digits10; ++digits) {
            std::snprintf(first, static_cast<std::size_t>(last - first), "%.*g", digits, static_cast<double>(value));
            if (static_cast<Number>(std::strtod(first, nullptr)) == value) break;
        }
        char* end = first;
        for (; *end != '\0'; ++end)
            if (*end == *std::localeconv()->decimal_point) *end = '.';
        return end;
    } else
#endif
        return std::to_chars(first, last, value).ptr;
}

}  // namespace detail::inline INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify
