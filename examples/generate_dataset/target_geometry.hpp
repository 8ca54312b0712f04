// Geometry of a target in its image: closed forms from its pose, and the same measured in the picture. Both are labels;
// tests compare them.
#pragma once

#include <cmath>

#include "../common/longest_shadow.hpp"

namespace generator {

namespace in = insonify;

/// Lengths are metres in the picture's geometry, so along the slant range in a slant-range picture.
struct target_geometry {
    double metres_per_pixel, left_edge;  ///< range, or distance from nadir, of the left edge
    double ground_range, slant_range;    ///< of the target's centre from the sonar, or from the camera's nadir
    double grazing;                      ///< radians, of the sound or light on level ground at the target
    double aspect;                       ///< radians in [0, 2 pi): from the line of sight to the target's x axis
    double height;                       ///< of its highest vertex above the datum
    double shadow, shadow_measured;      ///< from the echo of the point that casts the shadow's tip, to the tip; or 0
    bool shadow_is_cut;                  ///< by the right edge of the picture
    bool target_is_cut;                  ///< by any edge of the picture
};

/// An angle in [0, 2 pi).
inline double wrapped(double radians) {
    const double turns = radians / (2 * in::numeric::pi);
    return radians - 2 * in::numeric::pi * static_cast<double>(in::numeric::floor_to_int(turns));
}

/// Geometry under a side-scan sonar over a level bottom. The vertex whose shadow reaches farthest casts the tip.
template <in::across_track Axis>
target_geometry geometry_of(const in::side_scan_rig<Axis>& rig, const in::target& t, const in::target_label& seen) {
    namespace geometry = in::range_geometry;
    constexpr bool slant = Axis == in::across_track::slant_range;
    const in::ping_frame frame(in::ping_of(rig, 0), rig.side);
    const double altitude = static_cast<double>(rig.altitude);
    target_geometry f{};
    f.metres_per_pixel = rig.bin();
    f.left_edge = static_cast<double>(rig.first_range);
    f.ground_range = frame(t.placement.position).x;
    f.slant_range = geometry::slant_range(f.ground_range, altitude);
    f.grazing = geometry::grazing_angle(f.ground_range, altitude);
    const double line_of_sight = rig.side == in::side::starboard ? 0 : in::numeric::pi;
    f.aspect = wrapped(static_cast<double>(t.placement.yaw) - static_cast<double>(rig.yaw) - line_of_sight);
    const double first_row = -0.5 * static_cast<double>(rig.ping_spacing);
    const double last_row = first_row + rig.pings * static_cast<double>(rig.ping_spacing);
    const examples::longest_shadow s = examples::shadow_of(t, frame, altitude, [&](const glm::dvec3& v) {
        const double range = slant ? geometry::slant_range(v.x, altitude, v.z) : v.x;
        f.target_is_cut = f.target_is_cut || range < f.left_edge || range > static_cast<double>(rig.range) ||
                          v.y < first_row || v.y > last_row;
    });
    f.height = s.height;
    const double echo = slant ? s.slant_range : s.ground_range;
    f.shadow = slant ? s.slant_length : s.tip - s.ground_range;
    const int end = seen.shadow_box.x1;
    if (s.tip > 0 && seen.shadow_area > 0) f.shadow_measured = f.left_edge + end * f.metres_per_pixel - echo;
    const bool is_beyond = seen.shadow_area == 0 && s.tip > 0 && echo + f.shadow > static_cast<double>(rig.range);
    f.shadow_is_cut = end >= rig.bins || is_beyond;
    return f;
}

/// Geometry under the paper's camera and parallel light.
inline target_geometry geometry_of(const in::overhead_geometry& view, const in::target& t,
                                   const in::target_label& seen) {
    const in::overhead& rig = view.rig();
    const in::affine to_rig = view.rig_from(in::to_world(t.placement));
    target_geometry f{};
    f.metres_per_pixel = view.ground_sampling();
    f.left_edge = -0.5 * rig.size.x * f.metres_per_pixel;
    f.ground_range = to_rig.offset.x;
    f.slant_range = in::range_geometry::slant_range(f.ground_range, static_cast<double>(rig.altitude));
    f.grazing = static_cast<double>(rig.grazing);
    f.aspect = wrapped(static_cast<double>(t.placement.yaw) - static_cast<double>(rig.yaw));
    const glm::dvec2 half = view.half_extent(0);
    double farthest = -1e30, foot = farthest;
    for (const glm::vec3& v : t.shape->positions) {
        const glm::dvec3 p = in::transform_point(to_rig, v);
        f.height = (std::max)(f.height, p.z);
        // Perspective: higher points are seen farther from nadir.
        const double out = static_cast<double>(rig.altitude) / (static_cast<double>(rig.altitude) - p.z);
        f.target_is_cut = f.target_is_cut || !(out > 0) || std::abs(p.x) * out > half.x || std::abs(p.y) * out > half.y;
        const double tip = p.x + p.z * view.light().cot_elevation();
        if (p.z > 0 && tip > farthest) farthest = tip, foot = p.x;  // those below the datum are buried
    }
    f.shadow = farthest - foot;
    const int end = seen.shadow_box.x1;
    if (f.shadow > 0 && seen.shadow_area > 0) f.shadow_measured = f.left_edge + end * f.metres_per_pixel - foot;
    f.shadow_is_cut = end >= rig.size.x || (seen.shadow_area == 0 && f.shadow > 0 && farthest > half.x);
    return f;
}

}  // namespace generator
