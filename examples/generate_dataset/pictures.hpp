// Draws an image and encodes its files: image, masks and record.
#pragma once

#include <vector>

#include "layout.hpp"
#include "shared_inputs.hpp"

namespace generator {

/// The files of the i-th image of a set; the record is the last one.
/// @throws io_error, with the image and the options or the plan's line at fault, if it can't be drawn
std::vector<file> files_of(const options& o, std::uint64_t i, const shared_inputs& shared);

/// @throws plan_error if `--plan` has a column or value that the recipe does not have
void check_plan(const options& o, const shared_inputs& shared);

/// Sets the compression of PNG files. Call once, before the first image.
void set_png_compression();

}  // namespace generator
