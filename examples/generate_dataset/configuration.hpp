// The pinned configuration of a data set: all runs into one folder must have the same.
#pragma once

#include "shared_inputs.hpp"
#include "staging.hpp"
#include <nlohmann/json.hpp>

namespace generator {

using json = nlohmann::ordered_json;

/// Recipe, seed, version and the checksums of all inputs.
json configuration_of(const options& o, const std::vector<input>& inputs);

/// The images of a set that is made in shards.
json shards_of(const options& o);

/// Writes `now` to a file of the folder, or compares it with the existing one. Concurrent processes are safe: one
/// writes, the others compare.
/// @throws io_error that lists each value that differs, old and new
void pin(const std::filesystem::path& root, const std::string& name, const json& now, staging& into);

/// @throws io_error that lists each value that differs
void check_pinned(const std::filesystem::path& root, const json& before, const json& now);

/// A pinned file; null if it does not exist.
/// @throws io_error if it is damaged
json pinned(const std::filesystem::path& root, const std::string& name);

}  // namespace generator
