// Rayleigh, looks, K and Rician noise against their distributions, in closed form or by their moments.
#include <insonify/filter/echo_noise.hpp>
#include <insonify/filter/noise.hpp>
#include <insonify/filter/pipe.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../../catch.hpp"
#include "../../larger.hpp"
#include "../../moments.hpp"

namespace in = insonify;
using moments::correlation, moments::of, moments::once_in_1000;

namespace {

constexpr int side = 512;
constexpr float level = 0.02f;  // far from saturation

template <class Noise>
in::image<float> noisy(const Noise& noise, float value = level) {
    return in::image<float>(side, side, value) | noise;
}

/// Distance of pixel / level from a law: see moments::kolmogorov_smirnov.
template <class Cumulative>
double distance_of_ratio(const in::image<float>& picture, const Cumulative& law) {
    return moments::kolmogorov_smirnov(picture.pixels(), [&](double v) { return law(v / static_cast<double>(level)); });
}

/// Gamma(looks = 3, mean 1) up to x.
double three_looks(double x) {
    const double t = 3 * x;
    return 1 - std::exp(-t) * (1 + t + t * t / 2);
}

}  // namespace

TEST_CASE("Intensities follow their laws") {
    CHECK(distance_of_ratio(noisy(in::rayleigh{.of = in::echo::intensity, .seed = 1}),
                            [](double x) { return 1 - std::exp(-x); }) < once_in_1000);
    CHECK(distance_of_ratio(noisy(in::gamma_speckle{.looks = 3, .of = in::echo::intensity, .seed = 2}), three_looks) <
          once_in_1000);
    // Chi-square of one degree.
    CHECK(distance_of_ratio(noisy(in::gamma_speckle{.looks = 0.5f, .of = in::echo::intensity, .seed = 3}, level),
                            [](double x) { return std::erf(std::sqrt(x / 2)); }) < once_in_1000);
    // K of shape 1/2: P(I > t) = exp(-sqrt(2 t)), from the integral of exp(-t / tau) over chi-square textures.
    CHECK(distance_of_ratio(
              noisy(in::k_speckle{.shape = 0.5f, .of = in::echo::intensity, .seed = 4}, level / 4) |
                  [](float v) { return 4 * v; },
              [](double x) { return 1 - std::exp(-std::sqrt(2 * x)); }) < once_in_1000);
    CHECK(distance_of_ratio(noisy(in::rician{.steady = 0, .of = in::echo::intensity, .seed = 5}),
                            [](double x) { return 1 - std::exp(-x); }) < once_in_1000);
}

TEST_CASE("Amplitudes follow their laws, with the mean of the image") {
    CHECK(distance_of_ratio(noisy(in::rayleigh{.seed = 1}),
                            [](double x) { return 1 - std::exp(-x * x * in::numeric::pi / 4); }) < once_in_1000);
    const double mean_root = in::detail::mean_root_of_gamma(3);
    CHECK(distance_of_ratio(noisy(in::gamma_speckle{.looks = 3, .seed = 2}),
                            [&](double x) { return three_looks(x * x * mean_root * mean_root); }) < once_in_1000);
    for (const auto& picture : {noisy(in::rayleigh{}), noisy(in::gamma_speckle{}), noisy(in::k_speckle{}),
                                noisy(in::rician{}), noisy(in::rician{.steady = 20})}) {
        const auto m = of(picture);
        CHECK(std::abs(m.mean / static_cast<double>(level) - 1) < 4 * std::sqrt(m.index) / side);
    }
}

TEST_CASE("Scintillation indices are those of the literature") {
    const auto index = [](const auto& noise) { return of(noisy(noise)).index; };
    using enum in::echo;
    CHECK(index(in::rayleigh{.of = intensity}) == Approx(1).epsilon(0.02));
    for (const float looks : {0.5f, 1.0f, 1.3f, 2.2f, 4.0f, 64.0f, 1e4f})
        CHECK(index(in::gamma_speckle{.looks = looks, .of = intensity}) ==
              Approx(1 / static_cast<double>(looks)).epsilon(0.04));
    for (const float shape : {1.0f, 4.0f, 20.0f, 1e6f})
        CHECK(index(in::k_speckle{.shape = shape, .of = intensity}) ==
              Approx(1 + 2 / static_cast<double>(shape)).epsilon(0.06));
    CHECK(index(in::k_speckle{.shape = 6, .looks = 4, .of = intensity}) == Approx(7.0 / 6 * 5 / 4 - 1).epsilon(0.06));
    for (const float steady : {0.0f, 0.5f, 1.0f, 10.0f, 1e4f}) {
        const auto s = static_cast<double>(steady);
        CHECK(index(in::rician{.steady = steady, .of = intensity}) ==
              Approx((1 + 2 * s) / ((1 + s) * (1 + s))).epsilon(0.02));
    }
    CHECK(std::sqrt(index(in::rayleigh{})) == Approx(0.5227).epsilon(0.005));
}

TEST_CASE("Mean amplitudes equal their closed forms, on both sides of the change to a series") {
    using in::detail::mean_of_rice;
    using in::detail::mean_root_of_gamma;
    for (const double shape : {0.01, 0.5, 1.0, 3.3, 19.99, 20.01, 500.0}) {
        const auto wide = static_cast<long double>(shape);
        const long double exact = std::exp(std::lgamma(wide + 0.5L) - std::lgamma(wide)) / std::sqrt(wide);
        CHECK(mean_root_of_gamma(shape) == Approx(static_cast<double>(exact)).epsilon(5e-12));
    }
    CHECK(mean_of_rice(0) == Approx(std::sqrt(in::numeric::pi) / 2).epsilon(1e-14));
    CHECK(mean_of_rice(299.999) == Approx(mean_of_rice(300.001)).epsilon(1e-8));
    CHECK(mean_of_rice(1e6) == Approx(1).epsilon(1e-6));
    for (const double steady : {0.1, 1.0, 20.0, 299.0, 301.0, 1000.0}) {
        // A Poisson number of mean `steady` plus one is the shape of the gamma-distributed intensity.
        double mean = 0;
        for (double n = 0; n < 3000; ++n)
            mean += std::exp(n * std::log(steady) - steady - 2 * std::lgamma(n + 1) + std::lgamma(n + 1.5));
        CHECK(mean_of_rice(steady) == Approx(mean / std::sqrt(1 + steady)).epsilon(1e-6));
    }
}

namespace {

/// The distance along an axis at which the autocorrelation crosses 1 / e: ln r is interpolated over d^2, in which a
/// Gaussian is a straight line.
double length_of(const in::image<float>& picture, int dx, int dy) {
    double last = 0;
    for (int d = 1; d < 40; ++d) {
        const double now = std::log(std::fmax(correlation(picture, picture, d * dx, d * dy), 1e-3));
        if (now <= -1) {
            const double d0 = (d - 1.0) * (d - 1.0), d1 = static_cast<double>(d * d);
            return std::sqrt(d0 + (d1 - d0) * (-1 - last) / (now - last));
        }
        last = now;
    }
    return 40;
}

}  // namespace

TEST_CASE("The intensities of correlated echo noise have the 1/e length of the parameter, for every law") {
    using enum in::echo;
    const float length = GENERATE(1.0f, 1.5f, 2.0f, 4.0f);
    const auto check = [&](const char* law, const auto& noise, double index) {
        const auto picture = noisy(noise);
        INFO(law << ", length " << length);
        CHECK(of(picture).mean == Approx(static_cast<double>(level)).epsilon(0.05));
        CHECK(of(picture).index == Approx(index).epsilon(0.12));
        CHECK(length_of(picture, 1, 0) == Approx(static_cast<double>(length)).epsilon(0.08));
        CHECK(length_of(picture, 0, 1) == Approx(static_cast<double>(length)).epsilon(0.08));
        CHECK(correlation(picture, picture, 0, 16) == Approx(0).margin(0.04));
    };
    const in::correlation_length both{length, length};
    check("Rayleigh", in::rayleigh{.of = intensity, .correlation = both}, 1);
    check("looks", in::gamma_speckle{.looks = 3, .of = intensity, .correlation = both}, 1 / 3.0);
    check("Rician 1", in::rician{.steady = 1, .of = intensity, .correlation = both}, 0.75);
    check("Rician 8", in::rician{.steady = 8, .of = intensity, .correlation = both}, 17 / 81.0);
    check("K 1.5", in::k_speckle{.shape = 1.5f, .of = intensity, .correlation = both}, 1 + 2 / 1.5);
    check("K 4", in::k_speckle{.shape = 4, .of = intensity, .correlation = both}, 1.5);
    check("K 6, 4 looks", in::k_speckle{.shape = 6, .looks = 4, .of = intensity, .correlation = both},
          7.0 / 6 * 5 / 4 - 1);
}

TEST_CASE("Taps give white noise the autocorrelation exp(-(d / length)^2) to 0.003 at every distance") {
    for (const double length : {0.01, 0.3, 0.5, 1.0, 2.0, 10.0, 45.0, 50.0}) {
        const auto half = in::detail::field_taps(length);
        const int reach = static_cast<int>(half.size()) - 1;
        const auto tap = [&](int i) {
            return std::abs(i) <= reach ? static_cast<double>(half[static_cast<std::size_t>(std::abs(i))]) : 0.0;
        };
        double worst = 0;
        for (int d = 0; d <= 2 * reach + 5; ++d) {
            double sum = 0;
            for (int i = -reach; i <= reach; ++i) sum += tap(i) * tap(i + d);
            worst = larger(worst, std::abs(sum - std::exp(-(d / length) * (d / length))));
        }
        INFO("length " << length);
        CHECK(worst < 0.003);
    }
}

TEST_CASE("Below a pixel, adjacent echoes are correlated as the Gaussian of that 1/e length, down to 0.3") {
    using enum in::echo;
    for (const float length : {0.3f, 0.5f, 0.6f, 0.7f, 0.85f}) {
        const double l = static_cast<double>(length);
        const in::correlation_length x{length, 0};
        const auto rayleigh = noisy(in::rayleigh{.of = intensity, .correlation = x});
        CHECK(correlation(rayleigh, rayleigh, 1, 0) == Approx(std::exp(-1 / (l * l))).margin(0.01));
        CHECK(correlation(rayleigh, rayleigh, 0, 1) == Approx(0).margin(0.01));
        // The field's correlation c at the length, from c^2 + 2 s c = (1 + 2 s) / e, is the Gaussian's value there.
        const double s = 3, c = -s + std::sqrt(s * s + (1 + 2 * s) / std::exp(1.0));
        const double field = std::pow(c, 1 / (l * l));
        const auto rician = noisy(in::rician{.steady = 3, .of = intensity, .correlation = x});
        CHECK(correlation(rician, rician, 1, 0) == Approx((field * field + 2 * s * field) / (1 + 2 * s)).margin(0.01));
    }
}

TEST_CASE("Correlated textures have the gamma law's moments and quantiles") {
    for (const double shape : {0.05, 0.5, 1.0, 4.0, 100.0, 1e5}) {
        const in::detail::gamma_texture texture(shape);
        double mean = 0, square = 0, product = 0;
        for (int i = 0; i < 100000; ++i) {
            const double z = -7 + 14e-5 * (i + 0.5),
                         p = 14e-5 * std::exp(-0.5 * z * z) / std::sqrt(2 * in::numeric::pi);
            const auto t = static_cast<double>(texture(static_cast<float>(z)));
            mean += p * t;
            square += p * t * t;
            product += p * t * z;
        }
        INFO("shape " << shape);
        CHECK(mean == Approx(1).epsilon(1e-4));
        CHECK(square - 1 == Approx(1 / shape).epsilon(1e-3));
        CHECK(texture.correlation(1) == Approx(1).epsilon(1e-9));
        CHECK(texture.correlation(1e-4) / 1e-4 == Approx(product * product * shape).epsilon(0.01));
    }
    CHECK(in::detail::gamma_texture(1)(0) == Approx(std::log(2.0)).epsilon(1e-4));  // exponential: the median
}

TEST_CASE("Correlated gaussian noise: its variance, and 1 / e at its length") {
    const auto picture = noisy(in::gaussian{.variance = 0.0025f, .correlation = {4, 0}}, 0.5f);
    CHECK(of(picture).mean == Approx(0.5).epsilon(0.002));
    CHECK(of(picture).index == Approx(0.01).epsilon(0.03));
    CHECK(correlation(picture, picture, 4, 0) == Approx(std::exp(-1)).margin(0.03));
    CHECK(correlation(picture, picture, 0, 1) == Approx(0).margin(0.01));
    const auto grain = noisy(in::gaussian_speckle{.variance = 0.01f, .correlation = {2, 4}}, 0.5f);
    CHECK(of(grain).index == Approx(0.01).epsilon(0.03));
    CHECK(correlation(grain, grain, 0, 4) == Approx(std::exp(-1)).margin(0.04));
}

TEMPLATE_TEST_CASE("Echo noise is independent between pixels, frames, seeds and filters", "", in::rayleigh,
                   in::gamma_speckle, in::k_speckle, in::rician) {
    const auto base = noisy(TestType{.seed = 1});
    const double bound = 4.5 / side;
    CHECK(std::abs(correlation(base, base, 1, 0)) < bound);
    CHECK(std::abs(correlation(base, base, 0, 1)) < bound);
    CHECK(std::abs(correlation(base, base, 4, 0)) < bound);
    CHECK(std::abs(correlation(base, noisy(TestType{.seed = 2}))) < bound);
    CHECK(std::abs(correlation(base, noisy(TestType{.seed = 1, .frame = 1}))) < bound);
    if constexpr (!std::same_as<TestType, in::gamma_speckle>)
        CHECK(std::abs(correlation(base, noisy(in::gamma_speckle{.seed = 1}))) < bound);
    CHECK(noisy(TestType{.seed = 1}) == base);
}

TEST_CASE("The shape of echo noise may differ by pixel and by type of seabed") {
    in::image<std::uint8_t> types(side, side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) types(x, y) = x < side / 2 ? 0 : 1;
    const auto picture = noisy(in::gamma_speckle{.looks = {types, {1, 16}}, .of = in::echo::intensity});
    const auto half = [&](int x) { return of(in::image<float>(picture.view().part(x, 0, side / 2, side))).index; };
    CHECK(half(0) == Approx(1).epsilon(0.04));
    CHECK(half(side / 2) == Approx(1.0 / 16).epsilon(0.04));
    // A map of the same numbers gives the same noise.
    const auto looks = types | [](std::uint8_t t) { return t == 0 ? 1.0f : 16.0f; };
    CHECK(noisy(in::gamma_speckle{.looks = looks.view(), .of = in::echo::intensity}) == picture);
}

TEST_CASE("Shapes of echo noise out of range are refused") {
    const in::image<float> source(4, 4, 0.1f);
    for (const float bad : {0.0f, -1.0f, std::nanf(""), std::numeric_limits<float>::infinity(), 2e6f}) {
        CHECK_THROWS_AS((source | in::gamma_speckle{.looks = bad}), in::invalid_input);
        CHECK_THROWS_AS((source | in::k_speckle{.shape = bad}), in::invalid_input);
        CHECK_THROWS_AS((source | in::k_speckle{.looks = bad}), in::invalid_input);
        if (bad != 0) CHECK_THROWS_AS((source | in::rician{.steady = bad}), in::invalid_input);
    }
    CHECK_THROWS_AS((source | in::gamma_speckle{.looks = 1.5f, .correlation = {1, 1}}), in::invalid_input);
    CHECK_THROWS_AS((source | in::rayleigh{.correlation = {17, 0}}), in::invalid_input);
    CHECK_THROWS_AS((source | in::rayleigh{.correlation = {0, -1}}), in::invalid_input);
    const in::image<float> map(3, 4, 1.0f);
    CHECK_THROWS_WITH((source | in::k_speckle{.shape = map.view()}), ContainsSubstring("map for k_speckle.shape is 3"));
}

TEST_CASE("Extreme shapes give finite pixels") {
    for (const float shape : {0.01f, 1e6f}) {
        for (const auto& picture : {noisy(in::gamma_speckle{.looks = shape}), noisy(in::k_speckle{.shape = shape}),
                                    noisy(in::rician{.steady = shape})}) {
            CHECK(std::all_of(picture.pixels().begin(), picture.pixels().end(),
                              [](float v) { return v >= 0 && v <= 1; }));
        }
    }
    CHECK(std::isnan((in::image<float>{{std::nanf("")}} | in::k_speckle{})(0, 0)));
    CHECK((in::image<float>{{0, -3}} | in::rayleigh{}) == in::image<float>{{0, 0}});
}
