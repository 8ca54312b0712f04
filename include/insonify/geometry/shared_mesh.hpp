// A mesh that many objects share and none changes, with what is known of it.
#pragma once

#include <insonify/geometry/bounds.hpp>
#include <insonify/geometry/normals.hpp>
#include <insonify/geometry/surface_kind.hpp>

#include <memory>
#include <utility>

namespace insonify {
inline namespace INSONIFY_ABI {

/// An immutable mesh: copies refer to the same triangles. What renderers need of it is found once, when it is made: its
/// bounds, smooth normals if it brings none, and whether it is closed or a heightfield.
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

  private:
    struct state {
        mesh shape;
        bounding_box box;
        surface_kind kind = surface_kind::open;

        state() = default;
        explicit state(mesh m) : shape(std::move(m)) {
            validate(shape);
            if (shape.normals.empty()) shape.normals = smooth_normals(shape);
            box = bounds(shape);
            kind = kind_of(shape);
        }
    };
    static std::shared_ptr<const state> empty() { return std::make_shared<const state>(); }

    std::shared_ptr<const state> state_;
};

}  // namespace INSONIFY_ABI
}  // namespace insonify
