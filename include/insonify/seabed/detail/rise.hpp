// The rise of sampled heights between the neighbours of a vertex.
#pragma once

#include <insonify/core/numeric.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed::detail::inline INSONIFY_FLAGS {

/// Twice the rise per cell, by central differences. Beside an edge or a missing neighbour the one-sided difference is
/// doubled; it is 0 at a vertex without data.
/// @param both  whether there are neighbours on both sides; at an edge, the vertex itself stands for the missing one
inline float rise(float before, float at, float after, bool both = true) {
    if (!numeric::is_finite(at)) return 0;
    const bool has_before = numeric::is_finite(before), has_after = numeric::is_finite(after);
    if (has_before && has_after) return both ? after - before : 2 * (after - before);
    return has_after ? 2 * (after - at) : has_before ? 2 * (at - before) : 0.0f;
}

}  // namespace seabed::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
