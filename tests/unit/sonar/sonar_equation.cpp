// The sonar equation part by part: each follows its formula, and parts that are left out have no effect.
#include <insonify/all.hpp>
#include <insonify/sonar/side_scan/record.hpp>
#include <insonify/sonar/side_scan/swath.hpp>

#include <cmath>

#include "../../catch.hpp"

namespace in = insonify;
using namespace in::literals;

namespace {

in::scene level_bottom(float reflectivity = 1) {
    in::scene s;
    s.seabed = in::seabed::flat{.surface = {.rms = 0}};
    s.bottom.fill({reflectivity});
    return s;
}

/// A bottom whose strength doesn't depend on the angle.
struct constant_law {
    float operator()(float) const { return 1; }
};

const in::side_scan long_rig{.altitude = 5, .ping_spacing = 0.1f, .pings = 8, .range = 50, .bins = 1000};

template <class Equation, class Law = in::lambert_backscatter>
in::frame<in::no_labels> heard(const in::scene& s, const Equation& equation, const in::side_scan& r = long_rig,
                               const Law& law = {}) {
    return in::render(s, r, in::record_options<in::no_labels, Law, Equation>{.law = law, .equation = equation});
}

double range_of(int bin, const in::side_scan& r = long_rig) {
    return (bin + 0.5) * r.bin();
}
double cosine_of(double range) {
    return std::sqrt(range * range - 25) / range;
}
/// Mean, and the largest deviation relative to it.
template <class Fn>
std::pair<double, double> level(int first, int last, Fn&& value) {
    double sum = 0, lowest = 1e30, highest = -1e30;
    for (int b = first; b < last; ++b) {
        sum += value(b);
        lowest = (std::min)(lowest, value(b));
        highest = (std::max)(highest, value(b));
    }
    const double mean = sum / (last - first);
    return {mean, (std::max)(highest - mean, mean - lowest) / mean};
}

}  // namespace

TEST_CASE("Without any part, a picture sums to the cross-section of its surfaces") {
    const auto bare = heard(level_bottom(0.3f), in::sonar_equation<>{});
    double sum = 0;
    for (const float v : bare.image.pixels()) sum += static_cast<double>(v);
    // 8 pings of 0.1 m; the integral of sin^2 = A^2 / (A^2 + x^2) up to x is A atan(x / A).
    const double x = std::sqrt(50.0 * 50 - 25);
    CHECK(sum == Approx(0.3 * 8 * 0.1 * 5 * std::atan(x / 5)).epsilon(1e-3));
}

TEST_CASE("Level seabed has constant intensity after level_gain, for any sonar, within 1 %") {
    const auto check = [](const auto& equation) {
        const auto picture = heard(level_bottom(0.45f), equation);
        for (int y = 0; y < 8; ++y) {
            const auto [mean, deviation] =
                level(142, 1000, [&](int b) { return static_cast<double>(picture.image(b, y)); });  // beyond 45 degrees
            CHECK(mean == Approx(0.45).epsilon(0.002));
            CHECK(deviation < 0.01);
        }
    };
    check(in::sonar_equation{in::level_gain{}});
    check(in::sonar_equation{in::spreading_loss{}, in::absorption{}, in::level_gain{}});
    check(in::sonar_equation{in::source_level{220}, in::spreading_loss{}, in::absorption{322}, in::vertical_beam{},
                             in::horizontal_beam{}, in::pulse{0.1f}, in::level_gain{}});
}

TEST_CASE("Level seabed has constant intensity in ground range whatever the altitude of a ping") {
    const in::ground_range rig{.altitude = 5, .ping_spacing = 0.1f, .range = 50, .bins = 500};
    const std::vector<in::ping> track{{.position = {0, 0, 5}}, {.position = {0, 0.1, 20}}, {.position = {0, 0.2, 2}}};
    const in::sonar_equation equation{in::spreading_loss{}, in::absorption{}, in::level_gain{}};
    const auto picture = in::record(
        level_bottom(0.45f), track, rig,
        in::record_options<in::no_labels, in::lambert_backscatter, decltype(equation)>{.equation = equation});
    for (int y = 0; y < 3; ++y) {
        const int first = static_cast<int>(10 * track[static_cast<std::size_t>(y)].position.z) + 2;  // from 45 degrees
        const auto [mean, deviation] =
            level(first, 490, [&](int b) { return static_cast<double>(picture.image(b, y)); });
        CHECK(mean == Approx(0.45).epsilon(0.002));
        CHECK(deviation < 0.01);
    }
}

TEST_CASE("Time-varied gain of 40 dB per decade, or 30 with a beam, makes seabed level up to 1 / cos(grazing angle)") {
    const auto check = [](const auto& equation) {
        const auto picture = heard(level_bottom(), equation, long_rig, constant_law{});
        const auto profile = [&](int b) { return static_cast<double>(picture.image(b, 4)) * cosine_of(range_of(b)); };
        CHECK(level(110, 1000, profile).second < 0.01);
    };
    check(in::sonar_equation{in::spreading_loss{}, in::absorption{169}, in::time_varied_gain{40, 169}});
    check(in::sonar_equation{in::spreading_loss{}, in::absorption{169}, in::horizontal_beam{},
                             in::time_varied_gain{30, 169}});
    // With Lambert's law what is left is sin^2 of the grazing angle.
    const auto lambert = heard(level_bottom(), in::sonar_equation{in::spreading_loss{}, in::time_varied_gain{}});
    const auto profile = [&](int b) {
        const double sine = 5 / range_of(b);
        return static_cast<double>(lambert.image(b, 4)) * cosine_of(range_of(b)) / (sine * sine);
    };
    CHECK(level(110, 1000, profile).second < 0.01);
}

TEST_CASE("Losses and levels are those of their formulas") {
    const auto bare = heard(level_bottom(), in::sonar_equation<>{});
    const auto ratio = [&](const auto& equation, int bin) {
        return static_cast<double>(heard(level_bottom(), equation).image(bin, 0)) /
               static_cast<double>(bare.image(bin, 0));
    };
    for (const int bin : {150, 400, 999}) {
        const double r = range_of(bin);
        CHECK(ratio(in::sonar_equation{in::source_level{7}}, bin) == Approx(std::pow(10, 0.7)).epsilon(1e-5));
        CHECK(ratio(in::sonar_equation{in::spreading_loss{}}, bin) == Approx(std::pow(r, -4)).epsilon(1e-5));
        CHECK(ratio(in::sonar_equation{in::absorption{322}}, bin) ==
              Approx(std::pow(10, -2 * 0.322 * r / 10)).epsilon(1e-5));
        CHECK(ratio(in::sonar_equation{in::horizontal_beam{0.3_deg}}, bin) ==
              Approx(r * 0.3 * in::numeric::pi / 180 * std::sqrt(in::numeric::pi / (8 * std::log(2.0))) / 0.1)
                  .epsilon(1e-4));
    }
    // The table: 900 kHz takes 48 dB over 75 m, there and back.
    CHECK(10 * std::log10(in::absorption{322}.over_range(75)) == Approx(-48.3).margin(0.01));
}

TEST_CASE("A vertical beam is at full strength on its axis and a quarter, 6 dB, at its edges") {
    const in::vertical_beam beam{.beamwidth = 40_deg, .tilt = 25_deg, .side_lobes = 0};
    const auto at = [&](double depression) {
        return beam.over_direction(std::cos(depression * in::numeric::pi / 180),
                                   std::sin(depression * in::numeric::pi / 180));
    };
    CHECK(at(25) == Approx(1));
    CHECK(at(45) == Approx(0.25).epsilon(1e-5));
    CHECK(at(5) == Approx(0.25).epsilon(1e-5));
    CHECK(in::vertical_beam{.side_lobes = 0.01f}.over_direction(-1, 0) == Approx(0.01));
    // An axis that points backwards has no step where the angle's sign changes.
    const in::vertical_beam behind{.beamwidth = 100_deg, .tilt = 170_deg};
    CHECK(behind.over_direction(-1, 1e-6) == Approx(behind.over_direction(-1, -1e-6)).epsilon(1e-4));
    const auto bare = heard(level_bottom(), in::sonar_equation<>{});
    const auto with = heard(level_bottom(), in::sonar_equation{beam});
    for (const int bin : {120, 300, 900}) {
        const double depression = std::asin(5 / range_of(bin)) * 180 / in::numeric::pi;
        CHECK(static_cast<double>(with.image(bin, 0) / bare.image(bin, 0)) == Approx(at(depression)).epsilon(0.01));
    }
}

TEST_CASE("A horizontal beam blurs over its width at each range and preserves energy") {
    // Posts in two ranges, seen by a beam of a degree from pings 2 cm apart.
    in::scene s = level_bottom(0);
    for (const double x : {10.0, 30.0})
        s.add(in::cube{.size = {0.2f, 0.02f, 0.5f}}, {.position = {x, 2.0, 0.25}}, "post");
    in::side_scan fine = long_rig;
    fine.ping_spacing = 0.02f;
    fine.pings = 201;
    const in::horizontal_beam beam{.beamwidth = 1_deg};
    const auto sharp = heard(s, in::sonar_equation<>{}, fine);
    const auto blurred = heard(s, in::sonar_equation{beam}, fine);
    for (const double x : {9.9, 29.9}) {
        const int bin = static_cast<int>(std::sqrt(x * x + 25) / fine.bin());
        double before = 0, after = 0, square = 0;
        for (int y = 0; y < fine.pings; ++y) {
            const double along = (100 - y) * 0.02;
            before += static_cast<double>(sharp.image(bin, y));
            after += static_cast<double>(blurred.image(bin, y));
            square += along * along * static_cast<double>(blurred.image(bin, y));
        }
        const double range = range_of(bin, fine);
        REQUIRE(before > 0);
        CHECK(after == Approx(before * beam.footprint(range) / 0.02).epsilon(0.01));
        // The two-way pattern's deviation: width x range / (4 sqrt(ln 2)); the post is a ping or two wide itself.
        const double expected = range * in::numeric::pi / 180 / (4 * std::sqrt(std::log(2.0)));
        CHECK(std::sqrt(square / after) == Approx(expected).epsilon(0.05));
    }
}

TEST_CASE("Speckle of neighbouring pings correlates like a coherent sum over the beam") {
    // Scatterers of independent phases on a line along the track, received by two pings `apart` metres apart.
    for (const double degrees : {0.2, 0.5, 2.0})
        for (const double range : {3.0, 20.0, 90.0})
            for (const double wavelength : {0.0017, 0.0033, 0.015}) {
                const in::horizontal_beam beam{static_cast<float>(in::numeric::to_radians(degrees))};
                const double apart = beam.speckle_length(range, wavelength), reach = 2 * beam.reach(range) + apart;
                double re = 0, im = 0, power = 0;
                for (int i = -20000; i <= 20000; ++i) {
                    const double y = reach * i / 20000, other = y - apart;
                    const double a = beam.pattern(y, range), b = beam.pattern(other, range);
                    const double way = 2 * (std::hypot(range, y) - std::hypot(range, other));
                    const double heard = std::sqrt(a * b), phase = 2 * in::numeric::pi * way / wavelength;
                    re += heard * std::cos(phase), im += heard * std::sin(phase), power += a;
                }
                INFO(degrees << " degrees, " << range << " m, " << wavelength << " m");
                CHECK((re * re + im * im) / (power * power) == Approx(std::exp(-1)).epsilon(0.01));
            }
}

TEST_CASE("A pulse lengthens echoes by its length and preserves energy") {
    in::scene s = level_bottom(0);
    s.add(in::cube{.size = {0.1f, 5, 0.5f}}, {.position = {20, 0.4, 0.25}}, "wall");
    const auto sharp = heard(s, in::sonar_equation<>{});
    const auto sum = [](const auto& picture) {
        double total = 0;
        int bins = 0;
        for (const float v : picture.image.row(4)) {
            total += static_cast<double>(v);
            bins += v > 0;
        }
        return std::pair{total, bins};
    };
    const auto [power, length] = sum(sharp);
    for (const float metres : {0.02f, 0.2f, 0.35f, 1.0f}) {
        const auto [stretched, longer] = sum(heard(s, in::sonar_equation{in::pulse{metres}}));
        CHECK(stretched == Approx(power).epsilon(1e-5));
        const double more = (std::max)(0.0, static_cast<double>(metres) / long_rig.bin() - 1);
        CHECK(longer - length >= more - 1);
        CHECK(longer - length <= more + 2);
    }
}

TEST_CASE("A pulse may be as long as the recorded range, also where floats round its ends") {
    const auto record = [](float first, float range, int bins, float length) {
        const in::side_scan rig{.pings = 1, .first_range = first, .range = range, .bins = bins};
        return in::render(level_bottom(), rig, in::record_options<>{}.with(in::sonar_equation{in::pulse{length}}));
    };
    CHECK_NOTHROW(record(0, 1, 49, 1));  // 1.0 / 49 * 49 is below 1
    for (const float first : {1.3f, 17.7f, 60.0f, 999.9f}) CHECK_NOTHROW(record(first, first + 0.01f, 128, 0.01f));
    CHECK_THROWS_WITH(record(0, 1, 49, 1.001f), ContainsSubstring("at most range - first_range"));
}

TEST_CASE("The water column holds the noise floor alone, scaled by the gain") {
    const in::sonar_equation equation{in::spreading_loss{}, in::absorption{322}, in::noise_floor{1e-9f},
                                      in::time_varied_gain{40, 322}};
    const auto picture = heard(level_bottom(), equation);
    for (const int bin : {10, 50, 98}) {
        const double r = range_of(bin);
        CHECK(static_cast<double>(picture.image(bin, 0)) ==
              Approx(1e-9 * std::pow(r, 4) * std::pow(10, 2 * 0.322 * r / 10)).epsilon(1e-4));
    }
}

TEST_CASE("Parts that are left out have no effect, and own parts can be added") {
    using bare = in::sonar_equation<>;
    static_assert(!bare::has_noise && !bare::has_gain && !bare::has_ranges);
    struct half {
        double over_range(double) const { return 0.5; }
    };
    const auto full = heard(level_bottom(), bare{});
    const auto halved = heard(level_bottom(), in::sonar_equation{half{}});
    for (std::size_t i = 0; i < full.image.size(); ++i)
        REQUIRE(halved.image.pixels()[i] == 0.5f * full.image.pixels()[i]);
}

namespace {

struct own_direction {
    static constexpr const char* name = "over_direction()";
    double factor;
    double over_direction(double, double) const { return factor; }
};
struct own_range {
    static constexpr const char* name = "over_range()";
    double factor;
    double over_range(double) const { return factor; }
};
struct own_noise {
    static constexpr const char* name = "noise()";
    double intensity;
    double noise() const { return intensity; }
};
struct own_pulse {
    static constexpr const char* name = "range_length()";
    double length;
    double range_length() const { return length; }
};
/// A gain that names no type for the function object of the equation.
struct own_gain {
    static constexpr const char* name = "gain()";
    double factor;
    double gain(const in::flat_echo& e, const auto& level_at) const {
        return factor / level_at((std::min)(0.7, e.altitude / e.range));
    }
};
struct own_beam {
    double footprint_factor = 1, reach_factor = 1, pattern_factor = 1;
    double reach_offset = 0;  // metres: below 0 near the sonar alone
    double footprint(double range) const { return footprint_factor * 0.01 * range; }
    double reach(double range) const { return reach_factor * 0.02 * range + reach_offset; }
    double pattern(double, double) const { return pattern_factor; }
};

}  // namespace

TEMPLATE_TEST_CASE("Parts of your own that return NaN or less than 0 are refused by the name of their function", "",
                   own_direction, own_range, own_noise, own_pulse, own_gain) {
    const auto use = [](double value) { (void)heard(level_bottom(), in::sonar_equation<TestType>{TestType{value}}); };
    use(0.5);
    for (const double wrong : {-1.0, std::nan("")})
        CHECK_THROWS_WITH(use(wrong), ContainsSubstring(TestType::name) && ContainsSubstring("of the sonar equation"));
}

TEST_CASE("Power that a float can't hold is refused by the name of its function, as a gain of 0 would make it NaN") {
    const auto use = [](const auto& part) { (void)heard(level_bottom(), in::sonar_equation{part, own_gain{0}}); };
    use(own_noise{1e20});
    CHECK_THROWS_WITH(use(own_noise{1e39}), ContainsSubstring("noise() of the sonar equation is 1e+39"));
    use(own_direction{1e20});
    CHECK_THROWS_WITH(use(own_direction{1e39}), ContainsSubstring("over_direction() of the sonar equation is 1e+39"));
}

TEST_CASE("A horizontal beam of your own that returns NaN or less than 0 is refused by the name of its function") {
    const auto use = [](const own_beam& beam) { (void)heard(level_bottom(), in::sonar_equation<own_beam>{beam}); };
    use({});
    for (const double wrong : {-1.0, std::nan("")}) {
        CHECK_THROWS_WITH(use({.footprint_factor = wrong}), ContainsSubstring("footprint()"));
        CHECK_THROWS_WITH(use({.reach_factor = wrong}), ContainsSubstring("pings in the horizontal beam"));
        CHECK_THROWS_WITH(use({.pattern_factor = wrong}), ContainsSubstring("pattern()"));
    }
    CHECK_THROWS_WITH(use({.pattern_factor = 0}), ContainsSubstring("sum of pattern() of the sonar equation"));
    CHECK_THROWS_WITH(use({.reach_offset = -0.1}), ContainsSubstring("sum of pattern() of the sonar equation"));
}

TEST_CASE("Sediments differ in brightness as in the table") {
    const float rock = in::surface_of(in::seabed::sediment_of("rough rock")).reflectivity;
    const float sand = in::surface_of(in::sediment::fine_sand).reflectivity;
    CHECK(10 * std::log10(static_cast<double>(rock / sand)) == Approx(21.0).margin(1e-3));
    CHECK_THROWS_WITH(in::seabed::sediment_of("lava"), ContainsSubstring("lava"));
}
