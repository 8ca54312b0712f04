// Triangles on the screen, compact or wide, and the barycentric weights of a pixel.
#pragma once

#include <insonify/core/linear.hpp>
#include <insonify/raster/detail/vertices.hpp>

#include <array>
#include <cstdint>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A triangle with a vertex that isn't compact, a sliver, or a piece of a clipped triangle.
struct wide_triangle {
    std::array<screen_vertex, 3> corners;
    std::array<glm::dvec3, 3> weights;  ///< barycentric, of each corner in the mesh's triangle
    std::uint32_t triangle;
    rect span;  ///< of a folded polygon: exactly the pixels that it covers, in one row; else empty
};

/// A triangle as looked up by its id: its corners in clockwise order on the screen.
struct screen_triangle {
    screen_vertex a, b, c;
    bool front;
    std::uint32_t triangle;     ///< index into the mesh
    const wide_triangle* wide;  ///< null for a compact one

    bool is_span() const { return wide != nullptr && !wide->span.empty(); }

    /// Perspective-correct barycentric weights of the mesh triangle's vertices at a pixel's centre.
    glm::dvec3 weights_at(int x, int y, const pixel_grid& grid) const {
        const auto opposite = [&](const screen_vertex& from, const screen_vertex& to) {
            const std::int64_t edge_x = to.x - from.x, edge_y = to.y - from.y;
            const std::int64_t right = grid.centre(x) - from.x, down = grid.centre(y) - from.y;
            if (wide == nullptr) return static_cast<double>(compact_side(edge_x, edge_y, right, down));
            // Pixels of a span may lie just outside of the corners, where a weight would be negative.
            const double weight = double_double::from(wide_side(edge_x, edge_y, right, down)).high;
            return weight > 0 ? weight : 0.0;
        };
        const double wa = opposite(b, c) * a.inverse_w;
        const double wb = opposite(c, a) * b.inverse_w;
        const double wc = opposite(a, b) * c.inverse_w;
        const double scale = 1.0 / (wa + wb + wc);
        glm::dvec3 w(wa * scale, wb * scale, wc * scale);
        if (front) std::swap(w.y, w.z);  // b and c are exchanged in the mesh
        if (wide == nullptr) return w;
        return numeric::product(glm::dmat3(wide->weights[0], wide->weights[1], wide->weights[2]), w);
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
