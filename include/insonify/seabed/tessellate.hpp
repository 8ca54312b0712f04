// Tessellates heightfields into triangle meshes.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/executor.hpp>
#include <insonify/geometry/mesh.hpp>
#include <insonify/seabed/heightfield.hpp>
#include <insonify/seabed/normals.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

namespace detail::inline INSONIFY_FLAGS {

/// The triangles of a cell that have data at all corners.
struct cell_facets {
    bool lower, upper;

    /// @param here, ahead  the cell's first vertex in the row, and in the next
    cell_facets(const float* here, const float* ahead) {
        const bool diagonal = numeric::is_finite(here[0]) && numeric::is_finite(ahead[1]);
        lower = diagonal && numeric::is_finite(here[1]);
        upper = diagonal && numeric::is_finite(ahead[0]);
    }
    std::size_t count() const { return std::size_t{lower} + std::size_t{upper}; }
};

/// Position of a heightfield's vertex in the mesh; z = 0 without data.
inline glm::vec3 position_at(const heightfield& field, std::size_t i, std::size_t j, glm::ivec2 first) {
    const float height = field.heights(static_cast<int>(i), static_cast<int>(j));
    return {static_cast<float>(field.spacing * (static_cast<double>(first.x) + static_cast<double>(i))),
            static_cast<float>(field.spacing * (static_cast<double>(first.y) + static_cast<double>(j))),
            numeric::is_finite(height) ? height : 0.0f};
}

/// `tessellate`, for any type of mesh.
template <class Mesh, executor E>
void tessellate_into(Mesh& result, const heightfield& field, E& ex, glm::ivec2 first) {
    validate(field);
    const image<float>& heights = field.heights;
    const auto width = static_cast<std::size_t>(heights.width()), height = static_cast<std::size_t>(heights.height());
    insonify::detail::require(heights.size() <= 0xFFFFFFFFu, "heightfield.heights.size()", heights.size(),
                              "below 2^32");

    result.positions.resize(heights.size());
    result.normals.resize(heights.size());

    // Write the vertices and count the triangles of each row of cells.
    detail::dynamic_array<std::size_t> first_triangle(height, 0);
    ex.bulk(height, [&](std::size_t j) {
        row_normals(field, static_cast<int>(j), &result.normals[j * width]).compute();
        for (std::size_t i = 0; i < width; ++i) result.positions[j * width + i] = position_at(field, i, j, first);
        if (j + 1 == height) return;
        const float* const here = heights.row(static_cast<int>(j)).data();
        const float* const ahead = heights.row(static_cast<int>(j + 1)).data();
        std::size_t count = 0;
        for (std::size_t i = 0; i + 1 < width; ++i) count += cell_facets(here + i, ahead + i).count();
        first_triangle[j + 1] = count;
    });
    for (std::size_t j = 1; j < height; ++j) first_triangle[j] += first_triangle[j - 1];

    result.triangles.resize(first_triangle.back());
    ex.bulk(height - 1, [&](std::size_t j) {
        const float* const here = heights.row(static_cast<int>(j)).data();
        const float* const ahead = heights.row(static_cast<int>(j + 1)).data();
        glm::uvec3* next = result.triangles.data() + first_triangle[j];
        for (std::size_t i = 0; i + 1 < width; ++i) {
            const auto corner = static_cast<std::uint32_t>(j * width + i);
            const auto opposite = static_cast<std::uint32_t>(corner + width + 1);
            const cell_facets drawn(here + i, ahead + i);
            if (drawn.lower) *next++ = {corner, corner + 1, opposite};
            if (drawn.upper) *next++ = {corner, opposite, opposite - 1};
        }
    });
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// The surface of a heightfield as a mesh: two triangles per cell, counter-clockwise from above, cut from vertex (i, j)
/// to (i + 1, j + 1); 2 (width - 1) (height - 1) triangles if no height is missing.
///
/// Positions are spacing (first + (i, j)), relative to an origin that the caller places, so that float holds them
/// wherever the field lies: place the mesh at `field.origin`, or with `first` at the larger grid's origin. Vertex (i,
/// j) is number j width + i. Normals are those of `normals`. Vertices without data lie at z = 0 and belong to no
/// triangle.
/// @param first  index of vertex (0, 0) in a larger grid: meshes of its parts share their vertices to the last bit
/// @throws invalid_input as `validate`, and for 2^32 vertices or more
template <executor_argument Executor = serial_executor>
mesh tessellate(const heightfield& field, Executor&& ex = serial_executor{}, glm::ivec2 first = {0, 0}) {
    mesh result;
    detail::tessellate_into(result, field, ex, first);
    return result;
}

}  // namespace INSONIFY_FLAGS

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
