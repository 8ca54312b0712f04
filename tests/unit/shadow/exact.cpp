// Exact shadows of single points: closed forms to a nanometre, no bias in either direction, every kind of mesh,
// extreme lights, and equal results for every executor and batch.
#include <insonify/core/thread_pool.hpp>
#include <insonify/geometry/cube.hpp>
#include <insonify/geometry/shared_mesh.hpp>
#include <insonify/geometry/sphere.hpp>
#include <insonify/seabed/models.hpp>
#include <insonify/seabed/sample.hpp>
#include <insonify/seabed/tessellate.hpp>

#include "../../catch.hpp"
#include "lit_mesh.hpp"

namespace in = insonify;
namespace shadow = insonify::shadow;
using lit::parallel, lit::radians;

namespace {

in::mesh box(const glm::dvec3& size, const glm::dvec3& centre) {
    return in::transformed(to_mesh(in::cube{.size = glm::vec3(size)}), {glm::dmat3(1), centre});
}

in::mesh rough(double spacing = 1.0 / 32) {
    const int side = static_cast<int>(2 / spacing) + 1;
    return in::seabed::tessellate(in::seabed::sample(in::seabed::rock{}, {{-1, -1}, spacing, side, side}));
}

/// A grid of 3 m x 3 m around the origin, whose cells are cut along the falling diagonal if `falls`.
template <class Height>
in::mesh grid_of(int side, bool falls, const Height& height) {
    in::mesh m;
    const double spacing = 3.0 / (side - 1);
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            const double x = -1.5 + spacing * i, y = -1.5 + spacing * j;
            m.positions.emplace_back(x, y, height(x, y));
            if (i + 1 == side || j + 1 == side) continue;
            const auto a = static_cast<std::uint32_t>(j * side + i), d = a + static_cast<std::uint32_t>(side);
            m.triangles.emplace_back(a, a + 1, falls ? d : d + 1);
            m.triangles.emplace_back(falls ? a + 1 : a, d + 1, d);
        }
    return m;
}

in::mesh seabed_of(const in::seabed::any& recipe, int side, bool falls) {
    const auto field = in::seabed::sample(recipe, {{-1.5, -1.5}, 3.0 / (side - 1), side, side});
    std::size_t next = 0;
    return grid_of(side, falls, [&](double, double) { return static_cast<double>(field.heights.pixels()[next++]); });
}

/// The same triangles in random order, every other one with reversed winding, without shared vertices.
in::mesh shuffled(const in::mesh& m, std::uint64_t seed) {
    in::random_sequence random(seed);
    in::mesh soup;
    std::vector<glm::uvec3> left = m.triangles;
    while (!left.empty()) {
        std::swap(left[random.below(static_cast<std::uint32_t>(left.size()))], left.back());
        const auto first = static_cast<std::uint32_t>(soup.positions.size());
        for (int i = 0; i < 3; ++i) soup.positions.push_back(m.positions[left.back()[i]]);
        const bool is_turned = left.size() % 2 == 0;
        soup.triangles.emplace_back(first, first + (is_turned ? 2 : 1), first + (is_turned ? 1 : 2));
        left.pop_back();
    }
    return soup;
}

std::ptrdiff_t count_dark(const std::vector<bool>& dark) {
    return std::count(dark.begin(), dark.end(), true);
}

const double elevations[] = {0.01, 0.5, 1, 2, 6, 20, 45, 89, 89.99};

}  // namespace

TEST_CASE("A shadow is as long as height over tangent, to a nanometre, from a millimetre's height to a kilometre's") {
    for (const double height : {1e-3, 1.0, 1e3})
        for (const double elevation : elevations)
            for (const double azimuth : {0.0, 45.0, 90.0, 160.0}) {
                CAPTURE(height, elevation, azimuth);
                const shadow::light_frame light(parallel(azimuth, elevation));
                const lit::mesh cube(box(glm::dvec3(height), {0, 0, height / 2}), parallel(azimuth, elevation));
                // Behind the top's corner or edge that is farthest down the light.
                const glm::dvec2 travel = light.travel();
                const auto side = [&](double t) { return std::abs(t) < 1e-9 ? 0.0 : std::copysign(height / 2, t); };
                const glm::dvec2 tip = glm::dvec2(side(travel.x), side(travel.y)) +
                                       static_cast<double>(static_cast<float>(height)) * light.cot_elevation() * travel;
                const double little = height * (1e-7 + 1e-10 * light.cot_elevation());
                CHECK(cube.is_dark(glm::dvec3(tip - little * travel, 0)));
                CHECK_FALSE(cube.is_dark(glm::dvec3(tip + little * travel, 0)));
                // And it begins at the foot: no gap.
                if (elevation < 89.9) {
                    const glm::dvec2 foot(side(travel.x), side(travel.y));
                    CHECK(cube.is_dark(glm::dvec3(foot + 1e-6 * height * travel, 0)));
                }
            }
}

TEST_CASE("A ridge's shadow on level ground ends at height / tan(elevation), to a micrometre, from all around") {
    for (const bool falls : {false, true})
        for (const double elevation : {2.0, 6.0, 20.0, 45.0})
            for (double azimuth = 15; azimuth < 360; azimuth += 30) {
                CAPTURE(falls, elevation, azimuth);
                const shadow::light_frame light(parallel(azimuth, elevation));
                // One row of vertices stands up, across the axis that the light follows more.
                const double height = static_cast<double>(static_cast<float>(0.5 * std::tan(radians(elevation))));
                const bool along_x = std::abs(light.travel().x) > std::abs(light.travel().y);
                const lit::mesh ridge(
                    grid_of(61, falls,
                            [&](double x, double y) { return std::abs(along_x ? x : y) < 0.01 ? height : 0.0; }),
                    parallel(azimuth, elevation));
                const glm::dvec2 tip = height * light.cot_elevation() * light.travel();
                CHECK(ridge.is_dark(glm::dvec3(tip - 1e-6 * light.travel(), 0)));
                CHECK_FALSE(ridge.is_dark(glm::dvec3(tip + 1e-6 * light.travel(), 0)));
            }
}

TEST_CASE("A facet that faces the light is never shadowed by its own plane, with or without its triangle id") {
    for (const double elevation : elevations)
        for (const double tilt : {-89.0, -30.0, -0.6, 0.0, 5.0, 80.0, 89.9})
            for (const double azimuth : {0.0, 45.0, 23.7, 180.0}) {
                const double rise = std::tan(radians(tilt));
                in::mesh plane;
                for (int j = 0; j <= 6; ++j)
                    for (int i = 0; i <= 6; ++i) {
                        const double x = i / 3.0 - 1, y = j / 3.0 - 1;
                        plane.positions.emplace_back(x, y, rise * (0.8 * x + 0.6 * y));
                    }
                for (unsigned j = 0; j < 6; ++j)
                    for (unsigned i = 0; i < 6; ++i) {
                        const unsigned c = 7 * j + i;
                        plane.triangles.emplace_back(c, c + 1, c + 8);
                        plane.triangles.emplace_back(c, c + 8, c + 7);
                    }
                const lit::mesh lit(plane, parallel(azimuth, elevation));
                const lit::point_list points = lit.facing(40, 5);
                CAPTURE(elevation, tilt, azimuth);
                CHECK(count_dark(lit.dark(points)) == 0);
                CHECK(count_dark(lit.dark(points.detached())) == 0);
            }
}

TEST_CASE("Points on rubble are dark exactly where a ray to the light hits a triangle") {
    for (const double elevation : elevations) {
        const lit::mesh lit(rough(1.0 / 16), parallel(25, elevation));
        CAPTURE(elevation);
        const lit::point_list points = lit.facing(400, 11);
        CHECK(lit.wrong(points) == 0);
        CHECK(lit.wrong(points.detached()) == 0);
    }
}

TEST_CASE("Seabeds agree with rays at every elevation, cut along either diagonal, as grids and as soups of triangles") {
    double azimuth = 10;
    for (const in::seabed::any& recipe : {in::seabed::any(in::seabed::ripples{.wavelength = 0.6f, .steepness = 0.1f}),
                                          in::seabed::any(in::seabed::mud{}), in::seabed::any(in::seabed::rock{})})
        for (const bool falls : {false, true})
            for (const double elevation : {1.0, 6.0, 20.0, 45.0}) {
                azimuth += 49;  // covers all octants
                const lit::mesh bottom(seabed_of(recipe, 65, falls), parallel(azimuth, elevation));
                const lit::mesh soup(shuffled(*bottom, 3), parallel(azimuth, elevation));
                const lit::point_list points = bottom.facing(500, 11).detached();
                const std::vector<bool> dark = bottom.dark(points);
                CAPTURE(recipe.legend().front().name, falls, azimuth, elevation);
                CHECK(bottom.wrong(points, dark) == 0);
                CHECK((soup.dark(points) == dark));
            }
}

TEST_CASE("A rotated, scaled and tilted grid casts its shadow from its pose") {
    const in::affine place =
        in::to_world({.position = {4000, -2500, 3}, .yaw = 0.7f, .pitch = 0.2f, .roll = -0.15f, .scale = 1.7f});
    const in::affine near_by{place.linear, place.offset - glm::dvec3(4000, -2500, 0)};
    in::affine mirrored = near_by;
    mirrored.linear[0] = -mirrored.linear[0];
    for (const double azimuth : {20.0, 110.0, 200.0, 290.0})
        for (const in::affine& map : {near_by, mirrored}) {
            const lit::mesh lit(seabed_of(in::seabed::rock{}, 49, true), parallel(azimuth, 25), map);
            CAPTURE(azimuth);
            lit::point_list points = lit.facing(500, 3);
            for (std::size_t i = 0; i < 100; ++i) points.add(points[i] + glm::dvec3(0, 0, 0.05));
            CHECK(lit.wrong(points) == 0);
        }
}

TEST_CASE("Inverted lobes, open sheets and nested meshes block light from either side") {
    in::mesh lobes = in::transformed(to_mesh(in::sphere{.radius = 0.5f}), {glm::dmat3(1), {0, 0, 0.5}});
    const auto add = [&](in::mesh m, bool is_turned) {
        const auto first = static_cast<std::uint32_t>(lobes.positions.size());
        lobes.positions.insert(lobes.positions.end(), m.positions.begin(), m.positions.end());
        for (glm::uvec3 t : m.triangles) {
            if (is_turned) std::swap(t.y, t.z);
            lobes.triangles.push_back(t + first);
        }
    };
    add(in::transformed(to_mesh(in::sphere{.radius = 0.3f}), {glm::dmat3(1), {0.9, 0.1, 0.4}}), true);
    add(box({0.3, 0.3, 0.3}, {0.1, 0, 0.5}), true);
    add({{{-1, -1, 1}, {-1, 0, 1.2f}, {0, -1, 1}}, {}, {{0, 1, 2}}}, false);
    lobes.normals.clear();
    for (const double azimuth : {60.0, 200.0})
        for (const double elevation : {2.0, 30.0}) {
            const lit::mesh lit(lobes, parallel(azimuth, elevation));
            lit::point_list points = lit.facing(500, 3);
            in::random_sequence random(4);
            for (int i = 0; i < 1000; ++i) points.add({random.uniform(-3, 3), random.uniform(-3, 3), 0});
            CAPTURE(azimuth, elevation);
            CHECK(count_dark(lit.dark(points)) > 50);
            CHECK(lit.wrong(points) == 0);
        }
}

TEST_CASE("No light leaks between triangles that share an edge or a vertex") {
    // Points whose rays hit the edges of a sheet, to the precision of doubles.
    const in::mesh sheet = grid_of(17, false, [](double x, double y) { return 1 + 0.02 * std::sin(3 * x) * y; });
    for (const double azimuth : {0.0, 45.0, 23.7, 90.0})
        for (const double elevation : {6.0, 45.0, 90.0}) {
            const lit::mesh lit(sheet, parallel(azimuth, elevation));
            const glm::dvec3 to_light = lit.toward({});
            lit::point_list points;
            for (std::uint32_t t = 0; t < sheet.triangles.size(); ++t)
                for (int i = 0; i < 3; ++i)
                    for (const double fraction : {0.0, 0.3, 0.5, 0.875}) {
                        const glm::dvec3 a = lit.corner(t, i), b = lit.corner(t, (i + 1) % 3),
                                         on = a + fraction * (b - a);
                        const double x = std::abs(on.x), y = std::abs(on.y);
                        if (x < 1.49 && y < 1.49) points.add(on - 2.5 * to_light);
                    }
            CAPTURE(azimuth, elevation);
            REQUIRE(points.size() > 5000);
            CHECK(count_dark(lit.dark(points)) == static_cast<std::ptrdiff_t>(points.size()));
        }
}

TEST_CASE("Level ground, and rubble under light from straight above, are lit everywhere") {
    const in::mesh level = grid_of(33, false, [](double, double) { return 0.25; });
    for (const double elevation : {0.1, 6.0, 45.0, 89.9, 90.0})
        for (double azimuth = 0; azimuth < 360; azimuth += 22.5) {
            const lit::mesh lit(level, parallel(azimuth, elevation));
            CAPTURE(elevation, azimuth);
            CHECK(count_dark(lit.dark(lit.facing(200, 1))) == 0);
        }
    const lit::mesh rubble(seabed_of(in::seabed::rock{}, 33, false), parallel(17, 90));
    CHECK(count_dark(rubble.dark(rubble.facing(500, 2))) == 0);
    CHECK(count_dark(rubble.dark(std::vector<glm::dvec3>(rubble->positions.begin(), rubble->positions.end()))) == 0);
}

TEST_CASE("A heightfield on a grid agrees with rays, for its own points and for others") {
    in::serial_executor serial;
    double azimuth = 10;
    for (const in::seabed::any& recipe : {in::seabed::any(in::seabed::ripples{.wavelength = 0.6f, .steepness = 0.1f}),
                                          in::seabed::any(in::seabed::rock{})})
        for (const bool falls : {false, true})
            for (const double elevation : {0.5, 6.0, 30.0})
                for (int turn = 0; turn < 3; ++turn) {
                    azimuth += 49;  // covers all octants
                    const shadow::directional_light light = parallel(azimuth, elevation);
                    const lit::mesh bottom(seabed_of(recipe, 41, falls), light);
                    const auto grid = in::regular_grid_of(*bottom, in::shared_mesh::grid_error);
                    REQUIRE(grid);
                    shadow::caster swept = lit::caster_of(*bottom);
                    swept.may_skip = shadow::skip::facing_self;
                    swept.grid = &*grid;
                    const lit::point_list own = bottom.facing(200, 7);
                    lit::point_list others = own.detached();
                    for (std::size_t i = 0; i < own.size(); ++i) {
                        others.add(own[i] + glm::dvec3(0.1, -0.1, 0.02 + 0.001 * static_cast<double>(i)));
                        others.add(own[i] - glm::dvec3(0, 0, 0.03));
                    }
                    CAPTURE(recipe.legend().front().name, falls, elevation, azimuth);
                    in::bounding_box box = others.box();
                    box.lower -= glm::dvec3(0.5), box.upper += glm::dvec3(0.5);
                    const auto built = shadow::exact{}.build(std::span(&swept, 1), light, {box}, serial);
                    for (const lit::point_list* points : {&own, static_cast<const lit::point_list*>(&others)})
                        CHECK(bottom.wrong(*points, lit::test(built, *points).dark()) == 0);
                }
}

TEST_CASE("Points that face away are named after the first caster that blocks them, be it the one that they lie on") {
    in::serial_executor serial;
    const in::mesh roof = box({40, 40, 0.1}, {0, 0, 4});
    for (const auto& [mesh, skip] : {std::pair(rough(), shadow::skip::facing_self),
                                     std::pair(to_mesh(in::sphere{.radius = 0.5f}), shadow::skip::facing)})
        for (const double elevation : {3.0, 10.0, 20.0}) {
            const shadow::directional_light light = parallel(20, elevation);
            const lit::mesh own(mesh, light);
            const lit::point_list lit_list = own.facing(500, 3), list = own.facing_away(500, 3);
            shadow::points facing_away = list;
            facing_away.face_light = false;
            const shadow::points at[] = {lit_list, facing_away};
            shadow::caster casters[] = {lit::caster_of(*own), lit::caster_of(roof)};
            CAPTURE(elevation, list.size());
            const auto tested = [&] {
                lit::answers lit(lit_list.size()), dark(list.size());
                const shadow::results into[] = {lit, dark};
                shadow::exact{}
                    .build(casters, light, {merge(lit_list.box(), list.box())}, serial)
                    .test(std::span<const shadow::points>(at), std::span<const shadow::results>(into), serial);
                return std::pair(lit.caster, dark.caster);
            };
            const auto all = tested();
            CHECK(std::count(all.second.begin(), all.second.end(), 0u) > 0);
            casters[0].may_skip = skip;
            CHECK(tested() == all);
        }
}

TEST_CASE("Points in front of, behind, beside and above a grid agree with rays") {
    const lit::mesh wall(grid_of(31, false, [](double x, double) { return x > 1.25 && x < 1.35 ? 0.2 : 0.0; }),
                         parallel(0, 45));
    const double infinity = std::numeric_limits<double>::infinity(), nan = std::nan("");
    const std::vector<glm::dvec3> points{{1.4, 0, 0.05},  // behind the wall
                                         {1.4, 0, 0.15},  // over its shadow
                                         {2, 0, -0.6},    // behind the grid, in the wall's shadow
                                         {2, 0, -0.4},    // and over it
                                         {1, 0, 0},       // before the wall
                                         {-2, 0, 0},      // before the grid
                                         {1.4, 2, 0.05},  // beside it
                                         {infinity, 0, 0}, {0, nan, 0}, {0, 0, nan}};
    CHECK(wall.dark(points) == std::vector<bool>{true, false, true, false, false, false, false, false, false, false});
}

TEST_CASE("A grid ends like a cliff: points behind its last edge are dark below the light that passes it") {
    for (const bool falls : {false, true})
        for (double azimuth = 10; azimuth < 360; azimuth += 40) {
            CAPTURE(falls, azimuth);
            // Ground that rises along the light all the way to the end.
            const glm::dvec2 travel = shadow::light_frame(parallel(azimuth, 20)).travel();
            const lit::mesh rising(
                grid_of(31, falls, [&](double x, double y) { return 0.2 * (x * travel.x + y * travel.y); }),
                parallel(azimuth, 20));
            // Where the light leaves the grid above its middle.
            const double half = 1.5 / std::max(std::abs(travel.x), std::abs(travel.y)), beyond = half + 0.4;
            const double ray = 0.2 * half - 0.4 * std::tan(radians(20));
            CHECK(rising.is_dark(glm::dvec3(beyond * travel, ray - 1e-6)));
            CHECK_FALSE(rising.is_dark(glm::dvec3(beyond * travel, ray + 1e-6)));
        }
}

TEST_CASE("The result for a point does not depend on the bounds") {
    const lit::mesh lit(rough(), parallel(50, 6));
    const lit::point_list all = lit.facing(4000, 9);
    lit::point_list some;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (all[i].x > 0.2 && all[i].x < 0.7 && all[i].y > 0.1 && all[i].y < 0.7) some.add(all[i], 0, all.triangle(i));
    REQUIRE(some.size() > 50);
    const std::vector<bool> tight = lit.dark(some);
    CHECK((lit.dark(some, all.box()) == tight));
    CHECK((lit.dark(some, {glm::dvec3(-300), glm::dvec3(300)}) == tight));
    CHECK(count_dark(tight) > 5);
}

TEST_CASE("Light from a point: shadows spread as similar triangles do") {
    // A square of side s at height h under a light at height H throws one of side s H / (H - h).
    const double light = 3, height = 1, side = 0.5;
    const in::mesh sheet{
        {{-0.25f, -0.25f, 1}, {0.25f, -0.25f, 1}, {0.25f, 0.25f, 1}, {-0.25f, 0.25f, 1}}, {}, {{0, 1, 2}, {0, 2, 3}}};
    for (const glm::dvec2 beside : {glm::dvec2(0, 0), glm::dvec2(-7, 2), glm::dvec2(0, 100)}) {
        const lit::mesh lit(sheet, shadow::point_light{{beside, light}});
        const double half = 0.5 * side * light / (light - height);
        const glm::dvec2 centre = -beside * (height / (light - height));
        for (const double sign : {-1.0, 1.0})
            for (int axis = 0; axis < 2; ++axis) {
                glm::dvec2 edge = centre;
                edge[axis] += sign * half;
                glm::dvec2 out(0);
                out[axis] = sign * 1e-7;
                CAPTURE(beside.x, beside.y, sign, axis);
                CHECK(lit.is_dark(glm::dvec3(edge - out, 0)));
                CHECK_FALSE(lit.is_dark(glm::dvec3(edge + out, 0)));
            }
        CHECK_FALSE(lit.is_dark(glm::dvec3(0, 0, 2)));  // above the sheet
    }
}

TEST_CASE("A distant point light casts the shadows of a parallel light") {
    const glm::dvec3 to_light = shadow::light_frame(parallel(200, 6)).to_light();
    const lit::mesh far_away(rough(), shadow::point_light{1e9 * to_light}), parallel_light(rough(), parallel(200, 6));
    const lit::point_list points = parallel_light.facing(3000, 8);
    const std::vector<bool> one = far_away.dark(points), other = parallel_light.dark(points);
    int different = 0;
    for (std::size_t i = 0; i < points.size(); ++i) different += one[i] != other[i];
    CHECK(different <= 1);
    CHECK(count_dark(one) > 300);
}

TEST_CASE("Point lights just above, on and below the bottom, and inside a target, agree with rays") {
    const in::mesh bottom = rough(1.0 / 16);
    const glm::dvec3 on_vertex(bottom.positions[500]);
    const glm::dvec3 on_facet =
        (glm::dvec3(bottom.positions[bottom.triangles[700].x]) + glm::dvec3(bottom.positions[bottom.triangles[700].y]) +
         glm::dvec3(bottom.positions[bottom.triangles[700].z])) /
        3.0;
    const glm::dvec3 lights[] = {
        {0.3, 0.2, 0.35}, {0.3, 0.2, 5},     on_vertex,  on_facet, on_facet + glm::dvec3(0, 0, 0.01),
        {0.1, 0.1, -2},   {-30, 0.013, 0.2}, {0, 0, 1e4}};
    for (const glm::dvec3& position : lights) {
        const lit::mesh lit(bottom, shadow::point_light{position});
        lit::point_list points = lit.facing(250, 2);
        points.add(position);
        CAPTURE(position.x, position.y, position.z);
        CHECK(lit.wrong(points) == 0);
    }
    // No light leaves a closed box, and everything inside is lit.
    const lit::mesh closed(box({1, 1, 1}, {0, 0, 0.5}), shadow::point_light{{0.1, 0.2, 0.6}});
    CHECK(closed.is_dark({2, 0, 0}));
    CHECK(closed.is_dark({0, 0, 3}));
    CHECK_FALSE(closed.is_dark({-0.4, 0.4, 0.1}));
}

TEST_CASE("Light exactly along a face or an edge: the face casts no more than its edges do") {
    // Straight from -x over a cube that is turned along it: sides parallel to the light cast the cube's own outline.
    const lit::mesh cube(box({1, 1, 1}, {0, 0, 0.5}), parallel(0, 45));
    CHECK(cube.is_dark({1.4999999, 0.4999999, 0}));
    CHECK_FALSE(cube.is_dark({1, 0.5000001, 0}));
    CHECK_FALSE(cube.is_dark({1.5000001, 0, 0}));
    // Light parallel to a tilted face: points on it are not behind it.
    const in::mesh ramp{{{0, -1, 1}, {1, -1, 0}, {1, 1, 0}, {0, 1, 1}}, {}, {{0, 1, 2}, {0, 2, 3}}};
    const lit::mesh grazed(ramp, parallel(0, 45));
    CHECK_FALSE(grazed.is_dark({0.5, 0, 0.5}));
    CHECK_FALSE(grazed.is_dark({1.2, 0, 0}));
    CHECK_FALSE(grazed.is_dark({1.2, 0, -0.1}));
}

TEST_CASE("A seabed with a vertical step and a level one agree with rays") {
    in::seabed::heightfield field{.heights = in::image<float>(65, 65), .origin = {-1, -1}, .spacing = 1.0 / 32};
    const lit::mesh flat(in::seabed::tessellate(field), parallel(30, 0.01));
    CHECK(count_dark(flat.dark(flat.facing(500, 1))) == 0);
    // A step of 1 km over a cell of 3 cm, as near to vertical as a heightfield comes.
    for (int j = 0; j < 65; ++j)
        for (int i = 0; i < 32; ++i) field.heights(i, j) = 1000;
    for (const double elevation : {0.01, 6.0, 89.0, 89.99}) {
        const lit::mesh wall(in::seabed::tessellate(field), parallel(0, elevation));
        CAPTURE(elevation);
        CHECK(wall.wrong(wall.facing(300, 4)) == 0);
    }
}

TEST_CASE("Exact results are the same for any executor and any batches of points", "[threads]") {
    in::thread_pool pool(3);
    in::serial_executor serial;
    const in::mesh bottom = rough();
    const shadow::caster casters[] = {lit::caster_of(bottom)};
    for (const shadow::any_light& light :
         {shadow::any_light(parallel(23, 6)), shadow::any_light(shadow::point_light{{-0.7, 0.3, 0.9}})}) {
        lit::point_list points = lit::mesh(bottom, light).facing(3001, 9);
        in::random_sequence random(1);
        // More than one batch holds.
        const std::size_t count = std::holds_alternative<shadow::point_light>(light) ? 4000 : 70000;
        while (points.size() < count)
            points.add({random.uniform(0, 2), random.uniform(0, 2), random.uniform(-0.1, 0.3)});
        const shadow::point_bounds bounds{points.box()};
        const auto built = shadow::exact{}.build(casters, light, bounds, serial);
        const lit::answers expected = lit::test(built, points);
        CHECK(count_dark(expected.dark()) > 400);
        CHECK((lit::test(shadow::exact{}.build(casters, light, bounds, pool), points).lit == expected.lit));

        lit::answers parts(points.size());
        const shadow::points all = points;
        const shadow::results into = parts;
        std::vector<shadow::points> at;
        std::vector<shadow::results> to;
        std::size_t first = 0;
        for (std::size_t i = 0; first < points.size(); ++i) {
            const std::size_t some = std::min(points.size() - first, i % 5 == 0   ? 65536u
                                                                     : i % 3 == 0 ? 0u
                                                                                  : 1 + 777 * i);
            at.push_back({all.x.subspan(first, some), all.y.subspan(first, some), all.z.subspan(first, some),
                          all.mesh.subspan(first, some), all.triangle.subspan(first, some)});
            to.push_back({into.lit.subspan(first, some), into.caster.subspan(first, some)});
            first += some;
        }
        built.test(std::span<const shadow::points>(at), std::span<const shadow::results>(to), pool);
        CHECK((parts.lit == expected.lit));
        CHECK((parts.caster == expected.caster));
    }
}

TEST_CASE("An empty scene casts no shadow, and neither do triangles that are not finite") {
    CHECK_FALSE(lit::mesh({}, parallel(0, 45)).is_dark({0, 0, 0}));
    CHECK_FALSE(lit::mesh({}, shadow::point_light{{0, 0, 1}}).is_dark({0, 0, 0}));
    const double nan = std::nan("");
    const lit::mesh cube(box({1, 1, 1}, {0, 0, 0.5}), parallel(0, 45));
    for (const glm::dvec3& p : {glm::dvec3(nan, 0, 0), {0, 0, nan}, {1e30, 0, 0}, {0, -1e300, 0}})
        CHECK_FALSE(cube.is_dark(p));
    in::mesh broken = *cube;
    broken.positions[0].x = std::nanf("");
    broken.positions[1].z = std::numeric_limits<float>::infinity();
    CHECK(lit::mesh(broken, parallel(0, 45)).is_dark({1.2, 0.3, 0}));
    for (const shadow::any_light& light :
         {shadow::any_light(parallel(0, 45)), shadow::any_light(shadow::point_light{{-3, 0, 3}})}) {
        const lit::mesh lit(broken, light);
        lit::point_list ground;
        in::random_sequence random(2);
        for (int i = 0; i < 2000; ++i) ground.add({random.uniform(-2, 3), random.uniform(-2, 2), 0});
        in::mesh whole = broken;
        std::erase_if(whole.triangles, [](const glm::uvec3& t) { return t.x < 2 || t.y < 2 || t.z < 2; });
        CHECK(lit::mesh(whole, light).wrong(ground, lit.dark(ground)) == 0);
    }
}

TEST_CASE("A vertex at the largest float changes no other triangle's shadow") {
    in::mesh m = rough(1.0 / 16);
    const lit::mesh before(m, parallel(25, 6));
    const lit::point_list points = before.facing(600, 5);
    const std::vector<bool> expected = before.dark(points);
    CHECK(count_dark(expected) > 100);
    for (const glm::vec3& corner : {glm::vec3(3.4e38f, 0, 0), glm::vec3(0, -3.4e38f, 0), glm::vec3(0, 0, -3.4e38f)}) {
        in::mesh one = m;
        const auto first = static_cast<std::uint32_t>(one.positions.size());
        one.positions.insert(one.positions.end(), {corner, {40, 40, -50}, {41, 40, -50}});
        one.triangles.emplace_back(first, first + 1, first + 2);
        CAPTURE(corner.x, corner.y, corner.z);
        CHECK((lit::mesh(one, parallel(25, 6)).dark(points) == expected));
    }
}

TEST_CASE("An index without a position is refused, and so are lights out of range") {
    in::mesh m = box({1, 1, 1}, {0, 0, 0.5});
    m.triangles[3].y = static_cast<std::uint32_t>(m.positions.size());
    CHECK_THROWS_WITH(lit::mesh(m, parallel(0, 45)).is_dark({0, 0, 0}), ContainsSubstring("mesh.triangles is"));
    CHECK_THROWS_AS(lit::mesh(m, shadow::point_light{{0, 0, 9}}).is_dark({0, 0, 0}), in::invalid_input);
    const in::mesh cube = box({1, 1, 1}, {0, 0, 0.5});
    CHECK_THROWS_AS(lit::mesh(cube, parallel(0, 0)).is_dark({0, 0, 0}), in::invalid_input);
    CHECK_THROWS_AS(lit::mesh(cube, shadow::point_light{{std::nan(""), 0, 0}}).is_dark({0, 0, 0}), in::invalid_input);
}
