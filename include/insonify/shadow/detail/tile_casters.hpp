// Which casters touch each tile of a plane.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/shadow/policy.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::detail::inline INSONIFY_FLAGS {

using insonify::detail::dynamic_array;

/// The casters that touch each tile of a plane.
class tile_casters {
  public:
    static constexpr std::uint32_t none = invalid_id, several = invalid_id - 1;
    struct covered_tile {
        std::uint32_t tile, caster;
    };

    tile_casters() = default;
    /// @param all  in order of casters
    tile_casters(std::size_t tiles, std::span<const covered_tile> all)
        : only_(tiles, none), starts_(tiles + 1, 0), casters_(all.size()) {
        for (const auto& [tile, caster] : all) {
            ++starts_[tile + 1];
            only_[tile] = only_[tile] == none ? caster : several;
        }
        for (std::size_t tile = 0; tile < tiles; ++tile) starts_[tile + 1] += starts_[tile];
        dynamic_array<std::size_t> next = starts_;
        for (const auto& [tile, caster] : all) casters_[next[tile]++] = caster;
    }

    /// In order.
    std::span<const std::uint32_t> of(std::size_t tile) const {
        return std::span(casters_).subspan(starts_[tile], starts_[tile + 1] - starts_[tile]);
    }
    /// The only caster of a tile, or `none`, or `several`.
    std::uint32_t only(std::size_t tile) const { return only_[tile]; }

  private:
    dynamic_array<std::uint32_t> only_;
    dynamic_array<std::size_t> starts_;  ///< of the tiles, then the number of all
    dynamic_array<std::uint32_t> casters_;
};

}  // namespace shadow::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify
