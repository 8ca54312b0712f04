// From mesh to screen: vertices placed and snapped, triangles culled, the few that need it clipped, all put into bins.
//
// Almost all triangles are compact: 32-bit coordinates, 64-bit decisions. The others go a slower way that no distance
// and no number of clipping planes makes less exact.
#pragma once

#include <insonify/core/linear.hpp>
#include <insonify/core/simd/dispatch.hpp>
#include <insonify/geometry/detail/indices.hpp>
#include <insonify/raster/detail/binning.hpp>
#include <insonify/raster/detail/depth.hpp>
#include <insonify/raster/detail/fold.hpp>
#include <insonify/raster/detail/placement.hpp>
#include <insonify/raster/draw_stats.hpp>

#include <bit>
#include <optional>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Which side of a triangle is not drawn; its front is where its vertices run counter-clockwise.
enum class cull_mode { none, back, front };

/// How to draw. `tile` and `level` never change a bit of the result.
struct draw_options {
    cull_mode cull = cull_mode::none;
    keep_depth keep = keep_depth::smaller;
    depth_load load = depth_load::keep;
    int subpixel_bits = 8;   ///< 4 to 16: vertices are rounded to 2^-bits pixels
    int tile = 64;           ///< pixels, a power of two from 8 to 256
    isa level = best_isa();  ///< the widest instruction set to use
};

namespace detail::inline INSONIFY_FLAGS {

/// A triangle with a vertex that isn't compact, or a piece of one that was clipped.
struct wide_triangle {
    std::array<screen_vertex, 3> corners;
    std::array<glm::dvec3, 3> shares;  ///< of the mesh triangle's vertices in each corner
    std::uint32_t triangle;
    pixel_box run;  ///< if not empty, the pixels it covers, whatever the corners say
};

/// A triangle as bins refer to it: its corners in clockwise order on the screen.
struct screen_triangle {
    screen_vertex a, b, c;
    bool front;
    std::uint32_t triangle;     ///< of the mesh
    const wide_triangle* wide;  ///< null for a compact one

    /// Its pixels are listed, not computed.
    bool is_run() const { return wide != nullptr && !wide->run.empty(); }

    /// Perspective-correct shares of the mesh triangle's three vertices at a pixel's centre; they sum to one.
    glm::dvec3 weights_at(int x, int y, const pixel_grid& grid) const {
        const auto opposite = [&](const screen_vertex& from, const screen_vertex& to) {
            const std::int64_t run = to.x - from.x, rise = to.y - from.y;
            const std::int64_t right = grid.center(x) - from.x, down = grid.center(y) - from.y;
            if (wide == nullptr) return static_cast<double>(compact_side(run, rise, right, down));
            // A run may reach out of the corners' plane by a hair, where a share would be negative.
            const double share = double_double::from(wide_side(run, rise, right, down)).high;
            return share > 0 ? share : 0.0;
        };
        const double wa = opposite(b, c) * a.inverse_w;
        const double wb = opposite(c, a) * b.inverse_w;
        const double wc = opposite(a, b) * c.inverse_w;
        const double scale = 1.0 / (wa + wb + wc);
        glm::dvec3 w(wa * scale, wb * scale, wc * scale);
        if (front) std::swap(w.y, w.z);  // b and c stand in the mesh's other order
        return wide == nullptr ? w : numeric::product(glm::dmat3(wide->shares[0], wide->shares[1], wide->shares[2]), w);
    }
};

/// Names the triangles of a chunk that can be seen, and counts the others.
struct assembled_chunk {
    tile_runs runs;
    std::vector<wide_triangle> wide;
    draw_stats stats;
    std::optional<std::uint32_t> bad_index;
};

template <class Screen, class Shader>
struct assembly_kernel;

/// A mesh on the screen: its vertices, the triangles that need more room, and the bins that refer to both.
/// Depths are kept as Real: double where they are to be exact.
template <class Real>
class screen_mesh {
  public:
    /// @param weighed  whether weights_at will be asked for
    /// @param records  one for each vertex, to be set; or null and no_record
    template <vertex_shader Shader, class Record, executor E>
    screen_mesh(const mesh_view& m, const Shader& shader, const pixel_grid& grid, const tile_grid& tiles,
                const draw_options& options, bool weighed, Record* records, E& ex)
        : mesh_(m),
          indices_(m.triangles.data()),
          whole_(static_cast<std::uint32_t>(m.triangles.size())),
          grid_(grid),
          projection_(grid, options.keep, std::is_same_v<Real, double>),
          cull_(options.cull),
          vertices_(m.positions.size(), weighed, memory_of(ex)) {
        bulk_ranges(ex, m.positions.size(), 8192, [&](std::size_t first, std::size_t last) {
            dispatch(placement_kernel<Shader, Record, Real>{m, shader, records, projection_, vertices_, first, last},
                     options.level);
        });
        const std::size_t grain = (std::max)(std::size_t{4096}, (m.triangles.size() / 64 + 16) / 16 * 16);
        std::vector<assembled_chunk> chunks((m.triangles.size() + grain - 1) / grain);
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
            if (c.bad_index) detail::refuse("mesh.triangles", *c.bad_index, "an index of a position");

        // Wide triangles get names behind those of compact ones, in submission order.
        std::vector<tile_runs> runs;
        runs.reserve(chunks.size());
        for (assembled_chunk& c : chunks) {
            const auto offset = static_cast<std::uint32_t>(wide_.size());
            if (offset > 0 && !c.wide.empty()) c.runs.rename(whole(), offset);
            wide_.insert(wide_.end(), c.wide.begin(), c.wide.end());
            runs.push_back(std::move(c.runs));
            stats_ += c.stats;
        }
        bins_ = tile_bins(runs, tiles, ex);
    }

    const draw_stats& stats() const { return stats_; }
    const pixel_grid& grid() const { return grid_; }
    std::span<const triangle_run> bin(std::size_t tile) const { return bins_[tile]; }

    screen_triangle operator[](std::uint32_t name) const {
        screen_triangle t{};
        if (name < whole()) {
            const glm::uvec3& index = mesh_.triangles[name];
            t = {vertices_[index.x], vertices_[index.y], vertices_[index.z], false, name, nullptr};
            t.front = compact_area(t.a, t.b, t.c) < 0;  // counter-clockwise as seen, y being down
        } else {
            const wide_triangle& wide = wide_[name - whole()];
            t = {wide.corners[0], wide.corners[1], wide.corners[2], false, wide.triangle, &wide};
            t.front = wide_area(t.a, t.b, t.c).sign() < 0;
        }
        if (t.front) std::swap(t.b, t.c);
        return t;
    }

    bool has_wide() const { return !wide_.empty(); }
    bool is_compact(std::uint32_t name) const { return name < whole(); }
    /// The mesh's triangle that goes by a name, and its vertices.
    std::uint32_t triangle(std::uint32_t name) const {
        return is_compact(name) ? name : wide_[name - whole()].triangle;
    }
    const glm::uvec3& indices(std::uint32_t triangle) const { return indices_[triangle]; }
    const kept_vertex<Real>* vertices() const { return vertices_.kept.data(); }
    std::uint32_t compact_names() const { return whole_; }

    /// Of a triangle that isn't wide, corner by corner in the mesh's order.
    INSONIFY_INLINE const kept_vertex<Real>& corner(std::size_t triangle, int i) const {
        return vertices_.kept[indices_[triangle][i]];
    }

  private:
    template <class Screen, class Shader>
    friend struct assembly_kernel;

    std::uint32_t whole() const { return whole_; }

    /// Counted in draw_stats under these names.
    enum class fate { drawn, culled, missed, degenerate, not_finite };

    static void count(draw_stats& stats, fate f) {
        switch (f) {
            case fate::drawn: ++stats.drawn; break;
            case fate::culled: ++stats.culled; break;
            case fate::missed: break;  // what is left
            case fate::degenerate: ++stats.degenerate; break;
            case fate::not_finite: ++stats.not_finite; break;
        }
    }

    bool is_culled(bool front) const {
        return (cull_ == cull_mode::back && !front) || (cull_ == cull_mode::front && front);
    }

    /// Notes one triangle in the runs, unless it can't be seen.
    template <vertex_shader Shader>
    fate assemble(const Shader& shader, std::size_t triangle, const tile_grid& tiles, assembled_chunk& out) const {
        const auto name = static_cast<std::uint32_t>(triangle);
        for (int corner = 0; corner < 3; ++corner)
            if (this->corner(triangle, corner).place.is_off_grid()) return assemble_wide(shader, name, tiles, out);
        const glm::uvec3& index = mesh_.triangles[triangle];
        const screen_vertex a = vertices_[index.x], b = vertices_[index.y], c = vertices_[index.z];
        if (is_outside(a, b, c, grid_)) return fate::missed;
        const std::int64_t area = compact_area(a, b, c);
        if (area == 0) return fate::degenerate;
        if (is_culled(area < 0)) return fate::culled;
        const pixel_box box = center_box(a, b, c, grid_);
        if (box.empty()) return fate::missed;
        out.runs.add(name, 1, tile_range::of(tiles.touched(box)), false);
        return fate::drawn;
    }

    /// The same for a triangle that may have to be clipped, or whose vertices only 128 bits can compare.
    template <vertex_shader Shader>
    fate assemble_wide(const Shader& shader, std::uint32_t triangle, const tile_grid& tiles,
                       assembled_chunk& out) const {
        std::array<glm::dvec4, 3> clip;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec4 p(clip_position(shader, mesh_vertex(mesh_, mesh_.triangles[triangle][i])));
            if (!(numeric::is_finite(p.x) && numeric::is_finite(p.y) && numeric::is_finite(p.z) &&
                  numeric::is_finite(p.w)))
                return fate::not_finite;
            clip[static_cast<std::size_t>(i)] = p;
        }
        const clip_polygon polygon = projection_.clip(clip);
        if (polygon.cut) ++out.stats.clipped;
        if (polygon.count < 3) return fate::missed;

        const screen_polygon on_screen(polygon, projection_);
        if (on_screen.area_sign() == 0) return fate::degenerate;
        if (is_culled(on_screen.area_sign() < 0)) return fate::culled;
        fate f = fate::missed;
        on_screen.for_each_part(grid_, [&](std::array<int, 3> corners, const pixel_box& box, bool is_run) {
            wide_triangle part{};
            for (std::size_t k = 0; k < 3; ++k) {
                part.corners[k] = on_screen.at(corners[k]);
                part.shares[k] = polygon.corners[static_cast<std::size_t>(corners[k])].shares;
            }
            part.triangle = triangle;
            part.run = is_run ? box : pixel_box{0, 0, -1, -1};
            out.runs.add(whole() + static_cast<std::uint32_t>(out.wide.size()), 1, tile_range::of(tiles.touched(box)),
                         false);
            out.wide.push_back(part);
            f = fate::drawn;
        });
        return f;
    }

    mesh_view mesh_;
    const glm::uvec3* indices_;
    std::uint32_t whole_;  ///< names below this are triangles of the mesh, the others wide ones
    pixel_grid grid_;
    projection projection_;
    cull_mode cull_;
    screen_vertices<Real> vertices_;
    std::vector<wide_triangle> wide_;
    tile_bins bins_;
    draw_stats stats_;
};

/// Goes through the triangles of a chunk, as many small ones at a time as there are lanes.
template <class Screen, class Shader>
struct assembly_kernel {
    const Screen& screen;
    const Shader& shader;
    const tile_grid& tiles;
    std::size_t first, last;
    assembled_chunk& out;

    template <int N>
    INSONIFY_INLINE void run() const {
        const drawn_area<N> picture(screen.grid_, {0, 0, screen.grid_.width - 1, screen.grid_.height - 1});
        std::size_t i = first;
        for (; i + N <= last; i += N)
            if (!assemble_small<N>(i, picture))
                for (std::size_t k = i; k < i + N; ++k) assemble_one(k);
        for (; i < last; ++i) assemble_one(i);
    }

  private:
    void assemble_one(std::size_t triangle) const {
        Screen::count(out.stats, screen.assemble(shader, triangle, tiles, out));
    }

    /// Gives up if one of them isn't small, unless all lie outside of the picture: seen from close by, most of a
    /// surface's triangles do, and are large.
    template <int N>
    INSONIFY_INLINE bool assemble_small(std::size_t triangle, const drawn_area<N>& picture) const {
        using ints = lanes<std::int32_t, N>;
        const corner_lanes<N> at([&](int corner, ints& x, ints& y) INSONIFY_INLINE_LAMBDA {
            gather_pairs<N>(
                x, y, [&](int k) { return &screen.corner(triangle + static_cast<std::size_t>(k), corner).place.x; });
        });
        if (!at.are_on_grid()) return false;
        constexpr unsigned all = (1u << N) - 1;
        box_lanes<N> box;
        at.centers(picture, box);
        ints outside;
        box.is_beside(picture.box, outside);
        const unsigned far_off = set_lanes<N>(outside);
        if (far_off == all) return true;
        if (!at.are_small()) return false;
        ints area, empty, culled = ints{};
        at.area(area);
        if (screen.cull_ == cull_mode::back) culled = ints(area > 0);
        if (screen.cull_ == cull_mode::front) culled = ints(area < 0);
        box.cut_to(picture.box);
        box.is_empty(empty);

        const auto name = static_cast<std::uint32_t>(triangle);
        const ints first_tile =
                       ints((box.x0 >> tiles.log2_size) | (box.y0 >> tiles.log2_size << 16)),  // see tile_range
            last_tile = ints((box.x1 >> tiles.log2_size) | (box.y1 >> tiles.log2_size << 16));
        const unsigned flat = set_lanes<N>(ints(area == 0)) & ~far_off, turned = set_lanes<N>(culled) & ~far_off,
                       drawn = all & ~(set_lanes<N>(empty) | flat | turned);
        out.stats.degenerate += static_cast<unsigned>(std::popcount(flat));
        out.stats.culled += static_cast<unsigned>(std::popcount(turned));
        out.stats.drawn += static_cast<unsigned>(std::popcount(drawn));
        // Most of the time they all go the same way.
        const std::int32_t one_first = lane(first_tile, 0), one_last = lane(last_tile, 0);
        if (drawn == all && !any(ints(((first_tile ^ one_first) | (last_tile ^ one_last)) != 0))) {
            out.runs.add(name, N, {static_cast<std::uint32_t>(one_first), static_cast<std::uint32_t>(one_last)}, true);
            return true;
        }
        std::uint32_t firsts[static_cast<unsigned>(N)], lasts[static_cast<unsigned>(N)];
        store(firsts, first_tile);
        store(lasts, last_tile);
        for (unsigned left = drawn; left != 0; left &= left - 1) {
            const auto k = static_cast<unsigned>(std::countr_zero(left));
            out.runs.add(name + k, 1, {firsts[k], lasts[k]}, true);
        }
        return true;
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
