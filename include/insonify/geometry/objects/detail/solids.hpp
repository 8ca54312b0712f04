// Closed pieces that objects are assembled from: lofts of cross sections, boxes, bars and tubes.
//
// An object is a union of closed pieces that may overlap. Pieces never share an edge, so that the union stays closed by
// position (`inspect(mesh).solid()`); where two pieces meet, one reaches into the other.
#pragma once

#include <insonify/core/linear.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/core/random.hpp>
#include <insonify/geometry/mesh.hpp>
#include <insonify/geometry/transform.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A closed polygon in space, without coincident corners.
using section = std::vector<glm::dvec3>;

inline void require_size(const char* name, float metres) {
    require(metres >= 1e-4f && metres <= 1e5f, name, metres, "0.0001 to 100000 metres");
}
/// Refuses a thickness that float positions do not resolve on an object of the given size.
inline void require_thickness(const char* name, float metres, float object_size) {
    require(metres >= 1e-4f * object_size && metres <= object_size, name, metres,
            "at least 1/10000 of the object's size, at most that size");
}
inline void require_segments(const char* name, int value, int low, int high) {
    require_range(name, value, low, high, to_text(low) + " to " + to_text(high));
}

/// Appends the surface through sections with equal numbers of corners, closed at both ends. The two ends are cut into
/// triangles by a zigzag between corner i and corner n - 1 - i: exact for convex sections, for thin shells whose second
/// half runs back along the first, and for sections that are symmetric about their middle.
/// The piece faces outwards for either direction of the sections.
inline void append_loft(mesh& into, std::span<const section> sections) {
    const auto corners = static_cast<std::uint32_t>(sections[0].size());
    const auto first = static_cast<std::uint32_t>(into.positions.size());
    const std::size_t first_triangle = into.triangles.size();
    for (const section& s : sections)
        for (const glm::dvec3& p : s) into.positions.emplace_back(p);

    for (std::uint32_t k = 0; k + 1 < sections.size(); ++k)
        for (std::uint32_t i = 0; i < corners; ++i) {
            const std::uint32_t j = (i + 1) % corners, here = first + k * corners, next = here + corners;
            into.triangles.emplace_back(here + i, here + j, next + j);
            into.triangles.emplace_back(here + i, next + j, next + i);
        }
    const auto last = first + static_cast<std::uint32_t>(sections.size() - 1) * corners;
    for (std::uint32_t low = 0, high = corners - 1; high - low >= 2; ++low, --high) {
        into.triangles.emplace_back(first + low, first + high, first + low + 1);
        into.triangles.emplace_back(last + low, last + low + 1, last + high);
        if (high - low < 3) break;
        into.triangles.emplace_back(first + low + 1, first + high, first + high - 1);
        into.triangles.emplace_back(last + low + 1, last + high - 1, last + high);
    }

    double volume = 0;
    const glm::dvec3 origin(into.positions[first]);
    for (std::size_t t = first_triangle; t < into.triangles.size(); ++t) {
        const auto corner = [&](int i) { return glm::dvec3(into.positions[into.triangles[t][i]]) - origin; };
        volume += numeric::dot(corner(0), numeric::cross(corner(1), corner(2)));
    }
    if (volume < 0)
        for (std::size_t t = first_triangle; t < into.triangles.size(); ++t)
            std::swap(into.triangles[t].y, into.triangles[t].z);
}

/// Appends the hexahedron between two quadrilaterals whose corners correspond.
inline void append_block(mesh& into, const std::array<glm::dvec3, 4>& from, const std::array<glm::dvec3, 4>& to) {
    const section ends[2] = {{from.begin(), from.end()}, {to.begin(), to.end()}};
    append_loft(into, ends);
}

/// Appends a box with edges along the axes.
inline void append_box(mesh& into, const glm::dvec3& low, const glm::dvec3& high) {
    append_block(
        into, {{{low.x, low.y, low.z}, {high.x, low.y, low.z}, {high.x, high.y, low.z}, {low.x, high.y, low.z}}},
        {{{low.x, low.y, high.z}, {high.x, low.y, high.z}, {high.x, high.y, high.z}, {low.x, high.y, high.z}}});
}

/// Two unit vectors, perpendicular to a direction and to each other.
inline std::pair<glm::dvec3, glm::dvec3> across(const glm::dvec3& direction) {
    const glm::dvec3 along = unit(direction);
    const glm::dvec3 away = numeric::abs(along.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 u = unit(numeric::cross(away, along));
    return {u, numeric::cross(along, u)};
}

/// The corners of a regular polygon, inscribed in the ellipse with semi-axes u and v; an edge, not a corner, is centred
/// on u.
inline section circle(const glm::dvec3& centre, const glm::dvec3& u, const glm::dvec3& v, int corners) {
    section out;
    for (int i = 0; i < corners; ++i) {
        const auto [sine, cosine] = numeric::sin_cos_turns((i + 0.5) / corners);
        out.push_back(centre + cosine * u + sine * v);
    }
    return out;
}

/// Appends a straight round bar, its radius growing or shrinking linearly.
inline void append_bar(mesh& into, const glm::dvec3& from, const glm::dvec3& to, double from_radius, double to_radius,
                       int corners = 6) {
    const auto [u, v] = across(to - from);
    const section ends[2] = {circle(from, from_radius * u, from_radius * v, corners),
                             circle(to, to_radius * u, to_radius * v, corners)};
    append_loft(into, ends);
}

/// Appends a bent round bar through points; the sections at its bends lie in the bisecting planes.
inline void append_bent_bar(mesh& into, std::span<const glm::dvec3> path, double radius, int corners = 6) {
    std::vector<section> sections;
    const auto [start_u, start_v] = across(path[1] - path[0]);
    glm::dvec3 u = start_u;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const glm::dvec3 before = i > 0 ? unit(path[i] - path[i - 1]) : glm::dvec3(0);
        const glm::dvec3 after = i + 1 < path.size() ? unit(path[i + 1] - path[i]) : glm::dvec3(0);
        const glm::dvec3 along = unit(before + after);
        u = unit(u - numeric::dot(u, along) * along);
        sections.push_back(circle(path[i], radius * u, radius * numeric::cross(along, u), corners));
    }
    append_loft(into, sections);
}

/// Appends a transformed mesh.
inline void append(mesh& into, mesh part, const affine& map = {}) {
    part = transformed(std::move(part), map);
    const auto first = static_cast<std::uint32_t>(into.positions.size());
    into.positions.insert(into.positions.end(), part.positions.begin(), part.positions.end());
    into.normals.insert(into.normals.end(), part.normals.begin(), part.normals.end());
    for (const glm::uvec3& t : part.triangles) into.triangles.push_back(t + first);
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
