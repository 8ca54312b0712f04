// Behaviour common to all shadow policies, and results of map, pcf and penumbra for single points.
#include <insonify/core/random.hpp>
#include <insonify/geometry/cube.hpp>
#include <insonify/shadow/map.hpp>
#include <insonify/shadow/penumbra.hpp>

#include "../../catch.hpp"
#include "lit_mesh.hpp"

namespace in = insonify;
namespace shadow = insonify::shadow;
using lit::caster_of, lit::parallel, lit::radians;

namespace {

in::affine at(const glm::dvec3& place) {
    return {glm::dmat3(1), place};
}

template <shadow::casting_policy Policy>
lit::answers results_of(const Policy& policy, std::span<const shadow::caster> casters, const shadow::any_light& light,
                        const shadow::points& points, const shadow::point_bounds& bounds) {
    in::serial_executor ex;
    return lit::test(policy.build(casters, light, bounds, ex), points);
}

const in::bounding_box around{{-4, -4, -1}, {8, 4, 2}};
constexpr std::uint32_t none = shadow::invalid_id;

/// A level or tilted sheet of two triangles.
in::mesh sheet(double rise, bool is_turned = false) {
    in::mesh m{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {}, {{0, 1, 2}, {0, 2, 3}}};
    for (glm::vec3& p : m.positions) p.z = static_cast<float>(rise) * p.x;
    if (is_turned)
        for (glm::uvec3& t : m.triangles) std::swap(t.y, t.z);
    return m;
}

}  // namespace

TEMPLATE_TEST_CASE("Every policy reports the lowest-numbered caster that blocks a point, among those that apply to it",
                   "", shadow::map, shadow::pcf, shadow::exact, shadow::penumbra) {
    const in::mesh cube = to_mesh(in::cube{});
    // In a row along the light, the second nearest to it.
    const shadow::caster casters[] = {caster_of(cube, at({1.5, 0, 0.5})), caster_of(cube, at({0, 0, 0.5})),
                                      caster_of(cube, at({0, 2, 0.5}))};
    const lit::point_list list(std::vector<glm::dvec3>{
        {2.2, 0, 0.1}, {0.7, 0, 0.2}, {-0.7, 0, 0}, {0.8, 2, 0.1}, {2.6, 2.9, 0.1}, {2.4, 0, 0.4}});
    const shadow::point_bounds bounds{around, 0.02};
    const auto found = results_of(TestType{}, casters, parallel(0, 30), list, bounds);
    CHECK(found.lit == std::vector<float>{0, 0, 1, 0, 1, 0});
    CHECK(found.caster == std::vector<std::uint32_t>{0, 1, none, 2, none, 0});

    shadow::points few = list;
    few.casters = 2;
    const auto of_two = results_of(TestType{}, casters, parallel(0, 30), few, bounds);
    CHECK(of_two.caster == std::vector<std::uint32_t>{0, 1, none, none, none, 0});
    few.casters = 0;
    CHECK(results_of(TestType{}, casters, parallel(0, 30), few, bounds).caster == std::vector<std::uint32_t>(6, none));
    CHECK(results_of(TestType{}, {}, parallel(0, 30), list, bounds).lit == std::vector<float>(6, 1.0f));
}

TEST_CASE("Many small casters shade points as each does alone") {
    const in::mesh cube = to_mesh(in::cube{.size = glm::vec3(0.2f)});
    in::random_sequence random(1);
    std::vector<shadow::caster> casters;
    for (int i = 0; i < 60; ++i)
        casters.push_back(caster_of(cube, at({random.uniform(-3, 3), random.uniform(-3, 3), 0.1})));
    lit::point_list list;
    for (int i = 0; i < 4000; ++i) list.add({random.uniform(-3.5, 3.5), random.uniform(-3.5, 3.5), 0});
    const shadow::point_bounds bounds{around, 0.02};
    const auto check = [&](const auto& policy, const auto& lit_beside) {
        const auto together = results_of(policy, casters, parallel(20, 15), list, bounds);
        for (std::size_t i = 0; i < list.size(); ++i) {
            float lit = 1;
            std::uint32_t blocking = none;
            for (std::uint32_t k = 0; k < casters.size(); ++k) {
                const float alone = lit_beside(k, i);
                lit = (std::min)(lit, alone);
                if (alone < 0.5f && blocking == none) blocking = k;
            }
            CAPTURE(i);
            CHECK(together.lit[i] == lit);
            CHECK(together.caster[i] == blocking);
        }
    };
    std::vector<std::vector<float>> alone;
    for (std::uint32_t k = 0; k < casters.size(); ++k)
        alone.push_back(
            results_of(shadow::exact{}, std::span(casters).subspan(k, 1), parallel(20, 15), list, bounds).lit);
    check(shadow::exact{}, [&](std::uint32_t k, std::size_t i) { return alone[k][i]; });

    const shadow::light_frame light(parallel(20, 15));
    std::vector<shadow::height_map> maps;
    for (const shadow::caster& c : casters) {
        maps.emplace_back(light, shadow::extent_of(c.box, c.placement, light), 0.02 / 1.5);
        maps.back().cast(c.mesh, c.placement);
    }
    for (const int radius : {0, 8})
        check(shadow::pcf{.radius = radius}, [&](std::uint32_t k, std::size_t i) {
            return shadow::lit(maps[k], {light, list[i], glm::dvec3(0)}, radius);
        });
}

TEMPLATE_TEST_CASE("No policy gives a sheet shadow acne, whichever way its triangles are wound", "", shadow::map,
                   shadow::pcf, shadow::exact, shadow::penumbra) {
    for (const bool is_turned : {false, true})
        for (const double elevation : {3.0, 20.0, 70.0})
            for (const double rise : {-0.03, 0.0, 0.5, 2.0}) {
                const in::mesh m = sheet(rise, is_turned);
                const lit::mesh source(sheet(rise), parallel(30, elevation));
                lit::point_list points;
                const lit::point_list facing = source.facing(200, 3);
                for (std::size_t i = 0; i < facing.size(); ++i)
                    if (std::abs(facing[i].x) < 0.95 && std::abs(facing[i].y) < 0.95)
                        points.add(facing[i], 0, facing.triangle(i));
                const shadow::caster casters[] = {caster_of(m)};
                CAPTURE(is_turned, elevation, rise);
                const auto found =
                    results_of(TestType{}, casters, parallel(30, elevation), points, {points.box(), 0.02});
                CHECK(found.lit == std::vector<float>(points.size(), 1.0f));
                CHECK(found.caster == std::vector<std::uint32_t>(points.size(), none));
            }
}

TEST_CASE("Under maps a facet at grazing light is shaded by itself, or by a caster of a lower number") {
    // Inclined to the light by 0.3 degrees: 1.5 % of what level ground gets.
    const double rise = -std::tan(radians(19.7));
    const in::mesh m = sheet(rise), cube = to_mesh(in::cube{});
    lit::point_list points;
    points.add({0.2, 0.1, 0.2 * rise}, 1, 0);
    lit::point_list own;
    own.add(points[0], 0, 0);
    const shadow::caster apart[] = {caster_of(cube, at({-3, 3, 1})), caster_of(m), caster_of(cube, at({-1.7, 0, 1}))};
    const shadow::caster before[] = {apart[2], apart[1], apart[0]};
    for (const auto& found : {results_of(shadow::map{}, apart, parallel(0, 20), points, {around, 0.02}),
                              results_of(shadow::pcf{}, apart, parallel(0, 20), points, {around, 0.02})}) {
        CHECK(found.lit[0] == 0);
        CHECK(found.caster[0] == 1);
    }
    CHECK(results_of(shadow::map{}, before, parallel(0, 20), points, {around, 0.02}).caster[0] == 0);
    CHECK(results_of(shadow::exact{}, {&apart[1], 1}, parallel(0, 20), own, {around, 0.02}).lit[0] == 1);
}

TEST_CASE("The edge of a map's shadow is off by half a texel of the points' spacing, or of a 2048th of their extent") {
    // A second cube farther along the light: maps cover their caster, and their border would cut at the edge exactly.
    in::mesh cubes = to_mesh(in::cube{});
    const in::mesh farther = in::transformed(cubes, at({5, 0, 0}));
    for (const glm::uvec3& t : farther.triangles)
        cubes.triangles.push_back(t + static_cast<std::uint32_t>(farther.positions.size()));
    cubes.positions.insert(cubes.positions.end(), farther.positions.begin(), farther.positions.end());
    cubes.normals.insert(cubes.normals.end(), farther.normals.begin(), farther.normals.end());
    const shadow::caster casters[] = {caster_of(cubes, at({0, 0, 0.5}))};
    const double edge = 0.5 + 1 / std::tan(radians(40));
    for (const double spacing : {0.3, 0.06, 0.0}) {
        lit::point_list points;
        for (int i = 0; i < 2000; ++i) points.add({0.6 + 0.001 * i, 0.0123, 0});
        const auto found = results_of(shadow::map{}, casters, parallel(0, 40), points, {around, spacing});
        const auto dark = std::count(found.lit.begin(), found.lit.end(), 0.0f);
        const double texel = spacing > 0 ? spacing / 1.5 : 12.0 / 2048 / 1.5;
        CAPTURE(spacing);
        CHECK(std::abs(0.6 + 0.001 * static_cast<double>(dark) - edge) <= 0.5 * texel + 0.002);
    }
}

TEST_CASE("pcf darkens a shadow that covers all points up to their bounds") {
    in::mesh roof = sheet(0);
    for (glm::vec3& p : roof.positions) p = {100.0f * p.x, 100.0f * p.y, 3};
    const shadow::caster casters[] = {caster_of(roof, {})};
    lit::point_list list;
    for (const double x : {-1.0, -0.98, 0.0, 0.99, 1.0})
        for (const double y : {-1.0, -0.97, 0.0, 0.98, 1.0})
            for (const double z : {0.0, 1.0}) list.add({x, y, z});
    for (const double elevation : {20.0, 70.0, 90.0})
        for (const int radius : {1, 8}) {
            const auto found = results_of(shadow::pcf{.radius = radius}, casters, parallel(17, elevation), list,
                                          {{{-1, -1, 0}, {1, 1, 1}}, 0.02});
            CAPTURE(elevation, radius);
            CHECK(found.lit == std::vector<float>(list.size(), 0.0f));
        }
}

TEST_CASE("pcf reports the first caster that blocks more than half of the light") {
    const in::mesh cube = to_mesh(in::cube{});
    const shadow::caster casters[] = {caster_of(cube, at({0, 0, 0.5}))};
    lit::point_list points;
    for (int i = 0; i < 400; ++i) points.add({1.3 + 0.001 * i, 0.0123, 0});
    const auto found = results_of(shadow::pcf{.radius = 3}, casters, parallel(0, 45), points, {around, 0.05});
    int soft = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        CHECK((found.caster[i] == 0) == (found.lit[i] < 0.5f));
        soft += found.lit[i] > 0 && found.lit[i] < 1;
    }
    CHECK(soft > 50);
}

TEST_CASE("A point in a penumbra is lit by the visible fraction of the disc, under parallel and point lights") {
    // The far edge of a wide wall cuts the disc through its middle at the edge of the hard shadow.
    const in::mesh wall = in::transformed(to_mesh(in::cube{.size = {1, 30, 1}}), at({0, 0, 0.5}));
    const shadow::caster casters[] = {caster_of(wall)};
    const double diameter = radians(4), radius = std::tan(diameter / 2);
    const shadow::penumbra how{.diameter = static_cast<float>(diameter), .samples = 400};
    const auto visible_fraction = [&](double cut) {  // of a disc above a level chord
        return cut >= 1 ? 0.0 : cut <= -1 ? 1.0 : (std::acos(cut) - cut * std::sqrt(1 - cut * cut)) / in::numeric::pi;
    };
    for (const double behind : {1.6, 1.65, 1.7, 1.732, 1.75, 1.8, 1.85}) {
        lit::point_list point;
        point.add({0.5 + behind, 0, 0});
        const double cut = std::tan(std::atan(1 / behind) - radians(30)) / radius;
        const auto found = results_of(how, casters, parallel(0, 30), point, {around});
        CAPTURE(behind, cut);
        CHECK(static_cast<double>(found.lit[0]) == Approx(visible_fraction(cut)).margin(0.01));
        CHECK((found.caster[0] == 0) == (cut > 0));
    }
    // From nearby: a disc of this radius around (-6, 0, 6), which faces the origin.
    const glm::dvec3 lamp(-6, 0, 6);
    for (const double x : {1.7, 1.75, 1.8, 1.85, 1.9}) {
        const glm::dvec3 p(x, 0, 0), edge(0.5, 0, 1), up = glm::normalize(glm::dvec3(6, 0, 6));
        // Where the plane through the point and the edge meets the disc, along its upward radius.
        const glm::dvec3 normal = glm::cross(edge - p, glm::dvec3(0, 1, 0));
        const double cut = glm::dot(normal, p - lamp) / glm::dot(normal, up) / (glm::length(lamp) * radius);
        lit::point_list point;
        point.add(p);
        CAPTURE(x, cut);
        CHECK(static_cast<double>(results_of(how, casters, shadow::point_light{lamp}, point, {around}).lit[0]) ==
              Approx(visible_fraction(cut)).margin(0.02));
    }
}

TEST_CASE("Light may have the float nearest to 10^-9 radians as its elevation, but no less") {
    const float lowest = 1e-9f;
    CHECK_NOTHROW(shadow::light_frame({0, static_cast<double>(lowest)}));
    CHECK_THROWS_WITH(shadow::light_frame({0, static_cast<double>(std::nextafter(lowest, 0.0f))}),
                      ContainsSubstring("expected 10^-9 to pi / 2"));
}

TEST_CASE("Light from the float nearest to pi / 2 comes from the zenith, not from beyond") {
    const shadow::light_frame frame({0.3, static_cast<double>(static_cast<float>(in::numeric::pi / 2))});
    CHECK((frame.to_light().x == 0 && frame.to_light().y == 0));
    CHECK(frame.cot_elevation() == 0);
    CHECK_THROWS_WITH(shadow::light_frame({0, 1e-39}), ContainsSubstring("elevation is 1e-39"));
}

TEST_CASE("Samples of a penumbra below the lowest elevation of a light are below the horizon") {
    lit::point_list point;
    point.add({0, 0, 0});
    const shadow::directional_light lowest{.elevation = shadow::directional_light::lowest_elevation};
    const auto found = results_of(shadow::penumbra{.diameter = 1e-9f, .samples = 100}, {}, lowest, point, {around});
    CHECK(found.lit[0] == Approx(0.5).margin(0.05));
}

TEST_CASE("Samples of a penumbra behind a facet's plane do not light it") {
    const in::mesh m = sheet(-std::tan(radians(29.5)));  // half a degree to the light at 30 degrees
    const shadow::caster casters[] = {caster_of(m)};
    lit::point_list point;
    point.add({0.1, 0.05, -0.1 * std::tan(radians(29.5))}, 0, 0);
    const shadow::penumbra how{.diameter = static_cast<float>(radians(4)), .samples = 400};
    const double cut = -std::tan(radians(0.5)) / std::tan(radians(2));
    const double visible_fraction = (std::acos(cut) - cut * std::sqrt(1 - cut * cut)) / in::numeric::pi;
    CHECK(static_cast<double>(results_of(how, casters, parallel(0, 30), point, {around}).lit[0]) ==
          Approx(visible_fraction).margin(0.01));
}

TEST_CASE("Parameters out of range are refused by name, and so are point lights by maps") {
    const shadow::caster casters[] = {caster_of(sheet(0))};
    const auto build = [&](const auto& policy, const shadow::any_light& light) {
        in::serial_executor ex;
        policy.build(std::span<const shadow::caster>(casters), light, {around, 0.1}, ex);
    };
    const shadow::any_light light = parallel(0, 30);
    CHECK_THROWS_WITH(build(shadow::map{.texels_per_pixel = 0}, light), ContainsSubstring("texels_per_pixel is 0"));
    CHECK_THROWS_WITH(build(shadow::map{.largest = 0}, light), ContainsSubstring("largest is 0"));
    CHECK_THROWS_WITH(build(shadow::pcf{.radius = 9}, light), ContainsSubstring("radius is 9"));
    CHECK_THROWS_WITH(build(shadow::penumbra{.diameter = 2}, light), ContainsSubstring("diameter is 2"));
    CHECK_THROWS_WITH(build(shadow::penumbra{.samples = 0}, light), ContainsSubstring("samples is 0"));
    const shadow::any_light lamp = shadow::point_light{{0, 0, 3}};
    CHECK_THROWS_WITH(build(shadow::map{}, lamp),
                      ContainsSubstring("the distance of the light (overhead.light_distance) is 3, expected infinite"));
    CHECK_THROWS_WITH(build(shadow::pcf{}, lamp), ContainsSubstring("shadow::penumbra"));
}
