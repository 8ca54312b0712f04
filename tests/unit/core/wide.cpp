// The arithmetic behind exact geometry: 128-bit integers, numbers of twice a double's precision, products of vectors.
#include <insonify/core/detail/double_double.hpp>
#include <insonify/core/linear.hpp>
#include <insonify/core/random.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>

#include <glm/geometric.hpp>

#include "../../catch.hpp"
#include "../../larger.hpp"

namespace in = insonify;
using in::detail::double_double;
using in::detail::int128;

namespace {

__extension__ using wide = __int128;
__extension__ using wide_float = __float128;

wide value(const int128& v) {
    return static_cast<wide>(v.high) * (static_cast<wide>(1) << 64) + static_cast<wide>(v.low);
}
wide_float value(const double_double& v) {
    return static_cast<wide_float>(v.high) + static_cast<wide_float>(v.low);
}

/// Integers of all sizes up to 2^62, and the ends of their range.
struct any_integer {
    in::random_sequence random{1};
    std::int64_t operator()() {
        const std::uint64_t high = random.word(), bits = high << 32 | random.word();
        const auto shifted = static_cast<std::int64_t>(bits) >> (1 + random.below(63));
        return random.below(50) == 0 ? (shifted < 0 ? -(std::int64_t{1} << 62) : std::int64_t{1} << 62) : shifted;
    }
};

}  // namespace

TEST_CASE("128-bit integers equal the compiler's __int128") {
    any_integer any;
    for (int n = 0; n < 100000; ++n) {
        const std::int64_t a = any(), b = any(), c = any(), d = any();
        const wide expected = static_cast<wide>(a) * b - static_cast<wide>(c) * d;
        const int128 got = int128::product(a, b) - int128::product(c, d);
        const int bits = 1 + static_cast<int>(any.random.below(63));
        const wide shifted = expected >> bits;
        constexpr wide top = (std::numeric_limits<std::int64_t>::max)(),
                       bottom = (std::numeric_limits<std::int64_t>::min)();
        const bool same = value(got) == expected && value(-got) == -expected && value(int128::from(a)) == a &&
                          value(int128::product(a, (std::numeric_limits<std::int64_t>::min)())) == a * bottom &&
                          value(int128::product((std::numeric_limits<std::int64_t>::max)(), -a)) == -a * top &&
                          got.sign() == (expected > 0) - (expected < 0) &&
                          got.shifted_down(bits) == (shifted > top      ? top
                                                     : shifted < bottom ? bottom
                                                                        : shifted);
        INFO(a << " * " << b << " - " << c << " * " << d << ", shifted by " << bits);
        if (!same) FAIL("differs");
    }
}

TEST_CASE("Double-doubles keep 103 bits") {
    any_integer any;
    double worst = 0;
    for (int n = 0; n < 100000; ++n) {
        const int128 numerator = int128::product(any(), any()), denominator = int128::product(any(), 1 + (any() >> 40));
        if (denominator.sign() == 0) continue;
        const double factor = any.random.uniform(-1, 1);
        const double_double quotient =
            (double_double::from(numerator) * factor + double_double{factor, 0}) / double_double::from(denominator);
        const wide_float expected = (static_cast<wide_float>(value(numerator)) * static_cast<wide_float>(factor) +
                                     static_cast<wide_float>(factor)) /
                                    static_cast<wide_float>(value(denominator));
        if (expected == 0) continue;
        worst = larger(worst, std::abs(static_cast<double>((value(quotient) - expected) / expected)));
        if (quotient.to_float() != static_cast<float>(expected)) FAIL("rounds differently");
    }
    CHECK(worst < 0x1p-103);
}

TEST_CASE("Sums of double-doubles that cancel keep all bits") {
    in::random_sequence random(7);
    double worst = 0;
    for (int n = 0; n < 10000; ++n) {
        const double high = random.uniform(1, 2), close_by = high * (1 + random.below(8) * 0x1p-52);
        const double_double a = double_double::sum(high, high * 0x1p-54 * random.uniform(-1, 1)),
                            b = double_double::sum(-close_by, close_by * 0x1p-54 * random.uniform(-1, 1));
        // In this order without rounding.
        const wide_float expected = (static_cast<wide_float>(a.high) + static_cast<wide_float>(b.high)) +
                                    (static_cast<wide_float>(a.low) + static_cast<wide_float>(b.low));
        if (expected == 0) continue;
        worst = larger(worst, std::abs(static_cast<double>((value(a + b) - expected) / expected)));
    }
    CHECK(worst < 0x1p-100);
}

TEST_CASE("A double-double rounds to float once, from both halves") {
    // 1 + 2^-24 is the middle between two floats; a double alone would round to even.
    const double middle = 1 + 0x1p-24;
    CHECK(double_double{middle, 0}.to_float() == 1.0f);
    CHECK(double_double{middle, 0x1p-60}.to_float() == 1.0f + 0x1p-23f);
    CHECK(double_double{middle, -0x1p-60}.to_float() == 1.0f);
    const double odd_middle = 1 + 0x1p-23 + 0x1p-24;
    CHECK(double_double{odd_middle, 0}.to_float() == 1.0f + 0x1p-22f);
    CHECK(double_double{odd_middle, -0x1p-60}.to_float() == 1.0f + 0x1p-23f);
    CHECK(double_double{-middle, -0x1p-60}.to_float() == -1.0f - 0x1p-23f);
}

TEST_CASE("The dominant axis has the component of largest magnitude, the first of equal ones") {
    for (int x = -2; x <= 2; ++x)
        for (int y = -2; y <= 2; ++y)
            for (int z = -2; z <= 2; ++z) {
                const int size[] = {std::abs(x), std::abs(y), std::abs(z)};
                const auto first = std::max_element(std::begin(size), std::end(size)) - std::begin(size);
                CHECK(in::numeric::dominant_axis(glm::dvec3(x, y, z)) == first);
            }
}

TEST_CASE("Products of vectors and matrices equal GLM's within rounding") {
    const glm::dmat3 m(2, 0.5, -1, 3, 1, 4, -2, 7, 0.25);
    const glm::dvec3 a(1, -2, 3), b(0.5, 4, -1);
    CHECK(in::numeric::dot(a, b) == -10.5);
    CHECK(in::numeric::cross(a, b) == glm::dvec3(-10, 2.5, 5));
    CHECK(in::numeric::product(m, a) == glm::dvec3(-10, 19.5, -8.25));
    CHECK(in::numeric::product(m, glm::dmat3(1)) == m);
    CHECK(in::numeric::product(m, in::numeric::product(m, a)) == in::numeric::product(in::numeric::product(m, m), a));
    CHECK(in::numeric::determinant(m) == -82.875);
    const glm::dmat3 cofactors = in::numeric::cofactors(m);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) CHECK(in::numeric::dot(m[i], cofactors[j]) == (i == j ? -82.875 : 0));

    // GLM's may be compiled with fused multiply-add, which skips the rounding of terms; they are below 1 here.
    in::random_sequence random(1);
    const auto vector = [&] { return glm::dvec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}; };
    const auto difference = [](const glm::dvec3& u, const glm::dvec3& v) {
        return (std::max)({std::abs(u.x - v.x), std::abs(u.y - v.y), std::abs(u.z - v.z)});
    };
    double worst = 0;
    for (int n = 0; n < 10000; ++n) {
        const glm::dvec3 u = vector(), v = vector();
        const glm::dmat3 left(vector(), vector(), vector()), right(vector(), vector(), vector());
        const glm::dmat3 both = in::numeric::product(left, right), expected = left * right;
        worst = (std::max)({worst, std::abs(in::numeric::dot(u, v) - glm::dot(u, v)),
                            difference(in::numeric::cross(u, v), glm::cross(u, v)),
                            difference(in::numeric::product(left, u), left * u), difference(both[0], expected[0]),
                            difference(both[1], expected[1]), difference(both[2], expected[2])});
    }
    CHECK(worst <= 0x1p-51);
}
