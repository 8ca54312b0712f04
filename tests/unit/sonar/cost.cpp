// The cost of a picture depends on the ground in view, not on the extent of the seabed: samples are counted.
#include <insonify/all.hpp>
#include <insonify/seabed/blend.hpp>
#include <insonify/sonar/side_scan/recording.hpp>

#include <cmath>

#include "../../catch.hpp"

namespace in = insonify;
using namespace in::literals;

namespace {

template <class Shadow = in::shadow::exact>
in::render_stats cost_of(const in::seabed::any& bottom, const in::overhead& rig,
                         const in::render_options<Shadow>& options = {}) {
    in::scene scene;
    scene.seabed = bottom;
    return in::render(scene, rig, options).stats;
}

/// A rig over the middle of another's picture that sees `pixels` x `pixels` of it.
in::overhead chip_of(in::overhead rig, int pixels) {
    const double half = in::overhead_geometry(rig).half_extent(0).x * pixels / rig.size.x;
    rig.field_of_view = static_cast<float>(2 * in::numeric::atan2(half, static_cast<double>(rig.altitude)));
    rig.size = {pixels, pixels};
    return rig;
}

}  // namespace

TEST_CASE("The cost of a chip does not depend on the picture that it is cut from") {
    const in::overhead rig{.altitude = 4, .size = {1024, 1024}, .grazing = 10_deg};
    for (const in::seabed::any& bottom : {in::seabed::any(in::seabed::ripples{}), in::seabed::any(in::seabed::mud{})}) {
        const auto whole = cost_of<in::shadow::none>(bottom, rig);
        const auto chip = cost_of<in::shadow::none>(bottom, chip_of(rig, 256));
        // A sixteenth of the picture, including the coarse sampling for bounds and rounding at the sides.
        CHECK(chip.seabed_samples * 15 < whole.seabed_samples);
        CHECK(chip.seabed_samples >=
              static_cast<std::uint64_t>(chip.seabed_columns) * static_cast<std::uint64_t>(chip.seabed_rows));
        // With shadows, also what can cast one into the chip: the range of heights x cot(10 degrees) towards the light,
        // and no more.
        const auto shadowed = cost_of(bottom, chip_of(rig, 256));
        const double spacing = 2 * in::overhead_geometry(rig).half_extent(0).x / 512;
        const auto range = in::seabed::merge(in::seabed::prepare(bottom).range(), {0, 0});
        const double reach = (range.highest - range.lowest) / std::tan(0.1745) / spacing + 2;
        CHECK(shadowed.seabed_columns >= chip.seabed_columns);
        CHECK(shadowed.seabed_columns <= chip.seabed_columns + reach);
        CHECK(shadowed.seabed_rows <= chip.seabed_rows * 3 / 2);
    }
}

TEST_CASE("A picture samples as many points anywhere on ten kilometres of seabed") {
    const in::seabed::any bottom = in::seabed::blend{};
    const in::overhead home{.altitude = 10, .size = {256, 256}, .grazing = 20_deg};
    std::uint64_t most = 0, least = ~std::uint64_t{0};
    for (const glm::dvec2& place :
         {glm::dvec2(0, 0), glm::dvec2(10e3, 10e3), glm::dvec2(-4321, 9876), glm::dvec2(5e3, -7e3)}) {
        in::overhead rig = home;
        rig.position = place;
        const std::uint64_t samples = cost_of(bottom, rig).seabed_samples;
        most = (std::max)(most, samples);
        least = (std::min)(least, samples);
    }
    CHECK(most < least * 3 / 2);  // the relief differs, and with it how far shadows reach
}

TEST_CASE("A picture of ten kilometres takes as many samples and triangles as one of forty metres") {
    const in::overhead metres{.altitude = 11.5f, .size = {256, 256}, .grazing = 30_deg};  // 40 m
    in::overhead kilometres = metres;
    kilometres.altitude *= 250;
    for (const in::seabed::any& bottom : {in::seabed::any(in::seabed::ripples{}), in::seabed::any(in::seabed::mud{}),
                                          in::seabed::any(in::seabed::rock{})}) {
        const auto few = cost_of(bottom, metres), many = cost_of(bottom, kilometres);
        CHECK(many.seabed_samples <= few.seabed_samples * 11 / 10);
        CHECK(many.seabed.triangles <= few.seabed.triangles * 11 / 10);
    }
}

TEST_CASE("A recording ten kilometres from the origin samples as much seabed as one at the origin") {
    in::scene scene;
    scene.seabed = in::seabed::ripples{};
    in::side_scan rig{.altitude = 5, .pings = 64, .range = 30, .bins = 256};
    const auto home = in::render(scene, rig).stats.seabed_samples;
    rig.position = {7e3, -9e3};
    const auto away = in::render(scene, rig).stats.seabed_samples;
    CHECK(away <= home * 5 / 4);
    CHECK(away >= home * 4 / 5);
}
