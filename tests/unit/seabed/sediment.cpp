// Sediments by name: the table, the relief, and the reflectivity and speckle of their labels.
#include <insonify/seabed/sample.hpp>
#include <insonify/seabed/sediment.hpp>
#include <insonify/sonar/scene.hpp>
#include <insonify/sonar/speckle.hpp>

#include <cmath>

#include "../../catch.hpp"

namespace in = insonify;
namespace sb = insonify::seabed;

TEST_CASE("Sediments are found by name and by grain size") {
    CHECK(sb::sediment_of("medium sand") == in::sediment::medium_sand);
    CHECK(sb::sediment_of("silty clay") == in::sediment::silty_clay);
    CHECK_THROWS_WITH(sb::sediment_of("lava"), ContainsSubstring("\"lava\" is unknown"));
    CHECK(sb::sediment_of_phi(1.4f) == in::sediment::medium_sand);
    CHECK(sb::sediment_of_phi(40) == in::sediment::silty_clay);
    CHECK_THROWS_AS(sb::sediment_of_phi(std::nanf("")), in::invalid_input);
    for (const sb::sediment_parameters& row : sb::sediments) {
        const in::sediment s = sb::sediment_of(row.name);
        CHECK(sb::type_of(s) == row.label);
        CHECK(&sb::parameters_of(s) == &row);
        CHECK(sb::sediment_of_phi(row.phi) == s);
    }
    CHECK(sb::type_count == 16);
    CHECK(static_cast<int>(sb::type::rock) == 3);  // data sets store these numbers
    CHECK(static_cast<int>(sb::type::rough_rock) == 4);
    CHECK(static_cast<int>(sb::type::silty_clay) == 15);
}

TEST_CASE("A value that names no sediment is refused") {
    for (const int value : {0, 3, 16, 255}) {
        CAPTURE(value);
        CHECK_THROWS_WITH(sb::parameters_of(static_cast<sb::sediment>(value)),
                          "sediment is " + std::to_string(value) + ", expected an enumerator of seabed::sediment");
    }
}

TEST_CASE("The relief of a sediment is that of its spectrum: 2 pi w2 K^-1.25 / 1.25 at a metre") {
    const double w2 = 0.004446, k = 2 * 3.14159265358979 / 100;
    const double expected = std::sqrt(2 * 3.14159265358979 * w2 * std::pow(k, -1.25) / 1.25) / 100;
    CHECK(static_cast<double>(sb::parameters_of(in::sediment::medium_sand).rms()) == Approx(expected).epsilon(1e-3));
    // The same spectrum reaches further than a metre: the variance of all waves shorter than L grows as L^1.25.
    for (const float longest : {0.5f, 4.0f}) {
        const sb::roughness rough = sb::roughness_of(in::sediment::medium_sand, longest);
        CHECK(rough.longest == longest);
        CHECK(static_cast<double>(rough.rms) ==
              Approx(expected * std::pow(2.16 * static_cast<double>(longest), 0.625)).epsilon(1e-3));
    }
    CHECK(sb::roughness_of(in::sediment::medium_sand, 0.01f).shortest == 0.01f);
    const sb::roughness rough = sb::roughness_of(in::sediment::medium_sand);
    const auto field =
        sb::sample(sb::bottom_of(in::sediment::medium_sand), {.spacing = 1.21, .width = 400, .height = 400});
    double square = 0;
    for (const float h : field.heights.pixels()) square += static_cast<double>(h) * static_cast<double>(h);
    CHECK(std::sqrt(square / 160000) == Approx(static_cast<double>(rough.rms)).epsilon(0.05));
}

TEST_CASE("A sediment's name sets relief, brightness and speckle together") {
    const auto sample = [](in::sediment s) {
        return sb::sample(sb::bottom_of(s), {.spacing = 0.05, .width = 64, .height = 64});
    };
    const in::scene scene;
    const in::seabed_speckle speckle;
    for (const sb::sediment_parameters& row : sb::sediments) {
        const in::sediment s = sb::sediment_of(row.name);
        const auto field = sample(s);
        const sb::type type = field.types.empty() ? field.fallback : field.types(3, 5);
        REQUIRE(type == sb::type_of(s));
        const auto index = static_cast<std::size_t>(type);
        const double level =
            static_cast<double>(sb::parameters_of(s).level - sb::parameters_of(in::sediment::medium_sand).level);
        CHECK(10 * std::log10(static_cast<double>(scene.bottom[index].reflectivity) / 0.45) ==
              Approx(level).margin(1e-3));
        CHECK(speckle.bottom[index].texture == sb::parameters_of(s).texture);
        CHECK(speckle.bottom[index].steady == sb::parameters_of(s).steady);
    }
    CHECK(sb::rippled(in::sediment::coarse_sand).kind == sb::type::coarse_sand);
}
