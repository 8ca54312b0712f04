// A small, deterministic frame as the fixture of a unit test: here of a shadow detector.
#include <insonify/insonify.hpp>

#include "../tests/catch.hpp"

namespace in = insonify;
using namespace in::literals;

namespace {

/// The code under test: the longest dark run of a row.
int longest_dark_run(std::span<const float> row, float threshold) {
    int longest = 0, run = 0;
    for (const float pixel : row) longest = (std::max)(longest, run = pixel < threshold ? run + 1 : 0);
    return longest;
}

/// A cube of 0.3 m on level sand in 128 x 128 pixels; always the same bytes.
in::frame<> cube_on_sand() {
    in::scene scene;
    scene.seabed = in::seabed::flat{.surface = {.rms = 0}};
    scene.add(in::cube{.size = glm::vec3(0.3f)}, {.position = {0.5, 0, 0.15}}, "cube");
    return in::render(scene, {.altitude = 3, .field_of_view = 90_deg, .size = {128, 128}, .grazing = 10_deg});
}

}  // namespace

TEST_CASE("The detector finds the shadow of a cube and its length") {
    const in::frame<> frame = cube_on_sand();
    const in::rect& shadow = frame.labels.targets.at(0).shadow_box;
    REQUIRE(shadow.width() > 10);
    const int found = longest_dark_run(frame.image.row(shadow.y0 + shadow.height() / 2), 0.05f);
    CHECK(std::abs(found - shadow.width()) <= 1);
}

TEST_CASE("The detector finds nothing in the rows beside the shadow") {
    const in::frame<> frame = cube_on_sand();
    CHECK(longest_dark_run(frame.image.row(3), 0.05f) == 0);
    CHECK(longest_dark_run(frame.image.row(124), 0.05f) == 0);
}
