// The outline of an object on the ground it stands on.
//
// Based on: A. M. Andrew. Another efficient algorithm for convex hulls in two dimensions. Information Processing
// Letters 9(5), 1979.
#pragma once

#include <insonify/core/linear.hpp>
#include <insonify/geometry/mesh.hpp>
#include <insonify/geometry/transform.hpp>

#include <algorithm>
#include <limits>
#include <vector>

#include <glm/vec2.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

inline namespace INSONIFY_FLAGS {

/// The convex hull, counter-clockwise and without corners on straight edges, of the finite positions that are at most
/// `height` above the lowest one, seen from above. Fewer than three corners if those lie on a line.
/// @param height  metres, >= 0: masts and wings that stick out higher do not count
/// @throws invalid_input for a pose that `to_world` refuses, or a height that is negative or NaN
inline std::vector<glm::dvec2> footprint(const mesh_view& m, const pose& placement, float height) {
    detail::require(height >= 0, "height", height, "at least 0 metres");
    const affine map = to_world(placement);
    double lowest = std::numeric_limits<double>::infinity();
    std::vector<glm::dvec3> points;
    for (const glm::vec3& p : m.positions) {
        const glm::dvec3 at = transform_point(map, glm::dvec3(p));
        if (!numeric::is_finite(at)) continue;
        points.push_back(at);
        lowest = (std::min)(lowest, at.z);
    }
    std::vector<glm::dvec2> flat;
    for (const glm::dvec3& p : points)
        if (p.z - lowest <= static_cast<double>(height)) flat.emplace_back(p.x, p.y);
    std::sort(flat.begin(), flat.end(),
              [](const glm::dvec2& a, const glm::dvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });

    std::vector<glm::dvec2> outline;
    const auto add = [&](const glm::dvec2& p, std::size_t kept) {
        while (outline.size() >= kept + 2) {
            const glm::dvec2 a = outline[outline.size() - 2], ab = outline.back() - a, ap = p - a;
            if (numeric::cross(ab, ap) > 0) break;
            outline.pop_back();
        }
        outline.push_back(p);
    };
    for (const glm::dvec2& p : flat) add(p, 0);
    const std::size_t lower = outline.empty() ? 0 : outline.size() - 1;
    for (std::size_t i = flat.size(); i-- > 0;) add(flat[i], lower);
    if (outline.size() > 1) outline.pop_back();  // the first again
    return outline;
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
