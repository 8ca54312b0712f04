// The record of an image: its parameters and annotations, and size and checksum of each of its files.
//
//     {"id":7,"files":[{"of":"image","path":...,"bytes":...,"sha256":...},...],"size":128,"annotations":[...],
//      "parameters":{...},"sha256":"..."}
//
// The last member seals the record: it is the checksum of all that is before it. An image counts if its record is
// whole; it is complete if its files are what the record says.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "layout.hpp"
#include <nlohmann/json.hpp>

namespace generator {

using json = nlohmann::ordered_json;

/// How a record names a file.
json entry_of(const std::string& of, const file& f);

/// The text of a record's file.
std::string sealed(const json& record);

/// @param name  of the file, for the error
/// @throws io_error if the text is not a whole record
json parse_record(const std::string& text, const std::string& name);

/// What is wrong with an image: why its record or one of its files is missing or not what it was. Nothing if it is
/// complete.
/// @param thorough  decodes the files, too, and compares masks with annotations
std::optional<std::string> fault_of(const std::filesystem::path& root, std::uint64_t index, bool thorough);

/// Calls `visit` with the path, within the folder, of each record, by increasing id. Holds one block of names in
/// memory.
/// @throws io_error for a file that is no record by its name
void for_each_record(const std::filesystem::path& root,
                     const std::function<void(const std::string& path, std::uint64_t index)>& visit);

}  // namespace generator
