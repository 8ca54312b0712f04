// Materials and poses are checked by every way to draw a scene, and refused by name.
#include <insonify/all.hpp>

#include <limits>

#include "../../catch.hpp"
#include "../../not_finite.hpp"

namespace in = insonify;

namespace {

in::scene cubes() {
    in::scene s;
    s.add(in::cube{}, {.position = {0, 3, 0.5}}, "cube");
    s.add(in::cube{}, {.position = {2, 3, 0.5}}, "cube");
    return s;
}

/// Every way to draw a scene refuses it, in these words.
void check_refused(const in::scene& s, const std::string& words) {
    const in::overhead above{.size = {16, 16}};
    const in::side_scan beside{.pings = 4, .range = 8, .bins = 16};
    const in::ground_range on_ground{.pings = 4, .range = 8, .bins = 16};
    CHECK_THROWS_WITH(in::render(s, above), ContainsSubstring(words));
    CHECK_THROWS_WITH(in::render(s, beside), ContainsSubstring(words));
    CHECK_THROWS_WITH(in::render(s, on_ground), ContainsSubstring(words));
    CHECK_THROWS_WITH(in::record(s, in::track_of(beside), beside), ContainsSubstring(words));
    CHECK_THROWS_WITH(in::render_swath(s, beside), ContainsSubstring(words));
    CHECK_THROWS_AS(in::render(s, above), in::invalid_input);
}

}  // namespace

TEST_CASE("A reflectivity that is NaN, infinite or negative is refused by name: of targets, and of every bottom") {
    for (const float value : {not_a_number, positive_infinity, -positive_infinity, -0.5f}) {
        in::scene s = cubes();
        s.targets[1].surface.reflectivity = value;
        check_refused(s, "scene.targets[1].surface.reflectivity is " + in::detail::to_text(value) + ", expected 0 or");
        for (std::size_t type = 0; type < in::seabed::type_count; ++type) {
            s = cubes();
            s.bottom[type].reflectivity = value;
            check_refused(s,
                          "scene.bottom[" + std::to_string(type) + "].reflectivity is " + in::detail::to_text(value));
        }
    }
}

TEST_CASE("Reflectivities of 0, above 1 and of the largest float are drawn") {
    for (const float value : {0.0f, -0.0f, 3.0f, (std::numeric_limits<float>::max)()}) {
        in::scene s = cubes();
        s.targets[0].surface.reflectivity = value;
        s.bottom[0].reflectivity = value;
        const auto frame = in::render(s, in::overhead{.size = {32, 32}});
        for (const float pixel : frame.image.pixels()) REQUIRE((pixel >= 0 && pixel <= 1));
    }
}

TEST_CASE("A pose that is not finite is refused by name, in every way to draw") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    in::scene s = cubes();
    s.targets[1].placement.position.y = nan;
    check_refused(s, "scene.targets[1].placement.position.y is nan, expected finite");
    s = cubes();
    s.targets[0].placement.roll = positive_infinity;
    check_refused(s, "scene.targets[0].placement.roll is inf, expected finite");
    s = cubes();
    s.targets[0].placement.scale = static_cast<float>(nan);
    check_refused(s, "scene.targets[0].placement.scale is nan");
}
