// The heights that seabeds promise never to leave.
#include <insonify/core/random.hpp>
#include <insonify/seabed/any.hpp>
#include <insonify/seabed/sample.hpp>

#include "../../catch.hpp"

namespace in = insonify;
namespace seabed = insonify::seabed;

TEST_CASE("No seabed leaves the heights that it promises, and none promises much more than it needs") {
    const seabed::any recipes[] = {
        seabed::flat{},
        seabed::flat{.surface = {.rms = 0}},
        seabed::ripples{},
        seabed::ripples{.wavelength = 0.3f, .height = 0.08f, .sharpness = 0.9f, .surface = {.rms = 0}},
        seabed::mud{},
        seabed::mud{.surface = {.rms = 0}, .density = 0.5f},
        seabed::rock{},
        seabed::rock{.relief = 2, .fracture = 1, .surface = {.rms = 0}},
        seabed::blend{},
        seabed::blend{.first = seabed::rock{}, .second = seabed::mud{}}};
    for (const seabed::any& recipe : recipes) {
        const seabed::height_range range = seabed::prepare(recipe).range();
        seabed::height_range seen;
        in::random_sequence random(5);
        for (int patch = 0; patch < 12; ++patch) {
            const glm::dvec2 corner(random.uniform(-1e5, 1e5), random.uniform(-1e5, 1e5));
            for (const float h : seabed::sample(recipe, {corner, 0.07, 160, 160}).heights.pixels())
                seen = seabed::merge(seen, {static_cast<double>(h), static_cast<double>(h)});
        }
        CAPTURE(recipe.index(), range.lowest, seen.lowest, seen.highest, range.highest);
        CHECK(range.lowest <= seen.lowest);
        CHECK(range.highest >= seen.highest);
        CHECK(range.highest - range.lowest <= 3.5 * (seen.highest - seen.lowest) + 1e-6);
    }
}

TEST_CASE("A heightfield's range is that of its vertices; nothing has none") {
    seabed::heightfield field{.heights = in::image<float>(3, 3)};
    field.heights(1, 1) = 2.5f;
    field.heights(0, 2) = -1;
    field.heights(2, 2) = std::numeric_limits<float>::quiet_NaN();
    CHECK(seabed::prepare(field).range().highest == 2.5);
    CHECK(seabed::prepare(field).range().lowest == -1);
    CHECK(seabed::prepare(seabed::none{}).range().empty());
}
