// Bounds on the horizon of a regular grid under parallel light: how high the surface towards the light rises over each
// cell.
//
// A point is in shadow if the surface has a larger u (lit_grid.hpp) somewhere on its ray towards the light. Strips one
// row wide run along the light, so that no ray leaves its strip. Along each strip the kernel carries two bounds: a
// lower bound of the largest u on every ray (the minimum over the vertices around the strip at each column), and an
// upper bound (the maximum). Points below the lower bound are dark, points above the upper bound lit; the few in
// between are left to an exact test.
//
// Where all triangles around a strip face the light, u increases along each ray, so that they cannot shade a later
// point of the same slope. Such columns are left out of the upper bound, or points on lit slopes would be undecided.
//
// Based on: Nelson L. Max. Horizon Mapping: Shadows for Bump-Mapped Surfaces. 1988
#pragma once

#include <insonify/core/simd/dispatch.hpp>
#include <insonify/core/simd/lanes.hpp>
#include <insonify/geometry/transform.hpp>
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
    float lit_above;   ///< no ray of the strip meets a u above this
};

/// Computes the bounds of some strips.
struct horizon_kernel {
    const lit_grid& grid;
    const grid_heights& heights;
    int first_strip;       ///< strips count from this
    int from, to, strips;  ///< these, of so many
    float margin;          ///< of u
    float* bounds;         ///< by column: the lower bound of each strip, then the upper ones

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
        floats dark_below = floats{} + grid_heights::nothing, lit_above = dark_below;
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
            dark_below = lowest > dark_below ? lowest : dark_below;
            // The columns before count unless u increases all along them.
            lit_above = was_rising ? lit_above : floats(highest > lit_above ? highest : lit_above);
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
            lit_above = rises ? lit_above : floats(next > lit_above ? next : lit_above);
            floats stored = rises ? lit_above : floats{} + std::numeric_limits<float>::infinity();
            float* const of_column = bounds + static_cast<std::ptrdiff_t>(x) * 2 * strips + k;
            store(of_column, dark_below);
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
        bounds_ = insonify::detail::uninitialized_array<float>(
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
        if (u < static_cast<double>(b.dark_below) - margin_) return known::dark;
        return u > static_cast<double>(b.lit_above) + margin_ ? known::lit : known::nothing;
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
    horizon_bound bound(int column, int strip) const { return {dark_below(column)[strip], lit_above(column)[strip]}; }
    /// Bounds of a column, by strip.
    const float* dark_below(int column) const {
        return bounds_.data() + static_cast<std::ptrdiff_t>(column) * 2 * strips_;
    }
    const float* lit_above(int column) const { return dark_below(column) + strips_; }

  private:
    lit_grid grid_;
    grid_heights heights_;
    double off_, margin_ = 0;
    int first_strip_ = 0, strips_ = 0;
    insonify::detail::uninitialized_array<float> bounds_;
};

}  // namespace shadow::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
