// The ground that an overhead picture shows, and the ground that can throw a shadow into it.
#pragma once

#include <insonify/seabed/model.hpp>
#include <insonify/sonar/overhead/rig.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A rectangle along the world's axes, relative to the rig's position, metres.
struct ground_area {
    glm::dvec2 first{0}, last{0};

    void include(const glm::dvec2& p) {
        first = {(std::min)(first.x, p.x), (std::min)(first.y, p.y)};
        last = {(std::max)(last.x, p.x), (std::max)(last.y, p.y)};
    }
};

/// The ground that may be in view.
inline ground_area shown_ground(const overhead_geometry& view, const seabed::height_range& range) {
    ground_area area;
    for (const int right : {-1, 1})
        for (const int up : {-1, 1})
            for (const double height : {range.lowest, range.highest}) area.include(view.corner(height, right, up));
    return area;
}

/// The same, extended towards the light to all ground that can throw a shadow into view, by at most `longest` metres.
///
/// On its way to the light, a ray from the lowest ground rises above the highest within (highest - lowest)
/// cot(elevation) metres or, if the light is near, within that fraction of the distance to it; beyond, it meets
/// nothing. For a light that isn't a point, the corners of a square around it are tried: the distance is a quotient of
/// linear functions of the position on the light, so its maximum is in a corner.
/// @param radius  of the light over its distance
inline ground_area casting_ground(const overhead_geometry& view, const seabed::height_range& range, double radius,
                                  double longest) {
    const ground_area shown = shown_ground(view, range);
    ground_area all = shown;
    const double relief = range.highest - range.lowest;
    const glm::dmat3 to_world = glm::transpose(view.rig_from({}).linear);
    const auto clamped = [&](double way) { return (std::max)(-longest, (std::min)(longest, way)); };
    for (const double across : {-radius, radius})
        for (const double up : {-radius, radius}) {
            const glm::dvec2 beside{across, up};
            const glm::dvec3 toward = numeric::product(to_world, view.toward_light(beside));
            const glm::dvec3 source = numeric::product(to_world, view.light_position(beside));
            for (int axis = 0; axis < 2; ++axis) {
                for (const double from : {shown.first[axis], shown.last[axis]}) {
                    double way;
                    if (view.has_near_light()) {
                        const double share = source.z > range.highest ? relief / (source.z - range.lowest) : 1;
                        way = share * (source[axis] - from);
                    } else {
                        way = toward.z > 0 ? relief / toward.z * toward[axis] : longest * (toward[axis] < 0 ? -1 : 1);
                    }
                    const double end = from + clamped(way);
                    all.first[axis] = (std::min)(all.first[axis], end);
                    all.last[axis] = (std::max)(all.last[axis], end);
                }
            }
        }
    return all;
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
