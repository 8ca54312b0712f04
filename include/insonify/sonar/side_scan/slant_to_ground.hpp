// Slant-range correction: a recording laid out on the bottom, as if that were level.
#pragma once

#include <insonify/sonar/side_scan/range_geometry.hpp>
#include <insonify/sonar/side_scan/slant_range.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

inline namespace INSONIFY_FLAGS {

/// Lays a recording out on a level bottom at the datum: the water column goes, what is raised stays shifted towards the
/// sonar by its layover. Intensities are interpolated linearly between the centres of bins and labels are those of the
/// nearest bin; what the recording doesn't reach is 0, without labels.
///
/// @param slant      as `render` or `record` made it
/// @param from       its rig
/// @param to         which ground ranges the result's columns are: first_range, range and bins count
/// @param altitudes  of the sonar above the bottom, one per row from the top, or none: then all are the rig's
/// @throws invalid_input for a rig that can't be right, or a number of altitudes that is neither 0 nor that of rows, or
/// one
///         that is not finite
template <class Labels>
frame<Labels> to_ground_range(const frame<Labels>& slant, const side_scan& from, const ground_range& to,
                              std::span<const double> altitudes = {}) {
    validate(from), validate(to);
    const int rows = slant.image.height(), bins = slant.image.width();
    detail::require(bins == from.bins, "from.bins", from.bins, "the recording's width");
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
            const auto share = static_cast<float>(column - 0.5 - left);
            const float before = slant.image((std::max)(left, 0), y);
            const float after = slant.image((std::min)(left + 1, bins - 1), y);
            out.image(x, y) = before + share * (after - before);
            if constexpr (std::is_same_v<Labels, labels>) {
                out.labels.instance(x, y) = slant.labels.instance(nearest, y);
                out.labels.shadow(x, y) = slant.labels.shadow(nearest, y);
                out.labels.seabed(x, y) = slant.labels.seabed(nearest, y);
            }
        }
    }
    if constexpr (std::is_same_v<Labels, labels>) detail::describe_again(out.labels);
    return out;
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
