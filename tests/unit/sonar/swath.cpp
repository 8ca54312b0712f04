// Both sides of a track in one picture.
#include <insonify/all.hpp>
#include <insonify/sonar/side_scan/recording.hpp>
#include <insonify/sonar/side_scan/slant_to_ground.hpp>
#include <insonify/sonar/side_scan/swath.hpp>

#include "../../catch.hpp"

namespace in = insonify;
using namespace in::literals;

TEST_CASE("mirrored(), rotated_180() and side_by_side() arrange pictures") {
    const in::image<int> a{{1, 2, 3}, {4, 5, 6}};
    CHECK(in::mirrored(a) == in::image<int>{{3, 2, 1}, {6, 5, 4}});
    CHECK(in::rotated_180(a) == in::image<int>{{6, 5, 4}, {3, 2, 1}});
    CHECK(in::side_by_side(a, in::image<int>{{7}, {8}}, 1, -1) == in::image<int>{{1, 2, 3, -1, 7}, {4, 5, 6, -1, 8}});
    CHECK_THROWS_AS(in::side_by_side(a, in::image<int>{{7}}), in::invalid_input);
    CHECK_THROWS_AS(in::side_by_side(a, a, -1), in::invalid_input);
}

TEST_CASE("both_sides() takes a recording of each side, of the same pings in the same order") {
    const in::scene s;
    in::side_scan rig{.pings = 4, .bins = 16};
    const auto starboard = in::render(s, rig);
    rig.side = in::side::port;
    const auto port = in::render(s, rig);
    const auto both = in::both_sides(port, starboard);
    CHECK(both.image.width() == 32);
    CHECK_THROWS_WITH(in::both_sides(starboard, port), ContainsSubstring("port.rows.side"));
    CHECK_THROWS_WITH(in::both_sides(port, port), ContainsSubstring("starboard.rows.side"));
    CHECK_THROWS_WITH(in::both_sides(port, both), ContainsSubstring("starboard.rows.side"));
    const auto overhead = in::render(s, in::overhead{.size = {16, 4}});
    CHECK_THROWS_WITH(in::both_sides(port, overhead), ContainsSubstring("starboard.rows.side"));
    CHECK_THROWS_WITH(in::both_sides(in::flipped_vertically(port), starboard), ContainsSubstring("port.rows.first"));
    auto other = port;
    other.labels.targets.push_back({"ball", 1, {}, {}, {}});
    CHECK_THROWS_WITH(in::both_sides(other, starboard), ContainsSubstring("port.labels.targets.size() is 1"));
}

TEST_CASE("Labels of instances that are not in the target list are refused, as are images of different sizes") {
    in::labels l(3, 2);
    l.instance(1, 1) = 2;
    l.targets.push_back({"ball", 1, {}, {}, {}});
    CHECK_THROWS_WITH(in::classes_of(l), ContainsSubstring("labels.instance is 2"));
    CHECK_THROWS_WITH(in::measure_targets(l), ContainsSubstring("labels.instance is 2"));
    l.instance(1, 1) = 0, l.shadow(1, 1) = 3;
    CHECK_THROWS_WITH(in::measure_targets(l), ContainsSubstring("labels.shadow is 3"));
    l.shadow = in::image<std::uint16_t>(3, 1);
    CHECK_THROWS_WITH(in::measure_targets(l), ContainsSubstring("labels.shadow.size() is 3"));
    CHECK_THROWS_WITH(in::shadow_mask(l, 0), ContainsSubstring("labels.instance.size() is 6"));
}

TEST_CASE("Masks of instance 0 are the pixels without a target, and the seabed that is lit") {
    const auto l = in::render(in::scene{}, in::side_scan{.altitude = 5, .pings = 1, .range = 20, .bins = 80}).labels;
    const auto bare = in::target_mask(l, 0), lit = in::shadow_mask(l, 0);
    CHECK(std::count(l.seabed.pixels().begin(), l.seabed.pixels().end(), in::labels::no_seabed) > 10);
    for (int bin = 0; bin < 80; ++bin) {
        CHECK(bare(bin, 0) == 255);
        CHECK(lit(bin, 0) == (l.seabed(bin, 0) == in::labels::no_seabed ? 0 : 255));
    }
}

TEST_CASE("Slant-range correction takes recordings of one side, with labels of their size") {
    const in::side_scan rig{.pings = 4, .bins = 16};
    const in::ground_range to{.pings = 4, .bins = 16};
    const auto recording = in::render(in::scene{}, rig);
    auto sides = recording, above = recording, unlabelled = recording;
    sides.rows.port_columns = 8, above.rows.step = 0, unlabelled.labels.seabed = {};
    CHECK_THROWS_WITH(in::to_ground_range(sides, rig, to), ContainsSubstring("slant.rows.port_columns is 8"));
    CHECK_THROWS_WITH(in::to_ground_range(above, rig, to), ContainsSubstring("slant.rows.step is 0"));
    CHECK_THROWS_WITH(in::to_ground_range(unlabelled, rig, to), ContainsSubstring("labels.seabed.size() is 0"));
}

TEST_CASE("The paper's stitched picture: two of its cameras back to back, shadows away from the gap, forward up") {
    in::scene s;
    s.seabed = in::seabed::flat{.surface = {.rms = 0}};
    s.add(in::cube{.size = glm::vec3(0.3f)}, {.position = {1, 1, 0.15}}, "ahead to starboard");
    s.add(in::cube{.size = glm::vec3(0.3f)}, {.position = {-1, -1, 0.15}}, "astern to port");
    in::overhead rig{.altitude = 3, .field_of_view = 90_deg, .size = {100, 100}, .grazing = 20_deg};
    const auto starboard = in::render(s, rig);
    rig.yaw = 180_deg;
    const auto port = in::render(s, rig);
    const auto instance = in::side_by_side(in::rotated_180(port.labels.instance), starboard.labels.instance, 10);
    const auto shadow = in::side_by_side(in::rotated_180(port.labels.shadow), starboard.labels.shadow, 10);
    const auto image = in::side_by_side(in::rotated_180(port.image), starboard.image, 10, 0.25f);
    REQUIRE(image.width() == 210);
    CHECK(image(104, 50) == 0.25f);
    // In each half, both cubes are seen, as a camera below the middle of that half sees them.
    struct found {
        int x = 0, y = 0, count = 0;
    };
    const auto middle = [](const in::image<std::uint16_t>& picture, int value, int from, int to) {
        found f;
        for (int y = 0; y < picture.height(); ++y)
            for (int x = from; x < to; ++x)
                if (picture(x, y) == value) f = {f.x + x, f.y + y, f.count + 1};
        return found{f.x / (std::max)(f.count, 1), f.y / (std::max)(f.count, 1), f.count};
    };
    const found right = middle(instance, 1, 110, 210), left = middle(instance, 2, 0, 100);
    REQUIRE((right.count > 20 && left.count > 20));
    CHECK((right.x > 160 && right.y < 50));  // starboard of the middle, ahead
    CHECK((left.x < 50 && left.y > 50));
    CHECK(middle(shadow, 1, 110, 210).x > right.x);
    CHECK(middle(shadow, 2, 0, 100).x < left.x);
}

TEST_CASE("Slant-range correction restores positions on the seabed, with one altitude or one per row") {
    in::scene s;
    s.seabed = in::seabed::flat{.surface = {.rms = 0}};
    s.add(in::cube{.size = {0.2f, 5, 0.01f}}, {.position = {9, 0, 0.005}}, "plate");  // too flat for layover
    const in::side_scan rig{.altitude = 6, .pings = 3, .range = 20, .bins = 2000};
    const in::ground_range map{.altitude = 6, .pings = 3, .range = 15, .bins = 1500};
    const auto heard = in::render(s, rig, {.cell = 0.01});
    const auto on_ground = in::to_ground_range(heard, rig, map);
    REQUIRE(on_ground.labels.targets.size() == 1);
    const in::rect box = on_ground.labels.targets[0].box;
    CHECK(box.x0 * 0.01 == Approx(8.9).margin(0.025));
    CHECK(box.x1 * 0.01 == Approx(9.1).margin(0.025));
    CHECK(box.height() == 3);
    for (int x = 100; x < 1500; ++x)  // no water column is left
        REQUIRE(on_ground.labels.seabed(x, 0) != (on_ground.labels.instance(x, 0) == 0 ? in::labels::no_seabed : 0));
    const std::vector<double> heights{6, 6, 6}, two{6, 6};
    CHECK(in::to_ground_range(heard, rig, map, heights).image == on_ground.image);
    CHECK_THROWS_AS(in::to_ground_range(heard, rig, map, two), in::invalid_input);
    // Beyond the recorded ranges the picture is empty.
    const auto wide = in::to_ground_range(heard, rig, {.altitude = 6, .pings = 3, .range = 40, .bins = 400});
    CHECK(wide.image(399, 0) == 0);
    CHECK(wide.labels.seabed(399, 0) == in::labels::no_seabed);
}

TEST_CASE("The same scene has the same labels in three geometries, with shadows to the right") {
    in::scene s;
    s.seabed = in::seabed::flat{.surface = {.rms = 0}};
    s.add(in::cube{.size = glm::vec3(0.4f)}, {.position = {6, 2, 0.2}}, "cube");
    const auto check = [&](const auto& picture) {
        REQUIRE(picture.labels.targets.size() == 1);
        const in::target_label& t = picture.labels.targets[0];
        CHECK(t.class_name == "cube");
        CHECK((t.area > 0 && t.shadow_area > 0));
        CHECK(t.shadow_box.x1 > t.box.x1);
        CHECK(t.box.y0 + t.box.height() / 2 < picture.image.height() / 2);  // ahead is up
        for (const float v : picture.image.pixels()) REQUIRE(v >= 0);
    };
    check(in::render(s, in::overhead{.position = {5, 0}, .altitude = 4, .size = {400, 400}}));
    check(
        in::flipped_vertically(in::render(s, in::ground_range{.altitude = 4, .pings = 90, .range = 12, .bins = 400})));
    check(in::flipped_vertically(in::render(s, in::side_scan{.altitude = 4, .pings = 90, .range = 12, .bins = 400})));
}
