// Shading normals for meshes without normals.
//
// Based on: Grit Thuermer, Charles A. Wuethrich. Computing Vertex Normals from Polygonal Facets. Journal of Graphics
// Tools 3(1), 1998.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/linear.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/geometry/mesh.hpp>

#include <cstddef>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

inline namespace INSONIFY_FLAGS {

/// One unit normal per position: the mean of the triangles around it, weighted by their angle there, so that it does
/// not depend on how a face was cut into triangles. Triangles without area or with non-finite corners are skipped; a
/// position without other triangles gets +z. Edges stay sharp only between triangles that share no position by index.
/// @throws invalid_input if an index has no position
inline std::vector<glm::vec3> smooth_normals(const mesh& m) {
    validate(m);
    detail::dynamic_array<glm::dvec3> sums(m.positions.size(), glm::dvec3(0));
    for (const glm::uvec3& t : m.triangles) {
        const glm::dvec3 corners[3] = {glm::dvec3(m.positions[t.x]), glm::dvec3(m.positions[t.y]),
                                       glm::dvec3(m.positions[t.z])};
        const glm::dvec3 area = numeric::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double length = numeric::length(area);
        if (!(length > 0 && numeric::is_finite(length))) continue;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 a = corners[(i + 1) % 3] - corners[i];
            const glm::dvec3 b = corners[(i + 2) % 3] - corners[i];
            sums[t[i]] += numeric::atan2(length, numeric::dot(a, b)) / length * area;
        }
    }

    std::vector<glm::vec3> normals(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const double length = numeric::length(sums[i]);
        normals[i] = length > 0 ? glm::vec3(sums[i] / length) : glm::vec3(0, 0, 1);
    }
    return normals;
}

}  // namespace INSONIFY_FLAGS

namespace detail::inline INSONIFY_FLAGS {

/// Flips each triangle whose three corner normals all point to its back: normals define the outside.
/// @param m  its indices have positions, and positions have normals
inline void wind_by_normals(mesh& m) {
    for (glm::uvec3& t : m.triangles) {
        const glm::dvec3 a(m.positions[t.x]), b(m.positions[t.y]), c(m.positions[t.z]);
        const glm::dvec3 facet = numeric::cross(b - a, c - a);
        bool is_back = true;
        for (int i = 0; i < 3; ++i) is_back = is_back && numeric::dot(facet, glm::dvec3(m.normals[t[i]])) < 0;
        if (is_back) std::swap(t.y, t.z);
    }
}

}  // namespace detail::inline INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
