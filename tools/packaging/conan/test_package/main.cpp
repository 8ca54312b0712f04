// A cube on a flat seabed, seen from above: it and its shadow are in the picture.
#include <insonify/insonify.hpp>

namespace in = insonify;

int main() {
    in::scene scene;
    scene.seabed = in::seabed::flat{};
    scene.add(in::cube{}, {.position = {0, 0, 0.5}}, "cube");
    const auto frame = in::render(scene, {.altitude = 5, .size = {64, 64}});
    return frame.labels.targets.at(0).area > 0 && frame.labels.targets.at(0).shadow_area > 0 ? 0 : 1;
}
