// Parts of the C++20 library that some standard libraries lack: libc++ has std::bit_cast from version 14 on, and floats
// in both std::from_chars and std::to_chars from 20 on.
#pragma once

#include <insonify/config.hpp>

#include <algorithm>
#include <bit>
#include <charconv>
#include <clocale>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
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

/// Parses the whole text as a decimal number, `inf`, `infinity` or `nan`, with an optional sign, whatever the locale.
/// Numbers beyond a double's range become 0 or infinity.
/// @param value  the number; unspecified if the text is none
/// @returns whether the text is a number
inline bool parse_number(std::string_view text, double& value) {
    // from_chars does not accept a plus sign.
    if (text.substr(0, 1) == "+" && text.substr(1, 1) != "-") text.remove_prefix(1);
#if defined(__cpp_lib_to_chars)
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    // Some from_chars read nan(...), with any text in the parentheses.
    if (status == std::errc::invalid_argument || end != text.data() + text.size() || text.back() == ')') return false;
    if (status == std::errc::result_out_of_range) {
        // The status is the same at both ends of the range; the decimal exponent of the first nonzero digit tells them
        // apart.
        const std::size_t mark = (std::min)(text.find_first_of("eE"), text.size());
        const std::size_t point = (std::min)(text.find('.'), mark), first = text.find_first_of("123456789");
        double exponent = 0;
        if (mark < text.size()) parse_number(text.substr(mark + 1), exponent);
        exponent += static_cast<double>(point) - static_cast<double>(first);
        value = exponent < 0 ? 0 : (text[0] == '-' ? -1 : 1) * std::numeric_limits<double>::infinity();
    }
    return true;
#else
    // strtod also takes white space and hexadecimal numbers, and expects the locale's decimal point.
    if (text.empty() || text[0] == '+' || text.find_first_not_of("0123456789.+-eEinfatyINFATY") != text.npos)
        return false;
    std::string copy(text);
    if (const std::size_t point = copy.find('.'); point != copy.npos)
        copy.replace(point, 1, std::localeconv()->decimal_point);
    char* end = nullptr;
    value = std::strtod(copy.c_str(), &end);
    return end == copy.c_str() + copy.size();
#endif
}

/// Writes the shortest text that reads back as the same number, whatever the locale; not null-terminated.
/// @pre 64 characters from `first` to `last`, which hold any number
/// @returns the end of the text
template <class Number>
char* format_number(char* first, char* last, Number value) {
#if !defined(__cpp_lib_to_chars)
    if constexpr (std::is_floating_point_v<Number>) {
        for (int digits = 1; digits <= std::numeric_limits<Number>::max_digits10; ++digits) {
            std::snprintf(first, static_cast<std::size_t>(last - first), "%.*g", digits, static_cast<double>(value));
            if (static_cast<Number>(std::strtod(first, nullptr)) == value) break;
        }
        const std::string_view point = std::localeconv()->decimal_point;  // of several bytes in some locales
        char* const at = std::strstr(first, point.data());
        char* const end = first + std::strlen(first);
        if (at == nullptr) return end;
        *at = '.';
        return point.size() == 1 ? end : std::copy(at + point.size(), end, at + 1);
    } else
#endif
        return std::to_chars(first, last, value).ptr;
}

}  // namespace detail::inline INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify
