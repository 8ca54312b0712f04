// Checks that a mesh's triangles index existing positions.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/executor.hpp>
#include <insonify/core/simd/dispatch.hpp>
#include <insonify/core/simd/lanes.hpp>
#include <insonify/core/simd/transpose.hpp>
#include <insonify/geometry/mesh.hpp>

#include <algorithm>
#include <optional>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// The largest of some indices.
struct largest_index_kernel {
    const std::uint32_t* indices;
    std::size_t count;
    std::uint32_t& largest;

    template <int N>
    INSONIFY_INLINE void run() const {
        lanes<std::uint32_t, N> maximum{}, some;
        std::size_t i = 0;
        for (; i + N <= count; i += N) {
            load(some, indices + i);
            maximum = some > maximum ? some : maximum;
        }
        for (int k = 0; k < N; ++k) largest = (std::max)(largest, lane(maximum, k));
        for (; i < count; ++i) largest = (std::max)(largest, indices[i]);
    }
};

/// The largest index of the first triangle that has an index without a position.
inline std::optional<std::uint32_t> bad_index(std::span<const glm::uvec3> triangles, std::size_t vertices, isa level) {
    if (triangles.empty()) return std::nullopt;
    std::uint32_t largest = 0;
    if constexpr (is_packed<glm::uvec3>)
        dispatch(largest_index_kernel{&triangles.front().x, 3 * triangles.size(), largest}, level);
    else
        for (const glm::uvec3& t : triangles) largest = (std::max)({largest, t.x, t.y, t.z});
    if (largest < vertices) return std::nullopt;
    for (const glm::uvec3& t : triangles)
        if ((std::max)({t.x, t.y, t.z}) >= vertices) return (std::max)({t.x, t.y, t.z});
    return std::nullopt;
}

/// @throws invalid_input for an index without a position
template <executor E>
void require_indices(const mesh_view& m, E& ex) {
    constexpr std::size_t grain = 65536;
    dynamic_array<std::optional<std::uint32_t>> bad((m.triangles.size() + grain - 1) / grain);
    bulk_ranges(ex, m.triangles.size(), grain, [&](std::size_t first, std::size_t last) {
        bad[first / grain] = bad_index(m.triangles.subspan(first, last - first), m.positions.size(), best_isa());
    });
    for (const auto& index : bad)
        if (index) refuse_index(*index, m.positions.size());
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
