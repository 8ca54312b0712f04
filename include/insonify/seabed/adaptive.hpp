// Adaptive tessellation: the surface of a heightfield by few triangles, within a tolerance of all of them.
#pragma once

#include <insonify/seabed/detail/needed_vertices.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// A mesh of some vertices of a heightfield.
struct adaptive_mesh {
    mesh shape;                           ///< as `tessellate` makes it
    std::vector<std::uint32_t> vertices;  ///< index of each in the heightfield: j width + i
};

namespace detail::inline INSONIFY_FLAGS {

/// Calls `emit(corner, corner, corner)`, counter-clockwise and each a glm::ivec2, for every triangle whose right angle
/// is at a vertex.
template <class Emit>
void triangles_at(const needed_vertices& needed, int x, int y, const Emit& emit) {
    if (!needed(x, y)) return;
    const int s = needed_vertices::step_of(x, y);
    const bool centre = (x & s) != 0 && (y & s) != 0;
    // The corners of its diamond, counter-clockwise.
    static constexpr int square[5][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}, {1, 1}};
    static constexpr int upright[5][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}};
    const glm::ivec2 here(x, y);
    const auto corner = [&](int k) {
        const auto& to = centre ? square[k] : upright[k];
        return glm::ivec2(x + s * to[0], y + s * to[1]);
    };
    for (int k = 0; k < 4; ++k) {
        const glm::ivec2 a = corner(k), b = corner(k + 1);
        if (!needed.inside(a.x, a.y) || !needed.inside(b.x, b.y)) continue;
        if (centre || s > 1) {
            const glm::ivec2 middle = (a + b) / 2;
            if (!needed(middle.x, middle.y)) emit(here, a, b);
            continue;
        }
        // Half a cell. If the other half is one triangle, too, the cell has the heightfield's diagonal.
        const glm::ivec2 opposite = a + b - here;
        const bool rising = (b.x - a.x) == (b.y - a.y);
        if (!rising && needed(opposite.x, opposite.y))
            emit(here, a, opposite);
        else
            emit(here, a, b);
    }
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Adaptive mesh of a heightfield: at no point of a triangle is the full surface (`height_at`) farther above or below
/// than `allowed` at the triangle's corners; the slopes at the vertices that a triangle replaces stay within `allowed`,
/// too, and these vertices are of one type. At a tolerance of 0 on rough ground the triangles are those of
/// `tessellate`; a plane takes two, and some more beside an edge whose length is not a power of two cells. Takes
/// several times as long as `tessellate`.
///
/// The mesh is minimal within its hierarchy: no two halves of a triangle could be merged within the tolerance.
/// @param first  as for `tessellate`
/// @throws invalid_input as `tessellate`, and for a negative or NaN tolerance or a nadir that is not finite
template <executor_argument Executor = serial_executor>
adaptive_mesh tessellate(const heightfield& field, const tolerance& allowed, Executor&& ex = serial_executor{},
                         glm::ivec2 first = {0, 0}) {
    validate(field);
    detail::require(allowed.height >= 0, "tolerance.height", allowed.height, "metres, at least 0");
    detail::require(allowed.slope >= 0, "tolerance.slope", allowed.slope, "a slope, at least 0");
    detail::require(allowed.lean >= 0, "tolerance.lean", allowed.lean, "square metres, at least 0");
    insonify::detail::require_finite("tolerance.nadir.x", allowed.nadir.x);
    insonify::detail::require_finite("tolerance.nadir.y", allowed.nadir.y);
    const image<float>& heights = field.heights;
    detail::require(heights.size() <= 0xFFFFFFFFu, "heightfield.heights.size()", heights.size(), "below 2^32");
    const detail::needed_vertices needed(field, allowed, ex);

    const int size = needed.size();
    const auto rows = static_cast<std::size_t>(heights.height()), columns = static_cast<std::size_t>(heights.width());
    // The corners of the hierarchy's root are not midpoints of any side.
    const auto is_corner = [=](std::size_t x, std::size_t y) {
        const auto end = static_cast<std::size_t>(size);
        return (x == 0 || x == end) && (y == 0 || y == end);
    };
    // The two halves of the root, if not even its centre is needed.
    const bool whole = needed.inside(size, size) && (size == 1 || !needed(size / 2, size / 2));
    const auto each_triangle = [&](std::size_t j, const auto& emit) {
        const auto known = [&](const glm::ivec2& p) { return numeric::is_finite(heights(p.x, p.y)); };
        const auto emit_known = [&](const glm::ivec2& a, const glm::ivec2& b, const glm::ivec2& c) {
            if (known(a) && known(b) && known(c)) emit(a, b, c);
        };
        if (whole && j == 0) {
            emit_known({0, 0}, {size, 0}, {size, size});
            emit_known({0, 0}, {size, size}, {0, size});
        }
        for (int x = 0; x < heights.width(); ++x) detail::triangles_at(needed, x, static_cast<int>(j), emit_known);
    };

    // Number the vertices and count the triangles of each row, then write them.
    image<std::uint32_t> number(heights.width(), heights.height());
    std::vector<std::size_t> first_triangle(rows + 1, 0), first_vertex(rows + 1, 0);
    ex.bulk(rows, [&](std::size_t j) {
        const auto numbers = number.row(static_cast<int>(j));
        std::uint32_t next = 0;
        for (std::size_t i = 0; i < columns; ++i)
            if (is_corner(i, j) || needed(static_cast<int>(i), static_cast<int>(j))) numbers[i] = next++;
        first_vertex[j + 1] = next;
        each_triangle(j, [&](auto&&...) { ++first_triangle[j + 1]; });
    });
    for (std::size_t j = 0; j < rows; ++j) {
        first_triangle[j + 1] += first_triangle[j];
        first_vertex[j + 1] += first_vertex[j];
    }

    adaptive_mesh result;
    result.shape.positions.resize(first_vertex.back());
    result.shape.normals.resize(first_vertex.back());
    result.shape.triangles.resize(first_triangle.back());
    result.vertices.resize(first_vertex.back());
    ex.bulk(rows, [&](std::size_t j) {
        const detail::row_rises rises(heights, static_cast<int>(j));
        std::size_t vertex = first_vertex[j];
        for (std::size_t i = 0; i < columns; ++i) {
            if (!is_corner(i, j) && !needed(static_cast<int>(i), static_cast<int>(j))) continue;
            result.shape.positions[vertex] = detail::position_at(field, i, j, first);
            result.shape.normals[vertex] = rises.normal(i, static_cast<float>(field.spacing));
            result.vertices[vertex++] = static_cast<std::uint32_t>(j * columns + i);
        }
        const auto index = [&](const glm::ivec2& p) {
            return static_cast<std::uint32_t>(first_vertex[static_cast<std::size_t>(p.y)]) + number(p.x, p.y);
        };
        glm::uvec3* next = result.shape.triangles.data() + first_triangle[j];
        each_triangle(j, [&](const glm::ivec2& a, const glm::ivec2& b, const glm::ivec2& c) {
            *next++ = {index(a), index(b), index(c)};
        });
    });
    return result;
}

}  // namespace INSONIFY_FLAGS

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
