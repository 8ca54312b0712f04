// Which triangles each tile has to look at, in the order in which they were submitted.
//
// Triangles go through in chunks, in parallel; each chunk notes (tile, triangle) pairs. Counting the pairs of every
// chunk and tile gives each its place, and a second parallel pass puts the triangles there: an order-preserving
// counting sort whose result doesn't depend on who ran which chunk.
#pragma once

#include <insonify/core/executor.hpp>
#include <insonify/raster/setup.hpp>

#include <span>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::detail {

/// The image cut into square tiles of 2^log2_size pixels.
struct tile_grid {
    int log2_size;
    int columns, rows;

    tile_grid(int width, int height, int log2_tile)
        : log2_size(log2_tile),
          columns((width + (1 << log2_tile) - 1) >> log2_tile),
          rows((height + (1 << log2_tile) - 1) >> log2_tile) {}

    std::size_t count() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

/// The pairs of one chunk.
struct tile_pairs {
    struct pair {
        std::uint32_t tile;
        std::uint32_t triangle;
    };
    std::vector<pair> pairs;

    /// Notes the triangle in every tile that its box touches.
    void add(std::uint32_t triangle, const pixel_box& box, const tile_grid& tiles) {
        const int first_column = box.x0 >> tiles.log2_size, last_column = box.x1 >> tiles.log2_size;
        const int first_row = box.y0 >> tiles.log2_size, last_row = box.y1 >> tiles.log2_size;
        for (int row = first_row; row <= last_row; ++row)
            for (int column = first_column; column <= last_column; ++column)
                pairs.push_back({static_cast<std::uint32_t>(row * tiles.columns + column), triangle});
    }
};

/// Triangles by tile.
class tile_bins {
  public:
    tile_bins() = default;

    /// @param chunks  the pairs of all chunks, in submission order; they are used up
    template <executor E>
    tile_bins(std::vector<tile_pairs>& chunks, std::size_t tiles, E& ex) : first_(tiles + 1, 0) {
        // Count, then turn the counts into places: by tile first, by chunk within a tile.
        std::vector<std::uint32_t> places(chunks.size() * tiles, 0);
        const auto of_chunk = [&](std::size_t chunk) { return std::span(places).subspan(chunk * tiles, tiles); };
        ex.bulk(chunks.size(), [&](std::size_t chunk) {
            for (const auto& pair : chunks[chunk].pairs) ++of_chunk(chunk)[pair.tile];
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

        triangles_.resize(place);
        ex.bulk(chunks.size(), [&](std::size_t chunk) {
            for (const auto& pair : chunks[chunk].pairs) triangles_[of_chunk(chunk)[pair.tile]++] = pair.triangle;
            chunks[chunk] = {};
        });
    }

    std::span<const std::uint32_t> operator[](std::size_t tile) const {
        return std::span(triangles_).subspan(first_[tile], first_[tile + 1] - first_[tile]);
    }

  private:
    std::vector<std::uint32_t> first_;
    std::vector<std::uint32_t> triangles_;
};

}  // namespace insonify::inline INSONIFY_ABI::detail

INSONIFY_ARITHMETIC_END
