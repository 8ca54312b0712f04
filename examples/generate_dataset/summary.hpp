// What a run is about to make, said before it starts: counts, size, and an estimate of time and bytes.
#pragma once

#include <string>

#include "layout.hpp"
#include "stock.hpp"

namespace generator {

/// Time and bytes of an image, each a mean of a few that were drawn and thrown away.
struct image_cost {
    double seconds = 0;  ///< on one thread
    double bytes = 0;
    int images = 0;  ///< drawn; 0: nothing is known
};

/// Draws two to four images spread over the range, fewer if they take more than half a second.
image_cost measured_cost(const options& o, const index_range& work, const stock& shared);

/// Two or three lines for people, ending with a line break.
/// @param threads  that will share the work
std::string summary_of(const options& o, const index_range& work, const image_cost& cost, int threads);

/// Where a finished set is to be looked at.
std::string where_to_look(const options& o);

}  // namespace generator
