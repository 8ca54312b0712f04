// Noise: moments after clipping, distributions, and independence of adjacent pixels, frames and seeds.
#include <insonify/filter/echo_noise.hpp>
#include <insonify/filter/noise.hpp>
#include <insonify/filter/pipe.hpp>
#include <insonify/filter/poisson.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../../catch.hpp"
#include "../../moments.hpp"

namespace in = insonify;

namespace {

using moments::correlation, moments::once_in_1000;

constexpr int edge = 1024;  // 2^20 samples

struct sample_moments {
    double mean, variance, fourth;
};
sample_moments moments_of(const in::image<float>& image) {
    const auto n = static_cast<double>(image.size());
    double mean = 0, second = 0, fourth = 0;
    for (const float v : image.pixels()) mean += static_cast<double>(v) / n;
    for (const float v : image.pixels()) {
        const double square = (static_cast<double>(v) - mean) * (static_cast<double>(v) - mean);
        second += square / n;
        fourth += square * square / n;
    }
    return {mean, second, fourth};
}

/// Within four standard errors, and the rounding of a published number.
void check_moments(const in::image<float>& image, double mean, double variance, double mean_digit,
                   double variance_digit) {
    const auto m = moments_of(image);
    const auto n = static_cast<double>(image.size());
    CHECK(std::abs(m.mean - mean) <= 4 * std::sqrt(m.variance / n) + 0.5 * mean_digit);
    CHECK(std::abs(m.variance - variance) <=
          4 * std::sqrt((m.fourth - m.variance * m.variance) / n) + 0.5 * variance_digit);
}

/// See moments::kolmogorov_smirnov.
template <class Cumulative>
double distance_from_law(const in::image<float>& picture, const Cumulative& law) {
    return moments::kolmogorov_smirnov(picture.pixels(), law);
}

double normal_cdf(double z) {
    return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

in::image<float> flat(float value) {
    return in::image<float>(edge, edge, value);
}

}  // namespace

TEST_CASE("Clipped noise has the moments that integrals of the laws give") {
    const std::uint64_t seed = 11;
    check_moments(flat(0.5f) | in::gaussian{.variance = 0.05f, .seed = seed}, 0.50000, 0.04775, 1e-5, 1e-5);
    check_moments(flat(0.25f) | in::gaussian{.variance = 0.05f, .seed = seed}, 0.26478, 0.03945, 1e-5, 1e-5);
    check_moments(flat(0) | in::gaussian{.variance = 0.05f, .seed = seed}, 0.08921, 0.01704, 1e-5, 1e-5);
    check_moments(flat(1) | in::gaussian{.variance = 0.05f, .seed = seed}, 0.91079, 0.01704, 1e-5, 1e-5);
    check_moments(flat(0.5f) | in::speckle{.variance = 0.1f, .seed = seed}, 0.50000, 0.02500, 1e-5, 1e-5);
    check_moments(flat(0.8f) | in::speckle{.variance = 0.1f, .seed = seed}, 0.76763, 0.04487, 1e-5, 1e-5);
    check_moments(flat(1) | in::speckle{.variance = 0.1f, .seed = seed}, 0.86307, 0.03125, 1e-5, 1e-5);
    check_moments(flat(1) | in::speckle{.variance = 0.05f, .seed = seed}, 0.90318, 0.01563, 1e-5, 1e-5);
    check_moments(flat(0.25f) | in::gaussian_speckle{.variance = 0.04f, .seed = seed}, 0.25, 0.0025, 0, 0);
    check_moments(flat(0.1f) | in::rayleigh{.seed = seed}, 0.1, 0.01 * (4 / in::numeric::pi - 1), 0, 0);
}

TEST_CASE("Clipped poisson noise has the moments of MATLAB's uint8 rule") {
    const auto counts = [](float code) {
        return flat(code / 255) | in::poisson{.seed = 12} | [](float v) { return 255 * v; };
    };
    check_moments(counts(10), 10, 10, 0, 0);
    check_moments(counts(128), 128, 128, 0, 0);
    check_moments(counts(250), 245.861, 116.11, 1e-3, 1e-2);
    check_moments(counts(255), 248.631, 84.82, 1e-3, 1e-2);
}

TEST_CASE("Noise follows its law") {
    CHECK(distance_from_law(flat(0.5f) | in::gaussian{.mean = 0.02f, .variance = 0.0025f, .seed = 21},
                            [](double v) { return normal_cdf((v - 0.52) / 0.05); }) < once_in_1000);
    CHECK(distance_from_law(flat(0.5f) | in::speckle{.variance = 0.1f, .seed = 22},
                            [](double v) { return (v - 0.5) / (2 * 0.5 * std::sqrt(0.3)) + 0.5; }) < once_in_1000);
    CHECK(distance_from_law(flat(0.5f) | in::gaussian_speckle{.variance = 0.01f, .seed = 23},
                            [](double v) { return normal_cdf((v - 0.5) / 0.05); }) < once_in_1000);
    CHECK(distance_from_law(flat(0.125f) | in::rayleigh{.seed = 24}, [](double v) {
              return 1 - std::exp(-(v / 0.125) * (v / 0.125) * in::numeric::pi / 4);
          }) < once_in_1000);
}

TEST_CASE("Poisson counts follow the Poisson law on both sides of the change from inversion to rejection") {
    const float mean = GENERATE(0.05f, 0.7f, 1.0f, 4.5f, 9.99f, 10.0f, 10.5f, 30.5f, 128.2f, 255.9f, 400.0f);
    const float photons = 4096;
    const auto image = flat(mean / photons) | in::poisson{.photons = photons, .seed = 31};
    const auto exact_mean = static_cast<double>(mean / photons * photons);
    std::vector<double> observed(1024);
    for (const float v : image.pixels()) observed[static_cast<std::size_t>(std::lround(v * photons))] += 1;
    // Pearson's chi-square over counts that are expected at least 20 times, tails lumped.
    double statistic = 0, cells = 0, rest_expected = 0, rest_observed = 0, sum = 0;
    const auto n = static_cast<double>(image.size());
    for (std::size_t k = 0; k < observed.size(); ++k) {
        const auto count = static_cast<double>(k);
        const double p = std::exp(count * std::log(exact_mean) - exact_mean - std::lgamma(count + 1));
        sum += p;
        if (n * p >= 20) {
            statistic += (observed[k] - n * p) * (observed[k] - n * p) / (n * p);
            ++cells;
        } else {
            rest_expected += n * p;
            rest_observed += observed[k];
        }
    }
    CHECK(sum == Approx(1).epsilon(1e-9));
    CHECK(std::abs(rest_observed - rest_expected) <= 4 * std::sqrt(rest_expected) + 3);
    // Wilson and Hilferty: the cube root of chi-square / cells is normal.
    const double dof = cells - 1;
    const double z = (std::cbrt(statistic / dof) - (1 - 2 / (9 * dof))) / std::sqrt(2 / (9 * dof));
    CHECK(std::abs(z) < 4);
}

TEST_CASE("Poisson noise follows its law at the smallest and the largest number of photons") {
    CHECK((in::image<float>{{0, -1}} | in::poisson{}) == in::image<float>{{0, 0}});
    check_moments(flat(0.5f) | in::poisson{.photons = 1e9f, .seed = 1}, 0.5, 0.5e-9, 0, 0);
    const auto rare = flat(1) | in::poisson{.photons = 0.01f, .seed = 1};
    const auto hits = static_cast<double>(std::count(rare.pixels().begin(), rare.pixels().end(), 1.0f));
    const double expected = static_cast<double>(rare.size()) * (1 - std::exp(-0.01));
    CHECK(std::abs(hits - expected) < 4 * std::sqrt(expected));
    for (const double k : {0.0, 1.0, 2.0, 5.0, 9.0, 10.0, 11.0, 100.0, 1e6, 1e9}) {
        const double mean = k + 3 * std::sqrt(k + 10);
        double deficit;
        in::detail::poisson_deficit<1>(deficit, k, mean);
        const double exact = std::lgamma(k + 1) - k * std::log(mean) + mean - 0.5 * std::log(k + 1);
        CHECK(deficit == Approx(exact).epsilon(0).margin(1e-11 + k * 1e-14));
    }
}

TEMPLATE_TEST_CASE("Pixels of noise are independent of adjacent pixels, of other frames and of other seeds", "",
                   in::gaussian, in::speckle, in::gaussian_speckle, in::salt_and_pepper, in::rayleigh, in::poisson) {
    const auto base = flat(0.25f) | TestType{.seed = 1};
    const double limit = 4.5 / edge;
    CHECK(std::abs(correlation(base, base, 1, 0)) < limit);
    CHECK(std::abs(correlation(base, base, 2, 0)) < limit);
    CHECK(std::abs(correlation(base, base, 4, 0)) < limit);
    CHECK(std::abs(correlation(base, base, 0, 1)) < limit);
    CHECK(std::abs(correlation(base, flat(0.25f) | TestType{.seed = 2}, 0, 0)) < limit);
    CHECK(std::abs(correlation(base, flat(0.25f) | TestType{.seed = 1, .frame = 1}, 0, 0)) < limit);
    CHECK((flat(0.25f) | TestType{.seed = 1}) == base);
}

TEST_CASE("Different kinds of noise under one seed are independent") {
    const std::vector<in::image<float>> kinds = {
        flat(0.25f) | in::gaussian{.seed = 5},         flat(0.25f) | in::speckle{.seed = 5},
        flat(0.25f) | in::gaussian_speckle{.seed = 5}, flat(0.25f) | in::rayleigh{.seed = 5},
        flat(0.25f) | in::poisson{.seed = 5},          flat(0.25f) | in::salt_and_pepper{.seed = 5}};
    for (std::size_t a = 0; a < kinds.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) CHECK(std::abs(correlation(kinds[a], kinds[b], 0, 0)) < 4.5 / edge);
    }
}

TEMPLATE_TEST_CASE("The noise of a pixel depends on its place alone, not on the size of the image or other pixels", "",
                   in::gaussian, in::speckle, in::gaussian_speckle, in::salt_and_pepper, in::rayleigh, in::poisson) {
    const TestType noise{.seed = 9, .frame = 3};
    const auto large = in::image<float>(37, 29, 0.4f) | noise;
    in::image<float> other(11, 7, 0.4f);
    other(3, 3) = std::nanf("");
    other(4, 3) = -5;
    const auto cut = other | noise;
    CHECK(std::isnan(cut(3, 3)));
    CHECK(cut(4, 3) >= 0);
    for (int y = 0; y < 7; ++y) {
        for (int x = 0; x < 11; ++x) {
            if (y != 3 || (x != 3 && x != 4)) CHECK(cut(x, y) == large(x, y));
        }
    }
    const auto column = in::image<float>(1, 29, 0.4f) | noise;
    for (int y = 0; y < 29; ++y) CHECK(column(0, y) == large(0, y));
}

TEST_CASE("Noise of zero variance only clips") {
    const in::image<float> source{{-1, 0, 0.3f, 1, 2}};
    const in::image<float> clipped{{0, 0, 0.3f, 1, 1}};
    CHECK((source | in::gaussian{.variance = 0}) == clipped);
    CHECK((source | in::speckle{.variance = 0}) == clipped);
    CHECK((source | in::gaussian_speckle{.variance = 0}) == clipped);
    // The input is clipped first, as imnoise does: 2 counts as 1.
    const auto noisy = in::image<float>(64, 64, 2.0f) | in::speckle{.variance = 0.01f, .seed = 4};
    CHECK(std::any_of(noisy.pixels().begin(), noisy.pixels().end(), [](float v) { return v < 0.9f; }));
}

TEST_CASE("Parameters out of range are refused before a pixel changes") {
    const in::image<float> source{{-1, 0.25f, 2}, {0.5f, 0.75f, 1}};
    const auto refuses = [&](const auto& noise) {
        in::image<float> pixels = source;
        CHECK_THROWS_AS(in::apply_in_place(pixels.view(), noise), in::invalid_input);
        CHECK(pixels == source);
    };
    const float inf = std::numeric_limits<float>::infinity();
    for (const float bad : {-0.1f, std::nanf(""), inf}) {
        refuses(in::gaussian{.variance = bad});
        refuses(in::speckle{.variance = bad});
        refuses(in::gaussian_speckle{.variance = bad});
        refuses(in::poisson{.photons = bad});
        refuses(in::gaussian{} | in::speckle{.variance = bad});
    }
    refuses(in::gaussian{.mean = inf});
    refuses(in::poisson{.photons = 0});
    CHECK_THROWS_WITH((source | in::speckle{.variance = -1}),
                      ContainsSubstring("speckle.variance is -1") && ContainsSubstring("at least 0"));
}

TEST_CASE("Noise on ten million pixels: moments after clipping, tails to 4.5 sigma, the law itself", "[.slow]") {
    const in::image<float> half(4096, 2560, 0.5f);
    const auto n = static_cast<double>(half.size());
    for (const std::uint64_t seed : {1u, 2u}) {
        check_moments(half | in::gaussian{.variance = 0.05f, .seed = seed}, 0.50000, 0.04775, 1e-5, 1e-5);
        check_moments(in::image<float>(4096, 2560, 0.25f) | in::gaussian{.variance = 0.05f, .seed = seed}, 0.26478,
                      0.03945, 1e-5, 1e-5);
        check_moments(in::image<float>(4096, 2560, 0.8f) | in::speckle{.variance = 0.1f, .seed = seed}, 0.76763,
                      0.04487, 1e-5, 1e-5);
        const auto normal = half | in::gaussian{.variance = 0.0025f, .seed = seed};
        CHECK(distance_from_law(normal, [](double v) { return normal_cdf((v - 0.5) / 0.05); }) < once_in_1000);
        for (const double sigmas : {2.0, 3.0, 4.0, 4.5}) {
            const double expected = n * normal_cdf(-sigmas);
            double above = 0, below = 0;
            for (const float v : normal.pixels()) {
                above += static_cast<double>(v) > 0.5 + 0.05 * sigmas;
                below += static_cast<double>(v) < 0.5 - 0.05 * sigmas;
            }
            CHECK(std::abs(above - expected) < 4 * std::sqrt(expected) + 1);
            CHECK(std::abs(below - expected) < 4 * std::sqrt(expected) + 1);
        }
    }
}
