// The concept of a shadow policy: from casters and a light it builds an occlusion, which computes for any batch of
// points the fraction of the light that arrives and the caster that blocks it.
//
// The built-in policies (map, pcf, exact, penumbra) are models of these concepts, as are those of users:
//
//     struct my_policy {
//         my_occlusion build(std::span<const shadow::caster> casters, const shadow::any_light& light,
//                            const shadow::point_bounds& bounds, auto& executor) const;
//     };
//     render(scene, rig, render_options<my_policy>{});
//
// Parallel light is a shadow::directional_light; shadow::light_frame (light.hpp) has its direction as a vector. Casters
// are the targets in the order of the scene, then the seabed if there is one, all in the upright frame in which the
// light is described: the rig's in `render`.
#pragma once

#include <insonify/core/detail/uninitialized.hpp>
#include <insonify/core/executor.hpp>
#include <insonify/core/simd/dispatch.hpp>
#include <insonify/geometry/bounds.hpp>
#include <insonify/geometry/regular_grid.hpp>
#include <insonify/geometry/transform.hpp>
#include <insonify/shadow/light.hpp>

#include <cstdint>
#include <span>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow {

/// Stands for no caster, no mesh or no triangle.
inline constexpr std::uint32_t invalid_id = 0xFFFFFFFFu;

/// Triangles of a caster that a test may skip without changing the result: every ray that one of them blocks is blocked
/// by another, too. Points of the caster itself that face away from the light (points::face_light) are tested against
/// all of its triangles. A point exactly on an edge between a triangle that faces the light and one that does not may
/// get either result.
enum class skip {
    nothing,      ///< both sides of all triangles block
    facing,       ///< front faces towards the light: the mesh is closed, and no point lies inside
    facing_self,  ///< the same, for points on the caster itself: a heightfield, lit and seen from above
};

/// A mesh that blocks light, in the frame in which the light is described. Both sides of its triangles block.
/// Triangles with a corner that is not finite block nothing.
struct caster {
    mesh_view mesh;
    affine placement;  ///< from the mesh's frame to the light's
    bounding_box box;  ///< around the mesh, in its own frame
    skip may_skip = skip::nothing;
    const regular_grid* grid = nullptr;  ///< lattice of the vertices, see shared_mesh; or null
};

/// Points to test, as arrays of equal length.
struct points {
    std::span<const double> x, y, z;          ///< metres
    std::span<const std::uint32_t> mesh;      ///< index of the caster that a point lies on, or invalid_id
    std::span<const std::uint32_t> triangle;  ///< of that caster; it does not block its own points
    std::uint32_t casters = invalid_id;       ///< a test may skip casters from this index on
    bool face_light = true;                   ///< facets of the points face the light; if not, `lit` is ignored

    INSONIFY_MEMBER std::size_t size() const { return x.size(); }
    INSONIFY_MEMBER glm::dvec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// Results for points, as arrays of the same length.
struct results {
    std::span<float> lit;             ///< fraction of the light that arrives, 0 to 1
    std::span<std::uint32_t> caster;  ///< lowest index of the casters that block the light's centre, or invalid_id

    INSONIFY_MEMBER std::size_t size() const { return lit.size(); }
};

/// Region of the points that will be tested. `level` does not change results.
struct point_bounds {
    bounding_box box;        ///< around all of them
    double spacing = 0;      ///< metres from one to the next on level ground; 0 if unknown
    isa level = best_isa();  ///< the widest instruction set to use
};

inline namespace INSONIFY_FLAGS {

/// Normal of the facet that point i lies on, of any length, in the frame of the light; 0 if it lies on none. The sign
/// follows from the order of the vertices.
inline glm::dvec3 facet_of(std::span<const caster> casters, const points& at, std::size_t i) {
    if (at.mesh[i] >= casters.size() || at.triangle[i] == invalid_id) return glm::dvec3(0);
    const caster& c = casters[at.mesh[i]];
    const glm::uvec3& t = c.mesh.triangles[at.triangle[i]];
    const auto corner = [&](int k) { return transform_point(c.placement, glm::dvec3(c.mesh.positions[t[k]])); };
    const glm::dvec3 a = corner(0);
    return numeric::cross(corner(1) - a, corner(2) - a);
}

/// `structure.test(points, results)` sets all results. It may be called for several batches concurrently.
template <class S>
concept occlusion = requires(const S& structure, const points& at, const results& into) {
    structure.test(at, into);
};

/// `policy.build(casters, light, bounds, executor)` returns an occlusion. All points to test lie within `bounds`; the
/// casters' meshes outlive it. Surfaces that face away from the light are dark under every policy: their points are
/// tested only for the caster.
template <class P>
concept casting_policy = requires(const P& policy, std::span<const caster> casters, const any_light& light,
                                  const point_bounds& bounds, serial_executor& ex) {
    { policy.build(casters, light, bounds, ex) } -> occlusion;
};

class exact_occlusion;

}  // namespace INSONIFY_FLAGS

/// Hard shadows, exact for every point: the default. exact.hpp defines its `build`.
struct exact {
    /// See casting_policy.
    template <executor E>
    INSONIFY_TAGGED exact_occlusion build(std::span<const caster> casters, const any_light& light,
                                          const point_bounds& bounds, E& ex) const;
};

/// No shadows: nothing is built, tested or compiled.
struct none {};

/// A shadow policy: one that builds an occlusion of casters, or `none`.
template <class P>
concept policy = std::same_as<P, none> || casting_policy<P>;

inline namespace INSONIFY_FLAGS {

/// Radius of the light over its distance: `light_radius()` of the policy, or 0.
template <policy P>
double radius_of(const P& p) {
    if constexpr (requires { p.light_radius(); })
        return p.light_radius();
    else
        return 0;
}

}  // namespace INSONIFY_FLAGS

/// An occlusion that is faster for all points of a picture at once. `structure.screen(points, results)` decides points
/// that a cheap test can decide and sets the others to `unknown`; `structure.test(batches, results, executor)` decides
/// those, all batches together: at most `max_batches`, of at most `max_batch` points each.
template <class S>
concept collective_occlusion = occlusion<S> &&
    requires(const S& structure, const points& at, const results& into, std::span<const points> all_at,
             std::span<const results> all_into, serial_executor& ex) {
    structure.screen(at, into);
    structure.test(all_at, all_into, ex);
};
inline constexpr std::size_t max_batch = 65536;    ///< points, see collective_occlusion
inline constexpr std::size_t max_batches = 65536;  ///< see collective_occlusion
inline constexpr float unknown = -1;               ///< in results::lit, between screening and testing

/// Result of a test that may leave a triangle or a point undecided.
enum class decision : std::uint8_t { lit, dark, undecided };

/// A collective occlusion that decides whole triangles: `structure.decide_triangles(caster, eye, executor)` returns a
/// result for each triangle of a caster as seen by the camera, or an empty array.
template <class S>
concept triangle_occlusion = collective_occlusion<S> &&
    requires(const S& structure, std::uint32_t caster, const glm::dvec3& eye, serial_executor& ex) {
    { structure.decide_triangles(caster, eye, ex) } -> std::same_as<insonify::detail::uninitialized_array<decision>>;
};

}  // namespace shadow
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
