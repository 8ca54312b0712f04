// A unit with flags of its own, named by the macro UNIT.
#include "unit.hpp"

#include <insonify/insonify.hpp>
#include <insonify/sonar/side_scan/recording.hpp>
#include <insonify/sonar/speckle.hpp>

#define JOIN_RAW(a, b) a##b
#define JOIN(a, b) JOIN_RAW(a, b)

in::image<float> JOIN(draw_, UNIT)() {
    in::scene scene;
    scene.seabed = in::seabed::ripples{.wavelength = 0.7f};
    scene.add(in::cube{.size = glm::vec3(0.3f)}, {.position = {0.5, 0, 0.15}}, "cube");
    return in::render(scene, {.altitude = 3, .size = {128, 96}, .grazing = 0.2f}).image;
}

in::image<float> JOIN(record_, UNIT)() {
    in::scene scene;
    scene.seabed = in::seabed::ripples{.wavelength = 0.7f};
    scene.add(in::cube{.size = glm::vec3(0.3f)}, {.position = {3, 1, 0.15}}, "cube");
    const in::sonar_equation equation{in::pulse{}, in::horizontal_beam{}, in::level_gain{}};
    const in::side_scan rig{.altitude = 2, .ping_spacing = 0.05f, .pings = 40, .range = 6, .bins = 128};
    return in::with_speckle(in::render(scene, rig, in::record_options<>{}.with(equation))).image;
}

in::image<float> JOIN(filter_, UNIT)(const in::image<float>& picture, const quantization& quantize) {
    return picture | quantize | in::equalize{} | in::speckle{.variance = 0.1f, .seed = 7};
}

bool JOIN(reads_, UNIT)(in::display_scale scale, const in::bottom_tone& tone, const in::seabed::patches& where) {
    return scale == in::display_scale::decibels && !tone.is_none() && where.coverage == 0.25f;
}
