// From plan to files: draws an image, and packs it with its masks and its record.
#pragma once

#include <vector>

#include "layout.hpp"
#include "stock.hpp"

namespace generator {

/// The files of the i-th image of a set, and last its record.
/// @throws io_error, with the image and the options or the plan's line at fault, if it can't be drawn
std::vector<file> files_of(const options& o, std::uint64_t i, const stock& shared);

/// @throws plan_error if a line of `--plan` has a column or a value that the recipe has none of
void check_plan(const options& o, const stock& shared);

/// How PNG files are packed: to be called once, before the first.
void set_packing();

}  // namespace generator
