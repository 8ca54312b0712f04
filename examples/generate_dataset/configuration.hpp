// What is pinned in the folder of a data set: two runs into one folder must agree on all of it.
#pragma once

#include "staging.hpp"
#include "stock.hpp"
#include <nlohmann/json.hpp>

namespace generator {

using json = nlohmann::ordered_json;

/// Recipe, seed, version, and the contents of all inputs.
json configuration_of(const options& o, const std::vector<input>& inputs);

/// Which images a set that is made by shards shall have.
json shards_of(const options& o);

/// Writes `now` as a file of the folder, unless it is there. Of several processes, one is first; the others compare.
/// @throws io_error that names each value that differs, as it was and as it is
void pin(const std::filesystem::path& root, const std::string& name, const json& now, staging& into);

/// @throws io_error that names each value that differs
void check_pinned(const std::filesystem::path& root, const json& before, const json& now);

/// A pinned file, or null if there is none.
/// @throws io_error if it is damaged
json pinned(const std::filesystem::path& root, const std::string& name);

}  // namespace generator
