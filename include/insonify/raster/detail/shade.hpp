// Shades the visible pixels of a tile: one by one in double, or over SIMD lanes in float.
#pragma once

#include <insonify/core/simd/transpose.hpp>
#include <insonify/raster/detail/assembly.hpp>
#include <insonify/raster/detail/tile.hpp>
#include <insonify/raster/fragment_lanes.hpp>
#include <insonify/raster/framebuffer.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// The triangles of one tile.
template <class Real>
struct tile_triangles {
    const screen_mesh<Real>& screen;
    std::span<const triangle_run> bin;
    rect pixels;
    const void* records;  ///< varyings of the vertices, which shading reads later; or null
    std::size_t record_size;

    const pixel_grid& grid() const { return screen.grid(); }
    INSONIFY_INLINE const packed_vertex<Real>& vertex(std::uint32_t id, int i) const { return screen.vertex(id, i); }

    INSONIFY_INLINE void prefetch_indices(std::uint32_t id) const { prefetch(&screen.indices(id)); }
    INSONIFY_INLINE void prefetch_vertices(std::uint32_t id) const {
        const glm::uvec3& index = screen.indices(id);
        for (int i = 0; i < 3; ++i) {
            prefetch(&screen.vertex(id, i));
            if (records != nullptr) prefetch(static_cast<const char*>(records) + std::size_t{index[i]} * record_size);
        }
    }

    /// Of a large triangle. Out of line: it would be compiled into each copy of the kernel.
    INSONIFY_RARE triangle_setup setup(std::uint32_t id) const {
        const screen_triangle t = screen[id];
        triangle_setup s = triangle_setup::of(t.a, t.b, t.c, grid(), pixels_of(t), tile_buffer<false>::slack);
        if (t.is_span()) s.cover_all();
        return s;
    }
    /// The pixels of the tile that a triangle may cover.
    rect pixels_of(const screen_triangle& t) const {
        return intersect(pixels, t.is_span() ? t.wide->span : centre_rect(t.a, t.b, t.c, grid()));
    }
    INSONIFY_RARE float rounded_depth(std::uint32_t id, int x, int y) const {
        const screen_triangle t = screen[id];
        return detail::rounded_depth(t.a, t.b, t.c, x, y, grid());
    }
};

/// The varyings of a triangle's vertices, in the mesh's order.
template <class VertexShader>
struct vertex_varyings {
    varyings_of<VertexShader> a, b, c;

    vertex_varyings(const VertexShader& shader, const mesh_view& m, const glm::uvec3& index)
        : a(varyings_at(shader, mesh_vertex(m, index.x))),
          b(varyings_at(shader, mesh_vertex(m, index.y))),
          c(varyings_at(shader, mesh_vertex(m, index.z))) {}
};

/// Calls the fragment shader for every visible pixel of a tile.
/// @returns the number of pixels
template <class Target, class Triangles, class VertexShader, class FragmentShader>
std::uint64_t shade(const mesh_view& m, const VertexShader& vertex_shader, const FragmentShader& shader,
                    const Target& target, const Triangles& triangles, tile_buffer<true>& tile, float depth_sign) {
    using varyings = varyings_of<VertexShader>;
    const pixel_grid& grid = triangles.screen.grid();
    std::uint64_t shaded = 0;
    const auto shade_triangle = [&](std::uint32_t id) {
        const screen_triangle t = triangles.screen[id];
        const rect pixels = triangles.pixels_of(t);
        std::optional<vertex_varyings<VertexShader>> ends;  // most triangles of a fine mesh show no pixel
        for (int y = pixels.y0; y < pixels.y1; ++y) {
            const std::uint32_t* const shown = tile.id_at(pixels.x0, y);
            for (int x = pixels.x0; x < pixels.x1; ++x) {
                if (shown[x - pixels.x0] != id) continue;
                if (!ends) ends.emplace(vertex_shader, m, m.triangles[t.triangle]);
                const glm::dvec3 weights = t.weights_at(x, y, grid);
                const fragment<varyings> f{x,
                                           y,
                                           depth_sign * *tile.depth_at(x, y) + 0.0f,  // as in the image
                                           t.triangle,
                                           glm::vec3(weights),
                                           t.front,
                                           weighted(ends->a, ends->b, ends->c, weights)};
                if constexpr (requires { target.color; })
                    target.color(x, y) = shader(f);
                else
                    shader(f);
                ++shaded;
            }
        }
    };
    for (const triangle_run& run : triangles.bin)
        for (std::uint32_t i = 0; i < run.count; ++i) shade_triangle(run.first + i);
    return shaded;
}

/// Pixel centres of a row on the sub-pixel grid. Unsigned, so that differences to vertices off the grid wrap around.
template <int N>
struct row_centres {
    using positions = lanes<std::uint32_t, N>;
    int y, subpixel_bits;
    positions first;  ///< x of the picture's first N pixels
    positions down;   ///< y

    INSONIFY_INLINE row_centres(const pixel_grid& grid, int row) : y(row), subpixel_bits(grid.subpixel_bits) {
        iota<std::uint32_t, N>(first);
        first = (first << subpixel_bits) + static_cast<std::uint32_t>(grid.half());
        down = positions{} + static_cast<std::uint32_t>(grid.centre(row));
    }
};

/// Calls a shader over lanes for the visible pixels of a tile.
///
/// A triangle of a fine mesh covers two or three pixels, so most of the work is to fetch vertices: varyings are stored
/// by vertex, in whole vectors of four floats, and a pixel loads its three vertices in a few instructions. Part of a
/// row is looked up before any of it is shaded: both are long dependency chains, which then overlap.
template <class Screen, class Varyings, class Shader>
struct lane_shading_kernel {
    using record = varyings_record<Varyings>;

    const Screen& screen;
    const record* records;
    tile_buffer<true>& tile;
    rect pixels;
    float depth_sign;
    const Shader& shader;
    std::uint64_t& shaded;

    template <int N>
    INSONIFY_INLINE void run() const {
        fragment_lanes<N, Varyings> found[static_cast<unsigned>(part / N)];
        for (int y = pixels.y0; y < pixels.y1; ++y)
            for (int x = pixels.x0; x < pixels.x1; x += part) {
                const int count = find<N>(found, x, y);
                for (int i = 0; i < count; ++i) shader(found[i]);
            }
    }

  private:
    static constexpr int part = 64;  ///< pixels whose fragments stay in the first-level cache

    /// Finds the fragments of the pixels from (x0, y) on.
    /// @returns their number
    template <int N>
    INSONIFY_INLINE int find(fragment_lanes<N, Varyings>* found, int x0, int y) const {
        using ints = lanes<std::int32_t, N>;
        const row_centres<N> row(screen.grid(), y);
        const ints set = ints{} - 1;  // a comparison of single numbers is 1, not a mask
        ints column;
        iota<std::int32_t, N>(column);
        int count = 0;
        for (int x = x0; x < (std::min)(pixels.x1, x0 + part); x += N) {
            const std::uint32_t* const ids = tile.id_at(x, y);
            lanes<std::uint32_t, N> shown;
            load(shown, ids);
            const ints visible =
                (shown != tile_buffer<true>::invalid_id ? set : ints{}) & (column < pixels.x1 - x ? set : ints{});
            if (!any(ints(visible == 0))) {
                shaded += N;
                look_up<N>(found[count++], x, row, visible, true, ids);
            } else if (any(visible)) {
                look_up_some<N>(found[count++], x, row, visible, ids);
            }
        }
        return count;
    }

    /// Where some pixels are not visible, their lanes take the triangle of one that is.
    template <int N>
    INSONIFY_INLINE void look_up_some(fragment_lanes<N, Varyings>& f, int x, const row_centres<N>& row,
                                      const lanes<std::int32_t, N>& visible, const std::uint32_t* ids) const {
        std::uint32_t shown[static_cast<unsigned>(N)], some_id = 0;
        for (int k = 0; k < N; ++k)
            if (lane(visible, k) != 0) {
                some_id = ids[k];
                ++shaded;
            }
        for (int k = 0; k < N; ++k) shown[k] = lane(visible, k) != 0 ? ids[k] : some_id;
        look_up<N>(f, x, row, visible, false, shown);
    }

    template <int N>
    INSONIFY_INLINE void look_up(fragment_lanes<N, Varyings>& f, int x, const row_centres<N>& row,
                                 const lanes<std::int32_t, N>& visible, bool all_visible,
                                 const std::uint32_t* ids) const {
        f.x = x;
        f.y = row.y;
        f.visible = visible;
        f.all_visible = all_visible;
        f.depth_ = tile.depth_at(x, row.y);
        f.depth_sign_ = depth_sign;
        lanes<std::uint32_t, N> id;
        load(id, ids);
        const bool any_wide = any(lanes<std::int32_t, N>(id >= screen.compact_count()));
        std::memcpy(f.triangles, ids, sizeof f.triangles);
        if (any_wide)
            for (std::uint32_t& triangle : f.triangles) triangle = screen.triangle(triangle);
        weigh<N>(f, row);
        if (any_wide) weigh_wide<N>(f, ids);
    }

    /// Sets weights and varyings. A vertex's weight is the area of the triangle opposite to it; the sign of the whole
    /// cancels. In float its error is 2^-24 of the triangle's length squared.
    template <int N>
    INSONIFY_INLINE void weigh(fragment_lanes<N, Varyings>& f, const row_centres<N>& row) const {
        using positions = typename row_centres<N>::positions;
        using ints = lanes<std::int32_t, N>;
        using floats = lanes<float, N>;
        const glm::uvec3* corners[static_cast<unsigned>(N)];
        unroll<N>([&](int k) INSONIFY_INLINE_LAMBDA { corners[k] = &screen.indices(f.triangles[k]); });
        const positions px = row.first + (static_cast<std::uint32_t>(f.x) << row.subpixel_bits);
        floats right[3], down[3], inverse_w[3];  // from the pixel's centre to the vertices
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA {
            std::size_t index[static_cast<unsigned>(N)];
            unroll<N>([&](int k) INSONIFY_INLINE_LAMBDA { index[k] = (*corners[k])[i]; });
            const auto& vertices = screen.vertices();
            const vertex_lanes<N, typename Screen::real> v([&](int k) INSONIFY_INLINE_LAMBDA -> const auto& {
                return vertices.packed[index[k]];
            });
            convert(right[i], ints(positions(v.x) - px));
            convert(down[i], ints(positions(v.y) - row.down));
            floats inverse;
            if constexpr (std::is_same_v<typename Screen::real, float>)
                inverse = v.inverse_w;
            else
                gather<N>(inverse, [&](int k) { return static_cast<float>(vertices.inverse_w[index[k]]); });
            inverse_w[i] = inverse;
            unroll<record::blocks>([&](int block) INSONIFY_INLINE_LAMBDA {
                transpose<N>(f.values_[i] + 4 * block,
                             [&](int k) INSONIFY_INLINE_LAMBDA { return records[index[k]].values + 4 * block; });
            });
        });
        // Measured from the pixel, so that exchanging two vertices changes a sign and nothing else.
        f.weights[0] = right[1] * down[2] - down[1] * right[2];
        f.weights[1] = right[2] * down[0] - down[2] * right[0];
        f.weights[2] = right[0] * down[1] - down[0] * right[1];
        f.front = f.weights[0] + (f.weights[1] + f.weights[2]) < 0.0f ? ints{} - 1 : ints{};
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA { f.weights[i] = f.weights[i] * inverse_w[i]; });
        const floats scale = 1.0f / (f.weights[0] + (f.weights[1] + f.weights[2]));
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA { f.weights[i] = f.weights[i] * scale; });
    }

    /// Replaces the weights of lanes whose triangle is wide.
    template <int N>
    INSONIFY_INLINE void weigh_wide(fragment_lanes<N, Varyings>& f, const std::uint32_t* ids) const {
        for (int k = 0; k < N; ++k) {
            if (screen.is_compact(ids[k])) continue;
            const weights_of_one one = weigh_one(screen, ids[k], f.x + k, f.y);
            set_lane(f.front, k, one.front ? std::int32_t{-1} : std::int32_t{0});
            for (int i = 0; i < 3; ++i) set_lane(f.weights[i], k, one.weights[i]);
        }
    }
    struct weights_of_one {
        glm::vec3 weights;
        bool front;
    };
    INSONIFY_RARE static weights_of_one weigh_one(const Screen& screen, std::uint32_t id, int px, int py) {
        const screen_triangle t = screen[id];
        return {glm::vec3(t.weights_at(px, py, screen.grid())), t.front};
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
