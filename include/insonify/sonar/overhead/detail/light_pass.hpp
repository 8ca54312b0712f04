// Casters for shadow policies, and memory for the results of points.
//
// A point in several shadows has the label of the target with the lowest index, else of its own surface, if that faces
// away from the light, else of the seabed.
#pragma once

#include <insonify/sonar/detail/shadow_terms.hpp>
#include <insonify/sonar/overhead/detail/point_pass.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A mesh as a caster, and which of its triangles may be skipped for points that the camera sees.
///
/// A ray that starts outside of a closed mesh and hits it enters it through a triangle that faces away from the light,
/// so triangles that face the light may be skipped. What a camera outside of the mesh sees lies outside. The same holds
/// for a heightfield's own points if camera and light are above it: rays leave its bounds above the surface.
inline shadow::caster as_caster(const overhead_geometry& view, const placed_mesh& m) {
    surface seen;
    seen.to_rig = m.to_rig;
    const point_finder from(view, seen);
    const auto is_outside = [&](const glm::dvec3& p) {
        bool outside = false;
        for (int i = 0; i < 3; ++i) outside = outside || p[i] < m.box.lower[i] || p[i] > m.box.upper[i];
        return outside;
    };
    const auto is_above = [&](const glm::dvec3& p) { return p.z > m.box.upper.z; };
    const bool is_lit_from_above = view.has_near_light() ? is_above(from.light) : from.light.z > 0;
    const bool is_lit_from_outside = !view.has_near_light() || is_outside(from.light);
    shadow::skip may_skip = shadow::skip::nothing;
    if (m.kind == surface_kind::closed && is_outside(from.eye) && is_lit_from_outside) may_skip = shadow::skip::facing;
    if (m.kind == surface_kind::heightfield && is_above(from.eye) && is_lit_from_above)
        may_skip = shadow::skip::facing_its_own;
    return {m.shape, m.to_rig, m.box, may_skip, m.grid};
}

/// Memory for the results of points.
struct light_arrays {
    uninitialized_array<float> lit;
    uninitialized_array<std::uint32_t> caster;

    explicit light_arrays(std::size_t points, const shared_pool& memory = {})
        : lit(points, memory), caster(points, memory) {}
    shadow::results part(std::size_t first, std::size_t count) {
        return {std::span(lit).subspan(first, count), std::span(caster).subspan(first, count)};
    }
};

/// Points that face the light concern all casters; those that face away only need the targets, for labels.
/// @param targets  casters numbered below this are targets
inline shadow::points batch(shadow::points all, bool face_light, std::uint32_t targets) {
    if (!face_light) all.casters = targets;
    all.face_light = face_light;
    return all;
}

/// Visits the batches of a list, and where their answers go.
template <class Visit>
void for_each_batch(const point_list& points, const shadow::results& all, std::uint32_t targets, const Visit& visit) {
    if (points.facing > 0)
        visit(batch(points.facing_points(), true, targets),
              shadow::results{all.lit.first(points.facing), all.caster.first(points.facing)});
    if (points.averted > 0)
        visit(batch(points.averted_points(), false, targets),
              shadow::results{all.lit.subspan(points.facing), all.caster.subspan(points.facing)});
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
