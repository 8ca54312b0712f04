// Cylinders lying on their side, with flat or with rounded ends.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/geometry/revolution.hpp>

#include <array>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// A cylinder along x, centred at the origin, with flat ends.
struct cylinder {
    float radius = 0.5f;  ///< metres
    float length = 2;     ///< metres
    int segments = 64;    ///< around the axis, 3 to 2^20; see `segments_for`
};

/// A cylinder along x, centred at the origin, ending in two hemispheres; smooth all over.
struct capsule {
    float radius = 0.5f;  ///< metres
    float length = 2;     ///< metres from tip to tip, at least twice the radius
    int segments = 64;    ///< around the axis, 3 to 8192; half as many rings over both ends, an even number
};

inline namespace INSONIFY_ONCE {

/// 4 segments + 2 vertices: each rim has two rings, one for each normal.
/// @throws invalid_input for a radius or length that is not finite and positive, or segments outside 3 to 2^20
INSONIFY_FUNCTION mesh to_mesh(const cylinder& shape);

/// @throws invalid_input for a radius that is not finite and positive, a length that is not finite or below 2 radius,
///         or segments outside 3 to 8192
INSONIFY_FUNCTION mesh to_mesh(const capsule& shape);

#if INSONIFY_BODIES
INSONIFY_FUNCTION mesh to_mesh(const cylinder& shape) {
    detail::require_positive("cylinder.radius", shape.radius);
    detail::require_positive("cylinder.length", shape.length);
    detail::require_range("cylinder.segments", shape.segments, 3, 1 << 20, "3 to 2^20");
    const auto radius = static_cast<double>(shape.radius);
    const double half = 0.5 * static_cast<double>(shape.length);
    const std::array<profile_point, 6> profile = {{{0, -half, 0, -1},
                                                   {radius, -half, 0, -1},
                                                   {radius, -half, 1, 0},
                                                   {radius, half, 1, 0},
                                                   {radius, half, 0, 1},
                                                   {0, half, 0, 1}}};
    return revolve(profile, shape.segments, axis::x);
}

INSONIFY_FUNCTION mesh to_mesh(const capsule& shape) {
    detail::require_positive("capsule.radius", shape.radius);
    detail::require(numeric::is_finite(shape.length) && shape.length >= 2 * shape.radius, "capsule.length",
                    shape.length, "finite and at least twice the radius");
    detail::require_range("capsule.segments", shape.segments, 3, 8192, "3 to 8192");
    const auto radius = static_cast<double>(shape.radius);
    const double straight = 0.5 * static_cast<double>(shape.length) - radius;
    const int steps = (shape.segments + 3) / 4;
    detail::dynamic_array<profile_point> profile;
    detail::append_arc(profile, radius, -straight, 0.0, 0.25, steps);
    detail::append_arc(profile, radius, straight, 0.25, 0.5, steps);
    return revolve(profile, shape.segments, axis::x);
}
#endif

}  // namespace INSONIFY_ONCE

inline namespace INSONIFY_FLAGS {

/// Fewest segments with which no point of the shape is farther than `deviation` from the mesh's surface, whatever the
/// shape's own `segments`; see `segments_for(radius, chord_error)`.
/// @throws invalid_input as that does, and for a capsule that would need more than 8192
inline int segments_for(const cylinder& shape, float deviation) {
    return segments_for(shape.radius, deviation);
}
/// The same for a capsule.
inline int segments_for(const capsule& shape, float deviation) {
    return detail::round_segments_for(shape.radius, deviation, [](int segments) { return 2 * ((segments + 3) / 4); });
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
