// Cross-sections of targets with the plane of a ping.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/geometry/detail/plane_tree.hpp>
#include <insonify/sonar/scene.hpp>
#include <insonify/sonar/side_scan/side_scan.hpp>

#include <map>
#include <memory>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Where the plane of a ping cuts a triangle. Vectors are (x, u, z) of the ping_frame, of any length.
struct cut_segment {
    struct end {
        double x, down;    ///< metres from the sonar
        glm::vec3 normal;  ///< interpolated
    };
    end a, b;
    glm::vec3 facet;  ///< normal of the triangle
};

/// A target in world coordinates, with a tree that finds the triangles that a ping's plane cuts.
class sliced_target {
  public:
    /// @param tree  of the shape's triangles
    sliced_target(const target& t, std::shared_ptr<const plane_tree> tree)
        : shape_(t.shape), tree_(std::move(tree)), to_world_(to_world(t.placement)) {
        const bounding_box& box = t.shape.box();
        if (box.empty()) return;
        centre_ = transform_point(to_world_, box.centre());
        const glm::dvec3 half = 0.5 * box.size();
        radius_ = numeric::length(half) * static_cast<double>(t.placement.scale) * (1 + 1e-6);
        const glm::dmat3& linear = to_world_.linear;
        half_height_ = numeric::abs(linear[0].z) * half.x + numeric::abs(linear[1].z) * half.y +
                       numeric::abs(linear[2].z) * half.z;
    }

    /// Bounds of its heights above the datum: those of its box.
    double highest() const { return centre_.z + half_height_; }
    double lowest() const { return radius_ > 0 ? centre_.z - half_height_ : 1e30; }

    /// Whether a ping's plane may meet the target on the side that it faces, within a slant range in metres.
    bool is_met_by(const ping_frame& p, double range) const {
        const glm::dvec3 centre = p(centre_);
        const double x = centre.x, u = centre.y;
        return u <= radius_ && u >= -radius_ && x > -radius_ &&
               numeric::dot(centre, centre) < (range + radius_) * (range + radius_);
    }

    /// Lower bound of its distance across the track from a ping that meets it.
    double nearest(const ping_frame& p) const { return p(centre_).x - radius_; }

    /// Calls `visit(cut_segment)` for each triangle that the ping's plane cuts. Triangles that share an edge share the
    /// end on it to the last bit, so cross-sections have no gaps.
    template <class Visit>
    void cut(const ping_frame& p, const Visit& visit) const {
        const glm::dvec3 offset = p(to_world_.offset);
        glm::dmat3 linear;
        for (int i = 0; i < 3; ++i) linear[i] = p.direction(to_world_.linear[i]);
        const glm::mat3 normals(linear);  // scales are uniform
        const double sign = numeric::determinant(linear) < 0 ? -1 : 1;
        const glm::dvec3 ahead(linear[0].y, linear[1].y, linear[2].y);
        tree_->cut(ahead, offset.y, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                cut_triangle(shape_->triangles[i], linear, offset, normals, sign, visit);
        });
    }

  private:
    template <class Visit>
    void cut_triangle(const glm::uvec3& t, const glm::dmat3& linear, const glm::dvec3& offset, const glm::mat3& normals,
                      double sign, const Visit& visit) const {
        glm::dvec3 v[3];
        int behind = 0;
        for (int i = 0; i < 3; ++i) {
            v[i] = numeric::product(linear, glm::dvec3(shape_->positions[t[i]])) + offset;
            behind += v[i].y < 0 ? 1 : 0;
        }
        if (behind == 0 || behind == 3 || !numeric::is_finite(v[0].x + v[1].x + v[2].x + v[0].z + v[1].z + v[2].z))
            return;
        // The vertex that is alone on its side of the plane; two edges leave it.
        int alone = 0;
        while ((v[alone].y < 0) != (behind == 1)) ++alone;
        const auto end_on_edge = [&](int other) {
            // From behind the plane to its front.
            const int from = behind == 1 ? alone : other, to = behind == 1 ? other : alone;
            const double f = v[from].y / (v[from].y - v[to].y);
            const glm::dvec3 at = v[from] + f * (v[to] - v[from]);
            const glm::vec3 &n = shape_->normals[t[from]], &m = shape_->normals[t[to]];
            return cut_segment::end{at.x, -at.z, numeric::product(normals, n + static_cast<float>(f) * (m - n))};
        };
        // Scaled where its square would not fit into a float.
        glm::dvec3 facet = sign * numeric::cross(v[1] - v[0], v[2] - v[0]);
        const double size = numeric::abs(facet.x) + numeric::abs(facet.y) + numeric::abs(facet.z);
        if (!(size > 1e-15 && size < 1e15) && size > 0) facet = facet / size;
        visit(cut_segment{end_on_edge((alone + 1) % 3), end_on_edge((alone + 2) % 3), glm::vec3(facet)});
    }

    shared_mesh shape_;
    std::shared_ptr<const plane_tree> tree_;
    affine to_world_;
    glm::dvec3 centre_{0, 0, -1e30};
    double radius_ = 0;       ///< of its bounding sphere, metres
    double half_height_ = 0;  ///< of its box, along the world's z
};

/// The targets of a scene; those with the same mesh share its tree.
inline dynamic_array<sliced_target> sliced_targets(const scene& s) {
    dynamic_array<sliced_target> all;
    std::map<const mesh*, std::shared_ptr<const plane_tree>> trees;
    for (const target& t : s.targets) {
        std::shared_ptr<const plane_tree>& tree = trees[&*t.shape];
        if (tree == nullptr) tree = std::make_shared<const plane_tree>(t.shape);
        all.push_back({t, tree});
    }
    return all;
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
