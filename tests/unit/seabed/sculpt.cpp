// Sculpting: each edit on a plane, composition in order, and no change outside of an edit.
#include <insonify/core/random.hpp>
#include <insonify/seabed/models.hpp>
#include <insonify/seabed/sample.hpp>

#include <cmath>

#include "../../catch.hpp"

namespace in = insonify;
namespace sb = insonify::seabed;

namespace {

const sb::flat plane{.surface = {.rms = 0}};

float height(const std::vector<sb::edit>& edits, double x, double y) {
    return sb::at(sb::sculpted{.ground = plane, .edits = edits}, x, y).height;
}

/// A slope of one in x, of a half in y.
struct slope {
    static constexpr sb::type kind = sb::type::rock;
    void row(const sb::scanline& line, std::span<float> heights) const {
        for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = static_cast<float>(line.x(i) + 0.5 * line.y);
    }
};

double variance(const in::image<float>& heights) {
    double mean = 0, square = 0;
    for (const float h : heights.pixels()) mean += static_cast<double>(h) / static_cast<double>(heights.size());
    for (const float h : heights.pixels())
        square += std::pow(static_cast<double>(h) - mean, 2) / static_cast<double>(heights.size());
    return square;
}

}  // namespace

TEST_CASE("Hills and hollows have their height in the middle and end at their radius") {
    CHECK(height({sb::raise{{3, 4}, 2, 0.5f}}, 3, 4) == 0.5f);
    CHECK(height({sb::raise{{3, 4}, 2, -0.5f}}, 3, 4) == -0.5f);
    CHECK(height({sb::raise{{3, 4}, 2, 0.5f}}, 4, 4) == Approx(0.5 * 0.75 * 0.75));
    CHECK(height({sb::raise{{3, 4}, 2, 0.5f}}, 5.01, 4) == 0);
}

TEST_CASE("Flattened ground is level but for its edge") {
    const sb::sculpted bed{.ground = sb::ripples{}, .edits = {sb::flatten{{0, 0}, 4, 0.2f}}};
    for (const double x : {0.0, 1.5, 2.9}) CHECK(sb::at(bed, x, 0.3).height == 0.2f);
    CHECK(sb::at(bed, 5, 0).height == sb::at(sb::ripples{}, 5, 0).height);
}

TEST_CASE("Ramps rise linearly from one end to the other, and fade at their sides and beyond their ends") {
    const std::vector<sb::edit> edits{sb::ramp{{1, 1}, {5, 4}, 2, 0.1f, 1.1f}};
    for (const double t : {0.0, 0.25, 0.5, 1.0})
        CHECK(height(edits, 1 + 4 * t, 1 + 3 * t) == Approx(0.1 + t).margin(1e-6));
    CHECK(height(edits, 3 - 0.6 * 0.7, 2.5 + 0.8 * 0.7) == Approx(0.6).margin(1e-6));      // 0.7 m beside the middle
    CHECK(height(edits, 3 - 0.6 * 0.875, 2.5 + 0.8 * 0.875) == Approx(0.3).margin(1e-6));  // the middle of an edge
    CHECK(height(edits, 3 - 0.6 * 1.01, 2.5 + 0.8 * 1.01) == 0);
    CHECK(height(edits, 5 + 0.8 * 0.25, 4 + 0.6 * 0.25) == Approx(0.55).margin(1e-6));
    CHECK(height(edits, 5 + 0.8 * 0.51, 4 + 0.6 * 0.51) == 0);
    CHECK(height(edits, 1 - 0.8 * 0.25, 1 - 0.6 * 0.25) == Approx(0.05).margin(1e-6));
    CHECK(height(edits, 1 - 0.8 * 0.51, 1 - 0.6 * 0.51) == 0);
}

TEST_CASE("Furrows follow a path; marks come at equal steps along it, around corners too") {
    const std::vector<glm::dvec2> path{{0, 0}, {3, 0}, {3, 4}};
    const std::vector<sb::edit> furrow{sb::stamp{path, 0.5f, -0.2f}};
    CHECK(height(furrow, 1.7, 0) == -0.2f);
    CHECK(height(furrow, 3, 3.3) == -0.2f);
    CHECK(height(furrow, 1.7, 0.6) == 0);
    const std::vector<sb::edit> marks{sb::stamp{path, 0.5f, -0.2f, 2}};
    for (const glm::dvec2 at : {glm::dvec2{0, 0}, {2, 0}, {3, 1}, {3, 3}}) CHECK(height(marks, at.x, at.y) == -0.2f);
    for (const glm::dvec2 at : {glm::dvec2{1, 0}, {3, 0}, {3, 2}, {3, 4}}) CHECK(height(marks, at.x, at.y) == 0);
    // No mark lies on the extension of a leg, here at (3, -1).
    CHECK(height({sb::stamp{path, 1, -0.2f, 2}}, 3, -0.4) == 0);
}

TEST_CASE("A moat follows its outline, deepest where the current arrives, and heaps a mound down-current") {
    const sb::moat m{.outline = {{-4, -1}, {4, -1}, {4, 1}, {-4, 1}},
                     .depth = 0.4f,
                     .width = 2,
                     .current = 0,
                     .mound = 0.2f,
                     .tail = 6};
    // Up-current of the outline it is as deep as stated, abeam three quarters of it, in the lee half.
    CHECK(height({m}, -4, 0) == Approx(-0.4f));
    CHECK(height({m}, 0, 1) == Approx(-0.3f));
    CHECK(height({m}, 4, 0) == Approx(-0.2f));
    CHECK(height({m}, -5, 0) == Approx(-0.4f * 0.5625f));
    // The ground under the target and beyond the moat keeps its height.
    CHECK(height({m}, 0, 0) == 0);
    CHECK(height({m}, -6, 0) == 0);
    CHECK(height({m}, 0, 3.001) == 0);
    // The mound begins half a width behind the outline, and is highest after a third of its length.
    CHECK(height({m}, 5 + 2, 0) == Approx(0.2f));
    CHECK(height({m}, 11, 0) == 0);
    CHECK(height({m}, 7, 2.001) == 0);

    // Rotating outline and current rotates the whole moat, which stays within its extent.
    sb::moat turned = m;
    turned.current = 0.7f;
    for (glm::dvec2& p : turned.outline)
        p = {p.x * std::cos(0.7) - p.y * std::sin(0.7), p.x * std::sin(0.7) + p.y * std::cos(0.7)};
    for (double x = -7; x < 12; x += 0.5)
        for (double y = -4; y < 4; y += 0.5)
            CHECK(height({turned}, x * std::cos(0.7) - y * std::sin(0.7), x * std::sin(0.7) + y * std::cos(0.7)) ==
                  Approx(height({m}, x, y)).margin(1e-5));
    const auto range = sb::sculpted{.ground = plane, .edits = {m}}.prepare().range();
    CHECK(range.lowest <= -0.4);
    CHECK(range.highest >= 0.2);

    const auto prepare = [](const sb::edit& e) { return sb::sculpted{.ground = plane, .edits = {e}}.prepare(); };
    CHECK_THROWS_WITH(prepare(sb::moat{.outline = {{0, 0}, {1, 0}}}), ContainsSubstring("moat.outline.size() is 2"));
    CHECK_THROWS_WITH(prepare(sb::moat{.outline = {{0, 0}, {1, 0}, {2e9, 1}}}),
                      ContainsSubstring("moat.outline.x is 2e+09"));
    CHECK_THROWS_WITH(prepare(sb::moat{.depth = -1}), ContainsSubstring("moat.depth is -1"));
    CHECK_THROWS_WITH(prepare(sb::moat{.width = 0}), ContainsSubstring("moat.width is 0"));
    CHECK_THROWS_WITH(prepare(sb::moat{.mound = -1}), ContainsSubstring("moat.mound is -1"));
    CHECK_THROWS_WITH(prepare(sb::moat{.tail = -1}), ContainsSubstring("moat.tail is -1"));
}

TEST_CASE("A heap is level on top, slopes down its sides, and leaves higher ground alone") {
    const sb::heap heap{{0, 0}, 1, 0.3f, 0.5f};
    CHECK(height({heap}, 0.9, 0) == 0.3f);
    CHECK(height({heap}, 1.4, 0) == Approx(0.1));
    CHECK(height({heap}, 1.7, 0) == 0);
    CHECK(height({sb::raise{{0, 0}, 1, 0.5f}, heap}, 0, 0) == 0.5f);
    const sb::heap high{{0, 0}, 1, 150, 0.5f};  // its sides reach down by 100 m
    CHECK(height({high}, 200, 0) == Approx(50.5));
    CHECK(height({high}, 202, 0) == 0);
}

TEST_CASE("An edit changes all of the ground that its shape reaches") {
    const auto check = [](const auto& e) {
        in::random_sequence random(1);
        int differing = 0, changed = 0;
        for (int n = 0; n < 2000; ++n) {
            const double x = random.uniform(-5, 9), y = random.uniform(-5, 9);
            const float expected = sb::detail::height_after(e, {x, y}, 0.0f);
            differing += height({e}, x, y) != expected;
            changed += expected != 0;
        }
        INFO("edit " << sb::edit(e).index());
        CHECK(differing == 0);
        CHECK(changed > 50);
    };
    check(sb::raise{{2, 2}, 3, 0.5f});
    check(sb::flatten{{2, 2}, 3, 0.5f});
    check(sb::ramp{{0, 2}, {4, 2}, 4, 0.3f, 0.8f});
    check(sb::stamp{{{0, 2}, {4, 2}}, 2, -0.2f});
    check(sb::stamp{{{0, 2}, {4, 2}}, 1, -0.2f, 1.5f});
    check(sb::heap{{2, 2}, 1, 1, 0.5f});
    check(sb::moat{
        .outline = {{0, 1}, {3, 1}, {3, 3}}, .depth = 0.4f, .width = 2, .current = 0, .mound = 0.2f, .tail = 2});
    check(sb::moat{
        .outline = {{0, 2}, {1, 2}, {1, 3}}, .depth = 0.4f, .width = 0.5f, .current = 0, .mound = 0.2f, .tail = 7.5f});
}

TEST_CASE("Smoothing removes short relief and keeps slopes") {
    const sb::grid area{.origin = {-1, -1}, .spacing = 0.03, .width = 60, .height = 60};
    const sb::ripples waves{.wavelength = 0.3f};
    const sb::sculpted bed{.ground = waves, .edits = {sb::smooth{{0, 0}, 4, 0.4f}}};
    CHECK(variance(sb::sample(bed, area).heights) < 0.02 * variance(sb::sample(waves, area).heights));
    const sb::sculpted sloped{.ground = slope{}, .edits = {sb::smooth{{0, 0}, 4, 0.4f}}};
    for (const double x : {-1.3, 0.0, 0.77, 2.9})
        CHECK(static_cast<double>(sb::at(sloped, x, 1.1).height) == Approx(x + 0.55).margin(1e-5));
}

TEST_CASE("Smoothing leaves ground beside gaps as it is, and makes no gap wider") {
    sb::heightfield survey{.heights = in::image<float>(41, 41, 1.0f), .spacing = 0.25};
    survey.heights(20, 20) = std::nanf("");
    const sb::grid area{.spacing = 0.05, .width = 200, .height = 200};
    const auto gaps = [&](const std::vector<sb::edit>& edits) {
        const auto field = sb::sample(sb::sculpted{.ground = survey, .edits = edits}, area);
        return std::count_if(field.heights.pixels().begin(), field.heights.pixels().end(),
                             [](float h) { return !std::isfinite(h); });
    };
    const auto bare = gaps({});
    CHECK(bare > 0);
    for (const float length : {0.25f, 1.0f}) CHECK(gaps({sb::smooth{{5, 5}, 3, length}}) == bare);
    CHECK(gaps({sb::smooth{{7.5, 7.5}, 2.6f, 0.5f}}) == bare);
}

TEST_CASE("Heights stay within the range after levelling and smoothing, rounding included") {
    const std::vector<sb::edit> edits{sb::flatten{{0, 0}, 100, 0.3f}, sb::smooth{{0, 0}, 2, 0.25f},
                                      sb::ramp{.from_height = 0.3f, .to_height = 0.3f}};
    const sb::sculpted bed{.ground = plane, .edits = edits};
    const sb::height_range range = bed.prepare().range();
    const auto field = sb::sample(bed, {.origin = {-3, -3}, .spacing = 0.03, .width = 200, .height = 200});
    for (const float h : field.heights.pixels()) {
        REQUIRE(static_cast<double>(h) <= range.highest);
        REQUIRE(static_cast<double>(h) >= range.lowest);
    }
}

TEST_CASE("A hundred thousand edits need no deep stack") {
    const sb::sculpted bed{.ground = plane,
                           .edits = std::vector<sb::edit>(100000, sb::raise{{0, 0}, 1, 1.0f / 131072})};
    CHECK(sb::at(bed, 0, 0).height == 100000.0f / 131072);
}

TEST_CASE("Edits apply in order") {
    const sb::edit hill = sb::raise{{0, 0}, 2, 0.5f}, level = sb::flatten{{0, 0}, 2, 0.1f};
    CHECK(height({hill, level}, 0, 0) == 0.1f);
    CHECK(height({level, hill}, 0, 0) == Approx(0.6f));
    // Smoothing applies to the result of earlier edits.
    CHECK(height({sb::raise{{0, 0}, 0.2f, 0.5f}, sb::smooth{{0, 0}, 2, 0.5f}}, 0, 0) < 0.1f);
    CHECK(height({sb::smooth{{0, 0}, 2, 0.5f}, sb::raise{{0, 0}, 0.2f, 0.5f}}, 0, 0) == 0.5f);
}

TEST_CASE(
    "Sculpted heights depend on the position alone and equal the base outside of the edits, also far from the origin") {
    const double origin = GENERATE(0.0, 10000000.0);
    const sb::blend ground{.first = sb::rock{}, .patch = 3};
    const sb::sculpted bed{.ground = ground,
                           .edits = {sb::moat{.outline = {{origin + 2.6, 1.7}, {origin + 3.4, 1.7}, {origin + 3, 2.4}},
                                              .depth = 0.15f,
                                              .width = 0.6f,
                                              .tail = 2},
                                     sb::smooth{{origin + 4, 1}, 1.5f, 0.3f},
                                     sb::stamp{{{origin + 1, 0}, {origin + 3, 3}}, 0.3f, 0.1f, 0.7f}}};
    const double spacing = 1.0 / 32;
    const sb::grid whole{.origin = {origin, 0}, .spacing = spacing, .width = 300, .height = 90};
    const sb::grid patch{
        .origin = {origin + 97 * spacing, 31 * spacing}, .spacing = spacing, .width = 64, .height = 32};
    const auto all = sb::sample(bed, whole), part = sb::sample(bed, patch), bare = sb::sample(ground, whole);
    const auto prepared = bed.prepare();
    std::size_t differing = 0, changed = 0;
    for (int j = 0; j < patch.height; ++j)
        for (int i = 0; i < patch.width; ++i) {
            differing += part.heights(i, j) != all.heights(i + 97, j + 31) ? 1u : 0u;
            differing += part.types(i, j) != all.types(i + 97, j + 31) ? 1u : 0u;
            const auto point = sb::at(prepared, patch.origin.x + i * spacing, patch.origin.y + j * spacing);
            differing += point.height != part.heights(i, j) ? 1u : 0u;
            changed += part.heights(i, j) != bare.heights(i + 97, j + 31) ? 1u : 0u;
        }
    CHECK(differing == 0);
    CHECK(changed > 1000);
    for (int j = 0; j < whole.height; ++j) REQUIRE(all.heights(250, j) == bare.heights(250, j));
    CHECK(all.types == bare.types);
}

TEST_CASE("Refusals of edits name the parameter") {
    const auto prepare = [](sb::edit e) { return sb::sculpted{.ground = plane, .edits = {std::move(e)}}.prepare(); };
    CHECK_THROWS_WITH(prepare(sb::raise{.radius = 0}), ContainsSubstring("raise.radius is 0"));
    CHECK_THROWS_WITH(prepare(sb::flatten{.level = std::nanf("")}), ContainsSubstring("flatten.level"));
    CHECK_THROWS_WITH(prepare(sb::smooth{.length = 0}), ContainsSubstring("smooth.length is 0"));
    CHECK_THROWS_WITH(prepare(sb::smooth{{0, 0}, 132, 0.001f}), ContainsSubstring("smooth.radius is 132"));
    CHECK_NOTHROW(prepare(sb::smooth{{0, 0}, 131, 0.001f}));
    CHECK_THROWS_WITH(prepare(sb::ramp{.to = {0, 0}}), ContainsSubstring("ramp.to"));
    CHECK_THROWS_WITH(prepare(sb::stamp{}), ContainsSubstring("stamp.path.size() is 0"));
    CHECK_THROWS_WITH(prepare(sb::heap{.slope = 0}), ContainsSubstring("heap.slope is 0"));
}
