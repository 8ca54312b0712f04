// Whether a triangle blocks the light of a point, decided in doubles: the rule that everything faster has to obey.
//
// A triangle blocks a point's ray towards the light if the ray passes through it, edges included, and the point lies
// behind it by more than rounding can have moved either (2^-40 of the scene's size). There is no bias. A ray passes an
// edge on its left if toward . (a x b) is not negative, over the edge's ends as seen from the point; for the triangle
// on the other side the ends change places, which changes the sign of each rounded product and of the sum and nothing
// else, and a zero counts for both: no light leaks between triangles that share an edge.
//
// Based on: Sven Woop, Carsten Benthin, Ingo Wald. Watertight Ray/Triangle Intersection. JCGT 2, 2013.
#pragma once

#include <insonify/core/linear.hpp>
#include <insonify/shadow/policy.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::detail {

/// A light's rays: parallel, or to a point.
class light_rays {
  public:
    /// @param reach  no coordinate of a point that is tested is larger, metres
    light_rays(const any_light& light, double reach) : reach_(reach) {
        if (const auto* parallel = std::get_if<directional_light>(&light)) {
            source_ = light_frame(*parallel).to_light();
        } else {
            source_ = std::get<point_light>(light).position;
            is_near_ = true;
            for (int i = 0; i < 3; ++i) reach_ = (std::max)(reach_, numeric::magnitude(source_[i]));
        }
    }

    /// From a point to the light: unit length if it is parallel, the whole way if it is near.
    glm::dvec3 toward(const glm::dvec3& p) const { return is_near_ ? source_ - p : source_; }

    /// Whether the triangle (a, b, c) blocks the light of `from`.
    bool are_blocked(const glm::dvec3& corner_a, const glm::dvec3& corner_b, const glm::dvec3& corner_c,
                     const glm::dvec3& from) const {
        const glm::dvec3 to_light = toward(from), a = corner_a - from, b = corner_b - from, c = corner_c - from;
        const double bc = numeric::dot(to_light, numeric::cross(b, c));
        const double ca = numeric::dot(to_light, numeric::cross(c, a));
        const double ab = numeric::dot(to_light, numeric::cross(a, b));
        const bool is_left = bc >= 0 && ca >= 0 && ab >= 0, is_right = bc <= 0 && ca <= 0 && ab <= 0;
        if (!is_left && !is_right) return false;
        const glm::dvec3 normal = numeric::cross(b - a, c - a);
        // From the corner that is nearest: another may lie so far off that its distance rounds away the point's.
        const auto size = [](const glm::dvec3& v) {
            return numeric::magnitude(v.x) + numeric::magnitude(v.y) + numeric::magnitude(v.z);
        };
        const glm::dvec3& some = size(a) <= size(b) ? a : b;
        const double along = numeric::dot(normal, to_light),
                     behind = numeric::dot(normal, size(some) <= size(c) ? some : c);
        const double sign = is_left ? 1 : -1;
        const double tolerance = 0x1p-40 * reach_ * size(normal);
        if (!(sign * along > 0 && sign * behind > tolerance)) return false;
        return !is_near_ || sign * (along - behind) > tolerance;  // what the light itself touches does not block it
    }

  private:
    glm::dvec3 source_;  ///< direction, or position
    double reach_;
    bool is_near_ = false;
};

}  // namespace shadow::detail
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
