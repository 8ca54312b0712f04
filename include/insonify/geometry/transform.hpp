// Placement of meshes in the world: poses for users, affine maps for computation. Double precision throughout.
//
// A world position may be 10^7 m from the origin (UTM), where a float steps by 1 m. Compose the maps first, from object
// to camera, and round to float last.
#pragma once

#include <insonify/core/linear.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/geometry/mesh.hpp>

#include <string>
#include <string_view>
#include <utility>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Where an object stands and how it is turned: scaled first, then rolled, pitched, yawed, and moved.
///
/// The frame is right-handed with z up; angles follow the right-hand rule about their axis:
///   yaw    about z, from x (starboard) towards y (forward)
///   pitch  about y, from z towards x: the +x end goes down
///   roll   about x, from y towards z: the +y side goes up
struct pose {
    glm::dvec3 position{0};  ///< of the object's origin, metres
    float yaw = 0;           ///< radians
    float pitch = 0;         ///< radians
    float roll = 0;          ///< radians
    float scale = 1;         ///< uniform, > 0
    float burial = 0;        ///< metres of sinking below `position`, not scaled; negative raises
};

/// p -> linear p + offset.
struct affine {
    glm::dmat3 linear{1};
    glm::dvec3 offset{0};
};

namespace detail::inline INSONIFY_FLAGS {

/// Messages name the coordinate, as in "pose.position.x".
/// @param member  appended to the argument's name
template <glm::length_t Length>
void require_finite(std::string_view argument, const glm::vec<Length, double>& v, std::string_view member = {}) {
    for (glm::length_t i = 0; i < Length; ++i)
        if (!numeric::is_finite(v[i])) refuse(std::string(argument).append(member) + '.' + "xyz"[i], v[i], "finite");
}

/// The unit vector; a zero or non-finite vector is returned unchanged.
inline glm::dvec3 unit(const glm::dvec3& n) {
    const double square = numeric::dot(n, n);
    return square > 0 && numeric::is_finite(square) ? n / numeric::square_root(square) : n;
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Transforms a position.
inline glm::dvec3 transform_point(const affine& map, const glm::dvec3& point) {
    return numeric::product(map.linear, point) + map.offset;
}
/// Transforms a direction, to which the offset does not apply. Its length changes with the scale.
inline glm::dvec3 transform_direction(const affine& map, const glm::dvec3& direction) {
    return numeric::product(map.linear, direction);
}
/// The unit normal of the transformed surface, on the same side of it as before; by the inverse transpose.
inline glm::dvec3 transform_normal(const affine& map, const glm::dvec3& normal) {
    const glm::dmat3 areas = numeric::cofactors(map.linear);
    const double determinant = numeric::dot(map.linear[0], areas[0]);
    return detail::unit(numeric::product(areas, determinant < 0 ? -normal : normal));
}

/// The map that applies `inner`, then `outer`.
inline affine compose(const affine& outer, const affine& inner) {
    return {numeric::product(outer.linear, inner.linear), transform_point(outer, inner.offset)};
}

/// @throws invalid_input if the map flattens space, or is not finite
inline affine inverse(const affine& map) {
    const glm::dmat3 areas = numeric::cofactors(map.linear);
    const double determinant = numeric::dot(map.linear[0], areas[0]);
    detail::require(determinant != 0 && numeric::is_finite(determinant), "determinant of affine.linear", determinant,
                    "finite and not 0");
    detail::require_finite("affine.offset", map.offset);
    const glm::dmat3 linear = glm::transpose(areas) / determinant;
    return {linear, -numeric::product(linear, map.offset)};
}

/// @param name  of the pose in an error
/// @throws invalid_input for a value that is not finite, an angle beyond 10^6 radians, or a scale that is not positive
inline void validate(const pose& p, std::string_view name = "pose") {
    detail::require_finite(name, p.position, ".position");
    detail::require_angle(name, p.yaw, ".yaw");
    detail::require_angle(name, p.pitch, ".pitch");
    detail::require_angle(name, p.roll, ".roll");
    detail::require_member(numeric::is_finite(p.burial), name, ".burial", p.burial, "finite");
    detail::require_member(numeric::is_finite(p.scale) && p.scale > 0, name, ".scale", p.scale, "finite and positive");
}

/// From the object's frame to the world's: R = Rz(yaw) Ry(pitch) Rx(roll), p -> scale R p + position - (0, 0, burial).
/// To mirror, use an `affine`.
/// @throws invalid_input as `validate` does
inline affine to_world(const pose& p) {
    validate(p);
    const auto [sy, cy] = numeric::sin_cos(numeric::widened(p.yaw));
    const auto [sp, cp] = numeric::sin_cos(numeric::widened(p.pitch));
    const auto [sr, cr] = numeric::sin_cos(numeric::widened(p.roll));
    // Columns are the images of the object's axes.
    const glm::dmat3 rotation(glm::dvec3(cy * cp, sy * cp, -sp),                                    //
                              glm::dvec3(cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr),  //
                              glm::dvec3(cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr));
    return {numeric::widened(p.scale) * rotation, p.position - glm::dvec3(0.0, 0.0, numeric::widened(p.burial))};
}

/// The transformed mesh; each coordinate is rounded to float once. A mirroring map also swaps the winding, so that
/// triangles keep facing outwards.
inline mesh transformed(mesh m, const affine& map) {
    for (glm::vec3& position : m.positions) position = glm::vec3(transform_point(map, glm::dvec3(position)));
    for (glm::vec3& normal : m.normals) normal = glm::vec3(transform_normal(map, glm::dvec3(normal)));
    if (numeric::determinant(map.linear) < 0)
        for (glm::uvec3& triangle : m.triangles) std::swap(triangle.y, triangle.z);
    return m;
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
