// Tests of a shadow finder with Catch2: the fixture is a scene rendered in the test; a golden picture pins its pixels.
#if __has_include(<catch2/catch_test_macros.hpp>)
#include <catch2/catch_test_macros.hpp>
#else
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
#endif

#include <insonify/insonify.hpp>
#include <insonify/testing.hpp>
#include <insonify/testing/catch2.hpp>

#include "../shadow_finder.hpp"

namespace in = insonify;

TEST_CASE("The finder measures the shadow of a cube") {
    const in::frame<> frame = cube_on_sand();
    const in::target_label& cube = frame.labels.targets.at(0);
    const int row = cube.shadow_box.y0 + cube.shadow_box.height() / 2;
    CHECK(std::abs(longest_dark_run(frame.image.row(row)) - cube.shadow_box.width()) <= 1);
}

TEST_CASE("The fixture matches its golden picture") {
    const in::golden_pictures golden{.folder = GOLDEN_FOLDER, .failures = "."};
    CHECK_THAT(eight_bit_picture(), in::matches(golden.is("cube_on_sand", {.value = 1})));
}
