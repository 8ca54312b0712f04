// From mesh to screen: vertices placed and snapped, triangles culled, the few that need it clipped, all put into bins.
#pragma once

#include <insonify/geometry/mesh.hpp>
#include <insonify/raster/binning.hpp>
#include <insonify/raster/clip.hpp>
#include <insonify/raster/shader.hpp>

#include <atomic>

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

/// A piece of a clipped triangle, with the share of the whole triangle's vertices in each of its corners.
struct clipped_triangle {
    std::array<screen_vertex, 3> corners;
    std::array<glm::vec3, 3> shares;
    std::uint32_t triangle;
};

/// A triangle as bins refer to it: its corners in clockwise order on the screen.
struct screen_triangle {
    screen_vertex a, b, c;
    bool front;
    std::uint32_t triangle;           ///< of the mesh
    const clipped_triangle* clipped;  ///< null for a whole one

    /// Perspective-correct shares of the mesh triangle's three vertices at a pixel's centre; they sum to one.
    glm::vec3 weights_at(int x, int y, const pixel_grid& grid) const {
        const auto opposite = [&](const screen_vertex& from, const screen_vertex& to) {
            return static_cast<double>((std::int64_t{to.x} - from.x) * (grid.center(y) - from.y) -
                                       (std::int64_t{to.y} - from.y) * (grid.center(x) - from.x));
        };
        const double wa = opposite(b, c) * static_cast<double>(a.inverse_w);
        const double wb = opposite(c, a) * static_cast<double>(b.inverse_w);
        const double wc = opposite(a, b) * static_cast<double>(c.inverse_w);
        const double scale = 1.0 / (wa + wb + wc);
        glm::vec3 w(static_cast<float>(wa * scale), static_cast<float>(wb * scale), static_cast<float>(wc * scale));
        if (front) std::swap(w.y, w.z);  // b and c stand in the mesh's other order
        return clipped == nullptr ? w : w.x * clipped->shares[0] + w.y * clipped->shares[1] + w.z * clipped->shares[2];
    }
};

inline vertex mesh_vertex(const mesh& m, std::uint32_t index) {
    return {m.positions[index], m.normals.empty() ? glm::vec3(0) : m.normals[index], index};
}

/// A mesh on the screen: its vertices, the pieces that clipping made, and the bins that refer to both.
class screen_mesh {
  public:
    template <vertex_shader Shader, executor E>
    screen_mesh(const mesh& m, const Shader& shader, const pixel_grid& grid, const tile_grid& tiles, cull_mode cull,
                keep_depth keep, E& ex)
        : mesh_(m), grid_(grid), projection_(grid, keep), cull_(cull), vertices_(m.positions.size()) {
        place_vertices(shader, ex);
        const std::size_t grain = (std::max)(std::size_t{4096}, m.triangles.size() / 64 + 1);
        std::vector<chunk> chunks((m.triangles.size() + grain - 1) / grain);
        std::atomic<std::uint32_t> bad_index{0};
        bulk_ranges(ex, m.triangles.size(), grain, [&](std::size_t first, std::size_t last) {
            assemble(shader, tiles, first, last, chunks[first / grain], bad_index);
        });
        detail::require(bad_index == 0, "mesh.triangles", bad_index.load(), "an index of a position");

        // Pieces of clipped triangles get names behind those of whole ones, in submission order.
        std::vector<tile_pairs> pairs;
        pairs.reserve(chunks.size());
        for (chunk& c : chunks) {
            const auto offset = static_cast<std::uint32_t>(clipped_.size());
            if (offset > 0 && !c.clipped.empty())
                for (auto& pair : c.pairs.pairs)
                    if (pair.triangle >= whole()) pair.triangle += offset;
            clipped_.insert(clipped_.end(), c.clipped.begin(), c.clipped.end());
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
        } else {
            const clipped_triangle& piece = clipped_[name - whole()];
            t = {piece.corners[0], piece.corners[1], piece.corners[2], false, piece.triangle, &piece};
        }
        if (doubled_area(t.a, t.b, t.c) < 0) {  // counter-clockwise as seen, y being down
            t.front = true;
            std::swap(t.b, t.c);
        }
        return t;
    }

  private:
    struct chunk {
        tile_pairs pairs;
        std::vector<clipped_triangle> clipped;
        draw_stats stats;
    };
    static constexpr std::int32_t off_grid = (std::numeric_limits<std::int32_t>::min)();

    std::uint32_t whole() const { return static_cast<std::uint32_t>(mesh_.triangles.size()); }

    /// Fast path: vertices inside all clipping planes. The others are marked and seen to triangle by triangle.
    template <vertex_shader Shader, executor E>
    void place_vertices(const Shader& shader, E& ex) {
        bulk_ranges(ex, vertices_.size(), 8192, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                const glm::dvec4 clip(clip_position(shader, mesh_vertex(mesh_, static_cast<std::uint32_t>(i))));
                vertices_[i] = projection_.holds(clip) ? projection_.to_screen(clip) : screen_vertex{off_grid, 0, 0, 0};
            }
        });
    }

    template <vertex_shader Shader>
    void assemble(const Shader& shader, const tile_grid& tiles, std::size_t first, std::size_t last, chunk& out,
                  std::atomic<std::uint32_t>& bad_index) const {
        const std::size_t vertices = vertices_.size();
        out.stats.triangles = last - first;
        for (std::size_t i = first; i < last; ++i) {
            const glm::uvec3& index = mesh_.triangles[i];
            if (index.x >= vertices || index.y >= vertices || index.z >= vertices) {
                bad_index = (std::max)({index.x, index.y, index.z});
                return;
            }
            const screen_vertex &a = vertices_[index.x], &b = vertices_[index.y], &c = vertices_[index.z];
            const auto name = static_cast<std::uint32_t>(i);
            const bool on_grid = a.x != off_grid && b.x != off_grid && c.x != off_grid;
            count(out.stats,
                  on_grid ? bin_triangle(a, b, c, name, tiles, out) : clip_triangle(shader, name, tiles, out));
        }
    }

    /// Counted in draw_stats under these names; of a clipped triangle's pieces the first of these counts.
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

    /// Notes a triangle or a piece of one in the bins, unless it can't be seen.
    fate bin_triangle(const screen_vertex& a, const screen_vertex& b, const screen_vertex& c, std::uint32_t name,
                      const tile_grid& tiles, chunk& out) const {
        const std::int64_t area = doubled_area(a, b, c);
        if (area == 0) return fate::degenerate;
        const bool front = area < 0;
        if ((cull_ == cull_mode::back && !front) || (cull_ == cull_mode::front && front)) return fate::culled;
        const pixel_box box = intersect(center_box(a, b, c, grid_), {0, 0, grid_.width - 1, grid_.height - 1});
        if (box.empty()) return fate::missed;
        out.pairs.add(name, box, tiles);
        return fate::drawn;
    }

    template <vertex_shader Shader>
    fate clip_triangle(const Shader& shader, std::uint32_t triangle, const tile_grid& tiles, chunk& out) const {
        std::array<glm::dvec4, 3> clip;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec4 p(clip_position(shader, mesh_vertex(mesh_, mesh_.triangles[triangle][i])));
            if (!(numeric::is_finite(p.x) && numeric::is_finite(p.y) && numeric::is_finite(p.z) &&
                  numeric::is_finite(p.w)))
                return fate::not_finite;
            clip[static_cast<std::size_t>(i)] = p;
        }
        ++out.stats.clipped;
        const clip_polygon polygon = projection_.clip(clip);
        const auto corner = [&](int i) -> const clip_corner& { return polygon.corners[static_cast<std::size_t>(i)]; };
        fate whole_fate = polygon.count < 3 ? fate::missed : fate::degenerate;
        for (int i = 1; i + 1 < polygon.count; ++i) {
            const std::array<const clip_corner*, 3> fan{&corner(0), &corner(i), &corner(i + 1)};
            clipped_triangle piece{};
            for (std::size_t k = 0; k < 3; ++k) {
                piece.corners[k] = projection_.to_screen(fan[k]->position);
                piece.shares[k] = glm::vec3(fan[k]->shares);
            }
            piece.triangle = triangle;
            const auto name = whole() + static_cast<std::uint32_t>(out.clipped.size());
            const fate f = bin_triangle(piece.corners[0], piece.corners[1], piece.corners[2], name, tiles, out);
            if (f == fate::drawn) out.clipped.push_back(piece);
            whole_fate = (std::min)(whole_fate, f);
        }
        return whole_fate;
    }

    const mesh& mesh_;
    pixel_grid grid_;
    projection projection_;
    cull_mode cull_;
    std::vector<screen_vertex> vertices_;
    std::vector<clipped_triangle> clipped_;
    tile_bins bins_;
    draw_stats stats_;
};

}  // namespace detail
}  // namespace insonify::inline INSONIFY_ABI
