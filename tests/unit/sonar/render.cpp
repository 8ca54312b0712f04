// Overhead pictures against closed forms: positions, lengths of shadows, labels.
#include <insonify/core/thread_pool.hpp>
#include <insonify/geometry/cone.hpp>
#include <insonify/geometry/cube.hpp>
#include <insonify/geometry/cylinder.hpp>
#include <insonify/geometry/sphere.hpp>
#include <insonify/shadow/map.hpp>
#include <insonify/sonar/overhead/render.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "../../catch.hpp"
#include "../../larger.hpp"

namespace in = insonify;
using namespace in::literals;

namespace {

const in::seabed::flat plane{.surface = {.rms = 0}};

in::scene cube_on_plane(double edge) {
    in::scene s;
    s.seabed = plane;
    s.add(in::cube{.size = glm::vec3(static_cast<float>(edge))}, {.position = {-1, 0, edge / 2}}, "cube");
    return s;
}

/// The first and the last column of a row for which a condition holds.
struct extent {
    int first = -1, last = -1;
};
template <class Fn>
extent where(int width, Fn&& holds) {
    extent e;
    for (int x = 0; x < width; ++x)
        if (holds(x)) {
            if (e.first < 0) e.first = x;
            e.last = x;
        }
    return e;
}

}  // namespace

TEST_CASE(
    "A pixel of level ground is the sum of its direct light, sky and ambient light, under point and parallel lights") {
    const float distance = GENERATE(5.0f, 1000.0f, std::numeric_limits<float>::infinity());
    const in::overhead rig{.altitude = 3,
                           .field_of_view = 90_deg,
                           .size = {203, 121},
                           .grazing = 40_deg,
                           .light_azimuth = 30_deg,
                           .light_distance = distance,
                           .intensity = 0.9f,
                           .sky = 0.1f,
                           .ambient = 0.07f};
    in::scene s;
    s.seabed = plane;
    const in::image<float> picture = in::render(s, rig, in::render_options<in::shadow::none>{}).image;
    const double metres = 2 * 3.0 / 203, grazing = static_cast<double>(rig.grazing);
    const double azimuth = static_cast<double>(rig.light_azimuth), cosine = std::cos(grazing);
    const glm::dvec3 to_light(-cosine * std::cos(azimuth), -cosine * std::sin(azimuth), std::sin(grazing));
    double largest = 0;
    for (int y = 0; y < 121; ++y)
        for (int x = 0; x < 203; ++x) {
            const glm::dvec3 ground((x + 0.5 - 203 / 2.0) * metres, (121 / 2.0 - y - 0.5) * metres, 0);
            const double sine =
                std::isinf(distance) ? to_light.z : glm::normalize(static_cast<double>(distance) * to_light - ground).z;
            const double expected = 0.45 * (0.9 * sine + 0.1 + 0.07);
            largest = larger(largest, std::abs(static_cast<double>(picture(x, y)) - expected));
        }
    CHECK(largest < 1e-6);
}

TEST_CASE("A cube's shadow is as long as its height over the tangent of the grazing angle, within a pixel") {
    for (const float degrees : {4.0f, 6.0f, 12.0f, 30.0f, 60.0f}) {
        const double edge = 0.2;
        const in::overhead rig{.altitude = 3, .field_of_view = 90_deg, .size = {600, 600}, .grazing = degrees * 1_deg};
        const in::overhead_geometry view(rig);
        const auto picture = in::render(cube_on_plane(edge), rig);
        // The row below the cube's middle; the shadow's tip is that of the cube's far top edge.
        const auto shadow = where(600, [&](int x) { return picture.labels.shadow(x, 305) == 1; });
        const double tip = -1 + edge / 2 + edge / std::tan(static_cast<double>(rig.grazing));
        INFO("grazing " << degrees);
        CHECK(std::abs(shadow.last + 1 - view.pixel({tip, 0, 0}).x) <= 1);
        // It begins at the foot of the cube, which the camera at the origin sees: no gap.
        const double foot = view.pixel({-1 + edge / 2, 0, 0}).x;
        CHECK(shadow.first <= foot + 1);
    }
}

TEST_CASE("A raised point appears away from the nadir, as a pinhole sees it") {
    // research table: A = 3, x = 10, h = 0.3 -> 11.111.
    const in::overhead_geometry view({.altitude = 3, .field_of_view = 150_deg, .size = {2000, 100}});
    CHECK(view.pixel({10, 0, 0.3}).x == Approx(view.pixel({11.1111, 0, 0}).x).margin(0.01));
    CHECK(view.pixel({0, 0, 0}).x == Approx(1000));
    CHECK(view.pixel({0, 0, 0}).y == Approx(50));
    // 120 degrees: a pixel of 2048 is 1.6914e-3 of the altitude.
    CHECK(in::overhead_geometry({.altitude = 10}).ground_sampling() == Approx(1.6914e-2).epsilon(1e-4));
}

TEST_CASE("Level ground has one brightness: reflectivity x (intensity x sin(grazing) + sky)") {
    in::scene s;
    s.seabed = plane;
    for (const float degrees : {0.5f, 6.0f, 45.0f, 90.0f}) {
        const in::overhead rig{.size = {64, 48}, .grazing = degrees * 1_deg, .intensity = 0.8f, .sky = 0.1f};
        const double sine = std::sin(static_cast<double>(rig.grazing));
        const auto lambert = in::render(s, rig);
        for (const float v : lambert.image.pixels()) CHECK(v == Approx(0.45 * (0.8 * sine + 0.1)).epsilon(1e-5));
        const auto squared =
            in::render(s, rig, in::render_options<in::shadow::pcf, in::labels, in::lambert_backscatter>{});
        CHECK(squared.image(30, 20) == Approx(0.45 * (0.8 * sine * sine + 0.1)).epsilon(1e-5));
        for (const std::uint16_t v : lambert.labels.shadow.pixels()) CHECK(v == in::labels::no_shadow);
    }
}

TEST_CASE("A pixel of a large facet shows the normal at the point that its ray hits") {
    // From 0.5 to 4 m before the camera: halfway across the picture is not halfway across the facet.
    const glm::dvec3 corner[3] = {{-3, -3, 0}, {3, -2.5, 0}, {0, 0.4, 3.5}};
    const glm::dvec3 normal[3] = {{0, 0, 1}, {0.6, 0, 0.8}, {0, 0.6, 0.8}};
    in::mesh facet;
    for (int i = 0; i < 3; ++i) {
        facet.positions.emplace_back(corner[i]);
        facet.normals.emplace_back(normal[i]);
    }
    facet.triangles.emplace_back(0, 1, 2);
    in::scene s;
    s.seabed = in::seabed::none{};
    s.add(facet, {}, "facet", {.reflectivity = 1});
    const in::overhead rig{.altitude = 4,
                           .field_of_view = 90_deg,
                           .size = {200, 200},
                           .grazing = 90_deg,
                           .intensity = 1,
                           .sky = 0,
                           .ambient = 0};
    const in::overhead_geometry view(rig);
    const auto picture = in::render(s, rig, in::render_options<in::shadow::none>{});
    const glm::dmat3 to_weights =
        glm::inverse(glm::dmat3(corner[0] - view.eye(), corner[1] - view.eye(), corner[2] - view.eye()));
    int shown = 0;
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 200; ++x) {
            if (picture.labels.instance(x, y) == in::labels::no_instance) continue;
            glm::dvec3 weights = to_weights * view.ray(x, y);
            weights /= weights.x + weights.y + weights.z;
            const glm::dvec3 there = weights.x * normal[0] + weights.y * normal[1] + weights.z * normal[2];
            CHECK(picture.image(x, y) == Approx(there.z / glm::length(there)).margin(1e-5));
            ++shown;
        }
    CHECK(shown > 2000);
}

/// Lambert's law; records the largest sine that it is evaluated for.
struct watched_law {
    float* largest;
    float operator()(float s) const {
        *largest = (std::max)(*largest, s);
        return s;
    }
};

TEST_CASE("Backscatter laws are evaluated for sines of at most one, despite rounding") {
    float largest = 0;
    for (int i = 0; i < 50; ++i) {
        // A sheet across the light.
        const in::overhead rig{.altitude = 4,
                               .size = {16, 16},
                               .grazing = (30 + static_cast<float>(i)) * 1_deg,
                               .light_azimuth = static_cast<float>(7 * i) * 1_deg};
        const glm::dvec3 n = in::overhead_geometry(rig).light().to_light();
        const glm::dvec3 u = glm::normalize(glm::dvec3(-n.y, n.x, 0)), v = glm::cross(n, u);
        in::mesh sheet;
        for (const glm::dvec3& p : {-u - v, u - v, u + v, v - u}) {
            sheet.positions.emplace_back(p);
            sheet.normals.emplace_back(n);
        }
        sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
        in::scene s;
        s.seabed = in::seabed::none{};
        s.add(sheet, {}, "sheet");
        in::render(s, rig, in::render_options<in::shadow::none, in::no_labels, watched_law>{.law = {&largest}});
    }
    CHECK(largest == 1);
}

TEST_CASE("Labels state the target, the caster of the shadow and the seabed type of each pixel") {
    in::scene s;
    s.seabed = plane;
    s.add(in::sphere{.radius = 0.25f}, {.position = {-1, 0.6, 0.25}}, "sphere");
    s.add(in::cylinder{.radius = 0.2f, .length = 1}, {.position = {-1, -0.6, 0.2}, .yaw = 90_deg}, "cylinder");
    const auto picture = in::render(s, {.altitude = 3, .field_of_view = 90_deg, .size = {300, 300}, .grazing = 15_deg});
    const in::labels& l = picture.labels;
    REQUIRE(l.targets.size() == 2);
    for (const in::target_label& t : l.targets) {
        CHECK(t.area > 0);
        CHECK(t.shadow_area > 0);
        CHECK(t.shadow_box.x1 > t.box.x1);  // shadows go right
        std::int64_t area = 0, shadow_area = 0;
        const auto target = in::target_mask(l, t.instance), shadow = in::shadow_mask(l, t.instance);
        for (int y = 0; y < 300; ++y)
            for (int x = 0; x < 300; ++x) {
                const bool in_box = x >= t.box.x0 && x < t.box.x1 && y >= t.box.y0 && y < t.box.y1;
                area += target(x, y) == 255;
                shadow_area += shadow(x, y) == 255;
                if (target(x, y) == 255) CHECK(in_box);
                if (target(x, y) == 255) CHECK(l.seabed(x, y) == in::labels::no_seabed);
                if (shadow(x, y) == 255) CHECK(l.seabed(x, y) == static_cast<std::uint8_t>(in::seabed::type::sand));
            }
        CHECK(area == t.area);
        CHECK(shadow_area == t.shadow_area);
    }
    CHECK(l.targets[0].class_name == "sphere");
    CHECK(l.targets[0].box.y1 <= l.targets[1].box.y0);  // +y is up in the picture
    // A pinhole sees a sphere as an ellipse of area pi f^2 sin^2 a cos a / (cos^2 t - sin^2 a)^1.5, for the half angle
    // a of its cone and the angle t of its centre from the axis.
    const double square = 1 + 0.36 + 2.75 * 2.75, sine2 = 0.0625 / square, cosine2 = 2.75 * 2.75 / square;
    CHECK(l.targets[0].area ==
          Approx(in::numeric::pi * 150 * 150 * sine2 * std::sqrt(1 - sine2) / std::pow(cosine2 - sine2, 1.5))
              .epsilon(0.02));
}

TEMPLATE_TEST_CASE("Pixels are dark exactly where the labels state a shadow", "", in::shadow::map, in::shadow::exact) {
    in::scene s = cube_on_plane(0.3);
    s.add(in::sphere{.radius = 0.2f}, {.position = {0.8, 0.5, 0.2}}, "sphere");
    const in::overhead rig{.altitude = 3,
                           .field_of_view = 90_deg,
                           .size = {300, 300},
                           .grazing = 15_deg,
                           .intensity = 1,
                           .sky = 0,
                           .ambient = 0};
    const auto picture = in::render(s, rig, in::render_options<TestType>{});
    int dark[3] = {};
    for (int y = 0; y < 300; ++y)
        for (int x = 0; x < 300; ++x) {
            const std::uint16_t by = picture.labels.shadow(x, y);
            // A rounded target's normals turn away from the light before its facets do.
            if (by == in::labels::no_shadow && picture.labels.instance(x, y) != in::labels::no_instance) continue;
            CHECK((picture.image(x, y) > 0) == (by == in::labels::no_shadow));
            if (by == 1 || by == 2) ++dark[by];
        }
    CHECK(dark[1] > 500);
    CHECK(dark[2] > 500);
}

TEST_CASE("A pixel of the seabed has the type of the vertex with the largest weight") {
    using in::seabed::type;
    in::seabed::heightfield field{
        .heights = in::image<float>(9, 9), .types = in::image<type>(9, 9), .origin = {-8, -8}, .spacing = 2};
    for (int j = 0; j < 9; ++j)
        for (int i = 0; i < 9; ++i) field.types(i, j) = i <= 4 ? type::sand : type::rock;  // rock from x = 2 m on
    in::scene s;
    s.seabed = field;
    const in::overhead rig{.altitude = 4, .field_of_view = 90_deg, .size = {160, 160}};
    const auto picture = in::render(s, rig, in::render_options<in::shadow::none>{.cell = 2});
    const in::overhead_geometry view(rig);
    for (int y = 0; y < 160; ++y)
        for (int x = 0; x < 160; ++x) {
            const glm::dvec3 ray = view.ray(x, y), at = view.eye() - view.eye().z / ray.z * ray;
            const double u = at.x / 2, v = at.y / 2 - std::floor(at.y / 2);
            // The cells between 0 and 2 m are cut from (0, 0) to (1, 1); right of u = 0 corners are of rock.
            const double sand = v < u ? 1 - u : (std::max)(1 - v, v - u), rock = v < u ? (std::max)(u - v, v) : u;
            const bool expected = u >= 1 || (u > 0 && rock > sand);
            if (std::abs(rock - sand) < 1e-4 || std::abs(u - v) < 1e-4) continue;
            CAPTURE(x, y);
            CHECK(picture.labels.seabed(x, y) == static_cast<int>(expected ? type::rock : type::sand));
        }
}

TEST_CASE("Targets of one class share a number in the class map") {
    in::scene s;
    s.seabed = plane;
    for (const double y : {-1.0, 0.0, 1.0})
        s.add(in::cube{.size = glm::vec3(0.3f)}, {.position = {0, y, 0.15}}, y == 0 ? "rock" : "mine");
    const auto picture = in::render(s, {.altitude = 3, .field_of_view = 90_deg, .size = {120, 120}});
    const in::class_map map = in::classes_of(picture.labels);
    CHECK(map.names == std::vector<std::string>{"mine", "rock"});
    const std::uint16_t expected[] = {0, 1, 2, 1};
    for (std::size_t i = 0; i < map.classes.size(); ++i)
        REQUIRE(map.classes.pixels()[i] == expected[picture.labels.instance.pixels()[i]]);
}

TEST_CASE("The picture does not depend on the position in the world") {
    const auto at = [](glm::dvec2 offset) {
        in::scene s;
        s.seabed = plane;
        s.add(in::cone{.radius = 0.4f, .height = 0.8f}, {.position = glm::dvec3(offset, 0.4), .yaw = 20_deg}, "cone");
        return in::render(s, {.position = offset, .altitude = 4, .size = {160, 120}});
    };
    const auto here = at({0, 0});
    for (const glm::dvec2 offset : {glm::dvec2(1024, -4096), glm::dvec2(10000000, 5000000)}) {
        const auto there = at(offset);
        CHECK(there.image == here.image);
        CHECK(there.labels.shadow == here.labels.shadow);
    }
}

TEST_CASE("Camera, light and scene turned together give the same picture") {
    const auto turned = [](float yaw) {
        in::scene s;
        s.seabed = plane;
        const double c = std::cos(static_cast<double>(yaw)), d = std::sin(static_cast<double>(yaw));
        s.add(in::cube{}, {.position = {-c, -d, 0.5}, .yaw = yaw + 0.3f}, "cube");
        return in::render(s, {.altitude = 4, .yaw = yaw, .size = {200, 200}});
    };
    const auto a = turned(0), b = turned(1.1f);
    int different = 0;
    for (std::size_t i = 0; i < a.image.size(); ++i)
        different += a.image.pixels()[i] != Approx(b.image.pixels()[i]).margin(1e-4);
    CHECK(different < 300);  // pixels on edges, of 40000
}

TEST_CASE("render() gives the same bytes for any number of threads, tile size and instruction set", "[threads]") {
    in::scene s;
    s.seabed = in::seabed::rock{.relief = 0.2f};
    s.add(in::cylinder{.segments = 24}, {.position = {0, 0, 0.6}, .yaw = 40_deg}, "cylinder");
    const in::overhead rig{.altitude = 4, .yaw = 0.4f, .size = {230, 170}};
    const auto expected = in::render(s, rig, in::render_options<>{.level = in::isa::scalar});
    for (const int threads : {1, 2, 8}) {
        in::thread_pool pool(threads);
        for (const int tile : {16, 64}) {
            const auto picture = in::render(s, rig, in::render_options<>{.tile = tile}, pool);
            CHECK(picture.image == expected.image);
            CHECK(picture.labels.shadow == expected.labels.shadow);
            CHECK(picture.labels.instance == expected.labels.instance);
            CHECK(picture.labels.seabed == expected.labels.seabed);
        }
    }
}

TEST_CASE("The light at a picture's edge does not depend on how far the ground is sampled beyond it") {
    // Too gentle for shadows; `exact` samples the ground farther towards the light all the same.
    in::scene s;
    s.seabed = in::seabed::ripples{.wavelength = 0.8f, .steepness = 0.05f, .direction = 45_deg, .surface = {.rms = 0}};
    for (const float azimuth : {0_deg, 90_deg, 180_deg, 270_deg}) {
        const in::overhead rig{
            .altitude = 8, .field_of_view = 30_deg, .size = {96, 64}, .grazing = 20_deg, .light_azimuth = azimuth};
        const in::render_options<> options{.cell = 0.06, .subpixel_bits = 8};
        const auto shaded = in::render(s, rig, options);
        const auto bare = in::render(s, rig, options.with(in::shadow::none{}));
        REQUIRE(std::ranges::count(shaded.labels.shadow.pixels(), in::labels::no_shadow) == 96 * 64);
        CHECK(shaded.stats.seabed_samples > bare.stats.seabed_samples);
        CHECK(shaded.image == bare.image);
    }
}

TEST_CASE("without_labels() and shadow::none give no labels and no shadows") {
    const in::scene s = cube_on_plane(0.3);
    const in::overhead rig{.altitude = 3, .size = {100, 100}};
    const auto bare = in::render(s, rig, in::render_options<in::shadow::none, in::no_labels>{});
    static_assert(std::is_empty_v<decltype(bare.labels)>);
    // Without shadows level ground is everywhere as bright as in the light.
    CHECK(bare.image(60, 50) == bare.image(5, 5));
    const auto shaded = in::render(s, rig, in::render_options<in::shadow::map, in::no_labels>{});
    CHECK(shaded.image(5, 5) == bare.image(5, 5));
    CHECK(shaded.image(60, 50) < 0.5f * bare.image(60, 50));  // in the cube's shadow
    float darkest = 1;
    for (const float v : shaded.image.pixels()) darkest = (std::min)(darkest, v);
    CHECK(darkest == Approx(0.45f * 0.05f));
}

TEST_CASE("The picture is covered without gaps on every seabed") {
    for (const in::seabed::any& seabed : {in::seabed::any(in::seabed::ripples{}), in::seabed::any(in::seabed::mud{}),
                                          in::seabed::any(in::seabed::rock{.relief = 0.3f})}) {
        in::scene s;
        s.seabed = seabed;
        for (const float yaw : {0.0f, 0.7f}) {
            const auto picture = in::render(s, {.altitude = 5, .yaw = yaw, .size = {256, 200}});
            CHECK(picture.stats.seabed.pixels == 256 * 200);
            for (const std::uint8_t type : picture.labels.seabed.pixels()) CHECK(type < 4);
        }
    }
}

TEST_CASE("Objects beside the picture cast shadows into it") {
    // A wall 1 m high along y, 0.4 m beyond the left border; level ground elsewhere.
    in::seabed::heightfield field{.heights = in::image<float>(401, 401), .origin = {-10, -10}, .spacing = 0.05};
    const in::overhead rig{.altitude = 3, .field_of_view = 90_deg, .size = {200, 200}, .grazing = 20_deg};
    for (int j = 0; j < 401; ++j)
        for (int i = 124; i < 132; ++i) field.heights(i, j) = 1;  // x from -3.8 to -3.4
    in::scene s;
    s.seabed = field;
    const auto picture = in::render(s, rig);
    const double tip = in::overhead_geometry(rig).pixel({-3.4 + 1 / std::tan(20 * in::numeric::pi / 180), 0, 0}).x;
    const auto dark = where(200, [&](int x) { return picture.labels.shadow(x, 100) == in::labels::by_seabed; });
    CHECK(dark.first == 0);
    CHECK(std::abs(dark.last + 1 - tip) <= 3);  // the wall's top edge is a cell wide
}

TEST_CASE("rest_on() puts a target in contact with the seabed; burial is added to that") {
    const in::seabed::any seabed = in::seabed::ripples{};
    const in::mesh shape = to_mesh(in::sphere{.radius = 0.3f, .segments = 24});
    in::pose p = in::rest_on(seabed, shape, {.position = {3, 4, 77}, .burial = 0.1f});
    const auto lowest = [&](const in::pose& at) {
        const auto bottom = in::seabed::prepare(seabed);
        double clearance = 1e9;
        for (const glm::vec3& v : shape.positions) {
            const glm::dvec3 w = in::transform_point(in::to_world(at), v);
            clearance = (std::min)(clearance, w.z - static_cast<double>(in::seabed::at(bottom, w.x, w.y).height));
        }
        return clearance;
    };
    CHECK(lowest(p) == Approx(-0.1).margin(1e-6));
    p.burial = 0;
    CHECK(lowest(p) == Approx(0).margin(1e-6));
    REQUIRE_THROWS_AS(in::rest_on(seabed, {}, {}), in::invalid_input);
    // Vertices that are not finite touch nothing.
    in::mesh damaged = shape;
    damaged.positions.push_back(glm::vec3(std::numeric_limits<float>::quiet_NaN()));
    damaged.positions.push_back(glm::vec3(std::numeric_limits<float>::infinity(), 0, 0));
    CHECK(in::rest_on(seabed, damaged, {.position = {3, 4, 77}, .burial = 0.1f}).position == p.position);
    CHECK_THROWS_WITH(in::rest_on(seabed, shape, {.position = {1e25, 0, 0}}), ContainsSubstring("pose.position.x"));
}

TEST_CASE("Rigs out of range are refused by name and value") {
    const in::scene s;
    const auto refused = [&](const in::overhead& rig, const char* text) {
        REQUIRE_THROWS_WITH(in::render(s, rig), ContainsSubstring(text));
    };
    refused({.altitude = 0}, "overhead.altitude is 0");
    refused({.altitude = std::nanf("")}, "overhead.altitude is nan");
    refused({.field_of_view = 180_deg}, "overhead.field_of_view");
    refused({.size = {0, 5}}, "overhead.size.x is 0");
    refused({.grazing = 0}, "overhead.grazing is 0");
    refused({.intensity = -1}, "overhead.intensity is -1");
    const auto soft = [&](in::shadow::pcf shadow) {
        return in::render(s, {.size = {8, 8}}, in::render_options<in::shadow::pcf>{.shadow = shadow});
    };
    REQUIRE_THROWS_WITH(soft({.texels_per_pixel = 0}), ContainsSubstring("texels_per_pixel is 0"));
    REQUIRE_THROWS_WITH(soft({.radius = 9}), ContainsSubstring("radius is 9"));
    in::scene bad;
    bad.add(in::cube{}, {.scale = 0}, "cube");
    REQUIRE_THROWS_WITH(in::render(bad, {.size = {8, 8}}), ContainsSubstring("scene.targets[0].placement.scale is 0"));
}

TEST_CASE("Pictures of one pixel and of odd shapes are drawn") {
    for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(1, 40), glm::ivec2(301, 3)}) {
        const auto picture = in::render(cube_on_plane(0.5), {.altitude = 3, .size = size});
        CHECK(picture.stats.seabed.pixels == static_cast<std::uint64_t>(size.x * size.y));
        for (const float v : picture.image.pixels()) CHECK((v >= 0 && v <= 1));
    }
    // Straight down on the cube, whose top is lit.
    in::overhead rig{.position = {-1, 0}, .altitude = 3, .size = {1, 1}, .grazing = 40_deg};
    const float alone = in::render(cube_on_plane(0.5), rig).image(0, 0);
    rig.size = {3, 3};
    CHECK(alone == in::render(cube_on_plane(0.5), rig).image(1, 1));
    CHECK(alone > 0.2f);
}

TEST_CASE(
    "Overlapping shadows are labelled with the first target; a dark side in another target's shadow with that target") {
    in::scene s;
    s.seabed = plane;
    s.add(in::cube{.size = glm::vec3(0.4f)}, {.position = {-1.5, 0, 0.2}}, "near the light");
    s.add(in::cube{.size = glm::vec3(0.2f)}, {.position = {0, 0, 0.1}}, "in its shadow");
    const in::overhead rig{.altitude = 6, .field_of_view = 60_deg, .size = {400, 400}};
    const auto labels = in::render(s, rig).labels;
    const auto pixel = [&](double x, double z) {
        const glm::dvec2 p = in::overhead_geometry(rig).pixel({x, 0, z});
        return glm::ivec2(p);
    };
    const auto shadow_at = [&](double x, double z) { return labels.shadow(pixel(x, z).x, pixel(x, z).y); };
    REQUIRE(shadow_at(-1, 0) == 1);
    REQUIRE(labels.instance(pixel(0, 0.2).x, pixel(0, 0.2).y) == 2);
    CHECK(shadow_at(0, 0.2) == 1);       // the second one's top
    CHECK(shadow_at(0.4, 0) == 1);       // in the shadow of both
    CHECK(shadow_at(0.101, 0.05) == 1);  // its far side, which would be dark without the first
}

TEST_CASE("A sheet is as bright from behind as one that was wound the other way") {
    const auto seen = [](std::vector<glm::uvec3> triangles) {
        in::scene s;
        s.seabed = plane;
        s.add(in::mesh{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0.6f}, {-1, 1, 0.6f}}, {}, std::move(triangles)},
              {.position = {0, 0, 0.5}, .yaw = 1}, "sheet");
        return in::render(s, in::overhead{.altitude = 4, .field_of_view = 60_deg, .size = {64, 64}});
    };
    const auto front = seen({{0, 1, 2}, {0, 2, 3}}), back = seen({{0, 2, 1}, {0, 3, 2}});
    CHECK(front.image == back.image);
    CHECK(front.labels.instance == back.labels.instance);
    CHECK(front.labels.targets[0].area > 500);
}

TEST_CASE("A closed target looks the same if wound inside out, and none of its triangles are culled") {
    const in::overhead rig{.altitude = 4, .field_of_view = 60_deg, .size = {96, 96}};
    const auto drawn = [&](in::mesh shape) {
        in::scene s;
        s.seabed = plane;
        s.add(std::move(shape), {.position = {0.2, 0.1, 0.3}, .yaw = 1}, "shape");
        return in::render(s, rig);
    };
    const in::mesh shape = in::to_mesh(in::cylinder{.radius = 0.3f, .length = 1.5f});
    in::mesh turned = shape;
    for (glm::uvec3& t : turned.triangles) std::swap(t.y, t.z);
    for (glm::vec3& n : turned.normals) n = -n;
    const auto outside = drawn(shape), inside = drawn(turned);
    CHECK(outside.image == inside.image);
    CHECK(outside.labels.instance == inside.labels.instance);
    CHECK(outside.labels.shadow == inside.labels.shadow);
    CHECK(outside.labels.targets[0].area > 100);
    CHECK(outside.stats.targets.culled == 0);
}

TEST_CASE("The order of targets in the scene does not change the picture") {
    in::random_sequence random(17);
    const in::overhead rig{.altitude = 10, .size = {300, 220}, .grazing = 20_deg};
    in::scene one, other;
    std::vector<in::pose> poses;
    for (int i = 0; i < 20; ++i)
        poses.push_back({.position = {random.uniform(-6, 6), random.uniform(-5, 5), random.uniform(0, 5)},
                         .yaw = static_cast<float>(random.uniform(0, 6)),
                         .pitch = static_cast<float>(random.uniform(-1, 1))});
    for (const in::pose& p : poses) one.add(in::cube{}, p, "cube");
    for (auto p = poses.rbegin(); p != poses.rend(); ++p) other.add(in::cube{}, *p, "cube");
    const auto a = in::render(one, rig), b = in::render(other, rig);
    CHECK(a.image == b.image);
    int differ = 0;
    for (int y = 0; y < rig.size.y; ++y)
        for (int x = 0; x < rig.size.x; ++x) {
            const int first = a.labels.instance(x, y), last = b.labels.instance(x, y);
            differ += first == 0 ? last != 0 : last != 21 - first;
        }
    CHECK(differ == 0);
}

TEMPLATE_TEST_CASE("Sheets over sheets, drawn from the lowest to the highest, have the picture of the reverse order",
                   "", in::shadow::map, in::shadow::exact) {
    const in::seabed::heightfield field = in::seabed::sample(in::seabed::rock{}, {{-9, -9}, 0.25, 73, 73});
    in::scene upwards, downwards;
    constexpr int sheets = 6;
    for (in::scene* s : {&upwards, &downwards}) {
        s->seabed = in::seabed::none{};
        for (int i = 0; i < sheets; ++i) {
            const double height = s == &upwards ? i : sheets - 1 - i;
            s->add(in::seabed::tessellate(field), {.position = {-9, -9, 0.5 * height}, .pitch = 0.01f}, "sheet");
        }
    }
    const in::overhead rig{.altitude = 8, .field_of_view = 45_deg, .size = {77, 51}, .grazing = 25_deg};
    for (const int tile : {16, 64}) {
        in::render_options<TestType, in::no_labels> options;
        options.tile = tile;
        const in::image<float> picture = in::render(upwards, rig, options).image;
        CHECK(picture == in::render(downwards, rig, options).image);
        const auto [least, most] = std::minmax_element(picture.pixels().begin(), picture.pixels().end());
        CHECK(*most > 4 * *least);
    }
}

TEST_CASE("With exact depth the nearer of two sheets is visible wherever their depths differ as floats") {
    // Two sloped sheets of small triangles, the second 2 micrometres above the first, seen from 8 to 12 m.
    in::mesh sheets;
    const int n = 200;
    for (const double above : {0.0, 2e-6})
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) {
                const double x = 20.0 * i / n - 10, y = 20.0 * j / n - 10;
                sheets.positions.emplace_back(x, y, 0.2 * x + above);
            }
    for (const int first : {0, (n + 1) * (n + 1)})
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const auto a = static_cast<std::uint32_t>(first + j * (n + 1) + i), b = a + n + 1;
                sheets.triangles.insert(sheets.triangles.end(), {{a, a + 1, b + 1}, {a, b + 1, b}});
            }
    in::scene s;
    s.seabed = in::seabed::none{};
    s.add(sheets, {}, "sheets");
    const in::overhead rig{.field_of_view = 60_deg, .size = {512, 512}};
    const auto lower_shown = [&](const auto& options) {
        int pixels = 0;
        const in::visibility shown = in::visible_triangles(s, rig, options);
        for (const std::uint32_t t : shown.triangle.pixels()) pixels += t < 2u * n * n;
        return pixels;
    };
    const in::render_options<in::shadow::none> options{.subpixel_bits = 16};
    CHECK(lower_shown(options.with_exact_depth()) == 0);
    CHECK(lower_shown(options) > 0);
}
