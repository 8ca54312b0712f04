// Poses, affine maps and bounds.
#include <insonify/geometry/bounds.hpp>
#include <insonify/geometry/cube.hpp>
#include <insonify/geometry/sphere.hpp>
#include <insonify/geometry/topology.hpp>
#include <insonify/geometry/transform.hpp>

#include <limits>

#include <glm/geometric.hpp>

#include "../../catch.hpp"

namespace in = insonify;
using in::compose;
using in::inverse;
using in::to_world;
using namespace in::literals;

namespace {

double distance(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::length(a - b);
}
const in::pose skewed{.position = {1, -2, 3}, .yaw = 40_deg, .pitch = -25_deg, .roll = 110_deg, .scale = 1.5f};
constexpr double inf = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("Positive angles turn counter-clockwise seen against their axis") {
    const auto turned = [](const in::pose& p, const glm::dvec3& v) { return transform_direction(to_world(p), v); };
    CHECK(distance(turned({.yaw = 90_deg}, {1, 0, 0}), {0, 1, 0}) < 1e-7);
    CHECK(distance(turned({.pitch = 90_deg}, {1, 0, 0}), {0, 0, -1}) < 1e-7);
    CHECK(distance(turned({.roll = 90_deg}, {0, 1, 0}), {0, 0, 1}) < 1e-7);
}

TEST_CASE("A pose rolls first, then pitches, then yaws") {
    const in::affine all = to_world({.yaw = 20_deg, .pitch = 30_deg, .roll = 50_deg});
    const in::affine steps =
        compose(to_world({.yaw = 20_deg}), compose(to_world({.pitch = 30_deg}), to_world({.roll = 50_deg})));
    for (int i = 0; i < 3; ++i) CHECK(distance(all.linear[i], steps.linear[i]) < 1e-15);
}

TEST_CASE("A pose scales lengths, keeps angles and handedness, and sinks by the burial") {
    in::pose p = skewed;
    p.burial = 0.25f;
    const in::affine map = to_world(p);
    const glm::dmat3 product = glm::transpose(map.linear) * map.linear;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) CHECK(product[i][j] == Approx(i == j ? 2.25 : 0).margin(1e-14));
    }
    CHECK(glm::determinant(map.linear) == Approx(1.5 * 1.5 * 1.5));
    CHECK(transform_point(map, glm::dvec3(0)) == glm::dvec3(1, -2, 2.75));
    CHECK(to_world({}).linear == glm::dmat3(1));
}

TEST_CASE("inverse undoes a map, and composing applies the inner one first") {
    in::affine map = to_world(skewed);
    map.linear[0] *= 3.0;
    map.linear[2] += map.linear[1];
    const glm::dvec3 p(0.3, -7, 11);
    CHECK(distance(transform_point(inverse(map), transform_point(map, p)), p) < 1e-13);
    const in::affine back = compose(inverse(map), map);
    CHECK(distance(back.offset, glm::dvec3(0)) < 1e-14);
    const in::affine other = to_world({.position = {5, 6, 7}, .roll = 1});
    CHECK(distance(transform_point(compose(other, map), p), transform_point(other, transform_point(map, p))) < 1e-13);
    CHECK_THROWS_AS(inverse(in::affine{.linear = glm::dmat3(0)}), in::invalid_input);
    CHECK_THROWS_AS(inverse(in::affine{.linear = glm::dmat3(inf)}), in::invalid_input);
}

TEST_CASE("At 10^7 m from the origin a millimetre is preserved") {
    const glm::dvec3 far_away(1e7, -1e7, 50);
    const in::affine object = to_world({.position = far_away + glm::dvec3(1, 2, 3), .yaw = 1});
    const in::affine camera = to_world({.position = far_away, .pitch = 0.5f, .roll = 2});
    const in::affine seen = compose(inverse(camera), object);
    const in::affine reference =
        compose(inverse(to_world({.pitch = 0.5f, .roll = 2})), to_world({.position = {1, 2, 3}, .yaw = 1}));
    for (const glm::dvec3& p : {glm::dvec3(0), glm::dvec3(0.001, 0, 0), glm::dvec3(-1, 2, 0.5)}) {
        CHECK(distance(transform_point(seen, p), transform_point(reference, p)) < 1e-8);
    }
}

TEST_CASE("Normals stay square to a sheared surface and outside of a mirrored one") {
    in::affine map = to_world(skewed);
    map.linear[1] += 0.7 * map.linear[0];
    map.linear[2] *= 0.3;
    const bool mirrored = GENERATE(false, true);
    if (mirrored) map.linear[0] = -map.linear[0];

    const in::mesh before = to_mesh(in::cube{.size = {1, 2, 3}});
    const in::mesh after = transformed(before, map);
    CHECK(in::inspect(after).closed());
    for (const glm::uvec3& t : after.triangles) {
        const glm::dvec3 a = after.positions[t.x], b = after.positions[t.y], c = after.positions[t.z];
        const glm::dvec3 face = glm::normalize(glm::cross(b - a, c - a));
        CHECK(distance(face, after.normals[t.x]) < 1e-5);
        CHECK(glm::dot(face, a - map.offset) > 0);
    }
    CHECK(transform_normal(map, glm::dvec3(0)) == glm::dvec3(0));
}

TEST_CASE("A pose that is not finite, or whose scale is not positive, is refused by name") {
    const float bad = GENERATE(std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity());
    CHECK_THROWS_WITH(to_world({.position = {0, static_cast<double>(bad), 0}}), ContainsSubstring("pose.position.y"));
    CHECK_THROWS_WITH(to_world({.yaw = bad}), ContainsSubstring("pose.yaw"));
    CHECK_THROWS_WITH(to_world({.pitch = bad}), ContainsSubstring("pose.pitch"));
    CHECK_THROWS_WITH(to_world({.roll = bad}), ContainsSubstring("pose.roll"));
    CHECK_THROWS_WITH(to_world({.burial = bad}), ContainsSubstring("pose.burial"));
    CHECK_THROWS_WITH(to_world({.scale = bad}), ContainsSubstring("pose.scale"));
    CHECK_THROWS_AS(to_world({.scale = 0}), in::invalid_input);
    CHECK_THROWS_AS(to_world({.scale = -1}), in::invalid_input);
}

TEST_CASE("A bounding box starts empty, grows by points and boxes, and skips non-finite points") {
    in::bounding_box box;
    CHECK(box.empty());
    CHECK(box.size() == glm::dvec3(0));
    CHECK(merge(box, box).empty());
    box = include(box, {1, 2, 3});
    CHECK_FALSE(box.empty());
    CHECK(box.size() == glm::dvec3(0));
    CHECK(merge(box, in::bounding_box{}) == box);
    CHECK(include(box, {-inf, 0, 0}) == box);
    CHECK(include(box, {0, inf - inf, 0}) == box);
    CHECK(include(box, {0, 0, inf}) == box);
    box = merge(box, in::include({}, {-1, 5, 3}));
    CHECK(box.lower == glm::dvec3(-1, 2, 3));
    CHECK(box.upper == glm::dvec3(1, 5, 3));
    CHECK(box.centre() == glm::dvec3(0, 3.5, 3));

    in::mesh ball = to_mesh(in::sphere{.radius = 2, .aspect = {1, 2, 0.5f}});
    ball.positions.push_back(glm::vec3(std::numeric_limits<float>::quiet_NaN()));
    CHECK(bounds(ball).lower == glm::dvec3(-2, -4, -1));
    CHECK(bounds(ball).upper == glm::dvec3(2, 4, 1));
    CHECK(bounds(in::mesh{}).empty());
}
