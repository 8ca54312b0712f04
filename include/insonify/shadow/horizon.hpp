// Hard shadows of a heightfield over a regular grid: how far the light is blocked, swept once over its cells.
//
// All points of a ray of parallel light share their u (see light.hpp), so a point is dark if some surface up the light
// from it has a larger u. The largest so far, carried along lines that run with the light, says it all: it is kept
// where a line enters a cell, and interpolated between two lines.
//
// Only crests count, from where u falls along the light: there a surface turns away from it. So what faces the light is
// never compared with itself, and needs no bias; what faces away has to be known to be dark.
//
// Based on: Nelson L. Max. Horizon Mapping: Shadows for Bump-Mapped Surfaces. 1988
#pragma once

#include <insonify/core/dispatch.hpp>
#include <insonify/core/lanes.hpp>
#include <insonify/core/unfilled.hpp>
#include <insonify/geometry/bounds.hpp>
#include <insonify/geometry/regular_grid.hpp>
#include <insonify/geometry/transform.hpp>
#include <insonify/shadow/light.hpp>

#include <algorithm>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::shadow {

namespace detail {

using insonify::detail::lanes;

/// A grid as a sweep sees it: X counts its vertices along the axis that the light follows most, Y those across, both
/// turned so that the light goes towards larger ones, by `slope` of Y for each of X.
struct sweep_grid {
    int columns = 0, rows = 0;  ///< vertices along X, and along Y
    bool is_rising = true;      ///< cells are cut from (X, Y) to (X + 1, Y + 1), or else from (X, Y + 1) to (X + 1, Y)
    double slope = 0;           ///< in [0, 1]
    std::ptrdiff_t first = 0, along = 1, across = 1;  ///< the mesh's number of vertex (0, 0), and steps to the next
    affine to_mesh;                                   ///< from (X, Y, z)

    /// @param travel  where the light goes, in the mesh's frame
    sweep_grid(const regular_grid& grid, const glm::dvec3& travel)
        : columns(grid.columns), rows(grid.rows), is_rising(grid.is_rising), across(grid.columns) {
        glm::dvec2 x = grid.right, y = grid.up, origin = grid.origin;
        double travel_x = travel.x * y.y - travel.y * y.x, travel_y = x.x * travel.y - x.y * travel.x;
        const auto size = [](double v) { return v < 0 ? -v : v; };
        if (size(travel_y) > size(travel_x)) {
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
        to_mesh = {glm::dmat3(glm::dvec3(x, 0), glm::dvec3(y, 0), glm::dvec3(0, 0, 1)), glm::dvec3(origin, 0)};
    }
};

/// u of a grid's vertices, column by column, and less than anything around them.
struct sweep_relief {
    static constexpr int below = 2, above = 4;  ///< rows around
    static constexpr float nothing = -1e30f;

    std::ptrdiff_t pitch;
    insonify::detail::unfilled_vector<float> u;

    /// @param to_u  u of (X, Y, z) is dot(to_u, (X, Y, z)) + u_start
    template <executor E>
    sweep_relief(const mesh& m, const sweep_grid& grid, const glm::dvec3& to_u, double u_start, E& ex)
        : pitch(grid.rows + below + above), u(static_cast<std::size_t>(grid.columns * pitch)) {
        // In squares, so that both the mesh and what is made of it are read and written in runs.
        constexpr int square = 32;
        const auto height = static_cast<float>(to_u.z);
        bulk_ranges(ex, static_cast<std::size_t>(grid.columns), square, [&](std::size_t from, std::size_t to) {
            const int left = static_cast<int>(from), right = static_cast<int>(to);
            for (int x = left; x < right; ++x) {
                float* const column = u.data() + x * pitch;
                std::fill_n(column, below, nothing);
                std::fill_n(column + below + grid.rows, above, nothing);
            }
            for (int bottom = 0; bottom < grid.rows; bottom += square)
                for (int x = left; x < right; ++x) {
                    float* const column = u.data() + x * pitch + below;
                    const auto start = static_cast<float>(u_start + to_u.x * x), step = static_cast<float>(to_u.y);
                    const glm::vec3* const vertex = m.positions.data() + grid.first + x * grid.along;
                    for (int y = bottom; y < (std::min)(bottom + square, grid.rows); ++y)
                        column[y] = start + step * static_cast<float>(y) + height * vertex[y * grid.across].z;
                }
        });
    }
};

/// Which columns of a grid are kept, and which lines: line k passes through Y = start + k spacing at X = 0.
struct sweep_window {
    int first_column = 0, columns = 0;
    int lines = 0;
    int slots = 1;  ///< kept for a column: where a line enters it and, if cells fall, behind the edge of a row
    float start = 0, spacing = 1;

    std::ptrdiff_t pitch() const { return lines; }
};

/// Carries crests along some lines over all columns of a grid.
struct sweep_kernel {
    static constexpr int block = 32;  ///< lines
    const sweep_grid& grid;
    const sweep_relief& relief;
    const sweep_window& window;
    int first_line;
    float* crests;

    template <int N>
    INSONIFY_INLINE void run() const {
        line_lanes<N> lines[static_cast<unsigned>(block / N)];
        lanes<float, N> number;
        insonify::detail::count_up<float, N>(number);
        for (int i = 0; i < block / N; ++i) {
            lines[i].start = window.start + window.spacing * (number + static_cast<float>(first_line + i * N));
            lines[i].enter(*this);
        }
        for (int column = 0; column < grid.columns; ++column) {
            const int at = column - window.first_column;
            float* keep = nullptr;
            if (at >= 0 && at < window.columns) keep = crests + at * window.slots * window.pitch() + first_line;
            for (int i = 0; i < block / N; ++i) {
                float* const to = keep == nullptr ? nullptr : keep + i * N;
                if (column + 1 == grid.columns)
                    lines[i].leave(*this, to);
                else if (grid.is_rising)
                    lines[i].template step<true>(*this, column, to);
                else
                    lines[i].template step<false>(*this, column, to);
            }
        }
    }

  private:
    /// N lines where they cross a column.
    template <int N>
    struct line_lanes {
        using floats = lanes<float, N>;
        using ints = lanes<std::int32_t, N>;
        floats start;      ///< Y at X = 0
        ints row;          ///< of the vertex before, counted from the first of the relief
        floats beyond;     ///< how far beyond it, in [0, 1]
        floats vertex[3];  ///< u there and at the next two
        floats u, crest;

        INSONIFY_INLINE void enter(const sweep_kernel& of) {
            const floats y = y_at(of, 0);
            insonify::detail::convert(row, y);
            look(beyond, y, row);
            floats four[4];
            read(four, of, 0);
            for (int i = 0; i < 3; ++i) vertex[i] = four[i];
            between(u, vertex[0], vertex[1], beyond);
            crest = floats{} + sweep_relief::nothing;
        }

        /// From one column to the next, over edges whose ends are vertices of both.
        template <bool Rising>
        INSONIFY_INLINE void step(const sweep_kernel& of, int column, float* keep) {
            const auto slope = static_cast<float>(of.grid.slope);
            floats ahead[4];
            read(ahead, of, column + 1);
            const floats y = y_at(of, column + 1);
            ints next_row;
            insonify::detail::convert(next_row, y);
            const ints climbs = ints(next_row > row);  // over the edge of a row
            next_row = climbs ? row + 1 : row;
            floats next_beyond, next_u;
            look(next_beyond, y, next_row);
            const floats next[3] = {climbs ? ahead[1] : ahead[0], climbs ? ahead[2] : ahead[1],
                                    climbs ? ahead[3] : ahead[2]};
            between(next_u, next[0], next[1], next_beyond);
            floats on_edge;
            between(on_edge, vertex[1], ahead[1], (1.0f - beyond) * (slope > 0 ? 1 / slope : 0.0f));
            if constexpr (Rising) {
                floats on_diagonal;
                between(on_diagonal, vertex[0], ahead[1], beyond * (slope < 1 ? 1 / (1 - slope) : 0.0f));
                const floats middle = climbs ? on_edge : on_diagonal;
                fall(u, middle);
                if (keep != nullptr) insonify::detail::store(keep, crest);
                fall(middle, next_u);
            } else {
                floats on_first, on_second;
                between(on_first, vertex[1], ahead[0], (1.0f - beyond) * (1 / (1 + slope)));
                between(on_second, vertex[2], ahead[1], (2.0f - beyond) * (1 / (1 + slope)));
                fall(u, on_first);
                if (keep != nullptr) insonify::detail::store(keep, crest);
                fall(on_first, climbs ? on_edge : next_u);
                fall(climbs ? on_edge : next_u, climbs ? on_second : next_u);
                if (keep != nullptr) insonify::detail::store(keep + of.window.pitch(), crest);
                fall(climbs ? on_second : next_u, next_u);
            }
            row = next_row;
            beyond = next_beyond;
            for (int i = 0; i < 3; ++i) vertex[i] = next[i];
            u = next_u;
        }

        /// Behind the last column there is nothing.
        INSONIFY_INLINE void leave(const sweep_kernel& of, float* keep) {
            fall(u, floats{} + sweep_relief::nothing);
            if (keep == nullptr) return;
            for (int slot = 0; slot < of.window.slots; ++slot)
                insonify::detail::store(keep + slot * of.window.pitch(), crest);
        }

      private:
        /// Counted from the relief's first row, and held to its rows.
        INSONIFY_INLINE floats y_at(const sweep_kernel& of, int column) const {
            const auto most = static_cast<float>(of.grid.rows + sweep_relief::below);
            floats y = start + (static_cast<float>(of.grid.slope) * static_cast<float>(column) +
                                static_cast<float>(sweep_relief::below));
            y = y > 0.0f ? y : floats{};
            return y < most ? y : floats{} + most;
        }
        INSONIFY_INLINE static void look(floats& past, const floats& y, const ints& vertex_row) {
            insonify::detail::convert(past, vertex_row);
            past = y - past;
        }
        /// u of the vertex in the line's row, and of the next three.
        INSONIFY_INLINE void read(floats (&four)[4], const sweep_kernel& of, int column) const {
            const float* const from = of.relief.u.data() + column * of.relief.pitch;
            insonify::detail::transpose<N>(four, [&](int k) { return from + insonify::detail::lane(row, k); });
        }
        /// Exact at both ends, though one may be nothing.
        INSONIFY_INLINE static void between(floats& into, const floats& a, const floats& b, const floats& share) {
            into = a * (1.0f - share) + b * share;
        }
        INSONIFY_INLINE void fall(const floats& from, const floats& to) {
            crest = ints(to < from) & ints(from > crest) ? from : crest;
        }
    };
};

}  // namespace detail

/// One mesh as a caster, if it is a heightfield over a regular grid.
class horizon {
  public:
    /// Casts nothing.
    horizon() = default;

    /// @param frame      of the light
    /// @param m          the mesh
    /// @param grid       how it lies; nothing that can be asked about lies below it
    /// @param to_world   from the mesh's frame to the one in which the light is described; doesn't mirror it
    /// @param receivers  what can be asked about, in that frame
    /// @param spacing    metres between lines
    template <executor E>
    horizon(const light_frame& frame, const mesh& m, const regular_grid& grid, const affine& to_world,
            const bounding_box& receivers, double spacing, E& ex) {
        const glm::dvec3 travel = numeric::product(inverse(to_world).linear, -frame.to_light());
        const detail::sweep_grid sweep(grid, travel);
        const affine placed = compose(to_world, sweep.to_mesh);
        const glm::dvec3 start = frame(placed.offset);
        glm::dvec3 to_u, to_v;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 there = frame(placed.offset + placed.linear[i]);
            to_u[i] = there.x - start.x;
            to_v[i] = there.y - start.y;
        }
        // From the world to X, lines and u; a line is where Y - slope X is.
        const affine back = inverse(placed);
        const auto row_of = [&](int i) { return glm::dvec4(back.linear[0][i], back.linear[1][i], back.linear[2][i], back.offset[i]); };
        const glm::dvec4 to_x = row_of(0), to_y = row_of(1), to_line = to_y - sweep.slope * to_x;

        const auto range = [&](const glm::dvec4& row) {
            double low = row.w, high = row.w;
            for (int i = 0; i < 3; ++i) {
                const double a = row[i] * receivers.lower[i], b = row[i] * receivers.upper[i];
                low += (std::min)(a, b);
                high += (std::max)(a, b);
            }
            return glm::dvec2(low, high);
        };
        const glm::dvec2 asked_x = range(to_x), asked_lines = range(to_line);
        const double step = spacing / (to_v.y < 0 ? -to_v.y : to_v.y);
        const double low = (std::max)(asked_lines.x, -sweep.slope * (sweep.columns - 1)) - step;
        const double high = (std::min)(asked_lines.y, static_cast<double>(sweep.rows - 1)) + step;
        if (!(low < high) || asked_x.y < 0) return;
        window_.slots = sweep.is_rising ? 1 : 2;
        const auto column = [&](double x) {
            return static_cast<int>((std::min)((std::max)(x, 0.0), static_cast<double>(sweep.columns - 1)));
        };
        window_.first_column = column(asked_x.x);
        window_.columns = column(asked_x.y) + 1 - window_.first_column;
        const int lines = static_cast<int>((high - low) / step) + 2;
        window_.lines = (lines + detail::sweep_kernel::block - 1) / detail::sweep_kernel::block * detail::sweep_kernel::block;
        window_.start = static_cast<float>(low);
        window_.spacing = static_cast<float>(step);

        const detail::sweep_relief relief(m, sweep, to_u, start.x, ex);
        crests_.resize(static_cast<std::size_t>(window_.columns * window_.slots * window_.pitch()));
        bulk_ranges(ex, static_cast<std::size_t>(window_.lines), detail::sweep_kernel::block,
                    [&](std::size_t first, std::size_t) {
                        insonify::detail::dispatch(
                            detail::sweep_kernel{sweep, relief, window_, static_cast<int>(first), crests_.data()},
                            best_isa());
                    });

        slope_ = static_cast<float>(sweep.slope);
        columns_ = sweep.columns;
        to_x_ = glm::vec4(to_x);
        to_y_ = glm::vec4(to_y);
        to_line_ = glm::vec4((to_line - glm::dvec4(0, 0, 0, low)) / step);
        const glm::dvec2& along = frame.travel();
        to_u_ = glm::vec3(along.x, along.y, frame.cot_elevation());
    }

    bool empty() const { return crests_.empty(); }

    /// Marks which of the `asked` points are dark but for what faces away; positions are in the frame in which the
    /// light is described.
    template <int N>
    INSONIFY_INLINE void darken(insonify::detail::lanes<std::int32_t, N>& dark,
                                const insonify::detail::lanes<std::int32_t, N>& asked,
                                const insonify::detail::lanes<float, N> (&position)[3]) const {
        using namespace insonify::detail;
        using ints = lanes<std::int32_t, N>;
        using floats = lanes<float, N>;
        dark = ints{};
        if (empty()) return;
        const auto at = [&](const glm::vec4& row) INSONIFY_INLINE_LAMBDA {
            return floats(position[0] * row.x + position[1] * row.y + position[2] * row.z + row.w);
        };
        floats x = at(to_x_);
        const floats line = at(to_line_);
        const ints on_map = asked & ints(x >= 0.0f) & ints(line >= 0.0f) &
                            ints(line < static_cast<float>(window_.lines - 1));
        if (!any(on_map)) return;
        const auto first = static_cast<float>(window_.first_column),
                   last = static_cast<float>(window_.first_column + window_.columns - 1);
        floats clamped = x > first ? x : floats{} + first;
        clamped = clamped < last ? clamped : floats{} + last;
        ints column, number;
        convert(column, clamped);
        convert(number, floats(on_map ? line : floats{}));
        floats whole;
        convert(whole, number);
        const floats share = line - whole;
        ints slot = column - window_.first_column;
        if (window_.slots == 2) {
            // Past the edge of a row since it entered the column?
            const floats y = at(to_y_);
            convert(whole, column);
            const floats entered = y - slope_ * (x - whole);
            ints row;
            convert(row, y);
            convert(whole, row);
            slot = slot + slot + (entered < whole ? ints{} + 1 : ints{});
        }
        const ints index = slot * static_cast<std::int32_t>(window_.pitch()) + number;
        floats left, right;
        gather_pairs<N>(left, right, [&](int k) { return crests_.data() + lane(on_map ? index : ints{}, k); });
        const ints is_open = ints(left < -1e20f) | ints(right < -1e20f);
        const floats nearest = share < 0.5f ? left : right;
        const floats crest = is_open ? nearest : left + share * (right - left);
        const floats u = position[0] * to_u_.x + position[1] * to_u_.y + position[2] * to_u_.z;
        dark = on_map & ints(u < crest);
    }

  private:
    detail::sweep_window window_;
    float slope_ = 0;
    int columns_ = 0;
    glm::vec4 to_x_{0}, to_y_{0}, to_line_{0};  ///< from positions, with one for a fourth
    glm::vec3 to_u_{0};
    insonify::detail::unfilled_vector<float> crests_;  ///< largest u so far, by column, slot and line
};

}  // namespace insonify::inline INSONIFY_ABI::shadow

INSONIFY_ARITHMETIC_END
