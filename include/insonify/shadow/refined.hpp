// An object as a caster of refined shadows, by what suits its shape: a heightfield over a regular grid by its horizon,
// anything else by a map that names its triangles.
#pragma once

#include <insonify/shadow/caster_map.hpp>
#include <insonify/shadow/horizon.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::shadow {

/// One mesh as a caster, whatever its shape.
class refined_caster {
  public:
    /// Casts nothing.
    refined_caster() = default;

    /// @param frame      of the light
    /// @param m          the mesh, which has to outlive this
    /// @param box        around it, in its own frame
    /// @param to_world   from the mesh's frame to the one in which the light is described
    /// @param is_solid   nothing that can be asked about lies inside or below it
    /// @param receivers  what can be asked about, in the latter frame
    /// @param texel      metres between the rays that tell what is near a point; see refined::largest, too
    /// @throws invalid_input as map_grid does
    template <executor E>
    refined_caster(const light_frame& frame, const mesh_view& m, const bounding_box& box, const affine& to_world,
                   bool is_solid, const bounding_box& receivers, double texel, int largest, E& ex) {
        if (is_solid && is_lit_from_above(frame, to_world))
            if (const auto grid = regular_grid_of(m, ex)) {
                horizon_ = horizon(frame, m, box, *grid, to_world, receivers, texel, largest, ex);
                return;
            }
        const map_extent all = extent_of(receivers, {}, frame);
        map_ = caster_map(frame, m, to_world, is_solid, extent_of(box, to_world, frame).clipped_to(all), all.reach(),
                          texel, largest, ex);
    }

    /// Marks which of the `asked` points are dark, unless they face away; positions are in the frame in which the light
    /// is described.
    template <int N>
    INSONIFY_INLINE void darken(insonify::detail::lanes<std::int32_t, N>& dark,
                                const insonify::detail::lanes<std::int32_t, N>& asked,
                                const insonify::detail::lanes<float, N> (&position)[3]) const {
        if (!horizon_.empty())
            horizon_.darken<N>(dark, asked, position);
        else
            map_.darken<N>(dark, asked, position);
    }

  private:
    /// Whether light that comes from above does so in the mesh's own frame, which is no mirror's.
    static bool is_lit_from_above(const light_frame& frame, const affine& to_world) {
        return numeric::determinant(to_world.linear) > 0 &&
               numeric::product(inverse(to_world).linear, frame.to_light()).z > 0;
    }

    horizon horizon_;
    caster_map map_;
};

}  // namespace insonify::inline INSONIFY_ABI::shadow

INSONIFY_ARITHMETIC_END
