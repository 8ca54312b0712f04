// Casters for the shadow policies of an overhead picture.
#pragma once

#include <insonify/sonar/overhead/detail/point_pass.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Whether a position lies over a heightfield, whose outline is that of its grid or, without one, that of its box.
inline bool is_within_outline(const placed_mesh& m, const glm::dvec3& p) {
    if (m.grid == nullptr)
        return p.x >= m.box.lower.x && p.x <= m.box.upper.x && p.y >= m.box.lower.y && p.y <= m.box.upper.y;
    const regular_grid& g = *m.grid;
    const glm::dvec2 from = glm::dvec2(p) - g.origin;
    const double area = numeric::cross(g.right, g.up);
    const double column = numeric::cross(from, g.up) / area, row = numeric::cross(g.right, from) / area;
    return column >= g.lattice_error && column <= g.columns - 1 - g.lattice_error && row >= g.lattice_error &&
           row <= g.rows - 1 - g.lattice_error;
}

/// A mesh as a caster, and which of its triangles may be skipped for points that the camera sees.
///
/// A ray that starts outside of a closed mesh and hits it enters it through a triangle that faces away from the light,
/// so triangles that face the light may be skipped. What a camera outside of the mesh sees lies outside, unless the
/// near plane cuts the mesh open. The same holds for a heightfield's own points if camera and light are above it: rays
/// leave its bounds above the surface. From beside it, a camera may see its lower side, under its border.
inline shadow::caster as_caster(const overhead_geometry& view, const placed_mesh& m) {
    const view_from_object from(view, m.to_rig);
    const bool is_whole = transformed(m.box, m.to_rig).upper.z < view.highest_drawn();
    const auto is_outside = [&](const glm::dvec3& p) {
        bool outside = false;
        for (int i = 0; i < 3; ++i) outside = outside || p[i] < m.box.lower[i] || p[i] > m.box.upper[i];
        return outside;
    };
    const auto is_above = [&](const glm::dvec3& p) { return p.z > m.box.upper.z; };
    const bool is_lit_from_above = view.has_point_light() ? is_above(from.light) : from.light.z > 0;
    const bool is_lit_from_outside = !view.has_point_light() || is_outside(from.light);
    shadow::skip may_skip = shadow::skip::nothing;
    if (m.kind == surface_kind::closed && is_whole && is_outside(from.eye) && is_lit_from_outside)
        may_skip = shadow::skip::facing;
    if (m.kind == surface_kind::heightfield && is_whole && is_above(from.eye) && is_within_outline(m, from.eye) &&
        is_lit_from_above)
        may_skip = shadow::skip::facing_self;
    return {m.shape, m.to_rig, m.box, may_skip, m.grid};
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
