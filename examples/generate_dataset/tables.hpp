// What is made of all records in a folder: annotations.json (COCO), manifest.csv, README.md, tar files of WebDataset
// where the configuration says so, and SHA256SUMS of them. Written as a stream: a million images take the memory of a
// hundred.
#pragma once

#include <string>
#include <vector>

#include "staging.hpp"

namespace generator {

/// @throws io_error if a record is torn, or a table can't be written
/// @param preview  writes preview.html, too
/// @returns how many images the tables list
std::uint64_t write_tables(const std::filesystem::path& root, bool preview, staging& into);

/// What is wrong with the tables and config.json, by SHA256SUMS.
std::vector<std::string> table_faults(const std::filesystem::path& root);

}  // namespace generator
