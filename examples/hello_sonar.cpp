// A cylinder on rippled sand, as a sonar would show it: hello_sonar writes cylinder.png.
#include <insonify/insonify.hpp>
#include <insonify/io/png.hpp>

namespace in = insonify;
using namespace in::literals;

int main() {
    in::scene scene;
    scene.seabed = in::seabed::ripples{.wavelength = 0.6f, .steepness = 0.045f, .direction = 0.5f, .seed = 7};
    scene.add(in::cylinder{.radius = 0.25f, .length = 1.6f}, {.position = {-2.2, 0.4, 0.2}, .yaw = 75_deg}, "cylinder");

    const in::overhead rig{
        .altitude = 4, .field_of_view = 90_deg, .size = {1024, 1024}, .grazing = 10_deg, .intensity = 1, .sky = 0};
    const auto frame = in::render(scene, rig);  // frame.image, frame.labels, frame.stats

    const auto look = in::gamma_speckle{.looks = 3, .of = in::echo::intensity, .seed = 7} | in::display{.white = 0.4f};
    in::write_png("cylinder.png", frame.image | look | in::colormap::copper);
}
