// Which triangles each tile has to look at, in the order in which they were submitted.
//
// Triangles go through in chunks, in parallel. Neighbours in a mesh are mostly neighbours on the screen, so a chunk
// notes runs: triangles that follow one another and touch the same tiles. Counting the runs of every chunk and tile
// gives each its place, and a second parallel pass puts them there: an order-preserving counting sort whose result
// doesn't depend on who ran which chunk.
#pragma once

#include <insonify/core/detail/uninitialized.hpp>
#include <insonify/core/executor.hpp>
#include <insonify/core/simd/lanes.hpp>
#include <insonify/raster/detail/setup.hpp>

#include <algorithm>
#include <span>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// The image cut into square tiles of 2^log2_size pixels.
struct tile_grid {
    int log2_size;
    int columns, rows;

    tile_grid(int width, int height, int log2_tile)
        : log2_size(log2_tile),
          columns((width + (1 << log2_tile) - 1) >> log2_tile),
          rows((height + (1 << log2_tile) - 1) >> log2_tile) {}

    std::size_t count() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
    /// The tiles that a box of pixels touches.
    pixel_box touched(const pixel_box& box) const {
        return {box.x0 >> log2_size, box.y0 >> log2_size, box.x1 >> log2_size, box.y1 >> log2_size};
    }
};

/// The first and the last tile of a rectangle of tiles, each with its column and row in 16 bits: soon compared.
struct tile_range {
    std::uint32_t first, last;

    static tile_range of(const pixel_box& tiles) {
        const auto pack = [](int column, int row) {
            return static_cast<std::uint32_t>(column) | static_cast<std::uint32_t>(row) << 16;
        };
        return {pack(tiles.x0, tiles.y0), pack(tiles.x1, tiles.y1)};
    }
    pixel_box box() const {
        const auto unpack = [](std::uint32_t half) { return static_cast<int>(half & 0xFFFFu); };
        return {unpack(first), unpack(first >> 16), unpack(last), unpack(last >> 16)};
    }
    friend bool operator==(const tile_range&, const tile_range&) = default;
};

/// Triangles whose names follow one another, all drawn the same way.
struct triangle_run {
    std::uint32_t first, count;
    bool is_small;  ///< eight go through the set-up at a time
};

/// Reads the triangles of some runs in order, small ones as many at a time as are wanted, whatever their runs.
class run_reader {
  public:
    explicit run_reader(std::span<const triangle_run> runs) : runs_(runs) {}

    bool empty() const { return runs_.empty(); }

    /// Sets the names of the next small triangles, Most of them or as many as come before one that isn't small; behind
    /// those stands the first again, and the second half is scratch.
    /// @returns how many
    template <int Most>
    INSONIFY_INLINE int take_small(std::uint32_t (&names)[static_cast<unsigned>(2 * Most)]) {
        lanes<std::uint32_t, Most> number;
        count_up<std::uint32_t, Most>(number);
        int count = 0;
        while (count < Most && !runs_.empty() && runs_.front().is_small) {
            const triangle_run& run = runs_.front();
            const std::uint32_t some = (std::min)(run.count - taken_, static_cast<std::uint32_t>(Most - count));
            store(names + count, lanes<std::uint32_t, Most>(number + (run.first + taken_)));
            count += static_cast<int>(some);
            taken_ += some;
            if (taken_ == run.count) advance();
        }
        for (int i = count; count > 0 && i < Most; ++i) names[i] = names[0];
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
    std::uint32_t taken_ = 0;  ///< of the first of them
};

/// The runs of one chunk.
class tile_runs {
  public:
    /// The next triangles, `count` of them from `first` on, and the tiles that each of them touches.
    void add(std::uint32_t first, std::uint32_t count, const tile_range& tiles, bool is_small) {
        if (!runs_.empty()) {
            noted& last = runs_.back();
            if (last.run.first + last.run.count == first && last.tiles == tiles && last.run.is_small == is_small) {
                last.run.count += count;
                return;
            }
        }
        runs_.push_back({tiles, {first, count, is_small}});
    }

    /// Calls `visit(tile, run)` for every run and each tile that it touches, in order.
    template <class Visit>
    void for_each(const tile_grid& grid, const Visit& visit) const {
        for (const noted& n : runs_) {
            const pixel_box tiles = n.tiles.box();
            for (int row = tiles.y0; row <= tiles.y1; ++row)
                for (int column = tiles.x0; column <= tiles.x1; ++column)
                    visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
                              static_cast<std::size_t>(column),
                          n.run);
        }
    }

    /// Adds `offset` to all names from `first` on; no run may go across it.
    void rename(std::uint32_t first, std::uint32_t offset) {
        for (noted& n : runs_)
            if (n.run.first >= first) n.run.first += offset;
    }

  private:
    struct noted {
        tile_range tiles;
        triangle_run run;
    };
    std::vector<noted> runs_;
};

/// Runs by tile.
class tile_bins {
  public:
    tile_bins() = default;

    /// @param chunks  the runs of all chunks, in submission order
    template <executor E>
    tile_bins(std::span<const tile_runs> chunks, const tile_grid& grid, E& ex) : first_(grid.count() + 1, 0) {
        // Count, then turn the counts into places: by tile first, by chunk within a tile.
        const std::size_t tiles = grid.count();
        std::vector<std::uint32_t> places(chunks.size() * tiles, 0);
        const auto of_chunk = [&](std::size_t chunk) { return std::span(places).subspan(chunk * tiles, tiles); };
        ex.bulk(chunks.size(), [&](std::size_t chunk) {
            chunks[chunk].for_each(grid, [&](std::size_t tile, const triangle_run&) { ++of_chunk(chunk)[tile]; });
        });
        std::uint32_t place = 0;
        for (std::size_t tile = 0; tile < tiles; ++tile) {
            first_[tile] = place;
            for (std::size_t chunk = 0; chunk < chunks.size(); ++chunk) {
                const std::uint32_t count = of_chunk(chunk)[tile];
                of_chunk(chunk)[tile] = place;
                place += count;
            }
        }
        first_[tiles] = place;

        runs_ = uninitialized_vector<triangle_run>(place, memory_of(ex));
        ex.bulk(chunks.size(), [&](std::size_t chunk) {
            chunks[chunk].for_each(
                grid, [&](std::size_t tile, const triangle_run& run) { runs_[of_chunk(chunk)[tile]++] = run; });
        });
    }

    std::span<const triangle_run> operator[](std::size_t tile) const {
        return std::span(runs_).subspan(first_[tile], first_[tile + 1] - first_[tile]);
    }

  private:
    std::vector<std::uint32_t> first_;
    uninitialized_vector<triangle_run> runs_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
