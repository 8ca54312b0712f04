// Hard shadows of a heightfield over a regular grid: how far the light is blocked, swept once over its cells.
//
// All points of a ray of parallel light share their u (see sweep.hpp), so a point is dark if some surface up the light
// from it has a larger u. The largest so far is carried along lines that run with the light, kept where they enter a
// cell, and interpolated between two lines.
//
// Only crests count, from where u falls along the light: there a surface turns away from it. So what faces the light is
// never compared with itself, and needs no bias; what faces away has to be known to be dark.
//
// Based on: Nelson L. Max. Horizon Mapping: Shadows for Bump-Mapped Surfaces. 1988
#pragma once

#include <insonify/geometry/bounds.hpp>
#include <insonify/shadow/light.hpp>
#include <insonify/shadow/sweep.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::shadow {

/// One mesh as a caster, if it is a heightfield over a regular grid.
class horizon {
  public:
    /// Casts nothing.
    horizon() = default;

    /// @param frame      of the light
    /// @param m          the mesh
    /// @param box        around it, in its own frame
    /// @param grid       how it lies; nothing that can be asked about lies below it
    /// @param to_world   from the mesh's frame to the one in which the light is described; it comes from above in both
    /// @param receivers  what can be asked about lies in this box, in the latter frame
    /// @param texel      metres, of which lines lie two thirds apart; grows if more than `largest` lines were needed,
    ///                   or 2^30 values
    /// @param level      the widest instruction set to use; the answers are the same
    template <executor E>
    horizon(const light_frame& frame, const mesh_view& m, const bounding_box& box, const regular_grid& grid,
            const affine& to_world, const bounding_box& receivers, double texel, int largest, E& ex,
            isa level = best_isa()) {
        if (receivers.empty()) return;
        const glm::dvec3 travel = numeric::product(inverse(to_world).linear, -frame.to_light());
        const detail::sweep_grid sweep(grid, travel);
        const affine placed = compose(to_world, sweep.to_mesh);
        const affine back = inverse(placed);
        const linear_map x = linear_map::row_of(back, 0), y = linear_map::row_of(back, 1),
                         z = linear_map::row_of(back, 2);
        const linear_map line{y.along - sweep.slope * x.along, y.start - sweep.slope * x.start};  // its Y at X = 0
        const linear_map u{x.along + sweep.drop * z.along, x.start + sweep.drop * z.start};
        // From line to line, if they are a row apart.
        const glm::dvec3 run = placed.linear[0] + sweep.slope * placed.linear[1];
        const auto length = [](const glm::dvec3& v) { return numeric::square_root(numeric::dot(v, v)); };
        const double apart = length(numeric::cross(run, placed.linear[1])) / length(run);

        const glm::dvec2 asked_x = x.range(receivers), asked_lines = line.range(receivers),
                         asked_u = u.range(receivers);
        const double first = (std::max)(asked_lines.x, -sweep.slope * (sweep.columns - 1));
        const double last = (std::min)(asked_lines.y, static_cast<double>(sweep.rows - 1));
        if (!(first <= last) || asked_x.y < 0) return;
        const auto column = [&](double at) {
            return static_cast<int>((std::min)((std::max)(at, 0.0), static_cast<double>(sweep.columns - 1)));
        };
        window_.first_column = column(asked_x.x);
        window_.columns = column(asked_x.y) + 1 - window_.first_column;
        // Up the light from there, even the highest lies below all that is asked about.
        window_.entry = (std::min)(column(asked_u.x - sweep.drop * box.upper.z - 1), window_.first_column);
        window_.slots = sweep.is_rising ? 1 : 2;
        const int most = (std::min)(largest, (1 << 30) / (window_.columns * window_.slots));
        constexpr double closer = 1.5;  // than texels: a dB or two for one part in forty of a picture's time
        const double finest = texel / (closer * apart);
        const double step = (std::max)(finest, (last - first) / (std::max)(1, most - 3));
        window_.start = static_cast<float>(first - step);  // one more on either side, to interpolate
        window_.spacing = static_cast<float>(step);
        window_.slope = static_cast<float>(sweep.slope);
        window_.lines = static_cast<int>((last - first) / step) + 4;
        window_.pitch = (window_.lines + detail::sweep_kernel::block - 1) / detail::sweep_kernel::block *
                        detail::sweep_kernel::block;

        const detail::sweep_relief relief(m, sweep, window_, ex);
        const std::size_t kept = static_cast<std::size_t>(window_.columns) * static_cast<std::size_t>(window_.pitch);
        crests_.resize((kept + lines_ahead) * static_cast<std::size_t>(window_.slots));
        bulk_ranges(ex, static_cast<std::size_t>(window_.pitch), detail::sweep_kernel::block,
                    [&](std::size_t start, std::size_t) {
                        insonify::detail::dispatch(
                            detail::sweep_kernel{sweep, relief, window_, static_cast<int>(start), crests_.data()},
                            level);
                    });

        to_x_ = lane_map(x);
        to_line_ = lane_map({line.along / step, (line.start - first) / step + 1});
        const double slack = 0x1p-21 * (std::max)(-asked_u.x, asked_u.y);  // floats hold places no better
        to_u_ = lane_map(u, static_cast<float>(slack));
        last_line_ = static_cast<float>(window_.lines - 1);
        first_ = static_cast<float>(window_.first_column);
        last_ = static_cast<float>(window_.first_column + window_.columns - 1);
        first_column_ = window_.first_column;
        pitch_ = window_.pitch;
        // Pictures are drawn row by row towards -y: what the next rows will ask is on its way.
        ahead_ = (line.along.y > 0 ? -lines_ahead : lines_ahead) * window_.slots;
    }

    bool empty() const { return crests_.empty(); }

    /// Marks which of the `asked` points are dark, unless they face away; positions are in the frame in which the light
    /// is described.
    template <int N>
    INSONIFY_INLINE void darken(insonify::detail::lanes<std::int32_t, N>& dark,
                                const insonify::detail::lanes<std::int32_t, N>& asked,
                                const insonify::detail::lanes<float, N> (&position)[3]) const {
        using namespace insonify::detail;
        using ints = lanes<std::int32_t, N>;
        using floats = lanes<float, N>;
        dark = ints{};
        if (empty()) return;
        floats x, line, last_line;
        to_x_(x, position);
        to_line_(line, position);
        load(last_line, last_line_);
        const ints on_map = asked & ints(x >= 0.0f) & ints(line >= 0.0f) & ints(line < last_line);
        if (!any(on_map)) return;
        floats crest, u;
        find_crest<N>(crest, on_map, x, line);
        to_u_(u, position);
        dark = on_map & ints(u < crest);
    }

  private:
    /// along . point + start.
    struct linear_map {
        glm::dvec3 along;
        double start;

        static linear_map row_of(const affine& map, int i) {
            return {{map.linear[0][i], map.linear[1][i], map.linear[2][i]}, map.offset[i]};
        }
        /// The least and the largest in a box.
        glm::dvec2 range(const bounding_box& box) const {
            glm::dvec2 both(start);
            for (int i = 0; i < 3; ++i) {
                const double a = along[i] * box.lower[i], b = along[i] * box.upper[i];
                both += glm::dvec2((std::min)(a, b), (std::max)(a, b));
            }
            return both;
        }
    };

    /// The same in floats, for many points.
    struct lane_map {
        insonify::detail::spread<float> along[3], start;

        lane_map() = default;
        explicit lane_map(const linear_map& map, float more = 0)
            : along{static_cast<float>(map.along.x), static_cast<float>(map.along.y), static_cast<float>(map.along.z)},
              start(static_cast<float>(map.start) + more) {}
        template <class Floats>
        INSONIFY_INLINE void operator()(Floats& into, const Floats (&position)[3]) const {
            Floats a, b, c, d;
            load(a, along[0]), load(b, along[1]), load(c, along[2]), load(d, start);
            into = position[0] * a + position[1] * b + position[2] * c + d;
        }
    };

    /// How far the light is blocked where lines enter the cells of some points, which lie between two lines each.
    /// @param x     the points' columns, continuous, and `line` their lines; where they aren't on the map, anything
    template <int N>
    INSONIFY_INLINE void find_crest(insonify::detail::lanes<float, N>& crest,
                                    const insonify::detail::lanes<std::int32_t, N>& on_map,
                                    const insonify::detail::lanes<float, N>& point_x,
                                    const insonify::detail::lanes<float, N>& point_line) const {
        using namespace insonify::detail;
        using ints = lanes<std::int32_t, N>;
        using floats = lanes<float, N>;
        // Behind the last column, what it says goes on.
        floats first, last;
        load(first, first_), load(last, last_);
        floats x = point_x > first ? point_x : first;
        x = x < last ? x : last;
        const floats line = on_map ? point_line : floats{};
        ints column, number;
        convert(column, x);
        convert(number, line);
        floats entered_x, left_line;
        convert(entered_x, column);
        convert(left_line, number);
        const floats share = line - left_line;

        ints first_column, pitch, ahead;
        load(first_column, first_column_), load(pitch, pitch_), load(ahead, ahead_);
        ints start = (column - first_column) * pitch + number;
        if (window_.slots > 1) start = start + start;
        start = on_map ? start : ints{};
        ints soon = start + ahead;
        soon = soon > 0 ? soon : ints{};
        for (int k = 0; k < N; k += 2) prefetch(crests_.data() + lane(soon, k));

        floats left, right;
        if (window_.slots == 1) {
            gather_pairs<N>(left, right, [&](int k) { return crests_.data() + lane(start, k); });
        } else {
            // Behind the edge of a row that a line has passed since it entered the cell, its second slot counts. Rows
            // are counted from the one before the first.
            const floats left_y = (window_.start + 1.0f) + left_line * window_.spacing + entered_x * window_.slope;
            const floats y = left_y + share * window_.spacing + (x - entered_x) * window_.slope;
            ints row;
            floats edge;
            convert(row, y);
            convert(edge, row);
            floats both[4];  // slots of both lines
            transpose<N>(both, [&](int k) { return crests_.data() + lane(start, k); });
            left = left_y < edge ? both[1] : both[0];
            right = left_y + window_.spacing < edge ? both[3] : both[2];
        }
        // One line may have met nothing yet.
        const ints is_open = ints(left < detail::sweep_relief::least) | ints(right < detail::sweep_relief::least);
        crest = is_open ? (share < 0.5f ? left : right) : left + share * (right - left);
    }

    static constexpr int lines_ahead = 20;

    detail::sweep_window window_;
    lane_map to_x_, to_line_, to_u_;
    insonify::detail::spread<float> last_line_, first_, last_;  ///< lines, columns
    insonify::detail::spread<std::int32_t> first_column_, pitch_, ahead_;
    insonify::detail::unfilled_vector<float> crests_;  ///< largest u of a crest so far, by column, slot and line
};

}  // namespace insonify::inline INSONIFY_ABI::shadow

INSONIFY_ARITHMETIC_END
