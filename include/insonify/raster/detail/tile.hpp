// Draws the triangles of one tile, in submission order.
#pragma once

#include <insonify/core/image_view.hpp>
#include <insonify/core/simd/dispatch.hpp>
#include <insonify/raster/detail/binning.hpp>
#include <insonify/raster/detail/fill.hpp>
#include <insonify/raster/detail/small_fill.hpp>
#include <insonify/raster/detail/vertices.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Draws a tile between loading it from the image and storing it there. `Triangles` has the tile's runs of triangle ids
/// and, by id, vertices, setup and rounded depth.
template <class Triangles, bool HasIds, class Real>
struct tile_kernel {
    static constexpr bool exact = std::is_same_v<Real, double>;
    const Triangles& triangles;
    tile_buffer<HasIds>& tile;
    image_view<float> image;
    float sign;  ///< from the image's depth to the tile's, where smaller is nearer
    bool load_image;

    template <int Width>
    INSONIFY_INLINE void run() const {
        // As many lanes as a vector of Real holds.
        constexpr int N = exact && Width > 1 ? Width / 2 : Width;
        tile.restart(triangles.pixels.x0, triangles.pixels.y0);
        tile.template clear<Width>();
        if (load_image) copy<N>([&](int x, int y) { return std::pair(tile.depth_at(x, y), &image(x, y)); });
        const drawn_area<N> area(triangles.grid(), triangles.pixels);
        run_reader left(triangles.bin);
        while (!left.empty()) {
            draw_small_runs<N>(left, area);
            if (left.empty()) break;
            const triangle_run run = left.take_run();
            for (std::uint32_t i = 0; i < run.count; ++i) draw_one<N>(run.first + i);
        }
        copy<N>([&](int x, int y) { return std::pair(&image(x, y), tile.depth_at(x, y)); });
    }

  private:
    /// Copies depths between tile and image; `ends(x, y)` returns destination and source. Adding zero turns -0 into +0,
    /// so that both ways to compute a depth of zero give the same bits.
    template <int N, class Ends>
    INSONIFY_INLINE void copy(const Ends& ends) const {
        using floats = lanes<float, N>;
        const rect& pixels = triangles.pixels;
        for (int y = pixels.y0; y < pixels.y1; ++y) {
            int x = pixels.x0;
            for (; x + N <= pixels.x1; x += N) {
                const auto [to, from] = ends(x, y);
                floats z;
                load(z, from);
                store(to, floats(z * sign + 0.0f));
            }
            for (; x < pixels.x1; ++x) {
                const auto [to, from] = ends(x, y);
                *to = *from * sign + 0.0f;
            }
        }
    }

    template <int N>
    INSONIFY_INLINE void draw_one(std::uint32_t id) const {
        const triangle_setup t = triangles.setup(id);
        const auto rounded_depth = [&](int x, int y) { return triangles.rounded_depth(id, x, y); };
        if (t.narrow)
            fill<N, std::int32_t, HasIds, exact>(t, tile, id, rounded_depth);
        else
            fill<N, std::int64_t, HasIds, exact>(t, tile, id, rounded_depth);
    }

    /// Draws small triangles up to the next one that isn't. A tile's triangles lie far apart in the mesh, in rows of a
    /// few. While a group of them is drawn, the next group's vertices and the indices of the one after that are
    /// prefetched: of every second and every fourth triangle, because adjacent triangles share vertices and cache
    /// lines.
    template <int N>
    INSONIFY_INLINE void draw_small_runs(run_reader& left, const drawn_area<N>& area) const {
        struct group {
            std::uint32_t ids[static_cast<unsigned>(2 * N)];  // see take_small
            int count;
        };
        group groups[3];
        const auto take = [&](int i) INSONIFY_INLINE_LAMBDA {
            group& g = groups[i % 3];
            g.count = left.template take_small<N>(g.ids);
            for (int k = 0; k < g.count; k += 4) triangles.prefetch_indices(g.ids[k]);
        };
        const auto prefetch_vertices = [&](int i) INSONIFY_INLINE_LAMBDA {
            const group& g = groups[i % 3];
            for (int k = 0; k < g.count; k += 2) triangles.prefetch_vertices(g.ids[k]);
        };
        take(0);
        take(1);
        prefetch_vertices(0);
        for (int i = 0; groups[i % 3].count > 0; ++i) {
            take(i + 2);
            prefetch_vertices(i + 1);
            draw_small<N>(groups[i % 3].ids, groups[i % 3].count, area);
        }
    }

    template <int N>
    INSONIFY_INLINE void draw_small(const std::uint32_t* ids, int count, const drawn_area<N>& drawn) const {
        lanes<Real, N> z[3];
        triangle_lanes<N> t([&](int i, auto& x, auto& y) INSONIFY_INLINE_LAMBDA {
            const vertex_lanes<N, Real> v([&](int k) -> const auto& { return triangles.vertex(ids[k], i); });
            x = v.x;
            y = v.y;
            z[i] = v.depth;
        });
        // Clockwise order: b and c are exchanged where the front is seen.
        lanes<std::int32_t, N> area, front;
        t.area(area);
        front = area < 0;
        area = front ? 0 - area : area;
        exchange(front, t.bx, t.cx);
        exchange(front, t.by, t.cy);
        lanes<std::conditional_t<exact, std::int64_t, std::int32_t>, N> real_front;
        convert(real_front, front);
        exchange(real_front, z[1], z[2]);
        const small_setup<N> setup(t, drawn);
        const small_planes<N, Real> planes(t, area, z[0], z[1], z[2]);
        small_fill<N, Real, HasIds>{setup, planes, static_cast<int>(triangles.grid().unit()), tile, ids, count}(
            [&](int k, int x, int y) { return triangles.rounded_depth(ids[k], x, y); });
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
