// The overhead rig: a camera that looks straight down, and a light at a low grazing angle that rotates with it.
#pragma once

#include <insonify/geometry/transform.hpp>
#include <insonify/shadow/light.hpp>

#include <limits>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Camera and light above a position on the seabed. Image up is forward, image right is starboard. The light comes from
/// the left, so shadows fall to the right, as in a starboard channel. Geometry above the camera, or less than a
/// thousandth of the altitude below it, is not drawn but casts shadows.
///
/// A pixel is linear radiance: reflectivity x (intensity x law(sine of the grazing angle on the surface) x lit fraction
/// + sky x fraction of the sky that the surface faces + ambient), clamped to 1.
struct overhead {
    glm::dvec2 position{0, 0};                                      ///< of the camera over the datum, metres
    float altitude = 10;                                            ///< above the datum, metres
    float yaw = 0;                                                  ///< of camera and light together, radians
    float field_of_view = static_cast<float>(2 * numeric::pi / 3);  ///< across the picture, radians
    glm::ivec2 size{2048, 2048};                           ///< pixels: width (across track), height (along track)
    float grazing = static_cast<float>(numeric::pi / 30);  ///< of the light on level ground, radians
    float light_azimuth = 0;  ///< direction of travel of the light, from image right towards image up, radians
    /// Distance of the light from the datum below the camera, where grazing and azimuth apply, metres. If infinite, its
    /// rays are parallel; if finite, it is a point light, which needs `shadow::exact` or `penumbra` and has no falloff.
    float light_distance = std::numeric_limits<float>::infinity();
    float intensity = 4;  ///< of the light on a surface that faces it
    float sky = 0.05f;    ///< light from the upper hemisphere, without shadows
    float ambient = 0;    ///< light on every surface alike, without shadows
};

inline namespace INSONIFY_FLAGS {

/// @throws invalid_input for a value out of range
inline void validate(const overhead& rig) {
    using detail::require, detail::require_not_negative, detail::require_range;
    detail::require_finite("overhead.position", rig.position);
    detail::require_positive("overhead.altitude", rig.altitude);
    detail::require_angle("overhead.yaw", rig.yaw);
    require(rig.field_of_view > 0 && static_cast<double>(rig.field_of_view) < numeric::to_radians(179.9),
            "overhead.field_of_view", rig.field_of_view, "above 0 and below 179.9 degrees, in radians");
    require_range("overhead.size.x", rig.size.x, 1, 32768, "1 to 32768");
    require_range("overhead.size.y", rig.size.y, 1, 32768, "1 to 32768");
    require(rig.grazing >= 1e-9f && static_cast<double>(rig.grazing) <= numeric::pi / 2 + 1e-7, "overhead.grazing",
            rig.grazing, "10^-9 to pi / 2 radians");
    detail::require_angle("overhead.light_azimuth", rig.light_azimuth);
    require(rig.light_distance > 0 && (rig.light_distance <= 1e15f || !numeric::is_finite(rig.light_distance)),
            "overhead.light_distance", rig.light_distance, "above 0 and at most 10^15 metres, or infinite");
    require_not_negative("overhead.intensity", rig.intensity);
    require_not_negative("overhead.sky", rig.sky);
    require_not_negative("overhead.ambient", rig.ambient);
}

/// The projection and the light of a rig. Everything is drawn in the rig's frame (origin on the datum below the camera,
/// x to the right, y forward, z up), so that coordinates stay small at any distance from the world's origin.
class overhead_geometry {
  public:
    /// @throws invalid_input as validate does
    explicit overhead_geometry(const overhead& rig)
        : rig_((validate(rig), rig)),
          tangent_(numeric::tan(0.5 * numeric::widened(rig.field_of_view))),
          light_({numeric::widened(rig.light_azimuth), numeric::widened(rig.grazing)}) {
        clip_scale_ = glm::vec2(1 / tangent_, static_cast<double>(rig.size.x) / rig.size.y / tangent_);
        const auto [sine, cosine] = numeric::sin_cos(numeric::widened(rig.yaw));
        right_ = {cosine, sine};
        rig_from_world_.linear = {{cosine, -sine, 0}, {sine, cosine, 0}, {0, 0, 1}};
        rig_from_world_.offset = -numeric::product(rig_from_world_.linear, glm::dvec3(rig.position, 0));
    }

    const overhead& rig() const { return rig_; }
    const shadow::light_frame& light() const { return light_; }
    bool has_point_light() const { return numeric::is_finite(rig_.light_distance); }
    /// Position of a point light.
    glm::dvec3 light_position() const { return static_cast<double>(rig_.light_distance) * light_.to_light(); }
    /// The light in the rig's frame, for shadow policies.
    shadow::any_light light_source() const {
        if (has_point_light()) return shadow::point_light{light_position()};
        return shadow::directional_light{numeric::widened(rig_.light_azimuth), numeric::widened(rig_.grazing)};
    }
    /// The light along the world's axes, relative to the rig's position.
    shadow::any_light world_light() const {
        if (has_point_light())
            return shadow::point_light{numeric::product(glm::transpose(rig_from_world_.linear), light_position())};
        return shadow::directional_light{numeric::widened(rig_.light_azimuth) + numeric::widened(rig_.yaw),
                                         numeric::widened(rig_.grazing)};
    }

    /// From an object's frame to the rig's. Subtracts the rig's position before it rotates, so that large coordinates
    /// cancel exactly.
    affine rig_from(const affine& world_from_object) const {
        const glm::dvec3 relative = world_from_object.offset - glm::dvec3(rig_.position, 0);
        return {numeric::product(rig_from_world_.linear, world_from_object.linear),
                numeric::product(rig_from_world_.linear, relative)};
    }

    /// Half the size of the picture's footprint at a height above the datum, metres.
    glm::dvec2 half_extent(double height) const {
        const double half_width = (static_cast<double>(rig_.altitude) - height) * tangent_;
        return {half_width, half_width * rig_.size.y / rig_.size.x};
    }
    /// Metres per pixel on level ground at the datum.
    double ground_sampling() const { return 2 * half_extent(0).x / rig_.size.x; }

    /// A horizontal vector of the rig's frame, along the world's axes.
    glm::dvec2 along_world(const glm::dvec2& v) const {
        return {v.x * right_.x - v.y * right_.y, v.x * right_.y + v.y * right_.x};
    }
    /// A corner of the picture's footprint at a height, relative to the rig's position, along the world's axes.
    glm::dvec2 corner(double height, int right, int up) const {
        const glm::dvec2 half = half_extent(height);
        return along_world({right * half.x, up * half.y});
    }

    /// Pinhole projection with reversed depth, z / w = z_near / distance: larger is nearer.
    glm::vec4 clip(const glm::vec3& p) const {
        return {p.x * clip_scale_.x, p.y * clip_scale_.y, near_plane * rig_.altitude, rig_.altitude - p.z};
    }
    /// The same for coordinates in SIMD lanes.
    template <class Floats>
    INSONIFY_INLINE void clip(Floats (&into)[4], const Floats* p) const {
        into[0] = p[0] * clip_scale_.x;
        into[1] = p[1] * clip_scale_.y;
        into[2] = Floats{} + near_plane * rig_.altitude;
        into[3] = rig_.altitude - p[2];
    }

    glm::dvec3 eye() const { return {0, 0, rig_.altitude}; }
    /// Height up to which everything is in front of the near plane, however `clip` is rounded.
    double highest_drawn() const { return (1 - 2 * numeric::widened(near_plane)) * numeric::widened(rig_.altitude); }
    /// Metres per pixel, 1 m below the camera.
    double ray_step() const { return 2 * tangent_ / rig_.size.x; }
    /// Vector from the camera through a pixel's centre, to 1 m below it.
    glm::dvec3 ray(int x, int y) const {
        const double step = ray_step();
        return {step * (x + 0.5 - 0.5 * rig_.size.x), step * (0.5 * rig_.size.y - y - 0.5), -1};
    }

    /// Projection of a point of the rig's frame, in continuous pixels.
    glm::dvec2 pixel(const glm::dvec3& p) const {
        const double scale = 0.5 * rig_.size.x / (tangent_ * (static_cast<double>(rig_.altitude) - p.z));
        return {0.5 * rig_.size.x + scale * p.x, 0.5 * rig_.size.y - scale * p.y};
    }

  private:
    static constexpr float near_plane = 1e-3f;  ///< distance from the camera, in altitudes

    overhead rig_;
    double tangent_;
    glm::vec2 clip_scale_;
    shadow::light_frame light_;
    glm::dvec2 right_;
    affine rig_from_world_;
};

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
