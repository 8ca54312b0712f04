// The summary printed before a run: counts, size, and an estimate of time and bytes.
#pragma once

#include <string>

#include "layout.hpp"
#include "shared_inputs.hpp"

namespace generator {

/// Mean time and bytes of an image, measured on a few that are discarded.
struct image_cost {
    double seconds = 0;  ///< on one thread
    double bytes = 0;
    int images = 0;  ///< measured; 0: no estimate
};

/// Draws two to four images spread over the range, fewer if they take more than half a second.
image_cost measured_cost(const options& o, const index_range& work, const shared_inputs& shared);

/// Two or three lines of text.
/// @param threads  threads of the run
std::string summary_of(const options& o, const index_range& work, const image_cost& cost, int threads);

/// Where to find the files of a finished set.
std::string where_to_look(const options& o);

}  // namespace generator
