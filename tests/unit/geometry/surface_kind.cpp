// Classes of meshes: closed, heightfield over a convex region, or open.
#include <insonify/core/random.hpp>
#include <insonify/geometry/cube.hpp>
#include <insonify/geometry/cylinder.hpp>
#include <insonify/geometry/sphere.hpp>
#include <insonify/geometry/surface_kind.hpp>

#include <limits>
#include <utility>

#include "../../catch.hpp"

namespace in = insonify;
using in::surface_kind;

namespace {

in::mesh joined(in::mesh a, const in::mesh& b, const glm::vec3& offset) {
    const auto first = static_cast<std::uint32_t>(a.positions.size());
    for (const glm::vec3& p : b.positions) a.positions.push_back(p + offset);
    for (const glm::uvec3& t : b.triangles) a.triangles.push_back(t + first);
    a.normals.clear();
    return a;
}

in::mesh reversed(in::mesh m) {
    for (glm::uvec3& t : m.triangles) std::swap(t.x, t.y);
    return m;
}

/// The same triangles in another order, each with vertices of its own.
in::mesh soup_of(const in::mesh& m) {
    in::mesh soup;
    for (const glm::uvec3& t : m.triangles)
        for (int i = 0; i < 3; ++i) soup.positions.push_back(m.positions[t[i]]);
    for (std::uint32_t k = 0; k < m.triangles.size(); ++k) soup.triangles.emplace_back(3 * k, 3 * k + 1, 3 * k + 2);
    in::random_sequence random(1);
    for (auto left = static_cast<std::uint32_t>(soup.triangles.size()); left > 1; --left)
        std::swap(soup.triangles[left - 1], soup.triangles[random.below(left)]);
    return soup;
}

/// A bumpy sheet of n x n cells, those left out for which `is_hole(i, j)`.
template <class Hole>
in::mesh bumpy_sheet(std::uint32_t n, const Hole& is_hole) {
    in::mesh m;
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) m.positions.emplace_back(i, j, 0.1f * static_cast<float>(i * j % 3));
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t corner = j * (n + 1) + i;
            if (is_hole(i, j)) continue;
            m.triangles.emplace_back(corner, corner + 1, corner + n + 2);
            m.triangles.emplace_back(corner, corner + n + 2, corner + n + 1);
        }
    return m;
}
in::mesh bumpy_sheet(std::uint32_t n) {
    return bumpy_sheet(n, [](std::uint32_t, std::uint32_t) { return false; });
}

/// A fan of triangles around the origin that rises as it turns `turns` times around it, closed at its end.
in::mesh fan(int turns) {
    in::mesh m{{{0, 0, 0}}, {}, {}};
    const auto corners = static_cast<std::uint32_t>(7 * turns);
    for (std::uint32_t k = 0; k < corners; ++k) {
        const auto [sine, cosine] = in::numeric::sin_cos_turns(k / 7.0);
        m.positions.emplace_back(cosine, sine, k);
        m.triangles.emplace_back(0, k + 1, (k + 1) % corners + 1);
    }
    return m;
}

}  // namespace

TEST_CASE("Meshes whose edges are traversed equally often in both directions are closed") {
    for (const in::mesh& m : {to_mesh(in::cube{}), to_mesh(in::cylinder{}), to_mesh(in::sphere{})}) {
        CHECK(kind_of(m) == surface_kind::closed);
        CHECK(kind_of(reversed(m)) == surface_kind::closed);
        CHECK(kind_of(soup_of(m)) == surface_kind::closed);
        CHECK(kind_of(joined(m, m, {0.3f, 0.2f, 0.1f})) == surface_kind::closed);  // intersects itself
        CHECK(kind_of(joined(m, reversed(m), glm::vec3(0))) == surface_kind::closed);

        in::mesh holed = m;
        holed.triangles.pop_back();
        CHECK(kind_of(holed) == surface_kind::open);
        in::mesh tangled = m;
        std::swap(tangled.triangles[0].x, tangled.triangles[0].y);
        CHECK(kind_of(tangled) == surface_kind::open);
    }
    // Two cubes share an edge, which four triangles join.
    CHECK(kind_of(joined(to_mesh(in::cube{}), to_mesh(in::cube{}), {1, 1, 0})) == surface_kind::closed);
}

TEST_CASE("Sheets over a convex region, counter-clockwise from above, are heightfields") {
    CHECK(kind_of(in::mesh{{{0, 0, 0}, {1, 0, 5}, {0, 1, -5}}, {}, {{0, 1, 2}}}) == surface_kind::heightfield);
    CHECK(kind_of(bumpy_sheet(1)) == surface_kind::heightfield);
    CHECK(kind_of(bumpy_sheet(6)) == surface_kind::heightfield);
    CHECK(kind_of(soup_of(bumpy_sheet(6))) == surface_kind::heightfield);
    CHECK(kind_of(fan(1)) == surface_kind::heightfield);
    in::mesh hexagon = bumpy_sheet(6);  // without the triangles of two opposite corners
    hexagon.triangles.erase(hexagon.triangles.begin() + 61);
    hexagon.triangles.erase(hexagon.triangles.begin() + 10);
    CHECK(kind_of(hexagon) == surface_kind::heightfield);
}

TEST_CASE("Sheets that face down, are folded, or whose outline is not one convex loop are open") {
    CHECK(kind_of(reversed(bumpy_sheet(4))) == surface_kind::open);
    CHECK(kind_of(fan(2)) == surface_kind::open);  // lies over itself
    CHECK(kind_of(bumpy_sheet(4, [](auto i, auto j) { return i == 1 && j == 2; })) == surface_kind::open);
    CHECK(kind_of(bumpy_sheet(4, [](auto i, auto j) { return i > 1 && j > 1; })) == surface_kind::open);  // an L
    CHECK(kind_of(joined(bumpy_sheet(2), bumpy_sheet(2), {5, 0, 0})) == surface_kind::open);
    CHECK(kind_of(joined(bumpy_sheet(2), bumpy_sheet(2), {0, 0, 5})) == surface_kind::open);

    in::mesh folded = bumpy_sheet(4);
    folded.positions[2 * 5 + 2] += glm::vec3(1.5f, 0, 0);  // the middle vertex, beyond its neighbour
    CHECK(kind_of(folded) == surface_kind::open);
    in::mesh upright = bumpy_sheet(2);
    upright.positions[4] = {2, 1, 3};  // above the middle of the right side
    CHECK(kind_of(upright) == surface_kind::open);
    in::mesh slit = bumpy_sheet(2);  // from the middle to the right side, the upper edge of which is higher there
    slit.positions.push_back(slit.positions[5] + glm::vec3(0, 0, 1));
    slit.triangles[6] = {4, 9, 8};
    CHECK(kind_of(slit) == surface_kind::open);
}

TEST_CASE("Meshes without triangles, or with a vertex that is not finite, are open") {
    CHECK(kind_of(in::mesh{}) == surface_kind::open);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
        for (int axis = 0; axis < 3; ++axis) {
            in::mesh flat = bumpy_sheet(2), cube = to_mesh(in::cube{});
            flat.positions[4][axis] = cube.positions[1][axis] = bad;
            CHECK(kind_of(flat) == surface_kind::open);
            CHECK(kind_of(cube) == surface_kind::open);
        }
}
