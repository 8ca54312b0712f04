// From plan to files: draws an image, and packs it with its masks and its record.
#pragma once

#include <vector>

#include "layout.hpp"
#include "stock.hpp"

namespace generator {

/// The files of an image, and last its record.
/// @throws io_error, with the index and the options at fault, if the plan can't be drawn
std::vector<file> files_of(const options& o, const plan& p, const stock& shared);

/// The files of image `index` of whichever recipe.
std::vector<file> files_of(const options& o, std::uint64_t index, const stock& shared);

/// How PNG files are packed: to be called once, before the first.
void set_packing();

}  // namespace generator
