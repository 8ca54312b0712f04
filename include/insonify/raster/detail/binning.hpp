// Sorts triangles into tiles, in submission order.
//
// Triangles are binned in chunks, in parallel. Triangles adjacent in a mesh are mostly adjacent on the screen, so a
// chunk stores runs: consecutive triangles that touch the same tiles. A prefix sum over the run counts of every tile
// and chunk gives each run its position, and a second parallel pass copies them there: an order-preserving counting
// sort, whose result does not depend on which thread ran which chunk.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/detail/uninitialized.hpp>
#include <insonify/core/executor.hpp>
#include <insonify/core/rect.hpp>
#include <insonify/core/simd/lanes.hpp>

#include <algorithm>
#include <bit>
#include <span>
#include <utility>

#include <glm/vec2.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// The first and the last tile of a rectangle of tiles, column and row in 16 bits each: one comparison for both.
struct tile_range {
    std::uint32_t first, last;

    static std::uint32_t pack(int column, int row) {
        return static_cast<std::uint32_t>(column) | static_cast<std::uint32_t>(row) << 16;
    }
    rect tiles() const {
        const auto column = [](std::uint32_t tile) { return static_cast<int>(tile & 0xFFFFu); };
        const auto row = [](std::uint32_t tile) { return static_cast<int>(tile >> 16); };
        return {column(first), row(first), column(last) + 1, row(last) + 1};
    }
    friend bool operator==(const tile_range&, const tile_range&) = default;
};

/// The image divided into square tiles of 2^log2_size pixels.
struct tile_grid {
    int log2_size;
    int columns, rows;

    tile_grid(int width, int height, int log2_tile)
        : log2_size(log2_tile),
          columns((width + (1 << log2_tile) - 1) >> log2_tile),
          rows((height + (1 << log2_tile) - 1) >> log2_tile) {}

    std::size_t count() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
    /// Tiles per call of the executor, which share one buffer; one in small pictures, so that every thread gets work.
    std::size_t grain() const { return count() < 64 ? 1 : 4; }
    /// The tile of a pixel.
    std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y >> log2_size) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(x >> log2_size);
    }
    /// The first pixel of a tile.
    glm::ivec2 corner(std::size_t tile) const {
        const auto row_length = static_cast<std::size_t>(columns);
        return glm::ivec2(tile % row_length, tile / row_length) * (1 << log2_size);
    }
    /// The pixels of a tile, clipped to the image.
    rect pixels(std::size_t tile, int width, int height) const {
        const glm::ivec2 first = corner(tile), end = first + (1 << log2_size);
        return intersect({first.x, first.y, end.x, end.y}, {0, 0, width, height});
    }
    /// The tiles that a rectangle of pixels touches; it must not be empty.
    tile_range touched(const rect& pixels) const {
        return {tile_range::pack(pixels.x0 >> log2_size, pixels.y0 >> log2_size),
                tile_range::pack((pixels.x1 - 1) >> log2_size, (pixels.y1 - 1) >> log2_size)};
    }
};

/// Triangles with consecutive ids.
struct triangle_run {
    std::uint32_t first, count;
    bool is_small;  ///< see small_setup.hpp; in the bins of shadow casters, every triangle is
};

/// Reads the triangles of a tile's runs in order; small ones in groups across runs.
class run_reader {
  public:
    explicit run_reader(std::span<const triangle_run> runs) : runs_(runs) {}

    bool empty() const { return runs_.empty(); }

    /// Sets the ids of the next small triangles, at most N and up to the next one that isn't small. The rest of the
    /// first N ids repeats the first; the second half of the array is scratch.
    /// @returns their number
    template <int N>
    INSONIFY_INLINE int take_small(std::uint32_t (&ids)[static_cast<unsigned>(2 * N)]) {
        lanes<std::uint32_t, N> number;
        iota<std::uint32_t, N>(number);
        int count = 0;
        while (count < N && !runs_.empty() && runs_.front().is_small) {
            const triangle_run& run = runs_.front();
            const std::uint32_t some = (std::min)(run.count - taken_, static_cast<std::uint32_t>(N - count));
            store(ids + count, lanes<std::uint32_t, N>(number + (run.first + taken_)));
            count += static_cast<int>(some);
            taken_ += some;
            if (taken_ == run.count) advance();
        }
        for (int i = count; count > 0 && i < N; ++i) ids[i] = ids[0];
        return count;
    }
    /// The next run.
    triangle_run take_run() {
        const triangle_run run = runs_.front();
        advance();
        return run;
    }

  private:
    void advance() {
        runs_ = runs_.subspan(1);
        taken_ = 0;
    }

    std::span<const triangle_run> runs_;
    std::uint32_t taken_ = 0;  ///< triangles of the first run
};

/// The runs of one chunk.
class tile_runs {
  public:
    /// Appends `count` triangles, each of which touches these tiles.
    void add(std::uint32_t first, std::uint32_t count, const tile_range& tiles, bool is_small) {
        if (!entries_.empty()) {
            entry& last = entries_.back();
            if (last.run.first + last.run.count == first && last.tiles == tiles && last.run.is_small == is_small) {
                last.run.count += count;
                return;
            }
        }
        entries_.push_back({tiles, {first, count, is_small}});
    }

    /// The same for small triangles, from `first` on: those of the bits in `which`, with the first and the last tile of
    /// each. All of them usually touch the same tiles.
    template <int N>
    INSONIFY_INLINE void add_small(std::uint32_t first, unsigned which, const lanes<std::int32_t, N>& first_tile,
                                   const lanes<std::int32_t, N>& last_tile) {
        std::uint32_t firsts[static_cast<unsigned>(N)], lasts[static_cast<unsigned>(N)];
        store(firsts, first_tile);
        store(lasts, last_tile);
        if (which == (2u << (N - 1)) - 1 &&
            !any(lanes<std::int32_t, N>(((first_tile ^ lane(first_tile, 0)) | (last_tile ^ lane(last_tile, 0))) != 0)))
            return add(first, N, {firsts[0], lasts[0]}, true);
        for (unsigned left = which; left != 0; left &= left - 1) {
            const auto k = static_cast<unsigned>(std::countr_zero(left));
            add(first + k, 1, {firsts[k], lasts[k]}, true);
        }
    }

    /// Calls `visit(tile, run)` for every run and each tile that it touches, in order.
    /// @param all  rectangle that contains the tiles of all runs; `tile` is a row-major index into it
    template <class Visit>
    void for_each(const rect& all, const Visit& visit) const {
        for (const entry& e : entries_) {
            const rect tiles = e.tiles.tiles();
            for (int row = tiles.y0; row < tiles.y1; ++row)
                for (int column = tiles.x0; column < tiles.x1; ++column)
                    visit(static_cast<std::size_t>(row - all.y0) * static_cast<std::size_t>(all.width()) +
                              static_cast<std::size_t>(column - all.x0),
                          e.run);
        }
    }

    /// The smallest rectangle of tiles that contains those of all runs and `other`.
    rect bounds(rect other) const {
        for (const entry& e : entries_) other = merge(other, e.tiles.tiles());
        return other;
    }

    /// Adds `offset` to all ids from `first` on. @pre no run contains ids both below and above it
    void shift_ids(std::uint32_t first, std::uint32_t offset) {
        for (entry& e : entries_)
            if (e.run.first >= first) e.run.first += offset;
    }

  private:
    struct entry {
        tile_range tiles;
        triangle_run run;
    };
    dynamic_array<entry> entries_;
};

/// Runs by tile.
class tile_bins {
  public:
    tile_bins() = default;

    /// @param chunks  the runs of all chunks, in submission order
    /// @param all     contains their tiles
    template <executor E>
    tile_bins(std::span<const tile_runs> chunks, const rect& all, E& ex) {
        // How many runs each chunk has in each tile; then, where in the tile it puts the next one.
        const std::size_t tiles = static_cast<std::size_t>(all.width()) * static_cast<std::size_t>(all.height());
        first_.assign(tiles + 1, 0);
        dynamic_array<std::uint32_t> positions(chunks.size() * tiles, 0);
        const auto of_chunk = [&](std::size_t chunk) { return std::span(positions).subspan(chunk * tiles, tiles); };
        ex.bulk(chunks.size(), [&](std::size_t chunk) {
            chunks[chunk].for_each(all, [&](std::size_t tile, const triangle_run&) { ++of_chunk(chunk)[tile]; });
        });
        dynamic_array<std::uint32_t> next(tiles, 0);
        for (std::size_t chunk = 0; chunk < chunks.size(); ++chunk)
            for (std::size_t tile = 0; tile < tiles; ++tile)
                next[tile] += std::exchange(of_chunk(chunk)[tile], next[tile]);
        // A tile's runs fit 32 bits; those of all tiles together may not.
        for (std::size_t tile = 0; tile < tiles; ++tile) first_[tile + 1] = first_[tile] + next[tile];

        runs_ = uninitialized_array<triangle_run>(first_.back(), memory_of(ex));
        ex.bulk(chunks.size(), [&](std::size_t chunk) {
            chunks[chunk].for_each(all, [&](std::size_t tile, const triangle_run& run) {
                runs_[first_[tile] + of_chunk(chunk)[tile]++] = run;
            });
        });
    }

    std::span<const triangle_run> operator[](std::size_t tile) const {
        return std::span(runs_).subspan(first_[tile], first_[tile + 1] - first_[tile]);
    }

  private:
    dynamic_array<std::size_t> first_;
    uninitialized_array<triangle_run> runs_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
