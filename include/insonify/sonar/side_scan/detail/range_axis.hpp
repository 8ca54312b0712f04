// The range axis of a recording: which bins an echo is received in.
#pragma once

#include <insonify/core/numeric.hpp>
#include <insonify/sonar/side_scan/detail/ping_fan.hpp>
#include <insonify/sonar/side_scan/range_geometry.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Converts ranges to positions in bins.
struct range_axis {
    double first, bin;    ///< metres
    bool is_slant_range;  ///< bins are of slant range, or else of ground range

    /// Position of an echo at a slant range along a ray.
    float position(const ping_fan::ray& ray, double range) const {
        const double r = is_slant_range ? range : range * ray.sine;
        return static_cast<float>((r - first) / bin);
    }
    /// Position of the echo of a point, from its distances across and below the sonar.
    double position(double x, double down) const {
        const double r = is_slant_range ? range_geometry::slant_range(x, down) : x;
        return (r - first) / bin;
    }
    /// Half the number of bins between the edges of a ray on a surface along (dx, ddown).
    float half_length(const ping_fan::ray& ray, double range, double dx, double ddown) const {
        const double outwards = is_slant_range ? dx * ray.sine + ddown * ray.cosine : dx;
        const double turning = dx * ray.cosine - ddown * ray.sine;
        const double half = 0.5 * range * ray.width * outwards / (turning * bin);
        return static_cast<float>(numeric::abs(half));
    }
};

/// Calls `visit(bin, fraction, length)` for each of `count` bins between two positions: the fraction of the interval
/// that lies in the bin, and its length in bins. Declared inline: g++ otherwise inlines it less, which costs 4 %.
template <class Visit>
inline void distribute(std::size_t count, float low, float high, const Visit& visit) {
    const auto end = static_cast<float>(count);
    if (!(high > 0 && low < end)) return;
    const auto first = static_cast<std::int64_t>(low > 0 ? low : 0.0f);
    const auto last =
        (std::min)(static_cast<std::int64_t>((std::min)(high, end)), static_cast<std::int64_t>(count) - 1);
    if (first == last && low >= static_cast<float>(first) && high <= static_cast<float>(first + 1)) {
        visit(static_cast<std::size_t>(first), 1.0f, high - low);
        return;
    }
    const float scale = 1 / (high - low);
    for (std::int64_t b = first; b <= last; ++b) {
        const float from = (std::max)(low, static_cast<float>(b)), to = (std::min)(high, static_cast<float>(b + 1));
        if (to > from) visit(static_cast<std::size_t>(b), (to - from) * scale, to - from);
    }
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
