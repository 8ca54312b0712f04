// Detects meshes that are a heightfield over a regular grid, as seabeds mostly are. The mesh itself is inspected, so
// that callers need no flag and a wrong flag cannot change a result.
#pragma once

#include <insonify/geometry/mesh.hpp>

#if INSONIFY_BODIES
#include <insonify/core/linear.hpp>

#include <algorithm>
#include <cstddef>
#endif
#include <optional>

#include <glm/vec2.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Vertex (i, j) is number j columns + i and lies at origin + i right + j up in x and y, at any height; rows may go
/// down from the top, as those of pictures, `up` being to the right of `right`. Each cell is cut into two triangles the
/// same way; all of them are counter-clockwise seen from +z.
struct regular_grid {
    int columns = 0, rows = 0;              ///< vertices
    glm::dvec2 origin{0}, right{0}, up{0};  ///< metres, in the mesh's frame
    /// Cells are cut from vertex (i, j) to (i + 1, j + 1), or else from (i + 1, j) to (i, j + 1).
    bool is_rising = true;
    double lattice_error = 0x1p-12;  ///< bound of the distance of vertices from the lattice, in steps
};

#if INSONIFY_BODIES
namespace detail::inline INSONIFY_FLAGS {

/// The number of columns of a grid and the diagonal of its cells, from the mesh's first two triangles.
struct cell_cut {
    std::uint32_t columns;
    bool is_rising;
    bool is_mirrored;  ///< triangles are counter-clockwise if `up` is to the right of `right`

    static std::optional<cell_cut> of(const glm::uvec3 (&cell)[2]) {
        std::uint32_t opposite = 0;
        for (const glm::uvec3& t : cell) opposite = (std::max)({opposite, t.x, t.y, t.z});
        if (opposite < 3) return std::nullopt;
        const std::uint32_t columns = opposite - 1,
                            around[2][4] = {{0, 1, opposite, columns}, {0, columns, opposite, 1}};
        for (const bool is_mirrored : {false, true})
            if (const auto left_out = missing_corner(cell, around[is_mirrored]))
                return cell_cut{columns, *left_out % 2 == 1, is_mirrored};
        return std::nullopt;
    }

  private:
    /// The corner of the cell that the first triangle omits, if the second omits the opposite one.
    static std::optional<int> missing_corner(const glm::uvec3 (&cell)[2], const std::uint32_t (&around)[4]) {
        int left_out[2];
        for (int i = 0; i < 2; ++i) {
            left_out[i] = -1;
            for (int skipped = 0; skipped < 4; ++skipped)
                for (int turn = 0; turn < 3; ++turn) {
                    const auto corner = [&](int k) { return around[(skipped + 1 + (k + turn) % 3) % 4]; };
                    if (cell[i] == glm::uvec3(corner(0), corner(1), corner(2))) left_out[i] = skipped;
                }
            if (left_out[i] < 0) return std::nullopt;
        }
        if ((left_out[0] + 2) % 4 != left_out[1]) return std::nullopt;
        return left_out[0];
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
#endif

inline namespace INSONIFY_ONCE {

/// The regular grid of a mesh's vertices; none if they are not on one, a height is not finite, or the triangles are not
/// those of its cells row by row.
/// @param tolerance  distance from the lattice up to which vertices are accepted, in steps; the `lattice_error` of the
///                   result bounds the actual distance
INSONIFY_FUNCTION std::optional<regular_grid> regular_grid_of(const mesh_view& m, double tolerance = 1.0 / 256);

#if INSONIFY_BODIES
INSONIFY_FUNCTION std::optional<regular_grid> regular_grid_of(const mesh_view& m, double tolerance) {
    if (m.triangles.size() < 2) return std::nullopt;
    const glm::uvec3 cell[2] = {m.triangles[0], m.triangles[1]};
    const auto cut = detail::cell_cut::of(cell);
    if (!cut) return std::nullopt;
    const std::size_t columns = cut->columns, rows = m.positions.size() / columns;
    if (rows < 2 || columns > 1 << 20 || rows > 1 << 20 || rows * columns != m.positions.size() ||
        m.triangles.size() != 2 * (columns - 1) * (rows - 1))
        return std::nullopt;

    const auto place = [&](std::size_t i) { return glm::dvec2(m.positions[i].x, m.positions[i].y); };
    const glm::dvec2 origin = place(0), right = (place(columns - 1) - origin) / static_cast<double>(columns - 1),
                     up = (place((rows - 1) * columns) - origin) / static_cast<double>(rows - 1);
    const double area = numeric::cross(right, up);
    if (!(cut->is_mirrored ? area < 0 : area > 0)) return std::nullopt;  // written so that NaN doesn't pass
    // Metres between the lines of the lattice. Of an oblique one this is less than the length of a step.
    const double step =
        numeric::abs(area) / numeric::square_root((std::max)(numeric::dot(right, right), numeric::dot(up, up)));
    const double farthest_accepted = step * tolerance * (step * tolerance);

    double farthest = 0;  // squared
    for (std::size_t j = 0; j < rows; ++j) {
        const glm::dvec2 start = origin + static_cast<double>(j) * up;
        for (std::size_t i = 0; i < columns; ++i) {
            const std::size_t vertex = j * columns + i;
            const glm::dvec2 off = place(vertex) - (start + static_cast<double>(i) * right);
            const double squared = numeric::dot(off, off);
            farthest = (std::max)(farthest, squared);
            // Written so that NaN doesn't pass.
            if (!(squared <= farthest_accepted && numeric::is_finite(m.positions[vertex].z))) return std::nullopt;
        }
        if (j + 1 == rows) break;
        for (std::size_t i = 0; i + 1 < columns; ++i) {
            const glm::uvec3* const found = &m.triangles[2 * (j * (columns - 1) + i)];
            const auto corner = static_cast<std::uint32_t>(j * columns + i);
            if (found[0] != cell[0] + corner || found[1] != cell[1] + corner) return std::nullopt;
        }
    }
    return regular_grid{static_cast<int>(columns),
                        static_cast<int>(rows),
                        origin,
                        right,
                        up,
                        cut->is_rising,
                        numeric::square_root(farthest) / step};
}
#endif

}  // namespace INSONIFY_ONCE

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
