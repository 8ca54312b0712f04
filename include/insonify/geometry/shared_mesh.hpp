// An immutable mesh shared by many objects, with the properties that renderers need.
#pragma once

#include <insonify/config.hpp>
#if INSONIFY_BODIES
#include <insonify/geometry/detail/coherent_order.hpp>
#include <insonify/geometry/detail/lattice_order.hpp>
#include <insonify/geometry/normals.hpp>
#endif
#include <insonify/fwd.hpp>
#include <insonify/geometry/bounds.hpp>
#include <insonify/geometry/regular_grid.hpp>
#include <insonify/geometry/surface_kind.hpp>

#include <concepts>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail {

/// State that copies of a shared mesh refer to.
struct mesh_properties {
    mesh shape;
    bounding_box box;
    surface_kind kind = surface_kind::open;
    std::optional<regular_grid> grid;

    static constexpr double grid_error = 0x1p-12;  ///< see shared_mesh::grid
};

}  // namespace detail

namespace detail::inline INSONIFY_ONCE {

/// @throws invalid_input for indices or normals that don't match the positions
INSONIFY_FUNCTION std::shared_ptr<const mesh_properties> mesh_properties_of(mesh m);
/// The same for the mesh of a primitive, of which only the bounds have to be computed.
INSONIFY_FUNCTION std::shared_ptr<const mesh_properties> primitive_properties_of(mesh m);

#if INSONIFY_BODIES
/// Whether a heightfield, whose outline is convex, extends over all of its box, seen from above.
inline bool fills_box(const mesh& m, const bounding_box& box) {
    bool has_corner[4] = {};
    for (const glm::uvec3& t : m.triangles)
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 p(m.positions[t[i]]);
            for (int corner = 0; corner < 4; ++corner) {
                const glm::dvec3 at = box.corner(corner);
                has_corner[corner] = has_corner[corner] || (p.x == at.x && p.y == at.y);
            }
        }
    return has_corner[0] && has_corner[1] && has_corner[2] && has_corner[3];
}

INSONIFY_FUNCTION std::shared_ptr<const mesh_properties> mesh_properties_of(mesh m) {
    const auto made = std::make_shared<mesh_properties>();
    mesh_properties& properties = *made;
    properties.shape = std::move(m);
    validate(properties.shape);
    properties.box = bounds(properties.shape);
    if (!properties.shape.normals.empty())
        wind_by_normals(properties.shape);  // first: triangles of a grid are counter-clockwise
    properties.grid = regular_grid_of(properties.shape, mesh_properties::grid_error);
    if (!properties.grid && order_by_lattice(properties.shape))
        properties.grid = regular_grid_of(properties.shape, mesh_properties::grid_error);
    else if (!properties.grid && is_incoherent(properties.shape))
        order_along_curve(properties.shape, properties.box);
    if (properties.shape.normals.empty()) properties.shape.normals = smooth_normals(properties.shape);
    properties.kind = kind_of(properties.shape);
    // Without a grid or a box-shaped outline, renderers would have to search for the surface below a position.
    if (properties.kind == surface_kind::heightfield && !properties.grid &&
        !fills_box(properties.shape, properties.box))
        properties.kind = surface_kind::open;
    if (properties.kind != surface_kind::heightfield) properties.grid.reset();
    return made;
}

INSONIFY_FUNCTION std::shared_ptr<const mesh_properties> primitive_properties_of(mesh m) {
    const auto made = std::make_shared<mesh_properties>();
    made->box = bounds(m);
    made->shape = std::move(m);
    made->kind = surface_kind::closed;
    return made;
}
#endif

}  // namespace detail::inline INSONIFY_ONCE

namespace detail {

template <class Shape, class... Others>
inline constexpr bool is_among = (std::is_same_v<Shape, Others> || ...);
/// Shapes whose meshes are closed, have normals, are wound by them and have a coherent order, whatever their sizes.
template <class Shape>
inline constexpr bool is_primitive = is_among<Shape, cube, cylinder, capsule, cone, sphere, hemisphere>;

/// Shapes that `to_mesh` takes.
template <class Shape>
concept has_mesh = requires(const Shape& shape) {
    { to_mesh(shape) } -> std::convertible_to<shared_mesh>;
};

}  // namespace detail

/// An immutable mesh: copies refer to the same triangles. Shuffled meshes are reordered, triangles and vertices, for
/// coherent access; regular grids are reordered by rows; other meshes keep their order. Triangles that are wound
/// against all of their normals are flipped. The constructor computes what renderers need: bounds, smooth normals if
/// there are none, whether the mesh is closed or a heightfield, and the regular grid of a heightfield. One that was
/// moved from may only be assigned to or destroyed.
class shared_mesh {
  public:
    /// No triangles.
    shared_mesh() : properties_(std::make_shared<detail::mesh_properties>()) {}
    /// @throws invalid_input for indices or normals that don't match the positions
    INSONIFY_MEMBER shared_mesh(mesh m) : properties_(detail::mesh_properties_of(std::move(m))) {}
    /// The mesh of a shape with a `to_mesh`. Primitives skip the analysis, whose results follow from their type; a
    /// program that has no other shapes does not compile it.
    template <class Shape>
    INSONIFY_MEMBER static shared_mesh of(const Shape& shape) {
        static_assert(detail::has_mesh<Shape>,
                      "a target's shape is a mesh, a shared_mesh, or of a type with a function to_mesh(const T&) in "
                      "its namespace that returns one of them");
        if constexpr (detail::is_primitive<Shape>)
            return shared_mesh(detail::primitive_properties_of(to_mesh(shape)));
        else if constexpr (detail::has_mesh<Shape>)
            return shared_mesh(to_mesh(shape));
        else
            return {};  // so that the message above is the only error
    }
    /// The same as the constructor.
    INSONIFY_MEMBER static shared_mesh of(mesh m) { return shared_mesh(std::move(m)); }

    const mesh& operator*() const { return properties_->shape; }
    const mesh* operator->() const { return &properties_->shape; }
    operator mesh_view() const { return properties_->shape; }

    /// Around all finite positions, in the mesh's own frame.
    const bounding_box& box() const { return properties_->box; }
    /// Heightfields whose outline is neither their grid's nor that of the box count as open.
    surface_kind kind() const { return properties_->kind; }
    /// The grid of a heightfield whose vertices lie on one, within `grid_error` steps; null otherwise. Turn a mesh by
    /// its pose: turned vertices are rounded, which leaves the outline concave, and then there is no grid.
    const regular_grid* grid() const { return properties_->grid ? &*properties_->grid : nullptr; }
    static constexpr double grid_error = detail::mesh_properties::grid_error;

  private:
    INSONIFY_MEMBER explicit shared_mesh(std::shared_ptr<const detail::mesh_properties> properties)
        : properties_(std::move(properties)) {}

    std::shared_ptr<const detail::mesh_properties> properties_;
};

}  // namespace INSONIFY_ABI
}  // namespace insonify
