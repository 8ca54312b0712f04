// Primitive assembly: from a mesh to triangles on the screen, culled, clipped where needed, and binned.
//
// Almost all triangles are compact: 32-bit coordinates, 64-bit edge functions. The others are wide: slivers, vertices
// beyond the compact grid, or pieces of clipped triangles. They take a slower path that is exact at any distance.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/simd/dispatch.hpp>
#include <insonify/core/simd/transpose.hpp>
#include <insonify/geometry/detail/indices.hpp>
#include <insonify/raster/detail/binning.hpp>
#include <insonify/raster/detail/screen_polygon.hpp>
#include <insonify/raster/detail/screen_triangle.hpp>
#include <insonify/raster/draw_options.hpp>

#include <bit>
#include <optional>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// The visible triangles of a chunk, and the counts of all.
struct assembled_chunk {
    tile_runs runs;
    dynamic_array<wide_triangle> wide;
    draw_stats stats;
    std::optional<std::uint32_t> bad_index;
};

template <class Screen, class Shader>
struct assembly_kernel;

/// A mesh on the screen: vertices, wide triangles, and bins that refer to triangles by id. The id of a compact triangle
/// is its index in the mesh; those of wide triangles follow, in submission order.
/// @tparam Real  type of depths: double for exact ones, float for quick ones
template <class Real>
class screen_mesh {
  public:
    using real = Real;

    /// @param has_weights  whether pixels will be shaded: exact vertices then keep 1 / w, for weights_at()
    /// @param records      varyings, one record per vertex, set here; or no_records
    template <vertex_shader Shader, class Record, depth_precision Depth, executor E>
    screen_mesh(const mesh_view& m, const Shader& shader, const pixel_grid& grid, const tile_grid& tiles,
                const draw_options<Depth>& options, bool has_weights, Record* records, E& ex)
        : mesh_(m),
          compact_count_(static_cast<std::uint32_t>(m.triangles.size())),
          grid_(grid),
          projection_(grid, options.compare, std::is_same_v<Real, double>),
          cull_(options.cull),
          vertices_(m.positions.size(), has_weights && std::is_same_v<Real, double>, memory_of(ex)) {
        bulk_ranges(ex, m.positions.size(), 8192, [&](std::size_t first, std::size_t last) {
            dispatch(vertex_kernel<Shader, Record, Real>{m, shader, records, projection_, vertices_, first, last},
                     options.level);
        });
        const std::size_t grain = (std::max)(std::size_t{4096}, (m.triangles.size() / 64 + 16) / 16 * 16);
        dynamic_array<assembled_chunk> chunks((m.triangles.size() + grain - 1) / grain);
        bulk_ranges(ex, m.triangles.size(), grain, [&](std::size_t first, std::size_t last) {
            assembled_chunk& chunk = chunks[first / grain];
            chunk.bad_index = bad_index(m.triangles.subspan(first, last - first), m.positions.size(), options.level);
            if (chunk.bad_index) return;
            chunk.stats.triangles = last - first;
            dispatch(assembly_kernel<screen_mesh, Shader>{*this, shader, tiles, first, last, chunk}, options.level);
            draw_stats& s = chunk.stats;
            s.missed = s.triangles - (s.drawn + s.culled + s.degenerate + s.not_finite);
        });
        for (const assembled_chunk& c : chunks)
            if (c.bad_index) refuse_index(*c.bad_index, m.positions.size());

        dynamic_array<tile_runs> runs;
        runs.reserve(chunks.size());
        for (assembled_chunk& c : chunks) {
            const auto offset = static_cast<std::uint32_t>(wide_.size());
            if (offset > 0 && !c.wide.empty()) c.runs.shift_ids(compact_count_, offset);
            wide_.append(c.wide);
            runs.push_back(std::move(c.runs));
            stats_ += c.stats;
        }
        bins_ = tile_bins(runs, rect{0, 0, tiles.columns, tiles.rows}, ex);
    }

    const draw_stats& stats() const { return stats_; }
    const pixel_grid& grid() const { return grid_; }
    std::span<const triangle_run> bin(std::size_t tile) const { return bins_[tile]; }

    screen_triangle operator[](std::uint32_t id) const {
        screen_triangle t{};
        if (is_compact(id)) {
            const glm::uvec3& index = mesh_.triangles[id];
            t = {vertices_[index.x], vertices_[index.y], vertices_[index.z], false, id, nullptr};
            t.front = compact_area(t.a, t.b, t.c) < 0;  // counter-clockwise as seen: y is down
        } else {
            const wide_triangle& wide = wide_[id - compact_count_];
            t = {wide.corners[0], wide.corners[1], wide.corners[2], false, wide.triangle, &wide};
            t.front = wide_area(t.a, t.b, t.c).sign() < 0;
        }
        if (t.front) std::swap(t.b, t.c);
        return t;
    }

    bool is_compact(std::uint32_t id) const { return id < compact_count_; }
    std::uint32_t compact_count() const { return compact_count_; }
    /// The index in the mesh of a triangle.
    std::uint32_t triangle(std::uint32_t id) const { return is_compact(id) ? id : wide_[id - compact_count_].triangle; }
    const glm::uvec3& indices(std::uint32_t triangle) const { return mesh_.triangles[triangle]; }
    const screen_vertices<Real>& vertices() const { return vertices_; }

    /// Vertex i of a compact triangle, in the mesh's order.
    INSONIFY_INLINE const packed_vertex<Real>& vertex(std::size_t triangle, int i) const {
        return vertices_.packed[mesh_.triangles[triangle][i]];
    }

  private:
    template <class Screen, class Shader>
    friend struct assembly_kernel;

    /// The counter that a triangle belongs to.
    using outcome = std::uint64_t draw_stats::*;

    bool is_culled(bool front) const {
        return (cull_ == cull_mode::back && !front) || (cull_ == cull_mode::front && front);
    }

    /// Appends one triangle to the runs, if it is visible.
    template <vertex_shader Shader>
    outcome assemble(const Shader& shader, std::size_t triangle, const tile_grid& tiles, assembled_chunk& out) const {
        const auto id = static_cast<std::uint32_t>(triangle);
        for (int i = 0; i < 3; ++i)
            if (vertex(triangle, i).position.is_off_grid()) return assemble_wide(shader, id, tiles, out);
        const glm::uvec3& index = mesh_.triangles[triangle];
        const screen_vertex a = vertices_[index.x], b = vertices_[index.y], c = vertices_[index.z];
        const rect pixels = centre_rect(a, b, c, grid_);
        if (is_outside(pixels, grid_)) return &draw_stats::missed;
        const std::int64_t area = compact_area(a, b, c);
        if (area == 0) return &draw_stats::degenerate;
        if (is_culled(area < 0)) return &draw_stats::culled;
        if (pixels.empty()) return &draw_stats::missed;
        const std::int64_t width = (std::max)({a.x, b.x, c.x}) - (std::min)({a.x, b.x, c.x});
        const std::int64_t height = (std::max)({a.y, b.y, c.y}) - (std::min)({a.y, b.y, c.y});
        if (is_sliver(width, height, area)) return assemble_wide(shader, id, tiles, out);
        out.runs.add(id, 1, tiles.touched(pixels), is_small(width, height));
        return &draw_stats::drawn;
    }

    /// The same for a triangle that may have to be clipped, or that takes 128 bits.
    template <vertex_shader Shader>
    outcome assemble_wide(const Shader& shader, std::uint32_t triangle, const tile_grid& tiles,
                          assembled_chunk& out) const {
        std::array<glm::dvec4, 3> clip;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec4 p(position_of(shader(mesh_vertex(mesh_, mesh_.triangles[triangle][i]))));
            if (!(numeric::is_finite(p.x) && numeric::is_finite(p.y) && numeric::is_finite(p.z) &&
                  numeric::is_finite(p.w)))
                return &draw_stats::not_finite;
            clip[static_cast<std::size_t>(i)] = p;
        }
        const clip_polygon polygon = projection_.clip(clip);
        if (polygon.was_cut) ++out.stats.clipped;
        if (polygon.count < 3) return &draw_stats::missed;

        const screen_polygon on_screen(polygon, projection_);
        if (is_outside(on_screen.pixels(grid_), grid_)) return &draw_stats::missed;
        if (on_screen.area_sign() == 0) return &draw_stats::degenerate;
        if (is_culled(on_screen.area_sign() < 0)) return &draw_stats::culled;
        outcome result = &draw_stats::missed;
        on_screen.for_each_part(grid_, [&](std::array<int, 3> corners, const rect& pixels, bool is_span) {
            wide_triangle part{};
            for (std::size_t k = 0; k < 3; ++k) {
                part.corners[k] = on_screen.at(corners[k]);
                part.weights[k] = polygon.corners[static_cast<std::size_t>(corners[k])].weights;
            }
            part.triangle = triangle;
            if (is_span) part.span = pixels;
            out.runs.add(compact_count_ + static_cast<std::uint32_t>(out.wide.size()), 1, tiles.touched(pixels), false);
            out.wide.push_back(part);
            result = &draw_stats::drawn;
        });
        return result;
    }

    mesh_view mesh_;
    std::uint32_t compact_count_;  ///< ids below this are indices into the mesh, the others wide triangles
    pixel_grid grid_;
    projection projection_;
    cull_mode cull_;
    screen_vertices<Real> vertices_;
    dynamic_array<wide_triangle> wide_;
    tile_bins bins_;
    draw_stats stats_;
};

/// Assembles the triangles of a chunk, small ones as many at a time as there are lanes.
template <class Screen, class Shader>
struct assembly_kernel {
    const Screen& screen;
    const Shader& shader;
    const tile_grid& tiles;
    std::size_t first, last;
    assembled_chunk& out;

    template <int N>
    INSONIFY_INLINE void run() const {
        const drawn_area<N> picture(screen.grid_, screen.grid_.pixels());
        std::size_t i = first;
        for (; i + N <= last; i += N)
            if (!assemble_small<N>(i, picture))
                for (std::size_t k = i; k < i + N; ++k) assemble_one(k);
        for (; i < last; ++i) assemble_one(i);
    }

  private:
    /// Out of line: clipping would be compiled into each copy of the kernel.
    INSONIFY_RARE void assemble_one(std::size_t triangle) const {
        ++(out.stats.*screen.assemble(shader, triangle, tiles, out));
    }

    /// @returns false, counting nothing, if a triangle is off the grid, large or a sliver; true at once if all lie
    ///          outside of the picture, large ones too: in a close-up, most triangles do
    template <int N>
    INSONIFY_INLINE bool assemble_small(std::size_t triangle, const drawn_area<N>& picture) const {
        using ints = lanes<std::int32_t, N>;
        const triangle_lanes<N> t([&](int i, ints& x, ints& y) INSONIFY_INLINE_LAMBDA {
            gather_pairs<N>(
                x, y, [&](int k) { return &screen.vertex(triangle + static_cast<std::size_t>(k), i).position.x; });
        });
        if (!t.are_on_grid()) return false;
        constexpr unsigned all = (1u << N) - 1;
        rect_lanes<N> pixels;
        t.centres(picture, pixels);
        ints disjoint;
        pixels.is_disjoint(picture.pixels, disjoint);
        const unsigned outside = movemask<N>(disjoint);
        if (outside == all) return true;
        if (!t.are_small()) return false;
        ints area, sliver, empty, culled = ints{};
        t.area(area);
        t.is_sliver(area, sliver);
        if (screen.cull_ == cull_mode::back) culled = ints(area > 0);
        if (screen.cull_ == cull_mode::front) culled = ints(area < 0);
        pixels.intersect(picture.pixels);
        pixels.is_empty(empty);

        const int size = tiles.log2_size;  // see tile_range::pack
        const ints first_tile = ints((pixels.x0 >> size) | (pixels.y0 >> size << 16)),
                   last_tile = ints(((pixels.x1 - 1) >> size) | ((pixels.y1 - 1) >> size << 16));
        const unsigned degenerate = movemask<N>(ints(area == 0)) & ~outside,
                       culled_mask = movemask<N>(culled) & ~outside,
                       drawn = all & ~(movemask<N>(empty) | degenerate | culled_mask);
        if ((movemask<N>(sliver) & drawn) != 0) return false;
        out.stats.degenerate += static_cast<unsigned>(std::popcount(degenerate));
        out.stats.culled += static_cast<unsigned>(std::popcount(culled_mask));
        out.stats.drawn += static_cast<unsigned>(std::popcount(drawn));
        out.runs.template add_small<N>(static_cast<std::uint32_t>(triangle), drawn, first_tile, last_tile);
        return true;
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
