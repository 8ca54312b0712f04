// Whole triangles of a regular grid that are in the light or in the dark, by the bounds of their horizon.
//
// Within a cell, u (horizon_bounds.hpp) lies between its values at the corners, and so a triangle whose largest u is
// below what every ray of its strips has met is dark in all its points; one whose least u is above what any may have
// met is lit. Pixels that show such a triangle need no point. That holds for its upper side; it is the one that the
// camera sees if the camera lies above the triangle's plane.
#pragma once

#include <insonify/shadow/detail/horizon_bounds.hpp>
#include <insonify/shadow/detail/light_planes.hpp>

#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::detail::inline INSONIFY_FLAGS {

/// Where the ray at a point of a light's plane meets the plane z = 0 of a mesh, in the steps of its grid.
class ray_feet {
  public:
    ray_feet(const light_plane& plane, const affine& placement, const lit_grid& grid) {
        const auto seen = [&](double x, double y) { return glm::dvec2(plane(transform_point(placement, {x, y, 0}))); };
        origin_ = seen(0, 0);
        const glm::dvec2 x = seen(1, 0) - origin_, y = seen(0, 1) - origin_;
        const double area = x.x * y.y - x.y * y.x;
        x_of_ = glm::dvec2(y.y, -y.x) / area;
        y_of_ = glm::dvec2(-x.y, x.x) / area;
        grid_ = &grid;
    }
    glm::dvec2 operator()(const glm::dvec2& at) const {
        const glm::dvec2 off = at - origin_;
        return grid_->steps({x_of_.x * off.x + x_of_.y * off.y, y_of_.x * off.x + y_of_.y * off.y});
    }

    /// Bounds of those of a rectangle's points.
    std::pair<glm::dvec2, glm::dvec2> of(const glm::dvec2& corner, const glm::dvec2& size) const {
        glm::dvec2 lower = (*this)(corner), upper = lower;
        for (const glm::dvec2& other : {glm::dvec2(size.x, 0), glm::dvec2(0, size.y), size}) {
            const glm::dvec2 at = (*this)(corner + other);
            lower = {(std::min)(lower.x, at.x), (std::min)(lower.y, at.y)};
            upper = {(std::max)(upper.x, at.x), (std::max)(upper.y, at.y)};
        }
        return {lower, upper};
    }

  private:
    glm::dvec2 origin_{0}, x_of_{0}, y_of_{0};
    const lit_grid* grid_ = nullptr;
};

/// Answers for all triangles of one grid, seen by one camera.
class horizon_triangles {
  public:
    /// @param m    the mesh, of which `horizon` is
    /// @param eye  the camera, in the mesh's frame
    horizon_triangles(const mesh_view& m, const regular_grid& lattice, const horizon_bounds& horizon,
                      const glm::dvec3& travel, const glm::dvec3& eye)
        : horizon_(horizon), grid_(horizon.grid()), columns_(lattice.columns) {
        eye_ = grid_.steps(glm::dvec2(eye));
        eye_u_ = eye_.x + grid_.drop * eye.z;
        // The sine is u's slope along the light, times the light's own sine, over the length of the facet's normal.
        const double relief =
            static_cast<double>(horizon.heights().greatest) - static_cast<double>(horizon.heights().least);
        const auto square_of = [](const glm::dvec2& v) { return v.x * v.x + v.y * v.y; };
        const double steps_a_metre = numeric::square_root((std::max)(square_of(grid_.x_of), square_of(grid_.y_of)));
        const double steepest = 1 + 2 * relief * steps_a_metre;
        const double sine = -travel.z / numeric::square_root(numeric::dot(travel, travel));
        constexpr double grazed = 0x1p-20;  // a triangle closer to the light's direction is left to points
        rise_ = horizon.margin() + grazed * steepest / sine;
        // The first triangle of each cell leaves one corner out; of the two here, `lower` is opposite another.
        const std::ptrdiff_t corner = corner_of(0, 0);
        const std::ptrdiff_t apex = grid_.first + (grid_.is_rising ? grid_.along : 0) - corner;
        const glm::uvec3& t = m.triangles[0];
        const std::ptrdiff_t opposite = columns_ + 1 - apex;
        lower_is_first_ = static_cast<std::ptrdiff_t>(t.x) != opposite &&
                          static_cast<std::ptrdiff_t>(t.y) != opposite && static_cast<std::ptrdiff_t>(t.z) != opposite;
    }

    /// Writes the answers of some columns of cells, by triangle.
    void find(int first_column, int last_column, known* into) const {
        for (int low = 0; low < grid_.rows - 1; low += square)
            for (int x = first_column; x < last_column; ++x)
                for (int y = low; y < (std::min)(low + square, grid_.rows - 1); ++y) decide(x, y, into);
    }

    /// Takes the answers back of cells over which others may cast: where rays through some u and w pass within the
    /// relief.
    /// @param lower, upper  where such rays meet the plane z = 0, in the grid's own steps
    void forget(const glm::dvec2& lower, const glm::dvec2& upper, known* into) const {
        const auto least = static_cast<double>(horizon_.heights().least),
                   greatest = static_cast<double>(horizon_.heights().greatest);
        const auto held = [](double at, int count) {
            return static_cast<int>((std::min)((std::max)(at, 0.0), static_cast<double>(count)));
        };
        const int left = held(lower.x - grid_.drop * greatest - 2, grid_.columns - 1),
                  right = held(upper.x - grid_.drop * least + 2, grid_.columns - 1);
        const double up = grid_.slope * grid_.drop;
        const int bottom = held(lower.y - up * greatest - 2, grid_.rows - 1),
                  top = held(upper.y - up * least + 2, grid_.rows - 1);
        for (int x = left; x < right; ++x)
            for (int y = bottom; y < top; ++y) into[triangle_of(x, y)] = into[triangle_of(x, y) + 1] = known::nothing;
    }

  private:
    static constexpr int square = 32;  ///< cells, so that what is read and what is written stays in the cache

    /// The vertex of a cell with the lowest number.
    std::ptrdiff_t corner_of(int x, int y) const {
        return grid_.first + (x + (grid_.along < 0 ? 1 : 0)) * grid_.along +
               (y + (grid_.across < 0 ? 1 : 0)) * grid_.across;
    }
    /// The first triangle of a cell.
    std::size_t triangle_of(int x, int y) const {
        const std::ptrdiff_t corner = corner_of(x, y);
        return static_cast<std::size_t>(2 * (corner - corner / columns_));
    }

    void decide(int x, int y, known* into) const {
        const float *const here = horizon_.heights().column(x) + y, *const ahead = horizon_.heights().column(x + 1) + y;
        const float a = here[0], c = here[1], b = ahead[0], d = ahead[1];
        // The strips that the cell lies in.
        constexpr double beside = 0x1p-8;
        const double from = y - horizon_.first_strip() - grid_.slope * x;
        float met = std::numeric_limits<float>::infinity(), may_meet = -met;
        const int last = static_cast<int>(from + 1 + beside);
        for (int strip = static_cast<int>(from - grid_.slope - beside); strip <= last; ++strip) {
            const horizon_bound& bound = horizon_.bound(x, strip);
            met = bound.met < met ? bound.met : met;
            may_meet = bound.may_meet > may_meet ? bound.may_meet : may_meet;
        }
        const auto margin = static_cast<float>(horizon_.margin());
        const auto of = [&](float p, float q, float r, float along_x, float along_y, float base) {
            const float highest = (std::max)((std::max)(p, q), r), lowest = (std::min)((std::min)(p, q), r);
            const float rise = along_x + static_cast<float>(grid_.slope) * along_y;
            const auto dx = static_cast<float>(eye_.x - x), dy = static_cast<float>(eye_.y - y);
            const float error = 4 * margin * (2 + numeric::magnitude(dx) + numeric::magnitude(dy));
            const bool is_above = base + along_x * dx + along_y * dy < static_cast<float>(eye_u_) - error;
            const auto enough = static_cast<float>(rise_);
            const bool is_facing = rise > enough, is_averted = rise < -enough;
            if (is_above && is_averted) return known::dark;
            if ((is_above || is_facing) && highest < met - margin) return known::dark;
            return is_above && is_facing && lowest > may_meet + margin ? known::lit : known::nothing;
        };
        known lower, upper;
        if (grid_.is_rising) {
            lower = of(a, b, d, b - a, d - b, a);
            upper = of(a, d, c, d - c, c - a, a);
        } else {
            lower = of(a, b, c, b - a, c - a, a);
            upper = of(b, d, c, d - c, d - b, b + c - d);
        }
        known* const cell = into + triangle_of(x, y);
        cell[0] = lower_is_first_ ? lower : upper;
        cell[1] = lower_is_first_ ? upper : lower;
    }

    const horizon_bounds& horizon_;
    const lit_grid& grid_;
    int columns_;
    glm::dvec2 eye_{0};  ///< in the grid's steps
    double eye_u_ = 0;
    double rise_ = 0;  ///< of u along the light, a column, above which a triangle faces it
    bool lower_is_first_ = true;
};

}  // namespace shadow::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
