// The pixel loop: one tile, its triangles in order, coverage and depth several pixels at a time.
#pragma once

#include <insonify/core/image_view.hpp>
#include <insonify/core/simd/dispatch.hpp>
#include <insonify/raster/detail/binning.hpp>
#include <insonify/raster/detail/depth.hpp>
#include <insonify/raster/detail/placement.hpp>
#include <insonify/raster/detail/small_fill.hpp>

#include <algorithm>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A triangle of any size, ready for the pixels of a box: its corners run clockwise on the screen, edges are named by
/// their ends.
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

/// Draws one triangle of any size into a tile, N pixels of a row at a time. Depths that a double can't round with
/// certainty are asked of `nearest(x, y)`, if Exact.
template <int N, class Int, bool Winners, bool Exact, class Nearest>
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
        float* const depths = tile.depth(t.box.x0, y);
        std::uint32_t* const winners = tile.winner(t.box.x0, y);
        ints bc = row_bc, ca = row_ca, ab = row_ab;
        bool entered = false;
        for (int x = t.box.x0; x <= t.box.x1; x += N) {
            masks covered;
            convert(covered, ints((bc | ca | ab) >= 0));
            bc += static_cast<Int>(N * t.bc.dx);
            ca += static_cast<Int>(N * t.ca.dx);
            ab += static_cast<Int>(N * t.ab.dx);
            if (!any(covered)) {
                if (entered) break;  // a row of a triangle is one run
                continue;
            }
            entered = true;
            const doubles plane = row_z + t.depth.dx * (column_x + (static_cast<double>(x) - t.depth.x));
            floats z;
            convert(z, plane);
            if constexpr (Exact) {
                floats below, above;
                convert(below, doubles(plane - error));
                convert(above, doubles(plane + error));
                const masks doubtful = covered & masks(below != above);
                if (any(doubtful))
                    for (int i = 0; i < N; ++i)
                        if (lane(doubtful, i) != 0) set_lane(z, i, nearest(x + i, y));
            }
            z = z > lowest ? z : lowest;
            z = z < highest ? z : highest;
            const std::ptrdiff_t at = x - t.box.x0;
            keep_nearer<N, Winners>(depths + at, Winners ? winners + at : nullptr, covered, z, drawn);
        }
        row_bc += static_cast<Int>(t.bc.dy);
        row_ca += static_cast<Int>(t.ca.dy);
        row_ab += static_cast<Int>(t.ab.dy);
    }
}

/// All triangles of one tile, between reading and writing the image. `Triangles` has the runs of the tile, and for a
/// name its corners' places, its set-up and its nearest depth.
template <class Triangles, bool Winners, class Real>
struct tile_kernel {
    static constexpr bool exact = std::is_same_v<Real, double>;
    const Triangles& triangles;
    tile_buffer<Winners>& tile;
    image_view<float> image;
    pixel_box box;
    float sign;  ///< a smaller internal depth wins
    bool load_image, store_image;

    template <int Width>
    INSONIFY_INLINE void run() const {
        // As many as fit a vector of depths.
        constexpr int N = exact && Width > 1 ? Width / 2 : Width;
        tile.restart(box.x0, box.y0);
        tile.template clear<Width>();
        if (load_image) copy<N>([&](int x, int y) { return std::pair(tile.depth(x, y), &image(x, y)); });
        const drawn_area<N> area(triangles.grid(), box);
        run_reader left(triangles.runs());
        while (!left.empty()) {
            draw_small_ones<N>(left, area);
            if (left.empty()) break;
            const triangle_run run = left.take_run();
            for (std::uint32_t i = 0; i < run.count; ++i) draw_one<N>(run.first + i);
        }
        if (store_image) copy<N>([&](int x, int y) { return std::pair(&image(x, y), tile.depth(x, y)); });
    }

  private:
    /// Between tile and image; `ends(x, y)` are where to and where from. Adding zero leaves no minus zero, which one
    /// way to a depth may make where another makes zero.
    template <int N, class Ends>
    INSONIFY_INLINE void copy(const Ends& ends) const {
        using floats = lanes<float, N>;
        for (int y = box.y0; y <= box.y1; ++y) {
            int x = box.x0;
            for (; x + N - 1 <= box.x1; x += N) {
                const auto [to, from] = ends(x, y);
                floats z;
                load(z, from);
                store(to, floats(z * sign + 0.0f));
            }
            for (; x <= box.x1; ++x) {
                const auto [to, from] = ends(x, y);
                *to = *from * sign + 0.0f;
            }
        }
    }

    template <int N>
    INSONIFY_INLINE void draw_one(std::uint32_t name) const {
        const triangle_setup t = triangles.setup(name);
        const auto nearest = [&](int x, int y) { return triangles.nearest_depth(name, x, y); };
        if (t.narrow)
            fill<N, std::int32_t, Winners, exact>(t, tile, name, nearest);
        else
            fill<N, std::int64_t, Winners, exact>(t, tile, name, nearest);
    }

    /// As many as come before one that isn't small. A tile's triangles lie far apart in the mesh, in rows of a few: so
    /// while a group of them is drawn, the next one's corners and the indices of the one after that are on their way.
    /// Neighbours share corners, and cache lines: every second triangle, and every fourth, stand for the others.
    template <int N>
    INSONIFY_INLINE void draw_small_ones(run_reader& left, const drawn_area<N>& area) const {
        struct group {
            std::uint32_t names[static_cast<unsigned>(2 * N)];  // see take_small
            int count;
        };
        group groups[3];
        const auto take = [&](int i) INSONIFY_INLINE_LAMBDA {
            group& g = groups[i % 3];
            g.count = left.template take_small<N>(g.names);
            for (int k = 0; k < g.count; k += 4) triangles.prefetch_indices(g.names[k]);
        };
        const auto approach = [&](int i) INSONIFY_INLINE_LAMBDA {
            const group& g = groups[i % 3];
            for (int k = 0; k < g.count; k += 2) triangles.prefetch_corners(g.names[k]);
        };
        take(0);
        take(1);
        approach(0);
        for (int i = 0; groups[i % 3].count > 0; ++i) {
            take(i + 2);
            approach(i + 1);
            draw_small<N>(groups[i % 3].names, groups[i % 3].count, area);
        }
    }

    template <int N>
    INSONIFY_INLINE void draw_small(const std::uint32_t* names, int count, const drawn_area<N>& pixels) const {
        using reals = lanes<Real, N>;
        reals z[3];
        corner_lanes<N> at([&](int i, auto& x, auto& y) INSONIFY_INLINE_LAMBDA {
            const kept_lanes<N, Real> corner([&](int k) -> const auto& { return triangles.corner(names[k], i); });
            x = corner.x;
            y = corner.y;
            z[i] = corner.depth;
        });
        // Corners in clockwise order: b and c are exchanged where the front is seen.
        lanes<std::int32_t, N> area, front;
        at.area(area);
        front = area < 0;
        area = front ? 0 - area : area;
        exchange(front, at.bx, at.cx);
        exchange(front, at.by, at.cy);
        lanes<std::conditional_t<exact, std::int64_t, std::int32_t>, N> real_front;
        convert(real_front, front);
        exchange(real_front, z[1], z[2]);
        const small_setup<N> t(at, pixels);
        const small_planes<N, Real> planes(at, area, z[0], z[1], z[2]);
        small_fill<N, Real, Winners>{t, planes, static_cast<int>(triangles.grid().unit()), tile, names, count}(
            [&](int k, int x, int y) { return triangles.nearest_depth(names[k], x, y); });
    }

    template <class Mask, class Lanes>
    INSONIFY_INLINE static void exchange(const Mask& where, Lanes& a, Lanes& b) {
        const Lanes old = a;
        a = where ? b : a;
        b = where ? old : b;
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
