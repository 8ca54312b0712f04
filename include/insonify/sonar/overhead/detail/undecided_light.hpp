// Input of the shadow pass: the pixels whose light is undecided, and how much may arrive there.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/detail/uninitialized.hpp>
#include <insonify/core/image.hpp>
#include <insonify/core/rect.hpp>
#include <insonify/core/simd/lanes.hpp>
#include <insonify/raster/detail/binning.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>

#include <glm/vec2.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// One bit for each pixel, eight to a byte; each row starts at a byte.
class pixel_marks {
  public:
    pixel_marks() = default;
    pixel_marks(int width, int height, const shared_pool& memory)
        : bytes_((width + 7) / 8, height, uninitialized{}, memory) {}

    /// Clears a rectangle that starts and, unless at the image's edge, ends at a multiple of 8.
    void clear(const rect& pixels) {
        for (int y = pixels.y0; y < pixels.y1; ++y)
            std::fill_n(&bytes_(pixels.x0 / 8, y), (pixels.width() + 7) / 8, std::uint8_t{0});
    }
    /// Replaces the marks of the pixels in `which` (bit i is pixel x + i) by those in `marks`; all lie in one byte.
    INSONIFY_INLINE void set(int x, int y, unsigned which, unsigned marks) {
        std::uint8_t& byte = bytes_(x / 8, y);
        byte = static_cast<std::uint8_t>((byte & ~(which << x % 8)) | (marks & which) << x % 8);
    }
    /// Clears a mark.
    /// @returns whether it was set
    bool take(int x, int y) {
        std::uint8_t& byte = bytes_(x / 8, y);
        const unsigned bit = 1u << x % 8, before = byte;
        byte = static_cast<std::uint8_t>(before & ~bit);
        return (before & bit) != 0;
    }

  private:
    image<std::uint8_t> bytes_;
};

/// A pixel whose light is undecided, of one tile.
struct undecided_pixel {
    std::uint16_t column, row;  ///< within the tile
    std::uint32_t id;           ///< of its triangle, counted over all objects
    float direct;               ///< light that the source adds if nothing blocks it
};

/// Output of shading for the shadow pass: a list for each tile, since few pixels are undecided.
///
/// Pixels of triangles that are known to be lit get all their light at once, others only sky and ambient light. Entries
/// of pixels that a nearer surface has overwritten remain in the list; only the last entry of a marked pixel is valid.
class undecided_light {
  public:
    undecided_light() = default;
    /// @param tile  pixels, a power of 2
    undecided_light(int width, int height, int tile, const shared_pool& memory)
        : tiles_(width, height, std::countr_zero(static_cast<unsigned>(tile))), marks_(width, height, memory) {
        std::size_t start = 0;
        for (std::size_t i = 0; i < tiles_.count(); ++i) {
            // A quarter more than the tile's pixels, so that remove_hidden() rarely runs.
            const rect shown_in = tiles_.pixels(i, width, height);
            const auto shown = static_cast<std::size_t>(shown_in.width()) * static_cast<std::size_t>(shown_in.height());
            lists_.push_back({start, 0, shown + shown / 4 + 8});
            start += lists_.back().room;
        }
        pixels_ = uninitialized_array<undecided_pixel>(start, memory);
    }

    /// Empties the list of a tile.
    void clear(const rect& tile) {
        marks_.clear(tile);
        lists_[tiles_.at(tile.x0, tile.y0)].count = 0;
    }

    /// Lists the undecided pixels of up to N in a row, whose marks lie in one byte, and discards earlier entries of all
    /// pixels in `which`.
    /// @param which      pixels that are shaded, bit by bit
    /// @param undecided  those of them whose light is undecided
    template <int N>
    INSONIFY_INLINE void set(int x, int y, unsigned which, unsigned undecided,
                             const std::uint32_t (&triangles)[static_cast<unsigned>(N)], std::uint32_t first_id,
                             const lanes<float, N>& direct) {
        marks_.set(x, y, which, 0);
        if (undecided == 0) return;
        const std::size_t tile = tiles_.at(x, y);
        list& into = lists_[tile];
        if (into.count + N > into.room) remove_hidden(tile);
        marks_.set(x, y, undecided, undecided);
        float values[static_cast<unsigned>(N)];
        store(values, direct);
        const int mask = (1 << tiles_.log2_size) - 1;
        for (unsigned left = undecided; left != 0; left &= left - 1) {
            const int k = std::countr_zero(left);
            pixels_[into.start + into.count++] = {static_cast<std::uint16_t>((x + k) & mask),
                                                  static_cast<std::uint16_t>(y & mask), first_id + triangles[k],
                                                  values[k]};
        }
    }

    /// Marks a pixel of a list again.
    void mark(int x, int y) { marks_.set(x, y, 1, 1); }

    /// Calls visit(pixel) for each undecided pixel of a tile and clears its mark.
    template <class Visit>
    void take(std::size_t tile, const Visit& visit) {
        const list& from = lists_[tile];
        const glm::ivec2 corner = tiles_.corner(tile);
        for (std::size_t i = from.count; i-- > 0;) {
            const undecided_pixel& p = pixels_[from.start + i];
            if (marks_.take(corner.x + p.column, corner.y + p.row)) visit(p);
        }
    }

  private:
    /// The entries of a tile in `pixels_`: `count` of at most `room`, from index `start`.
    struct list {
        std::size_t start, count, room;
    };

    /// Removes entries that are not valid.
    INSONIFY_RARE void remove_hidden(std::size_t tile) {
        list& entries = lists_[tile];
        undecided_pixel* const start = pixels_.data() + entries.start;
        undecided_pixel *const end = start + entries.count, *last = end;
        take(tile, [&](const undecided_pixel p) { *--last = p; });
        entries.count = static_cast<std::size_t>(std::copy(last, end, start) - start);
        const glm::ivec2 corner = tiles_.corner(tile);
        for (std::size_t i = 0; i < entries.count; ++i) mark(corner.x + start[i].column, corner.y + start[i].row);
    }

    tile_grid tiles_{0, 0, 0};
    pixel_marks marks_;
    uninitialized_array<undecided_pixel> pixels_;
    dynamic_array<list> lists_;  ///< by tile
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
