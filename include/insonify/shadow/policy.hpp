// What a shadow policy is: casters and a light go in, points are tested, and each comes back with its share of the
// light and the caster that blocks it.
//
// A policy is a plain value that builds a structure for one light; the structure answers for any number of batches of
// points. The built-in policies (map, pcf, exact, penumbra) are models of these concepts, and so are those of users.
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
#include <variant>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow {

/// Where there is no caster, no mesh or no triangle.
inline constexpr std::uint32_t invalid_id = 0xFFFFFFFFu;

/// Which triangles of a caster a test may leave out, because others block the same points.
enum class skip {
    nothing,         ///< both sides of all triangles block
    facing,          ///< those whose front the light meets: the mesh is closed, and no point lies inside of it
    facing_its_own,  ///< the same for points on the caster itself: it is a heightfield, lit and seen from above
};

/// A mesh that blocks light, in the frame in which the light is described. Both sides of its triangles block.
/// Triangles with a corner that is not finite block nothing.
struct caster {
    mesh_view mesh;
    affine placement;  ///< from the mesh's frame to the light's
    bounding_box box;  ///< around the mesh, in its own frame
    skip may_skip = skip::nothing;
    const regular_grid* grid = nullptr;  ///< on which the vertices lie, see shared_mesh; or null
};

/// Points to test, as arrays of equal length.
struct points {
    std::span<const double> x, y, z;          ///< metres
    std::span<const std::uint32_t> mesh;      ///< number of the caster that a point lies on, or invalid_id
    std::span<const std::uint32_t> triangle;  ///< of that caster; it does not block its own points
    std::uint32_t casters = invalid_id;       ///< casters numbered below this matter; others need not be tested
    bool face_light = true;                   ///< their own facets do; else only the caster's name matters

    INSONIFY_MEMBER std::size_t size() const { return x.size(); }
    INSONIFY_MEMBER glm::dvec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// What becomes of points, as arrays of the same length as theirs.
struct shares {
    std::span<float> lit;             ///< fraction of the light that arrives, 0 to 1
    std::span<std::uint32_t> caster;  ///< lowest number of a caster that blocks the light's centre, or invalid_id

    INSONIFY_MEMBER std::size_t size() const { return lit.size(); }
};

/// Where points will be tested, and how. `level` changes no answer.
struct point_bounds {
    bounding_box box;        ///< around all of them
    double spacing = 0;      ///< metres from one to the next on level ground; 0 if unknown
    isa level = best_isa();  ///< the widest instruction set to use
};

inline namespace INSONIFY_FLAGS {

/// Normal of the facet that point i lies on, of any length, in the frame of the light; 0 if it lies on none. Its sign
/// is that of the triangle's order, whichever side is seen.
inline glm::dvec3 facet_of(std::span<const caster> casters, const points& at, std::size_t i) {
    if (at.mesh[i] >= casters.size() || at.triangle[i] == invalid_id) return glm::dvec3(0);
    const caster& c = casters[at.mesh[i]];
    const glm::uvec3& t = c.mesh.triangles[at.triangle[i]];
    const auto corner = [&](int k) { return transform_point(c.placement, glm::dvec3(c.mesh.positions[t[k]])); };
    const glm::dvec3 a = corner(0);
    return numeric::cross(corner(1) - a, corner(2) - a);
}

/// A light of any kind.
using any_light = std::variant<directional_light, point_light>;

/// `structure.test(points, shares)` fills in all shares; it may be called for several batches at the same time.
template <class S>
concept occlusion = requires(const S& structure, const points& at, const shares& into) {
    structure.test(at, into);
};

/// `policy.build(casters, light, bounds, executor)` gives an occlusion. All points that it will be asked about lie
/// within `bounds`; the casters' meshes outlive it. Surfaces that face away from the light are dark under every policy:
/// that is decided before, from the facet, and such a point is only tested for the name of its caster.
template <class P>
concept casting_policy = requires(const P& policy, std::span<const caster> casters, const any_light& light,
                                  const point_bounds& bounds, serial_executor& ex) {
    { policy.build(casters, light, bounds, ex) } -> occlusion;
};

class exact_occlusion;

}  // namespace INSONIFY_FLAGS

/// Hard shadows, exact for every point: the default. See exact.hpp, which makes it a model of casting_policy.
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

/// Radius of the light over its distance: 0, unless a policy has a `light_radius()`.
template <policy P>
double radius_of(const P& p) {
    if constexpr (requires { p.light_radius(); })
        return p.light_radius();
    else
        return 0;
}

}  // namespace INSONIFY_FLAGS

/// Occlusion that gains from seeing all points of a picture at once. `structure.screen(points, shares)` answers what
/// can be told of points one by one and leaves `unknown` where it cannot; `structure.test(batches, shares, executor)`
/// answers the rest, of all batches together.
template <class S>
concept collective_occlusion = occlusion<S> &&
    requires(const S& structure, const points& at, const shares& into, std::span<const points> all_at,
             std::span<const shares> all_into, serial_executor& ex) {
    structure.screen(at, into);
    structure.test(all_at, all_into, ex);
};
inline constexpr float unknown = -1;  ///< in shares::lit, between screening and testing

/// What may be known of a triangle or a point beforehand.
enum class known : std::uint8_t { lit, dark, nothing };

/// Collective occlusion that knows whole triangles: `structure.known_triangles(caster, eye, executor)` has an answer
/// for each triangle of a caster as the camera sees it, or none at all.
template <class S>
concept triangle_occlusion = collective_occlusion<S> &&
    requires(const S& structure, std::uint32_t caster, const glm::dvec3& eye, serial_executor& ex) {
    { structure.known_triangles(caster, eye, ex) } -> std::same_as<insonify::detail::uninitialized_vector<known>>;
};

}  // namespace shadow
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
