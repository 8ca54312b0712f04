// A heightfield on a regular grid as a caster, tested against its horizon instead of a list of triangles.
#pragma once

#include <insonify/shadow/detail/horizon_triangles.hpp>
#include <insonify/shadow/detail/horizon_walk.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::detail::inline INSONIFY_FLAGS {

/// A heightfield on a regular grid under parallel light. Light and camera are above it (skip::facing_self).
class grid_caster {
  public:
    template <executor E>
    grid_caster(const caster& c, const light_frame& frame, isa level, E& ex)
        : mesh_(c.mesh),
          to_mesh_(inverse(c.placement)),
          travel_(transform_direction(to_mesh_, -frame.to_light())),
          bounds_(mesh_, c.box, *c.grid, travel_, level, ex),
          macrocells_(bounds_.grid(), bounds_.u(), level, ex) {}

    /// Decides points [first, last), which lie on this caster and face the light, where the horizon's bounds suffice.
    /// @param into  results, from that of point `first` on
    void decide_own_points(const points& at, std::size_t first, std::size_t last, decision* into, isa level) const {
        insonify::detail::dispatch(kernel{*this, at, first, last, into}, level);
    }
    /// Whether it blocks the light of a point.
    /// @param p       in the frame of the light
    /// @param is_own  whether p lies on this caster and faces the light
    /// @param decide  decide(triangle): whether the triangle blocks p's light, in doubles; false for p's own triangle
    template <class Decide>
    bool blocks(const glm::dvec3& p, bool is_own, const Decide& decide) const {
        const glm::dvec3 at = transform_point(to_mesh_, p);
        const decision result = is_own ? bounds_.at(at) : decision::undecided;
        if (result != decision::undecided) return result == decision::dark;
        return horizon_walk(bounds_, macrocells_, at).is_blocked(is_own, decide);
    }

    /// See horizon_triangles.
    /// @param eye  the camera, in the frame of the light
    horizon_triangles triangles(const glm::dvec3& eye) const {
        return {mesh_, bounds_, travel_, transform_point(to_mesh_, eye)};
    }
    const lit_grid& grid() const { return bounds_.grid(); }

  private:
    struct kernel {
        const grid_caster& caster;
        const points& at;
        std::size_t first, last;
        decision* into;

        template <int Width>
        INSONIFY_INLINE void run() const {
            constexpr int N = Width > 1 ? Width / 2 : 1;
            std::size_t i = first;
            for (; i + N <= last; i += N) decide<N>(i);
            for (; i < last; ++i) decide<1>(i);
        }
        template <int N>
        INSONIFY_INLINE void decide(std::size_t i) const {
            using namespace insonify::detail;
            lanes<double, N> x, y, z, p[3];
            load(x, at.x.data() + i), load(y, at.y.data() + i), load(z, at.z.data() + i);
            const affine& m = caster.to_mesh_;
            for (int k = 0; k < 3; ++k)
                p[k] = m.linear[0][k] * x + m.linear[1][k] * y + m.linear[2][k] * z + m.offset[k];
            lanes<std::int64_t, N> decisions;
            caster.bounds_.decide<N>(decisions, p);
            for (int k = 0; k < N; ++k)
                into[i - first + static_cast<std::size_t>(k)] = static_cast<decision>(lane(decisions, k));
        }
    };

    mesh_view mesh_;
    affine to_mesh_;
    glm::dvec3 travel_;  ///< of the light, in the mesh's frame
    horizon_bounds bounds_;
    macrocell_u macrocells_;
};

}  // namespace shadow::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
