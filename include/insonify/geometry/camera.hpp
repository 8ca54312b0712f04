// A camera for `draw`: position, target, and perspective projection.
//
// Its clip space is the library's: visible is -w <= x <= w, -w <= y <= w with y up, and 0 <= z <= w. Depth is reversed,
// z / w = z_near / distance along the camera's axis, so that precision does not fall off far away (draw with
// depth_compare::greater).
#pragma once

#include <insonify/core/linear.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/geometry/transform.hpp>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// A pinhole camera.
struct camera {
    glm::dvec3 eye{0, -5, 2};                                   ///< metres in the world
    glm::dvec3 target{0, 0, 0};                                 ///< appears in the middle of the picture
    glm::dvec3 up{0, 0, 1};                                     ///< appears upwards; not along the line of sight
    float field_of_view = static_cast<float>(numeric::pi / 3);  ///< from the picture's bottom to its top, radians
    float aspect = 1;                                           ///< width of the picture / its height
    float z_near = 0.01f;                                       ///< metres; nearer surfaces are clipped
};

inline namespace INSONIFY_FLAGS {

/// From the world to the camera's frame: x right, y up, z towards the viewer.
/// @throws invalid_input for a coordinate that is not finite, an eye at the target, or an `up` of no length or
///         along the line of sight
inline affine look_at(const camera& c) {
    detail::require_finite("camera.eye", c.eye);
    detail::require_finite("camera.target", c.target);
    detail::require_finite("camera.up", c.up);
    const glm::dvec3 line = c.eye - c.target;
    const double distance = numeric::length(line), length = numeric::length(c.up);
    detail::require(distance > 0 && numeric::is_finite(distance), "distance from camera.eye to camera.target", distance,
                    "above 0, finite");
    detail::require(length > 0 && numeric::is_finite(length), "length of camera.up", length, "above 0, finite");
    const glm::dvec3 back = line / distance, across = numeric::cross(c.up, back);
    const double width = numeric::length(across), sine = width / length;
    // Rounding leaves a sine of up to 1e-15 between parallel vectors.
    detail::require(sine > 1e-12, "sine of the angle from camera.up to the line of sight", sine, "above 1e-12");
    const glm::dvec3 right = across / width, up = numeric::cross(back, right);
    const glm::dmat3 linear(glm::dvec3(right.x, up.x, back.x), glm::dvec3(right.y, up.y, back.y),
                            glm::dvec3(right.z, up.z, back.z));
    return {linear, -numeric::product(linear, c.eye)};
}

/// Projects points of an object to clip space: `clip = view(point)`.
class camera_view {
  public:
    /// @param object_to_world  placement of the object
    /// @throws invalid_input as look_at, and for a field of view, an aspect or a z_near out of range
    explicit camera_view(const camera& c, const affine& object_to_world = {})
        : to_camera_(compose(look_at(c), object_to_world)), z_near_(c.z_near) {
        detail::require(c.field_of_view > 0 && static_cast<double>(c.field_of_view) < numeric::pi,
                        "camera.field_of_view", c.field_of_view, "above 0 and below pi");
        detail::require_positive("camera.aspect", c.aspect);
        detail::require_positive("camera.z_near", c.z_near);
        const double scale = 1 / numeric::tan(0.5 * static_cast<double>(c.field_of_view));
        scale_ = {static_cast<float>(scale / static_cast<double>(c.aspect)), static_cast<float>(scale)};
        detail::require(numeric::is_finite(scale_.x) && numeric::is_finite(scale_.y),
                        "cotangent of half of camera.field_of_view, over camera.aspect",
                        scale / static_cast<double>(c.aspect),
                        "one that a float can hold, with and without the aspect");
    }

    glm::vec4 operator()(const glm::vec3& point) const {
        const glm::vec3 p(transform_point(to_camera_, glm::dvec3(point)));
        return {p.x * scale_.x, p.y * scale_.y, z_near_, -p.z};
    }

  private:
    affine to_camera_;
    glm::vec2 scale_{1};
    float z_near_;
};

/// Converts a position in OpenGL's clip space, where -w <= z <= w, to the library's. Unconverted, everything between
/// the near plane and twice its distance would be clipped.
inline glm::vec4 from_gl_clip(const glm::vec4& p) {
    return {p.x, p.y, 0.5f * (p.z + p.w), p.w};
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
