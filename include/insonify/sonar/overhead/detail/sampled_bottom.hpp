// The seabed of an overhead picture: sampled on a grid, as a mesh in the rig's frame.
#pragma once

#include <insonify/geometry/bounds.hpp>
#include <insonify/geometry/mesh.hpp>
#include <insonify/geometry/regular_grid.hpp>
#include <insonify/seabed/any.hpp>
#include <insonify/seabed/sample.hpp>
#include <insonify/seabed/tessellate.hpp>
#include <insonify/sonar/overhead/detail/shading.hpp>

#include <algorithm>
#include <optional>

#include <glm/vec2.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// The ground that may be in view, relative to the rig's position.
inline ground_rect shown_ground(const overhead_geometry& view, const seabed::height_range& range) {
    ground_rect shown;
    for (const int right : {-1, 1})
        for (const int up : {-1, 1})
            for (const double height : {range.lowest, range.highest}) shown.include(view.corner(height, right, up));
    return shown;
}

/// The longer side of a picture's footprint, metres.
inline double longer_side(const overhead_geometry& view) {
    return 2 * (std::max)(view.half_extent(0).x, view.half_extent(0).y);
}
/// Lower bound of the spacing of the seabed's vertices, metres.
inline double min_cell(const overhead_geometry& view) {
    return longer_side(view) / 32768;
}

/// Sampled heights and their mesh; empty until `sample` is called.
class sampled_bottom {
  public:
    explicit sampled_bottom(const shared_pool& memory) : mesh_(memory) {}

    /// Samples a part of the ground at multiples of the spacing, counted from `position`: the position of a vertex
    /// depends neither on the extent that is sampled nor on the distance to the world's origin.
    /// @throws invalid_input for more than 2^20 vertices along an axis, or 2^28 in all
    template <executor E>
    void sample(const seabed::any& source, const glm::dvec2& position, const ground_rect& ground, double spacing,
                E& ex) {
        seabed::grid grid{.origin = position, .spacing = spacing, .band_limited = true};
        const auto along = [&](int axis) {
            const double vertices = (ground.upper[axis] - ground.lower[axis]) / spacing + 4;
            require(vertices <= 1 << 20, "vertices of the seabed along an axis", vertices,
                    "at most 2^20; reduce `reach` or enlarge `cell`");
            // A vertex more on each side, so that normals in view are not one-sided differences.
            const double first = static_cast<double>(numeric::floor_to_int(ground.lower[axis] / spacing + 1e-6)) - 1;
            const double count = 2 - static_cast<double>(numeric::floor_to_int(-ground.upper[axis] / spacing)) - first;
            first_[axis] = static_cast<int>(first);
            return static_cast<int>(count);
        };
        grid.width = along(0);
        grid.height = along(1);
        grid.first = first_;
        seabed::detail::require_vertices(
            static_cast<double>(grid.width) * grid.height,
            "bring `overhead.altitude` and the seabed's range() nearer to each other, reduce `reach` or "
            "enlarge `cell`");
        field_ = seabed::sample(source, grid, ex);
        seabed::detail::tessellate_into(mesh_, field_, ex, first_);
        bool has_gaps = false;
        for (const float height : field_.heights.pixels()) {
            if (height != height) {
                has_gaps = true;
                continue;
            }
            lowest_ = (std::min)(lowest_, height);
            highest_ = (std::max)(highest_, height);
        }
        kind_ = has_gaps ? surface_kind::open : surface_kind::heightfield;
        if (!has_gaps) find_grid();
    }

    const seabed::heightfield& field() const { return field_; }
    /// Whether what is below may be seen: there are vertices without data, or no samples at all.
    bool is_open() const { return field_.heights.empty() || kind_ == surface_kind::open; }
    /// Bounds of the vertices' heights and the datum.
    float lowest() const { return lowest_; }
    float highest() const { return highest_; }

    /// The mesh, below a rig at the position that was sampled from. Refers to this object.
    placed_mesh placed_under(const overhead_geometry& view) const {
        const glm::ivec2 last = first_ + glm::ivec2(field_.heights.width() - 1, field_.heights.height() - 1);
        return {mesh_,
                {{field_.spacing * glm::dvec2(first_), lowest_}, {field_.spacing * glm::dvec2(last), highest_}},
                view.rig_from({glm::dmat3(1), glm::dvec3(view.rig().position, 0)}),
                kind_,
                grid_ ? &*grid_ : nullptr};
    }

  private:
    /// The lattice of the vertices, if float holds their coordinates to 2^-12 steps.
    void find_grid() {
        const glm::ivec2 size(field_.heights.width(), field_.heights.height());
        const glm::ivec2 last = first_ + size;
        const int farthest = (std::max)((std::max)(-first_.x, last.x), (std::max)(-first_.y, last.y));
        if (farthest >= 1 << 11) return;
        grid_ = regular_grid{.columns = size.x,
                             .rows = size.y,
                             .origin = field_.spacing * glm::dvec2(first_),
                             .right = {field_.spacing, 0},
                             .up = {0, field_.spacing},
                             .lattice_error = 0x1p-23 * farthest};  // rounded to float, in either direction
    }

    seabed::heightfield field_;
    uninitialized_mesh mesh_;
    glm::ivec2 first_{0, 0};  ///< lattice coordinates of the first vertex, from the rig's position
    float lowest_ = 0, highest_ = 0;
    surface_kind kind_ = surface_kind::heightfield;
    std::optional<regular_grid> grid_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
