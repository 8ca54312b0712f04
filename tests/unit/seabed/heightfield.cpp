// Queries of a heightfield: heights, normals and types between, at and beyond its vertices.
#include <insonify/seabed/heightfield.hpp>
#include <insonify/seabed/tessellate.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <glm/geometric.hpp>

#include "../../catch.hpp"

namespace in = insonify;
namespace sb = insonify::seabed;

namespace {

/// Random heights and types over [-4, 11] x [30, 40] metres.
sb::heightfield uneven() {
    sb::heightfield field{
        .heights = in::image<float>(7, 5), .types = in::image<sb::type>(7, 5), .origin = {-4, 30}, .spacing = 2.5};
    std::mt19937 random(7);
    for (float& h : field.heights.pixels()) h = static_cast<float>(random() % 1000) / 500;
    for (sb::type& t : field.types.pixels()) t = static_cast<sb::type>(random() % 4);
    return field;
}

using world_triangle = std::array<glm::dvec3, 3>;

/// The triangles of the drawn mesh, in the world.
std::vector<world_triangle> triangles_of(const sb::heightfield& field) {
    const in::mesh drawn = sb::tessellate(field);
    std::vector<world_triangle> all;
    for (const glm::uvec3& t : drawn.triangles) {
        world_triangle corners;
        for (int i = 0; i < 3; ++i)
            corners[static_cast<std::size_t>(i)] = glm::dvec3(drawn.positions[t[i]]) + glm::dvec3(field.origin, 0);
        all.push_back(corners);
    }
    return all;
}

}  // namespace

TEST_CASE("Height and normal at a point are those of the drawn triangle over it") {
    const sb::heightfield field = uneven();
    const std::vector<world_triangle> drawn = triangles_of(field);
    REQUIRE(drawn.size() == 2 * 6 * 4);
    for (const auto& [a, b, c] : drawn) {
        const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
        for (const glm::dvec3& share :
             {glm::dvec3(0.8, 0.1, 0.1), glm::dvec3(0.1, 0.8, 0.1), glm::dvec3(0.1, 0.1, 0.8)}) {
            const glm::dvec3 at = share.x * a + share.y * b + share.z * c;
            CHECK(field.height_at(at.x, at.y) == Approx(at.z).margin(1e-6));
            CHECK(glm::distance(glm::dvec3(field.normal_at(at.x, at.y)), normal) < 1e-6);
        }
        CHECK(field.height_at(a.x, a.y) == static_cast<float>(a.z));
    }
}

TEST_CASE("Beyond the edges a heightfield has the heights and types of its nearest vertices") {
    const sb::heightfield field = uneven();
    for (double x = -12; x < 20; x += 0.7) {
        for (double y = 22; y < 48; y += 0.7) {
            const double inner_x = std::clamp(x, -4.0, 11.0), inner_y = std::clamp(y, 30.0, 40.0);
            CHECK(field.height_at(x, y) == field.height_at(inner_x, inner_y));
            const int i = static_cast<int>(std::lround((inner_x + 4) / 2.5));
            const int j = static_cast<int>(std::lround((inner_y - 30) / 2.5));
            CHECK(field.type_at(x, y) == field.types(i, j));
        }
    }
}

TEST_CASE("A vertex without data makes holes of its triangles, whose borders keep their heights") {
    sb::heightfield field = uneven();
    field.heights(3, 2) = std::numeric_limits<float>::quiet_NaN();
    const glm::dvec2 missing = field.origin + 2.5 * glm::dvec2(3, 2);
    CHECK(std::isnan(field.height_at(missing.x, missing.y)));
    for (const auto& [a, b, c] : triangles_of(uneven())) {
        const glm::dvec3 middle = (a + b + c) / 3.0;
        const auto is_missing = [&](const glm::dvec3& p) { return glm::dvec2(p) == missing; };
        CHECK(std::isnan(field.height_at(middle.x, middle.y)) == (is_missing(a) || is_missing(b) || is_missing(c)));
        // The side that faces the missing vertex belongs to a neighbour, too.
        if (is_missing(b))
            CHECK(field.height_at((a.x + c.x) / 2, (a.y + c.y) / 2) == Approx((a.z + c.z) / 2).margin(1e-6));
    }
}
