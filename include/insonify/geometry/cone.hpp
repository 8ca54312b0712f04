// Cones, whole and truncated.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/geometry/revolution.hpp>

#include <algorithm>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// A cone standing on its base, tip towards +z, centred at mid-height: the base is at z = -height / 2.
struct cone {
    float radius = 0.5f;   ///< of the base, metres
    float height = 1;      ///< metres
    float top_radius = 0;  ///< metres; above 0 the cone is truncated and has a flat top
    int segments = 64;     ///< around the axis, 3 to 2^20; see `segments_for`
};

inline namespace INSONIFY_ONCE {

/// Vertices are duplicated along the rims and at the tip, one for each normal.
/// @throws invalid_input for a radius or height that is not finite and positive, a top radius that is not finite or
///         negative, or segments outside 3 to 2^20
INSONIFY_FUNCTION mesh to_mesh(const cone& shape);

#if INSONIFY_BODIES
INSONIFY_FUNCTION mesh to_mesh(const cone& shape) {
    detail::require_positive("cone.radius", shape.radius);
    detail::require_positive("cone.height", shape.height);
    detail::require_not_negative("cone.top_radius", shape.top_radius);
    detail::require_range("cone.segments", shape.segments, 3, 1 << 20, "3 to 2^20");
    const auto radius = static_cast<double>(shape.radius);
    const auto height = static_cast<double>(shape.height);
    const auto top = static_cast<double>(shape.top_radius);

    // The side's normal is its slope turned by 90 degrees.
    const double slant = numeric::square_root(height * height + (radius - top) * (radius - top));
    const double outwards = height / slant;
    const double upwards = (radius - top) / slant;
    detail::dynamic_array<profile_point> profile = {{0, -height / 2, 0, -1},
                                                    {radius, -height / 2, 0, -1},
                                                    {radius, -height / 2, outwards, upwards},
                                                    {top, height / 2, outwards, upwards}};
    if (top > 0) {
        profile.push_back({top, height / 2, 0, 1});
        profile.push_back({0, height / 2, 0, 1});
    }
    return revolve(profile, shape.segments);
}
#endif

}  // namespace INSONIFY_ONCE

inline namespace INSONIFY_FLAGS {

/// Fewest segments with which no point of the cone is farther than `deviation` from the mesh's surface.
/// See `segments_for(radius, chord_error)`.
/// @throws invalid_input as that does
inline int segments_for(const cone& shape, float deviation) {
    return segments_for((std::max)(shape.radius, shape.top_radius), deviation);
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
