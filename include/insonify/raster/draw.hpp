// Draws a mesh: the public entry of the rasterizer.
//
// Vertices are shaded and snapped (vertices.hpp), triangles culled, clipped and binned (assembly.hpp), tiles resolve
// visibility (tile.hpp), and visible pixels are shaded (shade.hpp), all in parallel over chunks or tiles.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/raster/detail/shade.hpp>

#include <bit>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

template <depth_precision Depth>
void check(const draw_options<Depth>& options, image_view<const float> depth) {
    require_range("subpixel_bits", options.subpixel_bits, 4, 16, "4 to 16");
    require(options.tile >= 8 && options.tile <= 256 && std::has_single_bit(static_cast<unsigned>(options.tile)),
            "tile", options.tile, "a power of two from 8 to 256");
    // Sub-pixels have 30 bits, columns and rows of tiles 16.
    const int limit = (std::min)(1 << (30 - options.subpixel_bits), options.tile << 16);
    require(depth.width() <= limit, "target width", depth.width(), "at most 2^30 sub-pixels and 2^16 tiles");
    require(depth.height() <= limit, "target height", depth.height(), "at most 2^30 sub-pixels and 2^16 tiles");
}

/// All stages but shading.
/// @param records  varyings of the vertices, set by the vertex stage; or no_records
/// @param finish   finish(tile_triangles, tile_buffer, depth sign) shades a tile and returns the number of pixels
template <bool HasIds, depth_precision Depth, vertex_shader VertexShader, executor E, class Record, class Finish>
draw_stats draw_tiles(const mesh_view& m, const VertexShader& shader, image_view<float> depth,
                      const draw_options<Depth>& options, E& ex, Record* records, Finish&& finish) {
    using real = std::conditional_t<Depth == depth_precision::exact, double, float>;
    check(options, depth);
    require_normals(m);
    if (depth.empty()) return {};
    const pixel_grid grid{options.subpixel_bits, depth.width(), depth.height()};
    const tile_grid tiles(grid.width, grid.height, std::countr_zero(static_cast<unsigned>(options.tile)));
    const screen_mesh<real> screen(m, shader, grid, tiles, options, HasIds, records, ex);
    const float sign = options.compare == depth_compare::less ? 1.0f : -1.0f;

    const std::size_t grain = tiles.grain();
    dynamic_array<std::uint64_t> shaded((tiles.count() + grain - 1) / grain, 0);
    bulk_ranges(ex, tiles.count(), grain, [&](std::size_t first, std::size_t last) {
        tile_buffer<HasIds> buffer(options.tile);
        for (std::size_t tile = first; tile < last; ++tile) {
            const tile_triangles<real> triangles{screen, screen.bin(tile), tiles.pixels(tile, grid.width, grid.height),
                                                 records, sizeof(Record)};
            const bool keep = options.load == depth_load::keep;
            if (triangles.bin.empty() && keep) continue;
            dispatch(tile_kernel<tile_triangles<real>, HasIds, real>{triangles, buffer, depth, sign, keep},
                     options.level);
            shaded[first / grain] += finish(triangles, buffer, sign);
        }
    });
    draw_stats stats = screen.stats();
    for (const std::uint64_t pixels : shaded) stats.pixels += pixels;
    return stats;
}

/// Shaders that one of the overloads of `draw` with a framebuffer takes.
template <class VertexShader, class Shader, class Pixel>
concept drawing_shaders = vertex_shader<VertexShader> &&(fragment_shader<Shader, varyings_of<VertexShader>, Pixel> ||
                                                         (std::is_void_v<Pixel> && varying_shader<VertexShader> &&
                                                          fragment_lane_shader<Shader, varyings_of<VertexShader>>));

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Draws depth alone; no shading is compiled.
///
/// @param m        a mesh, or a view of your own buffers; at most 2^32 - 2 triangles, parts of clipped ones included
/// @param shader   vertex_shader or vertex_lane_shader
/// @param target   depth image; each side at most 2^(30 - subpixel_bits) pixels and 2^16 tiles (2^22 pixels by default)
/// @param options  see draw_options; `draw_options<depth_precision::quick>` for depths in float
/// @param ex       runs the stages; the result is the same bytes for any executor
/// @returns the number of triangles by outcome, and of shaded pixels; zeros for an empty target
/// @throws invalid_input for an index without a position, a number of normals that is neither 0 nor that of positions,
///         options out of range or a target too large; the target is then unchanged
template <vertex_shader VertexShader, depth_precision Depth = depth_precision::exact,
          executor_argument E = serial_executor>
draw_stats draw(const mesh_view& m, const VertexShader& shader, const depth_target& target,
                const draw_options<Depth>& options = {}, E&& ex = {}) {
    return detail::draw_tiles<false>(m, shader, target.depth, options, ex, detail::no_records,
                                     [](auto&&...) { return std::uint64_t{0}; });
}

/// Draws depth and shades every visible pixel once.
///
/// @param shader  fragment_shader: from a `fragment` to a value for target.color, or to nothing if Pixel is void
/// The other parameters, the result and the errors are those of the depth-only draw; also throws invalid_input if the
/// color image's size isn't the depth image's.
template <vertex_shader VertexShader, class FragmentShader, class Pixel, depth_precision Depth = depth_precision::exact,
          executor_argument E = serial_executor>
    requires(fragment_shader<FragmentShader, varyings_of<VertexShader>, Pixel>)
draw_stats draw(const mesh_view& m, const VertexShader& vertex_shader, const FragmentShader& shader,
                const framebuffer<Pixel>& target, const draw_options<Depth>& options = {}, E&& ex = {}) {
    if constexpr (requires { target.color; }) {
        constexpr std::string_view what = "that of the depth image";
        detail::require_equal("target.color.width()", target.color.width(), target.depth.width(), what);
        detail::require_equal("target.color.height()", target.color.height(), target.depth.height(), what);
    }
    const auto shade = [&](const auto& triangles, auto& tile, float sign) {
        const rect& pixels = triangles.pixels;
        if constexpr (requires { target.background; })
            if (target.clears_color && options.load == depth_load::clear)
                for (int y = pixels.y0; y < pixels.y1; ++y)
                    std::fill_n(&target.color(pixels.x0, y), pixels.width(), target.background);
        return detail::shade(m, vertex_shader, shader, target, triangles, tile, sign);
    };
    return detail::draw_tiles<true>(m, vertex_shader, target.depth, options, ex, detail::no_records, shade);
}

/// Draws depth and shades every visible pixel once, several pixels of a row at a time.
///
/// @param shader  fragment_lane_shader; it stores its results itself
/// The other parameters, the result and the errors are those of the depth-only draw.
template <varying_shader VertexShader, class LaneShader, depth_precision Depth = depth_precision::exact,
          executor_argument E = serial_executor>
    requires(!fragment_shader<LaneShader, varyings_of<VertexShader>, void> &&
             fragment_lane_shader<LaneShader, varyings_of<VertexShader>>)
draw_stats draw(const mesh_view& m, const VertexShader& vertex_shader, const LaneShader& shader,
                const framebuffer<void>& target, const draw_options<Depth>& options = {}, E&& ex = {}) {
    using varyings = varyings_of<VertexShader>;
    detail::uninitialized_array<detail::varyings_record<varyings>> records(m.positions.size(), detail::memory_of(ex));
    const auto shade = [&](const auto& triangles, auto& tile, float sign) {
        using screen = std::remove_cvref_t<decltype(triangles.screen)>;
        if constexpr (requires { shader.clear(rect{}); })
            if (options.load == depth_load::clear) shader.clear(triangles.pixels);
        std::uint64_t shaded = 0;
        detail::dispatch(
            detail::lane_shading_kernel<screen, varyings, LaneShader>{triangles.screen, records.data(), tile,
                                                                      triangles.pixels, sign, shader, shaded},
            options.level);
        return shaded;
    };
    return detail::draw_tiles<true>(m, vertex_shader, target.depth, options, ex, records.data(), shade);
}

/// The error for shaders that `draw` cannot call.
template <class VertexShader, class Shader, class Pixel, class... Others>
    requires(!detail::drawing_shaders<VertexShader, Shader, Pixel>)
draw_stats draw(const mesh_view&, const VertexShader&, const Shader&, const framebuffer<Pixel>&, Others&&...) {
    static_assert(
        vertex_shader<VertexShader>,
        "a vertex shader takes a const vertex& and returns a glm::vec4, or a vertex_output whose varyings can "
        "be interpolated: see raster/shader.hpp");
    static_assert(!vertex_shader<VertexShader>,
                  "a fragment shader takes a const fragment<Varyings>&, of the vertex shader's varyings, and returns a "
                  "value for the framebuffer's pixel: see raster/shader.hpp");
    return {};
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
