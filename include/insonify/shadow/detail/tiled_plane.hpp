// A plane that rays of the light cross, cut into tiles, and which casters touch each tile.
#pragma once

#include <insonify/shadow/detail/light_planes.hpp>
#include <insonify/shadow/detail/occluders.hpp>
#include <insonify/shadow/policy.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::detail::inline INSONIFY_FLAGS {

/// The rectangle of a plane that contains the eight points corner(0) to corner(7).
template <class Corner>
std::pair<glm::dvec2, glm::dvec2> extent_on(const light_plane& plane, const Corner& corner) {
    glm::dvec2 lower(std::numeric_limits<double>::infinity()), upper = -lower;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 at = plane(corner(i));
        lower = {(std::min)(lower.x, at.x), (std::min)(lower.y, at.y)};
        upper = {(std::max)(upper.x, at.x), (std::max)(upper.y, at.y)};
    }
    return {lower, upper};
}

struct tiled_plane {
    static constexpr std::uint32_t no_caster = invalid_id, several_casters = invalid_id - 1;

    light_plane plane;
    plane_tiles tiles;
    float error = 0;  ///< of coordinates on the plane
    std::vector<plane_caster> casters;
    glm::dvec2 scale{};                     ///< tiles per unit
    std::vector<std::uint32_t> occupant{};  ///< by tile: the only caster that touches it, or one of the constants

    /// The tile that contains a point of the plane, or the nearest one.
    std::size_t tile_of(const glm::dvec3& at) const {
        const int column = clamped((at.x - tiles.lower.x) * scale.x, tiles.columns),
                  row = clamped((at.y - tiles.lower.y) * scale.y, tiles.rows);
        return static_cast<std::size_t>(row * tiles.columns + column);
    }
    /// First and last column and row of the tiles that a caster's box may touch.
    std::pair<glm::ivec2, glm::ivec2> tiles_under(const caster& c) const {
        const auto [lower, upper] =
            extent_on(plane, [&](int i) { return transform_point(c.placement, c.box.corner(i)); });
        // The margin is larger than rounding errors.
        const auto tile = [&](const glm::dvec2& at, double margin) {
            const glm::dvec2 in_tiles = (at - tiles.lower) * scale;
            return glm::ivec2(clamped(in_tiles.x + margin, tiles.columns), clamped(in_tiles.y + margin, tiles.rows));
        };
        return {tile(lower, -0x1p-10), tile(upper, 0x1p-10)};
    }
    void occupy(std::size_t tile, std::size_t caster) {
        occupant[tile] = occupant[tile] == no_caster ? static_cast<std::uint32_t>(caster) : several_casters;
    }

  private:
    static int clamped(double at, int count) { return static_cast<int>((std::min)((std::max)(0.0, at), count - 1.0)); }
};

}  // namespace shadow::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
