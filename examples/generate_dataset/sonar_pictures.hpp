// From an index to the files of one image of the sonar recipe.
#pragma once

#include "layout.hpp"
#include "options.hpp"
#include "plan_options.hpp"
#include "sampler.hpp"
#include "views.hpp"

namespace generator {

/// @param view   what a line of a plan leaves open
/// @param given  a line of a plan, or null
/// @throws insonify::io_error for a plan's value that can't be drawn
std::vector<file> files_of_sonar(const options& o, std::uint64_t index, const view_of_target& view,
                                 const plan_row* given);

/// What a plan may say of the images of this recipe.
known_columns known_to_sonar(const options& o);

}  // namespace generator
