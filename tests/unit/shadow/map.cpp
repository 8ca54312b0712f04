// Shadow maps against closed forms: lengths, contact, no shadow acne, and marched rays.
#include <insonify/core/random.hpp>
#include <insonify/core/thread_pool.hpp>
#include <insonify/geometry/cube.hpp>
#include <insonify/seabed/sample.hpp>
#include <insonify/seabed/tessellate.hpp>
#include <insonify/shadow/map_lookup.hpp>

#include <cmath>

#include "../../catch.hpp"
#include "lit_mesh.hpp"

namespace in = insonify;
namespace shadow = insonify::shadow;

namespace {

using lit::radians;

shadow::height_map map_of(const in::mesh& m, const shadow::light_frame& light, double texel) {
    shadow::height_map map(light, shadow::extent_of(bounds(m), {}, light), texel, 16384);
    map.cast(m, {});
    return map;
}

/// A cube of 1 m whose base lies on the datum around the origin.
in::mesh standing_cube() {
    return in::transformed(to_mesh(in::cube{}), {glm::dmat3(1), {0, 0, 0.5}});
}

float lit_on_ground(const shadow::height_map& map, double x, double y) {
    return shadow::lit(map, {map.frame(), {x, y, 0}, {0, 0, 1}}, 0);
}

/// A rough seabed of crossing waves.
struct waves {
    static constexpr in::seabed::type kind = in::seabed::type::sand;
    void row(const in::seabed::scanline& line, std::span<float> heights) const {
        for (std::size_t i = 0; i < heights.size(); ++i)
            heights[i] = static_cast<float>(0.05 * std::sin(7 * line.x(i) + 2 * std::sin(3 * line.y)) +
                                            0.02 * std::sin(23 * line.y + 9 * line.x(i)));
    }
};

const double elevations[] = {1, 3, 6, 20, 45, 70, 89};

}  // namespace

TEST_CASE("All points of one ray share u and v, and light from the zenith leaves x and y unchanged") {
    for (const double elevation : elevations) {
        const shadow::light_frame light({radians(200), radians(elevation)});
        const glm::dvec3 p(3, -2, 0.5), q = p + 4.0 * light.to_light();
        const glm::dvec3 a = light(p), b = light(q);
        CHECK(a.x == Approx(b.x));
        CHECK(a.y == Approx(b.y));
        CHECK(b.z > a.z);
        CHECK(light.cot_elevation() == Approx(1 / std::tan(radians(elevation))));
    }
    const glm::dvec3 above = shadow::light_frame({0, radians(90)})({3, -2, 5});
    CHECK(above.x == Approx(3));
    CHECK(above.y == Approx(-2));
}

TEST_CASE("A cube's shadow on level ground is as long as its height over the tangent, to a texel") {
    const double texel = 0.01;
    for (const double elevation : elevations) {
        const shadow::light_frame light({0, radians(elevation)});
        const auto map = map_of(standing_cube(), light, texel);
        const double length = 1 / std::tan(radians(elevation)), end = 0.5 + length;
        CHECK(lit_on_ground(map, end + 1.1 * texel, 0) == 1);
        if (length > 2 * texel) CHECK(lit_on_ground(map, end - 1.1 * texel, 0) == 0);
        CHECK(lit_on_ground(map, -0.5 - 1.1 * texel, 0) == 1);
        CHECK(lit_on_ground(map, 0.6 * end, 0.5 + 1.1 * texel) == 1);
        if (length > 2 * texel) CHECK(lit_on_ground(map, 0.5 + 0.5 * length, 0.5 - 1.1 * texel) == 0);
    }
}

TEST_CASE("A shadow begins at the foot of its caster") {
    const double texel = 0.01;
    for (const double elevation : {1.0, 6.0, 20.0, 45.0, 70.0}) {
        const shadow::light_frame light({0, radians(elevation)});
        const auto map = map_of(standing_cube(), light, texel);
        for (double x = 0.5 + texel; x < 0.5 + 0.9 / std::tan(radians(elevation)); x += 0.3 * texel)
            CHECK(lit_on_ground(map, x, 0.013) == 0);
    }
}

TEST_CASE("A plane that faces the light casts no shadow on itself, however it is tilted") {
    for (const double elevation : elevations)
        for (const double tilt : {-80.0, -30.0, -5.0, 0.0, 5.0, 30.0, 80.0})
            for (const double azimuth : {0.0, 45.0, 23.7, 180.0}) {
                const shadow::light_frame light({radians(azimuth), radians(elevation)});
                const double rise = std::tan(radians(tilt));
                const auto height = [=](double x, double y) { return rise * (0.8 * x + 0.6 * y); };
                in::mesh plane;
                for (const double y : {-1.0, 1.0})
                    for (const double x : {-1.0, 1.0}) plane.positions.emplace_back(x, y, height(x, y));
                plane.triangles = {{0, 1, 3}, {0, 3, 2}};
                const auto map = map_of(plane, light, 0.02);
                in::random_sequence random(3);
                for (int n = 0; n < 50; ++n) {
                    const double x = random.uniform(-0.9, 0.9), y = random.uniform(-0.9, 0.9);
                    const shadow::receiver_plane at(light, {x, y, height(x, y)}, {-0.8 * rise, -0.6 * rise, 1});
                    if (!at.faces_light) continue;
                    CHECK(shadow::lit(map, at, 0) == 1);
                    CHECK(shadow::lit(map, at, 1) == 1);
                }
            }
}

TEST_CASE("On a rough seabed the map agrees with marched rays") {
    const auto field = in::seabed::sample(waves{}, {.origin = {0, 0}, .spacing = 0.03, .width = 200, .height = 200});
    const in::mesh mesh = in::seabed::tessellate(field);
    for (const double elevation : {6.0, 20.0, 60.0}) {
        const shadow::light_frame light({radians(23.7), radians(elevation)});
        const auto map = map_of(mesh, light, 0.008);
        int both = 0, either = 0;
        in::random_sequence random(4);
        for (int n = 0; n < 4000; ++n) {
            const double x = random.uniform(2.5, 5.5), y = random.uniform(2.5, 5.5);
            const double z = static_cast<double>(field.height_at(x, y));
            const glm::dvec3 facet(field.normal_at(x, y));
            bool open = glm::dot(facet, light.to_light()) > 0;
            for (double t = 0.004; open && t < 2; t += 0.004)
                open = static_cast<double>(field.height_at(x - light.travel().x * t, y - light.travel().y * t)) <=
                       z + t / light.cot_elevation() + 1e-6;
            const shadow::receiver_plane at(light, {x, y, z}, facet);
            const bool lit = at.faces_light && shadow::lit(map, at, 0) == 1;
            both += open && lit;
            either += open || lit;
        }
        INFO("elevation " << elevation);
        CHECK(both > 0.95 * either);
    }
}

TEST_CASE("PCF softens shadow edges and changes no other point") {
    const double texel = 0.02;
    const shadow::light_frame light({0, radians(20)});
    const auto map = map_of(standing_cube(), light, texel);
    const auto soft = [&](double x) { return shadow::lit(map, {light, {x, 0.01, 0}, {0, 0, 1}}, 1); };
    const double end = 0.5 + light.cot_elevation();
    float before = 0;
    bool halfway = false;
    for (double x = end - 4 * texel; x < end + 4 * texel; x += 0.2 * texel) {
        // Three texels are averaged, around a map's edge that is off by half a texel.
        if (x < end - 2.1 * texel) CHECK(soft(x) == 0);
        if (x > end + 2.1 * texel) CHECK(soft(x) == 1);
        CHECK(soft(x) >= before);
        before = soft(x);
        halfway = halfway || (before > 0 && before < 1);
    }
    CHECK(halfway);
}

TEST_CASE("PCF takes points beyond the map's border as lit") {
    const shadow::light_frame light({radians(30), radians(45)});
    const in::bounding_box extent{{0, 0, 0}, {1, 1, 0.5}};
    constexpr double texel = 0.05;
    constexpr int soft = 3;
    shadow::height_map map(light, extent, texel);
    map.cast(in::mesh{{{-9, -9, 0.5f}, {9, -9, 0.5f}, {9, 9, 0.5f}, {-9, 9, 0.5f}}, {}, {{0, 1, 2}, {0, 2, 3}}}, {});
    const auto border = [](double a) { return (std::max)(-a, a - 1); };  // metres beyond it
    for (const double u : {-0.5, -0.2, -0.01, 0.01, 0.2, 0.5, 0.8, 0.99, 1.01, 1.25, 1.5})
        for (const double v : {-0.5, -0.2, -0.01, 0.01, 0.2, 0.5, 0.8, 0.99, 1.01, 1.25, 1.5}) {
            shadow::receiver_plane at;
            at.uvz = {u, v, 0};
            const double beyond = (std::max)(border(u), border(v));
            const float lit = shadow::lit(map, at, soft);
            CAPTURE(u, v, lit);
            if (beyond > (soft + 1) * texel)
                CHECK(lit == 1);
            else if (beyond < -(soft + 0.5) * texel)
                CHECK(lit == 0);
            else
                CHECK((lit > 0 && lit <= 1));
        }
}

TEST_CASE("A map is the same for any executor, and an empty one leaves everything lit") {
    const shadow::light_frame light({1, radians(10)});
    const in::mesh m = standing_cube();
    const auto extent = shadow::extent_of(bounds(m), {}, light);
    shadow::height_map serial(light, extent, 0.02), parallel(light, extent, 0.02);
    serial.cast(m, {});
    in::thread_pool pool(3);
    parallel.cast(m, {}, pool);
    for (int j = 0; j < serial.rows(); ++j)
        for (int i = 0; i < serial.columns(); ++i) REQUIRE(serial(i, j) == parallel(i, j));

    CHECK(lit_on_ground(shadow::height_map{}, 0, 0) == 1);
    CHECK(shadow::extent_of(in::bounding_box{}, {}, light).empty());
    CHECK(shadow::height_map(light, {}, 0.1).empty());
}

TEST_CASE("A map that would exceed its largest size gets coarser texels") {
    const shadow::light_frame light({0, radians(1)});
    const shadow::height_map map(light, shadow::extent_of(bounds(standing_cube()), {}, light), 1e-4, 512);
    CHECK(map.columns() <= 512);
    CHECK(map.rows() <= 512);
    CHECK((std::max)(map.columns(), map.rows()) == 512);  // no coarser than needed
}

TEST_CASE("Lights and maps out of range are refused") {
    REQUIRE_THROWS_WITH(shadow::light_frame({0, 0}), ContainsSubstring("elevation is 0"));
    REQUIRE_THROWS_AS(shadow::light_frame({0, 2}), in::invalid_input);
    REQUIRE_THROWS_AS(shadow::light_frame({std::nan(""), 1}), in::invalid_input);
    const shadow::light_frame light({0, 1});
    REQUIRE_THROWS_WITH(shadow::height_map(light, {}, 0), ContainsSubstring("texel is 0"));
    REQUIRE_THROWS_WITH(shadow::height_map(light, {}, 1, 0), ContainsSubstring("largest is 0"));
}
