// Tessellation: vertex positions, normals, and holes where data is missing.
#include <insonify/seabed/tessellate.hpp>

#include <cmath>
#include <limits>

#include "../../catch.hpp"

namespace in = insonify;

namespace {

/// z = 0.5 x - 0.25 y over 4 x 3 vertices that are 2 m apart.
in::seabed::heightfield tilted() {
    in::seabed::heightfield field{.heights = in::image<float>(4, 3), .spacing = 2};
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 4; ++i)
            field.heights(i, j) = 0.5f * 2 * static_cast<float>(i) - 0.25f * 2 * static_cast<float>(j);
    return field;
}

}  // namespace

TEST_CASE("A slope is tessellated into its vertices, normals and two upward-facing triangles per cell") {
    const in::mesh m = in::seabed::tessellate(tilted());
    REQUIRE(m.positions.size() == 12);
    REQUIRE(m.triangles.size() == 12);
    const float length = 1 / std::sqrt(0.25f + 0.0625f + 1);
    for (std::size_t v = 0; v < 12; ++v) {
        const auto i = static_cast<float>(v % 4), j = static_cast<float>(v / 4);
        CHECK(m.positions[v] == glm::vec3(2 * i, 2 * j, i - 0.5f * j));
        CHECK(m.normals[v].x == Approx(-0.5f * length));
        CHECK(m.normals[v].y == Approx(0.25f * length));
        CHECK(m.normals[v].z == Approx(length));
    }
    for (const glm::uvec3& t : m.triangles) {
        const glm::vec3 ab = m.positions[t.y] - m.positions[t.x], ac = m.positions[t.z] - m.positions[t.x];
        CHECK(ab.x * ac.y - ab.y * ac.x == 4);  // counter-clockwise from above, half a cell
    }
}

TEST_CASE("A missing vertex removes its triangles and no others") {
    // Cells are cut from vertex (i, j) to (i + 1, j + 1): the ends of a diagonal belong to both triangles.
    const auto triangles_without = [](int i, int j, float value) {
        in::seabed::heightfield field = tilted();
        field.heights(i, j) = value;
        const in::mesh m = in::seabed::tessellate(field);
        const auto missing = static_cast<std::uint32_t>(4 * j + i);
        for (const glm::uvec3& t : m.triangles) CHECK((t.x != missing && t.y != missing && t.z != missing));
        for (const glm::vec3& n : m.normals) CHECK(n.x * n.x + n.y * n.y + n.z * n.z == Approx(1));
        return m.triangles.size();
    };
    const float value = GENERATE(std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity());
    CHECK(triangles_without(0, 0, value) == 10);
    CHECK(triangles_without(3, 0, value) == 11);
    CHECK(triangles_without(0, 2, value) == 11);
    CHECK(triangles_without(3, 2, value) == 10);
    CHECK(triangles_without(1, 1, value) == 6);
    CHECK(triangles_without(1, 0, value) == 9);
}
