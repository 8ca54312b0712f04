// Spheres and hemispheres, which `aspect` makes ellipsoids: boulders, floats, half-buried balls.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/geometry/revolution.hpp>
#include <insonify/geometry/transform.hpp>

#include <algorithm>
#include <utility>

#include <glm/vec3.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// A sphere centred at the origin, stretched along x, y and z by `aspect`: the semi-axes are radius * aspect.
/// An edge of its mesh deviates as an edge of the circle does (`segments_for`), the middle of a face up to twice that.
struct sphere {
    float radius = 0.5f;  ///< metres
    glm::vec3 aspect{1};
    /// Around z, 3 to 8192; half as many rings from pole to pole. Even for strongly stretched shapes: with odd ones
    /// some normals point behind a face.
    int segments = 64;
};

/// The upper half of a sphere on the plane z = 0, with a flat base: the visible part of a half-buried sphere.
struct hemisphere {
    float radius = 0.5f;  ///< metres
    glm::vec3 aspect{1};
    int segments = 64;  ///< around z, 3 to 8192, even for strongly stretched shapes; a quarter as many rings
};

namespace detail::inline INSONIFY_FLAGS {

template <class Round>
void require_semi_axes(const Round& shape, const char* radius, const char* aspect) {
    require_positive(radius, shape.radius);
    for (int i = 0; i < 3; ++i) {
        const float semi_axis = shape.radius * shape.aspect[i];
        require(shape.aspect[i] > 0 && semi_axis > 0 && numeric::is_finite(semi_axis), aspect, shape.aspect[i],
                "above 0, and the radius times it above 0 and finite");
    }
}
template <class Round>
float longest_semi_axis(const Round& shape) {
    return shape.radius * (std::max)((std::max)(shape.aspect.x, shape.aspect.y), shape.aspect.z);
}

#if INSONIFY_BODIES
/// Turns a profile about z and stretches the result with its normals.
inline mesh stretched_round(const dynamic_array<profile_point>& profile, const glm::vec3& aspect, int segments) {
    mesh out = revolve(profile, segments);
    if (aspect == glm::vec3(1)) return out;
    affine stretch;
    for (int i = 0; i < 3; ++i) stretch.linear[i][i] = static_cast<double>(aspect[i]);
    return transformed(std::move(out), stretch);
}
#endif

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_ONCE {

/// Closed by index: every vertex is shared, and the poles are one vertex each.
/// @throws invalid_input for a radius or aspect that is not finite and positive, or segments outside 3 to 8192
INSONIFY_FUNCTION mesh to_mesh(const sphere& shape);

/// @throws invalid_input for a radius or aspect that is not finite and positive, or segments outside 3 to 8192
INSONIFY_FUNCTION mesh to_mesh(const hemisphere& shape);

#if INSONIFY_BODIES
INSONIFY_FUNCTION mesh to_mesh(const sphere& shape) {
    detail::require_semi_axes(shape, "sphere.radius", "sphere.aspect");
    detail::require_range("sphere.segments", shape.segments, 3, 8192, "3 to 8192");
    detail::dynamic_array<profile_point> profile;
    detail::append_arc(profile, static_cast<double>(shape.radius), 0.0, 0.0, 0.5, (shape.segments + 1) / 2);
    return detail::stretched_round(profile, shape.aspect, shape.segments);
}

INSONIFY_FUNCTION mesh to_mesh(const hemisphere& shape) {
    detail::require_semi_axes(shape, "hemisphere.radius", "hemisphere.aspect");
    detail::require_range("hemisphere.segments", shape.segments, 3, 8192, "3 to 8192");
    const auto radius = static_cast<double>(shape.radius);
    detail::dynamic_array<profile_point> profile = {{0, 0, 0, -1}, {radius, 0, 0, -1}};
    detail::append_arc(profile, radius, 0.0, 0.25, 0.5, (shape.segments + 3) / 4);
    return detail::stretched_round(profile, shape.aspect, shape.segments);
}
#endif

}  // namespace INSONIFY_ONCE

inline namespace INSONIFY_FLAGS {

/// Fewest segments with which no point of the shape is farther than `deviation` from the mesh's surface, whatever the
/// shape's own `segments`. A stretched one counts as a ball of its longest semi-axis.
/// @throws invalid_input as `segments_for(radius, chord_error)`, and for shapes that would need more than 8192
inline int segments_for(const sphere& shape, float deviation) {
    detail::require_semi_axes(shape, "sphere.radius", "sphere.aspect");
    return detail::round_segments_for(detail::longest_semi_axis(shape), deviation,
                                      [](int segments) { return (segments + 1) / 2; });
}
/// The same for a hemisphere.
inline int segments_for(const hemisphere& shape, float deviation) {
    detail::require_semi_axes(shape, "hemisphere.radius", "hemisphere.aspect");
    return detail::round_segments_for(detail::longest_semi_axis(shape), deviation,
                                      [](int segments) { return 2 * ((segments + 3) / 4); });
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
