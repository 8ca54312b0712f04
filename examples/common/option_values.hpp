// Strict checks of option values. Errors name the option, the value and the expected form.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>

#include "parse.hpp"
#include <CLI/CLI.hpp>

namespace examples {

/// Decimal digits, in [low, high]; -1, 1e3 and 10^12 are refused rather than wrapped or truncated, and so is 010, which
/// CLI11 reads as octal.
inline CLI::Validator whole_number(std::uint64_t low, std::uint64_t high) {
    return CLI::Validator(
        [low, high](std::string& text) -> std::string {
            std::uint64_t value = 0;
            const bool is_whole = parse(text, value);
            if (is_whole && text.size() > 1 && text[0] == '0')
                return "'" + text + "' begins with 0, as octal numbers do";
            if (is_whole && value >= low && value <= high) return "";
            return "'" + text + "' is not a whole number from " + std::to_string(low) + " to " + std::to_string(high);
        },
        "", "whole number");
}

/// A number in [low, high]; not NaN.
inline CLI::Validator number(double low, double high) {
    return CLI::Validator(
        [low, high](std::string& text) -> std::string {
            double value = 0;
            if (parse(text, value) && value >= low && value <= high) return "";
            return "'" + text + "' is not a number from " + CLI::detail::to_string(low) + " to " +
                   CLI::detail::to_string(high);
        },
        "", "number");
}

/// Name of a folder that exists or can be created.
inline CLI::Validator folder_to_fill() {
    return CLI::Validator(
        [](std::string& name) -> std::string {
            if (name.empty()) return "an empty name is not a folder";
            std::error_code ignored;
            const auto status = std::filesystem::status(name, ignored);
            return std::filesystem::exists(status) && !std::filesystem::is_directory(status)
                       ? "'" + name + "' is not a folder"
                       : "";
        },
        "", "folder");
}

}  // namespace examples
