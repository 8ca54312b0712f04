// The fewest segments within a chord error: measured on the facets, against the sagitta of a circle.
#include <insonify/geometry/cone.hpp>
#include <insonify/geometry/cylinder.hpp>
#include <insonify/geometry/objects/tyre.hpp>
#include <insonify/geometry/sphere.hpp>

#include <cmath>

#include "../../catch.hpp"

namespace in = insonify;

namespace {

using in::numeric::pi;

/// Largest deviation of a mesh's facets from a ball of the given radius around the origin.
double deviation_from_ball(const in::mesh& m, double radius, double lowest) {
    double nearest = radius;
    for (const glm::uvec3& t : m.triangles) {
        const glm::dvec3 a(m.positions[t.x]), b(m.positions[t.y]), c(m.positions[t.z]);
        if (a.z < lowest && b.z < lowest && c.z < lowest) continue;  // a flat base
        const glm::dvec3 normal = in::numeric::cross(b - a, c - a);
        const double length = std::sqrt(in::numeric::dot(normal, normal));
        if (length > 0) nearest = std::min(nearest, std::abs(in::numeric::dot(normal, a)) / length);
    }
    return radius - nearest;
}

double sagitta(double radius, int segments) {
    return radius * (1 - std::cos(pi / segments));
}

}  // namespace

TEST_CASE("Cylinders and cones get the fewest segments whose sagitta is within the deviation") {
    for (const double radius : {0.05, 0.25, 1.0, 40.0})
        for (const double deviation : {0.0001, 0.0017, 0.02, 0.11}) {
            CAPTURE(radius, deviation);
            const auto r = static_cast<float>(radius), d = static_cast<float>(deviation);
            const int around = in::segments_for(in::cylinder{.radius = r}, d);
            CHECK(in::segments_for(in::cone{.radius = r}, d) == around);
            CHECK(in::segments_for(in::cone{.radius = r / 2, .top_radius = r}, d) == around);
            const int tread = in::segments_for(in::tyre{.diameter = 2 * r}, d);
            CHECK(sagitta(static_cast<double>(r), tread) <= static_cast<double>(d) * (1 + 1e-9));
            if (around == 3) continue;
            CHECK(sagitta(static_cast<double>(r), around) <= static_cast<double>(d) * (1 + 1e-9));
            CHECK(sagitta(static_cast<double>(r), around - 1) > static_cast<double>(d));
        }
}

TEST_CASE("Balls get the fewest segments whose facets are within the deviation") {
    for (const double deviation : {0.2, 0.05, 0.02, 0.007, 0.0021, 0.0009}) {
        CAPTURE(deviation);
        const auto d = static_cast<float>(deviation);
        in::sphere ball{.radius = 0.5f};
        ball.segments = in::segments_for(ball, d);
        CHECK(deviation_from_ball(to_mesh(ball), 0.5, -1) <= deviation + 1e-6);
        REQUIRE(ball.segments > 3);
        --ball.segments;
        CHECK(deviation_from_ball(to_mesh(ball), 0.5, -1) > deviation - 1e-6);

        in::hemisphere half{.radius = 0.5f};
        half.segments = in::segments_for(half, d);
        CHECK(deviation_from_ball(to_mesh(half), 0.5, 1e-6) <= deviation + 1e-6);
        --half.segments;
        CHECK(deviation_from_ball(to_mesh(half), 0.5, 1e-6) > deviation - 1e-6);

        // A capsule with nothing between its ends is a ball along x.
        in::capsule round{.radius = 0.5f, .length = 1};
        round.segments = in::segments_for(round, d);
        CHECK(deviation_from_ball(to_mesh(round), 0.5, -1) <= deviation + 1e-6);
        --round.segments;
        CHECK(deviation_from_ball(to_mesh(round), 0.5, -1) > deviation - 1e-6);
    }
}

TEST_CASE("Stretched spheres take the segments of their longest axis, and unreachable errors are refused") {
    const float d = 0.004f;
    CHECK(in::segments_for(in::sphere{.radius = 0.25f, .aspect = {1, 4, 1}}, d) ==
          in::segments_for(in::sphere{.radius = 1}, d));
    CHECK(in::segments_for(in::hemisphere{.radius = 0.5f, .aspect = {1, 1, 2}}, d) ==
          in::segments_for(in::hemisphere{.radius = 1}, d));
    CHECK(in::segments_for(in::sphere{.radius = 0.01f}, 1.0f) == 3);
    CHECK_THROWS_AS(in::segments_for(in::sphere{.radius = 1e3f}, 1e-6f), in::invalid_input);
    CHECK_THROWS_AS(in::segments_for(in::sphere{}, 0.0f), in::invalid_input);
}
