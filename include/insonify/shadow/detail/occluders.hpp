// Casters projected onto one plane of a light: vertices in (u, v, height), and for each tile of the plane the triangles
// that touch it.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/linear.hpp>
#include <insonify/core/simd/dispatch.hpp>
#include <insonify/core/simd/lanes.hpp>
#include <insonify/core/simd/transpose.hpp>
#include <insonify/geometry/detail/indices.hpp>
#include <insonify/raster/detail/binning.hpp>
#include <insonify/shadow/detail/light_planes.hpp>
#include <insonify/shadow/policy.hpp>

#include <algorithm>
#include <bit>
#include <span>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::detail::inline INSONIFY_FLAGS {

using insonify::detail::dynamic_array;

/// A rectangle of a light's plane, cut into tiles.
struct plane_tiles {
    glm::dvec2 lower{0}, size{0};  ///< of the whole
    int columns = 1, rows = 1;

    glm::dvec2 tile() const { return {size.x / columns, size.y / rows}; }
    std::size_t count() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
    /// The lower corner of a tile, from that of the whole.
    glm::dvec2 corner(std::size_t i) const {
        const auto row_length = static_cast<std::size_t>(columns);
        return tile() * glm::dvec2(static_cast<double>(i % row_length), static_cast<double>(i / row_length));
    }
};

/// A vertex on the plane, from the lower corner of the tiles.
struct alignas(16) plane_vertex {
    float u, v, height;
    float state;  ///< 0, or one of the following

    static constexpr float behind = 1;    ///< on the other side of a point light
    static constexpr float too_near = 2;  ///< at a depth from 0 to min_depth: not projected
    static constexpr float not_finite = 3;
};

/// The vertices of one caster on a plane.
struct plane_vertices_kernel {
    const glm::vec3* positions;
    plane_vertex* vertices;
    std::size_t count;
    const light_plane& plane;
    affine to_plane;  ///< from the mesh to the plane, before the division
    glm::dvec2 lower;
    double min_depth;

    template <int Width>
    INSONIFY_INLINE void run() const {
        std::size_t i = 0;
#if INSONIFY_SIMD
        if constexpr (Width > 1)
            if (!plane.is_point_light())
                for (; i + 4 < count; i += 4) four(i);
#endif
        for (; i < count; ++i) one(i);
    }

  private:
    void one(std::size_t i) const {
        const glm::dvec3 p = transform_point(to_plane, glm::dvec3(positions[i]));
        if (!numeric::is_finite(p)) {
            vertices[i] = {0, 0, 0, plane_vertex::not_finite};
            return;
        }
        if (plane.is_point_light() && !(p.z >= min_depth)) {
            vertices[i] = {0, 0, 0, p.z < 0 ? plane_vertex::behind : plane_vertex::too_near};
            return;
        }
        const glm::dvec3 projected = plane.is_point_light() ? light_plane::perspective_divide(p) : p;
        vertices[i] = {static_cast<float>(projected.x - lower.x), static_cast<float>(projected.y - lower.y),
                       static_cast<float>(projected.z), 0};
    }
#if INSONIFY_SIMD
    INSONIFY_INLINE void four(std::size_t i) const {
        using namespace insonify::detail;
        using reals = lanes<double, 4>;
        lanes<float, 4> position[3], projected[4], rows[4];
        transpose_threes(position, &positions[i]);
        reals p[3], bad{};
        for (int axis = 0; axis < 3; ++axis) convert(p[axis], position[axis]);
        unroll<3>([&](int row) INSONIFY_INLINE_LAMBDA {
            const double offset = to_plane.offset[row] - (row < 2 ? lower[row] : 0.0);
            const reals sum = to_plane.linear[0][row] * p[0] + to_plane.linear[1][row] * p[1] +
                              to_plane.linear[2][row] * p[2] + offset;
            bad = bad + (sum - sum);
            convert(projected[row], sum);
        });
        const reals state = bad == 0.0 ? reals{} : reals{} + static_cast<double>(plane_vertex::not_finite);
        convert(projected[3], state);
        transpose_fours<4>(rows, projected);
        for (int k = 0; k < 4; ++k) store(&vertices[i + static_cast<std::size_t>(k)].u, rows[k]);
    }
#endif
};

/// The cells of an axis between two coordinates in cells, clamped to the last one; all of them where `is_unbounded`.
template <int N, class Mask>
INSONIFY_INLINE void cells_between(insonify::detail::lanes<std::int32_t, N>& first,
                                   insonify::detail::lanes<std::int32_t, N>& last,
                                   const insonify::detail::lanes<float, N>& low,
                                   const insonify::detail::lanes<float, N>& high, float last_cell,
                                   const Mask& is_unbounded) {
    using floats = insonify::detail::lanes<float, N>;
    floats from = low > 0.0f ? low : floats{}, to = high < last_cell ? high : floats{} + last_cell;
    from = from < last_cell ? from : floats{} + last_cell;
    to = to > 0.0f ? to : floats{};
    from = is_unbounded ? floats{} : from;
    to = is_unbounded ? floats{} + last_cell : to;
    insonify::detail::convert(first, from);
    insonify::detail::convert(last, to);
}

/// N triangles on the plane, one per lane.
template <int N>
struct plane_triangles {
    using floats = insonify::detail::lanes<float, N>;
    using ints = insonify::detail::lanes<std::int32_t, N>;
    floats a[3], b[3], c[3];  ///< u, v, height
    floats state;             ///< the worst of the corners'
    ints is_behind;           ///< all corners are

    /// @param corner  corner(k, i): vertex i of triangle k
    template <class Corner>
    INSONIFY_INLINE explicit plane_triangles(const Corner& corner) {
        using namespace insonify::detail;
        floats columns[3][4];
        unroll<3>([&](int i)
                      INSONIFY_INLINE_LAMBDA { transpose<N>(columns[i], [&](int k) { return &corner(k, i).u; }); });
        unroll<3>([&](int axis) INSONIFY_INLINE_LAMBDA {
            a[axis] = columns[0][axis];
            b[axis] = columns[1][axis];
            c[axis] = columns[2][axis];
        });
        state = columns[0][3] > columns[1][3] ? columns[0][3] : columns[1][3];
        state = state > columns[2][3] ? state : columns[2][3];
        is_behind = ints(columns[0][3] == plane_vertex::behind) & ints(columns[1][3] == plane_vertex::behind) &
                    ints(columns[2][3] == plane_vertex::behind);
    }
};

/// Records which tiles the triangles of a chunk touch, in order.
struct tile_assembly_kernel {
    const plane_vertex* vertices;
    const mesh_view& mesh;
    const affine& to_plane;
    std::size_t first, last;
    const plane_tiles& tiles;
    insonify::detail::tile_runs& runs;

    template <int N>
    INSONIFY_INLINE void run() const {
        for (std::size_t i = first; i < last; i += N) some<N>(i, (std::min)(last - i, std::size_t{N}));
    }

  private:
    template <int N>
    INSONIFY_INLINE void some(std::size_t start, std::size_t count) const {
        using namespace insonify::detail;
        using floats = lanes<float, N>;
        using ints = lanes<std::int32_t, N>;
        const plane_triangles<N> t([&](int k, int i) -> const plane_vertex& {
            return vertices[mesh.triangles[start + (std::min)(static_cast<std::size_t>(k), count - 1)][i]];
        });
        const glm::dvec2 tile = tiles.tile();
        ints from[2], to[2], outside{};
        unroll<2>([&](int axis) INSONIFY_INLINE_LAMBDA {
            floats low, high;
            range_of(low, high, t.a[axis], t.b[axis], t.c[axis]);
            // The margin covers rounding. Triangles with a NaN bound go into all tiles.
            const auto scale = static_cast<float>(1 / tile[axis]);
            const auto last_cell = static_cast<float>(axis == 0 ? tiles.columns - 1 : tiles.rows - 1);
            const floats margin =
                0x1p-20f * ((high < 0.0f ? floats{} - low : high) + static_cast<float>(tiles.size[axis]));
            const floats f = (low - margin) * scale, l = (high + margin) * scale;
            outside |= ints(f > last_cell + 1.0f) | ints(l < 0.0f);
            cells_between<N>(from[axis], to[axis], f, l, last_cell, t.state > 0.0f);
        });
        outside = (outside & ints(t.state == 0.0f)) | ints(t.state == plane_vertex::not_finite) | t.is_behind;
        unsigned drawn = ~movemask<N>(outside) & ((2u << (count - 1)) - 1);
        for (unsigned cut = drawn & movemask<N>(ints(t.state > 0.0f)); cut != 0; cut &= cut - 1) {
            const auto k = static_cast<unsigned>(std::countr_zero(cut));
            if (is_beside_pyramid(mesh.triangles[start + k])) drawn &= ~(1u << k);
        }
        if (drawn == 0) return;
        const ints first_tile = from[0] | from[1] << 16, last_tile = to[0] | to[1] << 16;
        runs.template add_small<N>(static_cast<std::uint32_t>(start), drawn, first_tile, last_tile);
    }

    /// Whether a triangle that reaches behind a point light lies beyond one side of the pyramid from the light through
    /// the plane's square: no ray to the light meets it there. The margin covers rounding.
    INSONIFY_RARE bool is_beside_pyramid(const glm::uvec3& triangle) const {
        glm::dvec3 p[3];
        for (int i = 0; i < 3; ++i) p[i] = transform_point(to_plane, glm::dvec3(mesh.positions[triangle[i]]));
        for (int axis = 0; axis < 2; ++axis)
            for (const double sign : {-1.0, 1.0})
                if (std::all_of(p, p + 3, [&](const glm::dvec3& q) {
                        return sign * q[axis] > q.z + 0x1p-20 * (numeric::abs(q.z) + numeric::abs(q[axis]));
                    }))
                    return true;
        return false;
    }
};

/// One caster over a plane.
class plane_caster {
  public:
    plane_caster() = default;

    /// @param c          caster whose indices are valid
    /// @param min_depth  vertices closer to a point light along the plane's axis are not projected, metres
    template <executor E>
    plane_caster(const caster& c, const light_plane& plane, const plane_tiles& tiles, double min_depth, isa level,
                 E& ex)
        : triangles_(c.mesh.triangles), vertices_(c.mesh.positions.size(), insonify::detail::memory_of(ex)) {
        affine to_plane{{}, plane(c.placement.offset)};
        for (int i = 0; i < 3; ++i) to_plane.linear[i] = plane.direction(c.placement.linear[i]);
        bulk_ranges(ex, vertices_.size(), 16384, [&](std::size_t first, std::size_t last) {
            insonify::detail::dispatch(plane_vertices_kernel{&c.mesh.positions[first], &vertices_[first], last - first,
                                                             plane, to_plane, tiles.lower, min_depth},
                                       level);
        });
        const std::size_t grain = (std::max)(std::size_t{4096}, (triangles_.size() / 64 + 16) / 16 * 16);
        dynamic_array<insonify::detail::tile_runs> chunks((triangles_.size() + grain - 1) / grain);
        bulk_ranges(ex, triangles_.size(), grain, [&](std::size_t first, std::size_t last) {
            insonify::detail::dispatch(
                tile_assembly_kernel{vertices_.data(), c.mesh, to_plane, first, last, tiles, chunks[first / grain]},
                level);
        });
        for (const insonify::detail::tile_runs& chunk : chunks) tiles_ = chunk.bounds(tiles_);
        bins_ = insonify::detail::tile_bins(chunks, tiles_, ex);
    }

    /// Contains all tiles that the caster touches.
    const rect& tiles() const { return tiles_; }
    /// The triangles that touch one of them.
    std::span<const insonify::detail::triangle_run> bin(int column, int row) const {
        return bins_[static_cast<std::size_t>(row - tiles_.y0) * static_cast<std::size_t>(tiles_.width()) +
                     static_cast<std::size_t>(column - tiles_.x0)];
    }
    /// Prefetches the corners of a triangle that may be tested soon.
    INSONIFY_INLINE void prefetch(std::uint32_t triangle) const {
        if (triangle >= triangles_.size()) return;
        for (int i = 0; i < 3; ++i) insonify::detail::prefetch(&corner(triangle, i));
    }
    const plane_vertex& corner(std::uint32_t triangle, int i) const { return vertices_[triangles_[triangle][i]]; }

  private:
    std::span<const glm::uvec3> triangles_;
    insonify::detail::uninitialized_array<plane_vertex> vertices_;
    rect tiles_;
    insonify::detail::tile_bins bins_;  ///< of the triangles by tile
};

}  // namespace shadow::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
