// An immutable mesh shared by many objects, with the properties that renderers need.
#pragma once

#include <insonify/geometry/bounds.hpp>
#include <insonify/geometry/detail/coherent_order.hpp>
#include <insonify/geometry/detail/lattice_order.hpp>
#include <insonify/geometry/normals.hpp>
#include <insonify/geometry/regular_grid.hpp>
#include <insonify/geometry/surface_kind.hpp>

#include <memory>
#include <optional>
#include <utility>

namespace insonify {
inline namespace INSONIFY_ABI {

/// An immutable mesh: copies refer to the same triangles. A mesh whose triangles follow one another without order, as
/// those of a shuffled one, is renumbered, triangles and vertices, and so is a regular grid that comes in another order
/// than its rows'; otherwise a mesh keeps its numbers. Triangles that are
/// wound against all of their normals are turned over. What renderers need of it is found once, when it is made: its
/// bounds, smooth normals if it brings none, whether it is closed or a heightfield, and the regular grid that a
/// heightfield's vertices lie on, if they do.
class shared_mesh {
  public:
    /// No triangles.
    shared_mesh() : state_(empty()) {}
    /// @throws invalid_input for indices or normals that don't match the positions
    shared_mesh(mesh m) : state_(std::make_shared<const state>(std::move(m))) {}

    const mesh& operator*() const { return state_->shape; }
    const mesh* operator->() const { return &state_->shape; }
    operator mesh_view() const { return state_->shape; }

    /// Around all finite positions, in the mesh's own frame.
    const bounding_box& box() const { return state_->box; }
    surface_kind kind() const { return state_->kind; }
    /// The grid of a heightfield whose vertices lie on one, within `grid_error` steps; null otherwise.
    const regular_grid* grid() const { return state_->grid ? &*state_->grid : nullptr; }
    static constexpr double grid_error = 0x1p-12;

  private:
    struct state {
        mesh shape;
        bounding_box box;
        surface_kind kind = surface_kind::open;
        std::optional<regular_grid> grid;

        state() = default;
        explicit state(mesh m) : shape(std::move(m)) {
            validate(shape);
            box = bounds(shape);
            grid = regular_grid_of(shape, serial_executor{}, grid_error);
            if (!grid && detail::order_by_lattice(shape))
                grid = regular_grid_of(shape, serial_executor{}, grid_error);
            else if (!grid && detail::is_incoherent(shape))
                detail::order_along_curve(shape, box);
            if (shape.normals.empty())
                shape.normals = smooth_normals(shape);
            else
                wind_by_normals(shape);
            kind = kind_of(shape);
            if (kind != surface_kind::heightfield) grid.reset();
        }
    };
    static std::shared_ptr<const state> empty() { return std::make_shared<const state>(); }

    std::shared_ptr<const state> state_;
};

}  // namespace INSONIFY_ABI
}  // namespace insonify
