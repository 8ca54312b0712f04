// Shading normals that are smooth across gentle bends and sharp across edges.
//
// Based on: Grit Thuermer, Charles A. Wuethrich. Computing Vertex Normals from Polygonal Facets. Journal of Graphics
// Tools 3(1), 1998 (the weight of a facet is its angle at the vertex).
#pragma once

#include <insonify/core/linear.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/geometry/mesh.hpp>
#include <insonify/geometry/topology.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

inline namespace INSONIFY_FLAGS {

/// The same triangles with unit normals. A corner's normal is the mean of the facets around its position that bend away
/// from its own facet by less than `angle`; a position becomes one vertex for each distinct normal. Facets without area
/// keep their corners, with +z as normal. Positions that no triangle uses are dropped. Takes time quadratic in the
/// triangles around a position.
/// @param angle  radians, 0 to pi; 0 makes every facet flat
/// @throws invalid_input if an index has no position, for normals that do not match the positions, or for an angle out
/// of range
inline mesh with_creases(const mesh& m, float angle = 0.7f) {
    validate(m);
    detail::require_range("angle", angle, 0, static_cast<float>(numeric::pi), "0 to pi radians");
    const double smoothest = numeric::sin_cos(static_cast<double>(angle)).cosine;
    const std::vector<std::uint32_t> first = weld(m.positions);

    struct corner {
        std::uint32_t position, triangle;
        int number;
        glm::dvec3 weighted;  // the facet's unit normal times its angle here
    };
    std::vector<glm::dvec3> facets(m.triangles.size(), glm::dvec3(0));
    std::vector<corner> corners;
    corners.reserve(3 * m.triangles.size());
    for (std::uint32_t t = 0; t < m.triangles.size(); ++t) {
        const glm::dvec3 p[3] = {glm::dvec3(m.positions[m.triangles[t].x]), glm::dvec3(m.positions[m.triangles[t].y]),
                                 glm::dvec3(m.positions[m.triangles[t].z])};
        const glm::dvec3 area = numeric::cross(p[1] - p[0], p[2] - p[0]);
        const double length = numeric::length(area);
        if (length > 0 && numeric::is_finite(length)) facets[t] = area / length;
        for (int i = 0; i < 3; ++i) {
            const double turn = numeric::atan2(length, numeric::dot(p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]));
            const bool has_area = facets[t] != glm::dvec3(0);  // otherwise the angle may be NaN
            corners.push_back({first[m.triangles[t][i]], t, i, has_area ? turn * facets[t] : facets[t]});
        }
    }
    std::sort(corners.begin(), corners.end(), [](const corner& a, const corner& b) {
        return a.position != b.position   ? a.position < b.position
               : a.triangle != b.triangle ? a.triangle < b.triangle
                                          : a.number < b.number;
    });

    mesh out;
    out.triangles = m.triangles;
    for (std::size_t begin = 0, end; begin < corners.size(); begin = end) {
        for (end = begin; end < corners.size() && corners[end].position == corners[begin].position;) ++end;
        const auto fan = out.positions.size();
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec3& facet = facets[corners[i].triangle];
            glm::dvec3 sum(0);
            for (std::size_t j = begin; j < end; ++j)
                if (i == j || numeric::dot(facet, facets[corners[j].triangle]) > smoothest) sum += corners[j].weighted;
            const double length = numeric::length(sum);
            const glm::vec3 normal =
                facet != glm::dvec3(0) && length > 0 ? glm::vec3(sum / length) : glm::vec3(0, 0, 1);
            std::size_t vertex = fan;
            while (vertex < out.normals.size() && out.normals[vertex] != normal) ++vertex;
            if (vertex == out.normals.size()) {
                out.positions.push_back(m.positions[corners[begin].position]);
                out.normals.push_back(normal);
            }
            out.triangles[corners[i].triangle][corners[i].number] = static_cast<std::uint32_t>(vertex);
        }
    }
    return out;
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
