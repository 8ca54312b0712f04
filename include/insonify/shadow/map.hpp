// Shadow maps: one height map for each caster, looked up at the nearest texel (`map`) or averaged over several (`pcf`).
//
// A target's map covers the target alone, so its texels stay fine in large pictures. On level ground a shadow edge is
// off by at most half a texel along u and along v, 0.71 texels across a diagonal edge. A point on a mesh gets a depth
// bias along the slope of its facet, see map_lookup.hpp. Point lights are rejected.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/executor.hpp>
#include <insonify/shadow/detail/tile_casters.hpp>
#include <insonify/shadow/map_lookup.hpp>
#include <insonify/shadow/policy.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow {

inline namespace INSONIFY_FLAGS {

/// The height maps of casters under one parallel light.
class map_occlusion {
  public:
    /// See casting_policy; the members of `pcf` come first.
    /// @throws invalid_input for a member out of range, a point_light, or an index without a position
    template <executor E>
    map_occlusion(float texels_per_pixel, int largest, int radius, std::span<const caster> casters,
                  const any_light& light, const point_bounds& bounds, E& ex)
        : casters_(casters), frame_(parallel(light)), radius_(radius) {
        insonify::detail::require_positive("shadow map's texels_per_pixel", texels_per_pixel);
        insonify::detail::require_range("shadow map's largest", largest, 1, 32768, "1 to 32768");
        insonify::detail::require_range("shadow map's radius", radius, 0, 8, "0 to 8 texels");
        const bounding_box receivers = extent_of(bounds.box, {}, frame_);
        const double texel = spacing_of(bounds, receivers) / static_cast<double>(texels_per_pixel);
        lowest_ = receivers.lower;
        const glm::dvec3 size = receivers.size();
        for (int i = 0; i < 2; ++i) tiles_per_metre_[i] = size[i] > 0 ? side / size[i] : 0;
        // A filter also averages texels beyond the receivers. The nearest texel never lies there.
        const double coarsest = (std::max)(texel, (std::max)(size.x, size.y) / (largest - 0.5));
        const double border = radius > 0 ? (radius + 1) * coarsest : 0;
        insonify::detail::dynamic_array<detail::tile_casters::covered_tile> covered;
        for (std::size_t k = 0; k < casters_.size(); ++k) {
            const caster& c = casters_[k];
            bounding_box own = extent_of(c.box, c.placement, frame_);
            for (int i = 0; i < 2; ++i) {  // the rays of the receivers, with the heights of the whole caster
                own.lower[i] = (std::max)(own.lower[i], receivers.lower[i] - border);
                own.upper[i] = (std::min)(own.upper[i], receivers.upper[i] + border);
            }
            maps_.push_back({frame_, own, texel, largest});
            maps_.back().cast(c.mesh, c.placement, ex);
            if (maps_.back().empty()) continue;
            const double reach = (radius + 2) * maps_.back().texel();  // of the filter, and rounding
            const glm::ivec2 first = tile_of(glm::dvec2(own.lower) - reach),
                             last = tile_of(glm::dvec2(own.upper) + reach);
            for (int row = first.y; row <= last.y; ++row)
                for (int column = first.x; column <= last.x; ++column)
                    covered.push_back({static_cast<std::uint32_t>(row * side + column), static_cast<std::uint32_t>(k)});
        }
        casters_of_tiles_ = {side * side, covered};
    }

    /// See occlusion.
    void test(const points& at, const results& into) const {
        for (std::size_t i = 0; i < at.size(); ++i) {
            into.lit[i] = 1;
            into.caster[i] = invalid_id;
            const glm::dvec3 facet = facet_of(casters_, at, i);
            const bool is_facing_away = numeric::dot(facet, frame_.to_light()) < 0;
            const receiver_plane plane(frame_, at[i], is_facing_away ? -facet : facet);
            const bool is_edge_on = !plane.faces_light && facet != glm::dvec3(0);
            const glm::ivec2 tile = tile_of(glm::dvec2(plane.uvz));
            for (const std::uint32_t k : casters_of_tiles_.of(static_cast<std::size_t>(tile.y * side + tile.x))) {
                if (k >= at.casters || !(into.lit[i] > 0)) break;
                const float fraction = lit(maps_[k], plane, radius_);
                into.lit[i] = (std::min)(into.lit[i], fraction);
                if (fraction < 0.5f && into.caster[i] == invalid_id) into.caster[i] = k;
            }
            if (!is_edge_on) continue;
            // The facet is edge-on to the light: its own mesh shadows it.
            into.lit[i] = 0;
            into.caster[i] = (std::min)(into.caster[i], at.mesh[i]);
        }
    }

  private:
    /// Tiles along either axis of the receivers' extent. Each lists the maps over it.
    static constexpr int side = 64;

    /// Column and row of the tile that contains a point (u, v), or of the nearest one.
    glm::ivec2 tile_of(const glm::dvec2& uv) const {
        glm::ivec2 tile;
        for (int i = 0; i < 2; ++i) tile[i] = numeric::clamped_index((uv[i] - lowest_[i]) * tiles_per_metre_[i], side);
        return tile;
    }

    static light_frame parallel(const any_light& light) {
        if (const auto* source = std::get_if<point_light>(&light)) {
            const glm::dvec3& p = source->position;
            insonify::detail::refuse("the distance of the light (overhead.light_distance)", numeric::length(p),
                                     "infinite for shadow maps; shadow::exact and shadow::penumbra take a point_light");
        }
        return light_frame(std::get<directional_light>(light));
    }
    /// Metres between points; if unknown, those of a picture of 2048 pixels that shows all of them.
    static double spacing_of(const point_bounds& bounds, const bounding_box& receivers) {
        if (bounds.spacing > 0 || receivers.empty()) return bounds.spacing > 0 ? bounds.spacing : 1;
        const glm::dvec3 size = bounds.box.upper - bounds.box.lower;
        const double longer = (std::max)({size.x, size.y, size.z});
        return longer > 0 ? longer / 2048 : 1;
    }

    insonify::detail::dynamic_array<caster> casters_;
    light_frame frame_;
    int radius_;
    insonify::detail::dynamic_array<height_map> maps_;
    glm::dvec2 lowest_{0}, tiles_per_metre_{0};
    detail::tile_casters casters_of_tiles_;
};

}  // namespace INSONIFY_FLAGS

/// A map of the casters' heights along the light, looked up at the nearest texel: hard edges.
struct map {
    float texels_per_pixel = 1.5f;  ///< texels per spacing of the points; a shadow edge is off by 0.71 texels at most
    int largest = 8192;             ///< texels a side; texels are enlarged where a map would exceed it

    /// See casting_policy.
    /// @throws invalid_input as map_occlusion does
    template <executor E>
    INSONIFY_MEMBER map_occlusion build(std::span<const caster> casters, const any_light& light,
                                        const point_bounds& bounds, E& ex) const {
        return {texels_per_pixel, largest, 0, casters, light, bounds, ex};
    }
};

/// The same map, averaged over (2 radius + 1)^2 texels, which blurs shadow edges over 2 radius + 1 texels.
struct pcf {
    float texels_per_pixel = 1.5f;
    int largest = 8192;
    int radius = 1;  ///< texels, 0 to 8

    /// See casting_policy.
    /// @throws invalid_input as map_occlusion does
    template <executor E>
    INSONIFY_MEMBER map_occlusion build(std::span<const caster> casters, const any_light& light,
                                        const point_bounds& bounds, E& ex) const {
        return {texels_per_pixel, largest, radius, casters, light, bounds, ex};
    }
};

}  // namespace shadow
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
