// Restores the lattice order of heightfields whose vertices or triangles were reordered, for example by a mesh
// optimizer. They are recognized by the positions of their vertices.
#pragma once

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
    /// Of a cell's three edges the longest is its diagonal. The first step goes mostly along x, both upwards.
    static std::optional<triangle_lattice> of(const mesh& m) {
        if (m.triangles.size() < 2) return std::nullopt;
        glm::dvec2 corner[3];
        for (int i = 0; i < 3; ++i) corner[i] = place(m, m.triangles[0][i]);
        int right_angle = 0;
        double longest = 0;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec2 edge = corner[(i + 2) % 3] - corner[(i + 1) % 3];
            const double square = edge.x * edge.x + edge.y * edge.y;
            if (square > longest) longest = square, right_angle = i;
        }
        triangle_lattice l;
        l.origin_ = corner[right_angle];
        l.right_ = corner[(right_angle + 1) % 3] - l.origin_;
        l.up_ = corner[(right_angle + 2) % 3] - l.origin_;
        if (numeric::abs(l.up_.x) > numeric::abs(l.right_.x)) std::swap(l.right_, l.up_);
        if (l.right_.x < 0) l.right_ = -l.right_;
        if (l.up_.y < 0) l.up_ = -l.up_;
        const double area = l.right_.x * l.up_.y - l.right_.y * l.up_.x;
        if (!(area > 0)) return std::nullopt;
        l.x_of_ = glm::dvec2(l.up_.y, -l.up_.x) / area;
        l.y_of_ = glm::dvec2(-l.right_.y, l.right_.x) / area;
        return l;
    }

    /// The steps of a vertex from the triangle's right angle, if it lies within a quarter of one.
    std::optional<glm::ivec2> steps(const mesh& m, std::uint32_t vertex) const {
        const glm::dvec2 off = place(m, vertex) - origin_;
        const glm::dvec2 at{x_of_.x * off.x + x_of_.y * off.y, y_of_.x * off.x + y_of_.y * off.y};
        constexpr double farthest = 1 << 24;
        glm::ivec2 whole;
        for (int axis = 0; axis < 2; ++axis) {
            if (!(numeric::abs(at[axis]) < farthest)) return std::nullopt;
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

/// Renumbers a mesh that is a whole lattice of cells, each cut the same way into two triangles that are
/// counter-clockwise seen from +z: vertices row by row, triangles cell by cell. Any other mesh stays as it is.
/// @returns whether it was one
inline bool order_by_lattice(mesh& m) {
    const auto lattice = triangle_lattice::of(m);
    if (!lattice) return false;
    std::vector<glm::ivec2> at(m.positions.size());
    glm::ivec2 lowest(0), highest(0);
    for (std::uint32_t v = 0; v < at.size(); ++v) {
        const auto steps = lattice->steps(m, v);
        if (!steps) return false;
        at[v] = *steps;
        lowest = {(std::min)(lowest.x, at[v].x), (std::min)(lowest.y, at[v].y)};
        highest = {(std::max)(highest.x, at[v].x), (std::max)(highest.y, at[v].y)};
    }
    const auto columns = static_cast<std::size_t>(highest.x - lowest.x + 1),
               rows = static_cast<std::size_t>(highest.y - lowest.y + 1);
    if (columns * rows != at.size() || m.triangles.size() != 2 * (columns - 1) * (rows - 1)) return false;

    constexpr std::uint32_t none = 0xFFFFFFFFu;
    std::vector<std::uint32_t> vertex_at(at.size(), none);
    const auto number_of = [&](const glm::ivec2& p) {
        return static_cast<std::size_t>(p.y - lowest.y) * columns + static_cast<std::size_t>(p.x - lowest.x);
    };
    for (std::uint32_t v = 0; v < at.size(); ++v) {
        std::uint32_t& to = vertex_at[number_of(at[v])];
        if (to != none) return false;
        to = v;
    }

    // Each triangle leaves one corner of its cell out; with a cell's corners numbered x + 2 y, the diagonals leave out
    // 1 and 2, or 0 and 3.
    std::vector<bool> is_there(m.triangles.size(), false);
    std::optional<bool> is_rising;
    for (const glm::uvec3& t : m.triangles) {
        const glm::ivec2 a = at[t.x], b = at[t.y], c = at[t.z];
        const glm::ivec2 corner{(std::min)((std::min)(a.x, b.x), c.x), (std::min)((std::min)(a.y, b.y), c.y)};
        const glm::ivec2 ab = b - a, ac = c - a;
        if (ab.x * ac.y - ab.y * ac.x != 1) return false;
        int left_out = 6;
        for (const glm::ivec2& p : {a, b, c}) {
            if (p.x > corner.x + 1 || p.y > corner.y + 1) return false;
            left_out -= (p.x - corner.x) + 2 * (p.y - corner.y);
        }
        const bool rises = left_out == 1 || left_out == 2;
        if (is_rising.value_or(rises) != rises) return false;
        is_rising = rises;
        const std::size_t cell = static_cast<std::size_t>(corner.y - lowest.y) * (columns - 1) +
                                 static_cast<std::size_t>(corner.x - lowest.x);
        const std::size_t slot = 2 * cell + (left_out < 2 ? 1 : 0);
        if (is_there[slot]) return false;
        is_there[slot] = true;
    }

    mesh ordered;
    ordered.positions.reserve(m.positions.size());
    ordered.normals.reserve(m.normals.size());
    for (const std::uint32_t v : vertex_at) {
        ordered.positions.push_back(m.positions[v]);
        if (!m.normals.empty()) ordered.normals.push_back(m.normals[v]);
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
