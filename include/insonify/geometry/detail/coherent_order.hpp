// Orders triangles along a space-filling curve, so that consecutive triangles share vertices in cache.
//
// Based on: Guy M. Morton. A Computer Oriented Geodetic Data Base and a New Technique in File Sequencing. IBM, 1966.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/detail/radix_sort.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/geometry/bounds.hpp>

#include <cstdint>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Whether most triangles have no index within 63 of one of the triangle before, as in shuffled meshes and triangle
/// soups.
inline bool is_incoherent(const mesh& m) {
    std::size_t jumps = 0;
    for (std::size_t i = 1; i < m.triangles.size(); ++i) {
        const glm::uvec3 &a = m.triangles[i - 1], &b = m.triangles[i];
        bool is_near = false;
        for (int j = 0; j < 3; ++j) {
            const std::uint32_t v = b[j];
            // Adjacent indices are adjacent in memory, too.
            for (int k = 0; k < 3; ++k) is_near = is_near || (v > a[k] ? v - a[k] : a[k] - v) < 64;
        }
        jumps += is_near ? 0u : 1u;
    }
    return jumps > m.triangles.size() / 2;
}

/// Spaces the bits of a value three apart.
inline std::uint64_t every_third_bit(std::uint64_t value) {
    value = (value | value << 32) & 0x001F00000000FFFFu;
    value = (value | value << 16) & 0x001F0000FF0000FFu;
    value = (value | value << 8) & 0x100F00F00F00F00Fu;
    value = (value | value << 4) & 0x10C30C30C30C30C3u;
    return (value | value << 2) & 0x1249249249249249u;
}

/// Sorts triangles along Morton's curve through their centres, and vertices by the first triangle that uses them.
inline void order_along_curve(mesh& m, const bounding_box& box) {
    const glm::dvec3 size = box.size();
    dynamic_array<keyed> order(m.triangles.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        std::uint64_t key = 0;
        for (int axis = 0; axis < 3; ++axis) {
            double sum = 0;
            for (int k = 0; k < 3; ++k) sum += static_cast<double>(m.positions[m.triangles[i][k]][axis]);
            const double share = size[axis] > 0 ? (sum / 3 - box.lower[axis]) / size[axis] : 0;
            const double clamped = share > 0 ? (share < 1 ? share : 1.0) : 0.0;  // NaN becomes 0
            key |= every_third_bit(static_cast<std::uint64_t>(clamped * 2097151)) << axis;
        }
        order[i] = {key, static_cast<std::uint32_t>(i)};
    }
    radix_sort(order);

    constexpr std::uint32_t unused = 0xFFFFFFFFu;
    dynamic_array<std::uint32_t> number(m.positions.size(), unused);
    mesh sorted;
    sorted.triangles.reserve(m.triangles.size());
    sorted.positions.reserve(m.positions.size());
    sorted.normals.reserve(m.normals.size());
    const auto add_vertex = [&](std::uint32_t v) {
        number[v] = static_cast<std::uint32_t>(sorted.positions.size());
        sorted.positions.push_back(m.positions[v]);
        if (!m.normals.empty()) sorted.normals.push_back(m.normals[v]);
    };
    for (const keyed& item : order) {
        glm::uvec3 t = m.triangles[item.number];
        for (int k = 0; k < 3; ++k) {
            if (number[t[k]] == unused) add_vertex(t[k]);
            t[k] = number[t[k]];
        }
        sorted.triangles.push_back(t);
    }
    for (std::uint32_t v = 0; v < number.size(); ++v)
        if (number[v] == unused) add_vertex(v);
    m = std::move(sorted);
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
