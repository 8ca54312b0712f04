// Maps that name their casters: edges where the casters have them, however large the texels, against closed forms and
// against rays that are tried on every triangle.
#include <insonify/core/random.hpp>
#include <insonify/core/thread_pool.hpp>
#include <insonify/geometry/cube.hpp>
#include <insonify/geometry/sphere.hpp>
#include <insonify/seabed/any.hpp>
#include <insonify/seabed/sample.hpp>
#include <insonify/seabed/tessellate.hpp>
#include <insonify/shadow/caster_map.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../../catch.hpp"
#include "points.hpp"

namespace in = insonify;
namespace shadow = insonify::shadow;
using points::ask, points::radians;

namespace {

template <class E = in::serial_executor>
shadow::caster_map map_of(const in::mesh& m, const shadow::light_frame& light, double texel, bool is_solid = true,
                          E&& ex = {}) {
    const shadow::map_extent extent = shadow::extent_of(in::bounds(m), {}, light);
    return {light, m, {}, is_solid, extent, extent.reach(), texel, 16384, ex};
}

in::mesh standing_cube() {
    return in::transformed(to_mesh(in::cube{}), {glm::dmat3(1), {0, 0, 0.5}});
}

}  // namespace

TEST_CASE("A cube's shadow on level ground ends at height / tan(elevation), to a fiftieth of a texel") {
    const double texel = 0.05;
    for (const double elevation : {1.0, 6.0, 20.0, 45.0, 80.0})
        for (const double azimuth : {0.0, 33.0, 90.0, 215.0}) {
            CAPTURE(elevation, azimuth);
            const shadow::light_frame light({radians(azimuth), radians(elevation)});
            const in::mesh cube = standing_cube();
            const shadow::caster_map map = map_of(cube, light, texel);
            // Behind the middle of the top's edge that is farther down the light.
            const glm::dvec2 travel = light.travel();
            const bool along_x = std::abs(travel.x) > std::abs(travel.y);
            const glm::dvec2 edge(along_x ? std::copysign(0.5, travel.x) : 0,
                                  along_x ? 0 : std::copysign(0.5, travel.y));
            const glm::dvec2 tip = edge + light.cot_elevation() * travel;
            const auto point = [&](double beyond) { return glm::vec3(glm::dvec3(tip + beyond * travel, 0)); };
            const std::vector<bool> dark = ask(map, {point(-0.02 * texel), point(0.02 * texel)});
            CHECK(dark[0]);
            CHECK_FALSE(dark[1]);
        }
}

TEST_CASE("Points are dark where a ray meets a triangle, whichever way the mesh's strips lie") {
    const in::seabed::grid grid{{-1.5, -1.5}, 3.0 / 64, 65, 65};
    struct bottom_kind {
        in::seabed::any recipe;
        double azimuth;
        int most_wrong;  ///< of a thousand
    };
    const auto ripples = [](double direction) {
        return in::seabed::ripples{
            .wavelength = 0.6f, .steepness = 0.1f, .direction = static_cast<float>(radians(direction))};
    };
    // Across the crests, then nearly along them, where shadows are narrower than a texel.
    const bottom_kind kinds[] = {
        {ripples(0), 25, 10},         {ripples(90), 115, 15},        {ripples(0), 115, 20},
        {ripples(90), 25, 20},        {in::seabed::mud{}, 25, 10},   {in::seabed::mud{}, 115, 15},
        {in::seabed::rock{}, 25, 25}, {in::seabed::rock{}, 115, 25}, {ripples(0), 295, 35}};
    in::random_sequence random(11);
    for (const auto& [recipe, azimuth, most_wrong] : kinds) {
        const in::mesh bottom = in::seabed::tessellate(in::seabed::sample(recipe, grid));
        for (const double elevation : {3.0, 6.0, 20.0, 45.0}) {
            const shadow::light_frame light({radians(azimuth), radians(elevation)});
            const std::vector<glm::vec3> asked = points::facing(bottom, light.to_light(), 1000, random);
            const int wrong = points::wrong(map_of(bottom, light, 3.0 / 128), asked, bottom, light.to_light());
            CAPTURE(recipe.index(), azimuth, elevation);
            CHECK(wrong <= most_wrong);
        }
    }
}

TEST_CASE("Of a closed shape it hardly matters whether the sides in the light cast too") {
    const shadow::light_frame light({1, radians(30)});
    const in::mesh ball = in::transformed(to_mesh(in::sphere{.radius = 0.5f}), {glm::dmat3(1), {0, 0, 0.5}});
    std::vector<glm::vec3> ground;
    for (int j = -40; j <= 40; ++j)
        for (int i = -40; i <= 40; ++i)
            ground.push_back({0.037f * static_cast<float>(i), 0.037f * static_cast<float>(j), 0});
    const std::vector<bool> sides = ask(map_of(ball, light, 0.02, true), ground);
    const std::vector<bool> all = ask(map_of(ball, light, 0.02, false), ground);
    CHECK(std::count(sides.begin(), sides.end(), true) > 300);
    std::size_t different = 0;
    for (std::size_t i = 0; i < ground.size(); ++i) different += sides[i] != all[i];
    CHECK(different <= ground.size() / 400);
}

TEST_CASE("An open sheet casts from both of its sides, if it isn't called solid") {
    const shadow::light_frame light({0, radians(45)});
    const in::mesh sheet{{{0, -1, 1}, {0, 1, 1}, {1, 1, 1}, {1, -1, 1}}, {}, {{0, 2, 1}, {0, 3, 2}}};
    in::mesh turned = sheet;
    for (glm::uvec3& t : turned.triangles) std::swap(t.y, t.z);
    const std::vector<glm::vec3> below{{1.5f, 0, 0}, {0.5f, 0, 0}, {2.5f, 0, 0}};
    for (const in::mesh& m : {sheet, turned})
        CHECK(ask(map_of(m, light, 0.1, false), below) == std::vector<bool>{true, false, false});
}

TEST_CASE("The answers are the same at every instruction set and for any executor") {
    const shadow::light_frame light({0.4, radians(6)});
    const in::mesh bottom =
        in::seabed::tessellate(in::seabed::sample(in::seabed::rock{}, {{-1, -1}, 1.0 / 32, 65, 65}));
    in::thread_pool pool(3);
    const shadow::caster_map serial = map_of(bottom, light, 0.02), parallel = map_of(bottom, light, 0.02, true, pool);
    std::vector<glm::vec3> points = bottom.positions;
    for (glm::vec3& p : points) p += glm::vec3(0.011f, 0.007f, 0.003f);
    const std::vector<bool> expected = ask(serial, points, in::isa::scalar);
    CHECK(std::count(expected.begin(), expected.end(), true) > 100);
    for (const in::isa level : {in::isa::scalar, in::isa::baseline, in::isa::avx2}) {
        CHECK((ask(serial, points, level) == expected));
        CHECK((ask(parallel, points, level) == expected));
    }
}

TEST_CASE("An empty map leaves everything lit, and so does one far from the point") {
    const shadow::light_frame light({0, radians(45)});
    const in::mesh cube = standing_cube();
    CHECK(ask(shadow::caster_map(), {{0, 0, 0}}) == std::vector<bool>{false});
    CHECK(ask(map_of({}, light, 0.1), {{0, 0, 0}}) == std::vector<bool>{false});
    const float far_away = 1e30f, nan = std::nanf("");
    CHECK(ask(map_of(cube, light, 0.1), {{far_away, 0, 0}, {0, -far_away, 0}, {nan, 0, 0}, {0, 0, nan}}) ==
          std::vector<bool>(4, false));
}
