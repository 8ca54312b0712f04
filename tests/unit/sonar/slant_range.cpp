// Side-scan geometry against closed forms: ranges of echoes, lengths of shadows, intensities and labels, at ordinary
// dimensions and at the limits of their ranges.
#include <insonify/all.hpp>
#include <insonify/core/thread_pool.hpp>
#include <insonify/seabed/blend.hpp>
#include <insonify/seabed/heightfield.hpp>
#include <insonify/sonar/side_scan/range_geometry.hpp>
#include <insonify/sonar/side_scan/recording.hpp>
#include <insonify/sonar/side_scan/slant_to_ground.hpp>
#include <insonify/sonar/side_scan/swath.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../../catch.hpp"
#include "../../single_pings.hpp"

namespace in = insonify;
namespace rg = insonify::range_geometry;
using namespace in::literals;
using single_pings::one_ping;

namespace {

const in::seabed::flat plane{.surface = {.rms = 0}};

in::scene level_bottom() {
    in::scene s;
    s.seabed = plane;
    return s;
}

struct run {
    int first = -1, last = -1, count = 0;
};
template <class Fn>
run where(const in::image<std::uint16_t>& picture, Fn&& holds, int row = 0) {
    run r;
    for (int x = 0; x < picture.width(); ++x)
        if (holds(picture(x, row))) {
            if (r.first < 0) r.first = x;
            r.last = x;
            ++r.count;
        }
    return r;
}

double degrees(double radians) {
    return in::numeric::to_degrees(radians);
}

/// The table of closed forms.
struct row {
    double altitude, ground, height, grazing, shadow, slant_shadow, apparent;
};
constexpr row table[] = {{3, 10, 0.3, 16.70, 1.1111, 1.1509, 9.914},  {3, 20, 0.5, 8.53, 4.0000, 4.0311, 19.931},
                         {4, 20, 0.5, 11.31, 2.8571, 2.9006, 19.906}, {7.5, 50, 1, 8.53, 7.6923, 7.7570, 49.860},
                         {10, 75, 1, 7.59, 8.3333, 8.3931, 74.873},   {5, 8, 1, 32.01, 2.0000, 2.2361, 7.416}};

/// A target, where its echo begins, and where its shadow ends.
struct outline {
    std::string name;
    in::mesh shape;
    double first_echo, shadow_end;  // slant ranges
    double ground;                  // ground range of its middle
};

/// Four targets as high as the table says; what casts the tip of the shadow stands at the table's ground range.
std::vector<outline> targets_of(const row& t) {
    const double a = t.altitude, x = t.ground, h = t.height;
    const auto size = static_cast<float>(h);
    std::vector<outline> all;
    // A cube: the tip is its far upper edge's, the first echo its near upper edge's.
    all.push_back({"cube", to_mesh(in::cube{.size = glm::vec3(size)}), rg::slant_range(x - h, a, h),
                   rg::slant_range(rg::shadow_tip(x, a, h), a), x - h / 2});
    // Round in the plane of the ping: the circle's nearest point, and the ray that touches it.
    const double r = h / 2, distance = rg::slant_range(x, a, r);
    const double touching = std::atan2(a - r, x) - std::asin(r / distance);
    const double end = a / std::sin(touching);
    all.push_back({"cylinder", to_mesh(in::cylinder{.radius = size / 2, .length = 4 * size, .segments = 1024}),
                   distance - r, end, x});
    all.push_back({"sphere", to_mesh(in::sphere{.radius = size / 2, .segments = 1024}), distance - r, end, x});
    // A cone: its tip casts the shadow's; the nearest point lies on the side, between the foot and the tip.
    const double base = h / 2;
    double first = 1e30;
    for (int i = 0; i <= 1000; ++i)
        first = (std::min)(first, rg::slant_range(x - base * (1 - i / 1000.0), a, h * i / 1000.0));
    all.push_back({"cone", to_mesh(in::cone{.radius = size / 2, .height = size, .segments = 256}), first,
                   rg::slant_range(rg::shadow_tip(x, a, h), a), x});
    return all;
}

}  // namespace

TEST_CASE("Closed forms of side-scan geometry give the values of the table") {
    for (const row& t : table) {
        CHECK(degrees(rg::grazing_angle(t.ground, t.altitude)) == Approx(t.grazing).margin(0.006));
        CHECK(rg::shadow_length(t.ground, t.altitude, t.height) == Approx(t.shadow).margin(6e-5));
        CHECK(rg::slant_shadow_length(t.ground, t.altitude, t.height) == Approx(t.slant_shadow).margin(6e-5));
        CHECK(rg::apparent_ground(t.ground, t.altitude, t.height) == Approx(t.apparent).margin(6e-4));
        CHECK(rg::apparent_ground(t.ground, t.altitude, t.height) ==
              Approx(std::sqrt(t.ground * t.ground - 2 * t.altitude * t.height + t.height * t.height)));
        // Heights from shadows invert exactly.
        const double tip = rg::shadow_tip(t.ground, t.altitude, t.height);
        CHECK(rg::height_from_shadow(t.ground, tip, t.altitude) == Approx(t.height).epsilon(1e-12));
        CHECK(rg::height_from_shadow(rg::slant_range(t.ground, t.altitude, t.height), rg::slant_range(tip, t.altitude),
                                     t.altitude) == Approx(t.height).epsilon(1e-12));
    }
    CHECK(rg::slant_range(20, 4, 0.5) == Approx(20.304).margin(5e-4));
    CHECK(rg::ground_resolution(1500 * 50e-6 / 2, in::numeric::to_radians(20)) == Approx(0.0399).margin(5e-5));
    CHECK(rg::along_track_footprint(30, in::numeric::to_radians(0.3)) == Approx(0.157).margin(5e-4));
}

TEST_CASE("Closed forms are never NaN, also where a quantity does not exist") {
    CHECK(rg::ground_range(4, 4) == 0);
    CHECK(rg::ground_range(3, 4) == 0);
    CHECK(std::isinf(rg::shadow_length(10, 3, 3)));
    CHECK(std::isinf(rg::shadow_tip(10, 3, 4)));
    CHECK(std::isinf(rg::slant_shadow_length(10, 3, 4)));
    CHECK(rg::apparent_ground(1, 10, 1) == 0);  // heard before the bottom is
    CHECK(degrees(rg::grazing_angle(0, 10)) == Approx(90));
    CHECK(rg::height_from_shadow(0, 0, 10) == 0);
}

TEST_CASE("Closed forms are never NaN below the datum and far away") {
    CHECK(rg::ground_range(1, -5) == 0);
    CHECK(rg::apparent_ground(0, -5, -4) == 0);
    CHECK(std::isinf(rg::slant_shadow_length(1e200, 5, 1)));
}

TEST_CASE("Echoes and shadows of the four targets arrive where the table's closed forms say, within a bin") {
    for (const row& t : table)
        for (const outline& expected : targets_of(t)) {
            in::scene s = level_bottom();
            s.add(expected.shape, {.position = {expected.ground, 0, t.height / 2}, .yaw = 90_deg}, expected.name);
            const double range = rg::slant_range(t.ground + 2 * t.shadow + 2, t.altitude);
            const in::side_scan rig = one_ping(t.altitude, range, 4096);
            const auto heard = in::render(s, rig, {.cell = 0.02});
            const auto bin_of = [&](double r) { return r / rig.bin(); };
            INFO(expected.name << " at " << t.ground << " m from " << t.altitude << " m");

            const run target = where(heard.labels.instance, [](auto i) { return i == 1; });
            const run shadow = where(heard.labels.shadow, [](auto i) { return i == 1; });
            CHECK(target.first == Approx(bin_of(expected.first_echo)).margin(1.01));
            CHECK(shadow.last + 1 == Approx(bin_of(expected.shadow_end)).margin(1.01));
            CHECK(shadow.last - shadow.first + 1 == shadow.count);  // in one piece
            // The height, measured from the picture as operators do.
            if (expected.name == "cone") {
                const double tip = (shadow.last + 1) * rig.bin();
                CHECK(rg::height_from_shadow(rg::slant_range(t.ground, t.altitude, t.height), tip, t.altitude) ==
                      Approx(t.height).margin(1.5 * t.altitude / tip * rig.bin()));
            }
        }
}

TEST_CASE("Layover: a cube's foot returns after its upper edge, by x - sqrt(x^2 - 2 A h + h^2)") {
    for (const row& t : table) {
        in::scene s = level_bottom();
        s.add(in::cube{.size = glm::vec3(static_cast<float>(t.height))},
              {.position = {t.ground + t.height / 2, 0, t.height / 2}}, "cube");
        const in::side_scan rig = one_ping(t.altitude, rg::slant_range(t.ground + 3, t.altitude), 8192);
        const in::ground_range map{
            .altitude = rig.altitude, .pings = 1, .range = static_cast<float>(t.ground) + 3, .bins = 8192};
        const auto corrected = in::to_ground_range(in::render(s, rig, {.cell = 0.02}), rig, map);
        const run target = where(corrected.labels.instance, [](auto i) { return i == 1; });
        CHECK((target.first + 0.5) * map.bin() == Approx(t.apparent).margin(1.5 * map.bin() + 6e-4));
        // The map itself has no layover: the same face stands where it is.
        const auto straight = in::render(s, map, {.cell = 0.02});
        const run upright = where(straight.labels.instance, [](auto i) { return i == 1; });
        CHECK(upright.first * map.bin() == Approx(t.ground).margin(1.5 * map.bin()));
        const run shadow = where(straight.labels.shadow, [](auto i) { return i == 1; });
        const double tip = rg::shadow_tip(t.ground + t.height, t.altitude, t.height);
        if (tip < t.ground + 3) CHECK((shadow.last + 1) * map.bin() == Approx(tip).margin(1.01 * map.bin()));
    }
}

TEST_CASE("The water column is empty up to the first return at R = A, the strongest echo of level seabed") {
    for (const double altitude : {0.5, 3.0, 20.0}) {
        const in::side_scan rig = one_ping(altitude, 5 * altitude, 1000);
        const auto heard = in::render(level_bottom(), rig);
        const auto samples = heard.image.row(0);
        const int first = static_cast<int>(std::find_if(samples.begin(), samples.end(), [](float v) { return v > 0; }) -
                                           samples.begin());
        CHECK(first == Approx(200).margin(1));
        CHECK(std::max_element(samples.begin(), samples.end()) - samples.begin() <= first + 1);
        for (int x = 0; x < first; ++x) CHECK(heard.labels.seabed(x, 0) == in::labels::no_seabed);
        for (int x = first + 1; x < 1000; ++x) CHECK(heard.labels.seabed(x, 0) == 0);
        CHECK(where(heard.labels.shadow, [](auto i) { return i != in::labels::no_shadow; }).count == 0);
    }
}

TEST_CASE("The face of a cube towards the sonar is the brightest part of the picture") {
    for (const auto side : {in::side::port, in::side::starboard}) {
        in::scene s = level_bottom();
        const double x = side == in::side::port ? -12 : 12;
        s.add(in::cube{.size = glm::vec3(0.6f)}, {.position = {x, 1, 0.3}}, "cube");
        const in::side_scan rig{.altitude = 4, .pings = 50, .first_range = 6, .range = 20, .bins = 700, .side = side};
        const auto heard = in::render(s, rig);
        float loudest_bottom = 0, loudest_target = 0;
        int at = 0;
        for (std::size_t i = 0; i < heard.image.size(); ++i) {
            const float v = heard.image.pixels()[i];
            if (heard.labels.instance.pixels()[i] == 0) {
                loudest_bottom = (std::max)(loudest_bottom, v);
            } else if (v > loudest_target) {
                loudest_target = v;
                at = static_cast<int>(i) % 700;
            }
        }
        CHECK(loudest_target > 10 * loudest_bottom);
        const double range = 6 + (at + 0.5) * rig.bin();
        CHECK(range >= rg::slant_range(11.7, 4, 0.6) - rig.bin());
        CHECK(range <= rg::slant_range(11.7, 4, 0) + rig.bin());
    }
}

TEST_CASE("Port of a mirrored scene is starboard, and half a turn of the track exchanges them") {
    in::scene s = level_bottom(), mirrored = level_bottom();
    s.add(in::cube{.size = {0.5f, 0.4f, 0.6f}}, {.position = {7, 1, 0.3}, .yaw = 0.4f}, "cube");
    mirrored.add(in::cube{.size = {0.5f, 0.4f, 0.6f}}, {.position = {-7, 1, 0.3}, .yaw = -0.4f}, "cube");
    in::side_scan rig{.altitude = 3, .pings = 60, .range = 14, .bins = 400};
    const auto starboard = in::render(s, rig);
    rig.side = in::side::port;
    const auto port = in::render(mirrored, rig);
    REQUIRE(starboard.labels.targets[0].area > 50);
    int different = 0;
    for (std::size_t i = 0; i < port.image.size(); ++i)
        different += port.image.pixels()[i] != Approx(starboard.image.pixels()[i]).epsilon(1e-3).margin(1e-4);
    CHECK(different <= 10);

    // The other way along the same line, looking to the other side: the same picture upside down.
    in::side_scan back = rig;
    back.position = {0, 59 * 0.04};
    back.yaw = 180_deg;
    const auto turned = in::render(s, back);
    different = 0;
    for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 400; ++x) different += turned.labels.instance(x, 59 - y) != starboard.labels.instance(x, y);
    CHECK(different <= 20);
}

TEST_CASE("A scene moved and rotated with the track gives the same recording") {
    const auto heard_at = [](glm::dvec2 offset, float yaw) {
        in::scene s = level_bottom();
        const double c = std::cos(static_cast<double>(yaw)), d = std::sin(static_cast<double>(yaw));
        const glm::dvec2 at = offset + glm::dvec2(8 * c - 1 * d, 8 * d + 1 * c);
        s.add(in::cone{.radius = 0.4f, .height = 0.8f}, {.position = {at.x, at.y, 0.4}, .yaw = yaw}, "cone");
        return in::render(s, in::side_scan{.position = offset,
                                           .altitude = 3,
                                           .yaw = yaw,
                                           .ping_spacing = 0.05f,
                                           .pings = 40,
                                           .range = 15,
                                           .bins = 300});
    };
    const auto here = heard_at({0, 0}, 0);
    for (const auto& [offset, yaw] : {std::pair{glm::dvec2(1e6, -2e6), 0.0f}, {{0, 0}, 0.7f}, {{-300, 1e5}, -2.5f}}) {
        const auto there = heard_at(offset, yaw);
        int different = 0;
        for (std::size_t i = 0; i < here.image.size(); ++i)
            different += there.labels.instance.pixels()[i] != here.labels.instance.pixels()[i] ||
                         there.image.pixels()[i] != Approx(here.image.pixels()[i]).epsilon(0.02).margin(1e-3);
        CHECK(different <= 60);  // of 12000
    }
}

TEST_CASE("A target as high as the sonar, and higher, shades the bottom to the end of the swath") {
    for (const double height : {2.9, 3.0, 5.0}) {
        in::scene s = level_bottom();
        s.add(in::cube{.size = {1, 1, static_cast<float>(height)}}, {.position = {10, 0, height / 2}}, "wall");
        const in::side_scan rig = one_ping(3, 40, 2000);
        const auto heard = in::render(s, rig);
        const run shadow = where(heard.labels.shadow, [](auto i) { return i == 1; });
        CHECK(shadow.last == 1999);
        // It begins where the face ends; the top, if it is seen at all, is met by a ray or two.
        CHECK(shadow.first >= rg::slant_range(9.5, 3, 0) / rig.bin() - 1);
        CHECK(shadow.first <= rg::slant_range(10.5, 3, height < 3 ? height : 0) / rig.bin() + 1);
        // Its face is heard from where it is nearest: at the sonar's own height, or its upper edge.
        const run target = where(heard.labels.instance, [](auto i) { return i == 1; });
        CHECK(target.first == Approx(rg::slant_range(9.5, 3, (std::min)(height, 3.0)) / rig.bin()).margin(1.01));
        for (const float v : heard.image.row(0)) REQUIRE((v >= 0 && in::numeric::is_finite(v)));
    }
}

TEST_CASE("A target at nadir returns before the seabed, and shades the seabed below it") {
    in::scene s = level_bottom();
    s.add(in::cube{.size = {1, 1, 2}}, {.position = {0, 0, 1}}, "block");
    const in::side_scan rig = one_ping(5, 15, 1500);
    const auto heard = in::render(s, rig);
    const run target = where(heard.labels.instance, [](auto i) { return i == 1; });
    CHECK(target.first == Approx(300).margin(1));  // 3 m: altitude less height
    const run shadow = where(heard.labels.shadow, [](auto i) { return i == 1; });
    const double tip = rg::shadow_tip(0.5, 5, 2);
    CHECK(shadow.last + 1 == Approx(rg::slant_range(tip, 5) / rig.bin()).margin(1.01));
    CHECK(shadow.first == Approx(500).margin(1));
}

TEST_CASE("Ranges below the altitude and pings below the seabed return nothing") {
    const in::side_scan rig = one_ping(10, 9, 64);
    for (const double altitude : {10.0, 0.0, -1.0}) {
        const in::ping track[] = {{.position = {0, 0, altitude}}, {.position = {0, 0, 5}}};
        const auto heard = in::record(level_bottom(), track, rig);
        for (const float v : heard.image.row(0)) CHECK(v == 0);
        for (const auto v : heard.labels.seabed.row(0)) CHECK(v == in::labels::no_seabed);
        for (const auto v : heard.labels.shadow.row(0)) CHECK(v == in::labels::no_shadow);
        const auto other = heard.image.row(1);
        CHECK(std::count_if(other.begin(), other.end(), [](float v) { return v > 0; }) > 10);
    }
}

TEST_CASE("A recording of which all pings are below the seabed is refused (depths passed as heights)") {
    for (const double altitude : {0.0, -5.0})
        CHECK_THROWS_WITH(in::render(level_bottom(), one_ping(altitude, 9, 64)),
                          ContainsSubstring("altitude of the highest ping is " + in::detail::to_text(altitude) +
                                            ", expected above the seabed's lowest height, 0"));
}

TEST_CASE("A sonar inside a hill receives nothing; one beside a cliff receives the cliff and nothing behind it") {
    in::seabed::heightfield map{.heights = in::image<float>(60, 20), .origin = {-10, -5}, .spacing = 0.5};
    for (int j = 0; j < 20; ++j)
        for (int i = 0; i < 60; ++i) map.heights(i, j) = i < 20 || i > 40 ? 4.0f : 0.0f;  // a valley from 0 to 10 m
    in::scene s;
    s.seabed = map;
    in::side_scan rig = one_ping(2, 18, 360);
    rig.position = {-5, 0};
    const auto buried = in::render(s, rig);
    for (const float v : buried.image.pixels()) CHECK(v == 0);
    rig.position = {3, 0};
    const auto heard = in::render(s, rig);
    float loudest = 0;
    for (int b = 0; b < 360; ++b) {
        const double range = (b + 0.5) * rig.bin();
        if (range > 7.8 && range > rg::slant_range(7.5, 2, 4) + 0.1) CHECK(heard.image(b, 0) == 0);
        if (range > 6.8 && range < 7.8) loudest = (std::max)(loudest, heard.image(b, 0));
        REQUIRE(heard.image(b, 0) >= 0);
    }
    CHECK(loudest > 10 * heard.image(100, 0));
}

TEST_CASE("Grazing angles from a tenth of a degree to almost a right angle give finite, level pictures") {
    // 0.1 degrees: 100 m away from 17.5 cm.
    const in::side_scan low{.altitude = 0.1745f, .pings = 1, .first_range = 90, .range = 110, .bins = 400};
    const auto heard = in::render(level_bottom(), low, {.cell = 0.05});
    for (const float v : heard.image.row(0)) CHECK(v == Approx(0.45).epsilon(0.01));
    in::scene s = level_bottom();
    s.add(in::cube{.size = glm::vec3(0.1f)}, {.position = {95, 0, 0.05}}, "cube");
    const auto with_cube = in::render(s, low, {.cell = 0.05});
    const run shadow = where(with_cube.labels.shadow, [](auto i) { return i == 1; });
    CHECK(shadow.last == 399);  // to 222 m
    // 89.9 degrees: 10 cm beside the point below, from 57 m.
    const in::side_scan steep{.altitude = 57.3f, .pings = 1, .first_range = 57.2f, .range = 57.4f, .bins = 2000};
    const auto below = in::render(level_bottom(), steep, {.cell = 0.01});
    const run bottom = where(in::map_pixels(below.labels.seabed, [](auto t) { return std::uint16_t{t}; }),
                             [](auto t) { return t == 0; });
    CHECK(bottom.first == Approx(1000).margin(2));
    CHECK(bottom.last == 1999);
    for (const float v : below.image.row(0)) REQUIRE((v >= 0 && in::numeric::is_finite(v)));
}

TEST_CASE("Bins of a centimetre are resolved over ten kilometres", "[.slow]") {
    in::scene s = level_bottom();
    s.add(in::cube{.size = glm::vec3(1)}, {.position = {9990.5, 0, 0.5}}, "cube");
    const in::side_scan rig{
        .altitude = 100, .ping_spacing = 0.5f, .pings = 1, .first_range = 9980, .range = 10010, .bins = 3000};
    const auto heard = in::render(s, rig, {.cell = 0.1});
    const run target = where(heard.labels.instance, [](auto i) { return i == 1; });
    CHECK(target.first == Approx((rg::slant_range(9990, 100, 1) - 9980) / rig.bin()).margin(1.5));
}

TEST_CASE("render() gives the same bytes for any number of threads, and one ping at a time") {
    in::scene s;
    s.seabed = in::seabed::blend{.first = in::seabed::ripples{}, .second = in::seabed::rock{}};
    s.add(in::sphere{.radius = 0.4f}, {.position = {6, 1, 0.4}}, "sphere");
    const in::side_scan rig{.altitude = 3, .yaw = 0.3f, .pings = 50, .range = 15, .bins = 256};
    const auto expected = in::render(s, rig);
    for (const int threads : {2, 5}) {
        in::thread_pool pool(threads);
        const auto heard = in::render(s, rig, {}, pool);
        CHECK(heard.image == expected.image);
        CHECK(heard.labels.instance == expected.labels.instance);
        CHECK(heard.labels.shadow == expected.labels.shadow);
        CHECK(heard.labels.seabed == expected.labels.seabed);
    }
    const auto track = in::track_of(rig);
    for (const int i : {0, 17, 49}) {
        const auto alone = in::record(s, std::span(track).subspan(static_cast<std::size_t>(i), 1), rig);
        CHECK(std::equal(alone.image.row(0).begin(), alone.image.row(0).end(), expected.image.row(i).begin()));
    }
    const auto bare = in::render(s, rig, in::record_options<in::no_labels>{});
    static_assert(std::is_empty_v<decltype(bare.labels)>);
    CHECK(bare.image == expected.image);
}

TEST_CASE("A window of ranges equals that part of the whole picture") {
    in::scene s;
    s.seabed = in::seabed::rock{.relief = 0.3f};
    s.add(in::cube{.size = glm::vec3(0.7f)}, {.position = {8.5, 0.6, 0.4}, .yaw = 0.5f}, "cube");
    const in::side_scan all{.altitude = 4, .ping_spacing = 0.0625f, .pings = 24, .range = 16, .bins = 512};
    in::side_scan part = all;
    part.first_range = 7;
    part.range = 12;
    part.bins = 160;
    const auto whole = in::render(s, all), window = in::render(s, part);
    int different = 0;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 160; ++x) {
            different += window.labels.instance(x, y) != whole.labels.instance(224 + x, y) ||
                         window.labels.shadow(x, y) != whole.labels.shadow(224 + x, y) ||
                         window.image(x, y) != Approx(whole.image(224 + x, y)).epsilon(1e-3).margin(1e-4);
        }
    CHECK(different <= 40);  // of 3840: at the ends
}

/// A recording of a window of ranges; with `all`, a pebble beside the first row near nadir forces the bottom to be
/// sampled from nadir on.
template <in::across_track Axis>
in::frame<in::labels> window_of(const in::seabed::any& bottom, const in::side_scan_rig<Axis>& rig, bool all) {
    in::scene s;
    s.seabed = bottom;
    const in::ping_frame middle(in::ping_of(rig, rig.pings / 2), rig.side), first(in::ping_of(rig, 0), rig.side);
    const double range = 0.5 * static_cast<double>(rig.first_range + rig.range);
    s.add(in::cube{.size = glm::vec3(0.6f)}, {.position = glm::dvec3(middle.world(range, 0), 0.2), .yaw = 0.5f},
          "cube");
    s.add(in::sphere{.radius = 0.01f}, {.position = glm::dvec3(first.world(all ? 1 : range + 1, 0), 0)}, "pebble");
    return in::render(s, rig);
}

TEST_CASE("A window samples only seabed that can return into it or occlude it, with the same bytes") {
    const in::seabed::any bottoms[] = {
        in::seabed::flat{}, in::seabed::ripples{.wavelength = 0.6f, .steepness = 0.12f}, in::seabed::mud{},
        in::seabed::rock{.relief = 0.2f},
        in::seabed::blend{.first = in::seabed::ripples{.steepness = 0.06f}, .second = in::seabed::mud{}, .patch = 4}};
    const auto check = [](const in::seabed::any& bottom, const auto& rig) {
        const auto part = window_of(bottom, rig, false), whole = window_of(bottom, rig, true);
        REQUIRE(part.stats.seabed_samples < whole.stats.seabed_samples);
        for (int y = 1; y < rig.pings; ++y)
            for (int x = 0; x < rig.bins; ++x) {
                REQUIRE(part.image(x, y) == whole.image(x, y));
                REQUIRE(part.labels.instance(x, y) == whole.labels.instance(x, y));
                REQUIRE(part.labels.shadow(x, y) == whole.labels.shadow(x, y));
                REQUIRE(part.labels.seabed(x, y) == whole.labels.seabed(x, y));
            }
    };
    // For any alignment of the bottom's tiles.
    for (int turn = 0; turn < 60; ++turn) {
        const float angle = 0.1f * static_cast<float>(turn);
        INFO("yaw " << angle);
        check(bottoms[1], in::side_scan{.position = {turn, -3.3 * turn},
                                        .altitude = 3,
                                        .yaw = angle,
                                        .pings = 16,
                                        .first_range = 9 + angle,
                                        .range = 11 + angle,
                                        .bins = 50});
    }
    for (const in::seabed::any& bottom : bottoms)
        for (const float altitude : {4.0f, 9.0f})
            for (const float distance : {3.0f, 8.0f}) {
                INFO("bottom " << bottom.legend().front().name << ", altitude " << altitude << ", distance "
                               << distance);
                in::side_scan rig{.position = {17, -40},
                                  .altitude = altitude,
                                  .yaw = altitude,
                                  .pings = 24,
                                  .first_range = distance * altitude,
                                  .range = distance * altitude + 4,
                                  .bins = 100,
                                  .side = distance < 4 ? in::side::port : in::side::starboard};
                check(bottom, rig);
                check(bottom, in::ground_range{.position = rig.position,
                                               .altitude = rig.altitude,
                                               .yaw = rig.yaw,
                                               .pings = rig.pings,
                                               .first_range = rig.first_range,
                                               .range = rig.range,
                                               .bins = rig.bins,
                                               .side = rig.side});
            }
}

TEST_CASE("Coarse and fine pictures have the same total energy") {
    in::scene s;
    s.seabed = in::seabed::ripples{.steepness = 0.05f};
    s.add(in::cube{.size = glm::vec3(0.5f)}, {.position = {9, 1, 0.25}, .yaw = 0.5f}, "cube");
    using bare = in::record_options<in::labels, in::lambert_backscatter, in::sonar_equation<>>;
    in::side_scan fine{.altitude = 5, .pings = 50, .range = 20, .bins = 2000};
    in::side_scan coarse = fine;
    coarse.bins = 40;
    const auto many = in::render(s, fine, bare{}), few = in::render(s, coarse, bare{});
    const auto power = [](const auto& heard, int from, int to) {
        double sum = 0;
        for (int y = 0; y < 50; ++y)
            for (int x = from; x < to; ++x) sum += static_cast<double>(heard.image(x, y));
        return sum;
    };
    for (int b = 12; b < 40; ++b) {
        INFO("bin " << b);
        CHECK(power(few, b, b + 1) == Approx(power(many, 50 * b, 50 * (b + 1))).epsilon(0.15));
    }
    CHECK(power(few, 0, 40) == Approx(power(many, 0, 2000)).epsilon(0.03));
}

TEST_CASE("render_swath() shows both sides with the water column between them") {
    in::scene s = level_bottom();
    s.add(in::cube{.size = glm::vec3(0.5f)}, {.position = {-6, 0.5, 0.25}}, "port cube");
    s.add(in::cube{.size = glm::vec3(0.5f)}, {.position = {8, 0.5, 0.25}}, "starboard cube");
    const in::side_scan rig{.altitude = 4, .pings = 30, .range = 12, .bins = 300};
    const auto swath = in::render_swath(s, rig);
    REQUIRE(swath.image.width() == 600);
    const int column = static_cast<int>(std::lround(4 / rig.bin()));
    for (int x = 300 - column + 1; x < 300 + column - 1; ++x) CHECK(swath.image(x, 3) == 0);
    CHECK(swath.image(300 + column + 1, 3) > 0);
    CHECK(swath.image(300 - column - 2, 3) > 0);
    REQUIRE(swath.labels.targets.size() == 2);
    for (const in::target_label& t : swath.labels.targets) {
        CHECK(t.area > 0);
        const bool port = t.class_name == "port cube";
        CHECK((t.box.x0 < 300) == port);
        CHECK((t.shadow_box.x0 < t.box.x0) == port);  // shadows fall away from the sonar
    }
}

TEST_CASE("Gaps in the seabed return nothing, and do not occlude") {
    in::seabed::heightfield map{.heights = in::image<float>(101, 41), .origin = {-1, -2}, .spacing = 0.1};
    for (int j = 0; j < 41; ++j)
        for (int i = 50; i < 60; ++i) map.heights(i, j) = std::numeric_limits<float>::quiet_NaN();
    in::scene s;
    s.seabed = map;
    const in::side_scan rig = one_ping(2, 8, 800);
    const auto heard = in::render(s, rig, {.cell = 0.05});
    for (const float v : heard.image.row(0)) REQUIRE((v >= 0 && in::numeric::is_finite(v)));
    CHECK(heard.image(static_cast<int>(rg::slant_range(4.5, 2) / rig.bin()), 0) == 0);
    CHECK(heard.image(static_cast<int>(rg::slant_range(6.5, 2) / rig.bin()), 0) > 0);
}

TEST_CASE("A target below the seabed, seen through a gap, returns the same in a window of ranges") {
    in::seabed::heightfield holed{.heights = in::image<float>(121, 121, 0.0f), .origin = {-15, -15}, .spacing = 0.25};
    for (int j = 0; j < 121; ++j)
        for (int i = 68; i < 100; ++i) holed.heights(i, j) = std::nanf("");  // x from 2 to 10
    in::scene s;
    s.seabed = holed;
    s.add(in::cube{}, {.position = {2.5, 0, -2.5}, .yaw = 0.3f}, "cube");
    in::side_scan rig{.altitude = 5, .pings = 1, .range = 16, .bins = 320};
    const auto whole = in::render(s, rig, {.cell = 0.02});  // a ray more or less through the gap matters little
    rig.first_range = 7;
    rig.bins = 180;
    const auto part = in::render(s, rig, {.cell = 0.02});
    double sum = 0, of_whole = 0;
    for (int b = 0; b < 180; ++b)
        if (part.labels.instance(b, 0) == 1 || whole.labels.instance(140 + b, 0) == 1)
            sum += static_cast<double>(part.image(b, 0)), of_whole += static_cast<double>(whole.image(140 + b, 0));
    CHECK(of_whole > 0);
    CHECK(sum == Approx(of_whole).epsilon(0.01));
    CHECK(part.labels.targets[0].box.width() == whole.labels.targets[0].box.width());
}

TEST_CASE("Seabed in front of its edge returns what it does without one, level and pitched, in any window") {
    const auto bins_of = [](const in::seabed::any& bottom, double altitude, double pitch, float first_range) {
        in::scene s;
        s.seabed = bottom;
        const in::side_scan rig{.first_range = first_range, .range = 40, .bins = 400};
        return in::record(s, std::vector<in::ping>{{.position = {0, 0, altitude}, .pitch = pitch}}, rig).image;
    };
    in::seabed::heightfield edged{.heights = in::image<float>(121, 121, 0.0f), .origin = {-60, -60}, .spacing = 1};
    for (int j = 0; j < 121; ++j)
        for (int i = 91; i < 121; ++i) edged.heights(i, j) = std::numeric_limits<float>::quiet_NaN();
    const in::seabed::flat level{.surface = {.rms = 0}};
    for (const double altitude : {20.0, 30.0})
        for (const double pitch : {0.0, 0.05})
            for (const float first : {0.0f, 32.0f}) {
                const auto whole = bins_of(level, altitude, pitch, first),
                           part = bins_of(edged, altitude, pitch, first);
                for (int b = 0; b < 400; ++b) {
                    const double slant =
                        static_cast<double>(first) + (b + 0.5) * (40 - static_cast<double>(first)) / 400;
                    const double across = std::sqrt((std::max)(0.0, slant * slant - altitude * altitude));
                    if (across < 0.2 * altitude || across > 29) continue;
                    CAPTURE(altitude, pitch, first, b);
                    REQUIRE(part(b, 0) == Approx(whole(b, 0)).epsilon(0.02));
                }
            }
}

TEST_CASE("Gains and losses beyond a float's range leave no NaN and no infinity") {
    const auto check = [](const auto& equation, float range, int bins = 512) {
        in::scene s;
        s.seabed = in::seabed::ripples{};
        s.add(in::cube{}, {.position = {20, 0.2, 0.5}}, "cube");
        const in::side_scan rig{.pings = 2, .range = range, .bins = bins};
        const auto picture = in::render(s, rig, in::record_options<>{}.with(equation));
        for (const float v : picture.image.pixels()) REQUIRE(std::isfinite(v));
    };
    using in::sonar_equation, in::vertical_beam, in::level_gain, in::spreading_loss, in::absorption;
    check(sonar_equation{vertical_beam{.beamwidth = 5_deg, .tilt = 20_deg, .side_lobes = 0}, level_gain{}}, 40);
    check(sonar_equation{vertical_beam{.beamwidth = 10_deg, .tilt = 60_deg, .side_lobes = 0}, level_gain{}}, 40);
    check(sonar_equation{spreading_loss{}, absorption{1070}, level_gain{}}, 200);
    check(sonar_equation{spreading_loss{}, absorption{1070}, in::time_varied_gain{.absorption_per_km = 1070}}, 200);
    check(sonar_equation{spreading_loss{}, absorption{322}, level_gain{}}, 400);
    check(sonar_equation{in::source_level{300}, spreading_loss{}}, 40, 8192);

    in::scene bright;
    bright.add(in::cube{}, {.position = {20, 0.2, 0.5}}, "cube");
    bright.targets[0].surface.reflectivity = 3e38f;
    const in::side_scan sparse{.ping_spacing = 1000, .pings = 1, .range = 40, .bins = 64};
    const auto picture = in::render(bright, sparse, in::record_options<>{}.with(sonar_equation<>{}));
    for (const float v : picture.image.pixels()) REQUIRE(std::isfinite(v));
}

TEST_CASE("Intensities are finite and not negative in random scenes and rigs") {
    for (std::uint64_t n = 0; n < 120; ++n) {
        in::random_sequence random(n, 3);
        const auto real = [&](double low, double high) { return static_cast<float>(random.uniform(low, high)); };
        in::scene s = level_bottom();
        if (n % 3 == 1) s.seabed = in::seabed::rock{.relief = real(0.05, 1)};
        if (n % 3 == 2) {  // cliffs and holes
            in::seabed::heightfield map{.heights = in::image<float>(30, 30), .origin = {-5, -5}, .spacing = 0.5};
            for (float& height : map.heights.pixels())
                height = random.below(10) == 0 ? std::numeric_limits<float>::quiet_NaN() : real(-3, 3);
            s.seabed = map;
        }
        for (std::uint32_t i = random.below(4); i > 0; --i) {
            in::mesh m = to_mesh(in::sphere{.radius = std::exp(real(-4, 3)), .segments = 12});
            if (random.below(3) == 0) m.positions[5].y = std::numeric_limits<float>::infinity();
            if (random.below(3) == 0)
                for (glm::vec3& p : m.positions) p.z = 0;
            s.add(m, {.position = {real(-10, 10), real(-3, 3), real(-2, 4)}, .pitch = real(-1, 1)}, "thing");
        }
        const float first = random.below(2) == 0 ? 0 : real(0, 20);
        const double lowest = n % 3 == 2 ? -2.5 : 0.01;  // a sonar below all of the seabed is refused
        const in::side_scan rig{.position = {real(-5, 5), real(-5, 5)},
                                .altitude = random.below(6) == 0 ? real(lowest, 3) : std::exp(real(-4, 3)),
                                .yaw = real(-10, 10),
                                .ping_spacing = std::exp(real(-4, 1)),
                                .pings = 5,
                                .first_range = first,
                                .range = first + std::exp(real(-3, 3)),
                                .bins = 1 + static_cast<int>(random.below(200))};
        const in::ground_range map{.position = rig.position,
                                   .altitude = rig.altitude,
                                   .pings = 5,
                                   .first_range = rig.first_range,
                                   .range = rig.range,
                                   .bins = rig.bins};
        INFO("case " << n);
        const auto heard = in::render(s, rig), seen = in::render(s, map);
        const auto corrected = in::to_ground_range(heard, rig, map);
        for (const auto* picture : {&heard.image, &seen.image, &corrected.image})
            for (const float v : picture->pixels()) REQUIRE((v >= 0 && in::numeric::is_finite(v)));
    }
}

TEST_CASE("A swath that ends where it begins is refused") {
    CHECK_THROWS_WITH(in::render(level_bottom(), in::side_scan{.first_range = 40, .range = 40}),
                      ContainsSubstring("side_scan.range is 40"));
}
