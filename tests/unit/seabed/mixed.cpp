// Layered seabeds: areas of the layers, and their borders.
#include <insonify/seabed/models.hpp>
#include <insonify/seabed/sample.hpp>

#include <cmath>

#include "../../catch.hpp"
#include "smooth.hpp"

namespace in = insonify;
namespace sb = insonify::seabed;

namespace {

sb::type type_at(const sb::mixed& m, double x, double y) {
    return sb::at(m, x, y).kind;
}

}  // namespace

TEST_CASE("Layers lie where their shapes are, later ones above earlier ones") {
    const sb::mixed bed{.base = sb::mud{},
                        .layers = {{sb::flat{}, sb::disc{{10, 0}, 5}, 0.1f, 0},
                                   {sb::ripples{}, sb::band{{{0, 20}, {20, 20}, {20, 40}}, 4}, 0.1f, 0},
                                   {sb::rock{}, sb::polygon{{{8, -2}, {12, -2}, {12, 2}, {8, 2}}}, 0.1f, 0}}};
    CHECK(type_at(bed, 0, 0) == sb::type::mud);
    CHECK(type_at(bed, 10, 4.8) == sb::type::sand);
    CHECK(type_at(bed, 10, 5.2) == sb::type::mud);
    CHECK(type_at(bed, 10, 0) == sb::type::rock);
    CHECK(type_at(bed, 11.8, 1.8) == sb::type::rock);
    CHECK(type_at(bed, 12.2, 1.8) == sb::type::sand);
    CHECK(type_at(bed, 3, 21.8) == sb::type::ripples);
    CHECK(type_at(bed, 21.8, 30) == sb::type::ripples);
    CHECK(type_at(bed, 3, 22.2) == sb::type::mud);
    CHECK(type_at(bed, -1.8, 20) == sb::type::ripples);  // its end is round
}

TEST_CASE("A stencil's layer lies where its image is above one half") {
    in::image<float> picture(4, 3, 0.0f);
    picture(2, 1) = 1;
    const sb::mixed bed{.layers = {{sb::rock{}, sb::stencil{picture, {100, 200}, 10}, 0.1f, 0}}};
    CHECK(type_at(bed, 120, 210) == sb::type::rock);
    CHECK(type_at(bed, 124, 210) == sb::type::rock);
    CHECK(type_at(bed, 126, 210) == sb::type::sand);
    CHECK(type_at(bed, 120, 216) == sb::type::sand);
    CHECK(type_at(bed, -500, 0) == sb::type::sand);
}

TEST_CASE("A stencil of a disc, of ones and zeros, covers what the disc does, to a pixel of its border") {
    in::image<float> picture(201, 161, 0.0f);
    for (int y = 0; y < 161; ++y)
        for (int x = 0; x < 201; ++x) picture(x, y) = std::hypot(0.1 * x - 9, 0.1 * y - 8) < 5 ? 1.0f : 0.0f;
    const auto bed = [](const sb::area& where) {
        return sb::mixed{.base = sb::flat{}, .layers = {{sb::rock{}, where, 0.6f, 0}}};
    };
    const sb::grid around{.origin = {2.03, 1.07}, .spacing = 0.11, .width = 120, .height = 120};
    const auto by_picture = sb::sample(bed(sb::stencil{picture, {0, 0}, 0.1}), around);
    const auto by_disc = sb::sample(bed(sb::disc{{9, 8}, 5}), around);
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 120; ++x) {
            const double inside = 5 - std::hypot(2.03 + 0.11 * x - 9, 1.07 + 0.11 * y - 8);
            if (std::abs(inside) < 0.4) continue;  // half of the border and a pixel
            REQUIRE(by_picture.heights(x, y) == by_disc.heights(x, y));
            REQUIRE(by_picture.types(x, y) == (inside > 0 ? sb::type::rock : sb::type::sand));
        }
}

TEST_CASE("Patches cover their given fraction, for any layers above and below") {
    const float coverage = GENERATE(0.1f, 0.4f, 0.8f);
    const sb::mixed bed{.base = sb::flat{},
                        .layers = {{sb::mud{.density = 0}, sb::patches{coverage, 3}, 0.3f},
                                   {sb::ripples{}, sb::patches{0.5f, 3}, 0.3f}}};
    const auto field = sb::sample(bed, {.spacing = 0.73, .width = 500, .height = 500});
    double mud = 0, ripples = 0;
    for (const sb::type t : field.types.pixels()) {
        mud += t == sb::type::mud ? 1 : 0;
        ripples += t == sb::type::ripples ? 1 : 0;
    }
    CHECK(ripples / 250000 == Approx(0.5).margin(0.03));
    CHECK(mud / (250000 - ripples) == Approx(static_cast<double>(coverage)).margin(0.03));
}

TEST_CASE("Beyond its border a layer is exactly its bottom; within it the surface has no steps") {
    const sb::ripples waves{.wavelength = 0.5f, .surface = smooth};
    const sb::flat plain{.surface = smooth};
    const bool under = GENERATE(false, true);
    const sb::any base = under ? sb::any(waves) : plain, layer = under ? sb::any(plain) : waves;
    const sb::mixed bed{.base = base, .layers = {{layer, sb::disc{{0, 0}, 4}, 1, 0}}};
    const double spacing = 1.0 / 128;
    const sb::grid area{.origin = {-6, -6}, .spacing = spacing, .width = 12 * 128, .height = 400};
    const auto field = sb::sample(bed, area), rippled = sb::sample(waves, area);
    std::size_t wrong = 0, mixed = 0;
    float steepest = 0, steepest_ripple = 0;
    for (int j = 0; j < area.height; ++j)
        for (int i = 1; i < area.width; ++i) {
            const double x = -6 + spacing * i, y = -6 + spacing * j, r = std::sqrt(x * x + y * y);
            const float height = field.heights(i, j), wave = rippled.heights(i, j);
            if (std::abs(r - 4) > 0.5)
                wrong += height != ((r < 4) != under ? wave : 0.0f) ? 1u : 0u;
            else
                mixed += height != 0 && height != wave ? 1u : 0u;
            steepest = std::max(steepest, std::abs(height - field.heights(i - 1, j)));
            steepest_ripple = std::max(steepest_ripple, std::abs(wave - rippled.heights(i - 1, j)));
        }
    CHECK(wrong == 0);
    CHECK(mixed > 1000);
    CHECK(steepest < 1.5f * steepest_ripple);
}

TEST_CASE("Crests emerge from a border before troughs") {
    const sb::mixed bed{.base = sb::flat{.surface = smooth},
                        .layers = {{sb::ripples{.wavelength = 0.5f, .surface = smooth}, sb::disc{{0, 0}, 4}, 1, 0}}};
    const sb::grid area{.origin = {-4.4, -4.4}, .spacing = 0.02, .width = 440, .height = 440};
    const auto field = sb::sample(bed, area);
    std::size_t above = 0, below = 0;
    for (int j = 0; j < area.height; ++j)
        for (int i = 0; i < area.width; ++i) {
            const double x = -4.4 + 0.02 * i, y = -4.4 + 0.02 * j, r = std::sqrt(x * x + y * y);
            if (r < 4.05 || r > 4.4 || field.types(i, j) != sb::type::ripples) continue;
            ++(field.heights(i, j) > 0 ? above : below);
        }
    CHECK(above > 200);
    CHECK(below == 0);
}

TEST_CASE("Layers name the parameter they refuse") {
    const auto bed = [](sb::layer l) { return sb::mixed{.layers = {std::move(l)}}; };
    CHECK_THROWS_WITH(bed({.border = 0}).prepare(), ContainsSubstring("layer.border is 0"));
    CHECK_THROWS_WITH(bed({.ragged = -1}).prepare(), ContainsSubstring("layer.ragged is -1"));
    CHECK_THROWS_WITH(bed({.where = sb::patches{.coverage = 2}}).prepare(), ContainsSubstring("patches.coverage is 2"));
    CHECK_THROWS_WITH(bed({.where = sb::disc{.radius = -1}}).prepare(), ContainsSubstring("disc.radius is -1"));
    CHECK_THROWS_WITH(bed({.where = sb::band{}}).prepare(), ContainsSubstring("band.path"));
    CHECK_THROWS_WITH(bed({.where = sb::polygon{{{0, 0}, {1, 1}}}}).prepare(), ContainsSubstring("polygon.corners"));
    CHECK_THROWS_WITH(bed({.where = sb::stencil{}}).prepare(), ContainsSubstring("stencil.coverage"));
    CHECK_THROWS_WITH(bed({.bottom = sb::rock{.block = 0}}).prepare(), ContainsSubstring("rock.block"));
}
