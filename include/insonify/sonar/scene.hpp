// The scene: a seabed and targets.
#pragma once

#include <insonify/geometry/shared_mesh.hpp>
#include <insonify/geometry/transform.hpp>
#include <insonify/seabed/any.hpp>
#include <insonify/seabed/flat.hpp>
#include <insonify/sonar/sediment.hpp>

#include <limits>
#include <string>
#include <utility>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// An object with a class. Its mesh may be open or closed; both sides of its triangles are visible and cast shadows.
struct target {
    shared_mesh shape;
    pose placement;
    std::string class_name;
    material surface{.reflectivity = 0.9f};
};

/// Heights are metres above the datum z = 0.
struct scene {
    insonify::seabed::any seabed = insonify::seabed::flat{};
    /// Materials by label, seabed::index_of(type). Labels of your own have the reflectivity that your seabed states,
    /// unless it is set here.
    bottom_materials bottom = default_bottom();
    std::vector<target> targets;

    /// Adds a mesh, a shared mesh, or a shape with a `to_mesh`: cube, cylinder, cone, sphere, your own. Instances are
    /// numbered from 1. A mesh without normals gets smooth ones, also across sharp edges whose triangles share
    /// vertices; `with_creases` keeps those sharp. To draw one mesh many times, make a `shared_mesh` once and add it
    /// repeatedly. Renderers take up to 65534 targets.
    /// @returns the target; the next call may move it
    /// @throws invalid_input for a mesh whose indices or normals don't match its positions
    template <class Shape>
    INSONIFY_MEMBER target& add(Shape&& shape, const pose& placement, std::string class_name,
                                const material& surface = {0.9f}) {
        targets.push_back({mesh_of(std::forward<Shape>(shape)), placement, std::move(class_name), surface});
        return targets.back();
    }

    template <class Shape>
    INSONIFY_MEMBER static shared_mesh mesh_of(Shape&& shape) {
        if constexpr (std::is_convertible_v<Shape&&, shared_mesh>)
            return std::forward<Shape>(shape);
        else
            return shared_mesh::of(shape);
    }
};

inline namespace INSONIFY_ONCE {

/// @throws invalid_input for a material whose reflectivity is negative or not finite, or a pose out of range. Renderers
///         check meshes and seabeds
INSONIFY_FUNCTION void validate(const scene& s);

/// The material of each label: the scene's, or that of the seabed's model where the scene sets none.
/// @throws invalid_input for a reflectivity of the seabed that is negative or not finite, or for a label of the library
///         with other properties than the library's
INSONIFY_FUNCTION bottom_materials resolved_bottom(const scene& s);

/// The same pose, lowered or raised so that one vertex touches the seabed and none is below it. `burial` then sinks it.
/// Vertices over gaps, or beyond 1e9 m, do not count; without any other the pose is returned as it is.
/// @param shape  a mesh, a shared mesh, or a view of one; of at least one position
/// @throws invalid_input for a shape without positions, or a pose out of range
INSONIFY_FUNCTION pose rest_on(const insonify::seabed::any& seabed, const mesh_view& shape, pose placement);

#if INSONIFY_BODIES
INSONIFY_FUNCTION void validate(const scene& s) {
    const auto check = [](const material& m, std::string_view owner, std::string_view member) {
        detail::require_member(m.reflectivity >= 0 && numeric::is_finite(m.reflectivity), owner, member, m.reflectivity,
                               "0 or more, finite");
    };
    for (std::size_t i = 0; i < s.bottom.size(); ++i)
        if (s.bottom[i].reflectivity != by_seabed_model)
            check(s.bottom[i], detail::element_name("scene.bottom", i), ".reflectivity");
    for (std::size_t i = 0; i < s.targets.size(); ++i) {
        const std::string name = detail::element_name("scene.targets", i);
        check(s.targets[i].surface, name, ".surface.reflectivity");
        validate(s.targets[i].placement, name + ".placement");
    }
}

INSONIFY_FUNCTION bottom_materials resolved_bottom(const scene& s) {
    bottom_materials all = s.bottom;
    std::vector<insonify::seabed::type_properties> legend;
    insonify::seabed::extend(legend, s.seabed.legend());  // refuses a label that is listed with two sets of properties
    for (const insonify::seabed::type_properties& t : legend) {
        detail::require(t.reflectivity >= 0 && numeric::is_finite(t.reflectivity), "type_properties.reflectivity",
                        t.reflectivity, "0 or more, finite");
        const std::size_t label = insonify::seabed::index_of(t.label);
        detail::require(label >= insonify::seabed::first_user_label || t == insonify::seabed::properties_of(t.label),
                        "type_properties.label", label, "user_type(n), as its properties are not the library's");
        material& m = all[label];
        if (m.reflectivity == by_seabed_model) m = {t.reflectivity};
    }
    for (std::size_t i = 0; i < all.size(); ++i)
        if (all[i].reflectivity == by_seabed_model)
            all[i] = {insonify::seabed::properties_of(static_cast<insonify::seabed::type>(i)).reflectivity};
    return all;
}

INSONIFY_FUNCTION pose rest_on(const insonify::seabed::any& seabed, const mesh_view& shape, pose placement) {
    detail::require(!shape.positions.empty(), "shape.positions.size()", shape.positions.size(), "at least 1");
    detail::require_finite("pose.burial", placement.burial);
    insonify::seabed::detail::require_position("pose.position", glm::dvec2(placement.position));
    pose bare = placement;
    bare.burial = 0;
    const affine map = to_world(bare);
    const auto bottom = seabed.prepare();
    double clearance = std::numeric_limits<double>::infinity();
    for (const glm::vec3& p : shape.positions) {
        const glm::dvec3 world = transform_point(map, glm::dvec3(p));
        if (!(numeric::abs(world.x) <= 1e9 && numeric::abs(world.y) <= 1e9)) continue;  // NaN, too
        const float height = insonify::seabed::at(bottom, world.x, world.y).height;
        if (numeric::is_finite(height)) clearance = (std::min)(clearance, world.z - static_cast<double>(height));
    }
    if (numeric::is_finite(clearance)) placement.position.z -= clearance;
    return placement;
}
#endif

}  // namespace INSONIFY_ONCE

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
