// Band limit: relief finer than a grid fades out instead of aliasing, at any spacing.
#include <insonify/seabed/models.hpp>
#include <insonify/seabed/sample.hpp>

#include <cmath>

#include "../../catch.hpp"
#include "smooth.hpp"

namespace in = insonify;
namespace sb = insonify::seabed;

namespace {

sb::heightfield sampled(const sb::any& source, double spacing, bool band_limited = true, int size = 192) {
    return sb::sample(
        source,
        {.origin = {-3.7, 11.3}, .spacing = spacing, .width = size, .height = size, .band_limited = band_limited});
}

double rms(const sb::heightfield& field) {
    double mean = 0, square = 0;
    const auto n = static_cast<double>(field.heights.size());
    for (const float h : field.heights.pixels()) mean += static_cast<double>(h) / n;
    for (const float h : field.heights.pixels())
        square += (static_cast<double>(h) - mean) * (static_cast<double>(h) - mean) / n;
    return std::sqrt(square);
}

/// Means over squares of 8 x 8 coarse vertices, against means over the same ground of a grid four times finer: the
/// root mean square difference, in metres. Relief that the coarse grid cannot carry has to average out on it.
double false_swell(const sb::any& source, double spacing, bool band_limited) {
    constexpr int squares = 8, across = 8, finer = 4;
    const auto coarse = sampled(source, spacing, band_limited, squares * across);
    const glm::dvec2 first = coarse.origin - 0.5 * (spacing - spacing / finer);
    const int size = squares * across * finer;
    const auto fine = sb::sample(source, {.origin = first, .spacing = spacing / finer, .width = size, .height = size});
    const auto mean = [](const sb::heightfield& field, int x, int y, int side) {
        double sum = 0;
        for (int j = y * side; j < (y + 1) * side; ++j)
            for (int i = x * side; i < (x + 1) * side; ++i) sum += static_cast<double>(field.heights(i, j));
        return sum / side / side;
    };
    double sum = 0, square = 0;
    for (int y = 0; y < squares; ++y)
        for (int x = 0; x < squares; ++x) {
            const double off = mean(coarse, x, y, across) - mean(fine, x, y, across * finer);
            sum += off / (squares * squares);
            square += off * off / (squares * squares);
        }
    return std::sqrt(square - sum * sum);
}

}  // namespace

TEST_CASE("A grid keeps waves of four samples and drops those of two") {
    CHECK(sb::band_limit_gain(1, 0) == 1);
    CHECK(sb::band_limit_gain(1, 0.25) == 1);
    CHECK(sb::band_limit_gain(1, 1.0 / 3) == Approx(2.0f / 3));
    CHECK(sb::band_limit_gain(1, 0.5) == 0);
    CHECK(sb::band_limit_gain(1, 1e9) == 0);
}

TEST_CASE("Ripples on a grid coarser than they are vanish; without the limit they turn up as longer ones") {
    const sb::ripples ripples{.wavelength = 0.5f, .steepness = 0.12f, .surface = smooth};
    // Each of these spacings aliases the ripples to waves of several samples, which look like a real swell.
    for (const double spacing : {0.25, 0.4, 0.45, 0.55, 0.9, 1.05, 40.0}) {
        CAPTURE(spacing);
        CHECK(rms(sampled(ripples, spacing, false)) > 0.015);
        CHECK(rms(sampled(ripples, spacing)) == 0);
    }
    // Between two and four samples a wave they fade steadily, and finer grids have them whole.
    double before = 0;
    for (const double spacing : {0.24, 0.2, 0.17, 0.14, 0.126}) {
        const double now = rms(sampled(ripples, spacing));
        CHECK(now > before);
        before = now;
    }
    CHECK(sampled(ripples, 0.5 / 8).heights == sampled(ripples, 0.5 / 8, false).heights);
}

TEST_CASE("Smoothed ground fades on coarse grids as the ground around it does") {
    const sb::ripples ripples{.wavelength = 0.8f, .surface = smooth};
    for (const float length : {0.1f, 0.25f}) {
        const sb::sculpted smoothed{.ground = ripples, .edits = {sb::smooth{{0, 0}, 1000, length}}};
        for (const double spacing : {0.25, 0.35, 0.5}) {
            CAPTURE(length, spacing);
            CHECK(rms(sampled(smoothed, spacing)) <= rms(sampled(ripples, spacing)));
        }
        CHECK(rms(sampled(smoothed, 0.1)) > 0);
    }
}

TEST_CASE("Smoothing removes relief that is shorter than its nodes, instead of aliasing it") {
    for (const float wavelength : {0.0625f, 0.07f, 0.12f}) {
        const sb::ripples ripples{.wavelength = wavelength, .surface = smooth};
        const sb::sculpted smoothed{.ground = ripples, .edits = {sb::smooth{{0, 0}, 1000, 0.25f}}};
        CAPTURE(wavelength);
        CHECK(rms(sampled(smoothed, 0.01)) < 0.02 * rms(sampled(ripples, 0.01)));
    }
}

TEST_CASE("Patches keep their coverage on grids coarser than their borders") {
    const sb::blend half{.first = sb::flat{.kind = sb::type::rock}, .coverage = 0.3f, .patch = 12};
    for (const double spacing : {2.0, 10.0, 40.0}) {
        const auto field = sampled(half, spacing);
        double first = 0;
        for (const sb::type t : field.types.pixels()) first += t == sb::type::rock;
        CAPTURE(spacing);
        CHECK(first / static_cast<double>(field.types.size()) == Approx(0.3).margin(0.03));
    }
}

TEST_CASE("Roughness keeps the octaves that a grid carries, and their heights") {
    const sb::flat bottom{.surface = {.rms = 0.01f, .longest = 8, .shortest = 0.03125f, .exponent = 2.5f}};
    for (const double spacing : {0.0625, 0.25, 1.0}) {
        CAPTURE(spacing);
        const auto limited = sampled(bottom, spacing), all = sampled(bottom, spacing, false);
        CHECK(rms(limited) < rms(all));
        // The rest equals a roughness without the finer octaves.
        sb::flat coarse = bottom;
        coarse.surface.shortest = static_cast<float>(2 * spacing);
        const auto octaves = [](float shortest) {  // of cells from 8 m, weighted by variance
            double sum = 0, variance = 1;
            for (double cell = 8; cell >= static_cast<double>(shortest); cell /= 2, variance *= std::pow(2, -0.5))
                sum += variance;
            return sum;
        };
        coarse.surface.rms *= static_cast<float>(std::sqrt(octaves(coarse.surface.shortest) / octaves(0.03125f)));
        const auto expected = sampled(coarse, spacing, false);
        for (std::size_t i = 0; i < limited.heights.size(); i += 97)
            CHECK(limited.heights.pixels()[i] == Approx(expected.heights.pixels()[i]).margin(1e-6));
    }
    CHECK(rms(sampled(bottom, 8)) == 0);
}

TEST_CASE("Means over an area are those of a fine grid, however coarse the samples") {
    const sb::any seabeds[] = {sb::flat{.surface = {.rms = 0.02f, .longest = 3}}, sb::ripples{},
                               sb::ripples{.wavelength = 0.5f, .steepness = 0.12f, .direction = 0.3f}, sb::mud{}};
    for (const sb::any& seabed : seabeds) {
        double limited = 0, unlimited = 0;
        for (const double spacing : {0.05, 0.2, 0.45, 0.6, 0.85, 1.3}) {
            const double with = false_swell(seabed, spacing, true), without = false_swell(seabed, spacing, false);
            CAPTURE(seabed.legend().front().name, spacing, with, without);
            CHECK(with < 0.0025);
            limited += with, unlimited += without;
        }
        CHECK(limited < 0.6 * unlimited);
    }
}

TEST_CASE("Ten kilometres cost as many samples as forty metres, and are level where the grid carries no relief") {
    const sb::mud bottom{};
    const auto wide = sampled(bottom, 10e3 / 192), fine = sampled(bottom, 40.0 / 192);
    CHECK(wide.heights.size() == fine.heights.size());
    CHECK(rms(wide) == 0);
    CHECK(rms(fine) > 0.005);
}
