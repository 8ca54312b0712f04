// The ground that can cast a shadow on points that lie above a rectangle.
#pragma once

#include <insonify/geometry/bounds.hpp>
#include <insonify/seabed/model.hpp>
#include <insonify/shadow/light.hpp>

#include <algorithm>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// The rectangle, extended towards the light to all ground that can cast a shadow on its points.
///
/// A ray from the lowest point to a parallel light is above the highest ground after (highest - lowest) cot(elevation)
/// metres; to a point light, after the fraction (highest - lowest) / (light's height - lowest) of the way. An extended
/// light is tried at the corners of a square around it: if all of it is above the ground that may cast, the distance is
/// a quotient of linear functions of the position on the light, with its maximum in a corner; else the ground is
/// extended to below the light, or by `longest`.
/// @param range   heights of the lowest point and of the highest ground
/// @param light   in the frame of the rectangle; the disc of a point light faces the origin
/// @param radius  of the light over its distance
/// @param longest  upper bound of the extension along each axis, metres
inline ground_rect casting_ground(const ground_rect& points, const seabed::height_range& range,
                                  const shadow::any_light& light, double radius, double longest) {
    ground_rect all = points;
    const double relief = range.highest - range.lowest;
    if (!(relief > 0)) return all;
    const auto* const source = std::get_if<shadow::point_light>(&light);
    const auto light_at = [&](const glm::dvec2& disc_offset) {  // a position for a point light, else a direction
        if (source != nullptr) return shadow::point_of_disc(source->position, disc_offset);
        const shadow::light_frame frame(std::get<shadow::directional_light>(light));
        return shadow::toward_disc(frame.to_light(), frame.travel(), disc_offset);
    };
    const auto clamped = [&](double way) { return (std::max)(-longest, (std::min)(longest, way)); };
    const double lowest_light = (std::min)(light_at({0, -radius}).z, light_at({0, radius}).z);
    const bool is_above = lowest_light > (source != nullptr ? range.highest : 0);
    for (const double across : {-radius, radius})
        for (const double up : {-radius, radius}) {
            const glm::dvec3 to = light_at({across, up});
            for (int axis = 0; axis < 2; ++axis) {
                for (const double from : {points.lower[axis], points.upper[axis]}) {
                    double way;
                    if (source != nullptr) {
                        const double fraction = is_above ? relief / (to.z - range.lowest) : 1;
                        way = fraction * (to[axis] - from);
                    } else {
                        way = is_above ? relief / to.z * to[axis] : longest * (to[axis] < 0 ? -1 : 1);
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
