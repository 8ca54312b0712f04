// The bottom as a ping meets it: ground close below the sonar, gaps, slopes under a pitched fan, the first return, and
// windows of ranges, which must hold what the whole recording holds there.
#include <insonify/all.hpp>

#include <cmath>
#include <functional>

#include "../../catch.hpp"

namespace in = insonify;

namespace {

constexpr float no_data = std::numeric_limits<float>::quiet_NaN();

/// Heights by a function of the position, between two bounds.
struct ground {
    static constexpr in::seabed::type kind = in::seabed::type::sand;
    std::function<float(double, double)> height;
    double lowest = 0, highest = 0;

    void row(const in::seabed::scanline& line, std::span<float> heights) const {
        for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = height(line.x(i), line.y);
    }
    in::seabed::height_range range() const { return {lowest, highest}; }
};

const ground sea_level{[](double, double) { return 0.0f; }};

in::scene over(const in::seabed::any& seabed) {
    in::scene s;
    s.seabed = seabed;
    s.bottom.fill({1});
    return s;
}

/// A bin holds reflectivity x sine^2 x area, for one metre of track.
in::frame<in::labels> hear(const in::scene& s, const std::vector<in::ping>& track, float first_range, float range,
                           int bins, double cell = 0) {
    const in::side_scan rig{.ping_spacing = 1, .first_range = first_range, .range = range, .bins = bins};
    in::record_options<> options;
    options.cell = cell;
    return in::record(s, track, rig, options.with(in::sonar_equation<>{}));
}
in::frame<in::labels> hear(const in::scene& s, const in::ping& p, float first_range, float range, int bins,
                           double cell = 0) {
    return hear(s, std::vector{p}, first_range, range, bins, cell);
}

double energy(const in::image<float>& picture, int row = 0) {
    double sum = 0;
    for (const float v : picture.row(row)) sum += static_cast<double>(v);
    return sum;
}
double target_energy(const in::frame<in::labels>& heard) {
    double sum = 0;
    for (int b = 0; b < heard.image.width(); ++b)
        if (heard.labels.instance(b, 0) != 0) sum += static_cast<double>(heard.image(b, 0));
    return sum;
}
int dark_bins(const in::frame<in::labels>& heard, int row = 0) {
    const auto shadows = heard.labels.shadow.row(row);
    return static_cast<int>(std::count_if(shadows.begin(), shadows.end(), [](auto by) { return by != 0; }));
}

}  // namespace

TEST_CASE("Level ground close below the sonar has no empty bins, beside ground that is sixteen times as deep") {
    for (const double depth : {3.0, 2.0, 1.0, 0.35}) {
        const double step = 5 - depth;
        const auto heard =
            hear(over(ground{[=](double x, double) { return x > 12 ? static_cast<float>(step) : 0.0f; }, 0, step}),
                 {.position = {0, 0, 5}}, 0, 40, 800);
        const double bin = 0.05;
        for (int b = static_cast<int>(13 / bin); b < 795; ++b) {
            // Lambert's law on ground at a depth d: sine^2 = (d / R)^2, over dx = R / x dR.
            const double range = (b + 0.5) * bin, x = std::sqrt(range * range - depth * depth);
            CAPTURE(depth, b);
            REQUIRE(heard.image(b, 0) == Approx(depth * depth / (range * x) * bin).epsilon(0.03));
        }
    }
}

TEST_CASE("Nothing is received before the first return, in the bin that ends at the altitude") {
    for (const double cell : {0.0, 0.02}) {
        const auto heard =
            hear(over(in::seabed::flat{.surface = {.rms = 0}}), {.position = {0, 0, 5}}, 0, 40, 400, cell);
        for (int b = 0; b < 50; ++b) CHECK(heard.image(b, 0) == 0);
        CHECK(heard.image(50, 0) > 0);
        CHECK(heard.labels.seabed(50, 0) != in::labels::no_seabed);
        // The integral of sine^2 over the ground within the first bin.
        CHECK(heard.image(50, 0) == Approx(5 * std::acos(5 / 5.1)).epsilon(0.01));
    }
}

TEST_CASE("A pitched ping half a metre from the edge of the data records the same energy as over unbounded ground") {
    for (const double pitch : {0.2, -0.5})
        for (const double edge : {-8.0, 2.0}) {
            // Behind the edge, seen from the foot, the ground is missing; far away it rises, so that its bounds are
            // wide.
            const double side = pitch > 0 ? 1 : -1;
            const in::ping p{.position = {0, edge + side * 0.5 - 10 * std::tan(pitch), 10}, .pitch = pitch};
            const auto height = [=](double, double y) { return side * y > 500 ? 5.0f : 0.0f; };
            const auto beside = [=](double x, double y) { return side * (y - edge) < 0 ? no_data : height(x, y); };
            CAPTURE(pitch, edge);
            CHECK(energy(hear(over(ground{beside, 0, 5}), p, 0, 30, 300).image) ==
                  Approx(energy(hear(over(ground{height, 0, 5}), p, 0, 30, 300).image)).epsilon(1e-4));
        }
}

TEST_CASE("A pitched fan across a steep rise along the track has no shadows, as the rise is level across it") {
    for (const double width : {0.25, 0.1})  // of a step half a metre high
        for (const double pitch : {0.35, 0.5}) {
            const auto step = [=](double, double y) {
                return static_cast<float>(0.5 * std::clamp(y / width, 0.0, 1.0));
            };
            std::vector<in::ping> track;
            for (int i = 0; i < 12; ++i) {
                const double way = (i + 0.5) / 12;  // up the step
                track.push_back({.position = {0, width * way - (5 - 0.5 * way) * std::tan(pitch), 5}, .pitch = pitch});
            }
            const auto heard = hear(over(ground{step, 0, 0.5}), track, 0, 30, 300, 0.02);
            for (int row = 0; row < 12; ++row) {
                CAPTURE(width, pitch, row);
                CHECK(dark_bins(heard, row) == 0);
                CHECK(energy(heard.image, row) > 0);
            }
        }
}

TEST_CASE("A pitched fan finds ground that rises more steeply than the fan descends") {
    // Iterating the depth diverges there. The fan's plane cuts the ground in a line, which shades nothing.
    const auto slope = [](double x, double y) {
        return static_cast<float>(std::clamp(1.5 * y - 0.25 * x, -60.0, 60.0));
    };
    const in::scene s = over(ground{slope, -60, 60});
    const double s45 = std::sqrt(0.5), depth = 5 / (s45 + 1.5 * s45), fall = 0.25 / (s45 + 1.5 * s45);
    const auto heard = hear(s, {.position = {0, 0, 5}, .pitch = 0.25 * in::numeric::pi}, 0, 20, 400);
    CHECK(dark_bins(heard) == 0);
    const double nearest = depth / std::sqrt(1 + fall * fall);
    for (int b = 0; b < 400; ++b) {
        CAPTURE(b, nearest);
        const double from = 0.05 * b;
        if (from + 0.05 < nearest) CHECK(heard.image(b, 0) == 0);
        if (from > nearest) CHECK(heard.image(b, 0) > 0);
    }
}

TEST_CASE("A pitched fan does not meet a cliff behind the sonar, however high it is") {
    for (const double pitch : {0.05, 0.15, 0.3}) {
        const auto heard = [&](double cliff) {
            const in::scene s =
                over(ground{[=](double, double y) { return y < -3 ? static_cast<float>(cliff) : 0; }, 0, 35});
            return energy(hear(s, {.position = {0, 0, 5}, .pitch = pitch}, 0, 20, 200).image);
        };
        CHECK(heard(0) > 0);
        CHECK(heard(35) == heard(0));
    }
}

TEST_CASE("A pitched fan over a gap does not meet the cliff behind the sonar, nor a wall behind the gap") {
    const auto heard = [](double cliff, double from, double to) {
        const auto height = [=](double x, double y) {
            if (y < -3) return static_cast<float>(cliff);
            return x >= from && x < to && y < 3 ? no_data : 0.0f;
        };
        return hear(over(ground{height, 0, 35}), in::ping{.position = {0, 0, 5}, .pitch = 0.3}, 0, 20, 200);
    };
    for (const auto& [from, to] : {std::pair(-1.0, 1.0), std::pair(5.0, 6.0)}) {
        const auto cliff = heard(35, from, to), level = heard(0, from, to);
        CHECK(energy(level.image) > 0);
        CHECK(cliff.image == level.image);
        CHECK(cliff.labels.shadow == level.labels.shadow);
    }
}

TEST_CASE("A pitched ping below the whole seabed, beside one above it, receives nothing") {
    const in::scene s = over(in::seabed::flat{.surface = {.rms = 0}});
    for (const double pitch : {0.5236, -0.5236, 1.2})
        for (const double y : {100.0, 98.6, -100.0, 1e4}) {
            const auto heard = in::record(s, std::vector{in::ping{}, in::ping{.position = {0, y, -3}, .pitch = pitch}},
                                          in::side_scan{});
            CHECK(energy(heard.image, 0) > 0);
            CHECK(energy(heard.image, 1) == 0);
        }
}

TEST_CASE("A pitched fan over ground at the very bounds of its heights is covered by what is sampled") {
    // Rounded to a float, the ground lies below its range. Tiles of 4 m begin at multiples of 4 m.
    const in::scene s = over(ground{[](double, double) { return -1000.7f; }, -1000.7, -1000.7});
    for (int i = 0; i < 6; ++i) {
        const double y = 104 - 1005.7 * std::tan(0.1) - 6e-7 + i * 2e-9;
        CHECK(energy(hear(s, {.position = {0.01, y, 5}, .pitch = 0.1}, 0, 1100, 1000, 0.0625).image) > 0);
    }
}

TEST_CASE("A pitched fan that passes below the border of a gap meets nothing there") {
    const auto heard_at = [](float height) {  // of ground that begins 3 m ahead, where the fan is at 2 m
        const in::scene s = over(ground{[=](double, double y) { return y < 3 ? no_data : height; }, -3, 3});
        return energy(hear(s, {.position = {0, 0, 5}, .pitch = 0.25 * in::numeric::pi}, 0, 20, 200).image);
    };
    CHECK(heard_at(1) > 0);
    CHECK(heard_at(3) == 0);
}

TEST_CASE("A heightfield has data up to the vertices at the border of a gap, on all sides") {
    in::seabed::heightfield field{.heights = in::image<float>(5, 5, 2.0f)};
    field.heights(2, 2) = no_data;
    for (const double along : {0.0, 0.3, 1.0})
        for (const double border : {1.0, 3.0}) {
            CHECK(field.height_at(border, 1 + 2 * along) == 2);
            CHECK(field.height_at(1 + 2 * along, border) == 2);
        }
    CHECK(std::isnan(field.height_at(2, 2)));
    CHECK(std::isnan(field.height_at(1.5, 2)));
    CHECK(std::isnan(field.height_at(2, 2.5)));
}

TEST_CASE("A gap that ends at sampled positions is as wide on both sides of the track") {
    const auto bed = [](double x, double) { return std::abs(x) > 8 && std::abs(x) < 10 ? no_data : 0.0f; };
    const in::scene s = over(ground{bed, 0, 0});
    in::side_scan rig{.ping_spacing = 1, .pings = 1, .range = 20, .bins = 160};
    in::record_options<> options;
    options.cell = 0.125;
    const auto starboard = in::render(s, rig, options);
    rig.side = in::side::port;
    const auto port = in::render(s, rig, options);
    for (int b = 0; b < 160; ++b) {
        CAPTURE(b);
        CHECK(port.image(b, 0) == starboard.image(b, 0));
    }
}

TEST_CASE("In a gap no bin has a label of seabed, on either side, in ground range and in slant range") {
    const auto bed = [](double x, double) { return std::abs(x) > 8 && std::abs(x) < 12 ? no_data : 0.0f; };
    in::scene s = over(ground{bed, 0, 0});
    for (const double x : {-14.0, 14.0}) s.add(in::cube{}, {.position = {x, 0, 0.5}}, "cube");  // seen over the gap
    const in::record_options<> options{.cell = 1};
    const auto check = [&](auto rig) {
        rig.ping_spacing = 1, rig.pings = 1, rig.range = 13, rig.bins = 260;
        const auto frame = in::render(s, rig, options);
        int labelled = 0, silent = 0;
        for (int b = 0; b < 260; ++b) {
            labelled += frame.labels.seabed(b, 0) != in::labels::no_seabed;
            silent += frame.labels.seabed(b, 0) != in::labels::no_seabed && frame.image(b, 0) == 0;
        }
        CHECK(labelled > 80);
        CHECK(silent <= 2);  // at the borders
    };
    for (const in::side side : {in::side::port, in::side::starboard}) {
        check(in::side_scan{.side = side});
        check(in::ground_range{.side = side});
    }
}

TEST_CASE("Without a seabed a target echoes as over a silent one, at any depth below the sonar") {
    for (const double depth : {0.0, 1.5, 4.0, 12.0}) {
        in::scene s = over(ground{[=](double, double) { return static_cast<float>(-depth); }, -depth, -depth});
        s.bottom.fill({0});
        s.add(in::sphere{.radius = 0.5f}, {.position = {8, 0, 0.5 - depth}}, "sphere");
        const in::ping p{.position = {0, 0, 5}};
        const auto over_silent = hear(s, p, 0, 30, 300);
        s.seabed = in::seabed::none{};
        const auto alone = hear(s, p, 0, 30, 300);
        CHECK(target_energy(alone) > 0.01);
        for (int b = 0; b < 300; ++b) {
            CAPTURE(depth, b);
            CHECK(alone.image(b, 0) == Approx(over_silent.image(b, 0)).epsilon(1e-3).margin(1e-5));
        }
    }
}

TEST_CASE("A window that begins behind a step has the labels of the whole recording") {
    for (double at = 8.6; at < 8.8; at += 0.01) {  // the window begins in the shadow of the step, or just beyond it
        in::scene s = over(ground{[=](double x, double) { return x < at ? 0.0f : 0.5f; }, 0, 0.5});
        s.add(in::cube{.size = {0.5f, 4, 1.5f}}, {.position = {15, 0, 1.25}}, "cube");
        const in::ping p{.position = {0, 0, 5}};
        const auto whole = hear(s, p, 0, 30, 300, 0.1), part = hear(s, p, 12, 30, 180, 0.1);
        int differing = 0;
        for (int b = 0; b < 180; ++b)
            differing += whole.labels.shadow(b + 120, 0) != part.labels.shadow(b, 0) ||
                         whole.labels.seabed(b + 120, 0) != part.labels.seabed(b, 0) ||
                         whole.labels.instance(b + 120, 0) != part.labels.instance(b, 0);
        CAPTURE(at);
        CHECK(differing == 0);
    }
}

TEST_CASE("A window close to the first return of a pitched ping holds that part of the whole recording") {
    const in::scene s = over(sea_level);
    for (const double pitch : {0.6, -0.9}) {
        const in::ping p{.position = {0, 0, 5}, .pitch = pitch};
        const auto first = static_cast<float>(5 / std::cos(pitch) + 0.2);
        const in::frame<in::labels> window = hear(s, p, first, first + 3, 60),
                                    whole = hear(s, p, first - 3, first + 3, 120);
        for (int b = 0; b < 60; ++b) {
            CAPTURE(pitch, b);
            CHECK(window.image(b, 0) == Approx(whole.image(60 + b, 0)).epsilon(1e-3));
            CHECK(window.labels.shadow(b, 0) == in::labels::no_shadow);
        }
    }
}

TEST_CASE("A buried target below a gap in front of a window echoes in it as in the whole recording") {
    in::scene s = over(ground{[](double x, double) { return x > 0.5 && x < 3 ? no_data : 0.0f; }, 0, 0});
    s.add(in::cube{.size = {2, 4, 2}}, {.position = {16, 0, -40}}, "cube");
    const in::ping p{.position = {0, 0, 5}};
    const double whole = target_energy(hear(s, p, 0, 60, 600));
    CHECK(whole > 1);
    CHECK(target_energy(hear(s, p, 12, 60, 480)) == Approx(whole).epsilon(0.001));
}

TEST_CASE("The buried part of a target is silent in a window whose rays begin in front of the sampled bottom") {
    // Beyond a gap the rays reach down to the post's foot, and the steepest of them would meet its side.
    in::scene s = over(ground{[](double x, double) { return x > 11 ? no_data : 0.0f; }});
    s.add(in::cube{.size = {1, 1, 4}}, {.position = {9.6, 0, -1.5}}, "post");
    const in::ping p{.position = {0, 0, 5}};
    const in::frame<in::labels> window = hear(s, p, 9, 13, 100), whole = hear(s, p, 5, 13, 200);
    CHECK(target_energy(window) > 0);
    for (int b = 0; b < 100; ++b) {
        CAPTURE(b);
        CHECK(window.image(b, 0) == Approx(whole.image(100 + b, 0)).epsilon(1e-4));
        CHECK(window.labels.instance(b, 0) == whole.labels.instance(100 + b, 0));
    }
}

TEST_CASE("A ping's row does not depend on the pings that are recorded with it") {
    in::scene s =
        over(ground{[](double x, double) { return x > 1 && x < 2 ? no_data : 0.05f * static_cast<float>(std::sin(x)); },
                    -0.05, 0.05});
    s.add(in::cube{.size = {2, 2, 2}}, {.position = {16, 50, -10}}, "cube");
    const in::ping first{.position = {0, 0, 5}}, over_target{.position = {4, 50, 5}};
    const auto alone = hear(s, first, 20, 30, 200), both = hear(s, {first, over_target}, 20, 30, 200);
    for (int b = 0; b < 200; ++b) CHECK(both.image(b, 0) == alone.image(b, 0));
}

TEST_CASE("The range of the last column bounds positions across the track, not the heights of targets there") {
    for (const double height : {10.0, 60.0}) {
        in::scene s = over(in::seabed::flat{.surface = {.rms = 0}});
        s.add(in::cube{.size = {1, 4, 1}}, {.position = {38, 0, height}}, "high");
        const in::ground_range rig{.ping_spacing = 1, .pings = 1, .range = 40, .bins = 400};
        const auto heard = in::render(s, rig, in::record_options<>{}.with(in::sonar_equation<>{}));
        CAPTURE(height);
        CHECK(target_energy(heard) == Approx(0.9).epsilon(0.03));  // the area of a side that the rays meet, about 1 m
    }
}

TEST_CASE("A shadow is labelled with the target that covers most of a ray, however finely it is meshed") {
    // Behind both plates the ground is dark; the higher part of each ray meets the plate of many strips.
    const auto strips = [](int count) {
        in::mesh m;
        for (int i = 0; i < count; ++i) {
            const auto low = static_cast<float>(0.6 * i / count), high = static_cast<float>(0.6 * (i + 1) / count);
            const auto first = static_cast<std::uint32_t>(m.positions.size());
            for (const glm::vec3 p : {glm::vec3(0, -1, low), {0, 1, low}, {0, 1, high}, {0, -1, high}})
                m.positions.push_back(p);
            m.triangles.push_back({first, first + 2, first + 1});
            m.triangles.push_back({first, first + 3, first + 2});
        }
        return m;
    };
    const auto shadows = [&](int count, double border) {
        in::scene s = over(in::seabed::flat{.surface = {.rms = 0}});
        s.add(strips(count), {.position = {10, 0, border}}, "of strips");
        s.add(strips(1), {.position = {10, 0, border - 0.6}}, "in one piece");
        return hear(s, in::ping{.position = {0, 0, 5}}, 0, 20, 60, 0.4).labels.shadow;
    };
    for (double border = 0.3; border < 0.6; border += 0.02) {
        CAPTURE(border);
        CHECK(shadows(40, border) == shadows(1, border));
    }
}

TEST_CASE("Cells so small that the seabed would not fit into memory are refused") {
    const in::side_scan rig{.ping_spacing = 1, .pings = 100, .range = 1000, .bins = 100};
    in::record_options<> options;
    options.cell = 1e-3;
    CHECK_THROWS_WITH(in::render(over(in::seabed::flat{}), rig, options), ContainsSubstring("seabed tiles"));
}

TEST_CASE("A ping pitched by the slope of the ground along the track hears what a level one hears on level ground") {
    for (const double pitch : {0.2, -0.4}) {
        // The ground, rotated about the sonar, is 5 m away. Pings as far apart as before are closer across the fan.
        const double slope = std::tan(pitch), depth = 5 / std::cos(pitch);
        const auto tilted = [=](double, double y) { return static_cast<float>(slope * y); };
        const in::ping level{.position = {0, 0, 5}}, pitched{.position = {0, 0, depth}, .pitch = pitch};
        const auto flat = hear(over(sea_level), level, 0, 20, 100);
        const auto same = hear(over(ground{tilted, -100, 100}), pitched, 0, 20, 100);
        for (int b = 0; b < 100; ++b) {
            CAPTURE(pitch, b);
            const double expected = static_cast<double>(flat.image(b, 0)) * std::cos(pitch);
            CHECK(same.image(b, 0) == Approx(expected).epsilon(0.02).margin(1e-5));
        }
    }
}

TEST_CASE("A crest in front of a window shades it, and a target in front of the crest has its name") {
    const auto crest = [](double x, double) { return x > 9.3 && x < 9.9 ? 1.0f : 0.0f; };
    in::scene s = over(ground{crest, 0, 1});
    const in::ping p{.position = {0, 0, 5}};
    for (const bool has_target : {false, true}) {
        if (has_target) s.add(in::cube{.size = {0.5f, 4, 3}}, {.position = {8, 0, 1.5}}, "post");
        const auto window = hear(s, p, 12.1f, 20, 79), whole = hear(s, p, 4.2f, 20, 158);
        for (int b = 0; b < 79; ++b) {
            CAPTURE(has_target, b);
            CHECK(window.labels.shadow(b, 0) == whole.labels.shadow(79 + b, 0));
            CHECK(window.image(b, 0) == Approx(whole.image(79 + b, 0)).epsilon(1e-3).margin(1e-6));
        }
        const int behind_crest = 4;  // 12.5 m away, 11.5 m across
        CHECK(window.labels.shadow(behind_crest, 0) == (has_target ? 1 : in::labels::by_seabed));
        CHECK(window.labels.shadow(20, 0) == (has_target ? 1 : in::labels::no_shadow));  // 14.1 m away
    }
}

TEST_CASE("A ridge casts its own shadow, whatever is buried in it") {
    const auto height = [](double x, double) { return static_cast<float>((std::max)(0.0, 2 - std::fabs(x - 9))); };
    in::scene s = over(ground{height, 0, 2});
    const in::ping p{.position = {0, 0, 5}};
    const auto bare = hear(s, p, 0, 30, 300);
    s.add(in::cube{.size = {0.8f, 4, 0.8f}}, {.position = {9, 0, 0.6}}, "buried");
    const auto heard = hear(s, p, 0, 30, 300);
    CHECK(dark_bins(heard) > 20);
    CHECK(heard.labels.shadow == bare.labels.shadow);
    CHECK(heard.image == bare.image);
}

TEST_CASE("A bin that shows a target is not in shadow") {
    in::scene s = over(sea_level);
    s.add(in::cube{.size = {0.5f, 4, 2}}, {.position = {8, 0, 1}}, "front");
    s.add(in::cube{.size = {0.05f, 4, 3.2f}}, {.position = {10, 0, 1.6}}, "behind it");
    const auto heard = hear(s, {.position = {0, 0, 5}}, 0, 20, 100);
    int of_targets = 0;
    for (int b = 0; b < 100; ++b)
        if (heard.labels.instance(b, 0) != 0) {
            CHECK(heard.labels.shadow(b, 0) == in::labels::no_shadow);
            ++of_targets;
        }
    CHECK(of_targets > 5);
    CHECK(dark_bins(heard) > 20);
}

TEST_CASE("Ground is lit where targets cover less than half of a ray") {
    for (const double share : {0.3, 0.8}) {
        // A wall of bars far above the ground, finer than the rays.
        in::scene s = over(sea_level);
        for (int i = 0; i < 60; ++i)
            s.add(in::cube{.size = {0.01f, 4, static_cast<float>(0.04 * share)}}, {.position = {8, 0, 1 + 0.04 * i}},
                  "bar");
        const auto heard = hear(s, {.position = {0, 0, 5}}, 0, 20, 40, 0.5);
        CAPTURE(share);
        CHECK((dark_bins(heard) > 4) == (share > 0.5));
    }
}

TEST_CASE("The last bin holds what it holds in a recording that goes on") {
    const in::scene s = over(sea_level);
    const in::ping p{.position = {0, 0, 5}};
    const auto ends = hear(s, p, 0, 20, 400, 0.2), goes_on = hear(s, p, 0, 24, 480, 0.2);
    for (int b = 390; b < 400; ++b) {
        CAPTURE(b);
        CHECK(ends.image(b, 0) == Approx(goes_on.image(b, 0)).epsilon(0.01));
    }
}

TEST_CASE("The last bin over level ground is as bright as the others, wherever its end falls among the rays") {
    for (const float altitude : {5.0f, 5.7f, 6.3f, 7.9f, 12.34f})
        for (const double cell : {0.0, 0.0625, 0.2})
            for (float range = 15; range < 40; range += 0.31f) {
                CAPTURE(altitude, cell, range);
                const in::ground_range rig{.altitude = altitude, .pings = 1, .range = range, .bins = 400};
                const auto heard = in::render(over(sea_level), rig, in::record_options<>{.cell = cell});
                CHECK(heard.image(399, 0) == Approx(heard.image(396, 0)).epsilon(0.01));
            }
}

TEST_CASE("Of a plate above the sonar each side hears its part") {
    const in::ping p{.position = {0, 0, 5}};
    in::scene whole = over(sea_level), part = whole;
    whole.add(in::cube{.size = {4, 4, 0.2f}}, {.position = {0.3, 0, 8}}, "plate");
    part.add(in::cube{.size = {2.3f, 4, 0.2f}}, {.position = {1.15, 0, 8}}, "plate");
    const double expected = target_energy(hear(part, p, 0, 10, 100));
    CHECK(expected > 0.1);
    CHECK(target_energy(hear(whole, p, 0, 10, 100)) == Approx(expected).epsilon(0.01));
}

TEST_CASE("Echoes and labels change from one type of bottom to the next halfway between vertices") {
    struct halves {
        void row(const in::seabed::scanline& line, std::span<float> heights, std::span<in::seabed::type> types) const {
            std::fill(heights.begin(), heights.end(), 0.0f);
            for (std::size_t i = 0; i < types.size(); ++i)
                types[i] = line.x(i) < 10.75 ? in::seabed::type::sand : in::seabed::type::rock;
        }
        in::seabed::height_range range() const { return {0, 0}; }
    };
    in::scene s;
    s.seabed = halves{};
    s.bottom.fill({1});
    s.bottom[in::seabed::index_of(in::seabed::type::rock)] = {0};
    // The profile has a vertex each half metre; those at 10 and 10.5 m lie on the last of sand and the first of rock.
    const in::ground_range rig{.ping_spacing = 1, .range = 20, .bins = 160};
    in::record_options<> options;
    options.cell = 1;
    const auto heard =
        in::record(s, std::vector{in::ping{.position = {0.25, 0, 5}}}, rig, options.with(in::sonar_equation<>{}));
    for (int b = 40; b < 150; ++b) {
        CAPTURE(b);
        const bool is_sand = b * 0.125 < 10.25;
        CHECK(heard.labels.seabed(b, 0) ==
              in::seabed::index_of(is_sand ? in::seabed::type::sand : in::seabed::type::rock));
        CHECK((heard.image(b, 0) > 0) == is_sand);
    }
}
