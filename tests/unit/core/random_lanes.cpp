// Random doubles over lanes: the draws of random.hpp, bit for bit.
#include <insonify/core/random.hpp>
#include <insonify/core/simd/dispatch.hpp>
#include <insonify/core/simd/random_lanes.hpp>

#include <bit>
#include <cmath>
#include <vector>

#include "../../catch.hpp"

namespace in = insonify;
using namespace insonify::detail;

namespace {

/// Words, logarithms and normal draws of counters 0, 1, 2 ...
struct lane_draws {
    std::vector<std::uint32_t> words;
    std::vector<double> logarithms, normals;
};
struct counting_kernel {
    [[maybe_unused]] static constexpr int avx512_lanes = 16;

    lane_draws& into;
    std::size_t count;

    template <int Width>
    INSONIFY_INLINE void run() const {
        constexpr int N = Width > 1 ? Width / 2 : 1;
        using words = lanes<std::uint64_t, N>;
        words step;
        iota<std::uint64_t, N>(step);
        for (std::size_t first = 0; first < count; first += N) {
            words word[4] = {step + std::uint64_t{first}, words{} + std::uint64_t{0xFFFFFFFFu}, words{},
                             words{} + std::uint64_t{7}};
            philox_lanes<N>(word, 0x12345678u, 0x9ABCDEF0u);
            lanes<double, N> u, a, b;
            uniform_lanes<N>(u, word[3]);
            log_lanes<N>(u, u);
            normal_lanes<N>(a, b, word[0], word[1]);
            for (int k = 0; k < N; ++k) {
                for (const words& w : word) into.words.push_back(static_cast<std::uint32_t>(lane(w, k)));
                into.logarithms.push_back(lane(u, k));
                into.normals.push_back(lane(a, k));
                into.normals.push_back(lane(b, k));
            }
        }
    }
};

}  // namespace

TEST_CASE("Words, logarithms and normal draws are the same in scalar code and in lanes, at every instruction set") {
    const in::isa level = GENERATE(in::isa::scalar, in::isa::baseline, in::isa::avx2, in::isa::avx512);
    constexpr std::size_t count = 20000;
    lane_draws found;
    dispatch(counting_kernel{found, count}, level);
    REQUIRE(found.words.size() == 4 * count);
    const auto same = [](double a, double b) {
        return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
    };
    for (std::size_t i = 0; i < count; ++i) {
        const in::philox_counter words =
            in::philox4x32({static_cast<std::uint32_t>(i), 0xFFFFFFFFu, 0, 7}, {0x12345678u, 0x9ABCDEF0u});
        const auto [a, b] = in::normal_pair(words[0], words[1]);
        const bool all = words[0] == found.words[4 * i] && words[1] == found.words[4 * i + 1] &&
                         words[2] == found.words[4 * i + 2] && words[3] == found.words[4 * i + 3] &&
                         same(in::numeric::log(in::uniform_open(words[3])), found.logarithms[i]) &&
                         same(a, found.normals[2 * i]) && same(b, found.normals[2 * i + 1]);
        REQUIRE(all);
    }
}

TEST_CASE("cos_sin_turns() in doubles is accurate to 4e-16, also at multiples of an eighth of a turn") {
    for (int i = 1; i < 4096; ++i) {
        const double turns = i / 4096.0;
        double cosine, sine;
        cos_sin_turns<1>(cosine, sine, turns);
        const auto [exact_sine, exact_cosine] = in::numeric::sin_cos_turns(turns);
        REQUIRE(std::abs(cosine - exact_cosine) < 4e-16);
        REQUIRE(std::abs(sine - exact_sine) < 4e-16);
    }
}
