// Primitive builders: closed, outward, and converging to the closed forms of area and volume.
#include <insonify/geometry/cone.hpp>
#include <insonify/geometry/cube.hpp>
#include <insonify/geometry/cylinder.hpp>
#include <insonify/geometry/normals.hpp>
#include <insonify/geometry/shared_mesh.hpp>
#include <insonify/geometry/sphere.hpp>
#include <insonify/geometry/topology.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "../../catch.hpp"
#include "../../not_finite.hpp"

namespace in = insonify;

namespace {

using in::numeric::pi;

struct measures {
    double area = 0;
    double volume = 0;  // by the divergence theorem: positive if triangles face outwards
};
measures measure(const in::mesh& m) {
    measures out;
    for (const glm::uvec3& t : m.triangles) {
        const glm::dvec3 a = m.positions[t.x], b = m.positions[t.y], c = m.positions[t.z];
        out.area += 0.5 * glm::length(glm::cross(b - a, c - a));
        out.volume += glm::dot(a, glm::cross(b, c)) / 6;
    }
    return out;
}

void check_closed_and_outward(const in::mesh& m) {
    const in::topology t = in::inspect(m);
    CHECK(t.closed());
    CHECK(t.solid());
    CHECK(t.euler_characteristic() == 2);
    CHECK(t.degenerate == 0);
    CHECK(measure(m).volume > 0);
    REQUIRE(m.normals.size() == m.positions.size());

    // Shading normals are unit and within 60 degrees of each triangle that uses them, even on the coarsest mesh.
    std::size_t wrong = 0;
    for (const glm::uvec3& t3 : m.triangles) {
        const glm::dvec3 a = m.positions[t3.x], b = m.positions[t3.y], c = m.positions[t3.z];
        const glm::dvec3 face = glm::normalize(glm::cross(b - a, c - a));
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 n = m.normals[t3[i]];
            wrong += glm::dot(n, face) >= 0.49999 && std::fabs(glm::length(n) - 1) < 1e-6 ? 0u : 1u;
        }
    }
    CHECK(wrong == 0);
}

// Area and volume with n, 2n and 4n segments: the error falls by four, and extrapolation lands on the closed form.
template <class Build>
void check_second_order(Build build, double area, double volume) {
    const measures coarse = measure(build(48)), middle = measure(build(96)), fine = measure(build(192));
    CHECK((area - coarse.area) / (area - middle.area) == Approx(4).epsilon(0.02));
    CHECK((area - middle.area) / (area - fine.area) == Approx(4).epsilon(0.02));
    CHECK((volume - coarse.volume) / (volume - middle.volume) == Approx(4).epsilon(0.02));
    CHECK((volume - middle.volume) / (volume - fine.volume) == Approx(4).epsilon(0.02));
    CHECK((4 * fine.area - middle.area) / 3 == Approx(area).epsilon(1e-6));
    CHECK((4 * fine.volume - middle.volume) / 3 == Approx(volume).epsilon(1e-6));
}

}  // namespace

TEST_CASE("Every primitive is a closed surface with outward triangles and unit normals") {
    check_closed_and_outward(to_mesh(in::cube{.size = {1, 2, 3}}));
    const int segments = GENERATE(3, 4, 5, 8, 64, 97);
    CAPTURE(segments);
    check_closed_and_outward(to_mesh(in::cylinder{.segments = segments}));
    check_closed_and_outward(to_mesh(in::cone{.segments = segments}));
    check_closed_and_outward(to_mesh(in::cone{.radius = 0.2f, .top_radius = 0.6f, .segments = segments}));
    check_closed_and_outward(to_mesh(in::sphere{.segments = segments + 3}));
    check_closed_and_outward(to_mesh(in::hemisphere{.segments = segments + 3}));
    check_closed_and_outward(to_mesh(in::capsule{.segments = segments + 3}));
    check_closed_and_outward(to_mesh(in::capsule{.radius = 1, .length = 2, .segments = segments + 3}));
}

TEST_CASE("A cube has the area and volume of its size, and normals along the axes") {
    const in::mesh m = to_mesh(in::cube{.size = {1, 2, 4}});
    CHECK(m.positions.size() == 24);
    CHECK(m.triangles.size() == 12);
    CHECK(measure(m).volume == 8);
    CHECK(measure(m).area == 28);
    for (const glm::uvec3& t : m.triangles) {
        const glm::vec3 a = m.positions[t.x];
        CHECK(glm::normalize(glm::cross(m.positions[t.y] - a, m.positions[t.z] - a)) == m.normals[t.x]);
        CHECK(m.normals[t.x] == m.normals[t.z]);
    }
}

TEST_CASE("Area and volume converge to the closed forms with the square of the segments") {
    SECTION("cylinder") {
        check_second_order([](int n) { return to_mesh(in::cylinder{.radius = 0.25f, .length = 2, .segments = n}); },
                           2 * pi * 0.25 * (2 + 0.25), pi * 0.0625 * 2);
    }
    SECTION("capsule") {
        check_second_order([](int n) { return to_mesh(in::capsule{.radius = 0.5f, .length = 3, .segments = n}); },
                           2 * pi * 0.5 * 3, pi * 0.25 * 2 + 4 * pi / 3 * 0.125);
    }
    SECTION("cone") {
        check_second_order([](int n) { return to_mesh(in::cone{.radius = 3, .height = 4, .segments = n}); },
                           pi * 3 * (3 + 5), pi * 9 * 4 / 3);
    }
    SECTION("truncated cone") {
        check_second_order(
            [](int n) { return to_mesh(in::cone{.radius = 4, .height = 4, .top_radius = 1, .segments = n}); },
            pi * (16 + 1 + 5 * 5), pi * 4 * (16 + 4 + 1) / 3);
    }
    SECTION("sphere") {
        check_second_order([](int n) { return to_mesh(in::sphere{.radius = 2, .segments = n}); }, 16 * pi,
                           4 * pi / 3 * 8);
    }
    SECTION("hemisphere") {
        check_second_order([](int n) { return to_mesh(in::hemisphere{.radius = 2, .segments = n}); }, 12 * pi,
                           2 * pi / 3 * 8);
    }
    SECTION("prolate spheroid") {
        // a = 1, c = 2: area 2 pi a^2 (1 + c / (a e) asin e), e^2 = 3/4, asin e = pi / 3.
        check_second_order(
            [](int n) {
                return to_mesh(in::sphere{.radius = 1, .aspect = {1, 1, 2}, .segments = n});
            },
            2 * pi * (1 + 2 / std::sqrt(0.75) * pi / 3), 4 * pi / 3 * 2);
    }
}

TEST_CASE("Vertices and shading normals are those of the true surface") {
    const in::mesh m = to_mesh(in::sphere{.radius = 2, .aspect = {1, 2, 0.5f}, .segments = 33});
    for (std::size_t i = 0; i < m.positions.size(); ++i) {
        // (x/2)^2 + (y/4)^2 + z^2 = 1 and its gradient.
        const glm::dvec3 p = m.positions[i], n = m.normals[i];
        const glm::dvec3 gradient(p.x / 4, p.y / 16, p.z);
        CHECK(glm::dot(p, gradient) == Approx(1).epsilon(1e-6));
        CHECK(glm::dot(n, glm::normalize(gradient)) == Approx(1).epsilon(1e-6));
    }
}

TEST_CASE("A cone's tip is shaded by segment, its side by the slope, and its base flat") {
    const in::mesh m = to_mesh(in::cone{.radius = 3, .height = 4, .segments = 16});
    std::size_t at_tip = 0;
    for (const glm::uvec3& t : m.triangles) {
        const glm::dvec3 a = m.positions[t.x], b = m.positions[t.y], c = m.positions[t.z];
        const glm::dvec3 face = glm::normalize(glm::cross(b - a, c - a));
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 n = m.normals[t[i]];
            CHECK(n.z == Approx(face.z < -0.5 ? -1 : 0.6));
            if (m.positions[t[i]].z == 2) {
                ++at_tip;
                CHECK(glm::length(glm::cross(glm::dvec3(n.x, n.y, 0), glm::dvec3(face.x, face.y, 0))) < 1e-6);
            }
        }
    }
    CHECK(at_tip == 16);
}

TEST_CASE("A sphere and a capsule share every vertex, and a sphere has two poles") {
    const in::mesh ball = to_mesh(in::sphere{.segments = 16});
    CHECK(ball.positions.size() == 2 + 7 * 16);
    CHECK(in::inspect(ball).vertices == ball.positions.size());
    const in::mesh float_body = to_mesh(in::capsule{.segments = 16});
    CHECK(in::inspect(float_body).vertices == float_body.positions.size());
}

TEST_CASE("Cylinders lie along x, cones stand along z, hemispheres stand on z = 0") {
    const auto extent = [](const in::mesh& m) {
        glm::vec3 lower = m.positions[0], upper = lower;
        for (const glm::vec3& p : m.positions) {
            for (int i = 0; i < 3; ++i) {
                lower[i] = (std::min)(lower[i], p[i]);
                upper[i] = (std::max)(upper[i], p[i]);
            }
        }
        return std::pair(lower, upper);
    };
    using box = std::pair<glm::vec3, glm::vec3>;
    CHECK(extent(to_mesh(in::cylinder{.radius = 0.5f, .length = 3})) == box({-1.5f, -0.5f, -0.5f}, {1.5f, 0.5f, 0.5f}));
    CHECK(extent(to_mesh(in::capsule{.radius = 0.5f, .length = 3})) == box({-1.5f, -0.5f, -0.5f}, {1.5f, 0.5f, 0.5f}));
    CHECK(extent(to_mesh(in::cone{.radius = 1, .height = 3})) == box({-1, -1, -1.5f}, {1, 1, 1.5f}));
    CHECK(extent(to_mesh(in::sphere{.radius = 1, .aspect = {1, 2, 3}})) == box({-1, -2, -3}, {1, 2, 3}));
    CHECK(extent(to_mesh(in::hemisphere{.radius = 1, .aspect = {1, 1, 2}})) == box({-1, -1, 0}, {1, 1, 2}));
}

TEST_CASE("A profile turns about any axis without being mirrored") {
    const std::vector<in::profile_point> can = {{0, 0, 0, -1}, {1, 0, 0, -1}, {1, 0, 1, 0},
                                                {1, 2, 1, 0},  {1, 2, 0, 1},  {0, 2, 0, 1}};
    const auto around = GENERATE(in::axis::x, in::axis::y, in::axis::z);
    const in::mesh m = in::revolve(can, 1024, around);
    CHECK(in::inspect(m).closed());
    CHECK(measure(m).volume == Approx(2 * pi).epsilon(1e-4));
    CHECK_THROWS_AS(in::revolve(std::vector<in::profile_point>{{-1, 0, 0, 1}}, 8), in::invalid_input);
    CHECK_THROWS_AS(in::revolve(std::vector<in::profile_point>{{1, std::sqrt(-1.0), 0, 1}}, 8), in::invalid_input);
}

TEST_CASE("segments_for gives the fewest segments within the chord error") {
    // Published: n = pi / acos(1 - e / r), for errors of 1, 0.25 and 0.1 pixels.
    struct row {
        float radius;
        int one, quarter, tenth;
    };
    for (const row& r : {row{5, 5, 10, 16}, row{20, 10, 20, 32}, row{60, 18, 35, 55}, row{200, 32, 63, 100},
                         row{1000, 71, 141, 223}}) {
        CHECK(in::segments_for(r.radius, 1) == r.one);
        CHECK(in::segments_for(r.radius, 0.25f) == r.quarter);
        CHECK(in::segments_for(r.radius, 0.1f) == r.tenth);
    }
    for (const float error : {1e-6f, 1e-4f, 0.003f, 0.1f, 0.4f}) {
        const int n = in::segments_for(1, error);
        CHECK(1 - std::cos(pi / n) <= static_cast<double>(error));
        CHECK(1 - std::cos(pi / (n - 1)) > static_cast<double>(error));
    }
    CHECK(in::segments_for(1, 0.5f) == 3);
    CHECK(in::segments_for(1, 9) == 3);
    CHECK(in::segments_for(1, static_cast<float>(1 - std::sqrt(0.5)) + 1e-7f) == 4);
    CHECK_THROWS_AS(in::segments_for(1, 0), in::invalid_input);
    CHECK_THROWS_AS(in::segments_for(1, 1e-13f), in::invalid_input);
    CHECK_THROWS_AS(in::segments_for(not_a_number, 1), in::invalid_input);
}

TEST_CASE("A primitive refuses sizes and segments out of range") {
    const float bad = GENERATE(0.0f, -1.0f, not_a_number, positive_infinity);
    CHECK_THROWS_AS(to_mesh(in::cube{.size = {1, bad, 1}}), in::invalid_input);
    CHECK_THROWS_AS(to_mesh(in::cylinder{.radius = bad}), in::invalid_input);
    CHECK_THROWS_AS(to_mesh(in::cylinder{.length = bad}), in::invalid_input);
    CHECK_THROWS_AS(to_mesh(in::cone{.radius = bad}), in::invalid_input);
    CHECK_THROWS_AS(to_mesh(in::cone{.height = bad}), in::invalid_input);
    CHECK_THROWS_AS(to_mesh(in::sphere{.radius = bad}), in::invalid_input);
    CHECK_THROWS_AS(to_mesh(in::sphere{.aspect = {1, 1, bad}}), in::invalid_input);
    CHECK_THROWS_WITH(to_mesh(in::sphere{.radius = 1e30f, .aspect = {1e30f, 1, 1}}),
                      ContainsSubstring("sphere.aspect"));
    CHECK_THROWS_WITH(in::segments_for(in::sphere{.aspect = {1, -50, 1}}, 0.01f),
                      ContainsSubstring("sphere.aspect is"));
    CHECK_THROWS_WITH(to_mesh(in::cube{{1e-45f, 1, 1}}), ContainsSubstring("cube.size is 0"));
    CHECK_THROWS_AS(to_mesh(in::hemisphere{.radius = bad}), in::invalid_input);
    CHECK_THROWS_AS(to_mesh(in::capsule{.radius = bad}), in::invalid_input);
    CHECK_THROWS_AS(to_mesh(in::cone{.top_radius = -1}), in::invalid_input);
    CHECK_THROWS_AS(to_mesh(in::capsule{.radius = 1, .length = 1.9f}), in::invalid_input);
    CHECK_THROWS_WITH(to_mesh(in::cylinder{.segments = 2}), "cylinder.segments is 2, expected 3 to 2^20");
    CHECK_THROWS_WITH(to_mesh(in::cylinder{.segments = 1 << 21}), ContainsSubstring("cylinder.segments is 2097152"));
    CHECK_THROWS_WITH(to_mesh(in::cone{.segments = 2}), "cone.segments is 2, expected 3 to 2^20");
    CHECK_THROWS_AS(to_mesh(in::sphere{.segments = 8193}), in::invalid_input);
    CHECK_THROWS_WITH(to_mesh(in::cylinder{.radius = -2}),
                      ContainsSubstring("cylinder.radius") && ContainsSubstring("-2"));
}

TEST_CASE("shared_mesh::of() gives a primitive the properties that analysis finds in its mesh") {
    const auto check = [](const auto& shape) {
        const in::shared_mesh known = in::shared_mesh::of(shape), found = in::shared_mesh::of(in::to_mesh(shape));
        CHECK(known->positions == found->positions);
        CHECK(known->normals == found->normals);
        CHECK(known->triangles == found->triangles);
        CHECK(known.box().lower == found.box().lower);
        CHECK(known.box().upper == found.box().upper);
        CHECK(known.kind() == found.kind());
        CHECK(known.grid() == found.grid());
    };
    for (const float size : {1e-37f, 1e-3f, 0.7f, 1e4f, 1e37f}) {
        check(in::cube{.size = {size, size / 3, 5 * size}});
        for (const int segments : {3, 64, 700}) {
            check(in::cylinder{.radius = size, .length = 3 * size, .segments = segments});
            check(in::capsule{.radius = size, .length = 3 * size, .segments = segments});
            check(in::cone{.radius = size, .height = size / 2, .segments = segments});
            check(in::sphere{.radius = size, .segments = segments});
            check(in::hemisphere{.radius = size, .segments = segments});
        }
    }
    check(in::cylinder{.segments = 1 << 20});
}

TEST_CASE("Topology distinguishes open, inconsistent and closed surfaces") {
    in::mesh m;
    m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    m.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    CHECK(in::inspect(m).closed());
    CHECK(in::inspect(m).edges == 6);
    SECTION("a missing triangle leaves three edges open") {
        m.triangles.pop_back();
        CHECK(in::inspect(m).boundary_edges == 3);
        CHECK_FALSE(in::inspect(m).closed());
    }
    SECTION("a reversed triangle makes its three edges inconsistent") {
        std::swap(m.triangles[0].x, m.triangles[0].y);
        CHECK(in::inspect(m).inconsistent_edges == 3);
    }
    SECTION("a third triangle makes an edge inconsistent") {
        m.positions.push_back({5, 5, 5});
        m.triangles.push_back({0, 1, 4});
        CHECK(in::inspect(m).inconsistent_edges == 1);
        CHECK(in::inspect(m).boundary_edges == 2);
    }
    SECTION("a repeated corner is counted and left out; NaN equals nothing; -0 equals 0") {
        m.positions.push_back({-0.0f, 0, 0});
        m.triangles.push_back({0, 4, 1});
        CHECK(in::inspect(m).degenerate == 1);
        CHECK(in::inspect(m).closed());
        m.positions.push_back({not_a_number, 0, 0});
        m.positions.push_back({1e30f, 2e29f, 3e29f});
        m.triangles.insert(m.triangles.end(), {{0, 4, 5}, {1, 6, 1}, {6, 1, 1}});
        CHECK(in::inspect(m).degenerate == 4);
        CHECK(in::inspect(m).solid());
        CHECK(in::weld({{not_a_number, 0, 0}, {not_a_number, 0, 0}, {-0.0f, 1, 2}, {0.0f, 1, 2}}) ==
              std::vector<std::uint32_t>{0, 1, 2, 2});
    }
    SECTION("an inward-facing piece is closed, and makes the mesh not solid, beside or inside an outward-facing one") {
        const auto with = [&](float size, float away, bool is_turned) {
            in::mesh both = m;
            const auto corners = static_cast<std::uint32_t>(m.positions.size());
            for (const glm::vec3& p : m.positions) both.positions.push_back(size * p + glm::vec3(away));
            for (glm::uvec3 t : m.triangles) {
                if (is_turned) std::swap(t.x, t.y);
                both.triangles.push_back(t + corners);
            }
            return in::inspect(both);
        };
        CHECK(in::inspect(m).solid());
        for (const auto& [size, away] : {std::pair(1.0f, 9.0f), std::pair(0.1f, 0.1f)}) {
            CHECK(with(size, away, false).solid());
            CHECK(with(size, away, true).closed());
            CHECK(with(size, away, true).inward_components == 1);
            CHECK_FALSE(with(size, away, true).solid());
        }
        for (glm::vec3& p : m.positions) p.z = 0;  // flat, it has no inside
        CHECK(in::inspect(m).inward_components == 1);
    }
    SECTION("an empty mesh is not closed") {
        CHECK_FALSE(in::inspect(in::mesh{}).closed());
        CHECK_FALSE(in::inspect(in::mesh{}).solid());
    }
    SECTION("an index without a position is refused") {
        m.triangles.push_back({0, 1, 99});
        CHECK_THROWS_AS(in::inspect(m), in::invalid_input);
    }
}

TEST_CASE("Smooth normals weight by angle: a cube's corner points along the diagonal however its faces are cut") {
    in::mesh cube = to_mesh(in::cube{});
    const std::vector<std::uint32_t> first = in::weld(cube.positions);
    for (glm::uvec3& t : cube.triangles) t = {first[t.x], first[t.y], first[t.z]};
    const std::vector<glm::vec3> normals = in::smooth_normals(cube);
    for (const std::uint32_t i : first) {
        CHECK(glm::length(normals[i] - glm::normalize(cube.positions[i])) < 1e-6f);
    }
    in::mesh flat{.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {not_a_number, 0, 0}}, .normals = {}, .triangles = {}};
    flat.triangles = {{0, 1, 2}, {0, 1, 3}};
    for (const glm::vec3& n : in::smooth_normals(flat)) CHECK(n == glm::vec3(0, 0, 1));
}
