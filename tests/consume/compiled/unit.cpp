// A unit with flags of its own: it draws a frame, and its function's name is the macro UNIT.
#include <insonify/insonify.hpp>

#include <vector>

namespace in = insonify;

std::vector<float> UNIT();

std::vector<float> UNIT() {
    in::scene scene;
    scene.seabed = in::seabed::ripples{.wavelength = 0.7f};
    scene.add(in::cube{.size = glm::vec3(0.3f)}, {.position = {0.5, 0, 0.15}}, "cube");
    const auto frame = in::render(scene, {.altitude = 3, .size = {128, 96}, .grazing = 0.2f});
    const auto image = frame.image | in::equalize{} | in::speckle{.variance = 0.1f, .seed = 7};
    return {image.pixels().begin(), image.pixels().end()};
}
