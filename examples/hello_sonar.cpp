// A cylinder on rippled sand, as a sonar would show it: hello_sonar [reference.pgm] writes cylinder.png.
#include <insonify/insonify.hpp>
#include <insonify/io/png.hpp>

namespace in = insonify;
using namespace in::literals;

int main(int argc, char** argv) {
    in::scene scene;
    scene.seabed = in::seabed::ripples{.wavelength = 0.8f, .steepness = 0.0625f, .direction = 0.6f, .seed = 7};
    scene.add(in::cylinder{.radius = 0.25f, .length = 2.0f}, {.position = {-2, 0, 0.25}, .yaw = 60_deg}, "cylinder");

    const auto rig = in::overhead{.altitude = 4, .size = {1024, 1024}, .grazing = 6_deg};
    const auto frame = in::render(scene, rig);  // frame.image, frame.labels, frame.stats

    const auto reference = argc > 1 ? in::read_netpbm<float>(argv[1]) : frame.image | in::equalize{};
    const auto look = in::match_histogram(reference) | in::speckle{.variance = 0.1f, .seed = 7};
    in::write_png("cylinder.png", frame.image | look | in::colormap::copper);
}
