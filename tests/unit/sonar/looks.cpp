// Looks of sonars (displays, gain errors, banding, the water column, tones of the seabed, instruments) against closed
// forms and moments, and at extremes.
#include <insonify/all.hpp>
#include <insonify/core/thread_pool.hpp>
#include <insonify/sonar/bottom_tone.hpp>
#include <insonify/sonar/instruments.hpp>
#include <insonify/sonar/side_scan/ping_gain.hpp>
#include <insonify/sonar/side_scan/recording.hpp>
#include <insonify/sonar/side_scan/water_column.hpp>
#include <insonify/sonar/speckle.hpp>

#include <cmath>
#include <limits>

#include "../../catch.hpp"
#include "../../not_finite.hpp"

namespace in = insonify;

namespace {

float shown(float intensity, const auto& display) {
    return (in::image<float>(1, 1, intensity) | display)(0, 0);
}
double decibels(float ratio) {
    return 10 * std::log10(static_cast<double>(ratio));
}

struct moments {
    double mean = 0, deviation = 0;
};
moments of(const std::vector<double>& values) {
    moments m;
    for (const double v : values) m.mean += v / static_cast<double>(values.size());
    for (const double v : values) m.deviation += (v - m.mean) * (v - m.mean) / static_cast<double>(values.size());
    m.deviation = std::sqrt(m.deviation);
    return m;
}
/// Correlation of a sequence with itself, shifted.
double correlation(const std::vector<double>& v, std::size_t shift) {
    const moments m = of(v);
    double sum = 0;
    for (std::size_t i = 0; i + shift < v.size(); ++i) sum += (v[i] - m.mean) * (v[i + shift] - m.mean);
    return sum / static_cast<double>(v.size() - shift) / (m.deviation * m.deviation);
}

/// Weights 1 - s and s over their norm, averaged over where the two positions lie between nodes.
double lattice_correlation(double distance) {
    double sum = 0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
        const auto weights = [](double t, double& a, double& b) {
            const double s = t * t * (3 - 2 * t), norm = std::sqrt(s * s + (1 - s) * (1 - s));
            a = (1 - s) / norm, b = s / norm;
        };
        double a0, a1, b0, b1;
        const double at = (i + 0.5) / n, other = at + distance, cell = std::floor(other);
        weights(at, a0, a1), weights(other - cell, b0, b1);
        sum += cell == 0 ? a0 * b0 + a1 * b1 : cell == 1 ? a1 * b0 : 0;
    }
    return sum / n;
}

}  // namespace

TEST_CASE("display() shows a power of the intensity, clamped at white") {
    CHECK(shown(1.5f, in::display{.white = 6}) == Approx(0.5));
    CHECK(shown(1.5f, in::display{.white = 6, .exponent = 1}) == Approx(0.25));
    CHECK(shown(0.75f, in::display{.white = 6, .exponent = 0.25f}) == Approx(std::pow(0.125, 0.25)));
    CHECK(shown(7, in::display{.white = 6, .exponent = 2}) == 1);
    for (const float v : {0.0f, -1.0f, not_a_number}) CHECK(shown(v, in::display{.exponent = 0.3f}) == 0);
    CHECK(shown(positive_infinity, in::display{.exponent = 0.3f}) == 1);
    for (const float bad : {0.0f, -1.0f, 5.0f, not_a_number})
        CHECK_THROWS_AS(in::display{.exponent = bad}.pass(), in::invalid_input);
}

TEST_CASE("decibel_display() steps evenly from black at its range below white") {
    for (const float range : {10.0f, 40.0f, 120.0f})
        for (const float level : {0.0f, 0.25f, 0.5f, 0.9f, 1.0f}) {
            const double intensity = 6 * std::pow(10.0, -0.1 * static_cast<double>(range * (1 - level)));
            CHECK(shown(static_cast<float>(intensity), in::decibel_display{.white = 6, .range = range}) ==
                  Approx(level).margin(2e-6));
        }
    CHECK(shown(1e-30f, in::decibel_display{}) == 0);
    CHECK(shown(1e30f, in::decibel_display{}) == 1);
    CHECK(shown(positive_infinity, in::decibel_display{}) == 1);
    for (const float v : {0.0f, -3.0f, not_a_number}) CHECK(shown(v, in::decibel_display{}) == 0);
    CHECK_THROWS_AS(in::decibel_display{.white = 0}.pass(), in::invalid_input);
    CHECK_THROWS_AS(in::decibel_display{.range = not_a_number}.pass(), in::invalid_input);
    CHECK_THROWS_AS(in::decibel_display{.range = 0}.pass(), in::invalid_input);
}

TEST_CASE("automatic_display() makes the given fractions of the pixels black and white") {
    in::image<float> ramp(100, 100);
    for (int i = 0; i < 10000; ++i) ramp.pixels()[static_cast<std::size_t>(i)] = 1 + static_cast<float>(i);
    for (const auto scale : {in::display_scale::power, in::display_scale::amplitude, in::display_scale::decibels}) {
        const auto picture =
            ramp | in::automatic_display{.scale = scale, .black_fraction = 0.05f, .white_fraction = 0.2f};
        int black = 0, white = 0;
        for (const float v : picture.pixels()) black += v == 0, white += v == 1;
        CHECK(black == Approx(500).margin(2));
        CHECK(white == Approx(2000).margin(2));
    }
    const auto linear =
        ramp | in::automatic_display{.scale = in::display_scale::power, .black_fraction = 0, .white_fraction = 0};
    CHECK(linear(0, 0) == 0);
    CHECK(linear(99, 99) == 1);
    CHECK(linear(0, 50) == Approx(0.5).margin(1e-3));
}

TEST_CASE("automatic_display() in decibels stretches the echoes, however many pixels are shadow or water") {
    in::image<float> echoes(10, 100);
    for (int y = 0; y < 50; ++y)
        for (int x = 0; x < 10; ++x) echoes(x, y) = static_cast<float>(std::pow(10.0, -5 + 0.004 * (10 * y + x)));
    const auto shown =
        echoes | in::automatic_display{.scale = in::display_scale::decibels, .black_fraction = 0, .white_fraction = 0};
    CHECK(shown(0, 0) == 0);
    CHECK(shown(0, 25) == Approx(0.5).margin(2e-3));
    CHECK(shown(9, 49) == 1);
    CHECK(shown(0, 99) == 0);
}

TEST_CASE("automatic_display() stretches the smallest and the largest floats") {
    using float_limits = std::numeric_limits<float>;
    for (const auto scale : {in::display_scale::power, in::display_scale::amplitude, in::display_scale::decibels})
        for (const float unit : {float_limits::denorm_min(), float_limits::max() / 4}) {
            in::image<float> ramp(5, 1);
            for (int x = 0; x < 4; ++x) ramp(x, 0) = unit * static_cast<float>(x + 1);
            ramp(4, 0) = positive_infinity;
            const auto shown = ramp | in::automatic_display{.scale = scale, .black_fraction = 0, .white_fraction = 0};
            CAPTURE(static_cast<int>(scale), unit);
            CHECK(shown(0, 0) == 0);
            CHECK(shown(1, 0) > 0.3f);
            CHECK(shown(2, 0) > shown(1, 0));
            CHECK(shown(2, 0) < 0.9f);
            CHECK(shown(3, 0) == 1);
            CHECK(shown(4, 0) == 1);
        }
}

TEST_CASE("automatic_display() takes constant, empty and non-finite pictures") {
    CHECK((in::image<float>(3, 3, 2.0f) | in::automatic_display{})(1, 1) == 0);
    CHECK((in::image<float>(1, 1, not_a_number) | in::automatic_display{})(0, 0) == 0);
    CHECK((in::image<float>() | in::automatic_display{}).size() == 0);
    in::image<float> mixed(4, 1, 1.0f);
    mixed(0, 0) = positive_infinity, mixed(1, 0) = not_a_number, mixed(2, 0) = 0;
    const auto seen = mixed | in::automatic_display{.black_fraction = 0, .white_fraction = 0};
    CHECK(seen(0, 0) == 1);
    CHECK(seen(1, 0) == 0);
    CHECK_THROWS_AS(mixed | in::automatic_display{.black_fraction = 0.6f}, in::invalid_input);
    // Echoes on even ground that are fewer than the pixels to be white.
    in::image<float> few(200, 1, 1.0f);
    few(7, 0) = 50;
    const auto shown = few | in::automatic_display{};
    CHECK(shown(7, 0) == 1);
    CHECK(shown(8, 0) == 0);
}

TEST_CASE("range_gain_error() has the given level and length, and is the same in all rows") {
    for (const float length : {5.0f, 20.0f}) {
        const auto picture =
            in::image<float>(20000, 2, 1.0f) | in::range_gain_error{.rms = 2, .length = length, .seed = 7};
        std::vector<double> level;
        for (int x = 0; x < picture.width(); ++x) {
            level.push_back(decibels(picture(x, 0)));
            CHECK(picture(x, 0) == picture(x, 1));
        }
        CHECK(of(level).deviation == Approx(2).epsilon(0.06));
        for (const double fraction : {0.4, 1.0, 1.6})
            CHECK(correlation(level, static_cast<std::size_t>(fraction * static_cast<double>(length))) ==
                  Approx(lattice_correlation(fraction)).margin(0.05));
        CHECK(correlation(level, static_cast<std::size_t>(2 * length)) == Approx(0).margin(0.05));
    }
    const auto tilted = in::image<float>(1000, 1, 1.0f) | in::range_gain_error{.rms = 0, .slope = 10};
    CHECK(decibels(tilted(999, 0) / tilted(0, 0)) == Approx(9.99).epsilon(1e-4));
    CHECK(decibels(tilted(499, 0)) == Approx(-0.005).margin(1e-4));
}

TEST_CASE("Filters by column take parts of a picture and masks, and noise of no level adds none") {
    in::image<float> picture(64, 8, 1.0f);
    in::image<std::uint8_t> none(64, 8, std::uint8_t{0}), some = none;
    for (int x = 40; x < 50; ++x) some(x, 3) = 1;
    const auto check = [&](const auto& filter) {
        const auto whole = picture | filter;
        CHECK((picture | in::where(none.view(), filter)) == picture);
        const auto masked = picture | in::where(some.view(), filter);
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 64; ++x) REQUIRE(masked(x, y) == (some(x, y) != 0 ? whole(x, y) : 1));
        const auto part =
            in::apply(picture.view().part(40, 0, 10, 8), filter, in::serial_executor{}, in::pixel_origin{40, 0});
        for (int x = 0; x < 10; ++x) REQUIRE(part(x, 5) == whole(40 + x, 5));
    };
    check(in::range_gain_error{});
    check(in::water_column{.noise = 0.1f});
    const auto before = in::apply(in::image<float>(4, 1, 0.0f), in::water_column{}, in::serial_executor{}, {-2, 0});
    for (const float v : before.pixels()) CHECK(v >= 0);  // columns before range 0
    const auto loud =
        in::image<float>(1024, 1, 1.0f) | in::water_column{.bin = 1, .noise = 0, .absorption_per_km = 3000};
    for (const float v : loud.pixels()) REQUIRE(std::isfinite(v));
}

TEST_CASE("Filters by ping take parts of a picture that begin at any row") {
    const in::image<float> picture(3, 8, 1.0f);
    const auto check = [&](const auto& filter) {
        const in::serial_executor ex;
        const auto whole = in::apply(picture, filter, ex, in::pixel_origin{0, -4});
        for (int y = 0; y < 8; ++y) {
            const auto part = in::apply(picture.view().part(0, y, 3, 1), filter, ex, in::pixel_origin{0, y - 4});
            REQUIRE(part(1, 0) == whole(1, y));
        }
    };
    check(in::ping_banding{});
    check(in::water_column{.surface = 1, .surface_range = 0.02f});
}

TEST_CASE("ping_banding() scales whole pings by drift and jitter, by ping number") {
    const auto levels = [](const in::ping_banding& banding, int pings) {
        const auto picture = in::image<float>(3, pings, 1.0f) | banding;
        std::vector<double> level;
        for (int y = 0; y < pings; ++y) {
            CHECK(picture(0, y) == picture(2, y));
            level.push_back(decibels(picture(1, y)));
        }
        return level;
    };
    const auto drift = levels({.drift = 1.5f, .length = 10, .jitter = 0, .seed = 3}, 20000);
    CHECK(of(drift).deviation == Approx(1.5).epsilon(0.06));
    CHECK(correlation(drift, 5) == Approx(lattice_correlation(0.5)).margin(0.05));
    const auto jitter = levels({.drift = 0, .jitter = 0.7f, .seed = 3}, 20000);
    CHECK(of(jitter).deviation == Approx(0.7).epsilon(0.03));
    CHECK(correlation(jitter, 1) == Approx(0).margin(0.03));

    // The upper half of a recording, made by itself; and the same upside down.
    const auto all = levels({.seed = 5}, 40), part = levels({.first_ping = 15, .seed = 5}, 25),
               down = levels({.first_ping = 39, .step = -1, .seed = 5}, 40);
    for (std::size_t i = 0; i < part.size(); ++i) CHECK(part[i] == all[i + 15]);
    for (std::size_t i = 0; i < all.size(); ++i) CHECK(down[i] == all[39 - i]);
}

TEST_CASE("Gains leave NaN and 0 unchanged, and are the identity at zero strength") {
    in::image<float> odd(2, 1, not_a_number);
    odd(1, 0) = 0;
    const auto seen = odd | in::range_gain_error{} | in::ping_banding{};
    CHECK(std::isnan(seen(0, 0)));
    CHECK(seen(1, 0) == 0);
    const auto same =
        in::image<float>(9, 9, 0.37f) | in::range_gain_error{.rms = 0} | in::ping_banding{.drift = 0, .jitter = 0};
    for (const float v : same.pixels()) CHECK(v == 0.37f);
    CHECK_THROWS_AS(odd | in::range_gain_error{.rms = -1}, in::invalid_input);
    CHECK_THROWS_AS(odd | in::range_gain_error{.length = not_a_number}, in::invalid_input);
    CHECK_THROWS_AS(odd | in::ping_banding{.length = 0}, in::invalid_input);
    CHECK_THROWS_AS(odd | in::ping_banding{.step = 2}, in::invalid_input);
}

TEST_CASE("water_column() raises noise with range, and adds volume reverberation everywhere") {
    const in::water_column water{
        .bin = 0.5f, .noise = 0.01f, .noise_range = 20, .spreading = 30, .absorption_per_km = 100};
    const auto picture = in::image<float>(100, 2, 0.0f) | water;
    const auto expected = [&](int x) {
        const double range = (x + 0.5) * 0.5;
        return 0.01 * std::pow(range / 20, 3) * std::pow(10, 0.02 * (range - 20));
    };
    for (const int x : {0, 7, 39, 40, 99}) CHECK(picture(x, 1) == Approx(expected(x)).epsilon(1e-5));
    in::water_column more = water;
    more.volume = 0.004f;
    CHECK((in::image<float>(100, 2, 1.0f) | more)(3, 0) == Approx(1 + expected(3) + 0.004).epsilon(1e-6));
}

TEST_CASE("water_column() has a surface return that begins above the sonar and decays behind it") {
    const in::water_column water{
        .first_range = 5, .bin = 0.1f, .noise = 0, .surface = 2, .surface_range = 8, .surface_tail = 0.5f, .waves = 0};
    const auto picture = in::image<float>(200, 1, 0.0f) | water;
    CHECK(picture(28, 0) == 0);
    for (const int x : {30, 35, 60})
        CHECK(picture(x, 0) == Approx(2 * std::exp(-((x + 0.5) * 0.1 + 5 - 8) / 0.5)).epsilon(1e-3));
    // It wavers from ping to ping.
    in::water_column rough = water;
    rough.waves = 0.3f, rough.wave_length = 4;
    const auto rows = in::image<float>(200, 4000, 0.0f) | rough;
    std::vector<double> begins;
    for (int y = 0; y < rows.height(); ++y) {
        int x = 0;
        while (rows(x, y) < 1) ++x;
        begins.push_back(0.1 * x);
    }
    CHECK(of(begins).deviation == Approx(0.3).epsilon(0.1));
    CHECK_THROWS_AS(picture | in::water_column{.bin = 0}, in::invalid_input);
    CHECK_THROWS_AS(picture | in::water_column{.noise = not_a_number}, in::invalid_input);
    CHECK_THROWS_AS(picture | in::water_column{.surface_tail = -1}, in::invalid_input);
}

TEST_CASE("A tone has the given level, lengths and fraction of patches") {
    const auto line = [](const in::bottom_tone& tone, const glm::dvec2& step, int count = 40000) {
        std::vector<double> level;
        for (int i = 0; i < count; ++i) level.push_back(in::level_of(tone, {i * step.x + 0.3, i * step.y + 7.7}));
        return level;
    };
    for (const int octaves : {1, 4}) {
        const auto drift = line({.drift = 3, .drift_length = 4, .octaves = octaves}, {1.0, 0.37});
        CHECK(of(drift).deviation == Approx(3).epsilon(0.05));
        CHECK(of(drift).mean == Approx(0).margin(0.15));
    }
    // Drift changes over its length in every direction.
    for (const glm::dvec2& step : {glm::dvec2(1, 0), glm::dvec2(0, 1)}) {
        const auto drift = line({.drift = 3, .drift_length = 4, .octaves = 1}, step);
        CHECK(correlation(drift, 2) == Approx(lattice_correlation(0.5)).margin(0.05));
        CHECK(correlation(drift, 8) == Approx(0).margin(0.05));
    }
    // Across streaks the tone changes over their width, along them over their length.
    const in::bottom_tone streaks{.streaks = 2, .streak_width = 2, .streak_length = 50, .direction = 0};
    CHECK(of(line(streaks, {13, 5})).deviation == Approx(2).epsilon(0.05));
    CHECK(correlation(line(streaks, {0, 1}), 1) == Approx(lattice_correlation(0.5)).margin(0.05));
    CHECK(correlation(line(streaks, {1, 0}), 25) == Approx(lattice_correlation(0.5)).margin(0.1));
    for (const float fraction : {0.1f, 0.5f, 0.8f}) {
        double inside = 0;
        for (const double level : line({.patches = 6, .patch_size = 3, .patch_coverage = fraction}, {1.1, 2.3}))
            inside += level / 6 / 40000;
        CHECK(inside == Approx(fraction).margin(0.02));
    }
}

TEST_CASE("A tone is fixed to the world: both sides of a track give a place the same level") {
    in::scene scene;
    scene.seabed = in::seabed::flat{.surface = {.rms = 0}};
    const in::bottom_tone tone{.drift = 5, .drift_length = 3, .patches = 4, .patch_size = 5};
    const auto heard = [&](const in::ground_range& rig) {
        auto clean = in::render(scene, rig);
        auto toned = in::with_tone(clean, rig, tone);
        for (std::size_t i = 0; i < toned.image.size(); ++i) toned.image.pixels()[i] /= clean.image.pixels()[i];
        return std::move(toned.image);
    };
    // The port side of a sonar at x = 30 and the starboard side of one at 0 meet at x = 15.
    const auto from_left =
        heard({.altitude = 3, .ping_spacing = 0.5f, .pings = 20, .first_range = 10, .range = 20, .bins = 20});
    const auto from_right = heard({.position = {30, 0},
                                   .altitude = 3,
                                   .ping_spacing = 0.5f,
                                   .pings = 20,
                                   .first_range = 10,
                                   .range = 20,
                                   .bins = 20,
                                   .side = in::side::port});
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x) {
            CHECK(from_left(x, y) == Approx(from_right(19 - x, y)).epsilon(1e-4));
            const double level = in::level_of(tone, {10 + 0.5 * (x + 0.5), 0.5 * y});
            CHECK(decibels(from_left(x, y)) == Approx(level).margin(1e-3));
        }
}

TEST_CASE("A tone is refused for recordings without labels, and for pings that are nowhere") {
    in::scene scene;
    scene.seabed = in::seabed::flat{};
    const in::side_scan rig{.pings = 4, .bins = 16};
    const auto clean = in::render(scene, rig);
    const in::bottom_tone tone{.drift = 2};
    auto unlabelled = clean;
    unlabelled.labels.seabed = {};
    CHECK_THROWS_WITH(in::with_tone(unlabelled, rig, tone), ContainsSubstring("labels.seabed.size() is 0"));
    auto track = in::track_of(rig);
    track[2].position.y = 1e13;
    CHECK_THROWS_WITH(in::with_tone(clean, track, rig, tone), ContainsSubstring("track[2].position.y is 1e+13"));
    track[2].position.y = static_cast<double>(not_a_number);
    CHECK_THROWS_WITH(in::with_tone(clean, track, rig, tone), ContainsSubstring("track[2].position.y is nan"));
    auto unnumbered = clean;
    unnumbered.rows.first = std::int64_t{1} << 32;
    CHECK_THROWS_WITH(in::with_tone(unnumbered, rig, tone), ContainsSubstring("rows.first is 4294967296"));
    CHECK_THROWS_WITH(in::with_tone(clean, std::span(track).first(3), rig, tone),
                      "track.size() is 3, expected 4, the number of the recording's rows");
}

TEST_CASE("A tone lies abreast of each ping of a track, below the sonar's own height") {
    in::scene scene;
    scene.seabed = in::seabed::flat{.surface = {.rms = 0}};
    const in::bottom_tone tone{.drift = 5, .drift_length = 3};
    const in::side_scan rig{
        .altitude = 5, .ping_spacing = 0.5f, .pings = 20, .first_range = 8, .range = 18, .bins = 20};
    const auto straight = in::render(scene, rig);
    const auto as_rendered = in::with_tone(straight, rig, tone),
               by_track = in::with_tone(straight, in::track_of(rig), rig, tone);
    CHECK(std::equal(as_rendered.image.pixels().begin(), as_rendered.image.pixels().end(),
                     by_track.image.pixels().begin()));

    std::vector<in::ping> track;
    for (int i = 0; i < 20; ++i) track.push_back({.position = {0.3 * i, 0.5 * i, 4 + 0.1 * i}, .yaw = 0.04 * i});
    const auto clean = in::record(scene, track, rig);
    const auto toned = in::with_tone(clean, track, rig, tone);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x) {
            const in::ping& ping = track[static_cast<std::size_t>(y)];
            const double slant = 8 + 0.5 * (x + 0.5),
                         ground = std::sqrt(slant * slant - ping.position.z * ping.position.z);
            const glm::dvec2 at{ping.position.x + ground * std::cos(ping.yaw),
                                ping.position.y + ground * std::sin(ping.yaw)};
            CHECK(decibels(toned.image(x, y) / clean.image(x, y)) == Approx(in::level_of(tone, at)).margin(1e-3));
        }
    const auto flipped = in::with_tone(in::flipped_vertically(clean), track, rig, tone);
    CHECK(flipped.image(3, 19) == toned.image(3, 0));
    const auto batch = std::span<const in::ping>(track).subspan(8, 6);  // of a longer line
    auto part = in::record(scene, batch, rig);
    part.rows.first = 8;
    CHECK(in::with_tone(part, batch, rig, tone).image(3, 5) == toned.image(3, 13));
    auto port = clean, above = clean;
    port.rows.side = in::side::port, above.rows.step = 0;
    CHECK_THROWS_WITH(in::with_tone(port, track, rig, tone), ContainsSubstring("rows.side is 0"));
    CHECK_THROWS_WITH(in::with_tone(above, track, rig, tone), ContainsSubstring("rows.step is 0"));
    CHECK_THROWS_WITH(in::with_tone(in::both_sides(port, clean), track, rig, tone),
                      ContainsSubstring("rows.port_columns is 20"));
    track.pop_back();
    CHECK_THROWS_WITH(in::with_tone(clean, track, rig, tone), ContainsSubstring("track.size() is 19"));
}

TEST_CASE(
    "with_tone() leaves targets and the water column unchanged, does nothing when off, and is the same for any "
    "executor") {
    in::scene scene;
    scene.add(in::cube{}, {.position = {9, 4, 0.5}}, "cube");
    const in::side_scan rig{.altitude = 5, .ping_spacing = 0.2f, .pings = 40, .range = 20, .bins = 80};
    auto clean = in::render(scene, rig);
    for (std::size_t i = 0; i < clean.image.size(); ++i)  // an echo of the water, which a tone would change
        if (clean.labels.seabed.pixels()[i] == in::labels::no_seabed) clean.image.pixels()[i] += 0.25f;
    const auto off = in::with_tone(clean, rig, {});
    CHECK(off.image.pixels().size() == clean.image.pixels().size());
    CHECK(std::equal(off.image.pixels().begin(), off.image.pixels().end(), clean.image.pixels().begin()));
    const in::bottom_tone tone{.drift = 3, .streaks = 1, .patches = -4};
    const auto once = in::with_tone(clean, rig, tone);
    int kept = 0, of_targets = 0, changed = 0;
    for (std::size_t i = 0; i < once.image.size(); ++i) {
        const bool is_same = once.image.pixels()[i] == clean.image.pixels()[i];
        if (once.labels.seabed.pixels()[i] != in::labels::no_seabed) {
            changed += is_same ? 0 : 1;
            continue;
        }
        CHECK(is_same);
        ++kept;
        of_targets += once.labels.instance.pixels()[i] != 0 ? 1 : 0;
    }
    CHECK((kept > 500 && of_targets > 5 && changed > 1000));
    in::thread_pool pool(3);
    const auto pooled = in::with_tone(clean, rig, tone, pool);
    CHECK(std::equal(once.image.pixels().begin(), once.image.pixels().end(), pooled.image.pixels().begin()));
    CHECK_THROWS_AS(in::level_of({.drift = not_a_number}, {0, 0}), in::invalid_input);
    CHECK_THROWS_AS(in::level_of({.drift = 1, .drift_length = 0}, {0, 0}), in::invalid_input);
    CHECK_THROWS_AS(in::level_of({.patch_coverage = 0}, {0, 0}), in::invalid_input);
    CHECK_THROWS_AS(in::level_of({.octaves = 9}, {0, 0}), in::invalid_input);
    CHECK(std::isfinite(in::level_of({.drift = 30, .streaks = 30, .patches = 30}, {1e12, -1e12})));
}

TEST_CASE("facet_backscatter() is Lambert's law with a peak at normal incidence") {
    const in::facet_backscatter law{.facets = 5, .slope = 0.2f};
    CHECK(law(1) == Approx(6));
    CHECK(law(0.3f) == Approx(0.09).epsilon(1e-5));
    // tan(incidence) = slope: half an exponent below the peak.
    const double sine = 1 / std::sqrt(1 + 0.04);
    CHECK(law(static_cast<float>(sine)) == Approx(sine * sine + 5 * std::exp(-0.5)).epsilon(1e-4));
    CHECK(law(0) == 0);
    CHECK(in::facet_backscatter{.facets = 0}(0.7f) == Approx(0.49));
    // The volume falls off more slowly than the surface.
    const in::facet_backscatter muddy{.facets = 0, .volume = 0.5f};
    CHECK(muddy(0.7f) == Approx(0.49 + 0.35));
    CHECK(muddy(0.1f) == Approx(0.06));
    for (const float s : {1e-3f, 5e-4f, 1e-6f, 1e-30f}) CHECK(muddy(s) == Approx(0.5f * s).epsilon(1e-2));
}

// Ainslie and McColm 1998 in salt water, at 10 degrees, 20 m, pH 8 and a salinity of 35.
TEST_CASE("The absorption of an instrument is that of sea water at its frequency") {
    const double temperature = 10, depth_km = 0.02;
    const double boron = 0.78 * std::exp(temperature / 26), magnesium = 42 * std::exp(temperature / 17);  // kHz
    for (const in::instrument& i : in::instruments::all) {
        const double f = static_cast<double>(i.frequency) / 1000, square = f * f;
        const double expected = 0.106 * boron * square / (square + boron * boron) +
                                0.52 * (1 + temperature / 43) * magnesium * square / (square + magnesium * magnesium) *
                                    std::exp(-depth_km / 6) +
                                0.00049 * square * std::exp(-(temperature / 27 + depth_km / 17));
        CAPTURE(i.name, expected);
        CHECK(std::abs(static_cast<double>(i.absorption_per_km) - expected) <= 0.51);  // rounded to a decibel
    }
}

TEST_CASE("Instruments are found by name; speckle lengths follow from pulse, beam or aperture") {
    for (const in::instrument& i : in::instruments::all) {
        CHECK(in::instrument_named(i.name).frequency == i.frequency);
        CHECK(i.speckle_length_across() == Approx(0.5234 * static_cast<double>(i.range_resolution)));
        CHECK(i.range > 0);
    }
    const in::instrument& towed = in::instruments::side_scan_450;
    CHECK(towed.along_track(100) == Approx(100 * static_cast<double>(towed.beamwidth)));
    CHECK(towed.speckle_length_along(100) ==
          Approx(towed.horizontal().speckle_length(100, 1500.0 / static_cast<double>(towed.frequency))).epsilon(1e-6));
    const in::instrument& aperture = in::instruments::synthetic_aperture;
    CHECK(aperture.along_track(20) == aperture.along_track(150));
    CHECK_THROWS_WITH(in::instrument_named("lidar"), ContainsSubstring("side_scan_450, side_scan_600"));
}
