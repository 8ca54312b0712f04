// Rays from points to a light, and whether a triangle blocks them, decided in doubles: the reference that every faster
// test reproduces.
//
// A triangle blocks a point's ray towards the light if the ray crosses it, edges included, and the point lies behind
// its plane by more than the rounding error, 2^-40 of the scene's size. There is no bias. Vertices are sheared so that
// the ray becomes an axis; the signs of three 2 x 2 determinants then say on which side it passes each edge. Two
// triangles that share an edge compute the same determinant with opposite signs, and zero counts as inside for both: no
// light leaks through the edge.
//
// Based on: Sven Woop, Carsten Benthin, Ingo Wald. Watertight Ray/Triangle Intersection. JCGT 2, 2013.
#pragma once

#include <insonify/core/linear.hpp>
#include <insonify/shadow/policy.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::detail::inline INSONIFY_FLAGS {

/// A light's rays: parallel, or to a point.
class light_rays {
  public:
    /// @param reach  upper bound of the absolute coordinates of tested points, metres
    /// @throws invalid_input for a position that is not finite, and as light_frame does
    light_rays(const any_light& light, double reach) : reach_(reach), light_reach_(reach) {
        if (const auto* parallel = std::get_if<directional_light>(&light)) {
            source_ = light_frame(*parallel).to_light();
        } else {
            source_ = std::get<point_light>(light).position;
            is_point_light_ = true;
            insonify::detail::require_finite("point_light.position", source_);
            for (int i = 0; i < 3; ++i) light_reach_ = (std::max)(light_reach_, numeric::abs(source_[i]));
        }
    }

    /// Vector from a point to the light: a unit vector for parallel light, the full offset for a point light.
    glm::dvec3 toward(const glm::dvec3& p) const { return is_point_light_ ? source_ - p : source_; }

    /// Whether the triangle (a, b, c) blocks the light of `from`.
    bool blocks(const glm::dvec3& corner_a, const glm::dvec3& corner_b, const glm::dvec3& corner_c,
                const glm::dvec3& from) const {
        const glm::dvec3 to_light = toward(from), a = corner_a - from, b = corner_b - from, c = corner_c - from;
        // Corners sheared along the ray, in the two axes of its smaller components. A corner that triangles share is
        // rounded alike for each.
        const int axis = numeric::dominant_axis(to_light);
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const double shear_u = to_light[u] / to_light[axis], shear_v = to_light[v] / to_light[axis];
        const auto across = [&](const glm::dvec3& p) {
            return glm::dvec2(p[u] - shear_u * p[axis], p[v] - shear_v * p[axis]);
        };
        const glm::dvec2 a2 = across(a), b2 = across(b), c2 = across(c);
        const double direction = to_light[axis] < 0 ? -1 : 1;
        const double bc = direction * numeric::cross(b2, c2);
        const double ca = direction * numeric::cross(c2, a2);
        const double ab = direction * numeric::cross(a2, b2);
        const bool is_left = bc >= 0 && ca >= 0 && ab >= 0, is_right = bc <= 0 && ca <= 0 && ab <= 0;
        if (!is_left && !is_right) return false;
        const glm::dvec3 normal = numeric::cross(b - a, c - a);
        // Measured from the nearest corner: the rounding error of a distant one may exceed the point's distance.
        const auto size = [](const glm::dvec3& d) { return numeric::abs(d.x) + numeric::abs(d.y) + numeric::abs(d.z); };
        const glm::dvec3& nearer = size(a) <= size(b) ? a : b;
        const double along = numeric::dot(normal, to_light),
                     behind = numeric::dot(normal, size(nearer) <= size(c) ? nearer : c);
        const double sign = is_left ? 1 : -1;
        const double tolerance = 0x1p-40 * size(normal);
        if (!(sign * along > 0 && sign * behind > reach_ * tolerance)) return false;
        // A triangle that contains the light does not block it.
        return !is_point_light_ || sign * (along - behind) > light_reach_ * tolerance;
    }

  private:
    glm::dvec3 source_;           ///< direction, or position
    double reach_, light_reach_;  ///< of points, and with the light
    bool is_point_light_ = false;
};

}  // namespace shadow::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
