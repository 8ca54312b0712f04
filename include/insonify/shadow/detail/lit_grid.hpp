// A regular grid re-indexed so that parallel light crosses its columns in ascending order, and the u of its vertices.
//
// In grid steps, all points of a ray have the same u = X + u_per_metre z, the X at which the ray meets z = 0.
#pragma once

#include <insonify/core/detail/uninitialized.hpp>
#include <insonify/core/executor.hpp>
#include <insonify/core/linear.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/geometry/bounds.hpp>
#include <insonify/geometry/mesh.hpp>
#include <insonify/geometry/regular_grid.hpp>

#include <algorithm>
#include <limits>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::detail::inline INSONIFY_FLAGS {

/// Coordinates of a point of a plane along two axes.
struct plane_axes {
    glm::dvec2 origin{0};
    glm::dvec2 x_of{0}, y_of{0};  ///< the first coordinate is dot(x_of, p - origin), the second alike

    plane_axes() = default;
    /// @param x, y  the axes; not parallel
    plane_axes(const glm::dvec2& start, const glm::dvec2& x, const glm::dvec2& y)
        : origin(start),
          x_of(glm::dvec2(y.y, -y.x) / numeric::cross(x, y)),
          y_of(glm::dvec2(-x.y, x.x) / numeric::cross(x, y)) {}

    INSONIFY_INLINE glm::dvec2 operator()(const glm::dvec2& p) const {
        const double dx = p.x - origin.x, dy = p.y - origin.y;
        return {x_of.x * dx + x_of.y * dy, y_of.x * dx + y_of.y * dy};
    }
};

/// A grid with axes along the light: X counts vertices along the axis closer to the light's direction, Y across it.
/// Light travels towards larger X and Y, by `slope` steps of Y per step of X.
struct lit_grid {
    int columns = 0, rows = 0;  ///< vertices along X, and along Y
    bool is_rising = true;      ///< cells are cut from (X, Y) to (X + 1, Y + 1), or else from (X, Y + 1) to (X + 1, Y)
    double slope = 0;           ///< in [0, 1]
    double u_per_metre = 0;     ///< increase of X along a ray per metre of descent
    std::ptrdiff_t first = 0, along = 1, across = 1;  ///< index of vertex (0, 0) in the mesh, and strides
    std::ptrdiff_t pitch = 1;                         ///< vertices from one row of the mesh to the next
    std::ptrdiff_t first_cell = 0, cell_along = 1, cell_across = 1;  ///< the same for cells
    plane_axes steps;                                                ///< (X, Y) of a position in the mesh's frame

    /// @param travel  direction in which light travels, in the mesh's frame; downwards
    lit_grid(const regular_grid& grid, const glm::dvec3& travel)
        : columns(grid.columns), rows(grid.rows), is_rising(grid.is_rising), across(grid.columns), pitch(grid.columns) {
        glm::dvec2 origin = grid.origin, x = grid.right, y = grid.up;
        double travel_x = numeric::cross(glm::dvec2(travel), y) / numeric::cross(x, y),
               travel_y = numeric::cross(x, glm::dvec2(travel)) / numeric::cross(x, y);
        if (numeric::abs(travel_y) > numeric::abs(travel_x)) {
            std::swap(columns, rows);
            std::swap(along, across);
            std::swap(x, y);
            std::swap(travel_x, travel_y);
        }
        const auto turn = [&](double& travelled, int count, std::ptrdiff_t& stride, glm::dvec2& axis) {
            if (travelled >= 0) return;
            travelled = -travelled;
            first += (count - 1) * stride;
            origin += static_cast<double>(count - 1) * axis;
            stride = -stride;
            axis = -axis;
            is_rising = !is_rising;
        };
        turn(travel_x, columns, along, x);
        turn(travel_y, rows, across, y);
        slope = travel_x > 0 ? travel_y / travel_x : 0;
        u_per_metre = travel_x / -travel.z;
        steps = {origin, x, y};
        // A row has one cell fewer than it has vertices.
        const auto cell_steps = [&](std::ptrdiff_t vertices) { return vertices - vertices / pitch; };
        first_cell = cell_steps(corner(0, 0));
        cell_along = cell_steps(along);
        cell_across = cell_steps(across);
    }
    /// Index of the lowest-numbered vertex of a cell.
    INSONIFY_INLINE std::ptrdiff_t corner(int x, int y) const {
        return first + (x + (along < 0 ? 1 : 0)) * along + (y + (across < 0 ? 1 : 0)) * across;
    }
    /// The first triangle of a cell; the other follows.
    INSONIFY_INLINE std::size_t first_triangle(int x, int y) const {
        return static_cast<std::size_t>(2 * (first_cell + x * cell_along + y * cell_across));
    }
};

/// u of a grid's vertices, column by column, padded with minus infinity.
struct grid_u {
    static constexpr float nothing = -std::numeric_limits<float>::infinity();
    static constexpr int around = 4;  ///< rows of padding on either side

    int pitch = 0;
    insonify::detail::uninitialized_array<float> values;
    double lowest_z = 0, highest_z = 0;  ///< bounds of the vertices

    template <executor E>
    grid_u(const mesh_view& m, const bounding_box& bounds, const lit_grid& grid, E& ex)
        : pitch(grid.rows + 2 * around),
          values(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(pitch),
                 insonify::detail::memory_of(ex)),
          lowest_z(bounds.lower.z),
          highest_z(bounds.upper.z) {
        // In squares of vertices, so that both reads and writes are contiguous.
        constexpr int square = 64;
        const auto u_per_metre = static_cast<float>(grid.u_per_metre);
        bulk_ranges(ex, static_cast<std::size_t>(grid.columns), square, [&](std::size_t from, std::size_t to) {
            const auto left = static_cast<int>(from), right = static_cast<int>(to);
            for (int x = left; x < right; ++x) {
                std::fill_n(column(x) - around, around, nothing);
                std::fill_n(column(x) + grid.rows, around, nothing);
            }
            const glm::vec3* const first = m.positions.data() + grid.first;
            const auto set = [&](int x, int y) {
                column(x)[y] = static_cast<float>(x) + u_per_metre * first[x * grid.along + y * grid.across].z;
            };
            for (int bottom = 0; bottom < grid.rows; bottom += square) {
                const int top = (std::min)(bottom + square, grid.rows);
                // Along the mesh's own rows.
                if (grid.across == 1 || grid.across == -1) {
                    for (int x = left; x < right; ++x)
                        for (int y = bottom; y < top; ++y) set(x, y);
                } else {
                    for (int y = bottom; y < top; ++y)
                        for (int x = left; x < right; ++x) set(x, y);
                }
            }
        });
    }
    const float* column(int x) const { return values.data() + static_cast<std::ptrdiff_t>(x) * pitch + around; }
    float* column(int x) { return values.data() + static_cast<std::ptrdiff_t>(x) * pitch + around; }
};

}  // namespace shadow::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
