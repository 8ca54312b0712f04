// Each field of the filters is refused by name where its value is out of range.
#include "../../refusals.hpp"

#include <insonify/core/image.hpp>
#include <insonify/filter/colormap.hpp>
#include <insonify/filter/echo_noise.hpp>
#include <insonify/filter/gray.hpp>
#include <insonify/filter/match.hpp>
#include <insonify/filter/noise.hpp>
#include <insonify/filter/pipe.hpp>
#include <insonify/filter/poisson.hpp>
#include <insonify/filter/where.hpp>

namespace in = insonify;
using namespace refusals;

namespace {

const in::image<float> gray{{0.1f, 0.2f, 0.3f}, {0.4f, 0.5f, 0.6f}};

const auto use = [](const auto& filter) { (void)(gray | filter); };

/// `FIELD` for a parameter, set to one number for all pixels.
#define PARAMETER(member, ...)                                                            \
    {                                                                                     \
#member, [](auto& o, double v) { o.member = static_cast<float>(v); }, __VA_ARGS__ \
    }

}  // namespace

TEST_CASE("Noise refuses each field by name") {
    static_assert(members<in::gaussian>() == 5 && members<in::speckle>() == 3 && members<in::salt_and_pepper>() == 3);
    static_assert(members<in::gaussian_speckle>() == 4 && members<in::correlation_length>() == 2);
    check_fields<in::gaussian>(
        "gaussian.", {}, use,
        {FIELD(mean, not_finite),
         PARAMETER(variance, below_0),
         {"correlation", [](auto& o, double v) { o.correlation.x = static_cast<float>(v); }, outside(0, 16)},
         {"correlation", [](auto& o, double v) { o.correlation.y = static_cast<float>(v); }, outside(0, 16)}});
    check_fields<in::speckle>("speckle.", {}, use, {PARAMETER(variance, below_0)});
    check_fields<in::gaussian_speckle>(
        "gaussian_speckle.", {}, use,
        {PARAMETER(variance, below_0),
         {"correlation", [](auto& o, double v) { o.correlation.x = static_cast<float>(v); }, outside(0, 16)},
         {"correlation", [](auto& o, double v) { o.correlation.y = static_cast<float>(v); }, outside(0, 16)}});
    check_fields<in::salt_and_pepper>("salt_and_pepper.", {}, use, {PARAMETER(density, outside(0, 1))});
}

TEST_CASE("Photon noise refuses each field by name") {
    check_fields<in::poisson>("poisson.", {}, use, {FIELD(photons, outside(0, 1e9))});
}

TEST_CASE("Echo noise refuses each field by name") {
    static_assert(members<in::rayleigh>() == 4 && members<in::gamma_speckle>() == 5);
    static_assert(members<in::k_speckle>() == 6 && members<in::rician>() == 5);
    check_fields<in::rayleigh>(
        "rayleigh.", {}, use,
        {{"correlation", [](auto& o, double v) { o.correlation.x = static_cast<float>(v); }, outside(0, 16)}});
    check_fields<in::gamma_speckle>(
        "gamma_speckle.", {}, use,
        {PARAMETER(looks, outside(0.01, 1e6)),
         {"correlation", [](auto& o, double v) { o.correlation.y = static_cast<float>(v); }, outside(0, 16)}});
    check_fields<in::k_speckle>(
        "k_speckle.", {}, use,
        {PARAMETER(shape, outside(0.01, 1e6)),
         FIELD(looks, outside(0.01, 1e6)),
         {"correlation", [](auto& o, double v) { o.correlation.x = static_cast<float>(v); }, outside(0, 16)}});
    check_fields<in::rician>(
        "rician.", {}, use,
        {PARAMETER(steady, outside(0, 1e6)),
         {"correlation", [](auto& o, double v) { o.correlation.x = static_cast<float>(v); }, outside(0, 16)}});
    const auto check_echo = [](auto filter, const std::string& name) {
        filter.of = static_cast<in::echo>(2);
        CHECK_THROWS_WITH(use(filter), ContainsSubstring(name + ".of is 2, expected amplitude or intensity"));
    };
    check_echo(in::rayleigh{}, "rayleigh");
    check_echo(in::gamma_speckle{}, "gamma_speckle");
    check_echo(in::k_speckle{}, "k_speckle");
    check_echo(in::rician{}, "rician");
}

TEST_CASE("A parameter by pixel or by type is refused for a single value out of range") {
    const in::image<float> good(3, 2, 0.1f);
    const in::image<std::uint8_t> types(3, 2, 1);
    for (const double value : below_0) {
        in::image<float> bad = good;
        bad(2, 1) = static_cast<float>(value);
        CHECK_THAT(refusal([&] { use(in::gaussian{.variance = bad.view()}); }), ContainsSubstring("gaussian.variance"));
        CHECK_THAT(refusal([&] {
                       use(in::gaussian{.variance = {types.view(), {0.1f, static_cast<float>(value)}}});
                   }),
                   ContainsSubstring("gaussian.variance"));
    }
    const in::image<float> narrow(2, 2, 0.1f);
    CHECK_THAT(refusal([&] { use(in::gaussian{.variance = narrow.view()}); }), ContainsSubstring("gaussian.variance"));
    const in::image<std::uint8_t> mask(2, 2);
    for (const std::string& said : {refusal([&] { use(in::where(mask.view(), in::equalize{})); }),
                                    refusal([&] { use(in::where(mask.view(), in::gaussian{})); })})
        CHECK(said == "width of the mask is 2, expected 3, that of the image");
}

TEST_CASE("Gray, levels and references are refused by name") {
    static_assert(members<in::gray_weights>() == 3 && members<in::equalize>() == 1);
    const in::image<in::rgb<float>> color(2, 2);
    const std::vector<double> bad = outside(0, 1);
    check_fields<in::gray_weights>("", in::matlab_weights,
                                   [&](const in::gray_weights& w) { (void)(color | in::to_gray{w}); },
                                   {{"to_gray.weights", [](auto& o, double v) { o.r = v; }, bad},
                                    {"to_gray.weights", [](auto& o, double v) { o.g = v; }, bad},
                                    {"to_gray.weights", [](auto& o, double v) { o.b = v; }, bad}});
    check_fields<in::equalize>("equalize.", {}, use, {FIELD(levels, outside_whole(2, 65536))});
    in::image<float> all_nan(2, 2, static_cast<float>(nan_value));
    CHECK_THAT(refusal([&] { use(in::match_histogram(all_nan)); }), ContainsSubstring("reference"));
    CHECK_THAT(refusal([&] { use(in::match_binned(all_nan)); }), ContainsSubstring("reference"));
    CHECK_THAT(refusal([&] { use(in::match_histogram(in::image<float>())); }), ContainsSubstring("reference"));
    const auto match = [](const in::distribution& reference) {
        return refusal([&] { use(in::match_histogram(reference)); });
    };
    CHECK(match({{0, 1}, {5, 9}}).empty());
    CHECK_THAT(match({{0, 1}, {9}}), ContainsSubstring("reference.values.size()"));
    for (const float second : {0.0f, -1.0f, static_cast<float>(infinity), static_cast<float>(nan_value)})
        CHECK_THAT(match({{0, second}, {5, 9}}), ContainsSubstring("reference.values "));
    CHECK_THAT(match({{0, 1}, {5, 5}}), ContainsSubstring("reference.cumulative "));
    CHECK_THAT(match({{0, 1}, {0, 5}}), ContainsSubstring("reference.cumulative "));
    for (const int bins : {-1, 0, 1, 65537})
        CHECK_THAT(refusal([&] { use(in::match_binned(gray, bins)); }), ContainsSubstring("bins"));
}
