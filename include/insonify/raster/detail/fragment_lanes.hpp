// Shading of several pixels at a time, for who can write a shader in lanes: what a row's next N pixels show.
//
// Where a triangle of a fine mesh covers two or three pixels, most of the work is to fetch its corners. So what the
// vertex callable gives is kept for each vertex, beside what interpolation needs, in whole vectors of four floats; and
// a pixel takes its three corners in a few loads.
#pragma once

#include <insonify/raster/detail/assembly.hpp>
#include <insonify/raster/detail/tile.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Where the centres of a row's pixels lie on the grid. Unsigned: what is off the grid has no place, and from there it
/// may be farther than an integer holds.
template <int N>
struct row_centers {
    using places = lanes<std::uint32_t, N>;
    int y, subpixel_bits;
    places first;  ///< along the row, of the picture's first N pixels
    places down;

    INSONIFY_INLINE row_centers(const pixel_grid& grid, int row) : y(row), subpixel_bits(grid.subpixel_bits) {
        count_up<std::uint32_t, N>(first);
        first = (first << subpixel_bits) + static_cast<std::uint32_t>(grid.half());
        down = places{} + static_cast<std::uint32_t>(grid.center(row));
    }
};

/// N neighbouring pixels of a row.
template <int N, class Varyings>
class fragment_lanes {
  public:
    using record = vertex_record<Varyings>;
    using ints = lanes<std::int32_t, N>;
    using floats = lanes<float, N>;

    int x, y;      ///< of the first lane
    ints visible;  ///< which lanes this draw has won
    bool all_visible;
    std::uint32_t triangles[static_cast<unsigned>(N)];  ///< of the mesh
    ints front;                                         ///< seen from the counter-clockwise side
    floats weights[3];                                  ///< of the corners, perspective-correct
    unsigned wide;                                      ///< bit k: lane k's triangle is clipped or very large
    floats right[3], down[3];  ///< from the pixel's centre to the corners of the others, in sub-pixels

    /// @param names  of what each lane shows: somebody's where a lane isn't visible
    template <class Screen>
    INSONIFY_INLINE void look_up(const Screen& screen, const record* records, int column, const row_centers<N>& row,
                                 const ints& shown, bool all_shown, const std::uint32_t* names) {
        x = column;
        y = row.y;
        visible = shown;
        all_visible = all_shown;
        lanes<std::uint32_t, N> name;
        load(name, names);
        const bool any_wide = any(ints(name >= screen.compact_names()));
        std::memcpy(triangles, names, sizeof triangles);
        if (any_wide)
            for (std::uint32_t& triangle : triangles) triangle = screen.triangle(triangle);
        const glm::uvec3* corners[count];
        unroll<N>([&](int k) INSONIFY_INLINE_LAMBDA { corners[k] = &screen.indices(triangles[k]); });
        read_corners(screen, records, row, corners);
        weigh();
        wide = 0;
        if (any_wide) weigh_wide(screen, names);
    }

    /// Float k of the varyings; the same bits whichever way the triangle runs.
    INSONIFY_INLINE void interpolate(floats& into, int k) const {
        into = weights[0] * values_[0][k] + (weights[1] * values_[1][k] + weights[2] * values_[2][k]);
    }
    /// The same at a corner, in the mesh's order.
    INSONIFY_INLINE const floats& at_corner(int corner, int k) const { return values_[corner][k]; }

  private:
    static constexpr auto count = static_cast<std::size_t>(N);

    /// What the records know of the corners of the lanes' triangles and, of compact ones, the screen: both at once, so
    /// that a corner is looked for once.
    template <class Screen>
    INSONIFY_INLINE void read_corners(const Screen& screen, const record* records, const row_centers<N>& row,
                                      const glm::uvec3* const (&corners)[count]) {
        using places = typename row_centers<N>::places;
        const places px = row.first + (static_cast<std::uint32_t>(x) << row.subpixel_bits);
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA {
            std::size_t vertex[count];
            unroll<N>([&](int k) INSONIFY_INLINE_LAMBDA { vertex[k] = (*corners[k])[i]; });
            const kept_lanes<N, float> corner([&](int k) INSONIFY_INLINE_LAMBDA -> const auto& {
                return screen.vertices()[vertex[k]];
            });
            convert(right[i], ints(places(corner.x) - px));
            convert(down[i], ints(places(corner.y) - row.down));
            inverse_w_[i] = corner.inverse_w;
            unroll<record::blocks>([&](int block) INSONIFY_INLINE_LAMBDA {
                transpose<N>(values_[i] + 4 * block,
                             [&](int k) INSONIFY_INLINE_LAMBDA { return records[vertex[k]].values + 4 * block; });
            });
        });
    }

    /// Each corner's share is the area of the triangle opposite to it; the sign of the whole cancels out. In float a
    /// share is off by 2^-24 of the triangle's length squared.
    INSONIFY_INLINE void weigh() {
        // From the pixel, so that exchanging two corners changes a sign and nothing else.
        weights[0] = right[1] * down[2] - down[1] * right[2];
        weights[1] = right[2] * down[0] - down[2] * right[0];
        weights[2] = right[0] * down[1] - down[0] * right[1];
        front = ints(weights[0] + (weights[1] + weights[2]) < 0.0f);
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA { weights[i] = weights[i] * inverse_w_[i]; });
        const floats scale = 1.0f / (weights[0] + (weights[1] + weights[2]));
        unroll<3>([&](int i) INSONIFY_INLINE_LAMBDA { weights[i] = weights[i] * scale; });
    }
    /// Of lanes whose triangle was clipped, or is too large.
    template <class Screen>
    INSONIFY_INLINE void weigh_wide(const Screen& screen, const std::uint32_t* names) {
        for (int k = 0; k < N; ++k) {
            if (screen.is_compact(names[k])) continue;
            wide |= 1u << k;
            const weights_of_one one = weigh_one(screen, names[k], x + k, y);
            set_lane(front, k, one.front ? std::int32_t{-1} : std::int32_t{0});
            for (int i = 0; i < 3; ++i) set_lane(weights[i], k, one.weights[i]);
        }
    }
    struct weights_of_one {
        glm::vec3 weights;
        bool front;
    };
    template <class Screen>
    INSONIFY_RARE static weights_of_one weigh_one(const Screen& screen, std::uint32_t name, int px, int py) {
        const screen_triangle t = screen[name];
        return {glm::vec3(t.weights_at(px, py, screen.grid())), t.front};
    }

    floats values_[3][static_cast<unsigned>(4 * record::blocks)];  ///< of the corners
    floats inverse_w_[3];                                          ///< of those of compact triangles
};

/// Hands the pixels of one tile that this draw has won to `shader(fragment_lanes)`. What they show is looked up for
/// part of a row before any of it is shaded: either is one long chain, and so neighbours' chains run side by side.
template <class Screen, class Varyings, class Shader>
struct shading_kernel {
    const Screen& screen;
    const vertex_record<Varyings>* records;
    tile_buffer<true>& tile;
    pixel_box box;
    const Shader& shader;
    std::uint64_t& shaded;

    template <int Width>
    INSONIFY_INLINE void run() const {
        constexpr int N = Width;
        fragment_lanes<N, Varyings> found[static_cast<unsigned>(part / N)];
        for (int y = box.y0; y <= box.y1; ++y)
            for (int x = box.x0; x <= box.x1; x += part) {
                const int count = find<N>(found, x, y);
                for (int i = 0; i < count; ++i) shader(found[i]);
            }
    }

  private:
    static constexpr int part = 64;  ///< pixels; what is known of them stays in the first-level cache

    /// Looks at the pixels from (x0, y) on.
    /// @returns how many fragments that makes
    template <int N>
    INSONIFY_INLINE int find(fragment_lanes<N, Varyings>* found, int x0, int y) const {
        using ints = lanes<std::int32_t, N>;
        const row_centers<N> row(screen.grid(), y);
        ints column;
        count_up<std::int32_t, N>(column);
        int count = 0;
        for (int x = x0; x <= (std::min)(box.x1, x0 + part - 1); x += N) {
            const std::uint32_t* const names = tile.winner(x, y);
            lanes<std::uint32_t, N> shown;
            load(shown, names);
            const ints visible = ints(shown != tile_buffer<true>::nobody) & ints(column <= box.x1 - x);
            if (!any(ints(visible == 0))) {
                shaded += N;
                found[count++].look_up(screen, records, x, row, visible, true, names);
            } else if (any(visible)) {
                find_some<N>(found[count++], x, row, visible, names);
            }
        }
        return count;
    }
    template <int N>
    INSONIFY_INLINE void find_some(fragment_lanes<N, Varyings>& found, int x, const row_centers<N>& row,
                                   const lanes<std::int32_t, N>& visible, const std::uint32_t* names) const {
        std::uint32_t shown[static_cast<unsigned>(N)], somebody = 0;
        for (int k = 0; k < N; ++k)
            if (lane(visible, k) != 0) {
                somebody = names[k];
                ++shaded;
            }
        for (int k = 0; k < N; ++k) shown[k] = lane(visible, k) != 0 ? names[k] : somebody;
        found.look_up(screen, records, x, row, visible, false, shown);
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
