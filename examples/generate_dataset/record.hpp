// The record of an image: its parameters and annotations, and size and checksum of each of its files.
//
//     {"id":7,"files":[{"of":"image","path":...,"bytes":...,"sha256":...},...],"size":128,"annotations":[...],
//      "parameters":{...},"sha256":"..."}
//
// The last member is the checksum of the text before it. An image is complete if its record's checksum is right and its
// files have the sizes and checksums that the record lists.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "layout.hpp"
#include <nlohmann/json.hpp>

namespace generator {

using json = nlohmann::ordered_json;

/// A file's entry in a record.
json entry_of(const std::string& of, const file& f);

/// The record as text, with its checksum.
std::string record_text(const json& record);

/// @param name  of the file, for the error
/// @throws io_error if the record is truncated or altered
json parse_record(const std::string& text, const std::string& name);

/// What is compared with a record: the sizes of files; also their checksums; also decoded masks with annotations.
enum class depth { sizes, checksums, pixels };

/// Why an image is incomplete: its record or one of its files is missing or altered, or the record is of a set with
/// another seed, recipe or size. Empty if it is complete.
/// @param config  the set's config.json
std::optional<std::string> fault_of(const std::filesystem::path& root, std::uint64_t index, const json& config,
                                    depth checked);

/// Which of seed, recipe and size of a record are not the set's; empty if all are. Rows of a plan may have their own.
std::string differing_parameters(const json& record, const json& config);

/// Calls `visit` with the relative path of each record, by increasing id. Holds the names of one block in memory.
/// @throws io_error for a file whose name is not a record's
void for_each_record(const std::filesystem::path& root,
                     const std::function<void(const std::string& path, std::uint64_t index)>& visit);

}  // namespace generator
