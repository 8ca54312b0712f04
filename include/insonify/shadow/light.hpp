// A parallel light over the sea floor, and the sheared frame in which its shadows are upright.
//
// Points are projected onto the datum along the light's rays: u = x . travel + z cot(elevation), v across. All points
// of one ray share (u, v), and of two of them the higher one is nearer to the light. The map from world to frame is
// affine, so triangles stay triangles; equal steps in (u, v) are equal steps on level ground at every elevation; and
// level ground is level here too, so it needs no bias.
#pragma once

#include <insonify/core/linear.hpp>
#include <insonify/core/numeric.hpp>

#include <algorithm>
#include <variant>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow {

/// Light from infinitely far away.
struct directional_light {
    /// Radians: the float nearest to 10^-9, which rigs take.
    static constexpr double lowest_elevation = static_cast<double>(1e-9f);

    double azimuth = 0;                         ///< radians: where it travels to, from +x towards +y
    double elevation = numeric::to_radians(6);  ///< radians above the horizon, lowest_elevation to pi / 2
};

/// Light from a point.
struct point_light {
    glm::dvec3 position{0, 0, 1};  ///< metres
};

/// A light of any kind.
using any_light = std::variant<directional_light, point_light>;

inline namespace INSONIFY_FLAGS {

/// Frame of a directional light; coordinates are metres.
class light_frame {
  public:
    /// @throws invalid_input for an elevation outside 10^-9 to pi / 2 or an azimuth beyond 10^6 radians
    explicit light_frame(const directional_light& light) {
        insonify::detail::require(
            light.elevation >= directional_light::lowest_elevation && light.elevation <= numeric::pi / 2 + 1e-7,
            "directional_light.elevation", light.elevation, "10^-9 to pi / 2");
        insonify::detail::require_angle("directional_light.azimuth", light.azimuth);
        const auto [sin_azimuth, cos_azimuth] = numeric::sin_cos(light.azimuth);
        const auto [sin_elevation, cosine] = numeric::sin_cos(light.elevation);
        const double cos_elevation = (std::max)(cosine, 0.0);  // floats near pi / 2 are beyond the zenith
        travel_ = {cos_azimuth, sin_azimuth};
        cot_ = cos_elevation / sin_elevation;
        to_light_ = {-cos_azimuth * cos_elevation, -sin_azimuth * cos_elevation, sin_elevation};
    }

    /// Unit vector on the ground along which shadows grow.
    const glm::dvec2& travel() const { return travel_; }
    /// Unit vector from a point towards the light.
    const glm::dvec3& to_light() const { return to_light_; }
    /// Length of a shadow on level ground for a height of one.
    double cot_elevation() const { return cot_; }

    /// (u, v, z) of a world position.
    glm::dvec3 operator()(const glm::dvec3& p) const {
        return {p.x * travel_.x + p.y * travel_.y + p.z * cot_, p.y * travel_.x - p.x * travel_.y, p.z};
    }

  private:
    glm::dvec2 travel_;
    glm::dvec3 to_light_;
    double cot_;
};

/// Direction to a point of a disc of light, in units of the distance to its centre.
/// @param to_light     unit vector to the centre
/// @param travel       unit vector on the ground along which shadows grow
/// @param disc_offset  from the centre, across and down, in the same unit
inline glm::dvec3 toward_disc(const glm::dvec3& to_light, const glm::dvec2& travel, const glm::dvec2& disc_offset) {
    const glm::dvec3 across(-travel.y, travel.x, 0), down = numeric::cross(to_light, across);
    return to_light + disc_offset.x * across + disc_offset.y * down;
}

/// A point of a disc of light that faces the origin.
/// @param disc_offset  from the centre, across and down, over the centre's distance from the origin
inline glm::dvec3 point_of_disc(const glm::dvec3& centre, const glm::dvec2& disc_offset) {
    const double distance = numeric::length(centre);
    const double level = numeric::length(glm::dvec2(centre));
    const glm::dvec2 travel = level > 0 ? glm::dvec2(-centre.x / level, -centre.y / level) : glm::dvec2(1, 0);
    return distance > 0 ? distance * toward_disc(centre / distance, travel, disc_offset) : centre;
}

}  // namespace INSONIFY_FLAGS

}  // namespace shadow
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
