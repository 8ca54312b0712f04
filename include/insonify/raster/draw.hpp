// The public entry of the rasterizer: a mesh, what to do with vertices and pixels, and where to leave the result.
#pragma once

#include <insonify/raster/detail/assembly.hpp>
#include <insonify/raster/detail/fragment_lanes.hpp>
#include <insonify/raster/detail/tile.hpp>

#include <bit>
#include <optional>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

inline void check(const draw_options& options, image_view<const float> depth) {
    require(options.subpixel_bits >= 4 && options.subpixel_bits <= 16, "subpixel_bits", options.subpixel_bits,
            "4 to 16");
    require(options.tile >= 8 && options.tile <= 256 && std::has_single_bit(static_cast<unsigned>(options.tile)),
            "tile", options.tile, "a power of two from 8 to 256");
    const int widest = 1 << (30 - options.subpixel_bits);
    require(depth.width() <= widest, "target width", depth.width(), "at most 2^30 sub-pixels");
    require(depth.height() <= widest, "target height", depth.height(), "at most 2^30 sub-pixels");
}

/// The triangles of one tile, as the pixel kernel asks for them.
template <class Real>
struct tile_triangles {
    const screen_mesh<Real>& screen;
    std::span<const triangle_run> bin;
    pixel_box box;
    const void* records;  ///< of vertices, which shading will read soon; or null
    std::size_t record_size;

    std::span<const triangle_run> runs() const { return bin; }
    const pixel_grid& grid() const { return screen.grid(); }
    INSONIFY_INLINE const kept_vertex<Real>& corner(std::uint32_t name, int i) const { return screen.corner(name, i); }

    INSONIFY_INLINE void prefetch_indices(std::uint32_t name) const { prefetch(&screen.indices(name)); }
    INSONIFY_INLINE void prefetch_corners(std::uint32_t name) const {
        const glm::uvec3& index = screen.indices(name);
        for (int i = 0; i < 3; ++i) {
            prefetch(&screen.corner(name, i));
            if (records != nullptr) prefetch(static_cast<const char*>(records) + std::size_t{index[i]} * record_size);
        }
    }

    INSONIFY_INLINE triangle_setup setup(std::uint32_t name) const {
        const screen_triangle t = screen[name];
        triangle_setup s = triangle_setup::of(t.a, t.b, t.c, grid(), box_of(t), tile_buffer<false>::slack);
        if (t.is_run()) s.cover_box();
        return s;
    }
    /// The pixels of the tile that a triangle may cover.
    pixel_box box_of(const screen_triangle& t) const {
        return intersect(box, t.is_run() ? t.wide->run : center_box(t.a, t.b, t.c, grid()));
    }
    INSONIFY_RARE float nearest_depth(std::uint32_t name, int x, int y) const {
        const screen_triangle t = screen[name];
        return detail::nearest_depth(t.a, t.b, t.c, x, y, grid());
    }
};

/// What the vertex callable gives the pixels between a triangle's corners, in the mesh's order.
template <class VertexShader>
struct corner_varyings {
    varyings_of<VertexShader> a, b, c;

    corner_varyings(const VertexShader& place, const mesh_view& m, const glm::uvec3& index)
        : a(varyings_at(place, mesh_vertex(m, index.x))),
          b(varyings_at(place, mesh_vertex(m, index.y))),
          c(varyings_at(place, mesh_vertex(m, index.z))) {}
};

/// Calls the fragment callable for every pixel of a tile that shows a triangle of this draw.
template <class Target, class Triangles, class VertexShader, class FragmentShader>
std::uint64_t shade(const mesh_view& m, const VertexShader& place, const FragmentShader& shader, const Target& target,
                    const Triangles& triangles, tile_buffer<true>& tile, float depth_sign) {
    using varyings = varyings_of<VertexShader>;
    const pixel_grid& grid = triangles.screen.grid();
    std::uint64_t shaded = 0;
    const auto shade_one = [&](std::uint32_t name) {
        const screen_triangle t = triangles.screen[name];
        const pixel_box box = triangles.box_of(t);
        std::optional<corner_varyings<VertexShader>> corners;  // most triangles of a fine mesh win no pixel
        for (int y = box.y0; y <= box.y1; ++y) {
            const std::uint32_t* const winner = tile.winner(box.x0, y);
            for (int x = box.x0; x <= box.x1; ++x) {
                if (winner[x - box.x0] != name) continue;
                if (!corners) corners.emplace(place, m, m.triangles[t.triangle]);
                const glm::dvec3 weights = t.weights_at(x, y, grid);
                const fragment<varyings> f{x,
                                           y,
                                           depth_sign * *tile.depth(x, y) + 0.0f,  // as in the image
                                           t.triangle,
                                           glm::vec3(weights),
                                           t.front,
                                           weighted(corners->a, corners->b, corners->c, weights)};
                if constexpr (requires { target.color; })
                    target.color(x, y) = shader(f);
                else
                    shader(f);
                ++shaded;
            }
        }
    };
    for (const triangle_run& run : triangles.runs())
        for (std::uint32_t i = 0; i < run.count; ++i) shade_one(run.first + i);
    return shaded;
}

/// Keeps all depths.
inline constexpr auto every_tile = [](const pixel_box&) { return true; };

/// Everything but the shading, which `finish(tile triangles, tile buffer, depth sign)` does; it returns the pixels that
/// it shaded. What the vertex callable gives goes into `records`, one for each vertex, if there are any. Depths are
/// stored where `is_kept(tile's box)`.
template <bool Winners, class Real, vertex_shader VertexShader, executor E, class Record, class Kept, class Finish>
draw_stats draw_tiles(const mesh_view& m, const VertexShader& place, image_view<float> depth,
                      const draw_options& options, E& ex, Record* records, const Kept& is_kept, Finish&& finish) {
    check(options, depth);
    require(m.normals.empty() || m.normals.size() == m.positions.size(), "mesh.normals.size()", m.normals.size(),
            "0 or one per position");
    if (depth.empty()) return {};
    const pixel_grid grid{options.subpixel_bits, depth.width(), depth.height()};
    const tile_grid tiles(grid.width, grid.height, std::countr_zero(static_cast<unsigned>(options.tile)));
    const screen_mesh<Real> screen(m, place, grid, tiles, options, Winners && std::is_same_v<Real, double>, records,
                                   ex);
    const float sign = options.keep == keep_depth::smaller ? 1.0f : -1.0f;

    // A few tiles share a buffer; how many doesn't matter to the result.
    constexpr std::size_t run = 4;
    std::vector<std::uint64_t> shaded((tiles.count() + run - 1) / run, 0);
    bulk_ranges(ex, tiles.count(), run, [&](std::size_t first, std::size_t last) {
        tile_buffer<Winners> buffer(options.tile);
        for (std::size_t tile = first; tile < last; ++tile) {
            const int x = static_cast<int>(tile % static_cast<std::size_t>(tiles.columns)) * options.tile;
            const int y = static_cast<int>(tile / static_cast<std::size_t>(tiles.columns)) * options.tile;
            const pixel_box box =
                intersect({x, y, x + options.tile - 1, y + options.tile - 1}, {0, 0, grid.width - 1, grid.height - 1});
            const tile_triangles<Real> triangles{screen, screen.bin(tile), box, records, sizeof(Record)};
            const bool keep = options.load == depth_load::keep;
            if (triangles.bin.empty() && keep) continue;
            dispatch(tile_kernel<tile_triangles<Real>, Winners, Real>{triangles, buffer, depth, box, sign, keep,
                                                                      is_kept(box)},
                     options.level);
            shaded[first / run] += finish(triangles, buffer, sign);
        }
    });
    draw_stats stats = screen.stats();
    for (const std::uint64_t pixels : shaded) stats.pixels += pixels;
    return stats;
}

/// Draws quick depths and hands the pixels that this draw has won, several at a time, to what shades their tile:
/// `shader.on(pixel_box)`, called with fragment_lanes. A draw that clears depths hands `shader.clear` each tile before,
/// to clear what it draws into.
/// @param later  where draws that keep depths will come: elsewhere none are stored
template <varying_shader VertexShader, class LaneShader, executor E>
draw_stats draw_lanes(const mesh_view& m, const VertexShader& place, const LaneShader& shader, image_view<float> depth,
                      std::span<const pixel_box> later, const draw_options& options, E& ex) {
    using varyings = varyings_of<VertexShader>;
    uninitialized_vector<vertex_record<varyings>> records(m.positions.size(), memory_of(ex));
    const auto is_kept = [&](const pixel_box& tile) {
        return std::any_of(later.begin(), later.end(), [&](const pixel_box& b) { return !intersect(tile, b).empty(); });
    };
    const auto shade_tile = [&](const auto& triangles, tile_buffer<true>& tile, float) {
        if (options.load == depth_load::clear) shader.clear(triangles.box);
        const auto on_tile = shader.on(triangles.box);
        std::uint64_t shaded = 0;
        dispatch(
            shading_kernel<screen_mesh<float>, varyings, std::remove_const_t<decltype(on_tile)>>{
                triangles.screen, records.data(), tile, triangles.box, on_tile, shaded},
            options.level);
        return shaded;
    };
    return draw_tiles<true, float>(m, place, depth, options, ex, records.data(), is_kept, shade_tile);
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Draws depth alone; no shading is compiled.
///
/// @param m        a mesh, or a view of your own buffers; any number of triangles up to 2^32 - 1
/// @param place    vertex_shader: `vertex` to clip space
/// @param target   depth image of up to 2^22 pixels a side; rows are tiles' rows, from the top
/// @param options  see draw_options
/// @param ex       who runs it; the result is the same bytes for any executor
/// @returns what became of the triangles
/// @throws invalid_input for an index without a position, normals that don't match, or options out of range;
///         the target is then untouched
template <vertex_shader VertexShader, executor_argument E = serial_executor>
draw_stats draw(const mesh_view& m, const VertexShader& place, const depth_target& target,
                const draw_options& options = {}, E&& ex = {}) {
    return detail::draw_tiles<false, double>(m, place, target.depth, options, ex, detail::no_records,
                                             detail::every_tile, [](auto&&...) { return std::uint64_t{0}; });
}

/// The same with quick depths.
template <vertex_shader VertexShader, executor_argument E = serial_executor>
draw_stats draw(const mesh_view& m, const VertexShader& place, const quick_depth_target& target,
                const draw_options& options = {}, E&& ex = {}) {
    return detail::draw_tiles<false, float>(m, place, target.depth, options, ex, detail::no_records, detail::every_tile,
                                            [](auto&&...) { return std::uint64_t{0}; });
}

/// Draws depth and shades every pixel that this draw won, once.
///
/// @param shader  fragment_shader: `fragment` to a value for target.color, or to nothing if Pixel is void
/// The other parameters, the result and the errors are those of the depth-only draw; it also throws invalid_input if
/// the color image's size isn't the depth image's.
template <vertex_shader VertexShader, class FragmentShader, class Pixel, executor_argument E = serial_executor>
    requires(fragment_shader<FragmentShader, varyings_of<VertexShader>, Pixel>)
draw_stats draw(const mesh_view& m, const VertexShader& place, const FragmentShader& shader,
                const framebuffer<Pixel>& target, const draw_options& options = {}, E&& ex = {}) {
    if constexpr (requires { target.color; }) {
        detail::require(target.color.width() == target.depth.width(), "color width", target.color.width(),
                        "the depth image's");
        detail::require(target.color.height() == target.depth.height(), "color height", target.color.height(),
                        "the depth image's");
    }
    const auto shade = [&](const auto& triangles, auto& tile, float sign) {
        if constexpr (requires { target.background; })
            if (target.clears_color && options.load == depth_load::clear)
                for (int y = triangles.box.y0; y <= triangles.box.y1; ++y)
                    std::fill_n(&target.color(triangles.box.x0, y), triangles.box.width(), target.background);
        return detail::shade(m, place, shader, target, triangles, tile, sign);
    };
    return detail::draw_tiles<true, double>(m, place, target.depth, options, ex, detail::no_records, detail::every_tile,
                                            shade);
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
