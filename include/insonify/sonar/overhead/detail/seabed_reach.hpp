// How far beyond the picture the seabed has to be there, so that whatever can throw a shadow into it does.
#pragma once

#include <insonify/seabed/model.hpp>
#include <insonify/sonar/overhead/rig.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A rectangle along the world's axes around the rig's position, metres.
struct ground_box {
    glm::dvec2 first{0}, last{0};

    void include(const glm::dvec2& p) {
        first = {(std::min)(first.x, p.x), (std::min)(first.y, p.y)};
        last = {(std::max)(last.x, p.x), (std::max)(last.y, p.y)};
    }
};

/// All of the bottom that the picture may show.
inline ground_box shown_ground(const overhead_geometry& view, const seabed::height_range& range) {
    ground_box box;
    for (const int right : {-1, 1})
        for (const int up : {-1, 1})
            for (const double height : {range.lowest, range.highest}) box.include(view.corner(height, right, up));
    return box;
}

/// The same, longer towards the light by as much as can throw a shadow into it, at most `longest` metres.
///
/// A shadow falls from a point of the bottom to a lower one along a ray of the light. On its way up from the lower one,
/// a ray comes to the highest point that there may be within (highest - lowest) cot(elevation) metres, or, of light
/// from nearby, within the same share of its way to the light; beyond that it meets nothing. Of a light that isn't a
/// point, this is asked of the corners of a square around it: the way is a quotient of linear functions of the place on
/// it, so it is longest in one of them.
/// @param radius  of the light over its distance
inline ground_box casting_ground(const overhead_geometry& view, const seabed::height_range& range, double radius,
                                 double longest) {
    const ground_box shown = shown_ground(view, range);
    ground_box all = shown;
    const double relief = range.highest - range.lowest;
    const glm::dmat3 to_world = glm::transpose(view.rig_from({}).linear);
    const auto held = [&](double way) { return (std::max)(-longest, (std::min)(longest, way)); };
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
                    const double end = from + held(way);
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
