// A header-only program that includes by name what the umbrella leaves out: each header brings the bodies of its
// functions.
#include <insonify/filter/poisson.hpp>
#include <insonify/geometry/obj.hpp>
#include <insonify/geometry/objects/tyre.hpp>
#include <insonify/insonify.hpp>
#include <insonify/seabed/models.hpp>
#include <insonify/shadow/map.hpp>
#include <insonify/sonar/side_scan/recording.hpp>
#include <insonify/sonar/speckle.hpp>

#include "../catch.hpp"

namespace in = insonify;

TEST_CASE("Headers by name are enough for a header-only program") {
    in::scene scene;
    scene.seabed = in::seabed::sample(in::seabed::ripples{}, in::seabed::grid_over({-5, -5}, {20, 5}, 0.25));
    scene.add(in::tyre{}, {.position = {5, 2, 0}}, "tyre");
    scene.add(in::read_obj("v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n"), {.position = {4, 1, 0}}, "sheet");
    const auto frame = in::render(scene, in::side_scan{.pings = 64, .bins = 128});
    CHECK(in::with_speckle(frame).image.width() == 128);
    const auto picture = in::render(scene, in::overhead{.size = {32, 32}}, in::render_options<in::shadow::map>{});
    CHECK((picture.image | in::poisson{}).height() == 32);
}
