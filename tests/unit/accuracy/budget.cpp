// Budgets: settings whose errors, measured against marched rays, stay below what was asked for.
#include <insonify/accuracy/budget.hpp>
#include <insonify/core/random.hpp>
#include <insonify/core/thread_pool.hpp>

#include <cmath>
#include <cstdio>

#include "../../catch.hpp"
#include "../../marching.hpp"

namespace in = insonify;
namespace sb = insonify::seabed;
namespace acc = insonify::accuracy;

namespace {

struct trial {
    sb::any bottom;
    in::overhead rig;
};

/// Any seabed under any light, such that what throws shadows into the picture is at most its length away.
trial random_trial(std::uint64_t seed, int pixels) {
    in::random_sequence draw(seed, 77);
    const auto between = [&](double low, double high) {
        return static_cast<float>(low + (high - low) * draw.uniform());
    };
    trial t;
    const int kind = static_cast<int>(draw.uniform() * 4);
    const auto own_seed = static_cast<std::uint64_t>(draw.uniform() * 1e9);
    if (kind == 0) {
        const float wavelength = between(0.3, 1.5);
        t.bottom = sb::ripples{.wavelength = wavelength,
                               .steepness = between(0.06, 0.16),
                               .direction = between(0, 6.28),
                               .sharpness = between(0, 0.5),
                               .seed = own_seed};
    } else if (kind == 1) {
        t.bottom = sb::mud{.mound_height = between(0.02, 0.1), .pock_depth = between(0.02, 0.1), .seed = own_seed};
    } else if (kind == 2) {
        t.bottom = sb::rock{
            .relief = between(0.1, 0.25), .outcrop = between(1.5, 4), .block = between(0.4, 1), .seed = own_seed};
    } else {
        t.bottom = sb::flat{.surface = {.rms = between(0.004, 0.02), .longest = between(0.5, 3)}, .seed = own_seed};
    }
    t.rig = {.position = {between(-500, 500), between(-500, 500)},
             .altitude = between(0.4, 1.2),
             .yaw = between(0, 6.28),
             .size = {pixels, pixels},
             .grazing = static_cast<float>(in::numeric::to_radians(kind == 2 ? between(10, 45) : between(4, 30))),
             .light_azimuth = between(0, 6.28)};
    return t;
}

in::image<std::uint8_t> dark_of(const in::labels& l) {
    return in::map_pixels(l.shadow,
                          [](std::uint16_t by) { return static_cast<std::uint8_t>(by != in::labels::is_lit); });
}

/// Displacement of the edges of shadows in a picture by the settings, against marched rays.
template <class E>
double displacement(const trial& t, const acc::settings<>& how, E& ex) {
    in::scene scene;
    scene.seabed = t.bottom;
    const auto frame = in::render(scene, t.rig, how.options(), ex);
    const auto truth = marching::dark_pixels(t.bottom, t.rig, 4, ex);
    const auto found = acc::compare_masks(dark_of(frame.labels), truth);
    return static_cast<double>(found.wrong_pixels()) /
           std::max(static_cast<double>(found.boundary_pixels), t.rig.size.x / 4.0);
}

}  // namespace

TEST_CASE("of 100 random scenes, 99 keep to a budget of 0.25, 1 or 4 pixels of shadow edge", "[.slow]") {
    in::thread_pool pool(2);
    std::uint64_t within = 0;
    const std::uint64_t scenes = std::getenv("SCENES") ? static_cast<std::uint64_t>(std::atoi(std::getenv("SCENES"))) : 100;
    for (std::uint64_t seed = 0; seed < scenes; ++seed) {
        const double tolerated = std::array{0.25, 1.0, 4.0}[seed % 3];
        const trial t = random_trial(seed, 192);
        const auto how = acc::settings_for({.shadow_edge = tolerated, .intensity = 1}, t.bottom, t.rig, {}, pool);
        const double off = displacement(t, how, pool);
        within += off <= tolerated;
        std::printf("%s %llu: seabed %zu, %4.1f degrees, asked %.2f, expected %.3f, is %.3f; %.2f cells, %.1f texels\n",
                    off <= tolerated ? "scene" : "SCENE", static_cast<unsigned long long>(seed), t.bottom.index(),
                    in::numeric::to_degrees(static_cast<double>(t.rig.grazing)), tolerated, how.expected.shadow_edge,
                    off, how.cells / 192.0, static_cast<double>(how.shadow.texels_per_pixel));
    }
    CHECK(within >= scenes * 99 / 100);
}
