// Restores the lattice order of heightfields whose vertices or triangles were reordered, for example by a mesh
// optimizer. They are recognized by the positions of their vertices.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/linear.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/geometry/mesh.hpp>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// The lattice of which a triangle is half a cell.
class triangle_lattice {
  public:
    /// The lattice of the first triangle, whose longest edge is the diagonal of a cell. The first axis is the one
    /// with the larger x component, which is positive, as is the y component of the second.
    static std::optional<triangle_lattice> of(const mesh& m) {
        if (m.triangles.size() < 2) return std::nullopt;
        glm::dvec2 corner[3];
        for (int i = 0; i < 3; ++i) corner[i] = place(m, m.triangles[0][i]);
        int right_angle = 0;
        double longest = 0;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec2 edge = corner[(i + 2) % 3] - corner[(i + 1) % 3];
            if (const double square = numeric::dot(edge, edge); square > longest) longest = square, right_angle = i;
        }
        triangle_lattice l;
        l.origin_ = corner[right_angle];
        l.right_ = corner[(right_angle + 1) % 3] - l.origin_;
        l.up_ = corner[(right_angle + 2) % 3] - l.origin_;
        if (numeric::abs(l.up_.x) > numeric::abs(l.right_.x)) std::swap(l.right_, l.up_);
        if (l.right_.x < 0) l.right_ = -l.right_;
        if (l.up_.y < 0) l.up_ = -l.up_;
        const double area = numeric::cross(l.right_, l.up_);
        if (!(area > 0)) return std::nullopt;
        l.x_of_ = glm::dvec2(l.up_.y, -l.up_.x) / area;
        l.y_of_ = glm::dvec2(-l.right_.y, l.right_.x) / area;
        return l;
    }

    /// Column and row of a vertex, from the triangle's right angle; none if it is more than a quarter of a step off.
    std::optional<glm::ivec2> steps(const mesh& m, std::uint32_t vertex) const {
        const glm::dvec2 offset = place(m, vertex) - origin_;
        const glm::dvec2 at{x_of_.x * offset.x + x_of_.y * offset.y, y_of_.x * offset.x + y_of_.y * offset.y};
        constexpr double limit = 1 << 24;
        glm::ivec2 whole;
        for (int axis = 0; axis < 2; ++axis) {
            if (!(numeric::abs(at[axis]) < limit)) return std::nullopt;
            whole[axis] = static_cast<int>(numeric::floor_to_int(at[axis] + 0.5));
            if (numeric::abs(at[axis] - whole[axis]) > 0.25) return std::nullopt;
        }
        return whole;
    }

  private:
    static glm::dvec2 place(const mesh& m, std::uint32_t vertex) {
        return {static_cast<double>(m.positions[vertex].x), static_cast<double>(m.positions[vertex].y)};
    }

    glm::dvec2 origin_{0}, right_{0}, up_{0}, x_of_{0}, y_of_{0};
};

/// The vertices of a mesh as points of a lattice.
struct lattice_vertices {
    dynamic_array<glm::ivec2> at;  ///< column and row of each vertex
    glm::ivec2 lowest{0}, highest{0};

    std::size_t columns() const { return static_cast<std::size_t>(highest.x - lowest.x + 1); }
    std::size_t rows() const { return static_cast<std::size_t>(highest.y - lowest.y + 1); }
    /// Index of a point in a lattice of so many columns, row by row.
    std::size_t index(const glm::ivec2& p, std::size_t width) const {
        return static_cast<std::size_t>(p.y - lowest.y) * width + static_cast<std::size_t>(p.x - lowest.x);
    }

    static std::optional<lattice_vertices> of(const mesh& m, const triangle_lattice& lattice) {
        lattice_vertices v;
        v.at.reserve(m.positions.size());
        for (std::uint32_t i = 0; i < m.positions.size(); ++i) {
            const auto steps = lattice.steps(m, i);
            if (!steps) return std::nullopt;
            v.at.push_back(*steps);
            v.lowest = {(std::min)(v.lowest.x, steps->x), (std::min)(v.lowest.y, steps->y)};
            v.highest = {(std::max)(v.highest.x, steps->x), (std::max)(v.highest.y, steps->y)};
        }
        return v;
    }

    /// The vertex at each point, row by row; none if a point has two.
    std::optional<dynamic_array<std::uint32_t>> by_point() const {
        constexpr std::uint32_t none = 0xFFFFFFFFu;
        dynamic_array<std::uint32_t> vertices(at.size(), none);
        for (std::uint32_t v = 0; v < at.size(); ++v) {
            std::uint32_t& vertex = vertices[index(at[v], columns())];
            if (vertex != none) return std::nullopt;
            vertex = v;
        }
        return vertices;
    }
};

/// Whether cells are cut from the lower left to the upper right corner. None unless the triangles are halves of cells,
/// cut the same way and counter-clockwise. @pre as many triangles as all cells have halves
inline std::optional<bool> rising_diagonals(const mesh& m, const lattice_vertices& v) {
    std::vector<bool> found(m.triangles.size(), false);
    std::optional<bool> is_rising;
    for (const glm::uvec3& t : m.triangles) {
        const glm::ivec2 a = v.at[t.x], b = v.at[t.y], c = v.at[t.z];
        const glm::ivec2 corner{(std::min)((std::min)(a.x, b.x), c.x), (std::min)((std::min)(a.y, b.y), c.y)};
        const glm::ivec2 ab = b - a, ac = c - a;
        if (numeric::cross(ab, ac) != 1) return std::nullopt;
        // With the corners of a cell numbered x + 2 y, a triangle lacks 1 or 2 if its diagonal is rising, else 0 or 3.
        int missing_corner = 6;
        for (const glm::ivec2& p : {a, b, c}) {
            if (p.x > corner.x + 1 || p.y > corner.y + 1) return std::nullopt;
            missing_corner -= (p.x - corner.x) + 2 * (p.y - corner.y);
        }
        const bool is_this_rising = missing_corner == 1 || missing_corner == 2;
        if (is_rising.value_or(is_this_rising) != is_this_rising) return std::nullopt;
        is_rising = is_this_rising;
        const std::size_t half = 2 * v.index(corner, v.columns() - 1) + (missing_corner < 2 ? 1 : 0);
        if (found[half]) return std::nullopt;
        found[half] = true;
    }
    return is_rising;
}

/// Reorders a mesh that is a complete lattice of cells, each cut the same way into two triangles that are
/// counter-clockwise seen from +z: vertices row by row, triangles cell by cell. Other meshes are left unchanged.
/// @returns whether the mesh is such a lattice
inline bool order_by_lattice(mesh& m) {
    const auto lattice = triangle_lattice::of(m);
    if (!lattice) return false;
    const auto v = lattice_vertices::of(m, *lattice);
    if (!v) return false;
    const std::size_t columns = v->columns(), rows = v->rows();
    if (columns * rows != v->at.size() || m.triangles.size() != 2 * (columns - 1) * (rows - 1)) return false;
    const auto vertices = v->by_point();
    if (!vertices) return false;
    const auto is_rising = rising_diagonals(m, *v);
    if (!is_rising) return false;

    mesh ordered;
    ordered.positions.reserve(m.positions.size());
    ordered.normals.reserve(m.normals.size());
    for (const std::uint32_t i : *vertices) {
        ordered.positions.push_back(m.positions[i]);
        if (!m.normals.empty()) ordered.normals.push_back(m.normals[i]);
    }
    ordered.triangles.reserve(m.triangles.size());
    for (std::size_t y = 0; y + 1 < rows; ++y)
        for (std::size_t x = 0; x + 1 < columns; ++x) {
            const auto a = static_cast<std::uint32_t>(y * columns + x), b = a + 1,
                       c = a + static_cast<std::uint32_t>(columns), d = c + 1;
            ordered.triangles.emplace_back(a, b, *is_rising ? d : c);
            ordered.triangles.emplace_back(*is_rising ? a : b, d, c);
        }
    m = std::move(ordered);
    return true;
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
