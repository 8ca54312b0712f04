// Range modes: labels of bins, objects above the sonar, thin parts, normals, scenes without seabed, attitude, and the
// order of rows. Energies are those of closed forms.
#include <insonify/all.hpp>

#include <algorithm>
#include <cmath>
#include <span>

#include "../../catch.hpp"

namespace in = insonify;
using namespace in::literals;

namespace {

const in::seabed::flat plane{.surface = {.rms = 0}};

/// A bin holds reflectivity x sine^2 x area, for one metre of track per ping.
const auto cross_sections = in::record_options<>{}.with(in::sonar_equation<>{});

in::side_scan one_ping(double altitude, double range, int bins) {
    return {.altitude = static_cast<float>(altitude),
            .ping_spacing = 1,
            .pings = 1,
            .range = static_cast<float>(range),
            .bins = bins};
}

/// Upright, facing the sonar at x, from z0 to z1, of 2 m along the track.
in::mesh plate(float x, float z0, float z1) {
    return {.positions = {{x, -1, z0}, {x, 1, z0}, {x, 1, z1}, {x, -1, z1}}, .triangles = {{0, 2, 1}, {0, 3, 2}}};
}

/// Level at z, from x0 to x1, seen from below.
in::mesh ceiling(float z, float x0, float x1) {
    return {.positions = {{x0, -1, z}, {x1, -1, z}, {x1, 1, z}, {x0, 1, z}}, .triangles = {{0, 2, 1}, {0, 3, 2}}};
}

double energy(const in::image<float>& picture) {
    double sum = 0;
    for (const float v : picture.pixels()) sum += static_cast<double>(v);
    return sum;
}
}  // namespace

TEST_CASE("A bin's instance is the target with most of its power, in any order of targets") {
    // The plates meet at bin 17.8 of 60: the upper plate, which is nearer, has 80 % of bin 17. Other numbers of bins
    // move the border, so that either plate has the larger part.
    for (const bool swapped : {false, true}) {
        in::scene s;
        s.seabed = plane;
        const std::uint16_t lower = swapped ? 2 : 1;
        if (swapped) s.add(plate(8, 1.0956f, 2), {}, "B");
        s.add(plate(8, 0, 1.0956f), {}, "A");
        if (!swapped) s.add(plate(8, 1.0956f, 2), {}, "B");
        for (const int bins : {60, 61, 57}) {
            const auto heard = in::render(s, one_ping(5, 30, bins), cross_sections);
            // The border's range, and how much of the bin around it is the lower plate's.
            const double border = std::sqrt(64 + 3.9044 * 3.9044) / 30 * bins;
            const int bin = static_cast<int>(border);
            const double above = border - bin;  // nearer: the upper one
            if (std::abs(above - 0.5) < 0.1) continue;
            const std::uint16_t expected = above < 0.5 ? lower : static_cast<std::uint16_t>(3 - lower);
            CAPTURE(swapped, bins, above);
            CHECK(heard.labels.instance(bin, 0) == expected);
        }
    }
}

TEST_CASE("Of targets in the same place the first is named, where they fill a ray and where they do not") {
    in::scene s;
    s.seabed = plane;
    for (const char* const name : {"first", "second", "third"}) s.add(plate(8, 0, 0.03f), {}, name);
    s.add(plate(12, 0, 3), {}, "behind");
    for (int i = 0; i < 2; ++i) s.add(plate(16, 4, 4.02f), {}, "above");
    const auto heard = in::render(s, one_ping(5, 30, 900), cross_sections);
    const auto named = [&](int instance) {
        const auto all = heard.labels.instance.pixels();
        return std::count(all.begin(), all.end(), instance);
    };
    for (const int first : {1, 4, 5}) CHECK(named(first) > 0);
    for (const int other : {2, 3, 6}) CHECK(named(other) == 0);
}

TEST_CASE("A bin's shadow is labelled with the target that shades most of it") {
    in::scene s;
    s.seabed = plane;
    // Heights whose shadows end at bins 24.8 and 26 of 60 over 30 m: A shades 80 % of bin 24, B all of bin 25.
    const auto height_for = [](double tip) { return static_cast<float>(5 * (1 - 8 / tip)); };
    const auto ground = [](double bin) { return std::sqrt(bin * bin / 4 - 25); };
    s.add(plate(8, 0, height_for(ground(24.8))), {}, "A");
    s.add(plate(8, height_for(ground(24.8)), height_for(ground(26))), {}, "B");
    const auto heard = in::render(s, one_ping(5, 30, 60), cross_sections);
    CHECK(heard.labels.shadow(24, 0) == 1);
    CHECK(heard.labels.shadow(25, 0) == 2);
}

TEST_CASE("A bin's shadow is labelled with the seabed where it shades more than a target does") {
    // A ridge 1 m high at x = 8 shades the bottom up to 10; a plate that floats at x = 5 shades some of what is around
    // it.
    struct ridge {
        in::seabed::type kind = in::seabed::type::mud;
        void row(const in::seabed::scanline& line, std::span<float> heights) const {
            for (std::size_t i = 0; i < heights.size(); ++i)
                heights[i] = static_cast<float>(std::max(0.0, 1 - 20 * std::abs(line.x(i) - 8)));
        }
        in::seabed::height_range range() const { return {0, 1}; }
    };
    const auto label_of_bin = [](double from, double to) {
        const auto height = [](double end) { return static_cast<float>(5 * (1 - 5 / end)); };
        in::scene s;
        s.seabed = ridge{};
        s.add(plate(5, height(from), height(to)), {}, "plate");
        const in::ground_range rig{.ping_spacing = 1, .pings = 1, .first_range = 0.5f, .range = 20.5f, .bins = 20};
        auto options = cross_sections;
        options.cell = 0.005;
        return in::render(s, rig, options).labels.shadow(9, 0);  // from 9.5 to 10.5 m
    };
    CHECK(label_of_bin(10.2, 10.4) == in::labels::by_seabed);
    CHECK(label_of_bin(9.7, 10.45) == 1);
}

TEST_CASE("A bin's seabed is the type that has most of it, whichever comes first") {
    struct two_types {
        double border;
        void row(const in::seabed::scanline& line, std::span<float> heights, std::span<in::seabed::type> types) const {
            std::fill(heights.begin(), heights.end(), 0.0f);
            for (std::size_t i = 0; i < types.size(); ++i)
                types[i] = line.x(i) < border ? in::seabed::type::mud : in::seabed::type::rock;
        }
        in::seabed::height_range range() const { return {0, 0}; }
    };
    const auto type_of_bin = [](double border) {
        in::scene s;
        s.seabed = two_types{border};
        const in::ground_range rig{.ping_spacing = 1, .pings = 1, .range = 20, .bins = 20};
        auto options = cross_sections;
        options.cell = 0.01;
        return in::render(s, rig, options).labels.seabed(10, 0);
    };
    CHECK(type_of_bin(10.3) == static_cast<std::uint8_t>(in::seabed::type::rock));
    CHECK(type_of_bin(10.7) == static_cast<std::uint8_t>(in::seabed::type::mud));
}

TEST_CASE("Objects above the sonar return all of their energy, up to the zenith") {
    in::scene bare, s;
    bare.seabed = s.seabed = plane;
    s.add(ceiling(8, 0, 6), {}, "bridge", {1});
    const auto rig = one_ping(5, 30, 600);
    const auto heard = in::render(s, rig, cross_sections);
    // The integral of sine^2 = h^2 / (x^2 + h^2) over x, by a metre of track.
    CHECK(energy(heard.image) - energy(in::render(bare, rig, cross_sections).image) ==
          Approx(3 * std::atan(2.0)).epsilon(0.01));
    CHECK(heard.labels.instance(61, 0) == 1);
}

TEST_CASE("Parts thinner than the spacing of rays return their own energy in every ping") {
    in::scene s;
    s.seabed = in::seabed::none{};
    const double width = 0.002;
    // An upright strip, 2 mm high, that crosses all pings and drifts in range and height.
    const in::mesh bar{.positions = {{9, 0, 0.4f}, {9.5f, 20, 0.7f}, {9.5f, 20, 0.702f}, {9, 0, 0.402f}},
                       .triangles = {{0, 2, 1}, {0, 3, 2}}};
    s.add(bar, {.position = {0, -0.01, 0}}, "bar", {1});
    in::side_scan rig = one_ping(5, 30, 1000);
    rig.ping_spacing = 0.1f, rig.pings = 180;
    const auto heard = in::render(s, rig, cross_sections.without_labels());
    for (int y = 0; y < rig.pings; ++y) {
        double sum = 0;
        for (const float v : heard.image.row(y)) sum += static_cast<double>(v);
        const double f = (0.1 * y + 0.01) / 20, x = 9 + 0.5 * f, down = 5 - 0.4 - 0.3 * f;
        // Upright, 2 mm high; the slope along the track widens it and turns it away.
        const double sine = x / std::hypot(x, down) / std::hypot(1, 0.025);
        REQUIRE(sum == Approx(0.1 * width * std::hypot(1, 0.025) * sine * sine).epsilon(0.02));
    }
}

TEST_CASE("Thin parts shade as much as they cover, and change no other bin") {
    in::scene bare, s;
    bare.seabed = s.seabed = plane;
    s.add(plate(9, 0.4f, 0.402f), {}, "bar", {0});
    const auto rig = one_ping(5, 30, 1000);
    const auto with = in::render(s, rig, cross_sections), without = in::render(bare, rig, cross_sections);
    const double lost = energy(without.image) - energy(with.image);
    const double x0 = 9 / (1 - 0.4 / 5), x1 = 9 / (1 - 0.402 / 5), middle = 0.5 * (x0 + x1);
    CHECK(lost == Approx(0.45 * (x1 - x0) * 25 / (25 + middle * middle)).epsilon(0.05));
}

TEST_CASE("A mesh wound against its normals gives the same pictures as one wound with them") {
    for (const bool every : {true, false}) {
        in::mesh good = to_mesh(in::cube{}), bad = good;
        for (std::size_t i = 0; i < bad.triangles.size(); i += every ? 1 : 3)
            std::swap(bad.triangles[i].y, bad.triangles[i].z);
        const auto scene_of = [](const in::mesh& m) {
            in::scene s;
            s.seabed = plane;
            s.add(m, {.position = {8, 0, 0.5}, .yaw = 0.3f}, "cube", {1});
            return s;
        };
        const in::scene a = scene_of(good), b = scene_of(bad);
        CHECK(in::render(a, one_ping(5, 30, 600)).image == in::render(b, one_ping(5, 30, 600)).image);
        const in::overhead above{.position = {8, 0}, .altitude = 4, .size = {96, 96}, .grazing = 20_deg};
        CHECK(in::render(a, above).image == in::render(b, above).image);
    }
}

TEST_CASE("Inverting all normals does not change the energy; inverting every second one loses less than half of it") {
    in::mesh inward = to_mesh(in::sphere{});
    const auto total = [](const in::mesh& m) {
        in::scene s;
        s.seabed = in::seabed::none{};
        s.add(m, {.position = {8, 0, 1}}, "sphere", {1});
        return energy(in::render(s, one_ping(5, 30, 600), cross_sections).image);
    };
    const double whole = total(inward);
    for (std::size_t i = 0; i < inward.normals.size(); i += 2) inward.normals[i] *= -1.0f;
    CHECK(total(inward) > 0.5 * whole);
    inward = to_mesh(in::sphere{});
    for (glm::vec3& n : inward.normals) n *= -1.0f;
    CHECK(total(inward) == Approx(whole).epsilon(1e-3));
    // A triangle whose normals disagree keeps its winding.
    in::mesh wall = plate(0, -1, 1);
    wall.normals.assign(4, {-1, 0, 0});
    const double expected = total(wall);
    for (const std::size_t i : {std::size_t{1}, std::size_t{2}, std::size_t{3}}) wall.normals[i].x = 1;
    CHECK(total(wall) == Approx(expected).epsilon(0.01));
}

TEST_CASE("Normals that are zero, NaN or infinite are replaced by the facet's") {
    const float infinity = std::numeric_limits<float>::infinity(), nan = std::nanf("");
    in::mesh facets = plate(8, 0, 1);
    const auto heard = [](const in::mesh& m) {
        in::scene s;
        s.seabed = plane;
        s.add(m, {}, "plate", {1});
        return in::render(s, one_ping(5, 30, 600)).image;
    };
    const auto expected = heard(facets);
    for (const float bad : {0.0f, nan, infinity}) {
        facets.normals.assign(4, glm::vec3(bad));
        CHECK(in::accuracy::compare_images(heard(facets), expected).mean_square < 1e-12);
    }
}

TEST_CASE("A scene of meshes alone works in every mode") {
    in::scene s;
    s.seabed = in::seabed::none{};
    // A bottom as a mesh, and a cube on it.
    s.add(in::mesh{.positions = {{-60, -3, 0}, {60, -3, 0}, {60, 3, 0}, {-60, 3, 0}},
                   .triangles = {{0, 1, 2}, {0, 2, 3}}},
          {}, "bottom", {1});
    s.add(in::cube{}, {.position = {10, 0, 0.5}}, "cube", {1});
    in::scene usual;
    usual.seabed = plane;
    usual.bottom.fill({1});
    usual.add(in::cube{}, {.position = {10, 0, 0.5}}, "cube", {1});
    const auto check = [&](const auto& rig) {
        const auto mesh = in::render(s, rig, cross_sections), bottom = in::render(usual, rig, cross_sections);
        CHECK(energy(mesh.image) == Approx(energy(bottom.image)).epsilon(0.01));
        CHECK(mesh.labels.targets[1].area > 0);
        CHECK(std::abs(mesh.labels.targets[1].area - bottom.labels.targets[0].area) <= 2);
        CHECK(mesh.stats.seabed_samples == 0);
    };
    check(in::side_scan{.altitude = 5, .pings = 1, .range = 30, .bins = 300});
    check(in::ground_range{.altitude = 5, .pings = 1, .range = 30, .bins = 300});
    CHECK(in::render(s, in::overhead{.position = {10, 0}, .size = {64, 64}}).labels.targets[1].area > 0);
}

TEST_CASE("A sonar below all meshes receives their echoes; an empty scene is silent") {
    in::scene s;
    s.seabed = in::seabed::none{};
    const auto rig = one_ping(5, 30, 300);
    CHECK(energy(in::render(s, rig).image) == 0);
    s.add(ceiling(8, 1, 6), {}, "ice", {1});
    CHECK(energy(in::render(s, rig, cross_sections).image) ==
          Approx(3 * (std::atan(2.0) - std::atan(1 / 3.0))).epsilon(0.01));
}

TEST_CASE("Row i is ping i in every recording, the first on top; upside_down turns rows, labels and numbers") {
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
    const auto turned = in::upside_down(drawn);
    CHECK(turned.labels.targets[0].box.y0 == 40 - 10 - drawn.labels.targets[0].box.height());
    CHECK((turned.rows.first == 39 && turned.rows.step == -1));
    CHECK(std::equal(turned.image.row(39).begin(), turned.image.row(39).end(), drawn.image.row(0).begin()));
    // Speckle follows the numbers.
    const in::seabed_speckle speckle{.seed = 3};
    CHECK(in::upside_down(in::with_speckle(drawn, speckle)).image == in::with_speckle(turned, speckle).image);
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
    s.seabed = plane;
    const double pitch = 0.3;
    s.add(in::cube{.size = glm::vec3(0.4f)}, {.position = {9, 5 * std::tan(pitch), 0.2}}, "cube", {1});
    const in::side_scan rig = one_ping(5, 30, 3000);
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
    s.seabed =
        in::seabed::sculpted{.ground = plane, .edits = {in::seabed::raise{.centre = {9, 3}, .radius = 2, .height = 1}}};
    const double pitch = 0.5;
    const in::ping pings[] = {{.position = {0, 0, 5}, .pitch = pitch}, {.position = {0, 0, 5}}};
    const auto heard = in::record(s, std::span<const in::ping>(pings), one_ping(5, 30, 600), cross_sections);
    // The hill lies where the fan reaches the ground, 5 tan(pitch) = 2.7 m ahead, and casts a shadow there alone.
    int dark[2] = {0, 0};
    for (int row = 0; row < 2; ++row)
        for (const std::uint16_t by : heard.labels.shadow.row(row)) dark[row] += by == in::labels::by_seabed;
    CHECK(dark[0] > dark[1] + 10);
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
        in::side_scan rig = one_ping(5, 30, 300);
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
        CHECK_FALSE(drawn.image == in::render(s, rig, defaults.with(in::lambert_backscatter{})).image);
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
    CHECK_THROWS_WITH(with({.pitch = 1.5}), ContainsSubstring("ping.pitch is 1.5"));
    CHECK_THROWS_WITH(with({.roll = std::nan("")}), ContainsSubstring("ping.roll is nan"));
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
    CHECK_THROWS_WITH(in::record_into(mine.view(), s, track, rig), ContainsSubstring("into.width() is 60"));
    CHECK_THROWS_WITH(in::record_into(mine.view().part(0, 0, 50, 8), s, track, rig),
                      ContainsSubstring("into.height() is 8"));
}
