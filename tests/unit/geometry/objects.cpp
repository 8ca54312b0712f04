// Objects that sonars find: closed and solid over their parameters, of the stated size, deterministic in the seed.
#include <insonify/geometry/bounds.hpp>
#include <insonify/geometry/cube.hpp>
#include <insonify/geometry/objects/aeroplane.hpp>
#include <insonify/geometry/objects/boulder.hpp>
#include <insonify/geometry/objects/compound.hpp>
#include <insonify/geometry/objects/crate.hpp>
#include <insonify/geometry/objects/footprint.hpp>
#include <insonify/geometry/objects/hull.hpp>
#include <insonify/geometry/objects/lobster_pot.hpp>
#include <insonify/geometry/objects/open_pipe.hpp>
#include <insonify/geometry/objects/truncated_cone.hpp>
#include <insonify/geometry/objects/tyre.hpp>
#include <insonify/geometry/objects/wedge.hpp>
#include <insonify/geometry/sphere.hpp>
#include <insonify/geometry/topology.hpp>

#include <cmath>
#include <limits>

#include "../../catch.hpp"
#include "../../not_finite.hpp"

namespace in = insonify;

namespace {

using in::numeric::pi;

double area_of(const in::mesh& m, const glm::uvec3& t) {
    const glm::dvec3 a(m.positions[t.x]), b(m.positions[t.y]), c(m.positions[t.z]);
    const glm::dvec3 n = in::numeric::cross(b - a, c - a);
    return 0.5 * std::sqrt(in::numeric::dot(n, n));
}

/// By the divergence theorem; where pieces overlap it counts twice.
double volume_of(const in::mesh& m) {
    double sum = 0;
    for (const glm::uvec3& t : m.triangles)
        sum += in::numeric::dot(glm::dvec3(m.positions[t.x]),
                                in::numeric::cross(glm::dvec3(m.positions[t.y]), glm::dvec3(m.positions[t.z]))) /
               6;
    return sum;
}

void check_solid(const in::mesh& m) {
    const in::topology t = in::inspect(m);
    CHECK(t.degenerate == 0);
    CHECK(t.boundary_edges == 0);
    CHECK(t.inconsistent_edges == 0);
    CHECK(t.inward_components == 0);
    CHECK(t.solid());
    REQUIRE(m.normals.size() == m.positions.size());
    std::size_t flat = 0, wrong = 0;
    for (const glm::uvec3& triangle : m.triangles) flat += area_of(m, triangle) > 0 ? 0u : 1u;
    for (const glm::vec3& n : m.normals) wrong += std::fabs(in::numeric::dot(n, n) - 1) < 1e-5f ? 0u : 1u;
    CHECK(flat == 0);
    CHECK(wrong == 0);
}

void check_size(const in::mesh& m, const glm::dvec3& size, double tolerance = 1e-5) {
    const glm::dvec3 is = in::bounds(m).size();
    for (int i = 0; i < 3; ++i) CHECK(is[i] == Approx(size[i]).epsilon(tolerance));
}
void check_stands(const in::mesh& m) {
    const in::bounding_box b = in::bounds(m);
    CHECK(std::fabs(b.lower.z) <= 1e-6 * b.size().z);
}

template <class Shape>
bool is_same(const Shape& a, const Shape& b) {
    const in::mesh m = to_mesh(a), n = to_mesh(b);
    return m.positions == n.positions && m.normals == n.normals && m.triangles == n.triangles;
}

in::hull ship_of(float size) {
    return {.length = 45 * size,
            .beam = 8.2f * size,
            .depth = 4 * size,
            .bulwark = size,
            .plating = 0.12f * size,
            .mast_height = 9 * size};
}
in::aeroplane aeroplane_of(float size) {
    return {.length = 14.4f * size,
            .span = 20 * size,
            .fuselage_diameter = 1.7f * size,
            .root_chord = 3.7f * size,
            .tip_chord = 1.5f * size,
            .tail_span = 7.4f * size,
            .fin_height = 2.1f * size,
            .propeller_diameter = 3.4f * size};
}

}  // namespace

TEST_CASE("A truncated cone is solid, has its stated size, and is a frustum without its fittings") {
    for (const float size : {1e-3f, 1.0f, 1e3f})
        for (const int segments : {6, 7, 64})
            for (const float shoulder : {0.0f, 0.05f}) {
                CAPTURE(size, segments, shoulder);
                const in::mesh m = to_mesh(in::truncated_cone{.diameter = 0.98f * size,
                                                              .top_diameter = 0.52f * size,
                                                              .height = 0.47f * size,
                                                              .shoulder = shoulder * size,
                                                              .boss_diameter = 0.22f * size,
                                                              .boss_height = 0.04f * size,
                                                              .segments = segments});
                check_solid(m);
                check_stands(m);
            }
    check_size(to_mesh(in::truncated_cone{}), {0.98, 0.98, 0.47});
    const in::mesh plain = to_mesh(in::truncated_cone{
        .diameter = 2, .top_diameter = 1, .height = 1.5f, .shoulder = 0, .boss_height = 0, .lugs = 0, .segments = 512});
    check_solid(plain);
    CHECK(volume_of(plain) == Approx(pi / 12 * (4 + 2 + 1) * 1.5).epsilon(1e-4));
    CHECK(in::segments_for(in::truncated_cone{}, 0.001f) == in::segments_for(0.49f, 0.001f));
    // The counts of the documentation.
    const auto triangles = [](const in::truncated_cone& c) { return to_mesh(c).triangles.size(); };
    CHECK(triangles({.lugs = 0, .segments = 50}) == 16 * 50);
    CHECK(triangles({.shoulder = 0, .lugs = 0, .segments = 50}) == 8 * 50);
    CHECK(triangles({.boss_height = 0, .lugs = 0, .segments = 50}) == 12 * 50);
    CHECK(triangles({.lugs = 3, .segments = 50}) == 16 * 50 + 3 * 44);
    CHECK_THROWS_WITH(to_mesh(in::truncated_cone{.diameter = 0}), ContainsSubstring("truncated_cone.diameter is 0"));
    CHECK_THROWS_WITH(to_mesh(in::truncated_cone{.top_diameter = 2}),
                      ContainsSubstring("truncated_cone.top_diameter is 2"));
    CHECK_THROWS_WITH(to_mesh(in::truncated_cone{.height = not_a_number}), ContainsSubstring("truncated_cone.height"));
    CHECK_THROWS_WITH(to_mesh(in::truncated_cone{.shoulder = 1}), ContainsSubstring("truncated_cone.shoulder is 1"));
    CHECK_THROWS_WITH(to_mesh(in::truncated_cone{.boss_diameter = -1}), ContainsSubstring("boss_diameter is -1"));
    CHECK_THROWS_WITH(to_mesh(in::truncated_cone{.boss_height = 1}), ContainsSubstring("boss_height is 1"));
    CHECK_THROWS_WITH(to_mesh(in::truncated_cone{.lugs = 9}), ContainsSubstring("truncated_cone.lugs is 9"));
    CHECK_THROWS_WITH(to_mesh(in::truncated_cone{.segments = 5}), ContainsSubstring("truncated_cone.segments is 5"));
}

TEST_CASE("A wedge is solid, with its stated size and the volume of its sections") {
    for (const float size : {1e-3f, 1.0f, 1e4f}) {
        const in::wedge w{.length = 1.02f * size,
                          .width = 0.8f * size,
                          .height = 0.385f * size,
                          .nose_height = 0.06f * size,
                          .nose_width = 0.46f * size,
                          .tail_height = 0.2f * size,
                          .ridge = 0.2f * size};
        const in::mesh m = to_mesh(w);
        check_solid(m);
        check_stands(m);
        check_size(m, glm::dvec3(1.02, 0.8, 0.385) * static_cast<double>(size));
        // A section's area is a quadratic polynomial between two stations: Simpson's rule is exact.
        const auto area = [&](double half, double z) { return z * (2 * half - static_cast<double>(w.side_slope) * z); };
        double volume = 0;
        const auto stations = in::detail::stations_of(w);
        for (std::size_t i = 1; i < stations.size(); ++i) {
            const auto &a = stations[i - 1], &b = stations[i];
            volume +=
                (b.x - a.x) / 6 *
                (area(a.half_width, a.height) + 4 * area((a.half_width + b.half_width) / 2, (a.height + b.height) / 2) +
                 area(b.half_width, b.height));
        }
        CHECK(volume_of(m) == Approx(volume).epsilon(1e-5));
    }
    CHECK_THROWS_WITH(to_mesh(in::wedge{.length = -1}), ContainsSubstring("wedge.length is -1"));
    CHECK_THROWS_WITH(to_mesh(in::wedge{.width = 0}), ContainsSubstring("wedge.width is 0"));
    CHECK_THROWS_WITH(to_mesh(in::wedge{.height = not_a_number}), ContainsSubstring("wedge.height"));
    CHECK_THROWS_WITH(to_mesh(in::wedge{.nose_height = 1}), ContainsSubstring("wedge.nose_height is 1"));
    CHECK_THROWS_WITH(to_mesh(in::wedge{.nose_width = 2}), ContainsSubstring("wedge.nose_width is 2"));
    CHECK_THROWS_WITH(to_mesh(in::wedge{.tail_height = 2}), ContainsSubstring("wedge.tail_height is 2"));
    CHECK_THROWS_WITH(to_mesh(in::wedge{.ridge = 1}), ContainsSubstring("wedge.ridge is 1"));
    CHECK_THROWS_WITH(to_mesh(in::wedge{.side_slope = 5}), ContainsSubstring("wedge.side_slope is 5"));
}

TEST_CASE("A tyre is solid, with its stated size and the volume of Pappus' theorem") {
    for (const float size : {1e-2f, 1.0f, 1e3f})
        for (const int segments : {6, 33, 64})
            for (const float fill : {0.0f, 0.001f, 0.5f, 1.0f}) {
                CAPTURE(size, segments, fill);
                const in::mesh m = to_mesh(in::tyre{.diameter = 0.634f * size,
                                                    .width = 0.195f * size,
                                                    .rim_diameter = 0.381f * size,
                                                    .wall = 0.015f * size,
                                                    .fill = fill,
                                                    .segments = segments});
                check_solid(m);
                check_stands(m);
            }
    const in::tyre t{.segments = 256};
    const in::mesh m = to_mesh(t);
    check_size(m, {0.634, 0.634, 0.195});
    // Half a superellipse of exponent n and semi-axes a, b, its flat side at the radius r: turned about the axis it
    // encloses pi times the integral of (r + x(z))^2 - r^2 over z.
    const auto turned = [](double r, double a, double b) {
        double sum = 0;
        const int steps = 200000;
        for (int i = 0; i < steps; ++i) {
            const double z = (i + 0.5) / steps, x = a * std::pow(1 - std::pow(z, 3.2), 1 / 3.2);
            sum += ((r + x) * (r + x) - r * r) / steps;
        }
        return 2 * b * pi * sum;
    };
    const double volume = turned(0.1905, 0.1265, 0.0975) - turned(0.1905, 0.1115, 0.0825);
    CHECK(volume_of(m) == Approx(volume).epsilon(0.01));
    CHECK_THROWS_WITH(to_mesh(in::tyre{.diameter = 0}), ContainsSubstring("tyre.diameter is 0"));
    CHECK_THROWS_WITH(to_mesh(in::tyre{.width = -1}), ContainsSubstring("tyre.width is -1"));
    CHECK_THROWS_WITH(to_mesh(in::tyre{.rim_diameter = 1}), ContainsSubstring("tyre.rim_diameter is 1"));
    CHECK_THROWS_WITH(to_mesh(in::tyre{.wall = 1}), ContainsSubstring("tyre.wall is 1"));
    CHECK_THROWS_WITH(to_mesh(in::tyre{.fill = 2}), ContainsSubstring("tyre.fill is 2"));
    CHECK_THROWS_WITH(to_mesh(in::tyre{.segments = 3}), ContainsSubstring("tyre.segments is 3"));
}

TEST_CASE("A pipe is solid, with its stated size and the volume of its wall") {
    for (const float length : {0.01f, 12.0f, 1000.0f})
        for (const int segments : {6, 48})
            for (const float flange : {0.0f, 0.2f})
                for (const float broken : {0.0f, 0.5f}) {
                    CAPTURE(length, segments, flange, broken);
                    const in::mesh m = to_mesh(in::open_pipe{.diameter = 0.1f * length,
                                                             .length = length,
                                                             .wall = 0.01f * length,
                                                             .flange = 0.1f * flange * length,
                                                             .broken = broken * length,
                                                             .segments = segments});
                    check_solid(m);
                    const in::topology t = in::inspect(m);
                    CHECK(t.euler_characteristic() == 0);  // one hole, from end to end
                }
    const in::mesh m = to_mesh(in::open_pipe{.segments = 512});
    check_size(m, {12, 0.71, 0.71});
    CHECK(volume_of(m) == Approx(pi * 12 * (0.355 * 0.355 - 0.29 * 0.29)).epsilon(1e-4));
    check_size(to_mesh(in::open_pipe{.flange = 0.1f}), {12, 0.91, 0.91});
    CHECK(is_same(in::open_pipe{.broken = 2, .seed = 3}, in::open_pipe{.broken = 2, .seed = 3}));
    CHECK_FALSE(is_same(in::open_pipe{.broken = 2, .seed = 3}, in::open_pipe{.broken = 2, .seed = 4}));
    CHECK(in::segments_for(in::open_pipe{}, 0.001f) == in::segments_for(0.355f, 0.001f));
    CHECK_THROWS_WITH(in::segments_for(in::open_pipe{}, 1e-9f), ContainsSubstring("8192 segments"));
    CHECK_THROWS_WITH(to_mesh(in::open_pipe{.diameter = 0}), ContainsSubstring("open_pipe.diameter is 0"));
    CHECK_THROWS_WITH(to_mesh(in::open_pipe{.length = not_a_number}), ContainsSubstring("open_pipe.length"));
    CHECK_THROWS_WITH(to_mesh(in::open_pipe{.wall = 0.4f}), ContainsSubstring("open_pipe.wall is 0.4"));
    CHECK_THROWS_WITH(to_mesh(in::open_pipe{.flange = 1}), ContainsSubstring("open_pipe.flange is 1"));
    CHECK_THROWS_WITH(to_mesh(in::open_pipe{.broken = 7}), ContainsSubstring("open_pipe.broken is 7"));
    CHECK_THROWS_WITH(to_mesh(in::open_pipe{.segments = 2}), ContainsSubstring("open_pipe.segments is 2"));
}

TEST_CASE("A boulder is solid, fills its box, and depends on its seed alone") {
    for (const glm::vec3 size : {glm::vec3(1.2f, 1, 0.75f), glm::vec3(1e-3f), glm::vec3(1e4f, 1e3f, 100)})
        for (const float angularity : {0.0f, 0.5f, 1.0f})
            for (const float roughness : {0.0f, 1.0f})
                for (const int segments : {2, 3, 20}) {
                    CAPTURE(size.x, angularity, roughness, segments);
                    const in::mesh m = to_mesh(in::boulder{.size = size,
                                                           .angularity = angularity,
                                                           .roughness = roughness,
                                                           .segments = segments,
                                                           .seed = 9});
                    check_solid(m);
                    check_stands(m);
                    check_size(m, glm::dvec3(size));
                    CHECK(m.triangles.size() == static_cast<std::size_t>(8 * segments * segments));
                    CHECK(in::inspect(m).euler_characteristic() == 2);
                }
    // A smooth, round one is an ellipsoid.
    const in::mesh smooth = to_mesh(in::boulder{.size = {2, 1, 1}, .angularity = 0, .roughness = 0, .segments = 64});
    CHECK(volume_of(smooth) == Approx(pi / 6 * 2).epsilon(1e-3));
    CHECK(is_same(in::boulder{.seed = 5}, in::boulder{.seed = 5}));
    CHECK_FALSE(is_same(in::boulder{.seed = 5}, in::boulder{.seed = 6}));
    CHECK_THROWS_WITH(to_mesh(in::boulder{.size = {1, 0, 1}}), ContainsSubstring("boulder.size is 0"));
    CHECK_THROWS_WITH(to_mesh(in::boulder{.size = {1000, 1, 1}}), ContainsSubstring("boulder.size is 1"));
    CHECK_THROWS_WITH(to_mesh(in::boulder{.angularity = 2}), ContainsSubstring("boulder.angularity is 2"));
    CHECK_THROWS_WITH(to_mesh(in::boulder{.roughness = -1}), ContainsSubstring("boulder.roughness is -1"));
    CHECK_THROWS_WITH(to_mesh(in::boulder{.segments = 1}), ContainsSubstring("boulder.segments is 1"));
}

TEST_CASE("A crate is solid, with its stated size, and loses boards with damage") {
    for (const float size : {1e-2f, 1.0f, 1e3f})
        for (const int boards : {1, 5, 20})
            for (const float damage : {0.0f, 0.3f, 1.0f})
                for (const bool is_open : {false, true}) {
                    CAPTURE(size, boards, damage, is_open);
                    const in::mesh m = to_mesh(in::crate{.size = size * glm::vec3(1.2f, 0.8f, 0.8f),
                                                         .board = 0.025f * size,
                                                         .boards = boards,
                                                         .is_open = is_open,
                                                         .damage = damage});
                    check_solid(m);
                    // Of a crate that has lost all boards, the floor and the posts are left.
                    const auto left = static_cast<std::size_t>(12 * (boards + 4)), all = left * 6;
                    if (damage == 1) CHECK(m.triangles.size() == left);
                    if (damage > 0 && damage < 1 && boards == 20)
                        CHECK((m.triangles.size() > left && m.triangles.size() < all));
                    if (damage == 0) {
                        check_stands(m);
                        check_size(m, static_cast<double>(size) * glm::dvec3(1.2, 0.8, 0.8));
                        CHECK(m.triangles.size() == static_cast<std::size_t>(12 * ((is_open ? 5 : 6) * boards + 4)));
                    }
                }
    // Boards without gaps of note make a hollow box; posts stand in its corners.
    const in::mesh m = to_mesh(in::crate{.size = glm::vec3(1), .board = 0.02f, .gap = 0.01f});
    const double walls = 1 - std::pow(0.96, 3), posts = 4 * std::pow(0.02 * 3, 2);
    CHECK(volume_of(m) == Approx(walls + posts).epsilon(0.06));
    CHECK(is_same(in::crate{.damage = 0.5f, .seed = 7}, in::crate{.damage = 0.5f, .seed = 7}));
    CHECK_FALSE(is_same(in::crate{.damage = 0.5f, .seed = 7}, in::crate{.damage = 0.5f, .seed = 8}));
    // Boards lower than a tenth of their thickness.
    const in::mesh thin = to_mesh(in::crate{.board = 0.08f, .boards = 64, .gap = 0.9f});
    for (const glm::vec3& p : thin.positions) CHECK((p.z >= 0 && p.z <= in::crate{}.size.z));
    CHECK_THROWS_WITH(to_mesh(in::crate{.size = {1, 1, -1}}), ContainsSubstring("crate.size is -1"));
    CHECK_THROWS_WITH(to_mesh(in::crate{.board = 0.2f}), ContainsSubstring("crate.board is 0.2"));
    CHECK_THROWS_WITH(to_mesh(in::crate{.boards = 0}), ContainsSubstring("crate.boards is 0"));
    CHECK_THROWS_WITH(to_mesh(in::crate{.gap = 1}), ContainsSubstring("crate.gap is 1"));
    CHECK_THROWS_WITH(to_mesh(in::crate{.damage = not_a_number}), ContainsSubstring("crate.damage"));
}

TEST_CASE("A lobster pot is solid, with its stated size to within a bar's thickness") {
    for (const float size : {1e-2f, 1.0f, 1e3f})
        for (const int hoops : {2, 3, 4, 16})
            for (const float mesh_size : {0.0f, 0.07f, 0.3f})
                for (const float crushed : {0.0f, 0.5f, 1.0f})
                    for (const int segments : {6, 12}) {
                        CAPTURE(size, hoops, mesh_size, crushed, segments);
                        const in::mesh m = to_mesh(in::lobster_pot{.length = 0.91f * size,
                                                                   .width = 0.56f * size,
                                                                   .height = 0.41f * size,
                                                                   .bar = 0.016f * size,
                                                                   .hoops = hoops,
                                                                   .mesh_size = mesh_size * size,
                                                                   .twine = 0.005f * size,
                                                                   .crushed = crushed,
                                                                   .segments = segments});
                        check_solid(m);
                        check_stands(m);
                        const glm::dvec3 is = in::bounds(m).size() / static_cast<double>(size);
                        CHECK(is.x == Approx(0.91));
                        CHECK(is.z <= 0.411);
                        if (crushed == 0) {
                            CHECK(is.y == Approx(0.56).margin(0.016));
                            CHECK(is.z == Approx(0.41).margin(0.016));
                        }
                    }
    check_solid(
        to_mesh(in::lobster_pot{.length = 0.4f, .width = 0.56f, .height = 0.41f, .bar = 0.05f}));  // the thickest
    CHECK_THROWS_WITH(to_mesh(in::lobster_pot{.length = 0}), ContainsSubstring("lobster_pot.length is 0"));
    CHECK_THROWS_WITH(to_mesh(in::lobster_pot{.width = -2}), ContainsSubstring("lobster_pot.width is -2"));
    CHECK_THROWS_WITH(to_mesh(in::lobster_pot{.height = not_a_number}), ContainsSubstring("lobster_pot.height"));
    CHECK_THROWS_WITH(to_mesh(in::lobster_pot{.bar = 1}), ContainsSubstring("lobster_pot.bar is 1"));
    CHECK_THROWS_WITH(to_mesh(in::lobster_pot{.hoops = 1}), ContainsSubstring("lobster_pot.hoops is 1"));
    CHECK_THROWS_WITH(to_mesh(in::lobster_pot{.mesh_size = 0.001f}), ContainsSubstring("lobster_pot.mesh_size"));
    CHECK_THROWS_WITH(to_mesh(in::lobster_pot{.twine = 0.1f}), ContainsSubstring("lobster_pot.twine is 0.1"));
    CHECK_THROWS_WITH(to_mesh(in::lobster_pot{.crushed = 3}), ContainsSubstring("lobster_pot.crushed is 3"));
    CHECK_THROWS_WITH(to_mesh(in::lobster_pot{.segments = 4}), ContainsSubstring("lobster_pot.segments is 4"));
}

TEST_CASE("A hull is solid, with its stated length and beam") {
    for (const float size : {1e-2f, 1.0f, 1e3f})
        for (const in::stern_type stern : {in::stern_type::cruiser, in::stern_type::transom})
            for (const int hatches : {0, 1, 3, 8})
                for (const int segments : {16, 64}) {
                    CAPTURE(size, hatches, segments);
                    in::hull h = ship_of(size);
                    h.stern = stern;
                    h.hatches = hatches;
                    h.segments = segments;
                    const in::mesh m = to_mesh(h);
                    check_solid(m);
                    check_stands(m);
                    const glm::dvec3 is = in::bounds(m).size() / static_cast<double>(size);
                    CHECK(is.x == Approx(45));
                    CHECK(is.y == Approx(8.2));
                    CHECK(is.z == Approx(9 + 4).epsilon(0.2));  // the foremast, on the sheer
                }
    // Optional parts left out, and the limits of the shape.
    for (const float house : {0.0f, 0.1f, 0.5f})
        for (const float position : {-0.35f, 0.0f, 0.3f})
            for (const int tiers : {1, 4})
                for (const int masts : {0, 4}) {
                    CAPTURE(house, position, tiers, masts);
                    in::hull h;
                    h.house_length = house;
                    h.house_position = position;
                    h.house_tiers = tiers;
                    h.masts = masts;
                    h.has_funnel = masts == 0;
                    check_solid(to_mesh(h));
                }
    for (const float beam : {3.0f, 20.0f})
        for (const float ratio : {0.21f, 1.9f})
            for (const float sheer : {0.0f, 4.0f}) {
                CAPTURE(beam, ratio, sheer);
                check_solid(to_mesh(in::hull{.beam = beam, .depth = ratio * beam, .bulwark = 0, .sheer = sheer}));
            }
    // The shell encloses some half to two thirds of its box (the block coefficient of coasters), and is itself thin.
    const in::compound parts = to_compound(in::hull{});
    CHECK(parts.parts.size() == 4);
    CHECK(volume_of(parts.parts[0].shape) > 45 * 4 * 0.12);
    CHECK(volume_of(parts.parts[0].shape) < 0.3 * 45 * 8.2 * 4);
}

TEST_CASE("Sizes of a hull and of an aeroplane that are not given keep its proportions") {
    for (const float size : {0.0625f, 0.5f, 2.0f}) {
        CHECK(is_same(in::hull{.length = 45 * size}, ship_of(size)));
        CHECK(is_same(in::aeroplane{.length = 14.4f * size}, aeroplane_of(size)));
    }
    CHECK(is_same(in::hull{.beam = 16.4f}, in::hull{.beam = 16.4f, .depth = 8}));
    check_solid(to_mesh(in::hull{.length = 5, .beam = 1.8f, .depth = 0.9f}));
}

TEST_CASE("A hull stays solid while it collapses and breaks, and sinks lower") {
    double height = 1e9;
    for (const float collapse : {0.0f, 0.01f, 0.3f, 0.5f, 0.8f, 1.0f}) {
        for (const float gap : {0.0f, 4.0f})
            for (const float position : {-0.4f, 0.1f, 0.4f}) {
                CAPTURE(collapse, gap, position);
                in::hull h;
                h.collapse = collapse;
                h.break_gap = gap;
                h.break_position = position;
                check_solid(to_mesh(h));
            }
        const in::mesh shell = to_compound(in::hull{.collapse = collapse}).parts[0].shape;
        CHECK(in::bounds(shell).size().z < height);
        height = in::bounds(shell).size().z;
    }
    CHECK(height < 0.75 * in::bounds(to_compound(in::hull{}).parts[0].shape).size().z);
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u, 6u})
        check_solid(to_mesh(in::hull{.collapse = 0.6f, .seed = seed}));
    CHECK(is_same(in::hull{.collapse = 0.6f, .seed = 7}, in::hull{.collapse = 0.6f, .seed = 7}));
    CHECK_FALSE(is_same(in::hull{.collapse = 0.6f, .seed = 7}, in::hull{.collapse = 0.6f, .seed = 8}));
    // The halves of one that broke straight apart are the gap farther from end to end, but for the torn edges.
    const in::mesh broken = to_mesh(in::hull{.break_gap = 6, .break_yaw = 0, .break_roll = 0});
    CHECK(in::bounds(broken).size().x == Approx(51));
    // However the bow half rolls, it does not sink into the bottom.
    for (const float roll : {-1.5f, -0.3f, 0.6f})
        check_stands(to_mesh(in::hull{.has_funnel = false, .masts = 0, .break_gap = 6, .break_roll = roll}));
}

TEST_CASE("A hull refuses parameters out of range by name and value") {
    const auto check = [](const in::hull& h, const char* text) {
        CHECK_THROWS_WITH(to_mesh(h), ContainsSubstring(text));
    };
    check({.length = 0}, "hull.length is 0");
    check({.length = not_a_number}, "hull.length");
    check({.beam = 40}, "hull.beam is 40");
    check({.depth = 1}, "hull.depth is 1");
    check({.bulwark = -1}, "hull.bulwark is -1");
    check({.sheer = 5}, "hull.sheer is 5");
    check({.stern = static_cast<in::stern_type>(7)}, "hull.stern is 7");
    check({.plating = 2}, "hull.plating is 2");
    check({.house_length = 0.8f}, "hull.house_length is 0.8");
    check({.house_position = 0.5f}, "hull.house_position is 0.5");
    check({.house_tiers = 0}, "hull.house_tiers is 0");
    check({.hatches = 9}, "hull.hatches is 9");
    check({.masts = -1}, "hull.masts is -1");
    check({.mast_height = 50}, "hull.mast_height is 50");
    check({.break_gap = -2}, "hull.break_gap is -2");
    check({.break_position = 0.5f}, "hull.break_position is 0.5");
    check({.break_yaw = 2}, "hull.break_yaw is 2");
    check({.break_roll = 2}, "hull.break_roll is 2");
    check({.collapse = 1.5f}, "hull.collapse is 1.5");
    check({.segments = 8}, "hull.segments is 8");
}

TEST_CASE("An aeroplane is solid, with its stated length and span") {
    for (const float size : {1e-2f, 1.0f, 1e3f})
        for (const int engines : {0, 1, 2, 3, 4})
            for (const int segments : {8, 24})
                for (const bool is_inverted : {false, true}) {
                    CAPTURE(size, engines, segments, is_inverted);
                    in::aeroplane a = aeroplane_of(size);
                    a.engines = engines;
                    a.segments = segments;
                    a.is_inverted = is_inverted;
                    const in::mesh m = to_mesh(a);
                    check_solid(m);
                    check_stands(m);
                    const glm::dvec3 is = in::bounds(m).size() / static_cast<double>(size);
                    CHECK(is.x == Approx(14.4).epsilon(1e-3));
                    CHECK(is.y == Approx(20).epsilon(1e-3));
                }
    // A fuselage is some two thirds of the cylinder around it.
    const in::mesh fuselage = to_compound(in::aeroplane{.engines = 0}).parts[0].shape;
    const double cylinder = 14.4 * pi / 4 * 1.7 * 1.7;
    CHECK(volume_of(fuselage) > 0.4 * cylinder);
    CHECK(volume_of(fuselage) < cylinder);
}

TEST_CASE("An aeroplane of any span has a tailplane that reaches out of its fuselage by default") {
    for (const float span : {3.6f, 4.0f, 5.5f, 14.4f, 57.6f}) {
        const in::aeroplane a{.span = span};
        CAPTURE(span);
        CHECK(a.tail_span == (std::max)(0.37f * span, 1.2f * a.fuselage_diameter));
        CHECK_NOTHROW(validate(a));
    }
    check_solid(to_mesh(in::aeroplane{.span = 3.6f}));
}

TEST_CASE("An aeroplane stays solid without its wings and tail") {
    for (const float left : {0.0f, 0.01f, 0.3f, 0.97f, 0.999f})
        for (const float torn : {0.0f, 3.0f})
            for (const float gap : {0.0f, 2.0f}) {
                CAPTURE(left, torn, gap);
                const in::mesh m =
                    to_mesh(in::aeroplane{.port_wing = left, .torn_off = torn, .tail_gap = gap, .seed = 2});
                check_solid(m);
                if (torn == 0 && left < 0.2f) CHECK(in::bounds(m).size().y < 15);
            }
    check_solid(to_mesh(in::aeroplane{.port_wing = 0, .starboard_wing = 0, .torn_off = 0, .is_inverted = true}));
    CHECK(is_same(in::aeroplane{.port_wing = 0.5f, .seed = 7}, in::aeroplane{.port_wing = 0.5f, .seed = 7}));
    CHECK_FALSE(is_same(in::aeroplane{.port_wing = 0.5f, .seed = 7}, in::aeroplane{.port_wing = 0.5f, .seed = 8}));

    const auto check = [](const in::aeroplane& a, const char* text) {
        CHECK_THROWS_WITH(to_mesh(a), ContainsSubstring(text));
    };
    check({.length = 0}, "aeroplane.length is 0");
    check({.span = 1}, "aeroplane.span is 1");
    check({.fuselage_diameter = 9}, "aeroplane.fuselage_diameter is 9");
    check({.root_chord = 0.1f}, "aeroplane.root_chord is 0.1");
    check({.tip_chord = 4}, "aeroplane.tip_chord is 4");
    check({.sweep = 1}, "aeroplane.sweep is 1");
    check({.dihedral = 1}, "aeroplane.dihedral is 1");
    check({.wing_position = 0.5f}, "aeroplane.wing_position is 0.5");
    check({.tail_span = 30}, "aeroplane.tail_span is 30");
    check({.fin_height = 0}, "aeroplane.fin_height is 0");
    check({.engines = 5}, "aeroplane.engines is 5");
    check({.propeller_diameter = -1}, "aeroplane.propeller_diameter is -1");
    check({.port_wing = not_a_number}, "aeroplane.port_wing");
    check({.starboard_wing = 2}, "aeroplane.starboard_wing is 2");
    check({.torn_off = -1}, "aeroplane.torn_off is -1");
    check({.tail_gap = -1}, "aeroplane.tail_gap is -1");
    check({.tail_yaw = 3}, "aeroplane.tail_yaw is 3");
    check({.segments = 4}, "aeroplane.segments is 4");
}

TEST_CASE("A compound is one mesh with the part of each triangle") {
    in::compound c;
    c.add(in::cube{}, {.position = {0, 0, 0.5}}, 0.4f)
        .add(in::sphere{.segments = 16}, {.position = {3, 0, 1}, .scale = 2});
    c.add(to_mesh(in::boulder{}), {.yaw = 1});
    const in::merged_compound m = merge(c);
    check_solid(m.shape);
    CHECK(m.reflectivities == std::vector<float>{0.4f, 1, 1});
    REQUIRE(m.part_ids.size() == m.shape.triangles.size());
    for (std::size_t t = 0; t < m.part_ids.size(); ++t) {
        const float x = m.shape.positions[m.shape.triangles[t].x].x;
        CHECK((m.part_ids[t] == 1) == (x > 1));
        if (t < 12) CHECK(m.part_ids[t] == 0);
    }
    CHECK(in::bounds(m.shape).upper == glm::dvec3(4, in::bounds(m.shape).upper.y, 2));
    CHECK(merge(in::compound{}).shape.triangles.empty());

    // Without normals in one part there are none at all.
    c.parts[0].shape.normals.clear();
    CHECK(to_mesh(c).normals.empty());
    CHECK_THROWS_WITH(merge(in::compound{{{{}, {}, -1}}}), ContainsSubstring("compound_part.reflectivity is -1"));
}

TEST_CASE("with_creases() is smooth across gentle bends and sharp across edges") {
    in::mesh box = to_mesh(in::cube{});
    box.normals.clear();
    const in::mesh sharp = in::with_creases(box);
    CHECK(sharp.positions.size() == 24);
    for (const glm::vec3& n : sharp.normals) CHECK(std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z) == Approx(1));
    const in::mesh round = in::with_creases(box, 2);  // 90 degrees are less than 2 radians
    CHECK(round.positions.size() == 8);
    for (const glm::vec3& n : round.normals) CHECK(std::fabs(n.x) == Approx(std::sqrt(1.0f / 3)));
    const in::mesh ball = in::with_creases(to_mesh(in::sphere{.segments = 64}));
    for (std::size_t i = 0; i < ball.positions.size(); ++i)
        CHECK(in::numeric::dot(ball.normals[i], ball.positions[i]) == Approx(0.5f).epsilon(0.001));
    CHECK_THROWS_AS(in::with_creases({{}, {}, {{0, 1, 2}}}), in::invalid_input);
    for (const float angle : {-0.1f, 3.2f, 1e20f, std::numeric_limits<float>::quiet_NaN()})
        CHECK_THROWS_WITH(in::with_creases(box, angle), ContainsSubstring("angle is "));
}

TEST_CASE("with_creases() keeps triangles without area or with NaN out of their neighbours' normals") {
    in::mesh m{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {0, 0, std::numeric_limits<float>::quiet_NaN()}},
               {},
               {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
    std::swap(m.triangles[0].y, m.triangles[0].z);  // the first one faces downwards
    const in::mesh smooth = in::with_creases(m, 3);
    for (int i = 0; i < 3; ++i) {
        CHECK(smooth.normals[smooth.triangles[0][i]] == glm::vec3(0, 0, -1));
        CHECK(smooth.normals[smooth.triangles[1][i]] == glm::vec3(0, 0, 1));
        CHECK(smooth.normals[smooth.triangles[2][i]] == glm::vec3(0, 0, 1));
    }
}

TEST_CASE("footprint() is the convex outline of the lowest vertices") {
    const in::mesh box = to_mesh(in::cube{.size = {2, 1, 1}});
    const auto corners = in::footprint(box, {.position = {10, 5, 3}}, 0.1f);
    REQUIRE(corners.size() == 4);
    double area = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec2 a = corners[i], b = corners[(i + 1) % 4];
        area += 0.5 * (a.x * b.y - a.y * b.x);
        CHECK(std::fabs(a.x - 10) == Approx(1));
        CHECK(std::fabs(a.y - 5) == Approx(0.5));
    }
    CHECK(area == Approx(2));  // positive: counter-clockwise
    // A cone's tip does not widen it; with all of its height nothing changes.
    CHECK(in::footprint(to_mesh(in::truncated_cone{.lugs = 0}), {}, 0).size() == 64);
    CHECK(in::footprint({}, {}, 1).empty());
    CHECK_THROWS_AS(in::footprint(box, {}, -1), in::invalid_input);
    // Vertices that are not finite do not count.
    in::mesh torn = box;
    for (const float value : {std::numeric_limits<float>::infinity(), std::nanf("")})
        for (const float sign : {1.0f, -1.0f})
            for (int axis = 0; axis < 3; ++axis) {
                torn.positions.push_back(box.positions[0]);
                torn.positions.back()[axis] = sign * value;
            }
    CHECK(in::footprint(torn, {.position = {10, 5, 3}}, 0.1f) == corners);
}
