// Mirrors, flips and joins pictures: both sides of a track in one.
#pragma once

#include <insonify/sonar/side_scan/recording.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

inline namespace INSONIFY_FLAGS {

/// The picture with left and right exchanged.
template <class T>
image<T> mirrored(const image<T>& source) {
    image<T> out(source.width(), source.height());
    for (int y = 0; y < source.height(); ++y)
        std::reverse_copy(source.row(y).begin(), source.row(y).end(), out.row(y).begin());
    return out;
}

/// The picture rotated by 180 degrees. That of a rig that faces backwards then has forward up.
template <class T>
image<T> rotated_180(const image<T>& source) {
    image<T> out(source.width(), source.height());
    std::reverse_copy(source.pixels().begin(), source.pixels().end(), out.pixels().begin());
    return out;
}

/// The recording with its last ping on top: up is forward, as in overhead pictures.
template <class Labels>
frame<Labels> flipped_vertically(frame<Labels> r) {
    const auto flip = [](auto& picture) {
        for (int y = 0; 2 * y < picture.height() - 1; ++y)
            std::swap_ranges(picture.row(y).begin(), picture.row(y).end(),
                             picture.row(picture.height() - 1 - y).begin());
    };
    detail::for_each_image(flip, r);
    if constexpr (std::is_same_v<Labels, labels>) measure_targets(r.labels);
    r.rows.first += static_cast<std::int64_t>((std::max)(r.image.height() - 1, 0)) * r.rows.step;
    r.rows.step = -r.rows.step;
    return r;
}

/// Two pictures side by side, `gap` columns of `fill` between them.
///
/// For two overhead frames, the first with its yaw half a turn further, `side_by_side(rotated_180(port.image),
/// starboard.image, gap)` is a picture of both sides; the gap stands for the blind zone below the sonar.
/// @throws invalid_input for pictures of different heights, a negative gap or one that leaves no room for the columns
template <class T>
image<T> side_by_side(const image<T>& left, const image<T>& right, int gap = 0, T fill = T{}) {
    detail::require_equal("right.height()", right.height(), left.height(), "the height of the left picture");
    const std::int64_t widest = (std::numeric_limits<int>::max)() - std::int64_t{left.width()} - right.width();
    detail::require_range("gap", std::int64_t{gap}, 0, widest, "0 or more, for a total width below 2^31");
    image<T> out(left.width() + gap + right.width(), left.height(), fill);
    for (int y = 0; y < left.height(); ++y) {
        std::copy(left.row(y).begin(), left.row(y).end(), out.row(y).begin());
        std::copy(right.row(y).begin(), right.row(y).end(), out.row(y).begin() + left.width() + gap);
    }
    return out;
}

/// Joins a port and a starboard recording of one track, port to the left: range grows outwards from the middle, where
/// the water column lies. The labels' bounding boxes and areas are those of both sides together.
/// @throws invalid_input for recordings of different heights, pings or targets, or that are not one of each side
template <class Labels>
frame<Labels> both_sides(const frame<Labels>& port, const frame<Labels>& starboard) {
    const auto require_side = [](const char* name, const ping_numbers& rows, side wanted) {
        detail::require(rows.side == wanted && rows.port_columns == 0 && rows.step != 0, name,
                        static_cast<int>(rows.side),
                        wanted == side::port ? "0, the port side alone" : "1, the starboard side alone");
    };
    require_side("port.rows.side", port.rows, side::port);
    require_side("starboard.rows.side", starboard.rows, side::starboard);
    detail::require_equal("port.rows.first", port.rows.first, starboard.rows.first, "that of the starboard recording");
    detail::require_equal("port.rows.step", port.rows.step, starboard.rows.step, "that of the starboard recording");
    if constexpr (std::is_same_v<Labels, labels>)
        detail::require_equal("port.labels.targets.size()", port.labels.targets.size(), starboard.labels.targets.size(),
                              "that of the starboard recording");
    frame<Labels> out;
    const auto join = [](auto& both, const auto& left, const auto& right) {
        both = side_by_side(mirrored(left), right);
    };
    detail::for_each_image(join, out, port, starboard);
    out.stats = port.stats;
    out.stats.seabed_samples += starboard.stats.seabed_samples;
    out.rows = starboard.rows;
    out.rows.port_columns = port.image.width();
    if constexpr (std::is_same_v<Labels, labels>) {
        out.labels.targets = starboard.labels.targets;
        out.labels.legend = starboard.labels.legend;
        measure_targets(out.labels);
    }
    return out;
}

/// Records both sides of a straight track; the rig's own side is ignored. See `render`.
template <across_track Axis, class Labels = labels, backscatter_law Law = lambert_backscatter,
          class Equation = sonar_equation<level_gain>, executor_argument E = serial_executor>
frame<Labels> render_swath(const scene& s, side_scan_rig<Axis> rig,
                           const record_options<Labels, Law, Equation>& options = {}, E&& ex = {}) {
    rig.side = side::port;
    const auto port = render(s, rig, options, ex);
    rig.side = side::starboard;
    return both_sides(port, render(s, rig, options, ex));
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
