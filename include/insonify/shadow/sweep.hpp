// A sweep along parallel light over a heightfield on a regular grid: for every cell, and for lines that run with the
// light, how far the surfaces before it block the light.
//
// A line crosses the edges of cells at known places, between two vertices each, and u is linear from one to the next:
// so what stands highest on a line is at a crossing, and a line's sweep is exact.
#pragma once

#include <insonify/core/dispatch.hpp>
#include <insonify/core/lanes.hpp>
#include <insonify/core/unfilled.hpp>
#include <insonify/geometry/regular_grid.hpp>
#include <insonify/geometry/transform.hpp>

#include <algorithm>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::shadow::detail {

using insonify::detail::convert, insonify::detail::count_up, insonify::detail::lanes, insonify::detail::prefetch,
    insonify::detail::store, insonify::detail::store_pairs, insonify::detail::transpose,
    insonify::detail::unfilled_vector;

/// A grid as a sweep sees it: X counts its vertices along the axis that the light follows most, Y those across, both
/// turned so that the light goes towards larger ones, by `slope` of Y for each of X. All points of a ray share
/// u = X + drop z: where it meets z = 0.
struct sweep_grid {
    int columns = 0, rows = 0;  ///< vertices along X, and along Y
    bool is_rising = true;      ///< cells are cut from (X, Y) to (X + 1, Y + 1), or else from (X, Y + 1) to (X + 1, Y)
    double slope = 0;           ///< in [0, 1]
    double drop = 0;            ///< columns that the light passes while it sinks by 1 m
    std::ptrdiff_t first = 0, along = 1, across = 1;  ///< the mesh's number of vertex (0, 0), and steps to the next
    affine to_mesh;                                   ///< from (X, Y, z)

    /// @param travel  where the light goes, in the mesh's frame: down
    sweep_grid(const regular_grid& grid, const glm::dvec3& travel)
        : columns(grid.columns), rows(grid.rows), is_rising(grid.is_rising), across(grid.columns) {
        glm::dvec2 x = grid.right, y = grid.up, origin = grid.origin;
        const double area = x.x * y.y - x.y * y.x;
        double travel_x = (travel.x * y.y - travel.y * y.x) / area, travel_y = (x.x * travel.y - x.y * travel.x) / area;
        if (numeric::magnitude(travel_y) > numeric::magnitude(travel_x)) {
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
        to_mesh = {glm::dmat3(glm::dvec3(x, 0), glm::dvec3(y, 0), glm::dvec3(0, 0, 1)), glm::dvec3(origin, 0)};
    }
};

/// Which columns of a grid are kept, and which lines: line k passes through Y = start + k spacing at X = 0.
struct sweep_window {
    int entry = 0;  ///< the first column from which anything can block what is asked about
    int first_column = 0, columns = 0;
    int slots = 1;             ///< of a column, side by side for each line: where it enters and, if cells fall, behind
                               ///< the edge of a row
    int lines = 0, pitch = 0;  ///< that count, and that are kept
    float start = 0, spacing = 1, slope = 0;

    int last_column() const { return first_column + columns - 1; }
};

/// u of a grid's vertices as far as a window needs them, column by column, and less than anything around them.
struct sweep_relief {
    static constexpr int below = 2, above = 4;  ///< rows around
    static constexpr float nothing = -1e30f;
    static constexpr float least = -1e20f;  ///< of any u; what is interpolated with nothing lies below it

    template <executor E>
    sweep_relief(const mesh_view& m, const sweep_grid& grid, const sweep_window& window, E& ex)
        : first_(window.entry), pitch_(grid.rows + below + above) {
        const int columns = (std::min)(window.last_column() + 2, grid.columns) - first_;
        u_.resize(static_cast<std::size_t>(columns * pitch_));
        // In squares, so that both the mesh and what is made of it are read and written in runs; the next one is on its
        // way.
        constexpr int square = 32;
        const auto drop = static_cast<float>(grid.drop);
        bulk_ranges(ex, static_cast<std::size_t>(columns), square, [&](std::size_t from, std::size_t to) {
            const int left = first_ + static_cast<int>(from), right = first_ + static_cast<int>(to);
            for (int x = left; x < right; ++x) {
                std::fill_n(column(x), below, nothing);
                std::fill_n(column(x) + below + grid.rows, above, nothing);
            }
            for (int bottom = 0; bottom < grid.rows; bottom += square)
                for (int x = left; x < right; ++x) {
                    float* const heights = column(x) + below;
                    const auto start = static_cast<float>(x);
                    const glm::vec3* const vertex = m.positions.data() + grid.first + x * grid.along;
                    for (int y = bottom; y < (std::min)(bottom + square, grid.rows); ++y) {
                        prefetch(vertex + (std::min)(y + square, grid.rows - 1) * grid.across);
                        heights[y] = start + drop * vertex[y * grid.across].z;
                    }
                }
        });
    }

    const float* column(int x) const { return u_.data() + (x - first_) * pitch_; }

  private:
    float* column(int x) { return u_.data() + (x - first_) * pitch_; }

    int first_;
    std::ptrdiff_t pitch_;
    unfilled_vector<float> u_;
};

/// Carries crests along some lines over the columns of a grid, as far as they are kept.
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
        // Before the first of the lines enters the grid, and when the last of them has left it, nothing changes.
        const float lowest = window.start + window.spacing * static_cast<float>(first_line),
                    highest = lowest + window.spacing * static_cast<float>(block);
        const int end = window.last_column() + 1,
                  first = (std::min)((std::max)(window.entry, column_at(-1.0f - highest)), end - 1),
                  last = (std::min)(end, column_at(static_cast<float>(grid.rows) - lowest) + 2);
        for (int i = 0; i < block / N; ++i) lines[i].enter(*this, first_line + i * N, first);
        keep<N>(lines, window.first_column, first);
        for (int column = first; column < last; ++column) {
            approach<N>(lines, column + 4);
            float* const kept = kept_at(column);
            for (int i = 0; i < block / N; ++i) {
                float* const to = kept == nullptr ? nullptr : kept + i * N * window.slots;
                if (column + 1 == grid.columns)
                    lines[i].leave(*this, to);
                else if (grid.is_rising)
                    lines[i].template step<true>(*this, column, to);
                else
                    lines[i].template step<false>(*this, column, to);
            }
        }
        keep<N>(lines, (std::max)(first, last), end);
    }

  private:
    template <int N>
    struct line_lanes;

    /// Where a line has climbed so many rows, held to the grid.
    int column_at(float climb) const {
        if (!(climb > 0)) return 0;
        const auto most = static_cast<float>(grid.columns - 1);
        return climb < window.slope * most ? static_cast<int>(climb / window.slope) : grid.columns - 1;
    }
    /// Where a column's crests go, if they are kept.
    float* kept_at(int column) const {
        const int at = column - window.first_column;
        if (at < 0 || at >= window.columns) return nullptr;
        return crests + (std::ptrdiff_t{at} * window.pitch + first_line) * window.slots;
    }
    /// A column soon to be passed: columns lie so far apart that no processor sees the next one coming.
    template <int N>
    INSONIFY_INLINE void approach(const line_lanes<N>* lines, int column) const {
        if (column > window.last_column()) return;
        constexpr int cache_line = 64 / sizeof(float);
        const float* const heights = relief.column(column);
        const int lowest = insonify::detail::lane(lines[0].row, 0),
                  highest = insonify::detail::lane(lines[block / N - 1].row, N - 1);
        for (int row = lowest; row < highest; row += cache_line) prefetch(heights + row);
        prefetch(heights + highest);
        const float* const kept = kept_at(column);
        if (kept == nullptr) return;
        for (int i = 0; i < block * window.slots; i += cache_line) prefetch(kept + i);
    }
    /// The same crests in some columns.
    template <int N>
    INSONIFY_INLINE void keep(const line_lanes<N>* lines, int first, int last) const {
        for (int column = first; column < last; ++column) {
            float* const kept = kept_at(column);
            if (kept == nullptr) continue;
            for (int i = 0; i < block / N; ++i) lines[i].keep(kept + i * N * window.slots, window.slots);
        }
    }

    /// N lines where they cross a column.
    template <int N>
    struct line_lanes {
        using floats = lanes<float, N>;
        using ints = lanes<std::int32_t, N>;
        floats start;      ///< Y at X = 0, counted from the relief's first row
        ints row;          ///< of the vertex before
        floats beyond;     ///< how far beyond it, in [0, 1]
        floats vertex[3];  ///< u there and at the next two
        floats u, crest;

        INSONIFY_INLINE void enter(const sweep_kernel& of, int first, int column) {
            floats number;
            count_up<float, N>(number);
            number = number + static_cast<float>(first);
            start = number * of.window.spacing + (of.window.start + static_cast<float>(sweep_relief::below));
            floats y, four[4];
            y_at(y, of, column);
            convert(row, y);
            convert(beyond, row);
            beyond = y - beyond;
            read(four, of, column);
            for (int i = 0; i < 3; ++i) vertex[i] = four[i];
            between(u, vertex[0], vertex[1], beyond);
            crest = floats{} + sweep_relief::nothing;
        }

        /// From one column to the next, over edges whose ends are vertices of both.
        /// @param kept  where the column's crests go, or null
        template <bool Rising>
        INSONIFY_INLINE void step(const sweep_kernel& of, int column, float* kept) {
            const float slope = of.window.slope;
            floats ahead[4], y;
            read(ahead, of, column + 1);
            y_at(y, of, column + 1);
            ints next_row;
            convert(next_row, y);
            const ints climbs = ints(next_row > row);  // over the edge of a row
            next_row = climbs ? row + 1 : row;
            floats next_beyond, next_u, on_edge;
            convert(next_beyond, next_row);
            next_beyond = y - next_beyond;
            const floats next[3] = {climbs ? ahead[1] : ahead[0], climbs ? ahead[2] : ahead[1],
                                    climbs ? ahead[3] : ahead[2]};
            between(next_u, next[0], next[1], next_beyond);
            between(on_edge, vertex[1], ahead[1], (1.0f - beyond) * (slope > 0 ? 1 / slope : 0.0f));
            if constexpr (Rising) {
                floats on_diagonal;
                between(on_diagonal, vertex[0], ahead[1], beyond * (slope < 1 ? 1 / (1 - slope) : 0.0f));
                const floats middle = climbs ? on_edge : on_diagonal;
                fall(u, middle);
                if (kept != nullptr) store(kept, crest);
                fall(middle, next_u);
            } else {
                floats on_first, on_second;
                between(on_first, vertex[1], ahead[0], (1.0f - beyond) * (1 / (1 + slope)));
                between(on_second, vertex[2], ahead[1], (2.0f - beyond) * (1 / (1 + slope)));
                const floats third = climbs ? on_edge : next_u, fourth = climbs ? on_second : next_u;
                fall(u, on_first);
                const floats before = crest;
                fall(on_first, third);
                fall(third, fourth);
                if (kept != nullptr) store_pairs<N>(kept, before, crest);
                fall(fourth, next_u);
            }
            row = next_row;
            beyond = next_beyond;
            for (int i = 0; i < 3; ++i) vertex[i] = next[i];
            u = next_u;
        }

        /// Behind the last column there is nothing.
        INSONIFY_INLINE void leave(const sweep_kernel& of, float* kept) {
            fall(u, floats{} + sweep_relief::nothing);
            if (kept == nullptr) return;
            keep(kept, of.window.slots);
        }
        /// The same in all slots.
        INSONIFY_INLINE void keep(float* kept, int slots) const {
            if (slots == 1)
                store(kept, crest);
            else
                store_pairs<N>(kept, crest, crest);
        }

      private:
        /// Held to the relief's rows.
        INSONIFY_INLINE void y_at(floats& y, const sweep_kernel& of, int column) const {
            const auto most = static_cast<float>(of.grid.rows + sweep_relief::below);
            y = start + of.window.slope * static_cast<float>(column);
            y = y > 0.0f ? y : floats{};
            y = y < most ? y : floats{} + most;
        }
        /// u of the vertex in the line's row, and of the next three.
        INSONIFY_INLINE void read(floats (&four)[4], const sweep_kernel& of, int column) const {
            const float* const from = of.relief.column(column);
            transpose<N>(four, [&](int k) { return from + insonify::detail::lane(row, k); });
        }
        /// Exact at both ends, though one may be nothing; never beyond the second.
        INSONIFY_INLINE static void between(floats& into, const floats& a, const floats& b, const floats& share) {
            const floats held = share < 1.0f ? share : floats{} + 1.0f;
            into = a * (1.0f - held) + b * held;
        }
        INSONIFY_INLINE void fall(const floats& from, const floats& to) {
            crest = ints(to < from) & ints(from > crest) ? from : crest;
        }
    };
};

}  // namespace insonify::inline INSONIFY_ABI::shadow::detail

INSONIFY_ARITHMETIC_END
