// Shadow test of one point against a heightfield on a regular grid, by a walk along the point's ray towards the light.
//
// In grid steps a ray is a straight line across cells. The surface's u (horizon_bounds.hpp) is piecewise linear along
// it, with vertices at the edges that the line crosses, and the ray is blocked if u exceeds the point's u. The walk
// skips macrocells (4 x 4 cells) whose largest u is below it, and ends where the bounds of the horizon decide.
// Where u is within its error of the point's, the triangles of that column are tested in doubles.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/shadow/detail/horizon_bounds.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::detail::inline INSONIFY_FLAGS {

using insonify::detail::dynamic_array;

/// The largest u of macrocells: `side` x `side` cells each.
class macrocell_u {
  public:
    static constexpr int side = 4;  ///< cells

    template <executor E>
    macrocell_u(const lit_grid& grid, const grid_u& u, isa level, E& ex)
        : columns_((grid.columns - 2) / side + 1), rows_((grid.rows - 2) / side + 1) {
        largest_ = insonify::detail::uninitialized_array<float>(
            static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), insonify::detail::memory_of(ex));
        bulk_ranges(ex, static_cast<std::size_t>(columns_), 4, [&](std::size_t from, std::size_t to) {
            dynamic_array<float> row(static_cast<std::size_t>(grid.rows));
            for (auto column = static_cast<int>(from); column < static_cast<int>(to); ++column)
                insonify::detail::dispatch(kernel{grid, u, column * side, row.data(),
                                                  largest_.data() + static_cast<std::ptrdiff_t>(column) * rows_, rows_},
                                           level);
        });
    }

    /// The largest u of the vertices of the cells in a column of macrocells, between two rows of cells.
    float largest_u(int column, int first_row, int last_row) const {
        const float* const macrocells = largest_.data() + static_cast<std::ptrdiff_t>(column) * rows_;
        const int first = (std::max)(first_row / side, 0), last = (std::min)(last_row / side, rows_ - 1);
        float largest = grid_u::nothing;
        for (int i = first; i <= last; ++i) largest = (std::max)(largest, macrocells[i]);
        return largest;
    }

  private:
    /// One column of macrocells.
    struct kernel {
        const lit_grid& grid;
        const grid_u& u;
        int first;   ///< column of vertices
        float* row;  ///< room for the largest u of each row
        float* into;
        int macrocells;

        template <int N>
        INSONIFY_INLINE void run() const {
            const int last = (std::min)(first + side, grid.columns - 1);
            int y = 0;
            for (; y + N <= grid.rows; y += N) largest_of<N>(y, last);
            for (; y < grid.rows; ++y) largest_of<1>(y, last);
            for (int macrocell = 0; macrocell < macrocells; ++macrocell) {
                const int low = macrocell * side, high = (std::min)(low + side, grid.rows - 1);
                float largest = row[low];
                for (int i = low + 1; i <= high; ++i) largest = (std::max)(largest, row[i]);
                into[macrocell] = largest;
            }
        }
        template <int N>
        INSONIFY_INLINE void largest_of(int y, int last) const {
            using namespace insonify::detail;
            lanes<float, N> largest, other;
            load(largest, u.column(first) + y);
            for (int x = first + 1; x <= last; ++x) {
                load(other, u.column(x) + y);
                largest = other > largest ? other : largest;
            }
            store(row + y, largest);
        }
    };

    int columns_, rows_;
    insonify::detail::uninitialized_array<float> largest_;
};

/// The walk along one ray.
class horizon_walk {
  public:
    /// @param p  origin of the ray, in the mesh's frame
    horizon_walk(const horizon_bounds& horizon, const macrocell_u& macrocells, const glm::dvec3& p)
        : horizon_(horizon),
          macrocells_(macrocells),
          grid_(horizon.grid()),
          x_(grid_.steps(glm::dvec2(p)).x),
          w_(grid_.steps(glm::dvec2(p)).y - grid_.slope * x_),
          u_(x_ + grid_.u_per_metre * p.z),
          lattice_margin_(horizon.lattice_margin()) {}

    /// Whether the surface blocks the point's ray.
    /// @param is_lit_side  whether the point lies on the surface, where it faces the light
    /// @param decide       decide(triangle): test of a triangle in doubles; false for the triangle of the point
    template <class Decide>
    bool is_blocked(bool is_lit_side, const Decide& decide) const {
        // Whether the ray begins on or over the surface, so that it meets whatever rises above it.
        bool is_above = is_lit_side || lies_above();
        const double u_lower_bound = u_ - horizon_.margin();
        const double highest_z = horizon_.u().highest_z;
        if (!(x_ + lattice_margin_ >= 0)) return false;  // before the conversion: a vertex may lie 1e38 m away
        int column = static_cast<int>((std::min)(x_ + lattice_margin_, static_cast<double>(grid_.columns - 2)));
        for (bool is_first = true; column >= 0; --column, is_first = false) {
            // Rows of cells that the ray crosses in this column.
            const double low = row_at(column), high = low + grid_.slope;
            if (high < -lattice_margin_ || column + 1 + grid_.u_per_metre * highest_z < u_lower_bound) return false;
            if (!is_first && is_above) {
                const decision rest = decide_before(column);
                if (rest != decision::undecided) return rest == decision::dark;
            }
            if (!is_first && column % macrocell_u::side == macrocell_u::side - 1) {
                const int before = column - (macrocell_u::side - 1);
                const float largest_before =
                    macrocells_.largest_u(before / macrocell_u::side, clamped_row(row_at(before) - lattice_margin_),
                                          clamped_row(high + lattice_margin_));
                if (static_cast<double>(largest_before) < u_lower_bound) {
                    column = before;
                    continue;
                }
            }
            if (low > grid_.rows - 1 + lattice_margin_) continue;
            const int first_row = clamped_row(low - lattice_margin_), last_row = clamped_row(high + lattice_margin_);
            if (largest_u(column, first_row, last_row) < u_lower_bound) continue;
            const double limit = is_above ? x_ - column : 2;
            if (low >= lattice_margin_ && high <= grid_.rows - 1 - lattice_margin_) {
                const crossing crossed = cross(column, limit);
                if (crossed.largest < u_lower_bound) continue;
                if (is_above && crossed.certain > u_ + horizon_.margin()) return true;
                if (!is_above && crossed.smallest > u_ + horizon_.margin()) continue;
            } else {
                // Close to the border, whose vertices may lie off the lattice, the ray may leave the grid and enter
                // it again below the surface.
                is_above = false;
            }
            for (int row = first_row; row <= last_row; ++row) {
                const auto triangle = static_cast<std::uint32_t>(grid_.first_triangle(column, row));
                if (decide(triangle) || decide(triangle + 1)) return true;
            }
        }
        return false;
    }

  private:
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    /// u on the edges that the ray crosses in one column of cells.
    struct crossing {
        double smallest = infinity, largest = -infinity;
        double certain = -infinity;  ///< the largest u that certainly lies before the point
    };

    double row_at(double column) const { return w_ + grid_.slope * column; }
    int clamped_row(double y) const {
        return static_cast<int>((std::min)((std::max)(y, 0.0), static_cast<double>(grid_.rows - 2)));
    }

    /// Whether the point is above the surface by more than the error of u.
    bool lies_above() const {
        const double y = row_at(x_);
        if (!(x_ >= lattice_margin_ && x_ <= grid_.columns - 1 - lattice_margin_ && y >= lattice_margin_ &&
              y <= grid_.rows - 1 - lattice_margin_))
            return false;
        for (const double x : {x_ - lattice_margin_, x_ + lattice_margin_})
            for (int row = clamped_row(y - lattice_margin_); row <= clamped_row(y + lattice_margin_); ++row)
                if (!(largest_u((std::min)(static_cast<int>(x), grid_.columns - 2), row, row) < u_ - horizon_.margin()))
                    return false;
        return true;
    }
    /// The largest u of the corners of some cells of a column.
    double largest_u(int column, int first_row, int last_row) const {
        const float* const here = horizon_.u().column(column);
        const float* const ahead = horizon_.u().column(column + 1);
        float largest = grid_u::nothing;
        for (int y = first_row; y <= last_row + 1; ++y) largest = (std::max)({largest, here[y], ahead[y]});
        return static_cast<double>(largest);
    }

    /// Decides by the bounds of a column, once the ray has been followed down to it.
    decision decide_before(int column) const {
        const int strip = static_cast<int>(w_ - lattice_margin_ - horizon_.first_strip()),
                  next = static_cast<int>(w_ + lattice_margin_ - horizon_.first_strip());
        if (!horizon_.has_strip(strip) || !horizon_.has_strip(next)) return decision::undecided;
        const horizon_bound b = horizon_.bound(column, strip, next);
        if (u_ < static_cast<double>(b.dark_below) - horizon_.margin()) return decision::dark;
        return u_ > static_cast<double>(b.lit_above) + horizon_.margin() ? decision::lit : decision::undecided;
    }

    /// Where the ray stays off the border in this column.
    /// @param limit  position of the point, in columns from this one
    crossing cross(int column, double limit) const {
        const double slope = grid_.slope, low = row_at(column);
        const int row = static_cast<int>(low);
        const float* const here = horizon_.u().column(column) + row;
        const float* const ahead = horizon_.u().column(column + 1) + row;
        const auto a = static_cast<double>(here[0]), b = static_cast<double>(ahead[0]),
                   c = static_cast<double>(here[1]), d = static_cast<double>(ahead[1]);
        crossing found;
        // An edge is crossed at fraction s of the column and at fraction t of the edge.
        const auto add = [&](double s, double first, double last, double t) {
            if (s > limit + lattice_margin_) return;
            const double u = first + t * (last - first);
            found.smallest = (std::min)(found.smallest, u);
            found.largest = (std::max)(found.largest, u);
            if (s <= limit - lattice_margin_) found.certain = (std::max)(found.certain, u);
        };
        const double start = low - row, end = start + slope, up = (1 - start) / slope;
        const bool stays = end <= 1;
        add(0, a, c, start);
        if (stays)
            add(1, b, d, end);
        else
            add(up, c, d, up);
        if (grid_.is_rising) {
            if (stays && start < 1 - slope) add(start / (1 - slope), a, d, start / (1 - slope));
        } else {
            add((1 - start) / (1 + slope), c, b, (1 - start) / (1 + slope));
        }
        if (stays) return found;
        const auto e = static_cast<double>(here[2]), f = static_cast<double>(ahead[2]);
        add(1, d, f, end - 1);
        if (!grid_.is_rising) add((2 - start) / (1 + slope), e, d, (2 - start) / (1 + slope));
        return found;
    }

    const horizon_bounds& horizon_;
    const macrocell_u& macrocells_;
    const lit_grid& grid_;
    double x_, w_, u_;
    double lattice_margin_;
};

}  // namespace shadow::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
