// The ground that can throw a shadow on points that lie above a rectangle.
#pragma once

#include <insonify/geometry/bounds.hpp>
#include <insonify/seabed/model.hpp>

#include <algorithm>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// The rectangle, extended towards the light to all ground that can throw a shadow on its points, by at most `longest`
/// metres along either axis.
///
/// On its way to the light, a ray from the lowest point rises above the highest ground within (highest - lowest)
/// cot(elevation) metres or, if the light is near, within that fraction of the distance to it; beyond, it meets
/// nothing. For an extended light, the corners of a square around it are tried: the distance is a quotient of linear
/// functions of the position on the light, so its maximum is in a corner.
/// @param range     heights of the lowest point and of the highest ground
/// @param radius    of the light over its distance
/// @param is_near   whether the light is near
/// @param light_at  light_at(offset): the position of a point of a near light, or the direction to one of a distant
///                  light, by its offset from the centre, across and up, over the light's distance
template <class Light>
ground_rect casting_ground(const ground_rect& points, const seabed::height_range& range, double radius, double longest,
                           bool is_near, const Light& light_at) {
    ground_rect all = points;
    const double relief = range.highest - range.lowest;
    if (!(relief > 0)) return all;
    const auto clamped = [&](double way) { return (std::max)(-longest, (std::min)(longest, way)); };
    for (const double across : {-radius, radius})
        for (const double up : {-radius, radius}) {
            const glm::dvec3 light = light_at(glm::dvec2(across, up));
            for (int axis = 0; axis < 2; ++axis) {
                for (const double from : {points.lower[axis], points.upper[axis]}) {
                    double way;
                    if (is_near) {
                        const double share = light.z > range.highest ? relief / (light.z - range.lowest) : 1;
                        way = share * (light[axis] - from);
                    } else {
                        way = light.z > 0 ? relief / light.z * light[axis] : longest * (light[axis] < 0 ? -1 : 1);
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
