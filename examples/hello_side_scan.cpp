// Both sides of a survey line, as a side-scan sonar records them: hello_side_scan writes swath.png.
#include <insonify/insonify.hpp>
#include <insonify/io/png.hpp>
#include <insonify/seabed/blend.hpp>
#include <insonify/sonar/side_scan/recording.hpp>
#include <insonify/sonar/speckle.hpp>

namespace in = insonify;
using namespace in::literals;

int main() {
    in::scene scene;
    scene.seabed = in::seabed::blend{.first = in::seabed::ripples{.seed = 7}, .second = in::seabed::mud{.seed = 7}};
    scene.add(in::cylinder{.radius = 0.25f, .length = 2.0f}, {.position = {9, 12, 0.2}, .yaw = 60_deg}, "cylinder");
    scene.add(in::cube{.size = glm::vec3(0.6f)}, {.position = {-12, 8, 0.25}, .yaw = 20_deg}, "cube");

    in::side_scan rig{.altitude = 4, .ping_spacing = 0.05f, .pings = 400, .range = 20, .bins = 700};
    const auto record = [&](in::side side) {  // frame.image holds intensities, frame.labels their sources
        rig.side = side;
        return in::with_speckle(in::render(scene, rig), {.seed = 7});
    };
    const auto swath = in::both_sides(record(in::side::port), record(in::side::starboard));
    in::write_png("swath.png", swath.image | in::display{} | in::colormap::copper);
}
