// Rigs at the limits of their ranges: the picture equals that of ordinary dimensions, or changes as geometry predicts.
#include <insonify/all.hpp>

#include "../../catch.hpp"

namespace in = insonify;
using namespace in::literals;

namespace {

in::scene level_bottom() {
    in::scene scene;
    scene.seabed = in::seabed::flat{.surface = {.rms = 0}};
    return scene;
}

in::scene scene_at(const glm::dvec3& offset, double scale = 1) {
    in::scene scene = level_bottom();
    const auto size = static_cast<float>(scale);
    scene.add(in::cylinder{.radius = 0.25f * size, .length = 2 * size},
              {.position = offset + scale * glm::dvec3(-2, 0.5, 0.25), .yaw = 30_deg, .roll = 90_deg}, "cylinder");
    scene.add(in::cube{.size = glm::vec3(0.8f * size)},
              {.position = offset + scale * glm::dvec3(1, -2, 0.4), .yaw = 0.3f}, "cube");
    return scene;
}

/// All pixels in which two frames differ by more than `tolerance`, or in a label.
template <class Frame>
int differences(const Frame& a, const Frame& b, float tolerance) {
    int count = 0;
    for (std::size_t i = 0; i < a.image.size(); ++i) {
        const float off = a.image.pixels()[i] - b.image.pixels()[i];
        count += !(off <= tolerance && off >= -tolerance) ||
                 a.labels.instance.pixels()[i] != b.labels.instance.pixels()[i] ||
                 a.labels.shadow.pixels()[i] != b.labels.shadow.pixels()[i];
    }
    return count;
}

}  // namespace

TEST_CASE("The picture has the same bytes at any distance from the world's origin") {
    const in::overhead rig{.altitude = 5, .yaw = 0.4f, .size = {160, 120}};
    const auto here = in::render(scene_at({0, 0, 0}), rig);
    for (const double away : {1e3, 1e6, 1e7}) {
        // Offsets in steps that doubles have at 1e7 m, so that the scene itself isn't rounded.
        const glm::dvec3 offset(away, -0.75 * away, 0);
        in::overhead there = rig;
        there.position = glm::dvec2(offset);
        const auto moved = in::render(scene_at(offset), there);
        CHECK(moved.image == here.image);
        CHECK(moved.labels.instance == here.labels.instance);
        CHECK(moved.labels.shadow == here.labels.shadow);
    }
}

TEMPLATE_TEST_CASE(
    "A scene scaled with the altitude gives the same picture, from a micrometre to a thousand kilometres", "",
    in::shadow::map, in::shadow::exact) {
    const in::overhead rig{.altitude = 5, .size = {160, 120}};
    const in::render_options<TestType> options;
    const auto ordinary = in::render(scene_at({0, 0, 0}), rig, options);
    REQUIRE(ordinary.labels.targets.size() == 2);
    for (const double altitude : {1e-6, 1e-3, 1e4, 1e6}) {
        in::overhead other = rig;
        other.altitude = static_cast<float>(altitude);
        INFO("altitude " << altitude);
        CHECK(differences(ordinary, in::render(scene_at({0, 0, 0}, altitude / 5), other, options), 1e-4f) == 0);
    }
}

TEST_CASE("A cube a quarter of the picture wide keeps its size at fields of view from 0.1 to 179 degrees") {
    for (const double degrees : {0.1, 1.0, 90.0, 170.0, 179.0}) {
        const in::overhead rig{
            .altitude = 10, .field_of_view = static_cast<float>(in::numeric::to_radians(degrees)), .size = {128, 96}};
        // A cube a quarter of the picture wide, right below.
        const double half = in::overhead_geometry(rig).half_extent(0).x;
        in::scene scene = level_bottom();
        const auto side = static_cast<float>(half / 2);
        const float height = (std::min)(0.01f * side, 1.0f);
        scene.add(in::cube{.size = {side, side, height}}, {.position = {0, 0, height / 2}}, "cube");
        const auto frame = in::render(scene, rig);
        INFO("field of view " << degrees);
        REQUIRE(frame.labels.targets.size() == 1);
        // As wide as it is, but for what perspective adds to its top.
        const double expected = 128.0 / 4 * 10 / (10 - static_cast<double>(height));
        CHECK(static_cast<double>(frame.labels.targets[0].box.width()) == Approx(expected).margin(1.01));
        for (const float value : frame.image.pixels()) REQUIRE((value >= 0 && value <= 1));
    }
    CHECK_THROWS_AS(in::render({}, in::overhead{.field_of_view = 180_deg}), in::invalid_input);
    CHECK_THROWS_AS(in::render({}, in::overhead{.field_of_view = 0}), in::invalid_input);
}

TEST_CASE("A mesh in other units, scaled by its pose, has the same smooth shades") {
    const auto picture_of = [](float radius, float scale) {
        in::scene scene = level_bottom();
        in::mesh ball = to_mesh(in::sphere{.radius = radius, .segments = 16});
        scene.add(std::move(ball), {.position = {0, 0, 0.5}, .scale = scale}, "ball");
        return in::render(scene, {.altitude = 4, .field_of_view = 20_deg, .size = {96, 96}}).image;
    };
    const auto metres = picture_of(0.5f, 1);
    for (const float scale : {1e-4f, 1e-3f, 1e3f}) {
        CAPTURE(scale);
        const auto other = picture_of(0.5f / scale, scale);
        int count = 0;
        for (std::size_t i = 0; i < metres.size(); ++i)
            count += std::abs(other.pixels()[i] - metres.pixels()[i]) > 1e-3f ? 1 : 0;
        CHECK(count <= 96);  // of 9216: vertices are rounded to other floats, which moves edges of shadows
    }
}

TEST_CASE("Shadows are long at grazing angles of up to a degree and vanish towards the zenith") {
    for (const double degrees : {0.1, 1.0, 45.0, 89.9, 90.0}) {
        const in::overhead rig{
            .altitude = 5, .size = {160, 120}, .grazing = static_cast<float>(in::numeric::to_radians(degrees))};
        const auto frame = in::render(scene_at({0, 0, 0}), rig);
        INFO("grazing " << degrees);
        int dark = 0;
        for (std::size_t i = 0; i < frame.image.size(); ++i) {
            REQUIRE((frame.image.pixels()[i] >= 0 && frame.image.pixels()[i] <= 1));
            dark += frame.labels.shadow.pixels()[i] != in::labels::no_shadow;
        }
        // A shadow of h / tan(grazing), up to the picture's end.
        if (degrees <= 1) CHECK(dark > 500);
        if (degrees > 89) CHECK(dark < 120);
    }
}

TEST_CASE("Ground of two triangles 20000 km wide gives the same picture at every instruction set") {
    in::mesh ground;
    for (const glm::vec2 at : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
        ground.positions.emplace_back(1e7f * at, 0);
        ground.normals.emplace_back(0, 0, 1);
    }
    ground.triangles = {{0, 1, 2}, {0, 2, 3}};
    in::scene scene = scene_at({});
    scene.seabed = in::seabed::none{};
    scene.add(ground, {}, "ground");
    const auto at_level = [&](in::isa level) {
        return in::render(scene, in::overhead{.altitude = 5, .size = {130, 97}}, in::render_options<>{.level = level});
    };
    const auto one_by_one = at_level(in::isa::scalar);
    CHECK(one_by_one.image(3, 3) > 0);
    CHECK(one_by_one.labels.instance(3, 3) == 3);
    for (const in::isa level : {in::isa::baseline, in::best_isa()})
        CHECK(differences(at_level(level), one_by_one, 0) == 0);
}

TEST_CASE("A picture of 4096 x 4096 pixels is the same in 262144 tiles and in 4096", "[.slow]") {
    // Under a point light the policy decides every point, and tests them all together.
    in::scene s;
    s.seabed = in::seabed::ripples{};
    for (int i = 0; i < 7; ++i)
        s.add(in::cube{.size = glm::vec3(0.3f)}, {.position = {0.8 * i - 2.4, 0.1, 0.15}}, "cube");
    const in::overhead rig{.altitude = 3, .size = {4096, 4096}, .grazing = 0.2f, .light_distance = 12};
    in::render_options<> options;
    const auto usual = in::render(s, rig, options);
    options.tile = 8;
    const auto small = in::render(s, rig, options);
    CHECK(small.image == usual.image);
    CHECK(small.labels.shadow == usual.labels.shadow);
}

TEST_CASE("Pictures of any size are drawn, of full and of empty scenes") {
    for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(1, 300), glm::ivec2(300, 1), glm::ivec2(2047, 3)}) {
        const auto frame = in::render(scene_at({0, 0, 0}), in::overhead{.altitude = 5, .size = size});
        CHECK(frame.image.width() == size.x);
        CHECK(frame.image.height() == size.y);
        for (const float value : frame.image.pixels()) REQUIRE((value >= 0 && value <= 1));
    }
    const auto empty = in::render(level_bottom(), in::overhead{.size = {64, 64}});
    for (const float value : empty.image.pixels()) CHECK(value == empty.image(0, 0));
}
