// Statistics of relief: spectral exponents, and the wavelength, spread and forks of ripples.
#include <insonify/seabed/models.hpp>
#include <insonify/seabed/sample.hpp>
#include <insonify/seabed/sediment.hpp>

#include <cmath>
#include <complex>

#include "../../catch.hpp"
#include "../../larger.hpp"

namespace in = insonify;
namespace sb = insonify::seabed;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr sb::roughness smooth{.rms = 0};

/// Discrete Fourier transform of 2^k values, in place.
void transform(std::vector<std::complex<double>>& values) {
    const std::size_t n = values.size();
    if (n == 1) return;
    std::vector<std::complex<double>> even(n / 2), odd(n / 2);
    for (std::size_t i = 0; i < n / 2; ++i) even[i] = values[2 * i], odd[i] = values[2 * i + 1];
    transform(even);
    transform(odd);
    for (std::size_t k = 0; k < n / 2; ++k) {
        const auto turned = std::polar(1.0, -2 * pi * static_cast<double>(k) / static_cast<double>(n)) * odd[k];
        values[k] = even[k] + turned;
        values[k + n / 2] = even[k] - turned;
    }
}

/// |F|^2 of an n x n patch through a Hann window, frequency 0 in the corner.
in::image<double> periodogram(const in::image<float>& patch) {
    const int n = patch.width();
    std::vector<std::complex<double>> line(static_cast<std::size_t>(n));
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    const auto window = [&](int i) { return 1 - std::cos(2 * pi * (i + 0.5) / n); };
    double mean = 0;
    for (const float h : patch.pixels()) mean += static_cast<double>(h) / n / n;
    in::image<std::complex<double>> rows(n, n);
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) line[at(x)] = (static_cast<double>(patch(x, y)) - mean) * window(x) * window(y);
        transform(line);
        for (int x = 0; x < n; ++x) rows(x, y) = line[at(x)];
    }
    in::image<double> power(n, n);
    for (int x = 0; x < n; ++x) {
        for (int y = 0; y < n; ++y) line[at(y)] = rows(x, y);
        transform(line);
        for (int y = 0; y < n; ++y) power(x, y) = std::norm(line[at(y)]);
    }
    return power;
}

int signed_frequency(int i, int n) {
    return i < n / 2 ? i : i - n;
}

/// Slope of the radially averaged periodogram between 4 and n / 4 cycles, over patches of three seeds; every octave
/// counts the same.
template <class Make>
double slope(Make make, double spacing, int n = 256) {
    std::vector<double> ring(static_cast<std::size_t>(n)), members(static_cast<std::size_t>(n));
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const auto field = sb::sample(make(seed), {.origin = {0, 5000}, .spacing = spacing, .width = n, .height = n});
        const auto power = periodogram(field.heights);
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const double u = signed_frequency(x, n), v = signed_frequency(y, n);
                const auto r = static_cast<std::size_t>(std::sqrt(u * u + v * v) + 0.5);
                ring[r] += power(x, y);
                members[r] += 1;
            }
    }
    double s = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t r = 4; r <= static_cast<std::size_t>(n / 4); ++r) {
        const double w = 1 / static_cast<double>(r), a = std::log(static_cast<double>(r)),
                     b = std::log(ring[r] / members[r]);
        s += w, sx += w * a, sy += w * b, sxx += w * a * a, sxy += w * a * b;
    }
    return (s * sxy - sx * sy) / (s * sxx - sx * sx);
}

/// Mean and variance, along and across the ripples, of the wave vectors in a patch: in cycles per metre.
struct waves {
    double number, spread, bandwidth;
};
waves waves_of(const sb::ripples& recipe) {
    const int n = 256;
    const double spacing = static_cast<double>(recipe.wavelength) / 8;
    const auto power =
        periodogram(sb::sample(recipe, {.origin = {40, 70}, .spacing = spacing, .width = n, .height = n}).heights);
    const double k0 = 1 / static_cast<double>(recipe.wavelength), angle = static_cast<double>(recipe.direction);
    double sum = 0, along = 0, along_square = 0, across_square = 0;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const double u = signed_frequency(x, n) / (n * spacing), v = signed_frequency(y, n) / (n * spacing);
            const double a = u * std::cos(angle) + v * std::sin(angle), b = v * std::cos(angle) - u * std::sin(angle);
            if (std::hypot(a - k0, b) > 0.55 * k0) continue;  // one half plane, without the harmonics
            sum += power(x, y), along += power(x, y) * a, along_square += power(x, y) * a * a;
            across_square += power(x, y) * b * b;
        }
    const double mean = along / sum;
    return {mean, std::sqrt(across_square / sum) / mean, std::sqrt(along_square / sum - mean * mean) / mean};
}

/// Zeros of psi in a square: plaquettes around which its phase winds.
int forks(const sb::ripples& recipe, double side) {
    const sb::ripples_sampler sampler(recipe);
    const double step = static_cast<double>(recipe.wavelength) / 8;
    const int n = static_cast<int>(side / step);
    const auto turns = [](double from, double to) {
        return (to - from) / (2 * pi) - std::round((to - from) / (2 * pi));
    };
    std::vector<double> above, here;
    int count = 0;
    for (int j = 0; j < n; ++j) {
        here.clear();
        for (int i = 0; i < n; ++i) {
            const auto psi = sampler.psi(i * step, j * step);
            here.push_back(std::atan2(psi.im, psi.re));
        }
        for (std::size_t i = 1; j > 0 && i < here.size(); ++i) {
            const double winding = turns(above[i - 1], above[i]) + turns(above[i], here[i]) +
                                   turns(here[i], here[i - 1]) + turns(here[i - 1], above[i - 1]);
            count += std::abs(winding) > 0.5 ? 1 : 0;
        }
        above = here;
    }
    return count;
}

}  // namespace

TEST_CASE("The radially averaged periodogram of a roughness falls with its exponent") {
    const float exponent = GENERATE(2.4f, 3.25f, 3.9f);
    const auto sand = [&](std::uint64_t seed) {
        return sb::flat{.surface = {.longest = 32, .shortest = 0.05f, .exponent = exponent}, .seed = seed};
    };
    CHECK(slope(sand, 1.0 / 16) == Approx(-static_cast<double>(exponent)).margin(0.15));
    CHECK(slope(sand, 1.0 / 10) == Approx(-static_cast<double>(exponent)).margin(0.15));
}

TEST_CASE(
    "The periodograms of sand, mud, sediments and rock fall with their exponents, by default and at a sonar's "
    "resolution") {
    const double spacing = 0.05;
    CHECK(slope([](std::uint64_t seed) { return sb::flat{.seed = seed}; }, spacing) == Approx(-3.25).margin(0.15));
    CHECK(slope([](std::uint64_t seed) { return sb::mud{.density = 0, .seed = seed}; }, spacing) ==
          Approx(-3.25).margin(0.15));
    CHECK(slope([](std::uint64_t seed) { return sb::rock{.seed = seed}; }, spacing) == Approx(-3.25).margin(0.15));
    CHECK(slope([](std::uint64_t seed) { return sb::bottom_of(sb::sediment::coarse_sand, seed); }, spacing) ==
          Approx(-3.25).margin(0.15));
    const auto between_ripples = [](std::uint64_t seed) {
        return sb::ripples{.steepness = 0, .surface = {.longest = 4, .shortest = 0.05f}, .seed = seed};
    };
    CHECK(slope(between_ripples, spacing) == Approx(-3.25).margin(0.15));
}

TEST_CASE("Sediments, and surveys continued by them, have the spectral strength of the table, w2 (K cm)^-3.25") {
    const float longest = GENERATE(4.0f, 0.8f);
    const int n = 256;
    const double spacing = 0.05, w2 = 0.004446, window = 2.25;  // mean square of a Hann window in two dimensions
    std::vector<double> power(3), expected(3);                  // of octaves: 0.2 to 0.4 m, 0.4 to 0.8 m, 0.8 to 1.6 m
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const sb::flat sand{.surface = sb::roughness_of(sb::sediment::medium_sand, longest), .seed = seed};
        const auto found = periodogram(sb::sample(sand, {.spacing = spacing, .width = n, .height = n}).heights);
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const double wave_number =
                    2 * pi * std::hypot(signed_frequency(x, n), signed_frequency(y, n)) / (n * spacing);
                const double octave = std::log2(2 * pi / wave_number / 0.2);
                if (!(octave >= 0 && octave < 3)) continue;
                const auto i = static_cast<std::size_t>(octave);
                power[i] += found(x, y) * std::pow(spacing / n / (2 * pi), 2) / window;
                expected[i] += w2 * 1e-8 * std::pow(wave_number / 100, -3.25);
            }
    }
    for (std::size_t i = 0; i < 2; ++i) CHECK(power[i] == Approx(expected[i]).epsilon(0.08));
    CHECK(power[2] == Approx((longest > 1.6f ? 1 : 0.86) * expected[2]).epsilon(0.08));
}

TEST_CASE("Ripples have the wavelength, spread and bandwidth of their parameters") {
    const float direction = GENERATE(0.0f, 2.1f);
    const sb::ripples recipe{
        .wavelength = 0.8f, .direction = direction, .spread = 0.12f, .bandwidth = 0.08f, .surface = smooth};
    waves mean{};
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        sb::ripples one = recipe;
        one.seed = seed;
        const waves w = waves_of(one);
        mean.number += w.number / 4, mean.spread += w.spread / 4, mean.bandwidth += w.bandwidth / 4;
    }
    INFO(mean.number << " " << mean.spread << " " << mean.bandwidth);
    CHECK(mean.number == Approx(1.25).epsilon(0.03));
    // Heights have a spectrum that is wider than that of psi by a quarter or so: near forks its phase turns faster.
    CHECK(mean.spread == Approx(1.28 * 0.12).epsilon(0.1));
    CHECK(mean.bandwidth == Approx(1.28 * 0.08).epsilon(0.1));
}

TEST_CASE("Crests fork 2 pi spread bandwidth / wavelength^2 times per square metre") {
    const float spread = GENERATE(0.06f, 0.15f);
    const float bandwidth = GENERATE(0.05f, 0.12f);
    double found = 0, promised = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const sb::ripples recipe{.wavelength = 1, .spread = spread, .bandwidth = bandwidth, .seed = seed};
        found += forks(recipe, 24) / 576.0;
        promised += recipe.forks();
    }
    INFO(found << " found, " << promised << " promised");
    CHECK(found == Approx(promised).epsilon(0.2));
}

TEST_CASE("The profile of ripples is a trochoid's to within 0.07 of half their height") {
    // Waves of a single number and direction: psi turns evenly, and heights are the profile.
    const float sharpness = GENERATE(0.2f, 0.5f);
    const sb::ripples recipe{
        .wavelength = 1, .steepness = 0.1f, .spread = 0, .bandwidth = 0, .sharpness = sharpness, .surface = smooth};
    const int n = 512;
    const auto row = sb::sample(recipe, {.spacing = 1.0 / n, .width = n, .height = 2}).heights;
    const auto s = static_cast<double>(sharpness);
    const auto crest = std::max_element(row.row(0).begin(), row.row(0).end()) - row.row(0).begin();
    const auto top = static_cast<double>(row.row(0)[static_cast<std::size_t>(crest)]);
    const auto trough = static_cast<double>(*std::min_element(row.row(0).begin(), row.row(0).end()));
    double worst = 0;
    for (int i = 0; i < n; ++i) {
        double e = 2 * pi * i / n;
        for (int k = 0; k < 50; ++k) e = 2 * pi * i / n + s * std::sin(e);  // Kepler's equation
        const double height = static_cast<double>(row(static_cast<int>((crest + i) % n), 0));
        worst = larger(worst, std::abs(2 * (height - trough) / (top - trough) - 1 - std::cos(e)));
    }
    CHECK(worst < 0.07);
    CHECK(worst > 0.001);
}

TEST_CASE("The number of rock blocks by size follows the exponent") {
    // The share of the ground under blocks of each size class, alone: with an exponent of 2 it is the same for all.
    const auto covered = [](float spacing, float share) {
        in::image<float> values(200, 200);
        const sb::detail::block_layer layer(static_cast<double>(spacing), share, 1, 1000,
                                            {7, sb::detail::stream::blocks, 0});
        std::size_t count = 0;
        for (int j = 0; j < 200; ++j) {
            const sb::scanline line{.y = 0.31 * j, .spacing = 0.29};
            const sb::detail::stretch part(line, 200);
            sb::detail::stretch_values heights{};
            layer.raise<1>(part, heights.data());
            for (std::size_t i = 0; i < 200; ++i) count += heights[i] > 0.0f ? 1u : 0u;
        }
        return static_cast<double>(count) / 40000;
    };
    // An octagon of radius r covers 8 (sqrt 2 - 1) r^2, and r = 0.6 +- 0.3 t^2 for a uniform t: r^2 is 0.36 + 0.09 / 5
    // on average. Blocks that overlap at random leave about exp(-cover) of the ground free.
    const double one = 8 * (std::sqrt(2.0) - 1) * (0.36 + 0.09 / 5);
    CHECK(covered(1, 0.2f) == Approx(1 - std::exp(-0.2 * one)).epsilon(0.05));
    CHECK(covered(2, 0.2f) == Approx(1 - std::exp(-0.2 * one)).epsilon(0.08));
    CHECK(covered(1, 0.05f) == Approx(1 - std::exp(-0.05 * one)).epsilon(0.1));
}
