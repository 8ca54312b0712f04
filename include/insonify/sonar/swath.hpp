// Both sides of the track in one picture.
#pragma once

#include <insonify/sonar/slant_range.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI {

/// The picture with left and right exchanged: what grew to the right grows to the left.
template <class T>
image<T> mirrored(const image<T>& source) {
    image<T> out(source.width(), source.height());
    for (int y = 0; y < source.height(); ++y)
        std::reverse_copy(source.row(y).begin(), source.row(y).end(), out.row(y).begin());
    return out;
}

/// The picture turned by half a turn: that of a rig which looks the other way, with forward up again.
template <class T>
image<T> turned(const image<T>& source) {
    image<T> out(source.width(), source.height());
    std::reverse_copy(source.pixels().begin(), source.pixels().end(), out.pixels().begin());
    return out;
}

/// Two pictures side by side, `gap` columns of `fill` between them.
///
/// `beside(turned(port.image), starboard.image, gap)` of two frames of `overhead`, the one with its yaw half a turn
/// further, is the paper's stitched picture; its dead zone is the gap.
/// @throws invalid_input for pictures of different heights, or a negative gap
template <class T>
image<T> beside(const image<T>& left, const image<T>& right, int gap = 0, T fill = T{}) {
    detail::require(left.height() == right.height(), "right.height()", right.height(), "that of the left picture");
    detail::require(gap >= 0, "gap", gap, "at least 0");
    image<T> out(left.width() + gap + right.width(), left.height(), fill);
    for (int y = 0; y < left.height(); ++y) {
        std::copy(left.row(y).begin(), left.row(y).end(), out.row(y).begin());
        std::copy(right.row(y).begin(), right.row(y).end(), out.row(y).begin() + left.width() + gap);
    }
    return out;
}

/// A port and a starboard recording of one track as one, port to the left: range grows from the middle outwards, and
/// the water column, as wide as the sonar is high, lies between. `targets` of the labels tells of both sides.
template <class Labels>
recording<Labels> both_sides(const recording<Labels>& port, const recording<Labels>& starboard) {
    recording<Labels> out;
    out.image = beside(mirrored(port.image), starboard.image);
    out.stats = port.stats;
    out.stats.seabed_vertices += starboard.stats.seabed_vertices;
    if constexpr (std::is_same_v<Labels, labels>) {
        out.labels.instance = beside(mirrored(port.labels.instance), starboard.labels.instance);
        out.labels.shadow = beside(mirrored(port.labels.shadow), starboard.labels.shadow);
        out.labels.seabed = beside(mirrored(port.labels.seabed), starboard.labels.seabed);
        out.labels.targets = starboard.labels.targets;
        out.labels.legend = starboard.labels.legend;
        detail::describe_again(out.labels);
    }
    return out;
}

/// Draws both sides of a straight track; the rig's own side doesn't matter. See `render`.
template <across_track Axis, class Labels = labels, backscatter_law Law = lambert_backscatter,
          class Equation = sonar_equation<level_gain>, executor_argument E = serial_executor>
recording<Labels> render_swath(const scene& s, side_scan_rig<Axis> rig,
                               const record_options<Labels, Law, Equation>& options = {}, E&& ex = {}) {
    rig.side = side::port;
    const auto port = render(s, rig, options, ex);
    rig.side = side::starboard;
    return both_sides(port, render(s, rig, options, ex));
}

}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
