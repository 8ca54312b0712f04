// The vertex stage: calls the vertex shader, divides by w, and snaps positions to the grid, several at a time.
#pragma once

#include <insonify/core/detail/uninitialized.hpp>
#include <insonify/core/simd/lanes.hpp>
#include <insonify/core/simd/transpose.hpp>
#include <insonify/geometry/mesh.hpp>
#include <insonify/raster/detail/clip.hpp>
#include <insonify/raster/detail/small_setup.hpp>
#include <insonify/raster/shader.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A vertex on the screen in sixteen bytes, which a lane loads at once. Depth is double where it is to be exact.
template <class Real>
struct packed_vertex;
template <>
struct packed_vertex<float> {
    grid_position position;
    float depth;
    float inverse_w;
};
template <>
struct packed_vertex<double> {
    grid_position position;
    double depth;
};

/// The vertices of a mesh on the screen, uninitialized until the vertex stage has set every one. Those that are not
/// compact are marked as off the grid.
template <class Real>
struct screen_vertices {
    uninitialized_array<packed_vertex<Real>> packed;
    uninitialized_array<double> inverse_w;  ///< empty if no weights in double are needed

    screen_vertices(std::size_t count, bool has_inverse_w, const shared_pool& memory)
        : packed(count, memory), inverse_w(has_inverse_w ? count : 0, memory) {}

    screen_vertex operator[](std::size_t i) const {
        const packed_vertex<Real>& v = packed[i];
        double over_w = 1;
        if constexpr (std::is_same_v<Real, float>)
            over_w = static_cast<double>(v.inverse_w);
        else if (!inverse_w.empty())
            over_w = inverse_w[i];
        return {v.position.x, v.position.y, static_cast<double>(v.depth), over_w};
    }
};

/// N vertices on the screen, one per lane.
template <int N, class Real>
struct vertex_lanes {
    lanes<std::int32_t, N> x, y;
    lanes<Real, N> depth;
    lanes<float, N> inverse_w;  ///< only of packed_vertex<float>

    /// @param vertex  vertex(k) returns the packed vertex of lane k
    template <class Vertex>
    INSONIFY_INLINE explicit vertex_lanes(const Vertex& vertex) {
        if constexpr (std::is_same_v<Real, float>) {
            static_assert(sizeof(packed_vertex<float>) == 4 * sizeof(float));
            lanes<float, N> column[4];
            transpose<N>(column, [&](int k) { return reinterpret_cast<const float*>(&vertex(k)); });
            std::memcpy(&x, &column[0], sizeof x);
            std::memcpy(&y, &column[1], sizeof y);
            depth = column[2];
            inverse_w = column[3];
        } else {
            gather_pairs<N>(x, y, [&](int k) { return &vertex(k).position.x; });
            gather<N>(depth, [&](int k) { return vertex(k).depth; });
        }
    }
};

inline vertex mesh_vertex(const mesh_view& m, std::uint32_t index) {
    return {m.positions[index], m.normals.empty() ? glm::vec3(0) : m.normals[index], index};
}

/// The varyings of a vertex for shading over lanes, padded to whole vectors of four floats.
template <class Varyings>
struct alignas((sizeof(Varyings) + 15) / 16 == 2 ? 32 : 16) varyings_record {
    static constexpr int blocks = (static_cast<int>(sizeof(Varyings)) + 15) / 16;
    float values[static_cast<unsigned>(4 * blocks)];

    void set(const Varyings& varyings) { std::memcpy(values, &varyings, sizeof varyings); }
};

/// For draws that keep no varyings.
struct no_record {};
inline constexpr no_record* no_records = nullptr;

/// Shades and snaps a range of a mesh's vertices; their varyings go into the records.
template <class Shader, class Record, class Real>
struct vertex_kernel {
    const mesh_view& m;
    const Shader& shader;
    Record* records;
    const projection& screen;
    screen_vertices<Real>& vertices;
    std::size_t first, last;

    template <int Width>
    INSONIFY_INLINE void run() const {
        constexpr int N = Width > 1 ? Width / 2 : 1;
        for (std::size_t i = first; i < last; i += N) transform<N>(i, (std::min)(last - i, std::size_t{N}));
    }

  private:
    static constexpr bool quick = std::is_same_v<Real, float>, recorded = !std::is_same_v<Record, no_record>;

    template <int N>
    INSONIFY_INLINE void transform(std::size_t start, std::size_t count) const {
        lanes<float, N> clip[4];
        bool shaded = false;
        if constexpr (N == 4 && vertex_lane_shader<Shader, lanes<float, N>>) {
            shaded = count == N;
            if (shaded) shade_lanes(clip, start);
        }
        if (!shaded) shade_one_by_one<N>(clip, start, count);

        lanes<double, N> p[4], z, inverse_w;
        for (int axis = 0; axis < 4; ++axis) convert(p[axis], clip[axis]);
        lanes<std::int64_t, N> x, y;
        screen.template to_screen<N>(p, x, y, z, inverse_w);
        if constexpr (N == 4 && quick) {
            if (count == N) return store_four(start, x, y, z, inverse_w);
        }
        for (std::size_t k = 0; k < count; ++k) {
            const int i = static_cast<int>(k);
            packed_vertex<Real>& packed = vertices.packed[start + k];
            packed.position = {static_cast<std::int32_t>(lane(x, i)), static_cast<std::int32_t>(lane(y, i))};
            packed.depth = static_cast<Real>(lane(z, i));
            if constexpr (quick)
                packed.inverse_w = static_cast<float>(lane(inverse_w, i));
            else if (!vertices.inverse_w.empty())
                vertices.inverse_w[start + k] = lane(inverse_w, i);
        }
    }

    template <int N>
    INSONIFY_INLINE void shade_one_by_one(lanes<float, N> (&clip)[4], std::size_t start, std::size_t count) const {
        float values[4][static_cast<unsigned>(N)];
        for (std::size_t k = 0; k < std::size_t{N}; ++k) {
            const std::size_t i = start + (k < count ? k : 0);
            const auto output = shader(mesh_vertex(m, static_cast<std::uint32_t>(i)));
            if constexpr (recorded) records[i].set(output.varyings);
            const glm::vec4 position = position_of(output);
            for (int axis = 0; axis < 4; ++axis) values[axis][k] = position[axis];
        }
        for (int axis = 0; axis < 4; ++axis) load(clip[axis], values[axis]);
    }

#if INSONIFY_SIMD
    using floats = lanes<float, 4>;

    INSONIFY_INLINE void shade_lanes(floats (&clip)[4], std::size_t start) const {
        constexpr int blocks = varyings_record<varyings_of<Shader>>::blocks;
        floats position[3], normal[3] = {}, varyings[static_cast<unsigned>(4 * blocks + 1)] = {};
        transpose_threes(position, &m.positions[start]);
        if (!m.normals.empty()) transpose_threes(normal, &m.normals[start]);
        shader(clip, varyings, position, normal);
        if constexpr (recorded) {
            unroll<Record::blocks>([&](int block) INSONIFY_INLINE_LAMBDA {
                floats rows[4];
                transpose_fours<4>(rows, reinterpret_cast<const floats(&)[4]>(varyings[4 * block]));
                unroll<4>([&](int k) INSONIFY_INLINE_LAMBDA {
                    store(records[start + static_cast<std::size_t>(k)].values + 4 * block, rows[k]);
                });
            });
        }
    }

    /// Stores four packed vertices, each as two halves: the position, then depth and 1 / w.
    INSONIFY_INLINE void store_four(std::size_t start, const lanes<std::int64_t, 4>& x, const lanes<std::int64_t, 4>& y,
                                    const lanes<double, 4>& z, const lanes<double, 4>& inverse_w) const {
        using pairs = lanes<std::uint64_t, 4>;
        pairs right, down;
        std::memcpy(&right, &x, sizeof right);
        std::memcpy(&down, &y, sizeof down);
        const pairs both = (down << 32) | (right & 0xFFFFFFFFu);
        floats position[2], depth, over_w;
        std::memcpy(&position, &both, sizeof position);
        convert(depth, z);
        convert(over_w, inverse_w);
        floats rest[2];
        pick<0, 4, 1, 5>(rest[0], depth, over_w);
        pick<2, 6, 3, 7>(rest[1], depth, over_w);
        unroll<2>([&](int i) INSONIFY_INLINE_LAMBDA {
            auto* const two = reinterpret_cast<float*>(&vertices.packed[start + 2 * static_cast<std::size_t>(i)]);
            floats low, high;
            pick<0, 1, 4, 5>(low, position[i], rest[i]);
            pick<2, 3, 6, 7>(high, position[i], rest[i]);
            store(two, low);
            store(two + 4, high);
        });
    }
#endif
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
