// Points of many batches, sorted by the tile of the light's planes that they lie over.
//
// Each run of batches is sorted by itself, so that runs are sorted in parallel; a tile collects its points from all
// runs.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/shadow/detail/receivers.hpp>
#include <insonify/shadow/detail/tiled_plane.hpp>

#include <algorithm>
#include <span>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::detail::inline INSONIFY_FLAGS {

/// Points sorted by tile, in parallel runs of batches.
class points_by_tile {
  public:
    /// Sorts points by tile and sets all results in `into` to lit, which is final where no caster touches the tile.
    /// @param planes  outlives this; without planes all points are lit
    template <executor E>
    points_by_tile(const tiled_planes& planes, std::span<const points> at, std::span<const results> into, E& ex)
        : planes_(planes) {
        const std::size_t grain = (std::max)(std::size_t{8}, (at.size() + 127) / 128);
        runs_.resize((at.size() + grain - 1) / grain);
        std::size_t count = 0;
        for (std::size_t i = 0; i < at.size(); ++i) {
            if (i % grain == 0) runs_[i / grain].first = count;
            count += at[i].size();
        }
        const auto memory = insonify::detail::memory_of(ex);
        sorted_ = receivers_of(count, memory);
        bulk_ranges(ex, at.size(), grain, [&](std::size_t first, std::size_t last) {
            sort(at, into, first, last, runs_[first / grain], memory);
        });
    }

    /// Replaces `own` by the points of a tile.
    void collect(std::size_t tile, insonify::detail::uninitialized_array<receiver>& own) const {
        std::size_t size = 0;
        for (const run& r : runs_) size += r.of(sorted_, tile).size();
        own.resize(size);
        auto to = own.begin();
        for (const run& r : runs_) {
            const auto some = r.of(sorted_, tile);
            to = std::copy(some.begin(), some.end(), to);
        }
    }

  private:
    using receivers_of = insonify::detail::uninitialized_array<receiver>;
    /// A run of batches.
    struct run {
        std::size_t first = 0;                ///< of its points among all
        dynamic_array<std::uint32_t> starts;  ///< of tiles, from there; empty if no tile has a caster

        std::span<const receiver> of(const receivers_of& all, std::size_t tile) const {
            if (starts.empty()) return {};
            return std::span(all).subspan(first + starts[tile], starts[tile + 1] - starts[tile]);
        }
    };

    void sort(std::span<const points> at, std::span<const results> into, std::size_t first, std::size_t last, run& out,
              const insonify::detail::shared_pool& memory) {
        std::size_t total = 0, count = 0;
        for (std::size_t batch = first; batch < last; ++batch) {
            std::fill(into[batch].lit.begin(), into[batch].lit.end(), 1.0f);
            std::fill(into[batch].caster.begin(), into[batch].caster.end(), invalid_id);
            total += at[batch].size();
        }
        const std::size_t tiles = planes_.tile_count();
        if (tiles == 0) return;
        receivers_of found(total, memory);
        insonify::detail::uninitialized_array<std::uint32_t> keys(total, memory);
        out.starts.assign(tiles + 1, 0);
        for (std::size_t batch = first; batch < last; ++batch) {
            const points& some = at[batch];
            for (std::size_t i = 0; i < some.size(); ++i) {
                const tiled_planes::place over = planes_.of(some[i]);
                if (over.plane == nullptr || over.caster == tile_casters::none) continue;
                if (over.caster != tile_casters::several && over.caster >= some.casters) continue;
                const glm::dvec2 from = glm::dvec2(over.projected) - over.plane->tiles.lower;
                found[count] = {static_cast<float>(from.x),
                                static_cast<float>(from.y),
                                static_cast<float>(over.projected.z),
                                {batch, i},
                                some.mesh[i],
                                some.triangle[i]};
                keys[count] = static_cast<std::uint32_t>(over.tile);
                ++out.starts[keys[count] + 1];
                ++count;
            }
        }
        for (std::size_t tile = 0; tile < tiles; ++tile) out.starts[tile + 1] += out.starts[tile];
        dynamic_array<std::uint32_t> next = out.starts;
        for (std::size_t i = 0; i < count; ++i) sorted_[out.first + next[keys[i]]++] = found[i];
    }

    const tiled_planes& planes_;
    dynamic_array<run> runs_;
    receivers_of sorted_;
};

}  // namespace shadow::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
