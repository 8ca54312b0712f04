// Tests of a shadow finder with GoogleTest: the fixture is a scene rendered in the test; a golden picture pins its
// pixels.
#include <insonify/insonify.hpp>
#include <insonify/testing.hpp>

#include "../shadow_finder.hpp"
#include <gmock/gmock.h>

namespace in = insonify;

TEST(ShadowFinder, MeasuresTheShadowOfACube) {
    const in::frame<> frame = cube_on_sand();
    const in::target_label& cube = frame.labels.targets.at(0);
    const int row = cube.shadow_box.y0 + cube.shadow_box.height() / 2;
    EXPECT_NEAR(longest_dark_run(frame.image.row(row)), cube.shadow_box.width(), 1);
}

TEST(ShadowFinder, TheFixtureMatchesItsGoldenPicture) {
    const in::golden_pictures golden{.folder = GOLDEN_FOLDER, .failures = "."};
    EXPECT_THAT(eight_bit_picture(), golden.is("cube_on_sand", {.value = 1}));
}
