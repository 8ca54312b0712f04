// Classifies meshes as closed, heightfield or open, so that renderers can skip triangles where that changes no pixel.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/linear.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/geometry/mesh.hpp>
#if INSONIFY_BODIES
#include <insonify/geometry/topology.hpp>
#endif

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Class of a mesh, from which renderers decide which of its triangles a shadow test may skip (shadow::skip).
enum class surface_kind {
    open,         ///< not proven to be one of the others
    closed,       ///< triangles traverse each edge equally often in both directions: a ray that starts and ends outside
                  ///< crosses as many back faces as front faces, even if the surface intersects itself
    heightfield,  ///< z over a convex part of the xy plane, all triangles counter-clockwise from above
};

inline namespace INSONIFY_ONCE {

/// Classifies a mesh, in linear time.
/// @param m  its indices have positions
INSONIFY_FUNCTION surface_kind kind_of(const mesh& m);

}  // namespace INSONIFY_ONCE

#if INSONIFY_BODIES

namespace detail::inline INSONIFY_FLAGS {

/// Net directed edges of a mesh: those that triangles traverse more often in one direction than in the other.
inline dynamic_array<std::pair<std::uint32_t, std::uint32_t>> unbalanced_edges(const mesh& m) {
    const std::vector<std::uint32_t> first = weld(m.positions);
    using edge = std::pair<std::uint32_t, std::uint32_t>;
    dynamic_array<edge> edges;
    edges.reserve(3 * m.triangles.size());
    for (const glm::uvec3& t : m.triangles)
        for (int i = 0; i < 3; ++i) {
            const edge e{first[t[i]], first[t[(i + 1) % 3]]};
            if (e.first != e.second) edges.push_back(e);
        }
    // Counting sorts, by the higher vertex and then by the lower one, bring the edges between two vertices together.
    const auto lower = [](const edge& e) { return (std::min)(e.first, e.second); };
    const auto higher = [](const edge& e) { return (std::max)(e.first, e.second); };
    dynamic_array<edge> sorted(edges.size());
    for (const bool by_lower : {false, true}) {
        dynamic_array<std::uint32_t> starts(m.positions.size() + 1, 0);
        const auto vertex = [&](const edge& e) { return by_lower ? lower(e) : higher(e); };
        for (const edge& e : edges) ++starts[vertex(e) + 1];
        for (std::size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
        for (const edge& e : edges) sorted[starts[vertex(e)]++] = e;
        edges.swap(sorted);
    }

    dynamic_array<edge> open;
    for (std::size_t i = 0; i < edges.size();) {
        const std::uint32_t low = lower(edges[i]), high = higher(edges[i]);
        std::int64_t balance = 0;
        for (; i < edges.size() && lower(edges[i]) == low && higher(edges[i]) == high; ++i)
            balance += edges[i].first == low ? 1 : -1;
        for (; balance > 0; --balance) open.push_back({low, high});
        for (; balance < 0; ++balance) open.push_back({high, low});
    }
    return open;
}

/// Whether directed edges make one loop that goes once around a convex polygon, seen from above.
inline bool is_convex_loop(const mesh& m, const dynamic_array<std::pair<std::uint32_t, std::uint32_t>>& edges) {
    dynamic_array<std::uint32_t> after(m.positions.size(), 0xFFFFFFFFu);
    for (const auto& [from, to] : edges) {
        if (after[from] != 0xFFFFFFFFu) return false;
        after[from] = to;
    }
    const auto way = [&](std::uint32_t from) {
        const glm::vec3 &a = m.positions[from], &b = m.positions[after[from]];
        return glm::dvec2(static_cast<double>(b.x) - static_cast<double>(a.x),
                          static_cast<double>(b.y) - static_cast<double>(a.y));
    };
    const std::uint32_t start = edges.front().first;
    std::size_t count = 0;
    int turns = 0;
    for (std::uint32_t at = start; count == 0 || at != start; at = after[at], ++count) {
        if (count > edges.size() || after[at] == 0xFFFFFFFFu || after[after[at]] == 0xFFFFFFFFu) return false;
        const glm::dvec2 now = way(at), then = way(after[at]);
        const double turn = numeric::cross(now, then);
        if (turn < 0 || (turn == 0 && numeric::dot(now, then) <= 0)) return false;
        turns += now.y < 0 && then.y >= 0;
    }
    return count == edges.size() && turns == 1;
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_ONCE {

INSONIFY_FUNCTION surface_kind kind_of(const mesh& m) {
    if (m.triangles.empty()) return surface_kind::open;
    bool is_finite = true, is_upward = true;
    for (const glm::uvec3& t : m.triangles) {
        const glm::dvec3 a(m.positions[t.x]), b(m.positions[t.y]), c(m.positions[t.z]);
        const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        is_upward = is_upward && area > 0;
        is_finite = is_finite && numeric::is_finite(a.x + a.y + a.z) && numeric::is_finite(b.x + b.y + b.z) &&
                    numeric::is_finite(c.x + c.y + c.z);
    }
    if (!is_finite) return surface_kind::open;
    const auto edges = detail::unbalanced_edges(m);
    if (edges.empty()) return surface_kind::closed;
    return is_upward && detail::is_convex_loop(m, edges) ? surface_kind::heightfield : surface_kind::open;
}

}  // namespace INSONIFY_ONCE

#endif

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
