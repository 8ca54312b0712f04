// From mesh to screen: vertices placed and snapped, triangles culled, the few that need it clipped, all put into bins.
//
// Almost all triangles are compact: 32-bit coordinates, 64-bit decisions. The others go a slower way that no distance
// and no number of clipping planes makes less exact.
#pragma once

#include <insonify/core/linear.hpp>
#include <insonify/geometry/mesh.hpp>
#include <insonify/raster/binning.hpp>
#include <insonify/raster/clip.hpp>
#include <insonify/raster/depth.hpp>
#include <insonify/raster/fold.hpp>
#include <insonify/raster/shader.hpp>

#include <optional>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI {

/// Which side of a triangle is not drawn; its front is where its vertices run counter-clockwise.
enum class cull_mode { none, back, front };

/// What became of a mesh's triangles. Nothing that a draw meets by the million is an error.
/// Each of `triangles` is counted once among drawn, culled, missed, degenerate and not_finite.
struct draw_stats {
    std::uint64_t triangles = 0;   ///< submitted
    std::uint64_t drawn = 0;       ///< reached the pixel loop
    std::uint64_t culled = 0;      ///< faced the wrong way
    std::uint64_t missed = 0;      ///< covered no pixel centre of the picture
    std::uint64_t degenerate = 0;  ///< no area left on the sub-pixel grid
    std::uint64_t not_finite = 0;  ///< a vertex was NaN or infinite
    std::uint64_t clipped = 0;     ///< of all these, how many were cut by a clipping plane
    std::uint64_t pixels = 0;      ///< shaded; 0 for depth alone

    draw_stats& operator+=(const draw_stats& other) {
        triangles += other.triangles;
        drawn += other.drawn;
        culled += other.culled;
        missed += other.missed;
        degenerate += other.degenerate;
        not_finite += other.not_finite;
        clipped += other.clipped;
        pixels += other.pixels;
        return *this;
    }
    friend bool operator==(const draw_stats&, const draw_stats&) = default;
};

namespace detail {

/// A vertex inside all clipping planes and compact on the grid, as millions of them are kept.
struct compact_vertex {
    std::int32_t x, y;
    double z, inverse_w;

    static compact_vertex of(const screen_vertex& v) {
        return {static_cast<std::int32_t>(v.x), static_cast<std::int32_t>(v.y), v.z, v.inverse_w};
    }
    operator screen_vertex() const { return {x, y, z, inverse_w}; }
};

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

inline vertex mesh_vertex(const mesh& m, std::uint32_t index) {
    return {m.positions[index], m.normals.empty() ? glm::vec3(0) : m.normals[index], index};
}

/// A mesh on the screen: its vertices, the triangles that need more room, and the bins that refer to both.
class screen_mesh {
  public:
    template <vertex_shader Shader, executor E>
    screen_mesh(const mesh& m, const Shader& shader, const pixel_grid& grid, const tile_grid& tiles, cull_mode cull,
                keep_depth keep, E& ex)
        : mesh_(m), grid_(grid), projection_(grid, keep), cull_(cull), vertices_(m.positions.size()) {
        place_vertices(shader, ex);
        const std::size_t grain = (std::max)(std::size_t{4096}, m.triangles.size() / 64 + 1);
        std::vector<chunk> chunks((m.triangles.size() + grain - 1) / grain);
        bulk_ranges(ex, m.triangles.size(), grain, [&](std::size_t first, std::size_t last) {
            assemble(shader, tiles, first, last, chunks[first / grain]);
        });
        for (const chunk& c : chunks)
            if (c.bad_index) detail::refuse("mesh.triangles", *c.bad_index, "an index of a position");

        // Wide triangles get names behind those of compact ones, in submission order.
        std::vector<tile_pairs> pairs;
        pairs.reserve(chunks.size());
        for (chunk& c : chunks) {
            const auto offset = static_cast<std::uint32_t>(wide_.size());
            if (offset > 0 && !c.wide.empty())
                for (auto& pair : c.pairs.pairs)
                    if (pair.triangle >= whole()) pair.triangle += offset;
            wide_.insert(wide_.end(), c.wide.begin(), c.wide.end());
            pairs.push_back(std::move(c.pairs));
            stats_ += c.stats;
        }
        bins_ = tile_bins(pairs, tiles.count(), ex);
    }

    const draw_stats& stats() const { return stats_; }
    const pixel_grid& grid() const { return grid_; }
    std::span<const std::uint32_t> bin(std::size_t tile) const { return bins_[tile]; }

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

  private:
    struct chunk {
        tile_pairs pairs;
        std::vector<wide_triangle> wide;
        draw_stats stats;
        std::optional<std::uint32_t> bad_index;
    };
    static constexpr std::int32_t off_grid = (std::numeric_limits<std::int32_t>::min)();

    std::uint32_t whole() const { return static_cast<std::uint32_t>(mesh_.triangles.size()); }

    /// Compact vertices. The others are marked and seen to triangle by triangle.
    template <vertex_shader Shader, executor E>
    void place_vertices(const Shader& shader, E& ex) {
        bulk_ranges(ex, vertices_.size(), 8192, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                const glm::dvec4 clip(clip_position(shader, mesh_vertex(mesh_, static_cast<std::uint32_t>(i))));
                vertices_[i] = projection_.is_compact(clip) ? compact_vertex::of(projection_.to_screen(clip))
                                                            : compact_vertex{off_grid, 0, 0, 0};
            }
        });
    }

    template <vertex_shader Shader>
    void assemble(const Shader& shader, const tile_grid& tiles, std::size_t first, std::size_t last, chunk& out) const {
        const std::size_t vertices = vertices_.size();
        out.stats.triangles = last - first;
        for (std::size_t i = first; i < last; ++i) {
            const glm::uvec3& index = mesh_.triangles[i];
            if (index.x >= vertices || index.y >= vertices || index.z >= vertices) {
                out.bad_index = (std::max)({index.x, index.y, index.z});
                return;
            }
            const compact_vertex &a = vertices_[index.x], &b = vertices_[index.y], &c = vertices_[index.z];
            const auto name = static_cast<std::uint32_t>(i);
            const bool compact = a.x != off_grid && b.x != off_grid && c.x != off_grid;
            count(out.stats, compact ? bin_compact(a, b, c, name, tiles, out) : bin_wide(shader, name, tiles, out));
        }
    }

    /// Counted in draw_stats under these names.
    enum class fate { drawn, culled, missed, degenerate, not_finite };

    static void count(draw_stats& stats, fate f) {
        switch (f) {
            case fate::drawn: ++stats.drawn; break;
            case fate::culled: ++stats.culled; break;
            case fate::missed: ++stats.missed; break;
            case fate::degenerate: ++stats.degenerate; break;
            case fate::not_finite: ++stats.not_finite; break;
        }
    }

    bool is_culled(bool front) const {
        return (cull_ == cull_mode::back && !front) || (cull_ == cull_mode::front && front);
    }

    /// Notes a triangle in the bins, unless it can't be seen.
    fate bin_compact(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c, std::uint32_t name,
                     const tile_grid& tiles, chunk& out) const {
        const std::int64_t area = compact_area(a, b, c);
        if (area == 0) return fate::degenerate;
        if (is_culled(area < 0)) return fate::culled;
        const pixel_box box = center_box(a, b, c, grid_);
        if (box.empty()) return fate::missed;
        out.pairs.add(name, box, tiles);
        return fate::drawn;
    }

    /// The same for a triangle that may have to be clipped, or whose vertices only 128 bits can compare.
    template <vertex_shader Shader>
    fate bin_wide(const Shader& shader, std::uint32_t triangle, const tile_grid& tiles, chunk& out) const {
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
            out.pairs.add(whole() + static_cast<std::uint32_t>(out.wide.size()), box, tiles);
            out.wide.push_back(part);
            f = fate::drawn;
        });
        return f;
    }

    const mesh& mesh_;
    pixel_grid grid_;
    projection projection_;
    cull_mode cull_;
    std::vector<compact_vertex> vertices_;
    std::vector<wide_triangle> wide_;
    tile_bins bins_;
    draw_stats stats_;
};

}  // namespace detail
}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
