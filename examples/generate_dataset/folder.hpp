// Opens the folder of a data set, for a generator or a merge.
#pragma once

#include <filesystem>
#include <string>

namespace generator {

/// The folder of a data set, made if need be.
/// @throws io_error if it can't be made, or holds something else
std::filesystem::path opened(const std::string& out);

/// Without a slash at the end.
std::filesystem::path folder_path(const std::string& out);

}  // namespace generator
