// Bounds of a seabed's heights, which limit the search for shadow casters.
#include <insonify/seabed/models.hpp>

#include <algorithm>
#include <vector>

#include "../../catch.hpp"

namespace in = insonify;
namespace sb = insonify::seabed;

namespace {

/// @param slack  largest ratio of the stated range to the measured one
void check(const sb::any& bottom, double slack) {
    const auto prepared = sb::prepare(bottom);
    const sb::height_range stated_range = prepared.range();
    std::vector<float> heights(4000);
    std::vector<sb::type> types(heights.size());
    float lowest = 1e9f, highest = -1e9f;
    for (int row = 0; row < 400; ++row) {
        prepared.row({.y = row * 0.17, .origin = -90, .spacing = 0.05}, heights, types);
        lowest = (std::min)(lowest, *std::min_element(heights.begin(), heights.end()));
        highest = (std::max)(highest, *std::max_element(heights.begin(), heights.end()));
    }
    INFO("bottom " << bottom.legend().front().name << ": " << lowest << " to " << highest << ", stated "
                   << stated_range.lowest << " to " << stated_range.highest);
    CHECK(stated_range.lowest <= static_cast<double>(lowest));
    CHECK(stated_range.highest >= static_cast<double>(highest));
    CHECK(stated_range.highest - stated_range.lowest <= slack * static_cast<double>(highest - lowest));
}

}  // namespace

TEST_CASE("Heights stay within the stated range, which is at most ten times too wide") {
    check(sb::flat{}, 10);
    check(sb::flat{.surface = {.rms = 0}}, 1e9);
    check(sb::ripples{}, 3);
    check(sb::ripples{.wavelength = 0.3f, .sharpness = 0.9f, .surface = {.rms = 0}}, 3);
    check(sb::ripples{.second = {.wavelength = 0.3f, .steepness = 0.1f}}, 3);
    check(sb::mud{}, 10);
    check(sb::mud{.surface = {.rms = 0.001f}, .density = 0}, 10);
    check(sb::mud{.pock_depth = 5, .pock_fraction = 0}, 10);
    check(sb::mud{.mound_height = 5, .pock_fraction = 1}, 10);
    check(sb::mud{.density = 0, .trawls = {.density = 0.1f}}, 10);
    check(sb::rock{}, 10);
    check(sb::rock{.relief = 2, .fracture = 1, .surface = {.rms = 0}}, 10);
    check(sb::blend{.second = sb::rock{}}, 10);
    check(sb::mixed{.base = sb::mud{}, .layers = {{.bottom = sb::rock{}}, {.bottom = sb::ripples{}}}}, 10);
}

TEST_CASE("The range of a detailed survey bounds its vertices, the interpolation between them, and the detail") {
    sb::heightfield survey{.heights = in::image<float>(40, 40), .origin = {-90, -5}, .spacing = 2.5};
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 40; ++j) survey.heights(i, j) = (i + j) % 3 == 0 ? 1.0f : 0.0f;
    check(survey, 2);
    check(sb::detailed{.field = survey}, 3);

    // Squares of two by two vertices: the largest overshoot, in the middle of a square.
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 40; ++j) survey.heights(i, j) = (i / 2 + j / 2) % 2 == 0 ? 1.0f : 0.0f;
    check(sb::detailed{.field = survey, .surface = {.rms = 0}}, 1.01);
}

TEST_CASE("seabed::none has an empty range of heights") {
    CHECK(sb::prepare(sb::any(sb::none{})).range().empty());
}

TEST_CASE("The range of a sculpted seabed bounds the base and its edits") {
    const sb::flat sand{.surface = {.rms = 0.01f}};
    for (const sb::edit& e :
         {sb::edit(sb::raise{.radius = 3, .height = 0.7f}), sb::edit(sb::raise{.height = -0.7f}),
          sb::edit(sb::flatten{.radius = 4, .level = -0.5f}), sb::edit(sb::smooth{.radius = 3}),
          sb::edit(sb::ramp{.from_height = -0.3f, .to_height = 0.6f}),
          sb::edit(sb::stamp{.path = {{-3, 1}, {5, 9}}, .height = -0.3f}),
          sb::edit(sb::moat{.depth = 0.4f, .mound = 0.3f}), sb::edit(sb::heap{.radius = 1, .level = 0.8f})}) {
        INFO("edit " << e.index());
        check(sb::sculpted{.ground = sand, .edits = {e}}, 10);
        check(sb::sculpted{.ground = sand, .edits = {e, e}}, 10);
    }
}
