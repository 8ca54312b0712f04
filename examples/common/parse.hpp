// Numbers from texts, whole or not at all.
#pragma once

#include <insonify/core/detail/portable.hpp>

#include <charconv>
#include <concepts>
#include <string_view>
#include <system_error>

namespace examples {

/// Reads all of a text as a whole number.
/// @returns whether it is one that `value` can hold
template <std::unsigned_integral Number>
bool parse(std::string_view text, Number& value) {
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    return status == std::errc{} && end == text.data() + text.size();
}
/// Reads all of a text as a decimal number, `inf` or `nan`, without a plus sign; numbers beyond those of a double
/// become 0 or infinite. Standard libraries without std::from_chars for doubles, as libc++ before 20, will do.
inline bool parse(std::string_view text, double& value) {
    return !text.starts_with('+') && insonify::detail::parse_number(text, value);
}

}  // namespace examples
