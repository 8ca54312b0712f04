// Side-scan pictures: pings by ranges, with the water column, the first return, layover and shadows, and labels for
// every bin.
#pragma once

#include <insonify/sonar/side_scan/detail/recorder.hpp>
#include <insonify/sonar/side_scan/recording.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

template <class Labels, class Law>
frame<Labels> record_pings(const scene& s, std::span<const ping> track, const range_bins& window,
                           const erased_options<Labels, Law>& options, executor_ref ex) {
    return recorder<Labels, Law>(s, track, window, options, ex).record(ex);
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
