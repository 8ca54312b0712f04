// Tables of comma-separated values (RFC 4180).
#pragma once

#include <string>
#include <string_view>

namespace generator {

/// A cell: quoted where it must be.
inline std::string csv_cell(std::string_view text) {
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + '"';
}

}  // namespace generator
