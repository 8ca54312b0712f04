// The resolution law of shadow maps, measured (docs/accuracy.md, "Shadow maps"): on ground that rises by `a` per metre
// along the light, the edge of a shadow is off by at most T / (2 (1 + a cot(elevation))) and by half of that on
// average, for texels of T metres; and a map of ground L x W with relief H has (L + H cot(elevation)) / T by W / T
// texels.
#include <insonify/core/random.hpp>
#include <insonify/geometry/bounds.hpp>
#include <insonify/shadow/map_lookup.hpp>

#include <cmath>

#include "../../catch.hpp"
#include "lit_mesh.hpp"

namespace in = insonify;
namespace shadow = insonify::shadow;

namespace {

using lit::radians;

struct displacement {
    double mean = 0, largest = 0;
};

/// Displacement of the end of the shadow that a level plate casts on a plane through the origin, which rises by `slope`
/// along the light: metres on the ground along the light, over many positions of the plate relative to the texels.
displacement measured(double elevation, double azimuth, double slope, double texel) {
    const shadow::light_frame light({azimuth, elevation});
    const glm::dvec2 travel = light.travel();
    const double cot = light.cot_elevation();
    in::random_sequence draw(11);
    displacement found;
    constexpr int times = 400;
    for (int i = 0; i < times; ++i) {
        // The plate's rim lies across the light at the height 1, a metre of it on either side of the light's plane.
        const double rim = 3 * draw.uniform();
        in::mesh plate;
        for (const double back : {-1.0, 0.0})
            for (const double side : {-1.0, 1.0})
                plate.positions.emplace_back((rim + back) * travel.x - side * travel.y,
                                             (rim + back) * travel.y + side * travel.x, 1);
        plate.triangles = {{0, 2, 3}, {0, 3, 1}};
        in::bounding_box extent = shadow::extent_of(in::bounds(plate), {}, light);
        const double start = 5 * texel * draw.uniform();
        extent.lower -= glm::dvec3(start, start, 0);
        shadow::height_map map(light, extent, texel, 32768);
        map.cast(plate, {});

        const auto is_lit = [&](double along) {
            const glm::dvec3 ground(along * travel.x, along * travel.y, along * slope);
            const glm::dvec3 normal(-slope * travel.x, -slope * travel.y, 1);
            return shadow::lit(map, shadow::receiver_plane(light, ground, normal), 0) == 1;
        };
        const double truth = (rim + cot) / (1 + slope * cot);
        double dark = truth - 3 * texel, lit = truth + 3 * texel;
        if (is_lit(dark) || !is_lit(lit)) {
            FAIL_CHECK("no edge at " << truth);
            continue;
        }
        for (int k = 0; k < 40; ++k) (is_lit(0.5 * (dark + lit)) ? lit : dark) = 0.5 * (dark + lit);
        const double off = std::abs(0.5 * (dark + lit) - truth);
        found.mean += off / times;
        found.largest = std::max(found.largest, off);
    }
    return found;
}

}  // namespace

TEST_CASE("An edge on level ground is off by half a texel at most and a quarter on average, at every elevation") {
    constexpr double texel = 0.02;
    for (const double elevation : {1.0, 3.0, 6.0, 20.0, 45.0, 70.0, 89.0}) {
        CAPTURE(elevation);
        const auto off = measured(radians(elevation), 0, 0, texel);
        CHECK(off.largest <= 0.5 * texel * 1.01);
        CHECK(off.largest >= 0.45 * texel);
        CHECK(off.mean == Approx(0.25 * texel).epsilon(0.1));
    }
}

TEST_CASE("The error of an edge does not depend on the light's azimuth") {
    constexpr double texel = 0.02;
    for (const double azimuth : {23.7, 45.0, 90.0, 200.0}) {
        const auto off = measured(radians(6), radians(azimuth), 0, texel);
        CHECK(off.largest <= 0.5 * texel * 1.01);
        CHECK(off.mean == Approx(0.25 * texel).epsilon(0.1));
    }
}

TEST_CASE("On slopes that face the light edges are sharper; on slopes that fall away their error grows without bound") {
    constexpr double texel = 0.02;
    const double elevation = radians(6), tangent = std::tan(elevation);
    for (const double ratio : {2.0, 1.0, 0.5, -0.3, -0.6}) {
        const double slope = ratio * tangent;
        CAPTURE(slope);
        const double on_ground = texel / (1 + slope / tangent);
        const auto off = measured(elevation, 0, slope, texel);
        CHECK(off.largest <= 0.5 * on_ground * 1.01);
        CHECK(off.mean == Approx(0.25 * on_ground).epsilon(0.1));
    }
}

TEST_CASE("A low light adds texels for the relief, and none for level ground") {
    constexpr double texel = 0.05, length = 20, width = 12, relief = 0.7;
    const in::bounding_box box{{0, 0, 0}, {length, width, relief}};
    for (const double elevation : {1.0, 6.0, 20.0, 60.0, 90.0}) {
        CAPTURE(elevation);
        const shadow::light_frame light({0, radians(elevation)});
        const shadow::height_map map(light, shadow::extent_of(box, {}, light), texel, 32768);
        CHECK(map.columns() == Approx((length + relief * light.cot_elevation()) / texel).margin(1.5));
        CHECK(map.rows() == Approx(width / texel).margin(1.5));
    }
}
