// Random numbers: Random123's known answers, and the documented distributions.
#include <insonify/core/random.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "../../catch.hpp"
#include "../../moments.hpp"

namespace in = insonify;
using moments::kolmogorov_smirnov, moments::once_in_100000;

namespace {

constexpr std::size_t draws = 1 << 16;

double moment(const std::vector<double>& samples, int power) {
    double sum = 0;
    for (const double x : samples) sum += std::pow(x, power);
    return sum / static_cast<double>(samples.size());
}

}  // namespace

TEST_CASE("Philox gives the known answers of Random123") {
    // kat_vectors of Random123 1.14, philox4x32 with 10 rounds.
    STATIC_REQUIRE(in::philox4x32({0, 0, 0, 0}, {0, 0}) ==
                   in::philox_counter{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
    const std::uint32_t ones = 0xffffffff;
    CHECK(in::philox4x32({ones, ones, ones, ones}, {ones, ones}) ==
          in::philox_counter{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
    CHECK(in::philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
          in::philox_counter{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("Neighbouring seeds and streams have keys that share no word") {
    std::set<std::uint32_t> first, second;
    for (std::uint64_t seed = 0; seed < 64; ++seed)
        for (std::uint32_t stream = 0; stream < 16; ++stream) {
            const auto key = in::stream_key(seed, stream);
            first.insert(key[0]);
            second.insert(key[1]);
        }
    CHECK(first.size() == 64 * 16);
    CHECK(second.size() == 64 * 16);
    CHECK(in::stream_key(1, 0) != in::stream_key(std::uint64_t{1} << 32, 0));
}

TEST_CASE("Uniform numbers stay inside (0, 1), lie symmetrically and use the last bit") {
    STATIC_REQUIRE(in::uniform_open(0) == 0x1p-33);
    STATIC_REQUIRE(in::uniform_open(0xffffffff) == 1 - 0x1p-33);
    STATIC_REQUIRE(in::uniform_open(0x7fffffff) + in::uniform_open(0x80000000) == 1);
    STATIC_REQUIRE(in::uniform_open(1) > in::uniform_open(0));
}

TEST_CASE("Uniform draws are uniform, and those of different seeds, streams and items are uncorrelated") {
    in::random_sequence one(7), seed(8), stream(7, 1), item(7, 0, 1);
    std::vector<double> samples;
    double with_seed = 0, with_stream = 0, with_item = 0, with_next = 0, last = 0;
    for (std::size_t i = 0; i < draws; ++i) {
        const double x = one.uniform() - 0.5;
        with_seed += x * (seed.uniform() - 0.5);
        with_stream += x * (stream.uniform() - 0.5);
        with_item += x * (item.uniform() - 0.5);
        with_next += x * last;
        samples.push_back((last = x) + 0.5);
    }
    CHECK(kolmogorov_smirnov(std::span(samples), [](double x) { return x; }) < once_in_100000);
    // A sum of n products of variance 1/144 has the deviation sqrt(n) / 12; five deviations do not occur.
    const double bound = 5 * std::sqrt(static_cast<double>(draws)) / 12;
    CHECK(std::abs(with_seed) < bound);
    CHECK(std::abs(with_stream) < bound);
    CHECK(std::abs(with_item) < bound);
    CHECK(std::abs(with_next) < bound);
}

TEST_CASE("Normal draws have the moments and the distribution of the standard normal, in both of a pair") {
    std::vector<double> first, second;
    double products = 0;
    for (std::uint32_t i = 0; i < draws; ++i) {
        const auto words = in::philox4x32({i, 0, 0, 0}, in::stream_key(3, 5));
        const auto [a, b] = in::normal_pair(words[0], words[1]);
        first.push_back(a);
        second.push_back(b);
        products += a * b;
    }
    const double n = static_cast<double>(draws);
    CHECK(std::abs(products) < 5 * std::sqrt(n));
    for (const auto& samples : {first, second}) {
        // The mean of x^k deviates by sqrt((E x^2k - (E x^k)^2) / n): 1, 2, 15 and 96 are those differences.
        CHECK(std::abs(moment(samples, 1)) < 5 * std::sqrt(1 / n));
        CHECK(std::abs(moment(samples, 2) - 1) < 5 * std::sqrt(2 / n));
        CHECK(std::abs(moment(samples, 3)) < 5 * std::sqrt(15 / n));
        CHECK(std::abs(moment(samples, 4) - 3) < 5 * std::sqrt(96 / n));
        CHECK(kolmogorov_smirnov(std::span(samples), [](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }) <
              once_in_100000);
    }
}

TEST_CASE("The normal tails reach 6.76 sigma and stay finite") {
    const auto far_out = in::normal_pair(0, 0);
    CHECK(far_out[0] == Approx(std::sqrt(2 * 33 * std::log(2.0))).epsilon(1e-12));
    CHECK(far_out[0] == Approx(6.76).epsilon(0.001));
    for (const std::uint32_t angle : {0u, 0x40000000u, 0x80000000u, 0xffffffffu})
        for (const double draw : in::normal_pair(0xffffffff, angle)) CHECK(std::isfinite(draw));
}

TEST_CASE("A sequence is a function of seed, stream and item, and draws words in Philox's order") {
    in::random_sequence sequence(11, 2, (std::uint64_t{9} << 32) + 4);
    for (std::uint32_t block = 0; block < 3; ++block)
        for (const std::uint32_t word : in::philox4x32({4, 9, block, 0}, in::stream_key(11, 2)))
            CHECK(sequence.word() == word);
}

TEST_CASE("Draws from a range stay inside it and reach all of it evenly") {
    in::random_sequence sequence(1);
    std::vector<int> faces(6, 0);
    for (int i = 0; i < 6000; ++i) ++faces[sequence.below(6)];
    // Chi-square with 5 degrees of freedom: 30.9 is exceeded once in 10^5.
    double chi_square = 0;
    for (const int count : faces) chi_square += (count - 1000.0) * (count - 1000.0) / 1000.0;
    CHECK(chi_square < 30.9);

    CHECK(sequence.below(1) == 0);
    CHECK_THROWS_AS(sequence.below(0), in::invalid_input);
    std::vector<double> samples;
    for (int i = 0; i < 1000; ++i) samples.push_back(sequence.uniform(-3, 5));
    CHECK(std::all_of(samples.begin(), samples.end(), [](double x) { return x > -3 && x < 5; }));
    CHECK(kolmogorov_smirnov(std::span(samples), [](double x) { return (x + 3) / 8; }) < once_in_100000);
}
