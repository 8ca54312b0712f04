// annotations.json (COCO) and manifest.csv of all records in a folder, and SHA256SUMS of both: written as a stream, so
// that a million images take no more memory than a hundred.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "staging.hpp"

namespace generator {

/// @throws io_error if a record is torn, or a table can't be written
/// @returns how many images the tables list
std::uint64_t write_tables(const std::filesystem::path& root, const std::vector<std::string>& classes, staging& into);

/// What is wrong with the tables and config.json, by SHA256SUMS.
std::vector<std::string> table_faults(const std::filesystem::path& root);

/// A cell of a CSV table (RFC 4180): quoted where it must be.
std::string csv_cell(std::string_view text);

}  // namespace generator
