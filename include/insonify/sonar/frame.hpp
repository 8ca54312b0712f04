// The result of every renderer: the image, its labels, statistics, and the order of its rows.
#pragma once

#include <insonify/fwd.hpp>
#include <insonify/raster/draw_options.hpp>
#include <insonify/sonar/labels.hpp>
#include <insonify/sonar/side_scan/side_scan.hpp>

#include <string>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Counts of triangles and of samples. Side-scan pictures draw no triangles.
struct render_stats {
    draw_stats seabed, targets;
    int seabed_columns = 0, seabed_rows = 0;  ///< vertices sampled; the mesh may have fewer
    std::uint64_t seabed_samples = 0;         ///< positions at which the seabed was evaluated
    double cell = 0;                          ///< metres between them
};

/// The order of a picture's rows and columns: ping numbers and sides.
struct ping_numbers {
    std::int64_t first = 0;  ///< ping of the top row
    int step = 1;            ///< from row to row: 1 or -1; 0 for overhead pictures, whose rows are not pings
    insonify::side side = insonify::side::starboard;
    int port_columns = 0;  ///< columns at the left that show the port channel, with range growing to the left
};

/// A picture and its ground truth.
///
/// In overhead pictures up is forward, and pixels are in [0, 1]. In side-scan pictures row i is ping rows.first + i
/// rows.step, columns are bins, and pixels are intensities, 0 and above; see sonar_equation.hpp for their unit.
template <class Labels>  // labels, unless stated: see fwd.hpp
struct frame {
    insonify::image<float> image;  ///< linear
    Labels labels;                 ///< or no_labels
    render_stats stats;
    ping_numbers rows;
};

namespace detail::inline INSONIFY_FLAGS {

/// @throws invalid_input for rows that are not pings, or that show both sides
inline void require_one_side(const ping_numbers& rows, const std::string& name) {
    require(rows.step != 0, name + ".step", rows.step, "1 or -1, as of a recording");
    require(rows.port_columns == 0, name + ".port_columns", rows.port_columns, "0, as of a recording of one side");
}

/// Calls `fn` with the pictures of all frames, then, if they have labels, with each of their images of labels.
template <class Fn, class... Frames>
void for_each_image(const Fn& fn, Frames&... frames) {
    fn(frames.image...);
    if constexpr ((requires { frames.labels.instance; } && ...))
        fn(frames.labels.instance...), fn(frames.labels.shadow...), fn(frames.labels.seabed...);
}

}  // namespace detail::inline INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
