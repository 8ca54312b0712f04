// What can be said of a target from its pose alone, and what its picture says: for the labels, and to check one by the
// other.
#pragma once

#include <insonify/insonify.hpp>

namespace generator {

namespace in = insonify;

/// Lengths are metres, in the picture's own geometry: along slant ranges in a slant-range picture.
struct facts {
    double metres_per_pixel, left_edge;  ///< the range, or the distance from nadir, where the picture begins
    double ground_range, slant_range;    ///< of the target's middle from the sonar, or from the camera's nadir
    double grazing;                      ///< radians, of the sound or the light on level ground there
    double aspect;                       ///< radians in [0, 2 pi): the target's x axis seen from the line of sight
    double height;                       ///< of its highest point above the datum
    double shadow, shadow_measured;      ///< from the echo of the point that casts the tip to the tip
    bool shadow_is_cut;                  ///< it goes on beyond the picture
};

inline double turn_of(double radians) {
    const double turns = radians / (2 * in::numeric::pi);
    return radians - 2 * in::numeric::pi * static_cast<double>(in::numeric::floor_to_int(turns));
}

/// Calls `visit` with every vertex of a target in the world.
template <class Fn>
void for_each_vertex(const in::target& t, const Fn& visit) {
    const in::affine to_world = in::to_world(t.placement);
    for (const glm::vec3& v : t.shape->positions) visit(in::transform_point(to_world, v));
}

/// Of a side-scan sonar, over a level bottom: the tip of the shadow is that of the vertex whose shadow reaches
/// farthest.
template <in::across_track Axis>
facts facts_of(const in::side_scan_rig<Axis>& rig, const in::target& t, const in::target_label& seen) {
    namespace geometry = in::range_geometry;
    constexpr bool slant = Axis == in::across_track::slant_range;
    const in::ping_frame frame(in::ping_of(rig, 0), rig.side);
    const double altitude = static_cast<double>(rig.altitude);
    facts f{};
    f.metres_per_pixel = rig.bin();
    f.left_edge = static_cast<double>(rig.first_range);
    f.ground_range = frame(t.placement.position).x;
    f.slant_range = geometry::slant_range(f.ground_range, altitude);
    f.grazing = geometry::grazing_angle(f.ground_range, altitude);
    const double line_of_sight = rig.side == in::side::starboard ? 0 : in::numeric::pi;
    f.aspect = turn_of(static_cast<double>(t.placement.yaw) - static_cast<double>(rig.yaw) - line_of_sight);
    double farthest = 0, echo = 0;
    for_each_vertex(t, [&](const glm::dvec3& world) {
        f.height = (std::max)(f.height, world.z);
        const double x = frame(world).x, tip = geometry::shadow_tip(x, altitude, world.z);
        if (!(tip > farthest)) return;
        farthest = tip;
        echo = slant ? geometry::slant_range(x, altitude, world.z) : x;
    });
    f.shadow = (slant ? geometry::slant_range(farthest, altitude) : farthest) - echo;
    const int end = seen.shadow_box.x1;
    f.shadow_measured = f.left_edge + end * f.metres_per_pixel - echo;
    f.shadow_is_cut = end >= rig.bins;
    return f;
}

/// Of the paper's camera and parallel light.
inline facts facts_of(const in::overhead_geometry& view, const in::target& t, const in::target_label& seen) {
    const in::overhead& rig = view.rig();
    const in::affine to_rig = view.rig_from(in::to_world(t.placement));
    facts f{};
    f.metres_per_pixel = view.ground_sampling();
    f.left_edge = -0.5 * rig.size.x * f.metres_per_pixel;
    f.ground_range = to_rig.offset.x;
    f.slant_range = in::range_geometry::slant_range(f.ground_range, static_cast<double>(rig.altitude));
    f.grazing = static_cast<double>(rig.grazing);
    f.aspect = turn_of(static_cast<double>(t.placement.yaw) - static_cast<double>(rig.yaw));
    double farthest = -1e30, foot = 0;
    for (const glm::vec3& v : t.shape->positions) {
        const glm::dvec3 p = in::transform_point(to_rig, v);
        f.height = (std::max)(f.height, p.z);
        const double tip = p.x + p.z * view.light().cot_elevation();
        if (tip > farthest) farthest = tip, foot = p.x;
    }
    f.shadow = farthest - foot;
    const int end = seen.shadow_box.x1;
    f.shadow_measured = f.left_edge + end * f.metres_per_pixel - foot;
    f.shadow_is_cut = end >= rig.size.x;
    return f;
}

}  // namespace generator
