// The planes onto which casters and points are projected along a light's rays.
//
// Parallel light has one plane, the datum in the light's sheared frame (light.hpp). Light from a point has six, the
// faces of a cube around it, each seen in perspective. On a plane every ray is one point (u, v), triangles stay
// triangles, and of two points of a ray the one with the larger height is nearer to the light.
#pragma once

#include <insonify/core/linear.hpp>
#include <insonify/geometry/bounds.hpp>
#include <insonify/shadow/light.hpp>

#include <algorithm>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::detail::inline INSONIFY_FLAGS {

/// One plane of a light.
class light_plane {
  public:
    light_plane() = default;
    explicit light_plane(const light_frame& frame)
        : rows_{{frame.travel().x, frame.travel().y, frame.cot_elevation()},
                {-frame.travel().y, frame.travel().x, 0},
                {0, 0, 1}} {}
    /// @param face  0 to 5: along +x, -x, +y, -y, +z, -z of the light
    light_plane(const point_light& light, int face) : origin_(light.position), is_point_light_(true) {
        const int axis = face / 2;
        rows_[0][(axis + 1) % 3] = rows_[1][(axis + 2) % 3] = 1;
        rows_[2][axis] = face % 2 == 0 ? 1 : -1;
    }

    bool is_point_light() const { return is_point_light_; }
    /// Whether triangles that are counter-clockwise from the light are clockwise on the plane.
    bool is_mirrored() const {
        return is_point_light_ == (numeric::dot(rows_[0], numeric::cross(rows_[1], rows_[2])) > 0);
    }

    /// (u, v, height) of a point; of a point light before the division, (u d, v d, d) with the depth d.
    glm::dvec3 operator()(const glm::dvec3& p) const { return direction(p - origin_); }
    /// The same for a difference of points.
    glm::dvec3 direction(const glm::dvec3& d) const {
        return {numeric::dot(rows_[0], d), numeric::dot(rows_[1], d), numeric::dot(rows_[2], d)};
    }
    /// After the division. Heights are 1 / depth.
    static glm::dvec3 perspective_divide(const glm::dvec3& p) { return {p.x / p.z, p.y / p.z, 1 / p.z}; }

    /// Number of the cube's face, seen from a point light, that a point lies over.
    static int face_of(const point_light& light, const glm::dvec3& p) {
        const glm::dvec3 d = p - light.position;
        const int axis = numeric::dominant_axis(d);
        return 2 * axis + (d[axis] < 0 ? 1 : 0);
    }

  private:
    glm::dvec3 rows_[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    glm::dvec3 origin_{0};
    bool is_point_light_ = false;
};

/// Whether anything within a box may lie over a plane of a point light.
inline bool may_project_onto(const light_plane& plane, const bounding_box& box) {
    bool outside[4] = {true, true, true, true};
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 p = plane(box.corner(i));
        for (int k = 0; k < 4; ++k) outside[k] = outside[k] && (k % 2 == 0 ? 1 : -1) * p[k / 2] > p.z * (1 + 0x1p-30);
    }
    return !(outside[0] || outside[1] || outside[2] || outside[3]);
}

/// The part of a point light's plane that a box is over.
inline std::pair<glm::dvec2, glm::dvec2> projected_extent(const light_plane& plane, const bounding_box& box) {
    glm::dvec2 lower(1), upper(-1);
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 p = plane(box.corner(i));
        if (!(p.z > 0)) return {glm::dvec2(-1), glm::dvec2(1)};
        for (int axis = 0; axis < 2; ++axis) {
            lower[axis] = (std::max)(-1.0, (std::min)(lower[axis], p[axis] / p.z));
            upper[axis] = (std::min)(1.0, (std::max)(upper[axis], p[axis] / p.z));
        }
    }
    return {lower, upper};
}

}  // namespace shadow::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
