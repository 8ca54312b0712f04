// Shadow tests of points without a picture, against closed forms and the picture of the same scene.
#include <insonify/core/random.hpp>
#include <insonify/core/thread_pool.hpp>
#include <insonify/geometry/cube.hpp>
#include <insonify/geometry/sphere.hpp>
#include <insonify/shadow/map.hpp>
#include <insonify/shadow/penumbra.hpp>
#include <insonify/sonar/occlusion.hpp>
#include <insonify/sonar/overhead/render.hpp>

#include <cmath>

#include "../../catch.hpp"

namespace in = insonify;
using namespace in::literals;

namespace {

/// Two cubes in a row under light from the left, somewhere in the world.
in::scene two_cubes(const glm::dvec3& offset) {
    in::scene s;
    s.seabed = in::seabed::none{};
    s.add(in::cube{}, {.position = offset + glm::dvec3(0, 0, 0.5)}, "cube");
    s.add(in::cube{}, {.position = offset + glm::dvec3(1.5, 0, 0.5)}, "cube");
    return s;
}

/// A level field with one wall across x, 1 m high, over 0.1 m.
in::seabed::heightfield wall() {
    in::seabed::heightfield field{.heights = in::image<float>(401, 41), .origin = {-20, -2}, .spacing = 0.1};
    for (int j = 0; j < 41; ++j) field.heights(100, j) = 1;  // at x = -10
    return field;
}

/// Exact shadows of translucent casters.
struct glass {
    float through;

    template <class Exact>
    struct occlusion {
        Exact opaque;
        float through;

        void test(const in::shadow::points& at, const in::shadow::results& into) const {
            opaque.test(at, into);
            for (std::size_t i = 0; i < into.lit.size(); ++i) into.lit[i] = (std::max)(into.lit[i], through);
        }
    };
    template <in::executor E>
    auto build(std::span<const in::shadow::caster> casters, const in::shadow::any_light& light,
               const in::shadow::point_bounds& within, E& ex) const {
        const auto opaque = in::shadow::exact{}.build(casters, light, within, ex);
        return occlusion<std::remove_const_t<decltype(opaque)>>{opaque, through};
    }
};

}  // namespace

TEST_CASE("A point behind a cube is in that cube's shadow, to a micrometre, anywhere in the world") {
    for (const glm::dvec3& offset : {glm::dvec3(0), glm::dvec3(1e5, -3e5, 0)}) {
        const in::scene s = two_cubes(offset);
        const in::occlusion_bounds within{{offset + glm::dvec3(-9, -9, -1), offset + glm::dvec3(9, 9, 3)}};
        const auto shade = in::occlusion_of(s, in::shadow::directional_light{0, 0.25 * in::numeric::pi}, within);
        const std::vector<glm::dvec3> points{offset + glm::dvec3(-0.6, 0, 0),     offset + glm::dvec3(0.6, 0, 0.89),
                                             offset + glm::dvec3(0.6, 0, 0.91),   offset + glm::dvec3(3 - 1e-6, 0, 0),
                                             offset + glm::dvec3(3 + 1e-6, 0, 0), offset + glm::dvec3(2.2, 0, 0)};
        const auto found = shade.test(points);
        CHECK(found.lit == std::vector<float>{1, 0, 1, 0, 1, 0});
        CHECK(found.shadow == std::vector<std::uint16_t>{0, 1, 0, 2, 0, 2});
    }
}

TEST_CASE("A point light casts shadows; an occlusion test outlives its scene") {
    const auto shade = [] {
        return in::occlusion_of(two_cubes({0, 0, 0}), in::shadow::point_light{{-2, 0, 2}}, {{{-5, -5, -1}, {5, 5, 3}}});
    }();
    // Over the first cube's far upper edge (0.5, 0, 1) the ray falls 0.4 for each metre.
    const double edge = 1 - 0.4 * 0.4;
    const std::vector<glm::dvec3> points{{0.9, 0, edge - 1e-6}, {0.9, 0, edge + 1e-6}, {-1, 0, 0}, {2.2, 0, 0}};
    const auto found = shade.test(points);
    CHECK(found.lit == std::vector<float>{0, 1, 1, 0});
    CHECK(found.shadow == std::vector<std::uint16_t>{1, 0, 0, 1});
}

TEST_CASE("A wall of seabed outside of the bounds shades points within height / tan(elevation)") {
    in::scene s;
    s.seabed = wall();
    const double elevation = std::atan(0.1);
    for (const double tip : {-0.5, 0.5}) {
        const in::occlusion_bounds within{{{-1, -1, -0.2}, {1, 1, 0.5}}, 0.1};
        const auto shade = in::occlusion_of(s, in::shadow::directional_light{0, elevation}, within);
        const std::vector<glm::dvec3> points{{tip, 0.3, 1e-3}};
        const auto found = shade.test(points);
        CAPTURE(tip);
        CHECK(found.shadow[0] == (tip < 0 ? in::labels::by_seabed : in::labels::no_shadow));
    }
    // Without a reach beyond the bounds the wall casts no shadow.
    const auto blind =
        in::occlusion_of(s, in::shadow::directional_light{0, elevation}, {{{-1, -1, -0.2}, {1, 1, 0.5}}, 0.1, 0});
    CHECK(blind.test(std::vector<glm::dvec3>{{-0.5, 0.3, 1e-3}}).lit[0] == 1);
}

TEST_CASE("Bounds around one point have the seabed that may shade it, anywhere in the world") {
    const in::shadow::directional_light light{0, 0.12};
    for (const double x : {0.0, 1e6}) {
        in::scene s;
        s.seabed = in::seabed::ripples{.wavelength = 4, .steepness = 0.2f};
        const auto among = in::occlusion_of(s, light, {{{x - 2, -1, -0.5}, {x + 2, 1, 1}}, 0.01});
        int dark = 0, differing = 0;
        for (int i = 0; i < 60; ++i) {
            const std::vector<glm::dvec3> point{{x - 2 + 0.066 * i, 0.3, 0.05}};
            const float lit = in::occlusion_of(s, light, {{point[0], point[0]}}).test(point).lit[0];
            dark += lit == 0;
            differing += lit != among.test(point).lit[0];
        }
        CAPTURE(x);
        CHECK(dark > 0);
        CHECK(dark < 60);
        CHECK(differing <= 1);  // by the seabed's cells
    }
}

TEST_CASE("A wall of seabed outside of the bounds shades points of a point light, by similar triangles") {
    in::scene s;
    s.seabed = wall();
    const auto label = [&](double height, double x) {
        const auto shade =
            in::occlusion_of(s, in::shadow::point_light{{-12, 0.3, height}}, {{{-1, -1, 0}, {1, 1, 0.5}}, 0.1});
        return shade.test(std::vector<glm::dvec3>{{x, 0.3, 1e-3}}).shadow[0];
    };
    // 2 m before the wall of 1 m, a light at 1.2 m casts a shadow that ends 10 m behind it, one at 0.9 m one without
    // end.
    CHECK(label(1.2, -0.5) == in::labels::by_seabed);
    CHECK(label(1.2, 0.5) == in::labels::no_shadow);
    CHECK(label(0.9, 0.5) == in::labels::by_seabed);
}

TEST_CASE("A wide light is partly shaded by seabed beyond the reach of its centre's rays") {
    in::scene s;
    s.seabed = wall();
    // 16 m behind the wall, rays below atan(1 / 16) meet it. The centre of the disc is above that; or below, and its
    // lowest part below the horizon.
    for (const double elevation : {std::atan(0.1), 0.02}) {
        const auto shade =
            in::occlusion_of(s, in::shadow::directional_light{0, elevation}, {{{5.8, -1, 0}, {7, 1, 0.5}}, 0.1, 20},
                             in::shadow::penumbra{.diameter = 0.1f, .samples = 400});
        const double depth = (elevation - std::atan(1.0 / 16)) / 0.05;
        const double segment = (std::acos(depth) - depth * std::sqrt(1 - depth * depth)) / in::numeric::pi;
        CAPTURE(elevation);
        CHECK(static_cast<double>(shade.test(std::vector<glm::dvec3>{{6, 0.3, 0}}).lit[0]) ==
              Approx(1 - segment).margin(0.01));
    }
}

TEST_CASE("A wide light is partly shaded by seabed beside the bounds") {
    in::seabed::heightfield block = wall();
    for (int j = 0; j < 41; ++j) block.heights(100, j) = j < 33 ? 0.0f : 4.0f;  // from y = 1.2 to 1.3 on
    in::scene s;
    s.seabed = block;
    const auto shade =
        in::occlusion_of(s, in::shadow::directional_light{0, std::atan(0.1)}, {{{-3, -1, 0}, {-1, 1, 0.5}}, 0.1, 20},
                         in::shadow::penumbra{.diameter = 0.1f, .samples = 400});
    // 8 m behind the block, whose edge is at 1.22 m at the height of the rays.
    const double depth = (1.22 - 0.95) / 8 / 0.05;
    const double segment = (std::acos(depth) - depth * std::sqrt(1 - depth * depth)) / in::numeric::pi;
    CHECK(static_cast<double>(shade.test(std::vector<glm::dvec3>{{-2, 0.95, 0}}).lit[0]) ==
          Approx(1 - segment).margin(0.02));
}

TEST_CASE("Points of a level bottom are lit as its picture's pixels are, under a rig that is moved and turned") {
    for (const float distance : {std::numeric_limits<float>::infinity(), 7.0f}) {
        in::overhead rig{.position = {300, -200},
                         .altitude = 4,
                         .yaw = 0.6f,
                         .field_of_view = 90_deg,
                         .size = {100, 100},
                         .grazing = 20_deg,
                         .light_azimuth = 0.3f};
        rig.light_distance = distance;
        in::scene s = two_cubes({300.5, -199.6, 0});
        s.add(in::sphere{.radius = 0.4f}, {.position = {299, -201, 0.4}}, "ball");
        s.seabed = in::seabed::flat{.surface = {.rms = 0}};
        in::render_options<> options;
        options.subpixel_bits = 16;
        const auto picture = in::render(s, rig, options);
        const in::overhead_geometry view(rig);
        std::vector<glm::dvec3> points;
        std::vector<std::uint16_t> expected;
        for (int y = 0; y < 100; ++y)
            for (int x = 0; x < 100; ++x) {
                if (picture.labels.instance(x, y) != in::labels::no_instance) continue;
                const glm::dvec3 down = view.eye() + 4.0 * view.ray(x, y);
                const double yaw = static_cast<double>(0.6f), cosine = std::cos(yaw), sine = std::sin(yaw);
                points.push_back({300 + down.x * cosine - down.y * sine, -200 + down.x * sine + down.y * cosine, 0});
                expected.push_back(picture.labels.shadow(x, y));
            }
        const auto shade = in::occlusion_of(s, in::light_of(rig), {{{290, -210, -0.5}, {310, -190, 0.5}}, 0.2});
        in::thread_pool pool(3);
        const auto found = shade.test(points, pool);
        CHECK(found.shadow == expected);
        CHECK(found.lit == shade.test(points).lit);
        CHECK(std::count(expected.begin(), expected.end(), 1) > 20);
    }
}

TEST_CASE("A point has a shadow's label where less than half of the light arrives, as pixels do") {
    for (const float through : {0.0f, 0.49f, 0.5f, 0.8f}) {
        const auto shade =
            in::occlusion_of(two_cubes({0, 0, 0}), in::shadow::directional_light{0, 0.25 * in::numeric::pi},
                             {{{-9, -9, -1}, {9, 9, 3}}}, glass{through});
        const auto found = shade.test(std::vector<glm::dvec3>{{-0.6, 0, 0}, {2.2, 0, 0}});
        CHECK(found.lit == std::vector<float>{1, through});
        CHECK(found.shadow[0] == in::labels::no_shadow);
        CHECK(found.shadow[1] == (through < 0.5f ? 2 : in::labels::no_shadow));
    }
}

TEST_CASE("Any shadow policy can test points; bounds out of range are refused") {
    const in::scene s = two_cubes({0, 0, 0});
    const in::shadow::directional_light light{0, 0.25 * in::numeric::pi};
    const in::occlusion_bounds within{{{-9, -9, -1}, {9, 9, 3}}};
    const std::vector<glm::dvec3> points{{-0.6, 0, 0}, {2.2, 0, 0}, {2.9, 0, 0}, {3.1, 0, 0}, {3, 0, 0}};
    const auto hard = in::occlusion_of(s, light, within, in::shadow::map{}).test(points);
    CHECK((hard.lit[0] == 1 && hard.lit[1] == 0 && hard.lit[2] == 0 && hard.lit[3] == 1));
    CHECK(hard.shadow[2] == 2);
    const auto soft = in::occlusion_of(s, light, within, in::shadow::penumbra{.diameter = 0.05f}).test(points);
    CHECK((soft.lit[0] == 1 && soft.lit[1] == 0 && soft.lit[3] == 1));
    CHECK((soft.lit[4] > 0.3f && soft.lit[4] < 0.7f));
    CHECK_THROWS_WITH(in::occlusion_of(s, light, {}), ContainsSubstring("occlusion_bounds.box.size()"));
    const double no_number = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(in::occlusion_of(s, light, {{{-9, no_number, -1}, {9, 9, 3}}}),
                      ContainsSubstring("occlusion_bounds.box.lower.y is nan"));
    CHECK_THROWS_WITH(in::occlusion_of(s, light, {{{-9, -9, -1}, {1e10, 9, 3}}}),
                      ContainsSubstring("occlusion_bounds.box.upper.x is 1e+10"));
    in::scene on_sand = s;
    on_sand.seabed = in::seabed::flat{};
    CHECK_THROWS_WITH(in::occlusion_of(on_sand, light, {{{-9, -9, -1}, {9, 9, 3}}, 1e-5}),
                      ContainsSubstring("enlarge `occlusion_bounds.cell`"));
    CHECK_THROWS_WITH(in::occlusion_of(s, in::shadow::point_light{{0, 0, 5}}, within, in::shadow::pcf{}),
                      ContainsSubstring("overhead.light_distance) is 5"));
    in::scene crowded;
    crowded.targets.assign(65535, s.targets[0]);
    CHECK_THROWS_WITH(in::occlusion_of(crowded, light, within), ContainsSubstring("scene.targets.size() is 65535"));
}
