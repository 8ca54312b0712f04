// Opens the folder of a data set.
#pragma once

#include <filesystem>
#include <string>

namespace generator {

/// The folder of a data set, created if necessary.
/// @throws io_error if it can't be created, or holds something else
std::filesystem::path open_folder(const std::string& out);

/// The path without a trailing slash.
std::filesystem::path folder_path(const std::string& out);

}  // namespace generator
