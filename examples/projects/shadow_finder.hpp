// The code under test, which does not depend on insonify, and the scene that it is tested on.
#pragma once

#include <insonify/insonify.hpp>

#include <cstdlib>
#include <span>

/// The longest dark run of a row of pixels.
inline int longest_dark_run(std::span<const float> row) {
    int longest = 0, run = 0;
    for (const float pixel : row) {
        run = pixel < 0.05f ? run + 1 : 0;
        longest = run > longest ? run : longest;
    }
    return longest;
}

/// A cube of 0.3 m on level sand in 128 x 128 pixels; always the same bytes.
inline insonify::frame<> cube_on_sand() {
    using namespace insonify::literals;
    insonify::scene scene;
    scene.seabed = insonify::seabed::flat{.surface = {.rms = 0}};
    scene.add(insonify::cube{.size = glm::vec3(0.3f)}, {.position = {0.5, 0, 0.15}}, "cube");
    return insonify::render(scene, {.altitude = 3, .field_of_view = 90_deg, .size = {128, 128}, .grazing = 10_deg});
}

inline insonify::image<std::uint8_t> eight_bit_picture() {
    return cube_on_sand().image | insonify::to_uint8;
}
