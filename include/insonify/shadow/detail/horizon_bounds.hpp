// Bounds on the horizon of a regular grid under parallel light: how high the surface towards the light rises over each
// cell.
//
// In grid steps, all points of a ray have the same u = X + drop z, the X at which the ray meets z = 0. A point is in
// shadow if the surface has a larger u somewhere on its ray towards the light. Strips one row wide run along the light,
// so that no ray leaves its strip. Along each strip the kernel carries two bounds: a lower bound of the largest u on
// every ray (the minimum over the vertices around the strip at each column), and an upper bound (the maximum). Points
// below the lower bound are dark, points above the upper bound lit; the few in between are left to an exact test.
//
// Where all triangles around a strip face the light, u increases along each ray, so that they cannot shade a later
// point of the same slope. Such columns are left out of the upper bound, or points on lit slopes would be undecided.
//
// Based on: Nelson L. Max. Horizon Mapping: Shadows for Bump-Mapped Surfaces. 1988
#pragma once

#include <insonify/core/detail/uninitialized.hpp>
#include <insonify/core/simd/dispatch.hpp>
#include <insonify/core/simd/lanes.hpp>
#include <insonify/geometry/regular_grid.hpp>
#include <insonify/geometry/transform.hpp>
#include <insonify/shadow/policy.hpp>

#include <algorithm>
#include <limits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::detail::inline INSONIFY_FLAGS {

/// A grid with axes along the light: X counts vertices along the axis closer to the light's direction, Y across it.
/// Light travels towards larger X and Y, by `slope` steps of Y per step of X.
struct lit_grid {
    int columns = 0, rows = 0;  ///< vertices along X, and along Y
    bool is_rising = true;      ///< cells are cut from (X, Y) to (X + 1, Y + 1), or else from (X, Y + 1) to (X + 1, Y)
    double slope = 0;           ///< in [0, 1]
    double drop = 0;            ///< columns that light crosses per metre of descent
    std::ptrdiff_t first = 0, along = 1, across = 1;  ///< index of vertex (0, 0) in the mesh, and strides
    std::ptrdiff_t pitch = 1;                         ///< vertices from one row of the mesh to the next
    std::ptrdiff_t first_cell = 0, cell_along = 1, cell_across = 1;  ///< the same for cells
    glm::dvec2 x_of, y_of;  ///< X = dot(x_of, p - origin), Y alike, in the mesh's frame
    glm::dvec2 origin{0};

    lit_grid() = default;
    /// @param travel  direction in which light travels, in the mesh's frame; downwards
    lit_grid(const regular_grid& grid, const glm::dvec3& travel)
        : columns(grid.columns),
          rows(grid.rows),
          is_rising(grid.is_rising),
          across(grid.columns),
          pitch(grid.columns),
          origin(grid.origin) {
        glm::dvec2 x = grid.right, y = grid.up;
        const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
        double travel_x = cross(glm::dvec2(travel), y) / cross(x, y),
               travel_y = cross(x, glm::dvec2(travel)) / cross(x, y);
        if (numeric::abs(travel_y) > numeric::abs(travel_x)) {
            std::swap(columns, rows);
            std::swap(along, across);
            std::swap(x, y);
            std::swap(travel_x, travel_y);
        }
        const auto turn = [&](double& steps, int count, std::ptrdiff_t& stride, glm::dvec2& axis) {
            if (steps >= 0) return;
            steps = -steps;
            first += (count - 1) * stride;
            origin += static_cast<double>(count - 1) * axis;
            stride = -stride;
            axis = -axis;
            is_rising = !is_rising;
        };
        turn(travel_x, columns, along, x);
        turn(travel_y, rows, across, y);
        slope = travel_x > 0 ? travel_y / travel_x : 0;
        drop = travel_x / -travel.z;
        x_of = glm::dvec2(y.y, -y.x) / cross(x, y);
        y_of = glm::dvec2(-x.y, x.x) / cross(x, y);
        // A row has one cell less than vertices.
        const auto cell_steps = [&](std::ptrdiff_t vertices) { return vertices - vertices / pitch; };
        first_cell = cell_steps(corner(0, 0));
        cell_along = cell_steps(along);
        cell_across = cell_steps(across);
    }
    /// (X, Y) of a position in the mesh's frame.
    INSONIFY_INLINE glm::dvec2 steps(const glm::dvec2& p) const {
        const double dx = p.x - origin.x, dy = p.y - origin.y;
        return {x_of.x * dx + x_of.y * dy, y_of.x * dx + y_of.y * dy};
    }
    /// The vertex of a cell with the lowest number.
    INSONIFY_INLINE std::ptrdiff_t corner(int x, int y) const {
        return first + (x + (along < 0 ? 1 : 0)) * along + (y + (across < 0 ? 1 : 0)) * across;
    }
    /// The first triangle of a cell; the other follows.
    INSONIFY_INLINE std::size_t first_triangle(int x, int y) const {
        return static_cast<std::size_t>(2 * (first_cell + x * cell_along + y * cell_across));
    }
};

/// u of a grid's vertices, column by column, padded with minus infinity.
struct grid_heights {
    static constexpr float nothing = -std::numeric_limits<float>::infinity();
    static constexpr int around = 4;  ///< rows of padding on either side

    int pitch = 0;
    insonify::detail::uninitialized_vector<float> u;
    float least = 0, greatest = 0;  ///< z

    template <executor E>
    grid_heights(const mesh_view& m, const lit_grid& grid, E& ex)
        : pitch(grid.rows + 2 * around),
          u(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(pitch), insonify::detail::memory_of(ex)) {
        // In square blocks, so that both reads and writes are contiguous.
        constexpr int square = 32;
        const auto drop = static_cast<float>(grid.drop);
        const auto runs = static_cast<std::size_t>((grid.columns + square - 1) / square);
        std::vector<glm::vec2> ranges(runs);
        bulk_ranges(ex, static_cast<std::size_t>(grid.columns), square, [&](std::size_t from, std::size_t to) {
            const auto left = static_cast<int>(from), right = static_cast<int>(to);
            float low = std::numeric_limits<float>::infinity(), high = -low;
            for (int x = left; x < right; ++x) {
                std::fill_n(column(x) - around, around, nothing);
                std::fill_n(column(x) + grid.rows, around, nothing);
            }
            const auto note = [&](int x, int y, float z) {
                low = (std::min)(low, z);
                high = (std::max)(high, z);
                column(x)[y] = static_cast<float>(x) + drop * z;
            };
            const glm::vec3* const first = m.positions.data() + grid.first;
            for (int bottom = 0; bottom < grid.rows; bottom += square) {
                const int top = (std::min)(bottom + square, grid.rows);
                // Along the mesh's own rows.
                if (grid.across == 1 || grid.across == -1) {
                    for (int x = left; x < right; ++x)
                        for (int y = bottom; y < top; ++y) note(x, y, first[x * grid.along + y * grid.across].z);
                } else {
                    for (int y = bottom; y < top; ++y)
                        for (int x = left; x < right; ++x) note(x, y, first[x * grid.along + y * grid.across].z);
                }
            }
            ranges[from / square] = {low, high};
        });
        least = ranges.front().x, greatest = ranges.front().y;
        for (const glm::vec2& r : ranges) {
            least = (std::min)(least, r.x);
            greatest = (std::max)(greatest, r.y);
        }
    }
    const float* column(int x) const { return u.data() + static_cast<std::ptrdiff_t>(x) * pitch + around; }
    float* column(int x) { return u.data() + static_cast<std::ptrdiff_t>(x) * pitch + around; }
};

/// Bounds of the largest u that rays of a strip meet before a column.
struct horizon_bound {
    float met;       ///< at least
    float may_meet;  ///< at most
};

/// Computes the bounds of some strips.
struct horizon_kernel {
    const lit_grid& grid;
    const grid_heights& heights;
    int first_strip;       ///< strips count from this
    int from, to, strips;  ///< these, of so many
    float margin;          ///< of u
    float* bounds;         ///< by column: what each strip's rays met, then what they may meet

    template <int N>
    INSONIFY_INLINE void run() const {
        for (int k = from; k < to; k += N) sweep<N>(k);
    }

  private:
    template <int N>
    INSONIFY_INLINE void sweep(int k) const {
        using namespace insonify::detail;
        using floats = lanes<float, N>;
        using ints = lanes<std::int32_t, N>;
        const auto slope = static_cast<float>(grid.slope);
        floats met = floats{} + grid_heights::nothing, may_meet = met;
        ints was_rising = ints{} - 1;
        for (int x = 0; x < grid.columns; ++x) {
            // The strip's rows where it crosses the column, and up to the next one: `row` to `row + 3` surround it.
            const int row = first_strip + k + static_cast<int>(grid.slope * x);
            floats here[4] = {}, ahead[4] = {};
            read<N>(here, x, row);
            if (x + 1 < grid.columns)
                read<N>(ahead, x + 1, row);
            else
                for (floats& value : ahead) value = floats{} + grid_heights::nothing;
            floats lowest = here[0], highest = here[0];
            unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA {
                if (i < 2) lowest = here[i + 1] < lowest ? here[i + 1] : lowest;
                highest = here[i + 1] > highest ? here[i + 1] : highest;
            });
            // Every ray of the strip meets the column between rows `row` and `row + 2`.
            met = lowest > met ? lowest : met;
            // The columns before count unless u increases all along them.
            may_meet = was_rising ? may_meet : floats(highest > may_meet ? highest : may_meet);
            ints rises = ints{} - 1;
            unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA {
                const floats &a = here[i], &b = ahead[i], &c = here[i + 1],
                             &d = ahead[i + 1];  // (0,0) (1,0) (0,1) (1,1)
                floats lower, upper;
                if (grid.is_rising) {
                    lower = (b - a) + slope * (d - b);
                    upper = (d - c) + slope * (c - a);
                } else {
                    lower = (b - a) + slope * (c - a);
                    upper = (d - c) + slope * (d - b);
                }
                // Cells outside of the grid do not shade.
                const ints is_cell = ints(a > grid_heights::nothing) & ints(b > grid_heights::nothing) &
                                     ints(c > grid_heights::nothing) & ints(d > grid_heights::nothing);
                const ints up = ints(lower > margin) & ints(upper > margin);
                rises = rises & ints(up | ints(is_cell == 0));
            });
            // Where u does not increase, these cells may shade points in them and after.
            floats next = highest;
            unroll<4>([&](int i) INSONIFY_INLINE_LAMBDA { next = ahead[i] > next ? ahead[i] : next; });
            may_meet = rises ? may_meet : floats(next > may_meet ? next : may_meet);
            floats stored = rises ? may_meet : floats{} + std::numeric_limits<float>::infinity();
            float* const of_column = bounds + static_cast<std::ptrdiff_t>(x) * 2 * strips + k;
            store(of_column, met);
            store(of_column + strips, stored);
            was_rising = rises;
        }
    }
    template <int N>
    INSONIFY_INLINE void read(insonify::detail::lanes<float, N> (&into)[4], int x, int row) const {
        using namespace insonify::detail;
        // Strips beside the grid read the padding value.
        const float* const column = heights.column(x);
        const int low = -grid_heights::around, high = grid.rows + grid_heights::around - 4;
        unroll<4>([&](int i) INSONIFY_INLINE_LAMBDA {
            if (row + i >= low && row + i + N <= high + 4)
                load(into[i], column + row + i);
            else
                gather<N>(into[i], [&](int lane) {
                    const int at = row + i + lane;
                    return at >= 0 && at < grid.rows ? column[at] : grid_heights::nothing;
                });
        });
    }
};

/// Decides points on a heightfield: lit, dark, or left to an exact test.
class horizon_bounds {
  public:
    /// @param m       the mesh, on the lattice
    /// @param travel  direction in which light travels, in the mesh's frame; downwards
    template <executor E>
    horizon_bounds(const mesh_view& m, const regular_grid& lattice, const glm::dvec3& travel, isa level, E& ex)
        : grid_(lattice, travel), heights_(m, grid_, ex), off_(lattice.off) {
        const auto greatest = static_cast<double>(heights_.greatest), least = static_cast<double>(heights_.least);
        const double relief = grid_.drop * (greatest - least);
        const double size = grid_.columns + grid_.drop * (std::max)(numeric::abs(greatest), numeric::abs(least));
        margin_ = 0x1p-21 * size + 4 * off_ * (2 + relief);
        first_strip_ = -static_cast<int>(grid_.slope * grid_.columns) - 2;
        strips_ = (grid_.rows - first_strip_ + 1 + 15) / 16 * 16;
        bounds_ = insonify::detail::uninitialized_vector<float>(
            2 * static_cast<std::size_t>(grid_.columns) * static_cast<std::size_t>(strips_),
            insonify::detail::memory_of(ex));
        bulk_ranges(ex, static_cast<std::size_t>(strips_), 64, [&](std::size_t from, std::size_t to) {
            insonify::detail::dispatch(
                horizon_kernel{grid_, heights_, first_strip_, static_cast<int>(from), static_cast<int>(to), strips_,
                               static_cast<float>(margin_), bounds_.data()},
                level);
        });
    }

    /// @param p  on the mesh, on a side that faces the light, in the mesh's frame
    INSONIFY_INLINE known at(const glm::dvec3& p) const {
        const glm::dvec2 at = grid_.steps(glm::dvec2(p));
        const double x = at.x, y = at.y;
        if (!(x >= 0 && x <= grid_.columns - 1)) return known::nothing;
        const auto column = static_cast<int>(x);
        const int strip = static_cast<int>(y - grid_.slope * x - first_strip_);
        if (!has_strip(strip)) return known::nothing;
        const horizon_bound b = bound(column, strip);
        const double u = x + grid_.drop * p.z;
        if (u < static_cast<double>(b.met) - margin_) return known::dark;
        return u > static_cast<double>(b.may_meet) + margin_ ? known::lit : known::nothing;
    }

    const lit_grid& grid() const { return grid_; }
    const grid_heights& heights() const { return heights_; }
    /// Error bound of u, in columns.
    double margin() const { return margin_; }
    /// Distance bound of vertices from the lattice, in steps.
    double off() const { return off_; }
    bool has_strip(int strip) const { return strip >= 0 && strip < strips_; }
    /// Strip number `strip` of a column holds the points with floor(Y - slope X) = strip + first_strip().
    int first_strip() const { return first_strip_; }
    horizon_bound bound(int column, int strip) const { return {met(column)[strip], may_meet(column)[strip]}; }
    /// Bounds of a column, by strip.
    const float* met(int column) const { return bounds_.data() + static_cast<std::ptrdiff_t>(column) * 2 * strips_; }
    const float* may_meet(int column) const { return met(column) + strips_; }

  private:
    lit_grid grid_;
    grid_heights heights_;
    double off_, margin_ = 0;
    int first_strip_ = 0, strips_ = 0;
    insonify::detail::uninitialized_vector<float> bounds_;
};

}  // namespace shadow::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
