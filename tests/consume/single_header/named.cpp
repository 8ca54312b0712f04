// Includes by name the headers that units of the compiled form need.
#include <insonify/geometry/objects/tyre.hpp>
#include <insonify/insonify.hpp>
#include <insonify/sonar/side_scan/recording.hpp>
#include <insonify/testing.hpp>

namespace in = insonify;

in::frame<> tyre_on_ripples() {
    in::scene scene;
    scene.seabed = in::seabed::ripples{.seed = 7};
    scene.add(to_mesh(in::tyre{}), {.position = {5, 2, 0}}, "tyre");
    return in::render(scene, in::side_scan{.pings = 64, .bins = 128});
}
