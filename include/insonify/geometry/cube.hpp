// Boxes.
#pragma once

#include <insonify/core/numeric.hpp>
#include <insonify/geometry/mesh.hpp>

#include <cstdint>

#include <glm/vec3.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// A box centred at the origin, edges along the axes.
struct cube {
    glm::vec3 size{1};  ///< edge lengths, metres
};

inline namespace INSONIFY_ONCE {

/// 24 vertices (each corner three times, once for each face's normal) and 12 triangles.
/// @throws invalid_input for a size that is not finite and positive
INSONIFY_FUNCTION mesh to_mesh(const cube& shape);

#if INSONIFY_BODIES
INSONIFY_FUNCTION mesh to_mesh(const cube& shape) {
    mesh out;
    for (int along = 0; along < 3; ++along) {
        detail::require_positive("cube.size", 0.5f * shape.size[along]);
        for (const float side : {-1.0f, 1.0f}) {
            // u and v follow the normal's axis cyclically; on the negative side they are swapped, to stay
            // counter-clockwise.
            const int u = (along + (side > 0 ? 1 : 2)) % 3;
            const int v = (along + (side > 0 ? 2 : 1)) % 3;
            const auto first = static_cast<std::uint32_t>(out.positions.size());
            for (int turn = 0; turn < 4; ++turn) {
                glm::vec3 corner(0), normal(0);
                corner[along] = normal[along] = side;
                corner[u] = turn == 1 || turn == 2 ? 1.0f : -1.0f;
                corner[v] = turn >= 2 ? 1.0f : -1.0f;
                out.positions.push_back(0.5f * shape.size * corner);
                out.normals.push_back(normal);
            }
            out.triangles.emplace_back(first, first + 1, first + 2);
            out.triangles.emplace_back(first, first + 2, first + 3);
        }
    }
    return out;
}
#endif

}  // namespace INSONIFY_ONCE
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
