// Indexed triangle meshes as plain data, and views of them.
#pragma once

#include <insonify/core/detail/uninitialized.hpp>
#include <insonify/core/error.hpp>

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace insonify {
inline namespace INSONIFY_ABI {

/// An indexed triangle mesh. Counter-clockwise triangles face the viewer; positions are metres in the mesh's own frame.
struct mesh {
    std::vector<glm::vec3> positions{};
    std::vector<glm::vec3> normals{};  ///< unit, one per position, or none at all
    std::vector<glm::uvec3> triangles{};
};

/// A view of a mesh in the caller's memory, which must outlive it.
struct mesh_view {
    std::span<const glm::vec3> positions;
    std::span<const glm::vec3> normals;  ///< see mesh
    std::span<const glm::uvec3> triangles;

    mesh_view() = default;
    INSONIFY_MEMBER mesh_view(std::span<const glm::vec3> p, std::span<const glm::vec3> n, std::span<const glm::uvec3> t)
        : positions(p), normals(n), triangles(t) {}
    INSONIFY_MEMBER mesh_view(const mesh& m)
        : mesh_view({m.positions.data(), m.positions.size()}, {m.normals.data(), m.normals.size()},
                    {m.triangles.data(), m.triangles.size()}) {}
};

namespace detail::inline INSONIFY_FLAGS {

/// A mesh with uninitialized storage, for meshes that are rebuilt for every picture.
struct uninitialized_mesh {
    uninitialized_array<glm::vec3> positions, normals;
    uninitialized_array<glm::uvec3> triangles;

    explicit uninitialized_mesh(const shared_pool& memory) : positions(memory), normals(memory), triangles(memory) {}

    operator mesh_view() const { return {positions, normals, triangles}; }
};

[[noreturn]] inline void refuse_index(std::uint32_t index, std::size_t positions) {
    refuse("mesh.triangles", index, "an index below " + to_text(positions) + ", the number of positions");
}
/// @throws invalid_input if normals are neither absent nor one per position
inline void require_normals(const mesh_view& m) {
    if (m.normals.empty() || m.normals.size() == m.positions.size()) return;
    refuse("mesh.normals.size()", m.normals.size(), "0 or " + to_text(m.positions.size()) + ", one per position");
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// @throws invalid_input if an index has no position, or normals are neither absent nor one per position
inline void validate(const mesh& m) {
    detail::require_normals(m);
    for (const glm::uvec3& t : m.triangles) {
        const std::uint32_t largest = t.x > t.y ? (t.x > t.z ? t.x : t.z) : (t.y > t.z ? t.y : t.z);
        if (largest >= m.positions.size()) detail::refuse_index(largest, m.positions.size());
    }
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify
