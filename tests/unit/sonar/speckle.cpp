// Speckle against the moments of its distributions, and its keying by seed, side, ping and bin.
#include <insonify/all.hpp>
#include <insonify/core/thread_pool.hpp>

#include <algorithm>
#include <cmath>

#include "../../catch.hpp"
#include "../../moments.hpp"

namespace in = insonify;
using moments::correlation, moments::of;

namespace {

constexpr int wide = 700, high = 400;

/// Unit intensities of one type under a law, with the given correlation lengths alone.
in::image<float> speckled(const in::speckle_law& law, float along = 0, float across = 0,
                          in::side side = in::side::starboard, std::uint64_t seed = 3) {
    in::seabed_speckle s{.along_track = along, .across_track = across, .texture_length = 1, .seed = seed};
    s.bottom[0] = law;
    const in::image<float> mean(wide, high, 1.0f);
    const in::image<std::uint8_t> types(wide, high, std::uint8_t{0});
    return in::with_speckle(mean.view(), types.view(), s, {.first = 7, .side = side});
}

/// Probability that two bins `lag` apart take their textures from the same column of nodes. A bin takes either adjacent
/// column with its linear weight.
double same_texture_node(int lag, int length) {
    const auto weight = [&](int x, int node) { return (std::max)(0.0, 1 - std::abs(x - node) / (1.0 * length)); };
    double share = 0;
    for (int x = 0; x < length; ++x)
        for (const int node : {0, length}) share += weight(x, node) * weight(x + lag, node) / length;
    return share;
}

}  // namespace

TEST_CASE("Fully developed speckle has exponential intensities and Rayleigh amplitudes") {
    const auto picture = speckled({});
    const auto [mean, index] = of(picture);
    CHECK(mean == Approx(1).epsilon(0.01));
    CHECK(index == Approx(1).epsilon(0.02));
    for (const double t : {0.1, 1.0, 3.0}) {
        double above = 0;
        for (const float v : picture.pixels()) above += static_cast<double>(v) > t;
        CHECK(above / static_cast<double>(picture.size()) == Approx(std::exp(-t)).epsilon(0.02));
    }
    const auto amplitude = of(in::map_pixels(picture, [](float v) { return std::sqrt(v); }));
    CHECK(amplitude.mean == Approx(0.8862).epsilon(0.005));
    CHECK(std::sqrt(amplitude.index) == Approx(0.5227).epsilon(0.01));
}

TEST_CASE("Looks, K and Rician speckle have the scintillation index of their formulas, and a mean of one") {
    for (const in::speckle_law law : {in::speckle_law{4, 0, 0},
                                      {16, 0, 0},
                                      {1, 2, 0},
                                      {1, 20, 0},
                                      {1, 0.5f, 0},
                                      {1, 0, 1},
                                      {1, 0, 10},
                                      {64, 0, 1e6f},
                                      {3, 4, 2}}) {
        const auto [mean, index] = of(speckled(law));
        const auto steady = static_cast<double>(law.steady);
        double expected = (1 + 2 * steady) / (law.looks * (1 + steady) * (1 + steady));
        if (law.texture > 0) expected = (1 + 1 / static_cast<double>(law.texture)) * (1 + expected) - 1;
        INFO("looks " << law.looks << ", texture " << law.texture << ", steady " << law.steady);
        CHECK(mean == Approx(1).epsilon(0.015));
        CHECK(index == Approx(expected).epsilon(0.05));
    }
}

TEST_CASE("Extreme shapes stay finite, and a very large one is no texture") {
    for (const float shape : {0.05f, 1e6f}) {
        const auto picture = speckled({1, shape, 0});
        for (const float v : picture.pixels()) REQUIRE((v >= 0 && in::numeric::is_finite(v)));
        CHECK(of(picture).mean == Approx(1).epsilon(shape < 1 ? 0.1 : 0.01));
        if (shape > 1) CHECK(of(picture).index == Approx(1).epsilon(0.02));
    }
}

TEST_CASE("Correlation falls to 1 / e at the given lengths, independently along and across the track") {
    for (const auto& [along, across] : {std::pair{0.0f, 3.0f}, {3.0f, 0.0f}, {5.0f, 2.0f}, {1.0f, 1.0f}}) {
        const auto picture = speckled({}, along, across);
        INFO("along " << along << ", across " << across);
        const double e = std::exp(-1.0);
        if (across > 0)
            CHECK(correlation(picture, picture, static_cast<int>(across), 0) == Approx(e).margin(0.06));
        else
            CHECK(correlation(picture, picture, 1, 0) == Approx(0).margin(0.01));
        if (along > 0)
            CHECK(correlation(picture, picture, 0, static_cast<int>(along)) == Approx(e).margin(0.06));
        else
            CHECK(correlation(picture, picture, 0, 1) == Approx(0).margin(0.01));
        CHECK(of(picture).index == Approx(1).epsilon(0.06));
    }
}

TEST_CASE("The speckle of a bin does not depend on the number of bins") {
    const float across = GENERATE(0.0f, 0.8f, 3.0f);
    const auto pings = [&](int bins) {
        return in::detail::speckle_field(3, in::side::starboard, 1.5f, across, bins).pings(7, 3, 0);
    };
    const in::image<float> widest = pings(80);
    int differing = 0;
    for (int bins = 1; bins < 80; ++bins) {
        const in::image<float> field = pings(bins);
        for (int y = 0; y < field.height(); ++y)
            for (int x = 0; x < field.width(); ++x) differing += field(x, y) != widest(x, y);
    }
    CHECK(differing == 0);
}

TEST_CASE("Textures are correlated over their length and gamma-distributed") {
    in::seabed_speckle s{.along_track = 0, .across_track = 0, .texture_length = 8};
    s.bottom[0] = {64, 1, 0};  // many looks: the texture dominates
    const in::image<float> mean(wide, high, 1.0f);
    const in::image<std::uint8_t> types(wide, high, std::uint8_t{0});
    const auto picture = in::with_speckle(mean.view(), types.view(), s, {});
    CHECK(of(picture).mean == Approx(1).epsilon(0.03));
    const double index = 2 * (1 + 1.0 / 64) - 1;
    CHECK(of(picture).index == Approx(index).epsilon(0.08));
    // Two bins have the same texture if their nodes are in the same row and column, else independent ones.
    for (const int lag : {2, 6}) {
        const double expected = same_texture_node(lag, 8) * same_texture_node(0, 8) / index;
        CHECK(correlation(picture, picture, lag, 0) == Approx(expected).margin(0.03));
        CHECK(correlation(picture, picture, 0, lag) == Approx(expected).margin(0.03));
    }
    CHECK(correlation(picture, picture, 20, 0) == Approx(0).margin(0.03));
    CHECK(correlation(picture, picture, 0, 20) == Approx(0).margin(0.03));
    // Gamma of shape 1 is exponential; the second factor is what 64 looks add, to second order.
    const double nodes = wide * high / 64.0;
    for (const double t : {0.1, 1.0, 3.0}) {
        double above = 0;
        for (const float v : picture.pixels()) above += static_cast<double>(v) > t;
        const double expected = std::exp(-t) * (1 + t * (t - 2) / 128);
        INFO("above " << t);
        CHECK(above / static_cast<double>(picture.size()) ==
              Approx(expected).margin(4 * std::sqrt(expected * (1 - expected) / nodes)));
    }
}

TEST_CASE("The two sides, two seeds and two pings are independent") {
    const auto starboard = speckled({1, 2, 0}, 1, 1), port = speckled({1, 2, 0}, 1, 1, in::side::port);
    const auto other = speckled({1, 2, 0}, 1, 1, in::side::starboard, 4);
    CHECK(correlation(starboard, port) == Approx(0).margin(0.01));
    CHECK(correlation(starboard, other) == Approx(0).margin(0.01));
    // Nor is one the other's mirror image.
    CHECK(correlation(starboard, in::mirrored(port)) == Approx(0).margin(0.01));
    CHECK(correlation(starboard, starboard, 0, 17) == Approx(0).margin(0.01));
}

TEST_CASE("The speckle of a ping does not depend on the order of recording or the number of threads") {
    in::scene scene;
    scene.seabed = in::seabed::blend{.first = in::seabed::ripples{}, .second = in::seabed::mud{}};
    const in::side_scan rig{.altitude = 3, .pings = 70, .range = 12, .bins = 200};
    in::thread_pool pool(3);
    const auto whole = in::with_speckle(in::render(scene, rig, {}, pool), {}, pool);
    const auto track = in::track_of(rig);
    for (int first = 0; first < 70; first += 33) {
        const int count = (std::min)(33, 70 - first);
        const auto part = in::record(
            scene, std::span(track).subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(count)), rig);
        const auto alone = in::with_speckle(part.image.view(), part.labels.seabed.view(), {}, {.first = first});
        for (int i = 0; i < count; ++i)
            REQUIRE(std::equal(alone.row(i).begin(), alone.row(i).end(), whole.image.row(first + i).begin()));
    }
}

TEST_CASE("Each type of seabed, and what has none, has its own speckle law; zero intensity stays zero") {
    in::seabed_speckle s{.elsewhere = {16, 0, 0}, .along_track = 0, .across_track = 0, .texture_length = 1};
    s.bottom = {{{1, 0, 0}, {4, 0, 0}, {1, 0, 10}, {1, 1, 0}, {in::looks_by_seabed_model}}};
    const std::uint8_t labels[] = {0, 1, 2, 3, 4, in::labels::no_seabed};
    const double expected[] = {1, 0.25, 21.0 / 121, 3, 1.0 / 16, 1.0 / 16};
    in::image<float> mean(6 * 200, 400, 2.0f);
    in::image<std::uint8_t> types(6 * 200, 400);
    for (int y = 0; y < 400; ++y)
        for (int x = 0; x < 1200; ++x) types(x, y) = labels[x / 200];
    mean(5, 5) = 0;
    const auto picture = in::with_speckle(mean.view(), types.view(), s, {});
    CHECK(picture(5, 5) == 0);
    for (int t = 0; t < 6; ++t) {
        INFO("label " << int{labels[t]});
        const auto [level, index] = of(in::image<float>(picture.view().part(200 * t, 0, 200, 400)));
        CHECK(level == Approx(2).epsilon(0.03));
        CHECK(index == Approx(expected[t]).epsilon(0.08));
    }
}

TEST_CASE("with_speckle() refuses labels of another size by name") {
    const in::image<float> mean(4, 4, 1.0f);
    const in::image<std::uint8_t> narrow(3, 4), low(4, 3);
    CHECK_THROWS_WITH(in::with_speckle(mean.view(), narrow.view(), {}, {}), ContainsSubstring("types.width()"));
    CHECK_THROWS_WITH(in::with_speckle(mean.view(), low.view(), {}, {}), ContainsSubstring("types.height()"));
}

TEST_CASE("Draws of speckle are normal_pair's to the bit, at every instruction set and count") {
    const in::philox_key key = in::stream_key(5, 9);
    for (const in::isa level : {in::isa::scalar, in::isa::baseline, in::best_isa()})
        for (const std::size_t blocks : {std::size_t{1}, std::size_t{3}, std::size_t{8}}) {
            // The bins wrap from below 0.
            const in::philox_counter first{0u - 2, 7, 1, 3};
            std::vector<float> drawn(4 * (blocks + in::detail::speckle_draw_kernel::max_lanes));
            in::detail::dispatch(in::detail::speckle_draw_kernel{key, first, drawn.data(), blocks}, level);
            for (std::size_t i = 0; i < blocks; ++i) {
                const in::philox_counter words =
                    in::philox4x32({first[0] + 2 * static_cast<std::uint32_t>(i), 7, 1, 3}, key);
                for (std::size_t k = 0; k < 2; ++k) {
                    const auto [re, im] = in::normal_pair(words[2 * k], words[2 * k + 1]);
                    CHECK(drawn[4 * i + 2 * k] == static_cast<float>(re * 0.70710678118654752));
                    CHECK(drawn[4 * i + 2 * k + 1] == static_cast<float>(im * 0.70710678118654752));
                }
            }
        }
}
