// Horizons: shadows of heightfields over regular grids, against closed forms and against rays that are tried on every
// triangle, whichever way the light goes over the grid and its cells are cut.
#include <insonify/core/thread_pool.hpp>
#include <insonify/seabed/any.hpp>
#include <insonify/seabed/sample.hpp>
#include <insonify/seabed/tessellate.hpp>
#include <insonify/shadow/refined.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include "../../catch.hpp"
#include "points.hpp"

namespace in = insonify;
namespace shadow = insonify::shadow;
using points::ask, points::radians;

namespace {

/// A grid of 3 m x 3 m around the origin; cells are cut along the other diagonal if they fall, and rows go down as
/// those of pictures if they sink.
template <class Height>
in::mesh grid_of(int side, bool falls, const Height& height, bool sinks = false) {
    in::mesh m;
    const double spacing = 3.0 / (side - 1);
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            const double x = -1.5 + spacing * i, y = sinks ? 1.5 - spacing * j : -1.5 + spacing * j;
            m.positions.emplace_back(x, y, height(x, y));
            if (i + 1 == side || j + 1 == side) continue;
            const auto a = static_cast<std::uint32_t>(j * side + i), d = a + static_cast<std::uint32_t>(side);
            glm::uvec3 both[2] = {{a, a + 1, falls ? d : d + 1}, {falls ? a + 1 : a, d + 1, d}};
            for (glm::uvec3& t : both) m.triangles.push_back(sinks ? glm::uvec3(t.x, t.z, t.y) : t);
        }
    return m;
}

in::mesh seabed_of(const in::seabed::any& recipe, int side, bool falls, bool sinks = false) {
    const auto field = in::seabed::sample(recipe, {{-1.5, -1.5}, 3.0 / (side - 1), side, side});
    std::size_t next = 0;
    return grid_of(
        side, falls, [&](double, double) { return static_cast<double>(field.heights.pixels()[next++]); }, sinks);
}

constexpr struct { bool falls, sinks; } every_order[] = {{false, false}, {true, false}, {true, true}};

/// @param box  of what is asked about
template <class E = in::serial_executor>
shadow::horizon horizon_of(const in::mesh& m, const shadow::light_frame& light, double texel, const in::affine& place,
                           const in::bounding_box& box, int largest = 8192, E&& ex = {},
                           in::isa level = in::best_isa()) {
    const auto grid = in::regular_grid_of(m);
    REQUIRE(grid);
    return {light, m, in::bounds(m), *grid, place, box, texel, largest, ex, level};
}
shadow::horizon horizon_of(const in::mesh& m, const shadow::light_frame& light, double texel) {
    return horizon_of(m, light, texel, {}, in::bounds(m));
}

}  // namespace

TEST_CASE("A ridge's shadow on level ground ends at height / tan(elevation), from all around") {
    for (const auto& [falls, sinks] : every_order)
        for (const double elevation : {2.0, 6.0, 20.0, 45.0})
            for (double azimuth = 15; azimuth < 360; azimuth += 30) {
                CAPTURE(falls, sinks, elevation, azimuth);
                const shadow::light_frame light({radians(azimuth), radians(elevation)});
                // One row of vertices stands up, across the axis that the light follows more.
                const double height = 0.5 * std::tan(radians(elevation));
                const bool along_x = std::abs(light.travel().x) > std::abs(light.travel().y);
                const in::mesh m = grid_of(
                    61, falls, [&](double x, double y) { return std::abs(along_x ? x : y) < 0.01 ? height : 0.0; },
                    sinks);
                const shadow::horizon h = horizon_of(m, light, 0.04);
                const glm::dvec2 tip = 0.5 * light.travel();
                const auto point = [&](double beyond) {
                    return glm::vec3(glm::dvec3(tip + beyond * light.travel(), 0));
                };
                CHECK(ask(h, {point(-0.001), point(0.001)}) == std::vector<bool>{true, false});
            }
}

TEST_CASE("Points of a seabed are dark where a ray meets it, but for a few at the edges of shadows") {
    struct bottom_kind {
        in::seabed::any recipe;
        int most_wrong;  ///< of a thousand
    };
    const bottom_kind kinds[] = {{in::seabed::ripples{.wavelength = 0.6f, .steepness = 0.1f}, 8},
                                 {in::seabed::mud{}, 10},
                                 {in::seabed::rock{}, 10}};
    in::random_sequence random(11);
    double azimuth = 10;
    for (const auto& [recipe, most_wrong] : kinds)
        for (const auto& [falls, sinks] : every_order) {
            const in::mesh bottom = seabed_of(recipe, 65, falls, sinks);
            for (const double elevation : {1.0, 6.0, 20.0, 45.0}) {
                azimuth += 49;  // all octants come by
                const shadow::light_frame light({radians(azimuth), radians(elevation)});
                const auto asked = points::facing(bottom, light.to_light(), 1000, random);
                CAPTURE(recipe.index(), falls, sinks, azimuth, elevation);
                CHECK(points::wrong(horizon_of(bottom, light, 3.0 / 128), asked, bottom, light.to_light()) <=
                      most_wrong);
            }
        }
}

TEST_CASE("The closer the lines, the fewer points are wrong") {
    const in::mesh bottom = seabed_of(in::seabed::rock{}, 65, false);
    in::random_sequence random(5);
    for (const double azimuth : {30.0, 120.0}) {
        const shadow::light_frame light({radians(azimuth), radians(6)});
        const auto asked = points::facing(bottom, light.to_light(), 3000, random);
        const auto wrong = [&](double texel) {
            return points::wrong(horizon_of(bottom, light, texel), asked, bottom, light.to_light());
        };
        const int coarse = wrong(0.1), fine = wrong(0.003);
        CHECK(coarse <= 200);
        CHECK(fine <= 4);
        CHECK(4 * fine < coarse);
    }
}

TEST_CASE("A turned, scaled and tilted grid casts as the same mesh does where it is put") {
    const in::mesh bottom = seabed_of(in::seabed::rock{}, 49, true);
    const in::affine place =
        in::to_world({.position = {4000, -2500, 3}, .yaw = 0.7f, .pitch = 0.2f, .roll = -0.15f, .scale = 1.7f});
    const glm::dvec3 away(4000, -2500, 0);  // asked about near the origin, as pictures do
    const in::affine near_by{place.linear, place.offset - away};
    const in::mesh placed = in::transformed(bottom, near_by);
    in::random_sequence random(3);
    for (const double azimuth : {20.0, 110.0, 200.0, 290.0}) {
        const shadow::light_frame light({radians(azimuth), radians(25)});
        const auto asked = points::facing(placed, light.to_light(), 1000, random);
        CAPTURE(azimuth);
        const shadow::horizon h = horizon_of(bottom, light, 0.02, near_by, in::bounds(placed));
        CHECK(points::wrong(h, asked, placed, light.to_light()) <= 6);
    }
}

TEST_CASE("Level ground and light from straight above leave everything lit") {
    in::random_sequence random(1);
    const in::mesh level = grid_of(33, false, [](double, double) { return 0.25; });
    for (const double elevation : {0.1, 6.0, 45.0, 89.9, 90.0})
        for (double azimuth = 0; azimuth < 360; azimuth += 22.5) {
            const shadow::light_frame light({radians(azimuth), radians(elevation)});
            const auto asked = points::facing(level, light.to_light(), 200, random);
            CAPTURE(elevation, azimuth);
            CHECK(ask(horizon_of(level, light, 0.05), asked) == std::vector<bool>(200, false));
        }
    const in::mesh rubble = seabed_of(in::seabed::rock{}, 33, false);
    const shadow::light_frame above({0.3, radians(90)});
    CHECK(ask(horizon_of(rubble, above, 0.05), rubble.positions) == std::vector<bool>(33 * 33, false));
}

TEST_CASE("What is asked about lies anywhere: before the grid, behind it, beside it, above it, or nowhere") {
    const in::mesh wall = grid_of(31, false, [](double x, double) { return x > 1.25 && x < 1.35 ? 0.2 : 0.0; });
    const shadow::light_frame light({0, radians(45)});
    const float infinity = std::numeric_limits<float>::infinity(), nan = std::nanf("");
    in::bounding_box box = in::bounds(wall);
    box = in::merge(box, {{-9, -9, -1}, {9, 9, 1}});
    const shadow::horizon h = horizon_of(wall, light, 0.02, {}, box);
    CHECK(ask(h, {{1.4f, 0, 0.05f},  // behind the wall
                  {1.4f, 0, 0.15f},  // over its shadow
                  {2, 0, -0.6f},     // behind the grid, in the wall's shadow
                  {2, 0, -0.4f},     // and over it
                  {1, 0, 0},         // before the wall
                  {-2, 0, 0},        // before the grid
                  {1.4f, 2, 0.05f},  // beside it
                  {1e30f, 0, 0},     // anywhere else
                  {0, -1e30f, 0},
                  {infinity, 0, 0},
                  {0, nan, 0},
                  {0, 0, nan}}) ==
          std::vector<bool>{true, false, true, false, false, false, false, false, false, false, false, false});
    CHECK(ask(shadow::horizon(), {{0, 0, 0}}) == std::vector<bool>{false});
}

TEST_CASE("A grid ends like a cliff: what lies behind its last edge, and deeper, is dark") {
    for (const bool falls : {false, true})
        for (double azimuth = 10; azimuth < 360; azimuth += 40) {
            CAPTURE(falls, azimuth);
            // Ground that rises along the light all the way to the end.
            const shadow::light_frame light({radians(azimuth), radians(20)});
            const glm::dvec2& travel = light.travel();
            const in::mesh rising =
                grid_of(31, falls, [&](double x, double y) { return 0.2 * (x * travel.x + y * travel.y); });
            const in::bounding_box box = in::merge(in::bounds(rising), {{-9, -9, -2}, {9, 9, 2}});
            const shadow::horizon h = horizon_of(rising, light, 0.02, {}, box);
            // Where the light leaves the grid above its middle.
            const double half = 1.5 / (std::max)(std::abs(travel.x), std::abs(travel.y)), beyond = half + 0.4;
            const double ray = 0.2 * half - 0.4 * std::tan(radians(20));
            const auto point = [&](double z) { return glm::vec3(glm::dvec3(beyond * travel, z)); };
            CHECK(ask(h, {point(ray - 0.01), point(ray + 0.01)}) == std::vector<bool>{true, false});
        }
}

TEST_CASE("A shadow goes on beside the grid, however long ago the light left it") {
    const glm::dvec2 crest(-1.3, 1.2);
    const shadow::light_frame light({radians(40), radians(5)});
    for (const bool falls : {false, true}) {
        const in::mesh wall =
            grid_of(61, falls, [&](double, double y) { return std::abs(y - crest.y) < 0.01 ? 0.2 : 0.0; });
        const in::bounding_box box = in::merge(in::bounds(wall), {{-9, -9, -1}, {9, 9, 1}});
        const shadow::horizon h = horizon_of(wall, light, 0.02, {}, box);
        for (const double way : {0.6, 1.0, 1.5, 2.0}) {
            CAPTURE(falls, way);
            const double ray = 0.2 - way * std::tan(radians(5));
            const auto point = [&](double z) { return glm::vec3(glm::dvec3(crest + way * light.travel(), z)); };
            CHECK(ask(h, {point(ray - 0.005), point(ray + 0.005)}) == std::vector<bool>{true, false});
        }
    }
}

TEST_CASE("The end of a grid is off by half of what lines lie apart at most") {
    const shadow::light_frame light({0, radians(45)});
    const in::mesh wall = grid_of(31, false, [](double x, double) { return x > -0.05 && x < 0.05 ? 0.5 : 0.0; });
    const in::bounding_box box = in::merge(in::bounds(wall), {{-9, -9, -1}, {9, 9, 1}});
    for (const double texel : {0.2, 0.23, 0.26, 0.29, 0.32, 0.35}) {
        CAPTURE(texel);
        const shadow::horizon h = horizon_of(wall, light, texel, {}, box);
        const double half = texel / 1.5 / 2 + 0.001;
        for (const double end : {-1.5, 1.5}) {
            const double out = end < 0 ? -1 : 1;
            const auto point = [&](double beyond) { return glm::vec3(glm::dvec3(0.2, end + out * beyond, 0.1)); };
            CHECK(ask(h, {point(-half), point(half)}) == std::vector<bool>{true, false});
        }
    }
}

TEST_CASE("A part of a grid is asked about as the whole is") {
    const in::mesh bottom = seabed_of(in::seabed::rock{}, 97, false);
    for (const double azimuth : {50.0, 140.0, 230.0, 320.0}) {
        const shadow::light_frame light({radians(azimuth), radians(6)});
        const in::bounding_box part{{0.2, -0.9, -1}, {0.9, -0.1, 1}};
        in::random_sequence random(9);
        std::vector<glm::vec3> asked;
        for (const glm::vec3& p : points::facing(bottom, light.to_light(), 8000, random))
            if (p.x > 0.2f && p.x < 0.9f && p.y > -0.9f && p.y < -0.1f) asked.push_back(p);
        REQUIRE(asked.size() > 200);
        CHECK(points::wrong(horizon_of(bottom, light, 0.01, {}, part), asked, bottom, light.to_light()) <=
              static_cast<int>(asked.size() / 100));
    }
}

TEST_CASE("Fewer lines than asked for lie farther apart, and still say roughly who is dark") {
    const in::mesh bottom = seabed_of(in::seabed::ripples{.wavelength = 0.6f, .steepness = 0.1f}, 65, false);
    const shadow::light_frame light({radians(20), radians(6)});
    in::random_sequence random(2);
    const auto asked = points::facing(bottom, light.to_light(), 1000, random);
    const shadow::horizon h = horizon_of(bottom, light, 1e-6, {}, in::bounds(bottom), 64);
    CHECK(points::wrong(h, asked, bottom, light.to_light()) <= 20);
    ask(horizon_of(bottom, light, 0.01, {}, in::bounds(bottom), 1), asked);  // one line at most: anything but a crash
}

TEST_CASE("Asked about less, a horizon answers the same: what it leaves out can't block") {
    const shadow::light_frame light({radians(GENERATE(10, 100, 215, 301)), radians(14)});
    const in::mesh bottom =
        seabed_of(in::seabed::rock{.relief = 0.1f, .outcrop = 0.8f, .block = 0.3f}, 129, GENERATE(false, true));
    const in::bounding_box all = in::bounds(bottom);
    const in::bounding_box part{{-0.3, -0.2, all.lower.z}, {0.2, 0.3, all.upper.z}};
    std::vector<glm::vec3> asked;
    for (const glm::vec3& p : bottom.positions)
        if (p.x > -0.3f && p.x < 0.2f && p.y > -0.2f && p.y < 0.3f) asked.push_back(p + glm::vec3(0, 0, 1e-4f));
    // Lines don't fall on the same places, so a few at the edges of shadows differ.
    const std::vector<bool> of_all = ask(horizon_of(bottom, light, 0.002, {}, all), asked),
                            of_part = ask(horizon_of(bottom, light, 0.002, {}, part), asked);
    std::size_t differ = 0;
    for (std::size_t i = 0; i < asked.size(); ++i) differ += of_all[i] != of_part[i];
    CHECK(std::count(of_all.begin(), of_all.end(), true) > static_cast<std::ptrdiff_t>(asked.size() / 10));
    CHECK(differ <= asked.size() / 100);
}

TEST_CASE("A horizon is the same at every instruction set and for any executor") {
    const shadow::light_frame light({0.4, radians(6)});
    in::thread_pool pool(3);
    for (const bool falls : {false, true}) {
        const in::mesh bottom = seabed_of(in::seabed::rock{}, 65, falls);
        std::vector<glm::vec3> asked = bottom.positions;
        for (int i = 1; i < 8; ++i)  // many, to meet the edges of shadows
            for (int k = 0; k < 65 * 65; ++k)
                asked.push_back(bottom.positions[static_cast<std::size_t>(k)] + 0.003f * static_cast<float>(i));
        for (glm::vec3& p : asked) p += glm::vec3(0.011f, 0.007f, 0.003f);
        const auto swept = [&](in::isa level, auto& ex) {
            return horizon_of(bottom, light, 0.013, {}, in::bounds(bottom), 8192, ex, level);
        };
        in::serial_executor serial;
        const std::vector<bool> expected = ask(swept(in::isa::scalar, serial), asked, in::isa::scalar);
        CHECK(std::count(expected.begin(), expected.end(), true) > 100);
        for (const in::isa level : {in::isa::scalar, in::isa::baseline, in::isa::avx2}) {
            CHECK((ask(swept(in::isa::avx2, serial), asked, level) == expected));
            CHECK((ask(swept(level, pool), asked) == expected));
        }
    }
}

TEST_CASE("A solid grid is swept and anything else mapped, which hardly shows") {
    const in::mesh bottom = seabed_of(in::seabed::mud{}, 65, false);
    in::mesh mirrored = bottom;
    for (glm::vec3& p : mirrored.positions) p.x = -p.x;
    const in::affine mirror{{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};
    const shadow::light_frame light({radians(70), radians(3)});
    in::random_sequence random(4);
    in::serial_executor ex;
    const auto asked = points::facing(bottom, light.to_light(), 1000, random);
    const auto caster = [&](const in::mesh& m, const in::affine& place, bool is_solid) {
        return shadow::refined_caster(light, m, in::bounds(m), place, is_solid, in::bounds(bottom), 0.02, 8192, ex);
    };
    for (const auto& c : {caster(bottom, {}, true), caster(mirrored, mirror, true)})
        CHECK(points::wrong(c, asked, bottom, light.to_light()) <= 20);
    // An open sheet also darkens what is below it.
    const glm::vec3 below(0, 0, in::bounds(bottom).lower.z - 0.01);
    CHECK(ask(caster(bottom, {}, false), {below}) == std::vector<bool>{true});
}
