// Central differences of sampled heights, one-sided at edges and gaps.
#pragma once

#include <insonify/core/numeric.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed::detail::inline INSONIFY_FLAGS {

/// Twice the height difference per cell. At an edge or beside a missing vertex, the one-sided difference doubled; 0 at
/// a vertex without data.
/// @param both  whether the grid has vertices on both sides; at an edge, `at` is passed for the missing one
inline float central_difference(float before, float at, float after, bool both = true) {
    if (!numeric::is_finite(at)) return 0;
    const bool has_before = numeric::is_finite(before), has_after = numeric::is_finite(after);
    if (has_before && has_after) return both ? after - before : 2 * (after - before);
    return has_after ? 2 * (after - at) : has_before ? 2 * (at - before) : 0.0f;
}

}  // namespace seabed::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
