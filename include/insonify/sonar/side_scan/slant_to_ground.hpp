// Slant-range correction: resamples a recording to ground range, assuming a level seabed.
#pragma once

#include <insonify/sonar/side_scan/range_geometry.hpp>
#include <insonify/sonar/side_scan/recording.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

inline namespace INSONIFY_FLAGS {

/// Resamples a recording to ground range on a level seabed at the datum. The water column disappears; raised objects
/// stay displaced towards the sonar by their layover. Intensities are interpolated linearly between the centres of
/// bins, labels taken from the nearest bin; ranges that the recording does not contain are 0 and unlabelled.
///
/// @param slant      a result of `render` or `record`; resample each side before `both_sides` joins them
/// @param from       its rig
/// @param to         first_range, range and bins are the columns of the result
/// @param altitudes  of the sonar above the seabed, one per row from the top; empty for the rig's altitude
/// @throws invalid_input for a rig out of range, a picture from above or of both sides, labels of another size, a
///         number of altitudes other than 0 or that of the rows, or an altitude that is not finite
template <class Labels>
frame<Labels> to_ground_range(const frame<Labels>& slant, const side_scan& from, const ground_range& to,
                              std::span<const double> altitudes = {}) {
    validate(from), validate(to);
    const int rows = slant.image.height(), bins = slant.image.width();
    detail::require_equal("from.bins", from.bins, bins, "the recording's width");
    detail::require_one_side(slant.rows, "slant.rows");
    if constexpr (std::is_same_v<Labels, labels>) detail::require_sizes(slant.labels, bins, rows, "that of the image");
    detail::require(altitudes.empty() || altitudes.size() == static_cast<std::size_t>(rows), "altitudes.size()",
                    altitudes.size(), "0 or one per row");
    for (const double altitude : altitudes) detail::require_finite("altitudes", altitude);
    frame<Labels> out;
    out.stats = slant.stats;
    out.rows = slant.rows;
    out.image = image<float>(to.bins, rows);
    if constexpr (std::is_same_v<Labels, labels>) {
        out.labels = labels(to.bins, rows);
        out.labels.targets = slant.labels.targets;
        out.labels.legend = slant.labels.legend;
    }
    for (int y = 0; y < rows; ++y) {
        const double altitude =
            altitudes.empty() ? static_cast<double>(from.altitude) : altitudes[static_cast<std::size_t>(y)];
        for (int x = 0; x < to.bins; ++x) {
            const double ground = static_cast<double>(to.first_range) + (x + 0.5) * to.bin();
            const double range = range_geometry::slant_range(ground, altitude);
            const double column = (range - static_cast<double>(from.first_range)) / from.bin();
            if (!(column >= 0 && column < bins)) continue;
            const int nearest = static_cast<int>(column);
            const int left = column - nearest < 0.5 ? nearest - 1 : nearest;
            const auto weight = static_cast<float>(column - 0.5 - left);
            const float before = slant.image((std::max)(left, 0), y);
            const float after = slant.image((std::min)(left + 1, bins - 1), y);
            out.image(x, y) = before + weight * (after - before);
            if constexpr (std::is_same_v<Labels, labels>) {
                out.labels.instance(x, y) = slant.labels.instance(nearest, y);
                out.labels.shadow(x, y) = slant.labels.shadow(nearest, y);
                out.labels.seabed(x, y) = slant.labels.seabed(nearest, y);
            }
        }
    }
    if constexpr (std::is_same_v<Labels, labels>) measure_targets(out.labels);
    return out;
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
