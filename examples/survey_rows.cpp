// Rows of a survey into a caller's buffer, a few pings at a time, as a simulator produces them: survey_rows.
#include <insonify/insonify.hpp>
#include <insonify/sonar/side_scan/recording.hpp>

#include <algorithm>
#include <cstdio>
#include <vector>

namespace in = insonify;
using namespace in::literals;

int main() {
    in::scene scene;
    scene.seabed = in::seabed::ripples{.seed = 6};
    scene.add(in::cylinder{.radius = 0.3f, .length = 2}, {.position = {12, 6, 0.3}}, "cylinder");

    const in::side_scan sonar{.ping_spacing = 0.1f, .range = 30, .bins = 600};
    const in::sonar_equation equation{in::spreading_loss{}, in::absorption{}, in::vertical_beam{},
                                      in::noise_floor{1e-13f}, in::level_gain{}};
    const auto options = in::record_options<>{}.with(equation).without_labels();

    // The caller's memory: 120 rows of 640 floats, of which the last 40 hold the caller's data.
    std::vector<float> buffer(120 * 640, -1.0f);
    const in::image_view<float> rows(buffer.data(), 640, 120);
    for (int first = 0; first < 120; first += 8) {
        std::vector<in::ping> pings;
        for (int i = first; i < first + 8; ++i) {
            const double t = 0.1 * i;  // a vehicle that rolls, pitches, yaws and heaves on its way
            pings.push_back({.position = {0.2 * t, t, 5 + 0.1 * (i % 16) / 16},
                             .yaw = 0.01 * (i % 8),
                             .pitch = 0.02 * (i % 5 - 2),
                             .roll = 0.03 * (i % 7 - 3)});
        }
        in::record_into(rows.part(0, first, 600, 8), scene, pings, sonar, options);
    }
    const double loudest = static_cast<double>(*std::max_element(buffer.begin(), buffer.end()));
    const auto untouched = std::count(buffer.begin(), buffer.end(), -1.0f);
    std::printf("loudest echo %.2f; %td of the caller's 4800 values are untouched\n", loudest, untouched);
    return loudest > 0 && untouched == 4800 ? 0 : 1;
}
