// The columns of a recording, and the options of recorders without the types of the sonar equation's parts.
#pragma once

#include <insonify/sonar/side_scan/detail/equation_interface.hpp>
#include <insonify/sonar/side_scan/range_geometry.hpp>
#include <insonify/sonar/side_scan/side_scan.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail {

/// The columns of a recording, in slant or ground range.
struct range_bins {
    float altitude;      ///< metres, as of the rig
    float ping_spacing;  ///< metres
    float first_range, range;
    int bins;
    double bin;  ///< metres
    side facing;
    bool is_slant_range;  ///< bins are of slant range, or else of ground range

    template <across_track Axis>
    INSONIFY_MEMBER explicit range_bins(const side_scan_rig<Axis>& rig)
        : altitude(rig.altitude),
          ping_spacing(rig.ping_spacing),
          first_range(rig.first_range),
          range(rig.range),
          bins(rig.bins),
          bin(rig.bin()),
          facing(rig.side),
          is_slant_range(Axis == across_track::slant_range) {}

    /// Slant range of the bottom at a column's range, from an altitude.
    INSONIFY_MEMBER double slant_range(double r, double above) const {
        return is_slant_range ? r : range_geometry::slant_range(r, above);
    }
};

/// Options of a recording without the parts of the equation in their type.
template <class Labels, class Law>
struct erased_options {
    const Law& law;
    const equation_interface& equation;
    double cell;
    int margin;  ///< pings at either end of the track that the beam needs; they get no rows in the result
};

}  // namespace detail

namespace detail::inline INSONIFY_FLAGS {

/// Reach of the horizontal beam at the largest range, in pings.
inline int beam_reach(const equation_interface& equation, const range_bins& window) {
    const double slant = window.slant_range(static_cast<double>(window.range), static_cast<double>(window.altitude));
    const double pings = equation.beam_reach(slant) / static_cast<double>(window.ping_spacing);
    require(pings >= 0 && pings < 4096, "pings in the horizontal beam", pings, "0 or more, below 4096");
    return static_cast<int>(pings);
}

}  // namespace detail::inline INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
