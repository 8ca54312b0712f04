// From heightfield to triangles.
#pragma once

#include <insonify/core/executor.hpp>
#include <insonify/geometry/mesh.hpp>
#include <insonify/seabed/heightfield.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::seabed {

namespace detail {

/// Which triangles of a cell have data at all their corners.
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

/// How much a surface rises at the vertices of a row, by central differences: twice the rise of a cell. A neighbour
/// that is missing or beyond the edge leaves the side that is there to count twice; at a vertex without data nothing
/// rises.
class row_rises {
  public:
    row_rises(const image<float>& heights, int j)
        : here_(heights.row(j).data()),
          back_(heights.row((std::max)(j - 1, 0)).data()),
          ahead_(heights.row((std::min)(j + 1, heights.height() - 1)).data()),
          width_(static_cast<std::size_t>(heights.width())),
          inner_(j > 0 && j + 1 < heights.height()) {}

    float x(std::size_t i) const {
        const std::size_t left = i > 0 ? i - 1 : i, right = i + 1 < width_ ? i + 1 : i;
        return rise(here_[left], here_[i], here_[right], right - left == 2);
    }
    float y(std::size_t i) const { return rise(back_[i], here_[i], ahead_[i], inner_); }

    /// Unit normal of the surface at a vertex.
    glm::vec3 normal(std::size_t i, float spacing) const {
        const float dx = x(i), dy = y(i), dz = 2 * spacing;
        const float inverse = 1 / numeric::square_root(dx * dx + dy * dy + dz * dz);
        return {-dx * inverse, -dy * inverse, dz * inverse};
    }

  private:
    static float rise(float before, float at, float after, bool both) {
        if (!numeric::is_finite(at)) return 0;
        const bool has_before = numeric::is_finite(before), has_after = numeric::is_finite(after);
        if (has_before && has_after) return both ? after - before : 2 * (after - before);
        return has_after ? 2 * (after - at) : has_before ? 2 * (at - before) : 0.0f;
    }

    const float *here_, *back_, *ahead_;
    std::size_t width_;
    bool inner_;
};

/// A vertex of a heightfield as its mesh has it; one without data lies at z = 0.
inline glm::vec3 position_at(const heightfield& field, std::size_t i, std::size_t j) {
    const float height = field.heights(static_cast<int>(i), static_cast<int>(j));
    return {static_cast<float>(field.spacing * static_cast<double>(i)),
            static_cast<float>(field.spacing * static_cast<double>(j)), numeric::is_finite(height) ? height : 0.0f};
}

}  // namespace detail

/// The surface of a heightfield as a mesh: two triangles per cell, counter-clockwise from above, cut from vertex (i, j)
/// to (i + 1, j + 1); 2 (width - 1) (height - 1) triangles if no height is missing.
///
/// Positions are relative to the heightfield's origin, x in [0, spacing (width - 1)], so that float holds them wherever
/// the field lies: place the mesh at `field.origin`. Vertex (i, j) is number j width + i. Normals are those of central
/// differences, one-sided at edges. Vertices without data lie at z = 0 and belong to no triangle.
/// @throws invalid_input as `validate`, and for 2^32 vertices or more
template <executor_argument Executor = serial_executor>
mesh tessellate(const heightfield& field, Executor&& ex = serial_executor{}) {
    validate(field);
    const image<float>& heights = field.heights;
    const auto width = static_cast<std::size_t>(heights.width()), height = static_cast<std::size_t>(heights.height());
    detail::require(heights.size() < (std::size_t{1} << 32), "heightfield.heights.size()", heights.size(),
                    "below 2^32");

    mesh result;
    result.positions.resize(heights.size());
    result.normals.resize(heights.size());

    // Write the vertices, and count the triangles of each row of cells on the way.
    std::vector<std::size_t> first_triangle(height, 0);
    const auto spacing = static_cast<float>(field.spacing);
    ex.bulk(height, [&](std::size_t j) {
        const detail::row_rises rises(heights, static_cast<int>(j));
        for (std::size_t i = 0; i < width; ++i) {
            result.positions[j * width + i] = detail::position_at(field, i, j);
            result.normals[j * width + i] = rises.normal(i, spacing);
        }
        if (j + 1 == height) return;
        const float* const here = heights.row(static_cast<int>(j)).data();
        const float* const ahead = heights.row(static_cast<int>(j + 1)).data();
        std::size_t count = 0;
        for (std::size_t i = 0; i + 1 < width; ++i) count += detail::cell_facets(here + i, ahead + i).count();
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
            const detail::cell_facets drawn(here + i, ahead + i);
            if (drawn.lower) *next++ = {corner, corner + 1, opposite};
            if (drawn.upper) *next++ = {corner, opposite, opposite - 1};
        }
    });
    return result;
}

}  // namespace insonify::inline INSONIFY_ABI::seabed

INSONIFY_ARITHMETIC_END
