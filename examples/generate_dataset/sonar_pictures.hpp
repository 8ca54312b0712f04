// From an index to the files of one image of the sonar recipe.
#pragma once

#include "layout.hpp"
#include "options.hpp"
#include "sampler.hpp"

namespace generator {

/// @param given  values that a plan gives, or null
/// @throws insonify::io_error for a plan's value that can't be drawn
std::vector<file> files_of_sonar(const options& o, std::uint64_t index, const std::string& class_name,
                                 const plan_row* given);

}  // namespace generator
