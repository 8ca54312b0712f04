// A rendered survey line above a real one: beside_real [recorded line [out.png]]
//
// The real one, 461 pings of both sides out to 30 m at 600 kHz, shows a wreck below a towfish that descends towards it.
// The rendered one has a wreck of about the same size, a similar tow, and the look of the recipe `sonar`; no pixel of
// it comes from the real one.
#include <insonify/geometry/objects/boulder.hpp>
#include <insonify/geometry/objects/footprint.hpp>
#include <insonify/geometry/objects/hull.hpp>
#include <insonify/insonify.hpp>
#include <insonify/io/png.hpp>
#include <insonify/seabed/sculpt.hpp>
#include <insonify/sonar/bottom_tone.hpp>
#include <insonify/sonar/instruments.hpp>
#include <insonify/sonar/side_scan/ping_gain.hpp>
#include <insonify/sonar/side_scan/record_options.hpp>
#include <insonify/sonar/side_scan/recording.hpp>
#include <insonify/sonar/side_scan/sonar_equation.hpp>
#include <insonify/sonar/side_scan/water_column.hpp>
#include <insonify/sonar/speckle.hpp>

#include <cstdio>
#include <filesystem>

#include "common/pictures.hpp"
#include "common/usage.hpp"

namespace in = insonify;
using namespace in::literals;

namespace {

constexpr in::instrument sonar = in::instruments::side_scan_600;

in::scene wreck_on_gravel() {
    in::scene scene;
    // Gravel with waves of sand, and the moat that the current has dug around the hull.
    const in::seabed::any ground = in::seabed::ripples{.wavelength = 1.1f,
                                                       .steepness = 0.02f,
                                                       .direction = 40_deg,
                                                       .spread = 0.3f,
                                                       .bandwidth = 0.2f,
                                                       .surface = {.rms = 0.014f, .longest = 2, .shortest = 0.08f},
                                                       .seed = 4};
    const in::mesh hull = to_mesh(in::hull{.length = 17,
                                           .beam = 5.2f,
                                           .depth = 2.6f,
                                           .bulwark = 0.5f,
                                           .house_length = 0.18f,
                                           .house_tiers = 1,
                                           .hatches = 2,
                                           .masts = 1,
                                           .collapse = 0.35f,
                                           .seed = 8});
    in::pose pose{.position = {10.5, 12, 0}, .yaw = 24_deg, .roll = 9_deg};
    pose = in::rest_on(ground, hull, pose);
    pose.burial = 1.1f;
    scene.seabed = in::seabed::sculpted{
        .ground = ground,
        .edits = {
            in::seabed::moat{.outline = in::footprint(hull, pose, 1.5f), .depth = 0.3f, .width = 1.5f, .mound = 0.2f}}};
    scene.add(hull, pose, "wreck", {2});
    in::random_sequence dice(5);
    for (int i = 0; i < 60; ++i) {
        const in::mesh stone = to_mesh(in::boulder{.size = glm::vec3(static_cast<float>(dice.uniform(0.1, 0.45))),
                                                   .segments = 6,
                                                   .seed = static_cast<std::uint32_t>(i)});
        const bool is_near = i < 35;
        // One draw a statement: compilers evaluate arguments in different orders.
        const double y = is_near ? dice.uniform(4, 20) : dice.uniform(0, 27);
        const double x = is_near ? dice.uniform(5, 16) : dice.uniform(-27, 27);
        const glm::dvec3 at(x, y, 0);
        scene.add(stone, in::rest_on(ground, stone, {.position = at}), "stone", {1});
    }
    return scene;
}

/// The towfish descends from 14.5 m to 4 m and sways about its course.
std::vector<in::ping> tow_of(const in::side_scan& rig) {
    std::vector<in::ping> track = in::track_of(rig);
    for (std::size_t i = 0; i < track.size(); ++i) {
        const double t = static_cast<double>(i) / static_cast<double>(track.size());
        const auto sway = in::numeric::sin_cos(9 * t);
        track[i].position.z = 4 + 10.5 * in::numeric::exp(-4.5 * t * t) + 0.35 * in::numeric::sin_cos(17 * t).sine;
        track[i].yaw += 0.025 * sway.sine;
        track[i].pitch = 0.02 * sway.cosine;
    }
    return track;
}

in::image<float> line_of(const in::scene& scene, in::side_scan rig, in::side side) {
    rig.side = side;
    const in::facet_backscatter law{.facets = 0.3f, .slope = 0.2f, .volume = 0.5f};
    // Gains level the vertical beam's pattern out to 45 degrees; below the sonar the beam is weak, and so is the echo.
    const in::sonar_equation equation{in::pulse{2 * sonar.range_resolution}, in::horizontal_beam{sonar.beamwidth},
                                      in::vertical_beam{.beamwidth = sonar.vertical_beamwidth}, in::level_gain{}};
    const std::vector<in::ping> tow = tow_of(rig);
    auto recording = in::record(scene, tow, rig, in::record_options<>{}.with(law).with(equation));
    recording = in::with_tone(
        std::move(recording), tow, rig,
        {.drift = 2.6f, .drift_length = 9, .streaks = 0.6f, .streak_width = 1.2f, .streak_length = 25, .seed = 2});
    recording.image =
        std::move(recording.image) |
        in::range_gain_error{.rms = 0.6f, .length = 250, .slope = -8, .seed = side == in::side::port ? 3u : 4u} |
        in::water_column{.bin = static_cast<float>(rig.bin()), .noise = 4e-4f, .noise_range = 30, .volume = 1e-4f};
    recording = in::with_speckle(std::move(recording),
                                 in::seabed_speckle{.elsewhere = {.looks = 1}, .along_track = 0.6f, .seed = 6});
    return std::move(recording.image) | in::ping_banding{.drift = 0.2f, .jitter = 0.2f} |
           in::display{.white = 4, .exponent = 0.5f};
}

}  // namespace

int main(int argc, char** argv) try {
    examples::check_arguments(argc, argv, 0, 2, "beside_real [recorded line [out.png]]");
    const std::string real = argc > 1 ? argv[1] : EXAMPLES_REFERENCE "/sidescan_scotsman/waterfall_u8_linear.png";
    const std::string out = argc > 2 ? argv[2] : "beside_real.png";
    const in::side_scan rig{.altitude = 14, .ping_spacing = 0.06f, .pings = 461, .range = 29.98f, .bins = 1018};
    const in::scene scene = wreck_on_gravel();
    const in::image<float> port = line_of(scene, rig, in::side::port),
                           starboard = line_of(scene, rig, in::side::starboard);

    const bool has_real = argc > 1 || std::filesystem::exists(real);
    const in::image<float> below = has_real ? examples::read_gray(real) : in::image<float>(2 * rig.bins, 1);
    in::image<float> page((std::max)(2 * rig.bins, below.width()), rig.pings + 12 + below.height(), 1);
    const int middle = page.width() / 2;
    for (int y = 0; y < rig.pings; ++y)
        for (int x = 0; x < rig.bins; ++x) page(middle - 1 - x, y) = port(x, y), page(middle + x, y) = starboard(x, y);
    for (int y = 0; y < below.height(); ++y)
        for (int x = 0; x < below.width(); ++x) page(middle - below.width() / 2 + x, rig.pings + 12 + y) = below(x, y);
    in::write_png(out, page | in::to_uint8);
    if (!has_real) std::printf("no real line at %s: %s shows only the rendered one\n", real.c_str(), out.c_str());
} catch (const std::exception& error) {
    std::fprintf(stderr, "beside_real: %s\n", error.what());
    return 1;
}
