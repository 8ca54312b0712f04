// Angular blocks strewn over the plane: what broken rock is made of.
//
// Each cell of a lattice may hold one flat-topped, tilted, eight-sided block with steep walls; the surface is the
// highest of the blocks that reach a point. Where blocks are many they meet in Voronoi-like edges, where they are few
// they are boulders.
//
// Based on: Steven Worley. A Cellular Texture Basis Function. SIGGRAPH, 1996.
#pragma once

#include <insonify/seabed/noise.hpp>

#include <array>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::seabed::detail {

/// One size class of blocks. Continuous; walls no steeper than `steepness`.
class block_layer {
  public:
    /// @param cell       metres: blocks reach 0.3 to 0.9 of it from their centre
    /// @param share      in [0, 1]: how many cells hold a block
    /// @param height     metres: of the highest blocks
    /// @param steepness  slope of the walls
    block_layer(double cell, float share, float height, float steepness, cell_hash hash)
        : lattice_(lattice::shifted(cell, hash)),
          hash_(hash),
          share_(share),
          height_(height),
          wall_(steepness * static_cast<float>(cell)) {}

    /// Calls `visit(i, height)` for each sample of the row: metres, 0 between the blocks.
    template <class Visit>
    void row(const scanline& line, std::size_t count, Visit&& visit) const {
        const float kept = carried(2 / lattice_.frequency, line.grid_spacing);
        if (kept == 0) {
            for (std::size_t i = 0; i < count; ++i) visit(i, 0.0f);
            return;
        }
        const lattice_coordinate v(line.y * lattice_.frequency + lattice_.offset_y);
        const std::array rows{hash_[v.cell - 1], hash_[v.cell], hash_[v.cell + 1]};

        std::array<block, 9> reaching{};
        std::size_t used = 0;
        walk(
            lattice_, line, count,
            [&](std::int64_t column) {
                used = 0;
                for (std::size_t j = 0; j < 3; ++j) {
                    for (int i = -1; i <= 1; ++i) {
                        const float dy = v.fraction - static_cast<float>(j) + 1;
                        if (place(rows[j](column + i), static_cast<float>(i), dy, reaching[used])) ++used;
                    }
                }
            },
            [&](std::size_t i, float t) {
                float highest = 0;
                for (std::size_t b = 0; b < used; ++b) highest = (std::max)(highest, reaching[b].height_at(t));
                visit(i, kept * highest);
            });
    }

  private:
    /// A block as one row sees it: everything that depends on y is already in.
    struct block {
        float x;             // of the centre, in cells from the side of the cell walked
        float cosine, sine;  // of its heading
        float u, v;          // what y adds to the coordinates along and across the heading
        float radius;        // in cells
        float wall;          // metres per cell
        float top, tilt;     // metres at x, and metres per cell along the row

        float height_at(float t) const {
            const float dx = t - x;
            const float along = abs(dx * cosine + u), across = abs(v - dx * sine);
            // The octagon norm: the widest of the four pairs of sides.
            const float distance = (std::max)((std::max)(along, across), 0.70710678f * (along + across));
            return (std::min)(top + tilt * dx, (radius - distance) * wall);
        }
        static float abs(float value) { return value < 0 ? -value : value; }
    };

    /// The block of a neighbouring cell, if it has one that reaches the row.
    bool place(std::uint64_t bits, float column, float dy, block& b) const {
        const std::uint64_t more = scramble(bits), rest = scramble(more);
        const pair_of_bits centre(bits), form(more), heading(rest);
        const pair_of_bits slope(scramble(rest));
        if (0.5f + 0.5f * form.a > share_) return false;
        b.radius = 0.6f + 0.3f * slope.a * slope.b;  // middling sizes are the most common
        const float y = dy - (0.5f + 0.5f * centre.b);
        // The corners of an octagon lie 1 / cos(pi / 8) from its centre, so at most 0.975 of a cell: none is missed.
        if (y * y > b.radius * b.radius * 1.1715729f) return false;

        const float length = numeric::square_root(heading.a * heading.a + heading.b * heading.b) + 1e-9f;
        b.x = column + 0.5f + 0.5f * centre.a;
        b.cosine = heading.a / length;
        b.sine = heading.b / length;
        b.u = y * b.sine;
        b.v = y * b.cosine;
        b.wall = wall_;
        // Wide blocks are high ones; a tilted top makes one side a ramp and the other a cliff.
        const float middle = height_ * b.radius * (0.7f + 0.4f * form.b);
        b.tilt = 0.5f * height_ * slope.a;
        b.top = middle + 0.5f * height_ * slope.b * y;
        return true;
    }

    lattice lattice_;
    cell_hash hash_;
    float share_, height_, wall_;
};

}  // namespace insonify::inline INSONIFY_ABI::seabed::detail

INSONIFY_ARITHMETIC_END
