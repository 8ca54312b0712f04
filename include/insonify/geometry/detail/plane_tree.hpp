// Bounding-volume tree that finds the triangles of a mesh that a plane may cut.
//
// An implicit tree of bounding boxes, eight triangles to a leaf and eight children to a node, over the triangles in
// their own order, which shared_mesh keeps coherent. It is built in one pass, and triangles are visited in order.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/linear.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/geometry/mesh.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Finds the triangles of a mesh that a plane may cut.
class plane_tree {
  public:
    plane_tree() = default;
    /// @param m  its indices have positions; triangles with corners that are not finite are in no box
    explicit plane_tree(const mesh_view& m) : triangles_(m.triangles.size()) {
        dynamic_array<box> level((triangles_ + branching - 1) / branching);
        for (std::size_t i = 0; i < triangles_; ++i) {
            const glm::uvec3& t = m.triangles[i];
            const glm::vec3 &a = m.positions[t.x], &b = m.positions[t.y], &c = m.positions[t.z];
            if (!numeric::is_finite(a) || !numeric::is_finite(b) || !numeric::is_finite(c)) continue;
            for (const glm::vec3& p : {a, b, c}) level[i / branching].include({p, p});
        }
        levels_.push_back(std::move(level));
        while (levels_.back().size() > 1) {
            const dynamic_array<box>& below = levels_.back();
            dynamic_array<box> above((below.size() + branching - 1) / branching);
            for (std::size_t i = 0; i < below.size(); ++i) above[i / branching].include(below[i]);
            levels_.push_back(std::move(above));
        }
    }

    /// Calls `visit(first, last)` for runs of triangles that contain all those cut by normal . p + offset = 0.
    template <class Visit>
    void cut(const glm::dvec3& normal, double offset, const Visit& visit) const {
        if (triangles_ > 0) descend(levels_.size() - 1, 0, normal, offset, visit);
    }

  private:
    static constexpr std::size_t branching = 8;

    struct box {
        glm::vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};

        void include(const box& other) {
            for (int i = 0; i < 3; ++i) {
                low[i] = (std::min)(low[i], other.low[i]);
                high[i] = (std::max)(high[i], other.high[i]);
            }
        }
        bool meets(const glm::dvec3& normal, double offset) const {
            if (low.x > high.x) return false;  // empty
            double lowest = offset, highest = offset, size = numeric::abs(offset);
            for (int i = 0; i < 3; ++i) {
                const double a = normal[i] * static_cast<double>(low[i]), b = normal[i] * static_cast<double>(high[i]);
                lowest += (std::min)(a, b);
                highest += (std::max)(a, b);
                size += (std::max)(numeric::abs(a), numeric::abs(b));
            }
            const double rounding = 1e-12 * size;
            return lowest <= rounding && highest >= -rounding;
        }
    };

    template <class Visit>
    void descend(std::size_t level, std::size_t i, const glm::dvec3& normal, double offset, const Visit& visit) const {
        if (!levels_[level][i].meets(normal, offset)) return;
        const std::size_t first = i * branching;
        if (level == 0) return visit(first, (std::min)(first + branching, triangles_));
        for (std::size_t child = first; child < (std::min)(first + branching, levels_[level - 1].size()); ++child)
            descend(level - 1, child, normal, offset, visit);
    }

    std::size_t triangles_ = 0;
    dynamic_array<dynamic_array<box>> levels_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
