// The ground that an overhead picture shows, and the ground that can throw a shadow into it.
#pragma once

#include <insonify/geometry/bounds.hpp>
#include <insonify/seabed/model.hpp>
#include <insonify/sonar/overhead/rig.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// The ground that may be in view, relative to the rig's position.
inline ground_rect shown_ground(const overhead_geometry& view, const seabed::height_range& range) {
    ground_rect shown;
    for (const int right : {-1, 1})
        for (const int up : {-1, 1})
            for (const double height : {range.lowest, range.highest}) shown.include(view.corner(height, right, up));
    return shown;
}

/// The same, extended towards the light to all ground that can throw a shadow into view, by at most `longest` metres.
///
/// On its way to the light, a ray from the lowest ground rises above the highest within (highest - lowest)
/// cot(elevation) metres or, if the light is near, within that fraction of the distance to it; beyond, it meets
/// nothing. For an extended light, the corners of a square around it are tried: the distance is a quotient of linear
/// functions of the position on the light, so its maximum is in a corner.
/// @param radius  of the light over its distance
inline ground_rect casting_ground(const overhead_geometry& view, const seabed::height_range& range, double radius,
                                  double longest) {
    const ground_rect shown = shown_ground(view, range);
    ground_rect all = shown;
    const double relief = range.highest - range.lowest;
    const glm::dmat3 to_world = glm::transpose(view.rig_from({}).linear);
    const auto clamped = [&](double way) { return (std::max)(-longest, (std::min)(longest, way)); };
    for (const double across : {-radius, radius})
        for (const double up : {-radius, radius}) {
            const glm::dvec2 beside{across, up};
            const glm::dvec3 toward = numeric::product(to_world, view.toward_light(beside));
            const glm::dvec3 source = numeric::product(to_world, view.light_position(beside));
            for (int axis = 0; axis < 2; ++axis) {
                for (const double from : {shown.lower[axis], shown.upper[axis]}) {
                    double way;
                    if (view.has_near_light()) {
                        const double share = source.z > range.highest ? relief / (source.z - range.lowest) : 1;
                        way = share * (source[axis] - from);
                    } else {
                        way = toward.z > 0 ? relief / toward.z * toward[axis] : longest * (toward[axis] < 0 ? -1 : 1);
                    }
                    const double end = from + clamped(way);
                    all.lower[axis] = (std::min)(all.lower[axis], end);
                    all.upper[axis] = (std::max)(all.upper[axis], end);
                }
            }
        }
    return all;
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
