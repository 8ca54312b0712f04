// Vertices on the screen: placed by the vertex callable one by one, divided by w and rounded to the grid several at a
// time.
#pragma once

#include <insonify/core/detail/uninitialized.hpp>
#include <insonify/core/simd/lanes.hpp>
#include <insonify/geometry/mesh.hpp>
#include <insonify/raster/detail/clip.hpp>
#include <insonify/raster/detail/small.hpp>
#include <insonify/raster/shader.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A vertex on the screen, as millions of them are kept: sixteen bytes, which a lane takes in one load.
template <class Real>
struct kept_vertex;
template <>
struct kept_vertex<float> {
    grid_place place;
    float depth;
    float inverse_w;
};
template <>
struct kept_vertex<double> {
    grid_place place;
    double depth;
};

/// Vertices on the screen. Those that aren't compact are marked and seen to triangle by triangle.
/// They are left as memory comes until they are set, every one.
template <class Real>
struct screen_vertices {
    uninitialized_vector<kept_vertex<Real>> kept;
    uninitialized_vector<double> inverse_w;  ///< where weights_at will be asked for

    screen_vertices(std::size_t count, bool weighed, const shared_pool& memory)
        : kept(count, memory), inverse_w(weighed ? count : 0, memory) {}

    screen_vertex operator[](std::size_t i) const {
        const kept_vertex<Real>& v = kept[i];
        return {v.place.x, v.place.y, static_cast<double>(v.depth), inverse_w.empty() ? 1 : inverse_w[i]};
    }
};

/// N vertices on the screen, one per lane.
template <int N, class Real>
struct kept_lanes {
    lanes<std::int32_t, N> x, y;
    lanes<Real, N> depth;
    lanes<float, N> inverse_w;  ///< of quick depths

    /// @param vertex  vertex(k): the kept vertex of lane k
    template <class Vertex>
    INSONIFY_INLINE explicit kept_lanes(const Vertex& vertex) {
        if constexpr (std::is_same_v<Real, float>) {
            static_assert(sizeof(kept_vertex<float>) == 4 * sizeof(float));
            lanes<float, N> column[4];
            transpose<N>(column, [&](int k) { return reinterpret_cast<const float*>(&vertex(k)); });
            std::memcpy(&x, &column[0], sizeof x);
            std::memcpy(&y, &column[1], sizeof y);
            depth = column[2];
            inverse_w = column[3];
        } else {
            gather_pairs<N>(x, y, [&](int k) { return &vertex(k).place.x; });
            gather<N>(depth, [&](int k) { return vertex(k).depth; });
        }
    }
};

inline vertex mesh_vertex(const mesh_view& m, std::uint32_t index) {
    return {m.positions[index], m.normals.empty() ? glm::vec3(0) : m.normals[index], index};
}

/// What pixels read of a vertex: its varyings, float by float, filled up to whole vectors of four.
template <class Varyings>
struct alignas((sizeof(Varyings) + 15) / 16 == 2 ? 32 : 16) vertex_record {
    static constexpr int blocks = (static_cast<int>(sizeof(Varyings) / sizeof(float)) + 3) / 4;
    float values[static_cast<unsigned>(4 * blocks)];

    void set(const Varyings& varyings) { std::memcpy(values, &varyings, sizeof varyings); }
};

/// Nothing of that.
struct no_record {};
inline constexpr no_record* no_records = nullptr;

/// Places a range of a mesh's vertices; what the vertex callable gives beside the place goes into the records.
template <class Shader, class Record, class Real>
struct placement_kernel {
    const mesh_view& m;
    const Shader& shader;
    Record* records;
    const projection& screen;
    screen_vertices<Real>& vertices;
    std::size_t first, last;

    template <int Width>
    INSONIFY_INLINE void run() const {
        constexpr int N = Width > 1 ? Width / 2 : 1;
        for (std::size_t i = first; i < last; i += N) place<N>(i, (std::min)(last - i, std::size_t{N}));
    }

  private:
    static constexpr bool quick = std::is_same_v<Real, float>, recorded = !std::is_same_v<Record, no_record>;

    template <int N>
    INSONIFY_INLINE void place(std::size_t start, std::size_t count) const {
        lanes<float, N> clip[4];
        bool asked = false;
        if constexpr (N == 4 && lane_shader<Shader, lanes<float, N>>) {
            asked = count == N;
            if (asked) ask_in_lanes(clip, start);
        }
        if (!asked) ask_one_by_one<N>(clip, start, count);

        lanes<double, N> p[4], z, inverse_w;
        for (int axis = 0; axis < 4; ++axis) convert(p[axis], clip[axis]);
        lanes<std::int64_t, N> x, y;
        screen.template to_screen<N>(p, x, y, z, inverse_w);
        if constexpr (N == 4 && quick) {
            if (count == N) return keep_four(start, x, y, z, inverse_w);
        }
        for (std::size_t k = 0; k < count; ++k) {
            const int i = static_cast<int>(k);
            kept_vertex<Real>& kept = vertices.kept[start + k];
            kept.place = {static_cast<std::int32_t>(lane(x, i)), static_cast<std::int32_t>(lane(y, i))};
            kept.depth = static_cast<Real>(lane(z, i));
            if constexpr (quick) kept.inverse_w = static_cast<float>(lane(inverse_w, i));
            if (!vertices.inverse_w.empty()) vertices.inverse_w[start + k] = lane(inverse_w, i);
        }
    }

    template <int N>
    INSONIFY_INLINE void ask_one_by_one(lanes<float, N> (&clip)[4], std::size_t start, std::size_t count) const {
        float values[4][static_cast<unsigned>(N)];
        for (std::size_t k = 0; k < std::size_t{N}; ++k) {
            const std::size_t i = start + (k < count ? k : 0);
            const auto placed = shader(mesh_vertex(m, static_cast<std::uint32_t>(i)));
            if constexpr (recorded) records[i].set(placed.varyings);
            const glm::vec4 position = position_of(placed);
            for (int axis = 0; axis < 4; ++axis) values[axis][k] = position[axis];
        }
        for (int axis = 0; axis < 4; ++axis) load(clip[axis], values[axis]);
    }

#if INSONIFY_SIMD
    using floats = lanes<float, 4>;

    INSONIFY_INLINE void ask_in_lanes(floats (&clip)[4], std::size_t start) const {
        floats position[3], normal[3] = {};
        transpose_threes(position, &m.positions[start].x);
        if constexpr (!recorded) {
            floats none;
            shader(clip, &none, position, normal);
        } else {
            if (!m.normals.empty()) transpose_threes(normal, &m.normals[start].x);
            floats varyings[static_cast<unsigned>(4 * Record::blocks)] = {};
            shader(clip, varyings, position, normal);
            unroll<Record::blocks>([&](int block) INSONIFY_INLINE_LAMBDA {
                floats rows[4];
                transpose_fours<4>(rows, reinterpret_cast<const floats(&)[4]>(varyings[4 * block]));
                unroll<4>([&](int k) INSONIFY_INLINE_LAMBDA {
                    store(records[start + static_cast<std::size_t>(k)].values + 4 * block, rows[k]);
                });
            });
        }
    }

    /// Two halves of a kept vertex at a time: its place, and what goes with it.
    INSONIFY_INLINE void keep_four(std::size_t start, const lanes<std::int64_t, 4>& x, const lanes<std::int64_t, 4>& y,
                                   const lanes<double, 4>& z, const lanes<double, 4>& inverse_w) const {
        using pairs = lanes<std::uint64_t, 4>;
        pairs right, down;
        std::memcpy(&right, &x, sizeof right);
        std::memcpy(&down, &y, sizeof down);
        const pairs both = (down << 32) | (right & 0xFFFFFFFFu);
        floats place[2], depth, nearness;
        std::memcpy(&place, &both, sizeof place);
        convert(depth, z);
        convert(nearness, inverse_w);
        const floats rest[2] = {__builtin_shufflevector(depth, nearness, 0, 4, 1, 5),
                                __builtin_shufflevector(depth, nearness, 2, 6, 3, 7)};
        unroll<2>([&](int i) INSONIFY_INLINE_LAMBDA {
            auto* const two = reinterpret_cast<float*>(&vertices.kept[start + 2 * static_cast<std::size_t>(i)]);
            store(two, floats(__builtin_shufflevector(place[i], rest[i], 0, 1, 4, 5)));
            store(two + 4, floats(__builtin_shufflevector(place[i], rest[i], 2, 3, 6, 7)));
        });
    }
#endif
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
