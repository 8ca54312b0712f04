// The result of every kind of picture: the image, its labels, which pings its rows are, and what was drawn.
#pragma once

#include <insonify/raster/draw_stats.hpp>
#include <insonify/sonar/labels.hpp>
#include <insonify/sonar/side_scan/side_scan.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// What became of the triangles, and how large the intermediate things were. Range modes draw no triangles.
struct render_stats {
    draw_stats seabed, targets;
    int seabed_columns = 0, seabed_rows = 0;  ///< vertices sampled, of which the mesh may leave some out
    std::uint64_t seabed_samples = 0;         ///< points at which the seabed was evaluated
    double cell = 0;                          ///< metres between them
};

/// Which pings the rows of a picture are, and which side its columns hear.
struct ping_numbers {
    std::int64_t first = 0;  ///< of the top row
    int step = 1;            ///< from row to row: 1, or -1; 0 for overhead pictures, whose rows are not pings
    insonify::side side = insonify::side::starboard;
    int port_columns = 0;  ///< at the left, of another channel: port, its range growing to the left
};

/// A picture with all that is known about it.
///
/// Of `overhead`, up is forward and pixels are in [0, 1]. Of range modes, row i is ping i, column j is bin j, and
/// pixels are intensities, 0 and above: see sonar_equation.hpp for their unit.
template <class Labels = labels>
struct frame {
    insonify::image<float> image;  ///< linear
    Labels labels;                 ///< or no_labels
    render_stats stats;
    ping_numbers rows;
};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
