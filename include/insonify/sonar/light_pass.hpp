// From a shadow policy to the light on a tile: who casts, which points are tested, and what is named as the caster.
//
// Casters are numbered as they are named: a point in several shadows belongs to the target with the lowest number; else
// to its own surface, if that faces away from the light; else to the seabed.
#pragma once

#include <insonify/sonar/labels.hpp>
#include <insonify/sonar/point_pass.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail {

/// The light as a policy takes it.
inline shadow::any_light light_of(const overhead_geometry& view) {
    if (view.has_near_light()) return shadow::point_light{view.light_position()};
    return shadow::directional_light{static_cast<double>(view.rig().light_azimuth),
                                     static_cast<double>(view.rig().grazing)};
}

inline shadow::caster as_caster(const placed_mesh& m) {
    return {m.shape, m.to_rig, m.box, m.grid};
}

/// Room for what becomes of points.
struct light_arrays {
    unfilled_vector<float> lit;
    unfilled_vector<std::uint32_t> caster;

    explicit light_arrays(std::size_t points) : lit(points), caster(points) {}
    shadow::shares part(std::size_t first, std::size_t count) {
        return {std::span(lit).subspan(first, count), std::span(caster).subspan(first, count)};
    }
};

/// The batches of a tile, and where their answers go: points that face the light, which all casters concern, and those
/// that face away, whose shadows only name targets.
struct tile_batches {
    shadow::points at[2];
    shadow::shares into[2];

    /// @param targets  casters numbered below this are targets
    tile_batches(const point_tile& points, const shadow::shares& all, std::uint32_t targets)
        : at{points.facing_points(), points.averted_points()},
          into{{all.lit.first(points.facing), all.caster.first(points.facing)},
               {all.lit.subspan(points.facing), all.caster.subspan(points.facing)}} {
        at[1].casters = targets;
    }
    template <class Visit>
    void for_each(const Visit& visit) const {
        for (int i = 0; i < 2; ++i)
            if (at[i].size() > 0) visit(at[i], into[i]);
    }
};

}  // namespace detail
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
