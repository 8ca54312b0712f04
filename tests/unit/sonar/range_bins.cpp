// Bins of range modes: their labels, objects above the sonar, thin parts, normals, and scenes without seabed. Energies
// are those of closed forms.
#include <insonify/all.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "../../catch.hpp"
#include "../../single_pings.hpp"

namespace in = insonify;
using namespace in::literals;
using single_pings::cross_sections;
using single_pings::level_ground;
using single_pings::one_metre;

namespace {

/// Upright, facing the sonar at x, from z0 to z1, of 2 m along the track.
in::mesh plate(float x, float z0, float z1) {
    return {.positions = {{x, -1, z0}, {x, 1, z0}, {x, 1, z1}, {x, -1, z1}}, .triangles = {{0, 2, 1}, {0, 3, 2}}};
}

/// Level at z, from x0 to x1, seen from below.
in::mesh ceiling(float z, float x0, float x1) {
    return {.positions = {{x0, -1, z}, {x1, -1, z}, {x1, 1, z}, {x0, 1, z}}, .triangles = {{0, 2, 1}, {0, 3, 2}}};
}

double energy_of(const in::image<float>& picture) {
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
        s.seabed = level_ground;
        const std::uint16_t lower = swapped ? 2 : 1;
        if (swapped) s.add(plate(8, 1.0956f, 2), {}, "B");
        s.add(plate(8, 0, 1.0956f), {}, "A");
        if (!swapped) s.add(plate(8, 1.0956f, 2), {}, "B");
        for (const int bins : {60, 61, 57}) {
            const auto heard = in::render(s, one_metre(5, 30, bins), cross_sections);
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
    s.seabed = level_ground;
    for (const char* const name : {"first", "second", "third"}) s.add(plate(8, 0, 0.03f), {}, name);
    s.add(plate(12, 0, 3), {}, "behind");
    for (int i = 0; i < 2; ++i) s.add(plate(16, 4, 4.02f), {}, "above");
    const auto heard = in::render(s, one_metre(5, 30, 900), cross_sections);
    const auto named = [&](int instance) {
        const auto all = heard.labels.instance.pixels();
        return std::count(all.begin(), all.end(), instance);
    };
    for (const int first : {1, 4, 5}) CHECK(named(first) > 0);
    for (const int other : {2, 3, 6}) CHECK(named(other) == 0);
}

TEST_CASE("A bin's shadow is labelled with the target that shades most of it") {
    in::scene s;
    s.seabed = level_ground;
    // Heights whose shadows end at bins 24.8 and 26 of 60 over 30 m: A shades 80 % of bin 24, B all of bin 25.
    const auto height_for = [](double tip) { return static_cast<float>(5 * (1 - 8 / tip)); };
    const auto ground = [](double bin) { return std::sqrt(bin * bin / 4 - 25); };
    s.add(plate(8, 0, height_for(ground(24.8))), {}, "A");
    s.add(plate(8, height_for(ground(24.8)), height_for(ground(26))), {}, "B");
    const auto heard = in::render(s, one_metre(5, 30, 60), cross_sections);
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
    bare.seabed = s.seabed = level_ground;
    s.add(ceiling(8, 0, 6), {}, "bridge", {1});
    const auto rig = one_metre(5, 30, 600);
    const auto heard = in::render(s, rig, cross_sections);
    // The integral of sine^2 = h^2 / (x^2 + h^2) over x, by a metre of track.
    CHECK(energy_of(heard.image) - energy_of(in::render(bare, rig, cross_sections).image) ==
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
    in::side_scan rig = one_metre(5, 30, 1000);
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
    bare.seabed = s.seabed = level_ground;
    s.add(plate(9, 0.4f, 0.402f), {}, "bar", {0});
    const auto rig = one_metre(5, 30, 1000);
    const auto with = in::render(s, rig, cross_sections), without = in::render(bare, rig, cross_sections);
    const double lost = energy_of(without.image) - energy_of(with.image);
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
            s.seabed = level_ground;
            s.add(m, {.position = {8, 0, 0.5}, .yaw = 0.3f}, "cube", {1});
            return s;
        };
        const in::scene a = scene_of(good), b = scene_of(bad);
        CHECK(in::render(a, one_metre(5, 30, 600)).image == in::render(b, one_metre(5, 30, 600)).image);
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
        return energy_of(in::render(s, one_metre(5, 30, 600), cross_sections).image);
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
        s.seabed = level_ground;
        s.add(m, {}, "plate", {1});
        return in::render(s, one_metre(5, 30, 600)).image;
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
    usual.seabed = level_ground;
    usual.bottom.fill({1});
    usual.add(in::cube{}, {.position = {10, 0, 0.5}}, "cube", {1});
    const auto check = [&](const auto& rig) {
        const auto mesh = in::render(s, rig, cross_sections), bottom = in::render(usual, rig, cross_sections);
        CHECK(energy_of(mesh.image) == Approx(energy_of(bottom.image)).epsilon(0.01));
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
    const auto rig = one_metre(5, 30, 300);
    CHECK(energy_of(in::render(s, rig).image) == 0);
    s.add(ceiling(8, 1, 6), {}, "ice", {1});
    CHECK(energy_of(in::render(s, rig, cross_sections).image) ==
          Approx(3 * (std::atan(2.0) - std::atan(1 / 3.0))).epsilon(0.01));
}
