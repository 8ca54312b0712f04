// The pixel loop: one tile, its triangles in order, coverage and depth several pixels at a time.
//
// A tile resolves visibility in buffers of its own that stay in the first-level cache; who won is known before anything
// is shaded, and shading happens once per pixel.
#pragma once

#include <insonify/core/dispatch.hpp>
#include <insonify/core/lanes.hpp>
#include <insonify/raster/depth.hpp>

#include <algorithm>
#include <limits>
#include <vector>

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // wide vectors stay inside always-inlined code
#endif

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::detail {

/// A triangle ready for the pixels of a box: its corners run clockwise on the screen, edges are named by their ends.
struct triangle_setup {
    edge_function bc, ca, ab;
    depth_plane depth;
    pixel_box box;
    bool narrow;  ///< the edge functions fit 32 bits all over the box

    /// The corners must not lie on one line. What `box` leaves out may be covered nevertheless.
    static triangle_setup of(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c,
                             const pixel_grid& grid, const pixel_box& box, int slack) {
        const bool compact = grid.is_compact(a) && grid.is_compact(b) && grid.is_compact(c);
        const double area =
            compact ? static_cast<double>(compact_area(a, b, c)) : double_double::from(wide_area(a, b, c)).high;
        triangle_setup t{edge_function::through(b, c, grid, box.x0, box.y0, compact),
                         edge_function::through(c, a, grid, box.x0, box.y0, compact),
                         edge_function::through(a, b, grid, box.x0, box.y0, compact),
                         depth_plane::through(a, b, c, area, grid),
                         box,
                         true};
        if (t.is_narrow(slack)) return t;
        const int width = box.width() + slack, height = box.height();
        t.bc = t.bc.simplified(width, height);
        t.ca = t.ca.simplified(width, height);
        t.ab = t.ab.simplified(width, height);
        t.narrow = t.is_narrow(slack);
        return t;
    }

    /// All pixels of the box are covered, and none to its right.
    void cover_box() {
        bc = ca = {0, 0, 0};
        ab = {box.width() - 1, -1, 0};
        narrow = true;
    }

  private:
    bool is_narrow(int slack) const {
        const int width = box.width() + slack, height = box.height();
        return bc.is_narrow(width, height) && ca.is_narrow(width, height) && ab.is_narrow(width, height);
    }
};

/// Depth of a tile's pixels and, where Winners, which of the tile's triangles each shows.
template <bool Winners>
class tile_buffer {
  public:
    static constexpr std::uint32_t nobody = 0xFFFFFFFFu;
    static constexpr int slack = 16;  // whole vectors may reach past the end of a row

    explicit tile_buffer(int size)
        : stride_(size + slack),
          depth_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(size)),
          winner_(Winners ? depth_.size() : 0) {}

    /// Puts the empty tile where its first pixel is (x, y) of the image.
    void restart(int x, int y) {
        x_ = x;
        y_ = y;
        std::fill(depth_.begin(), depth_.end(), std::numeric_limits<float>::infinity());
        std::fill(winner_.begin(), winner_.end(), nobody);
    }

    float* depth(int x, int y) { return depth_.data() + index(x, y); }
    std::uint32_t* winner(int x, int y) { return winner_.data() + index(x, y); }

  private:
    std::ptrdiff_t index(int x, int y) const { return static_cast<std::ptrdiff_t>(y - y_) * stride_ + (x - x_); }

    int stride_;
    int x_ = 0, y_ = 0;
    std::vector<float> depth_;
    std::vector<std::uint32_t> winner_;
};

/// Draws one triangle into a tile, N pixels of a row at a time; a tie in depth stays with whoever came first.
/// Depths that a double can't round with certainty are asked of `nearest(x, y)`.
template <int N, class Int, bool Winners, class Nearest>
INSONIFY_INLINE void fill(const triangle_setup& t, tile_buffer<Winners>& tile, std::uint32_t name,
                          const Nearest& nearest) {
    using ints = lanes<Int, N>;
    using floats = lanes<float, N>;
    using doubles = lanes<double, N>;
    using masks = lanes<std::int32_t, N>;
    using names = lanes<std::uint32_t, N>;
    ints column;
    doubles column_x;
    count_up<Int, N>(column);
    count_up<double, N>(column_x);
    const floats lowest = floats{} + t.depth.lowest, highest = floats{} + t.depth.highest;
    const doubles error = doubles{} + t.depth.error;
    const names drawn = names{} + name;

    // Lanes hold N neighbouring pixels of a row.
    ints row_bc = static_cast<Int>(t.bc.origin) + column * static_cast<Int>(t.bc.dx);
    ints row_ca = static_cast<Int>(t.ca.origin) + column * static_cast<Int>(t.ca.dx);
    ints row_ab = static_cast<Int>(t.ab.origin) + column * static_cast<Int>(t.ab.dx);

    for (int y = t.box.y0; y <= t.box.y1; ++y) {
        const double row_z = t.depth.row(y);
        ints bc = row_bc, ca = row_ca, ab = row_ab;
        for (int x = t.box.x0; x <= t.box.x1; x += N) {
            masks covered;
            convert(covered, ints((bc | ca | ab) >= 0));
            const doubles plane = row_z + t.depth.dx * (column_x + (static_cast<double>(x) - t.depth.x));
            floats z;
            convert(z, plane);
            floats below, above;
            convert(below, doubles(plane - error));
            convert(above, doubles(plane + error));
            const masks doubtful = covered & masks(below != above);
            if (any(doubtful))
                for (int i = 0; i < N; ++i)
                    if (lane(doubtful, i) != 0) set_lane(z, i, nearest(x + i, y));
            z = z > lowest ? z : lowest;
            z = z < highest ? z : highest;

            float* const stored = tile.depth(x, y);
            floats old;
            load(old, stored);
            const masks visible = covered & masks(z < old);
            store(stored, floats(visible ? z : old));
            if constexpr (Winners) {
                std::uint32_t* const winner = tile.winner(x, y);
                names before;
                load(before, winner);
                store(winner, names(visible ? drawn : before));
            }
            bc += static_cast<Int>(N * t.bc.dx);
            ca += static_cast<Int>(N * t.ca.dx);
            ab += static_cast<Int>(N * t.ab.dx);
        }
        row_bc += static_cast<Int>(t.bc.dy);
        row_ca += static_cast<Int>(t.ca.dy);
        row_ab += static_cast<Int>(t.ab.dy);
    }
}

/// All triangles of one tile. `Triangles` gives `setup(i)` for i in [0, count()), with an empty box for none, and
/// `nearest_depth(i, x, y)`.
template <class Triangles, bool Winners>
struct tile_kernel {
    const Triangles& triangles;
    tile_buffer<Winners>& tile;

    template <int N>
    INSONIFY_INLINE void run() const {
        for (std::uint32_t i = 0; i < triangles.count(); ++i) {
            const triangle_setup t = triangles.setup(i);
            const auto nearest = [&](int x, int y) { return triangles.nearest_depth(i, x, y); };
            if (t.narrow)
                fill<N, std::int32_t>(t, tile, i, nearest);
            else
                fill<N, std::int64_t>(t, tile, i, nearest);
        }
    }
};

}  // namespace insonify::inline INSONIFY_ABI::detail

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

INSONIFY_ARITHMETIC_END
