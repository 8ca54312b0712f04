// Bounds on the horizon of a regular grid under parallel light: how high the surface towards the light rises over each
// cell.
//
// A point is in shadow if the surface nearer to the light, in the vertical plane of its ray, has a larger u
// (lit_grid.hpp) somewhere. Strips one row wide run along the light, so that no ray leaves its strip. Along each strip
// the kernel carries two bounds of the largest u on its rays: a lower one, the running maximum over columns of the
// smallest u around the strip, and an upper one, the running maximum of the largest. Points below the lower bound are
// dark, points above the upper bound lit; the few in between are left to an exact test.
//
// Where all triangles around a strip face the light, u increases along each ray, so that they cannot shade a later
// point of the same slope. Such columns are left out of the upper bound, or points on lit slopes would be undecided.
//
// Based on: Nelson L. Max. Horizon Mapping: Shadows for Bump-Mapped Surfaces. The Visual Computer 4,
// 1988
#pragma once

#include <insonify/core/simd/dispatch.hpp>
#include <insonify/core/simd/lanes.hpp>
#include <insonify/shadow/detail/lit_grid.hpp>
#include <insonify/shadow/policy.hpp>

#include <algorithm>
#include <limits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::detail::inline INSONIFY_FLAGS {

/// Bounds of the largest u that rays of a strip meet before a column.
struct horizon_bound {
    float dark_below;  ///< every ray of the strip meets a u of at least this
    float lit_above;   ///< points of the column with a larger u are lit; infinity where u does not increase
};

/// Computes the bounds of adjacent strips, column by column: adjacent strips read mostly the same u.
struct horizon_kernel {
    static constexpr int max_strips = 64;

    const lit_grid& grid;
    const grid_u& u;
    int first_row;      ///< of the first strip, in column 0
    int count, strips;  ///< strips of this call, and of the grid; both multiples of 16
    float margin;       ///< of u
    float* bounds;      ///< of the first strip; by column: the lower bound of each strip, then the upper ones

    template <int N>
    INSONIFY_INLINE void run() const {
        bounds_so_far now;
        const auto slope = static_cast<float>(grid.slope);
        float copies[2][static_cast<unsigned>(room)];
        std::int32_t is_facing[static_cast<unsigned>(room)];
        for (int x = 0; x < grid.columns; ++x) {
            // The strips' first row where they cross the column: `row` to `row + 3` surround the first strip up to the
            // next column.
            const int row = first_row + static_cast<int>(grid.slope * x);
            float* const of_column = bounds + static_cast<std::ptrdiff_t>(x) * 2 * strips;
            if (row + count + 3 < 0 || row >= grid.rows) {
                std::copy_n(now.dark_below, count, of_column);
                std::copy_n(now.lit_above, count, of_column + strips);
                continue;
            }
            const float* const here = u_from(x, row, copies[0]);
            const float* const ahead = u_from(x + 1, row, copies[1]);
            for (int k = 0; k < count + 2; k += N) find_facing<N>(is_facing + k, here + k, ahead + k, slope);
            for (int k = 0; k < count; k += N) advance<N>(now, k, here + k, ahead + k, is_facing + k, of_column + k);
        }
    }

  private:
    static constexpr int room = max_strips + 2 * 16;  ///< rows around the strips, in whole vectors

    struct bounds_so_far {
        float dark_below[static_cast<unsigned>(max_strips)], lit_above[static_cast<unsigned>(max_strips)];

        bounds_so_far() {
            std::fill_n(dark_below, max_strips, grid_u::nothing);
            std::fill_n(lit_above, max_strips, grid_u::nothing);
        }
    };

    /// The u of a column from a row on; copied and padded where it reaches past either end of the column.
    const float* u_from(int x, int row, float* copy) const {
        const bool exists = x < grid.columns;
        if (exists && row >= -grid_u::around && row + room <= grid.rows + grid_u::around) return u.column(x) + row;
        std::fill_n(copy, room, grid_u::nothing);
        const int first = (std::max)(row, 0), last = (std::min)(row + room, grid.rows);
        if (exists && first < last) std::copy_n(u.column(x) + first, last - first, copy + (first - row));
        return copy;
    }

    /// Sets masks of the cells between two columns that face the light (u increases along the rays) or lie outside of
    /// the grid.
    template <int N>
    INSONIFY_INLINE void find_facing(std::int32_t* into, const float* here, const float* ahead, float slope) const {
        using namespace insonify::detail;
        using ints = lanes<std::int32_t, N>;
        lanes<float, N> a, b, c, d, lower, upper;  // (0,0) (1,0) (0,1) (1,1)
        load(a, here), load(b, ahead), load(c, here + 1), load(d, ahead + 1);
        if (grid.is_rising) {
            lower = (b - a) + slope * (d - b);
            upper = (d - c) + slope * (c - a);
        } else {
            lower = (b - a) + slope * (c - a);
            upper = (d - c) + slope * (d - b);
        }
        // Cells outside of the grid do not shade.
        const ints is_cell = ints(a > grid_u::nothing) & ints(b > grid_u::nothing) & ints(c > grid_u::nothing) &
                             ints(d > grid_u::nothing);
        const ints up = ints(lower > margin) & ints(upper > margin);
        store(into, ints(up | ints(is_cell == 0)));
    }

    /// Takes N strips from one column to the next.
    /// @param of_column  where their bounds go
    template <int N>
    INSONIFY_INLINE void advance(bounds_so_far& now, int k, const float* here, const float* ahead,
                                 const std::int32_t* facing_of, float* of_column) const {
        using namespace insonify::detail;
        using floats = lanes<float, N>;
        using ints = lanes<std::int32_t, N>;
        floats dark_below, lit_above, smallest, largest, next;
        ints is_facing;
        load(dark_below, now.dark_below + k), load(lit_above, now.lit_above + k);
        load(smallest, here), load(is_facing, facing_of);
        largest = smallest;
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA {
            floats other;
            load(other, here + i + 1);
            if (i < 2) smallest = other < smallest ? other : smallest;
            largest = other > largest ? other : largest;
        });
        unroll<2>([&](int i) INSONIFY_INLINE_LAMBDA {
            ints other;
            load(other, facing_of + i + 1);
            is_facing = is_facing & other;
        });
        // Every ray of the strip meets the column between rows `row` and `row + 2`.
        dark_below = smallest > dark_below ? smallest : dark_below;
        // Where u does not increase, these cells may shade points in them and after, on the next column too.
        next = largest;
        unroll<4>([&](int i) INSONIFY_INLINE_LAMBDA {
            floats other;
            load(other, ahead + i);
            next = other > next ? other : next;
        });
        lit_above = is_facing ? lit_above : floats(next > lit_above ? next : lit_above);
        const floats stored = is_facing ? lit_above : floats{} + std::numeric_limits<float>::infinity();
        store(of_column, dark_below);
        store(of_column + strips, stored);
        store(now.dark_below + k, dark_below), store(now.lit_above + k, lit_above);
    }
};

/// Decides points on a heightfield: lit, dark, or left to an exact test.
class horizon_bounds {
  public:
    /// @param m       the mesh, on the lattice
    /// @param box     around it
    /// @param travel  direction in which light travels, in the mesh's frame; downwards
    template <executor E>
    horizon_bounds(const mesh_view& m, const bounding_box& box, const regular_grid& lattice, const glm::dvec3& travel,
                   isa level, E& ex)
        : grid_(lattice, travel),
          u_(m, box, grid_, ex),
          lattice_margin_(2 * lattice.lattice_error + 0x1p-30 * (std::max)(grid_.columns, grid_.rows)) {
        const double relief = grid_.u_per_metre * (u_.highest_z - u_.lowest_z);
        const double size =
            grid_.columns + grid_.u_per_metre * (std::max)(numeric::abs(u_.highest_z), numeric::abs(u_.lowest_z));
        margin_ = 0x1p-21 * size + 4 * lattice.lattice_error * (2 + relief);
        first_strip_ = -static_cast<int>(grid_.slope * grid_.columns) - 2;
        strips_ = (grid_.rows - first_strip_ + 1 + 15) / 16 * 16;
        bounds_ = insonify::detail::uninitialized_array<float>(
            2 * static_cast<std::size_t>(grid_.columns) * static_cast<std::size_t>(strips_),
            insonify::detail::memory_of(ex));
        bulk_ranges(
            ex, static_cast<std::size_t>(strips_), horizon_kernel::max_strips, [&](std::size_t from, std::size_t to) {
                insonify::detail::dispatch(
                    horizon_kernel{grid_, u_, first_strip_ + static_cast<int>(from), static_cast<int>(to - from),
                                   strips_, static_cast<float>(margin_), bounds_.data() + from},
                    level);
            });
    }

    /// Decides N points.
    /// @param p  x, y and z: on the mesh, on a side that faces the light, in the mesh's frame
    template <int N>
    INSONIFY_INLINE void decide(insonify::detail::lanes<std::int64_t, N>& result,
                                const insonify::detail::lanes<double, N> (&p)[3]) const {
        using namespace insonify::detail;
        using reals = lanes<double, N>;
        using bits = lanes<std::int64_t, N>;
        const plane_axes& axes = grid_.steps;
        const reals dx = p[0] - axes.origin.x, dy = p[1] - axes.origin.y;
        const reals x = axes.x_of.x * dx + axes.x_of.y * dy;
        const reals strip = axes.y_of.x * dx + axes.y_of.y * dy - grid_.slope * x - static_cast<double>(first_strip_);
        const bits exists = bits(x >= 0.0) & bits(x <= static_cast<double>(grid_.columns - 1)) &
                            bits(strip >= lattice_margin_) & bits(strip < strips_ - lattice_margin_);
        const reals u = x + grid_.u_per_metre * p[2];
        // A point close to a line of the lattice may lie in a cell beyond it.
        const reals column = exists ? x : reals{}, ahead = exists ? x + lattice_margin_ : reals{};
        const reals low = exists ? strip - lattice_margin_ : reals{}, high = exists ? strip + lattice_margin_ : reals{};
        const auto bound_at = [&](const reals& at, int k) {
            return bound(static_cast<int>(lane(at, k)), static_cast<int>(lane(low, k)),
                         static_cast<int>(lane(high, k)));
        };
        reals dark, lit;
        gather<N>(dark, [&](int k) { return static_cast<double>(bound_at(column, k).dark_below); });
        gather<N>(lit, [&](int k) { return static_cast<double>(bound_at(ahead, k).lit_above); });
        const bits is_dark = exists & bits(u < dark - margin_), is_lit = exists & bits(u > lit + margin_);
        result = is_lit ? bits{} + static_cast<std::int64_t>(decision::lit)
                        : bits{} + static_cast<std::int64_t>(decision::undecided);
        result = is_dark ? bits{} + static_cast<std::int64_t>(decision::dark) : result;
    }
    /// The same for one point.
    decision at(const glm::dvec3& p) const {
        std::int64_t result;
        decide<1>(result, {p.x, p.y, p.z});
        return static_cast<decision>(result);
    }

    const lit_grid& grid() const { return grid_; }
    const grid_u& u() const { return u_; }
    /// Error bound of u, in columns.
    double margin() const { return margin_; }
    /// Bound of the distance of vertices from their lattice points, along the light or across, in steps, with a margin.
    double lattice_margin() const { return lattice_margin_; }
    bool has_strip(int strip) const { return strip >= 0 && strip < strips_; }
    /// Strip number `strip` of a column holds the points with floor(Y - slope X) = strip + first_strip().
    int first_strip() const { return first_strip_; }
    /// Bounds of one or two adjacent strips.
    INSONIFY_INLINE horizon_bound bound(int column, int strip, int next) const {
        const float *const dark = dark_below(column), *const lit = lit_above(column);
        return {(std::min)(dark[strip], dark[next]), (std::max)(lit[strip], lit[next])};
    }
    /// Bounds of a column, by strip.
    const float* dark_below(int column) const {
        return bounds_.data() + static_cast<std::ptrdiff_t>(column) * 2 * strips_;
    }
    const float* lit_above(int column) const { return dark_below(column) + strips_; }

  private:
    lit_grid grid_;
    grid_u u_;
    double lattice_margin_, margin_ = 0;
    int first_strip_ = 0, strips_ = 0;
    insonify::detail::uninitialized_array<float> bounds_;
};

}  // namespace shadow::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
