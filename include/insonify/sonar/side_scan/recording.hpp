// Side-scan pictures: the functions that record them. The recorder is in record.hpp, which is included below in the
// header-only form.
#pragma once

#include <insonify/core/executor.hpp>
#include <insonify/core/image_view.hpp>
#include <insonify/sonar/scene.hpp>
#include <insonify/sonar/side_scan/detail/range_bins.hpp>
#include <insonify/sonar/side_scan/record_options.hpp>
#include <insonify/sonar/side_scan/side_scan.hpp>

#include <algorithm>
#include <span>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

// Defined in record.hpp.
template <class Labels, class Law>
class recorder;

template <class Labels, class Law>
frame<Labels> record_pings(const scene& s, std::span<const ping> track, const range_bins& window,
                           const erased_options<Labels, Law>& options, executor_ref ex) {
    static_assert(
        requires { sizeof(recorder<Labels, Law>); },
        "a law other than the built-in ones needs #include <insonify/sonar/side_scan/record.hpp> in the "
        "compiled form");
    return recorder<Labels, Law>(s, track, window, options, ex).record(ex);
}

}  // namespace detail::inline INSONIFY_FLAGS

#if defined(INSONIFY_COMPILED)
namespace detail::inline INSONIFY_ONCE {

#define INSONIFY_RECORDINGS(each)                                                                          \
    each(labels, lambert_backscatter) each(no_labels, lambert_backscatter) each(labels, facet_backscatter) \
        each(no_labels, facet_backscatter)
#define INSONIFY_RECORDING(Labels, Law)                                                               \
    frame<Labels> record_pings(const scene& s, std::span<const ping> track, const range_bins& window, \
                               const erased_options<Labels, Law>& options, executor_ref ex);
INSONIFY_RECORDINGS(INSONIFY_RECORDING)
#undef INSONIFY_RECORDING

}  // namespace detail::inline INSONIFY_ONCE
#endif

inline namespace INSONIFY_FLAGS {

/// Records a track of any shape, with yaw, pitch, roll and heave of every ping.
///
/// Pings are numbered from 0: set `rows.first` of a part of a longer track before `with_speckle`. A `horizontal_beam`
/// blurs over the given pings alone: record extra pings at the ends of each part, and drop their rows.
///
/// @param s        the seabed and its targets
/// @param track    pings in order; row i of the result is ping i
/// @param rig      ranges, side and ping spacing; its own track is ignored. Its altitude is nominal: the default `cell`
///                 and, in ground range, the width of the horizontal beam go by it
/// @param options  labels, backscatter law and sonar equation by type; sampling of the seabed
/// @param ex       runs it; the result is the same bytes for any executor
/// @throws invalid_input for a rig, a ping, a seabed, a material, a pose or an option out of range, or a pitched ping
///         over a seabed that states no `range`
template <across_track Axis, class Labels = labels, backscatter_law Law = lambert_backscatter,
          class Equation = sonar_equation<level_gain>, executor_argument E = serial_executor>
frame<Labels> record(const scene& s, std::span<const ping> track, const side_scan_rig<Axis>& rig,
                     const record_options<Labels, Law, Equation>& options = {}, E&& ex = {}) {
    validate(rig);
    const detail::equation_of<Equation, Law> equation(options.equation, options.law);
    const detail::erased_options<Labels, Law> erased{options.law, equation, options.cell, 0};
    return detail::record_pings(s, track, detail::range_bins(rig), erased, executor_ref(ex));
}

/// Records pings into the caller's memory, without labels: row i of `into` becomes ping i.
/// @param into  rig.bins columns, a row per ping; may be a part of a larger image
/// The other parameters and errors are those of `record`; also throws invalid_input for a view of another size, which
/// is then unchanged.
template <across_track Axis, class Labels = labels, backscatter_law Law = lambert_backscatter,
          class Equation = sonar_equation<level_gain>, executor_argument E = serial_executor>
render_stats record_into(image_view<float> into, const scene& s, std::span<const ping> track,
                         const side_scan_rig<Axis>& rig, const record_options<Labels, Law, Equation>& options = {},
                         E&& ex = {}) {
    detail::require_equal("into.width()", into.width(), rig.bins, "the number of bins");
    detail::require_equal("into.height()", static_cast<std::size_t>(into.height()), track.size(),
                          "the number of pings");
    const auto recorded = record(s, track, rig, options.without_labels(), ex);
    for (int y = 0; y < into.height(); ++y)
        std::copy(recorded.image.row(y).begin(), recorded.image.row(y).end(), into.row(y).begin());
    return recorded.stats;
}

/// Records the straight track of a rig, in slant or ground range. Row i is ping i. For a `horizontal_beam`, the track
/// is continued beyond its ends. The other parameters and errors are those of `record`.
template <across_track Axis, class Labels = labels, backscatter_law Law = lambert_backscatter,
          class Equation = sonar_equation<level_gain>, executor_argument E = serial_executor>
frame<Labels> render(const scene& s, const side_scan_rig<Axis>& rig,
                     const record_options<Labels, Law, Equation>& options = {}, E&& ex = {}) {
    validate(rig);
    const detail::equation_of<Equation, Law> equation(options.equation, options.law);
    const detail::range_bins window(rig);
    // The beam reaches beyond the ends of the track.
    const int more = detail::beam_reach(equation, window);
    std::vector<ping> track;
    for (int i = -more; i < rig.pings + more; ++i) track.push_back(ping_of(rig, i));
    const detail::erased_options<Labels, Law> erased{options.law, equation, options.cell, more};
    return detail::record_pings(s, track, window, erased, executor_ref(ex));
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END

#if INSONIFY_BODIES
#include <insonify/sonar/side_scan/record.hpp>
#endif
