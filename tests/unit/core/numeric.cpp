// Bit-stable mathematics against the C library's long double functions, which have eleven more bits.
#include <insonify/core/numeric.hpp>
#include <insonify/core/random.hpp>

#include <cmath>
#include <limits>

#include "../../catch.hpp"
#include "../../larger.hpp"

namespace in = insonify;
namespace numeric = insonify::numeric;
using namespace insonify::literals;

// Rounds a pair of doubles to floats and back, with external linkage so that compilers see no more than a pair.
struct pair_of_doubles {
    double first, second;
};
[[gnu::noinline]] void round_to_float(const pair_of_doubles& from, pair_of_doubles& to) {
    const auto first = static_cast<float>(from.first), second = static_cast<float>(from.second);
    to.first = numeric::widened(first);
    to.second = numeric::widened(second);
}

namespace {

using limits = std::numeric_limits<double>;
constexpr double infinity = limits::infinity();
const double quiet_nan = limits::quiet_NaN();
constexpr int draw_count = 200000;

// Expected values are computed in long double.
constexpr long double wide(double x) {
    return static_cast<long double>(x);
}

double difference(double value, long double expected) {
    return static_cast<double>(std::fabs(wide(value) - expected));
}

// In units of the last place of a double at the expected value; below the normal range, of the smallest subnormal.
double ulps(double value, long double expected) {
    if (std::fabs(expected) > wide((limits::max)())) return std::isinf(value) ? 0 : infinity;
    const double magnitude = (std::max)(static_cast<double>(std::fabs(expected)), (limits::min)());
    const double unit = std::ldexp(1.0, std::ilogb(magnitude) - 52);
    return static_cast<double>(std::fabs(wide(value) - expected)) / unit;
}

// The largest error over draws of x from (low, high).
template <class Error>
double worst(double low, double high, Error&& error) {
    in::random_sequence random(2021);
    double largest = 0;
    for (int i = 0; i < draw_count; ++i) largest = larger(largest, error(random.uniform(low, high)));
    return largest;
}

}  // namespace

TEST_CASE("log() is accurate to 1 ulp over all magnitudes, also next to 1") {
    const auto error = [](double x) { return ulps(numeric::log(x), std::log(wide(x))); };
    CHECK(worst(0.5, 2, error) <= 1);
    CHECK(worst(1 - 1e-6, 1 + 1e-6, error) <= 1);
    CHECK(worst(0, 1, error) <= 1);
    CHECK(worst(-1074, 1023.9, [&](double exponent) { return error(std::exp2(exponent)); }) <= 1);
}

TEST_CASE("log() of 0, negative numbers, infinity and NaN follows the C library") {
    CHECK(numeric::log(1) == 0);
    CHECK(numeric::log(0) == -infinity);
    CHECK(numeric::log(-0.0) == -infinity);
    CHECK(numeric::log(infinity) == infinity);
    CHECK(std::isnan(numeric::log(-1)));
    CHECK(std::isnan(numeric::log(-infinity)));
    CHECK(std::isnan(numeric::log(quiet_nan)));
    CHECK(numeric::log(limits::denorm_min()) == Approx(-744.4400719213812));
}

TEST_CASE("exp() is accurate to 2 ulp and underflows gradually") {
    const auto error = [](double x) { return ulps(numeric::exp(x), std::exp(wide(x))); };
    CHECK(worst(-1, 1, error) <= 2);
    CHECK(worst(-745, 709.7, error) <= 2);
    CHECK(worst(709.7, 709.8, error) <= 2);
    CHECK(worst(-745.2, -708, error) <= 2);
    CHECK(numeric::exp(0) == 1);
    CHECK(numeric::exp(infinity) == infinity);
    CHECK(numeric::exp(-infinity) == 0);
    CHECK(numeric::exp(1e300) == infinity);
    CHECK(numeric::exp(-1e300) == 0);
    CHECK(std::isnan(numeric::exp(quiet_nan)));
}

TEST_CASE("sin_cos_turns() is accurate to 2e-16, exact at quarter turns, and periodic for large arguments") {
    const auto error = [](double x) {
        const long double angle = 2 * std::acos(-1.0L) * (wide(x) - wide(std::floor(x)));
        const auto [sine, cosine] = numeric::sin_cos_turns(x);
        return larger(difference(sine, std::sin(angle)), difference(cosine, std::cos(angle)));
    };
    CHECK(worst(-1, 1, error) < 2e-16);
    CHECK(worst(-1e-3, 1e-3, error) < 2e-16);
    CHECK(worst(-1e6, 1e6, error) < 2e-16);
    CHECK(worst(-0x1p50, 0x1p50, error) < 2e-16);
    for (int quarter = -8; quarter <= 8; ++quarter) {
        const auto [sine, cosine] = numeric::sin_cos_turns(0.25 * quarter);
        const int phase = ((quarter % 4) + 4) % 4;
        CHECK(sine == (phase == 1 ? 1 : phase == 3 ? -1 : 0));
        CHECK(cosine == (phase == 0 ? 1 : phase == 2 ? -1 : 0));
    }
}

TEST_CASE("Sine, cosine and tangent of radians agree with the C library over several turns") {
    const auto error = [](double x) {
        const auto [sine, cosine] = numeric::sin_cos(x);
        const double largest = larger(difference(sine, std::sin(wide(x))), difference(cosine, std::cos(wide(x))));
        return largest / ((std::fabs(x) + 1) * 2e-16);
    };
    CHECK(worst(-1, 1, error) < 1);
    CHECK(worst(-1000, 1000, error) < 1);
    CHECK(worst(-1.5, 1.5, [](double x) { return std::fabs(numeric::tan(x) / std::tan(x) - 1); }) < 1e-14);
}

TEST_CASE("atan2() is accurate to 1e-15 in all quadrants and exact on the axes") {
    in::random_sequence random(5);
    double largest = 0;
    for (int i = 0; i < draw_count; ++i) {
        const double scale = std::exp2(random.uniform(-300, 300)), slope = std::exp2(random.uniform(-8, 8));
        const double y = scale * slope * random.uniform(-1, 1), x = scale * random.uniform(-1, 1);
        const long double expected = std::atan2(wide(y), wide(x));
        largest = larger(largest, difference(numeric::atan2(y, x), expected));
    }
    CHECK(largest < 1e-15);

    CHECK(numeric::atan2(0, 0) == 0);
    CHECK(numeric::atan2(0, 2) == 0);
    CHECK(numeric::atan2(0, -2) == numeric::pi);
    CHECK(numeric::atan2(3, 0) == numeric::pi / 2);
    CHECK(numeric::atan2(-3, 0) == -numeric::pi / 2);
    CHECK(numeric::atan2(1, 1) == numeric::pi / 4);
    CHECK(numeric::atan2(1, infinity) == 0);
    CHECK(numeric::atan2(1, -infinity) == numeric::pi);
    CHECK(std::isnan(numeric::atan2(quiet_nan, 1)));
    CHECK(std::isnan(numeric::atan2(1, quiet_nan)));
    CHECK(std::isnan(numeric::atan2(infinity, -infinity)));
    CHECK(std::isnan(numeric::atan2(0, quiet_nan)));
    CHECK(std::isnan(numeric::atan2(quiet_nan, 0)));
}

TEST_CASE("pow() is accurate to the error of the logarithm, and exact at 0 and 1") {
    in::random_sequence random(6);
    double largest = 0;
    for (int i = 0; i < draw_count; ++i) {
        const double x = std::exp2(random.uniform(-20, 20)), y = random.uniform(-20, 20);
        const long double exact = std::pow(wide(x), wide(y));
        const double bound = (std::fabs(y * std::log(x)) + 2) * 3e-16;
        largest = larger(largest, static_cast<double>(std::fabs(wide(numeric::pow(x, y)) / exact - 1)) / bound);
    }
    CHECK(largest < 1);

    CHECK(numeric::pow(0, 0) == 1);
    CHECK(numeric::pow(quiet_nan, 0) == 1);
    CHECK(numeric::pow(0, 3) == 0);
    CHECK(numeric::pow(0, -3) == infinity);
    CHECK(numeric::pow(1, 1e10) == 1);
    CHECK(std::isnan(numeric::pow(quiet_nan, 1)));
    CHECK(std::isnan(numeric::pow(0, quiet_nan)));
}

TEST_CASE("saturate() clamps to [0, 1] and keeps NaN") {
    for (const float inside : {0.0f, 0.25f, 1.0f}) CHECK(numeric::saturate(inside) == inside);
    CHECK(numeric::saturate(-0.5f) == 0);
    CHECK(numeric::saturate(1.5f) == 1);
    CHECK(numeric::saturate(-std::numeric_limits<float>::infinity()) == 0);
    CHECK(numeric::saturate(std::numeric_limits<float>::infinity()) == 1);
    CHECK(std::isnan(numeric::saturate(std::numeric_limits<float>::quiet_NaN())));
}

TEST_CASE("normal_quantile() inverts the normal distribution to 4.5e-4") {
    const auto error = [](double p) {
        // The quantile's derivative is one over the density: to first order, which takes the bounds below to 4.6e-4.
        const double x = numeric::normal_quantile(p), excess = 0.5 * std::erfc(-x / std::sqrt(2.0)) - p;
        return std::fabs(excess) * std::sqrt(2 * numeric::pi) * std::exp(0.5 * x * x);
    };
    CHECK(worst(0, 1, error) < 4.6e-4);
    CHECK(worst(-200, -1, [&](double exponent) { return error(std::exp2(exponent / 10)); }) < 4.6e-4);
}

TEST_CASE("rounded_to_eight_bits() rounds to the nearest number of eight significant bits") {
    CHECK(numeric::rounded_to_eight_bits(1) == 1);
    CHECK(numeric::rounded_to_eight_bits(255) == 255);
    CHECK(numeric::rounded_to_eight_bits(257.5) == 258);
    CHECK(numeric::rounded_to_eight_bits(0.1) == 205.0 / 2048);
    CHECK(worst(-100, 100, [](double exponent) {
              const double x = std::exp2(exponent), rounded = numeric::rounded_to_eight_bits(x);
              const double unit = std::ldexp(1.0, std::ilogb(x) - 7);
              return rounded / unit == std::floor(rounded / unit) ? std::fabs(rounded - x) / unit : infinity;
          }) <= 0.5);
}

TEST_CASE("Square roots are correctly rounded") {
    CHECK(numeric::square_root(2.0) == 0x1.6a09e667f3bcdp+0);
    CHECK(numeric::square_root(2.0f) == 0x1.6a09e6p+0f);
    CHECK(worst(0, 1e6, [](double x) { return ulps(numeric::square_root(x), std::sqrt(wide(x))); }) <= 0.5);
}

TEST_CASE("Floors round towards minus infinity") {
    STATIC_REQUIRE(numeric::floor_to_int(2.9) == 2);
    STATIC_REQUIRE(numeric::floor_to_int(-2.1) == -3);
    STATIC_REQUIRE(numeric::floor_to_int(-2.0) == -2);
    STATIC_REQUIRE(numeric::floor_to_int(-0.0) == 0);
    CHECK(worst(-1e12, 1e12, [](double x) {
              return std::fabs(static_cast<double>(numeric::floor_to_int(x)) - std::floor(x));
          }) == 0);
}

TEMPLATE_TEST_CASE("is_finite() is false for infinity and NaN alone", "", float, double) {
    using own = std::numeric_limits<TestType>;
    for (const TestType value : {TestType(0), -TestType(0), own::denorm_min(), (own::max)(), own::lowest()})
        CHECK(numeric::is_finite(value));
    for (const TestType value : {own::infinity(), -own::infinity(), own::quiet_NaN(), own::signaling_NaN()})
        CHECK(!numeric::is_finite(value));
}

TEST_CASE("widened() keeps the rounding of a pair of doubles to floats, which g++ 12 otherwise drops") {
    pair_of_doubles pair{};
    round_to_float({0.1, 0.7}, pair);
    CHECK(pair.first == 0x1.99999ap-4);
    CHECK(pair.second == 0x1.666666p-1);
}

TEST_CASE("Degrees are written as literals and stored as radians") {
    STATIC_REQUIRE(180_deg == static_cast<float>(numeric::pi));
    STATIC_REQUIRE(22.5_deg == static_cast<float>(numeric::pi / 8));
    CHECK(6_deg == Approx(0.10472).epsilon(1e-5));
    CHECK(numeric::to_degrees(numeric::to_radians(37)) == Approx(37));
}
