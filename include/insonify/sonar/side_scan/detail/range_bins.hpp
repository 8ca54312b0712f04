// The columns of a recording, and the options of recorders without the types of the sonar equation's parts.
#pragma once

#include <insonify/sonar/side_scan/detail/equation_interface.hpp>
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
    side facing;
    bool is_slant_range;  ///< bins are of slant range, or else of ground range

    template <across_track Axis>
    INSONIFY_MEMBER explicit range_bins(const side_scan_rig<Axis>& rig)
        : altitude(rig.altitude),
          ping_spacing(rig.ping_spacing),
          first_range(rig.first_range),
          range(rig.range),
          bins(rig.bins),
          facing(rig.side),
          is_slant_range(Axis == across_track::slant_range) {}

    INSONIFY_MEMBER double bin() const {
        return (static_cast<double>(range) - static_cast<double>(first_range)) / bins;
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
    const double range = static_cast<double>(window.range), altitude = static_cast<double>(window.altitude);
    const double slant = window.is_slant_range ? range : numeric::square_root(range * range + altitude * altitude);
    const double pings = equation.beam_reach(slant) / static_cast<double>(window.ping_spacing);
    require(pings >= 0 && pings < 4096, "pings in the horizontal beam", pings, "0 or more, below 4096");
    return static_cast<int>(pings);
}

}  // namespace detail::inline INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
