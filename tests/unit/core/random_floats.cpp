// Random floats over lanes: the draws of random.hpp to a float's rounding, the same at every instruction set.
#include <insonify/core/random.hpp>
#include <insonify/core/simd/random_lanes.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "../../catch.hpp"
#include "../../larger.hpp"

namespace in = insonify;
using namespace insonify::detail;

namespace {

constexpr std::uint32_t first_block = 0xFFFFFFF0u;  // the counters of its blocks pass 2^32

/// Draws of the blocks from `first_block` on, in the order of their words.
struct float_draws {
    std::vector<float> normals, symmetric, units, logarithms;
};
struct all_draws_kernel {
    [[maybe_unused]] static constexpr int avx512_lanes = 16;

    float_draws& into;

    template <int N>
    INSONIFY_INLINE void run() const {
        for (std::size_t i = 0; i < into.normals.size(); i += 4 * N) {
            const std::uint32_t counter[4] = {first_block + static_cast<std::uint32_t>(i / 4), 5, 6, 7};
            lanes<std::uint32_t, N> word[4];
            philox_words<N>(word, counter, 0x12345678u, 0x9ABCDEF0u);
            lanes<float, N> draw[4];
            normal_lanes<N>(draw[0], draw[1], word[0], word[1]);
            normal_lanes<N>(draw[2], draw[3], word[2], word[3]);
            store_draws<N>(&into.normals[i], draw);
            for (int k = 0; k < 4; ++k) symmetric_lanes<N>(draw[k], word[k]);
            store_draws<N>(&into.symmetric[i], draw);
            for (int k = 0; k < 4; ++k) unit_lanes<N>(draw[k], word[k]);
            store_draws<N>(&into.units[i], draw);
            for (int k = 0; k < 4; ++k) log_uniform_lanes<N>(draw[k], word[k]);
            store_draws<N>(&into.logarithms[i], draw);
        }
    }
};

float_draws draws_of(std::size_t count, auto&& run) {
    float_draws result{std::vector<float>(count), std::vector<float>(count), std::vector<float>(count),
                       std::vector<float>(count)};
    run(all_draws_kernel{result});
    return result;
}
float_draws draws_one_by_one(std::size_t count) {
    return draws_of(count, [](const all_draws_kernel& kernel) { kernel.run<1>(); });
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
    return std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

float log_of_word(std::uint32_t word) {
    float result;
    log_uniform_lanes<1>(result, word);
    return result;
}

}  // namespace

TEST_CASE("Draws in lanes equal those of their words to a float's rounding, across blocks") {
    constexpr std::size_t count = 1 << 18;
    const float_draws found = draws_one_by_one(count);
    double normal = 0, symmetric = 0, unit = 0, logarithm = 0;
    for (std::size_t i = 0; i < count; i += 4) {
        const auto words =
            in::philox4x32({first_block + static_cast<std::uint32_t>(i / 4), 5, 6, 7}, {0x12345678u, 0x9ABCDEF0u});
        for (std::size_t k = 0; k < 4; ++k) {
            const double u = in::uniform_open(words[k]);
            const double z = in::normal_pair(words[k & 2], words[(k & 2) + 1])[k & 1];
            normal = larger(normal, std::abs(z - static_cast<double>(found.normals[i + k])));
            symmetric = larger(symmetric, std::abs(2 * u - 1 - static_cast<double>(found.symmetric[i + k])));
            unit = larger(unit, std::abs(u - static_cast<double>(found.units[i + k])) / u);
            logarithm =
                larger(logarithm, std::abs(std::log(u) - static_cast<double>(found.logarithms[i + k])) / -std::log(u));
        }
    }
    CHECK(normal < 6e-7);
    CHECK(symmetric < 6e-8);
    CHECK(unit < 1e-4);  // of the smallest of them: 31 bits
    CHECK(logarithm < 3e-7);
}

TEST_CASE("Draws in lanes have the same bits at every instruction set") {
    const float_draws scalar = draws_one_by_one(1 << 12);
    for (const in::isa level : {in::isa::baseline, in::isa::avx2, in::isa::avx512}) {
        const float_draws wide =
            draws_of(1 << 12, [&](const all_draws_kernel& kernel) { in::detail::dispatch(kernel, level); });
        CHECK(same_bits(wide.normals, scalar.normals));
        CHECK(same_bits(wide.symmetric, scalar.symmetric));
        CHECK(same_bits(wide.units, scalar.units));
        CHECK(same_bits(wide.logarithms, scalar.logarithms));
    }
}

TEST_CASE("log_uniform_lanes() has a relative error below 3e-7, also near both ends") {
    for (const std::uint32_t word :
         {0u, 1u, 2u, 77u, 0x7FFFFFFFu, 0x80000000u, 0xB504F333u, 0xFFFFFF00u, 0xFFFFFFFFu}) {
        const double exact = std::log1p(-(static_cast<double>(~word) + 0.5) * 0x1p-32);
        CHECK(static_cast<double>(log_of_word(word)) == Approx(exact).epsilon(3e-7));
    }
}

TEST_CASE("cos_sin_turns() in floats is accurate to 1.2e-7, also at multiples of an eighth of a turn") {
    double worst = 0;
    const auto compare = [&](std::uint32_t word) {
        float cosine, sine;
        cos_sin_turns<1>(cosine, sine, word);
        const auto [exact_sine, exact_cosine] = in::numeric::sin_cos_turns(word * 0x1p-32);
        worst = larger(worst, larger(std::abs(static_cast<double>(cosine) - exact_cosine),
                                     std::abs(static_cast<double>(sine) - exact_sine)));
    };
    for (std::uint64_t word = 0; word <= 0xFFFFFFFFu; word += 0x3FFFD) compare(static_cast<std::uint32_t>(word));
    for (std::uint32_t eighth = 0; eighth < 8; ++eighth)
        for (std::uint32_t distance = 0; distance <= 1000; ++distance) {
            compare(0x20000000u * eighth + distance);
            compare(0x20000000u * eighth - distance);
        }
    CHECK(worst < 1.2e-7);
}

TEST_CASE("floor_lanes() equals std::floor()") {
    for (double x = -690; x < 690; x += 0.37) {
        double found;
        floor_lanes<1>(found, x);
        CHECK(found == std::floor(x));
    }
    for (const double x : {-3.0, -0.5, 0.0, 7.0, 1e9 + 0.5, 0x1p51 - 0.5, 0.5 - 0x1p51}) {
        double found;
        floor_lanes<1>(found, x);
        CHECK(found == std::floor(x));
    }
}
