// Recordings: the order of rows, pitch and roll of pings, options that every rig shares, and images in the caller's
// memory.
#include <insonify/all.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "../../catch.hpp"
#include "../../single_pings.hpp"

namespace in = insonify;
using single_pings::cross_sections;
using single_pings::level_ground;
using single_pings::one_metre;

TEST_CASE("Row i is ping i in every recording, the first on top; flipped_vertically flips images, labels and numbers") {
    in::scene s;
    s.seabed = in::seabed::ripples{};
    s.add(in::cube{}, {.position = {10, 1.5, 0.5}}, "cube");
    const in::side_scan rig{.ping_spacing = 0.1f, .pings = 40, .range = 20, .bins = 100};
    const auto drawn = in::render(s, rig);
    const auto track = in::track_of(rig);
    const auto recorded = in::record(s, std::span<const in::ping>(track), rig);
    CHECK(drawn.image == recorded.image);
    CHECK(drawn.labels.instance == recorded.labels.instance);
    CHECK(drawn.labels.targets[0].box.y0 == 10);
    CHECK((drawn.rows.first == 0 && drawn.rows.step == 1));
    const auto turned = in::flipped_vertically(drawn);
    CHECK(turned.labels.targets[0].box.y0 == 40 - 10 - drawn.labels.targets[0].box.height());
    CHECK((turned.rows.first == 39 && turned.rows.step == -1));
    CHECK(std::equal(turned.image.row(39).begin(), turned.image.row(39).end(), drawn.image.row(0).begin()));
    CHECK(in::flipped_vertically(in::frame<in::no_labels>{}).rows.first == 0);
    // Speckle follows the numbers.
    const in::seabed_speckle speckle{.seed = 3};
    CHECK(in::flipped_vertically(in::with_speckle(drawn, speckle)).image == in::with_speckle(turned, speckle).image);
}

TEST_CASE("Speckle of both sides in one picture is that of each side") {
    in::scene s;
    in::side_scan rig{.ping_spacing = 0.1f, .pings = 20, .range = 20, .bins = 100};
    const auto swath = in::with_speckle(in::render_swath(s, rig));
    rig.side = in::side::port;
    const auto port = in::with_speckle(in::render(s, rig));
    rig.side = in::side::starboard;
    const auto starboard = in::with_speckle(in::render(s, rig));
    CHECK(swath.image == in::both_sides(port, starboard).image);
}

TEST_CASE("A pitched fan leans forward: the first return is A / cos(pitch) away, and targets are met ahead") {
    in::scene s;
    s.seabed = level_ground;
    const double pitch = 0.3;
    s.add(in::cube{.size = glm::vec3(0.4f)}, {.position = {9, 5 * std::tan(pitch), 0.2}}, "cube", {1});
    const in::side_scan rig = one_metre(5, 30, 3000);
    for (const double yaw : {0.0, 1.0}) {
        in::scene turned = s;
        turned.targets[0].placement.position = {9 * std::cos(yaw) - 5 * std::tan(pitch) * std::sin(yaw),
                                                9 * std::sin(yaw) + 5 * std::tan(pitch) * std::cos(yaw), 0.2};
        const in::ping level{.position = {0, 0, 5}, .yaw = yaw},
            leaning{.position = {0, 0, 5}, .yaw = yaw, .pitch = pitch};
        const in::ping pings[] = {level, leaning};
        const auto heard = in::record(turned, std::span<const in::ping>(pings), rig, cross_sections);
        const auto first_return = [&](int row) {
            int bin = 0;
            while (heard.image(bin, row) == 0) ++bin;
            return bin * 0.01;
        };
        CHECK(first_return(0) == Approx(5).margin(0.02));
        CHECK(first_return(1) == Approx(5 / std::cos(pitch)).margin(0.02));
        int met[2] = {0, 0}, nearest = 3000;
        for (int row = 0; row < 2; ++row)
            for (int bin = 0; bin < 3000; ++bin)
                if (heard.labels.instance(bin, row) == 1) ++met[row], nearest = (std::min)(nearest, bin);
        CHECK(met[0] == 0);
        CHECK(met[1] > 0);
        // Its nearest edge.
        const double down = (5 - 0.4) / std::cos(pitch);
        CHECK(nearest * 0.01 == Approx(std::hypot(8.8, down)).margin(0.15));
        // Level ground has a grazing sine of A / R: the sum of sine^2 over x.
        double sum = 0;
        for (int bin = 0; bin < 900; ++bin) sum += static_cast<double>(heard.image(bin, 1));
        const double depth = 5 / std::cos(pitch), edge = std::sqrt(81 - depth * depth);
        CHECK(sum == Approx(0.45 * 25 / depth * std::atan(edge / depth)).epsilon(0.01));
    }
}

TEST_CASE("A pitched fan meets relief where its plane cuts the seabed") {
    in::scene s;
    s.seabed = in::seabed::sculpted{.ground = level_ground,
                                    .edits = {in::seabed::raise{.centre = {9, 3}, .radius = 2, .height = 1}}};
    const double pitch = 0.5;
    const in::ping pings[] = {{.position = {0, 0, 5}, .pitch = pitch}, {.position = {0, 0, 5}}};
    const auto heard = in::record(s, std::span<const in::ping>(pings), one_metre(5, 30, 600), cross_sections);
    // The hill lies where the fan reaches the ground, 5 tan(pitch) = 2.7 m ahead, and casts a shadow there alone.
    int dark[2] = {0, 0};
    for (int row = 0; row < 2; ++row)
        for (const std::uint16_t by : heard.labels.shadow.row(row)) dark[row] += by == in::labels::by_seabed;
    CHECK(dark[0] > 10);
    CHECK(dark[1] == 0);
}

TEST_CASE("A ping on the border of two tiles of the seabed is like any other") {
    in::scene s;
    s.seabed = in::seabed::flat{.surface = {.rms = 0}};
    const in::side_scan rig{.range = 20, .bins = 200};
    in::record_options<> options;
    // The cell is rounded to 0.030029296875. At this y a quotient and a product with the reciprocal round differently.
    options.cell = 0.03;
    const auto at = [&](double y) {
        return in::record(s, std::vector<in::ping>{{.position = {0, y, 5}}}, rig, options).image;
    };
    CHECK(at(-46.125) == at(-46.11));
}

TEST_CASE("Roll adds to the tilt of the beam on the lower side") {
    in::scene s;
    s.seabed = in::seabed::ripples{};
    const auto swath = [&](in::side looks, double roll, float tilt) {
        in::side_scan rig = one_metre(5, 30, 300);
        rig.side = looks;
        const in::ping pings[] = {{.position = {0, 0, 5}, .roll = roll}};
        return in::record(s, std::span<const in::ping>(pings), rig,
                          in::record_options<>{}.with(in::sonar_equation{in::vertical_beam{.tilt = tilt}}))
            .image;
    };
    for (const double roll : {0.1, -0.2})
        for (const in::side looks : {in::side::port, in::side::starboard}) {
            const float down = static_cast<float>(looks == in::side::starboard ? roll : -roll);
            const auto rolled = swath(looks, roll, 0.35f), tilted = swath(looks, 0, 0.35f + down);
            for (std::size_t i = 0; i < rolled.size(); ++i)
                REQUIRE(rolled.pixels()[i] == Approx(tilted.pixels()[i]).epsilon(1e-3).margin(1e-6));
            CHECK_FALSE(rolled == swath(looks, 0, 0.35f));
        }
}

TEST_CASE("Overhead pictures and recordings have one result: legend, statistics and row order") {
    in::scene s;
    s.seabed = in::seabed::mud{};
    in::frame<> drawn = in::render(s, in::overhead{.size = {32, 24}});
    CHECK(drawn.rows.step == 0);
    CHECK(drawn.stats.cell > 0);
    CHECK_THROWS_WITH(in::with_speckle(drawn), ContainsSubstring("ping_numbers.step is 0"));
    const in::frame<in::no_labels> bare =
        in::render(s, in::overhead{.size = {32, 24}}, in::render_options<>{}.without_labels());
    CHECK(bare.image == drawn.image);
    const in::frame<> dull =
        in::render(s, in::overhead{.size = {32, 24}},
                   in::render_options<>{}.with(in::shadow::none{}).with(in::lambert_backscatter{}));
    CHECK_FALSE(dull.image == drawn.image);
    drawn = in::render(s, in::ground_range{.pings = 3, .range = 20, .bins = 16});
    CHECK((drawn.rows.step == 1 && drawn.stats.cell > 0 && drawn.labels.legend[0].name == "mud"));
}

TEST_CASE("The same code draws with any rig: options_for(rig) shares law, cell and labels") {
    static_assert(in::sonar_options<in::render_options<>> && in::sonar_options<in::record_options<>>);
    in::scene s;
    s.seabed = in::seabed::mud{};
    const auto draw = [&](const auto& rig) {
        const auto defaults = in::options_for(rig);
        CHECK(in::render(s, rig, defaults).image == in::render(s, rig).image);
        auto coarse = defaults.with(in::lambert{}).without_labels();
        coarse.cell = 0.5;
        const in::frame<in::no_labels> drawn = in::render(s, rig, coarse);
        CHECK(drawn.stats.cell == 0.5);
        CHECK_FALSE(in::render(s, rig, defaults.with(in::lambert{})).image ==
                    in::render(s, rig, defaults.with(in::lambert_backscatter{})).image);
        coarse.cell = -1;
        CHECK_THROWS_WITH(in::render(s, rig, coarse), ContainsSubstring("cell is -1, expected 0 metres or more"));
    };
    draw(in::overhead{.size = {32, 24}});
    draw(in::side_scan{.pings = 3, .range = 20, .bins = 16});
    draw(in::ground_range{.pings = 3, .range = 20, .bins = 16});
}

TEST_CASE("Attitudes out of range are refused by name") {
    const in::scene s;
    const auto with = [&](const in::ping& p) {
        return in::record(s, std::span<const in::ping>(&p, 1), in::side_scan{.range = 20, .bins = 8});
    };
    CHECK_THROWS_WITH(with({.pitch = 1.5}), ContainsSubstring("track[0].pitch is 1.5"));
    CHECK_THROWS_WITH(with({.roll = std::nan("")}), ContainsSubstring("track[0].roll is nan"));
    CHECK_NOTHROW(with({.yaw = 9, .pitch = -1.3, .roll = 7}));
}

TEST_CASE("record_into() writes the caller's rows and nothing else, and refuses views of another size") {
    in::scene s;
    s.seabed = in::seabed::ripples{};
    const in::side_scan rig{.pings = 6, .range = 20, .bins = 50};
    const auto track = in::track_of(rig);
    const auto expected = in::record(s, std::span<const in::ping>(track), rig);
    in::image<float> mine(60, 8, -1.0f);
    const auto stats = in::record_into(mine.view().part(5, 1, 50, 6), s, track, rig);
    CHECK(stats.seabed_samples == expected.stats.seabed_samples);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 60; ++x) {
            const bool inside = x >= 5 && x < 55 && y >= 1 && y < 7;
            REQUIRE(mine(x, y) == (inside ? expected.image(x - 5, y - 1) : -1.0f));
        }
    CHECK_THROWS_WITH(in::record_into(mine.view(), s, track, rig),
                      ContainsSubstring("into.width() is 60, expected 50, the number of bins"));
    CHECK_THROWS_WITH(in::record_into(mine.view().part(0, 0, 50, 8), s, track, rig),
                      ContainsSubstring("into.height() is 8, expected 6, the number of pings"));
}
