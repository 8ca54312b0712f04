// The tables of all records: annotations.json (COCO), manifest.csv, README.md, optionally tar files of WebDataset, and
// SHA256SUMS. Records are streamed: a million images take as much memory as a hundred.
#pragma once

#include <string>
#include <vector>

#include "staging.hpp"

namespace generator {

/// @param preview  also writes preview.html
/// @returns number of images in the tables
/// @throws io_error if a record is damaged, or a table can't be written
std::uint64_t write_tables(const std::filesystem::path& root, bool preview, staging& into);

/// Tables that are missing or contradict SHA256SUMS, one line each.
std::vector<std::string> table_faults(const std::filesystem::path& root);

}  // namespace generator
