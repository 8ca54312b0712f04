// A light's planes (light_planes.hpp), cut into tiles, and the casters over each tile.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/shadow/detail/light_planes.hpp>
#include <insonify/shadow/detail/occluders.hpp>
#include <insonify/shadow/detail/tile_casters.hpp>
#include <insonify/shadow/policy.hpp>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::detail::inline INSONIFY_FLAGS {

/// The rectangle of a plane that contains the eight points corner(0) to corner(7).
template <class Corner>
insonify::detail::ground_rect extent_on(const light_plane& plane, const Corner& corner) {
    insonify::detail::ground_rect all;
    for (int i = 0; i < 8; ++i) all.include(glm::dvec2(plane(corner(i))));
    return all;
}

/// One plane of a light: its tiles, and the casters projected onto it.
struct tiled_plane {
    light_plane plane;
    plane_tiles tiles;
    float error = 0;  ///< of coordinates on the plane
    dynamic_array<plane_caster> casters;
    glm::dvec2 scale{};  ///< tiles per unit
    tile_casters casters_of_tiles{};

    /// The tile that contains a point of the plane, or the nearest one.
    std::size_t tile_of(const glm::dvec3& at) const {
        const glm::ivec2 tile = clamped((glm::dvec2(at) - tiles.lower) * scale);
        return static_cast<std::size_t>(tile.y * tiles.columns + tile.x);
    }
    /// First and last column and row of the tiles that a caster's box may touch.
    std::pair<glm::ivec2, glm::ivec2> tiles_under(const caster& c) const {
        const auto [lower, upper] =
            extent_on(plane, [&](int i) { return transform_point(c.placement, c.box.corner(i)); });
        // The margin is larger than rounding errors.
        return {clamped((lower - tiles.lower) * scale - 0x1p-10), clamped((upper - tiles.lower) * scale + 0x1p-10)};
    }

  private:
    glm::ivec2 clamped(const glm::dvec2& tile) const {
        return {numeric::clamped_index(tile.x, tiles.columns), numeric::clamped_index(tile.y, tiles.rows)};
    }
};

/// All planes of one light, with their tiles numbered consecutively: one plane for parallel light, or the six faces of
/// a cube around a point light. Faces that no point lies over have no casters and no tiles.
class tiled_planes {
  public:
    explicit tiled_planes(const any_light& light) {
        if (const auto* source = std::get_if<point_light>(&light)) point_light_ = *source;
    }
    void add(tiled_plane plane) {
        starts_.push_back(tile_count() + (plane.casters.empty() ? 0 : plane.tiles.count()));
        planes_.push_back(std::move(plane));
    }

    bool empty() const { return planes_.empty(); }
    bool has_point_light() const { return point_light_.has_value(); }
    const tiled_plane& front() const { return planes_.front(); }
    std::size_t tile_count() const { return starts_.back(); }

    /// The plane of a tile, and the number of the tile on that plane.
    std::pair<const tiled_plane*, std::size_t> plane_of(std::size_t tile) const {
        const auto after = std::upper_bound(starts_.begin(), starts_.end(), tile);
        return {&planes_[static_cast<std::size_t>(after - starts_.begin() - 1)], tile - *(after - 1)};
    }

    /// Where a point lies.
    struct place {
        const tiled_plane* plane;  ///< null where no caster blocks its light
        glm::dvec3 projected;      ///< on the plane, after the division
        std::size_t tile;          ///< among all
        std::uint32_t caster;      ///< of the tile, see tile_casters::only
    };
    place of(const glm::dvec3& p) const {
        const auto face = static_cast<std::size_t>(point_light_ ? light_plane::face_of(*point_light_, p) : 0);
        const tiled_plane& on = planes_[face];
        if (on.casters.empty()) return {};
        const glm::dvec3 homogeneous = on.plane(p),
                         projected = point_light_ ? light_plane::perspective_divide(homogeneous) : homogeneous;
        const std::size_t tile = on.tile_of(projected);
        return {&on, projected, starts_[face] + tile, on.casters_of_tiles.only(tile)};
    }

  private:
    std::optional<point_light> point_light_;
    dynamic_array<tiled_plane> planes_;
    dynamic_array<std::size_t> starts_{0};  ///< first tile of each plane, then their number
};

}  // namespace shadow::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
