// Hard shadows without a map: whether a triangle stands between a point and the light, asked in doubles of every
// triangle that might.
//
// The rule. A point is dark if its own facet faces away from the light or is grazed by it, or if its ray towards the
// light passes through a triangle, edges included, that the point lies behind by more than rounding can have moved it
// (2^-40 of the scene's size). It is lit otherwise. There is no bias: a point's own facet holds the point to 2^-49, and
// neighbours in its plane meet the ray at their edges alone. Of solids only the sides that face away from the light
// are asked: a ray that starts outside of one and runs through it leaves it through a lit side and so has entered it
// through one of those.
//
// Why none is missed. A triangle's box on the light's plane (light_rays) holds every ray through it, rounding included,
// and a point is compared with every triangle in whose box it is. Why nothing leaks between neighbours: whether a ray
// passes an edge on its left is the sign of toward . (a x b) over the edge's ends as seen from the point; for the
// triangle on the other side the ends change places, which changes the sign of each rounded product and of the sum and
// nothing else; and a zero counts for both.
//
// Based on: Sven Woop, Carsten Benthin, Ingo Wald. Watertight Ray/Triangle Intersection. JCGT 2, 2013.
#pragma once

#include <insonify/geometry/transform.hpp>
#include <insonify/shadow/light_rays.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::shadow {

/// A mesh's corners in the frame in which the light is described, in doubles.
template <executor_argument E = serial_executor>
std::vector<glm::dvec3> placed_corners(const mesh_view& m, const affine& placement, E&& ex = {}) {
    std::vector<glm::dvec3> corners(m.positions.size());
    bulk_ranges(ex, corners.size(), 16384, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) corners[i] = transform_point(placement, m.positions[i]);
    });
    return corners;
}

/// How far from the origin the farthest finite corner lies, along an axis.
inline double reach_of(std::span<const glm::dvec3> corners) {
    double reach = 0;
    for (const glm::dvec3& c : corners)
        for (int i = 0; i < 3; ++i) {
            const double size = numeric::magnitude(c[i]);
            if (size > reach && numeric::is_finite(size)) reach = size;
        }
    return reach;
}

/// Whether light falls on the side of a triangle from which it is seen, more than grazing it: corners that were rounded
/// to float are off by 2^-24, and what is parallel to the light but for that is dark.
/// @param normal  of the triangle, of any length
/// @param toward  to the light, and `back` to whoever sees it
inline bool is_faced(const glm::dvec3& normal, const glm::dvec3& toward, const glm::dvec3& back) {
    const double along = numeric::dot(normal, toward), grazed = 0x1p-22;
    const bool seen_from_above = numeric::dot(normal, back) > 0;
    const double facing = seen_from_above ? along : -along;
    return facing > 0 &&
           facing * facing > grazed * grazed * numeric::dot(normal, normal) * numeric::dot(toward, toward);
}

/// One mesh as what may stand in one light.
class light_blockers {
  public:
    /// Stands in nobody's light.
    light_blockers() = default;

    /// @param rays         of the light; corners lie within its reach, or aren't asked
    /// @param corners      of the mesh, see placed_corners; both have to outlive this
    /// @param is_solid     nothing that can be asked about lies inside or below it
    /// @param is_mirrored  the placement turned its triangles round
    /// @param ex           who makes the trees; they are the same for any executor
    template <executor E>
    light_blockers(const light_rays& rays, const mesh_view& m, std::span<const glm::dvec3> corners, bool is_solid,
                   bool is_mirrored, E& ex)
        : triangles_(m.triangles), corners_(corners) {
        constexpr std::size_t grain = 16384;
        trees_.resize(rays.planes());
        std::vector<std::vector<topped_box>> parts((triangles_.size() + grain - 1) / grain);
        for (std::size_t plane = 0; plane < trees_.size(); ++plane) {
            bulk_ranges(ex, triangles_.size(), grain, [&](std::size_t first, std::size_t last) {
                std::vector<topped_box>& part = parts[first / grain];
                part.clear();
                part.reserve(last - first);
                for (std::size_t i = first; i < last; ++i) {
                    const glm::uvec3& t = triangles_[i];
                    const glm::dvec3 &a = corners_[t.x], &b = corners_[t.y], &c = corners_[t.z];
                    if (!is_within(a, rays) || !is_within(b, rays) || !is_within(c, rays)) continue;
                    if (is_solid) {
                        const glm::dvec3 normal = numeric::cross(b - a, c - a);
                        const double facing = numeric::dot(normal, rays.toward(a));
                        if (is_mirrored ? facing < 0 : facing > 0) continue;
                    }
                    if (std::optional<topped_box> box = rays.over(plane, a, b, c)) {
                        box->name = static_cast<std::uint32_t>(i);
                        part.push_back(*box);
                    }
                }
            });
            trees_[plane] = box_tree(joined(parts, ex), ex);
        }
    }

    /// Which of up to N points have something between them and the light.
    /// @param from    where they are; they should be neighbours
    /// @param points  bit k: ask about from[k]
    template <int N>
    INSONIFY_INLINE unsigned stop(const light_rays& rays, const glm::dvec3* from, unsigned points) const {
        unsigned dark = 0;
        for (std::size_t plane = 0; plane < trees_.size(); ++plane) {
            point_range at[static_cast<unsigned>(N)];
            unsigned over = 0;
            for (unsigned rest = points; rest != 0; rest &= rest - 1) {
                const int k = std::countr_zero(rest);
                if (rays.plane_of(from[k]) != plane) continue;
                at[k] = rays.range_of(plane, from[k]);
                over |= 1u << k;
            }
            dark |= trees_[plane].template find<N>(
                at, over, [&](std::uint32_t name, int k) { return blocks(triangles_[name], rays, from[k]); });
        }
        return dark;
    }

  private:
    static bool is_within(const glm::dvec3& p, const light_rays& rays) {
        for (int i = 0; i < 3; ++i)
            if (!(p[i] <= rays.reach() && p[i] >= -rays.reach())) return false;
        return true;
    }

    template <executor E>
    static std::vector<topped_box> joined(const std::vector<std::vector<topped_box>>& parts, E& ex) {
        std::vector<std::size_t> starts(parts.size() + 1, 0);
        for (std::size_t i = 0; i < parts.size(); ++i) starts[i + 1] = starts[i] + parts[i].size();
        std::vector<topped_box> all(starts.back());
        ex.bulk(parts.size(), [&](std::size_t i) {
            std::copy(parts[i].begin(), parts[i].end(), all.begin() + static_cast<std::ptrdiff_t>(starts[i]));
        });
        return all;
    }

    bool blocks(const glm::uvec3& t, const light_rays& rays, const glm::dvec3& from) const {
        const glm::dvec3 toward = rays.toward(from);
        const glm::dvec3 a = corners_[t.x] - from, b = corners_[t.y] - from, c = corners_[t.z] - from;
        const double bc = numeric::dot(toward, numeric::cross(b, c));
        const double ca = numeric::dot(toward, numeric::cross(c, a));
        const double ab = numeric::dot(toward, numeric::cross(a, b));
        const bool is_left = bc >= 0 && ca >= 0 && ab >= 0, is_right = bc <= 0 && ca <= 0 && ab <= 0;
        if (!is_left && !is_right) return false;
        const glm::dvec3 normal = numeric::cross(b - a, c - a);
        const double along = numeric::dot(normal, toward), behind = numeric::dot(normal, a);
        const double sign = is_left ? 1 : -1;
        const double hair =
            0x1p-40 * (numeric::magnitude(normal.x) + numeric::magnitude(normal.y) + numeric::magnitude(normal.z));
        if (!(sign * along > 0 && sign * behind > hair * rays.reach())) return false;
        // What the light itself touches doesn't stop it.
        return !rays.end() || sign * (along - behind) > hair * rays.size();
    }

    std::span<const glm::uvec3> triangles_;
    std::span<const glm::dvec3> corners_;
    std::vector<box_tree> trees_;  ///< one for each plane of the light
};

}  // namespace insonify::inline INSONIFY_ABI::shadow

INSONIFY_ARITHMETIC_END
