// The files of one image of the sonar recipe.
#pragma once

#include "layout.hpp"
#include "options.hpp"
#include "plan_options.hpp"
#include "sampler.hpp"
#include "views.hpp"

namespace generator {

/// @param view   target and seabed where the plan gives none
/// @param given  a line of a plan, or null
/// @throws insonify::io_error for a value of the plan that can't be drawn
std::vector<file> files_of_sonar(const options& o, std::uint64_t index, const view_of_target& view,
                                 const plan_row* given);

/// The columns that plans of this recipe may have.
known_columns columns_of_sonar_recipe(const options& o);

}  // namespace generator
