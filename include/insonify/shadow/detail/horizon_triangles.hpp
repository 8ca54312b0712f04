// Decides whole triangles of a regular grid, lit or dark, by the bounds of their horizon.
//
// Within a cell, u (horizon_bounds.hpp) lies between its values at the corners. A triangle is dark if its largest u is
// below the lower bounds of its strips, and lit if its smallest u is above the upper bounds. Pixels that show such a
// triangle need no test of their point. This holds for the upper side, which the camera sees if it is above the
// triangle's plane.
#pragma once

#include <insonify/shadow/detail/horizon_bounds.hpp>
#include <insonify/shadow/detail/light_planes.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::detail::inline INSONIFY_FLAGS {

/// Maps points of a light's plane to where their rays meet the plane z = 0 of a mesh, in grid steps.
class mesh_plane_intercepts {
  public:
    mesh_plane_intercepts(const light_plane& plane, const affine& placement, const lit_grid& grid) : grid_(grid) {
        const auto projected = [&](double x, double y) {
            return glm::dvec2(plane(transform_point(placement, {x, y, 0})));
        };
        const glm::dvec2 origin = projected(0, 0);
        metres_ = {origin, projected(1, 0) - origin, projected(0, 1) - origin};
    }

    /// Bounds of the images of a rectangle.
    insonify::detail::ground_rect of(const glm::dvec2& corner, const glm::dvec2& size) const {
        insonify::detail::ground_rect all;
        for (const glm::dvec2& to : {glm::dvec2(0), glm::dvec2(size.x, 0), glm::dvec2(0, size.y), size})
            all.include(grid_.steps(metres_(corner + to)));
        return all;
    }

  private:
    plane_axes metres_;  ///< on the plane z = 0 of the mesh
    const lit_grid& grid_;
};

/// Decides all triangles of one grid, seen by one camera.
class horizon_triangles {
  public:
    /// @param m    the mesh that `horizon` was computed for
    /// @param eye  the camera, in the mesh's frame
    horizon_triangles(const mesh_view& m, const horizon_bounds& horizon, const glm::dvec3& travel,
                      const glm::dvec3& eye)
        : horizon_(horizon), grid_(horizon.grid()) {
        eye_ = grid_.steps(glm::dvec2(eye));
        eye_u_ = eye_.x + grid_.u_per_metre * eye.z;
        // sin(grazing angle) = slope of u along the light x sin(elevation) / |normal of the facet|. `steepest` is an
        // upper bound of that |normal|.
        const double relief = horizon.u().highest_z - horizon.u().lowest_z;
        const double steps_per_metre = (std::max)(numeric::length(grid_.steps.x_of), numeric::length(grid_.steps.y_of));
        const double steepest = 1 + 2 * relief * steps_per_metre;
        const double sine = -travel.z / numeric::length(travel);
        constexpr double min_sine = 0x1p-20;  // triangles at a smaller grazing angle are left to the test of points
        min_facing_slope_ = horizon.margin() + min_sine * steepest / sine;
        // `lower` has its right angle at `apex` and leaves out the opposite corner. It is the first triangle of a cell
        // if the mesh's first triangle leaves out that corner too.
        const std::ptrdiff_t corner = grid_.corner(0, 0);
        const std::ptrdiff_t apex = grid_.first + (grid_.is_rising ? grid_.along : 0) - corner;
        const glm::uvec3& t = m.triangles[0];
        const std::ptrdiff_t opposite = grid_.pitch + 1 - apex;
        lower_is_first_ = static_cast<std::ptrdiff_t>(t.x) != opposite &&
                          static_cast<std::ptrdiff_t>(t.y) != opposite && static_cast<std::ptrdiff_t>(t.z) != opposite;
    }

    /// Writes the results of some columns of cells, by triangle.
    void classify(int first_column, int last_column, decision* into, isa level) const {
        for (int left = first_column; left < last_column; left += wide)
            for (int bottom = 0; bottom < grid_.rows - 1; bottom += tall) {
                decisions found;
                const int right = (std::min)(left + wide, last_column), top = (std::min)(bottom + tall, grid_.rows - 1);
                insonify::detail::dispatch(kernel{*this, left, bottom, right, top, found}, level);
                write(found, left, bottom, right, top, into);
            }
    }

    /// Discards the results of cells that another caster may shade, within some columns: those whose rays pass through
    /// a rectangle of the plane z = 0.
    /// @param lower, upper  corners of the rectangle, in the grid's steps
    void reset_to_undecided(const glm::dvec2& lower, const glm::dvec2& upper, int first_column, int last_column,
                            decision* into) const {
        // Rays through the rectangle stay within these columns and, in each, these rows, at all heights of the relief.
        const double lowest_z = horizon_.u().lowest_z, highest_z = horizon_.u().highest_z;
        const double tolerance = 0x1p-8 + horizon_.margin();  // covers rounding
        const auto clamped = [](double at, int first, int last) {
            return static_cast<int>((std::min)((std::max)(at, static_cast<double>(first)), static_cast<double>(last)));
        };
        const int left = clamped(lower.x - grid_.u_per_metre * highest_z - tolerance - 1, first_column, last_column),
                  right = clamped(upper.x - grid_.u_per_metre * lowest_z + tolerance + 1, first_column, last_column);
        for (int x = left; x < right; ++x) {
            const int bottom = clamped(lower.y - grid_.slope * (upper.x - x) - tolerance - 2, 0, grid_.rows - 1),
                      top = clamped(upper.y - grid_.slope * (lower.x - x - 1) + tolerance + 2, 0, grid_.rows - 1);
            const float *const here = horizon_.u().column(x), *const ahead = horizon_.u().column(x + 1);
            for (int y = bottom; y < top; ++y) {
                const auto low = static_cast<double>((std::min)({here[y], here[y + 1], ahead[y], ahead[y + 1]})),
                           high = static_cast<double>((std::max)({here[y], here[y + 1], ahead[y], ahead[y + 1]}));
                if (high < lower.x - tolerance || low > upper.x + tolerance) continue;
                into[grid_.first_triangle(x, y)] = into[grid_.first_triangle(x, y) + 1] = decision::undecided;
            }
        }
    }

  private:
    /// Size in cells of the parts whose results stay in the cache. Within a column, reads are contiguous; the next
    /// column is on another page, where hardware prefetchers do not follow.
    static constexpr int wide = 32, tall = 256;

    /// Results for the cells of a part.
    struct decisions {
        std::int32_t of[wide][tall];  ///< by column, then row: of the first triangle, and of the second << 8
    };

    /// The results of a part in the order of the mesh.
    void write(const decisions& found, int left, int bottom, int right, int top, decision* into) const {
        for (int y = bottom; y < top; ++y)
            for (int x = left; x < right; ++x) {
                const std::int32_t both = found.of[x - left][y - bottom];
                decision* const cell = into + grid_.first_triangle(x, y);
                cell[0] = static_cast<decision>(both & 0xFF);
                cell[1] = static_cast<decision>(both >> 8);
            }
    }

    struct kernel {
        const horizon_triangles& whole;
        int left, bottom, right, top;
        decisions& into;

        template <int N>
        INSONIFY_INLINE void run() const {
            for (int x = left; x < right; ++x) {
                int y = bottom;
                for (; y + N <= top; y += N) decide<N>(x, y);
                for (; y < top; ++y) decide<1>(x, y);
            }
        }

      private:
        /// N cells of a column.
        template <int N>
        INSONIFY_INLINE void decide(int x, int y) const {
            using namespace insonify::detail;
            using floats = lanes<float, N>;
            const horizon_bounds& horizon = whole.horizon_;
            const lit_grid& grid = whole.grid_;
            floats a, b, c, d;  // (0,0) (1,0) (0,1) (1,1)
            load(a, horizon.u().column(x) + y);
            load(c, horizon.u().column(x) + y + 1);
            load(b, horizon.u().column(x + 1) + y);
            load(d, horizon.u().column(x + 1) + y + 1);
            // The strips that the cells lie in.
            constexpr double tolerance = 0x1p-8;
            const double from = y - horizon.first_strip() - grid.slope * x;
            floats dark_below = floats{} + std::numeric_limits<float>::infinity(), lit_above = 0.0f - dark_below;
            const int last = static_cast<int>(from + 1 + tolerance);
            for (int strip = static_cast<int>(from - grid.slope - tolerance); strip <= last; ++strip) {
                floats smallest, largest;
                load(smallest, horizon.dark_below(x) + strip);
                load(largest, horizon.lit_above(x) + strip);
                dark_below = smallest < dark_below ? smallest : dark_below;
                lit_above = largest > lit_above ? largest : lit_above;
            }
            const auto margin = static_cast<float>(horizon.margin());
            dark_below = dark_below - margin;
            lit_above = lit_above + margin;
            floats row;
            iota<float, N>(row);
            const auto dx = static_cast<float>(whole.eye_.x - x);
            const floats dy = static_cast<float>(whole.eye_.y - y) - row;
            const floats error = 4 * margin * ((2 + numeric::abs(dx)) + (dy < 0.0f ? 0.0f - dy : dy));
            const floats eye = static_cast<float>(whole.eye_u_) - error;
            const cell_triangles<N> decide{dark_below,
                                           lit_above,
                                           eye,
                                           dy,
                                           dx,
                                           static_cast<float>(grid.slope),
                                           static_cast<float>(whole.min_facing_slope_)};
            lanes<std::int32_t, N> lower, upper;
            if (grid.is_rising) {
                decide(lower, a, b, d, b - a, d - b, a);
                decide(upper, a, d, c, d - c, c - a, a);
            } else {
                decide(lower, a, b, c, b - a, c - a, a);
                decide(upper, b, d, c, d - c, d - b, b + c - d);
            }
            const auto& first = whole.lower_is_first_ ? lower : upper;
            const auto& second = whole.lower_is_first_ ? upper : lower;
            store(&into.of[x - left][y - bottom], lanes<std::int32_t, N>(first | second << 8));
        }
    };

    /// Decides one triangle of each of N cells.
    template <int N>
    struct cell_triangles {
        using floats = insonify::detail::lanes<float, N>;
        using ints = insonify::detail::lanes<std::int32_t, N>;
        floats dark_below, lit_above;  ///< bounds: dark below the first, lit above the second
        floats eye;                    ///< u of the camera less the error bound; it is above planes of smaller u
        floats dy;                     ///< from the cell to the camera
        float dx, slope, min_facing_slope;

        /// @param along_x, along_y  how u rises in it
        /// @param base              u of its plane at the cell's corner (0, 0)
        INSONIFY_INLINE void operator()(ints& result, const floats& p, const floats& q, const floats& r,
                                        const floats& along_x, const floats& along_y, const floats& base) const {
            floats largest, smallest;
            insonify::detail::range_of(smallest, largest, p, q, r);
            const floats u_slope = along_x + slope * along_y;
            const ints is_above = ints(base + along_x * dx + along_y * dy < eye);
            const ints is_facing = ints(u_slope > min_facing_slope),
                       is_facing_away = ints(u_slope < 0.0f - min_facing_slope);
            const ints is_dark = (is_above & is_facing_away) | ((is_above | is_facing) & ints(largest < dark_below));
            const ints is_lit = is_above & is_facing & ints(smallest > lit_above);
            result = is_lit ? ints{} + static_cast<std::int32_t>(decision::lit)
                            : ints{} + static_cast<std::int32_t>(decision::undecided);
            result = is_dark ? ints{} + static_cast<std::int32_t>(decision::dark) : result;
        }
    };

    const horizon_bounds& horizon_;
    const lit_grid& grid_;
    glm::dvec2 eye_{0};  ///< in the grid's steps
    double eye_u_ = 0;
    double min_facing_slope_ = 0;  ///< slope of u along the light, per column, above which a triangle faces it
    bool lower_is_first_ = true;
};

}  // namespace shadow::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
