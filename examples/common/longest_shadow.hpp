// Length of a target's shadow on a level bottom, in closed form from its vertices, to compare measured shadows with.
#pragma once

#include <insonify/insonify.hpp>
#include <insonify/sonar/side_scan/range_geometry.hpp>

namespace examples {

/// The shadow of the vertex that casts farthest; vertices below the datum are buried and cast none. Metres, from the
/// sonar.
struct longest_shadow {
    double tip = 0;                            ///< ground range where the shadow ends; 0 if no vertex casts one
    double ground_range = 0, slant_range = 0;  ///< of the vertex
    double slant_length = 0;                   ///< of the shadow, in slant range; 0 if no vertex casts one
    double height = -1e30;                     ///< of the target's highest point above the datum
};

/// @param visit  called with each vertex in the ping's frame: across track, along track, up
template <class Visit>
longest_shadow shadow_of(const insonify::target& t, const insonify::ping_frame& frame, double altitude,
                         const Visit& visit) {
    namespace geometry = insonify::range_geometry;
    const insonify::affine to_world = insonify::to_world(t.placement);
    longest_shadow s;
    for (const glm::vec3& v : t.shape->positions) {
        const glm::dvec3 world = insonify::transform_point(to_world, v);
        const glm::dvec2 across_along(frame(world));
        visit(glm::dvec3(across_along, world.z));
        s.height = (std::max)(s.height, world.z);
        const double tip = geometry::shadow_tip(across_along.x, altitude, world.z);
        if (world.z <= 0 || !(tip > s.tip)) continue;
        s.tip = tip;
        s.ground_range = across_along.x;
        s.slant_range = geometry::slant_range(across_along.x, altitude, world.z);
        s.slant_length = geometry::slant_shadow_length(across_along.x, altitude, world.z);
    }
    return s;
}

}  // namespace examples
