// Checks whether a mesh is closed and consistently oriented, as imported targets should be.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/detail/radix_sort.hpp>
#include <insonify/core/linear.hpp>
#include <insonify/geometry/mesh.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

inline namespace INSONIFY_FLAGS {

/// Topology of a mesh, with coincident vertices merged (sharp edges split vertices for their normals).
struct topology {
    std::size_t vertices = 0;            ///< distinct positions that triangles use
    std::size_t edges = 0;               ///< pairs of vertices that triangles join
    std::size_t triangles = 0;           ///< without the degenerate ones
    std::size_t degenerate = 0;          ///< triangles with two coincident corners, not counted elsewhere
    std::size_t boundary_edges = 0;      ///< edges with one triangle
    std::size_t inconsistent_edges = 0;  ///< with more than two triangles, or two that traverse them the same way
    std::size_t inward_components = 0;   ///< connected components that face inwards or enclose nothing

    /// Every edge joins two triangles of the same orientation.
    bool closed() const { return triangles > 0 && boundary_edges == 0 && inconsistent_edges == 0; }
    /// Closed, with all triangles facing outwards.
    bool solid() const { return closed() && inward_components == 0; }
    /// V - E + F: 2 for a closed surface of one piece without handles.
    std::int64_t euler_characteristic() const {
        return static_cast<std::int64_t>(vertices + triangles) - static_cast<std::int64_t>(edges);
    }
};

/// For each position, the index of the first equal one; NaN equals nothing. Linear in the positions.
inline std::vector<std::uint32_t> weld(const std::vector<glm::vec3>& positions) {
    std::vector<std::uint32_t> first(positions.size());
    detail::dynamic_array<detail::keyed> order;
    order.reserve(positions.size());
    // Adding 0 makes one value of both zeros.
    const auto bits = [&](std::uint32_t i, int axis) { return detail::ordered_bits(positions[i][axis] + 0.0f); };
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        first[i] = i;
        if (positions[i] == positions[i]) order.push_back({bits(i, 2), i});
    }
    // By z, then by x and y.
    detail::radix_sort(order);
    for (detail::keyed& item : order) item.key = std::uint64_t{bits(item.number, 0)} << 32 | bits(item.number, 1);
    detail::radix_sort(order);
    for (std::size_t i = 1; i < order.size(); ++i) {
        const std::uint32_t here = order[i].number, before = order[i - 1].number;
        if (positions[here] == positions[before]) first[here] = first[before];
    }
    return first;
}

/// Takes time linear in the positions and, almost, in the triangles.
/// @throws invalid_input if an index has no position
inline topology inspect(const mesh& m) {
    validate(m);
    topology out;
    const std::vector<std::uint32_t> first = weld(m.positions);

    // An edge's key has its lower vertex first; the number is the triangle's direction along it.
    detail::dynamic_array<detail::keyed> sides;
    std::vector<bool> used(m.positions.size());
    std::vector<std::uint32_t> parent = first;  // union-find: a vertex of the same piece; the root is its id
    const auto piece_of = [&](std::uint32_t vertex) {
        while (parent[vertex] != vertex) vertex = parent[vertex] = parent[parent[vertex]];
        return vertex;
    };
    detail::dynamic_array<double> volume(m.positions.size());  // by piece, six times the enclosed volume
    sides.reserve(3 * m.triangles.size());
    const auto is_degenerate = [&](const glm::uvec3& t) {
        return first[t.x] == first[t.y] || first[t.y] == first[t.z] || first[t.z] == first[t.x];
    };
    for (const glm::uvec3& t : m.triangles) {
        if (is_degenerate(t)) {
            ++out.degenerate;
            continue;
        }
        ++out.triangles;
        const std::uint32_t corners[3] = {first[t.x], first[t.y], first[t.z]};
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [a, b] = std::pair(corners[i], corners[(i + 1) % 3]);
            sides.push_back({std::uint64_t{(std::min)(a, b)} << 32 | (std::max)(a, b), a < b ? 1u : 0u});
            out.vertices += used[a] ? 0u : 1u;
            used[a] = true;
            parent[piece_of(a)] = piece_of(b);
        }
    }
    detail::radix_sort(sides);

    for (const glm::uvec3& t : m.triangles) {
        if (is_degenerate(t)) continue;  // its volume would not be 0 if a corner is far away or not finite
        const std::uint32_t piece = piece_of(t.x);
        const glm::dvec3 from(m.positions[piece]);
        volume[piece] +=
            numeric::dot(glm::dvec3(m.positions[t.x]) - from,
                         numeric::cross(glm::dvec3(m.positions[t.y]) - from, glm::dvec3(m.positions[t.z]) - from));
    }
    for (std::uint32_t v = 0; v < volume.size(); ++v)
        if (used[v] && parent[v] == v && !(volume[v] > 0)) ++out.inward_components;

    for (std::size_t i = 0, end; i < sides.size(); i = end) {
        for (end = i + 1; end < sides.size() && sides[end].key == sides[i].key;) ++end;
        ++out.edges;
        if (end - i == 1)
            ++out.boundary_edges;
        else if (end - i > 2 || sides[i + 1].number == sides[i].number)
            ++out.inconsistent_edges;
    }
    return out;
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
