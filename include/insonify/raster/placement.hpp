// Vertices on the screen: placed by the vertex callable one by one, divided by w and rounded to the grid several at a
// time.
#pragma once

#include <insonify/core/lanes.hpp>
#include <insonify/geometry/mesh.hpp>
#include <insonify/raster/clip.hpp>
#include <insonify/raster/shader.hpp>
#include <insonify/raster/small.hpp>

#include <memory>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::detail {

/// Vertices on the screen. Those that aren't compact are marked and seen to triangle by triangle.
/// They are left as memory comes until they are set, every one.
template <class Real>
struct screen_vertices {
    std::unique_ptr<grid_place[]> places;
    std::unique_ptr<Real[]> depths;
    std::unique_ptr<double[]> inverse_w;  ///< where weights_at will be asked for

    screen_vertices(std::size_t count, bool weighed)
        : places(std::make_unique_for_overwrite<grid_place[]>(count)),
          depths(std::make_unique_for_overwrite<Real[]>(count)),
          inverse_w(weighed ? std::make_unique_for_overwrite<double[]>(count) : nullptr) {}

    screen_vertex operator[](std::size_t i) const {
        return {places[i].x, places[i].y, static_cast<double>(depths[i]), inverse_w ? inverse_w[i] : 1};
    }
};

inline vertex mesh_vertex(const mesh& m, std::uint32_t index) {
    return {m.positions[index], m.normals.empty() ? glm::vec3(0) : m.normals[index], index};
}

/// Places a range of a mesh's vertices; `keep(index, placed)` is told what the vertex callable gives.
template <class Shader, class Keep, class Real>
struct placement_kernel {
    const mesh& m;
    const Shader& shader;
    const Keep& keep;
    const projection& screen;
    screen_vertices<Real>& vertices;
    std::size_t first, last;

    template <int Width>
    INSONIFY_INLINE void run() const {
        constexpr int N = Width > 1 ? Width / 2 : 1;
        for (std::size_t i = first; i < last; i += N) place<N>(i, (std::min)(last - i, std::size_t{N}));
    }

  private:
    template <int N>
    INSONIFY_INLINE void place(std::size_t start, std::size_t count) const {
        using doubles = lanes<double, N>;
        float clip[4][static_cast<unsigned>(N)];
        for (std::size_t k = 0; k < std::size_t{N}; ++k) {
            const std::size_t i = start + (k < count ? k : 0);
            const auto placed = shader(mesh_vertex(m, static_cast<std::uint32_t>(i)));
            if (k < count) keep(i, placed);
            const glm::vec4 position = position_of(placed);
            for (int axis = 0; axis < 4; ++axis) clip[axis][k] = position[axis];
        }
        doubles p[4];
        for (int axis = 0; axis < 4; ++axis) {
            lanes<float, N> narrow;
            load(narrow, clip[axis]);
            convert(p[axis], narrow);
        }
        lanes<std::int64_t, N> x, y;
        doubles z, inverse_w;
        screen.template to_screen<N>(p, x, y, z, inverse_w);

        std::int64_t columns[static_cast<unsigned>(N)], rows[static_cast<unsigned>(N)];
        store(columns, x);
        store(rows, y);
        lanes<Real, N> depth;
        convert(depth, z);
        Real depths[static_cast<unsigned>(N)];
        store(depths, depth);
        for (std::size_t k = 0; k < count; ++k) {
            vertices.places[start + k] = {static_cast<std::int32_t>(columns[k]), static_cast<std::int32_t>(rows[k])};
            vertices.depths[start + k] = depths[k];
        }
        if (!vertices.inverse_w) return;
        double inverses[static_cast<unsigned>(N)];
        store(inverses, inverse_w);
        for (std::size_t k = 0; k < count; ++k) vertices.inverse_w[start + k] = inverses[k];
    }
};

}  // namespace insonify::inline INSONIFY_ABI::detail

INSONIFY_ARITHMETIC_END
