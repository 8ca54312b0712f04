// Counter-based random numbers: a number is a pure function of (seed, stream, counter).
//
// Noise counted by pixel or world cell does not depend on tiling, cropping, threads or the order of frames:
//
//     const philox_key key = stream_key(seed, 17);                                     // 17: any number of your own
//     const double u = uniform_open(philox4x32({x, y, frame, 0}, key)[0]);  // x, y, frame: std::uint32_t
//
// Based on: John K. Salmon, Mark A. Moraes, Ron O. Dror, David E. Shaw. Parallel Random Numbers: As Easy as 1, 2, 3.
// SC11, 2011 (Philox4x32-10; checked against the known answers of Random123).
#pragma once

#include <insonify/core/simd/random_lanes.hpp>

#include <array>
#include <cstdint>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Input of philox4x32 besides the key: pixel, cell or sample numbers.
using philox_counter = std::array<std::uint32_t, 4>;
/// The key of a stream of random words, from `stream_key`.
using philox_key = std::array<std::uint32_t, 2>;

inline namespace INSONIFY_FLAGS {

/// Philox4x32 with ten rounds: four independent 32-bit words for each counter and key.
constexpr philox_counter philox4x32(philox_counter counter, philox_key key) {
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t a = std::uint64_t{0xD2511F53u} * counter[0];
        const std::uint64_t b = std::uint64_t{0xCD9E8D57u} * counter[2];
        counter = {static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(b),
                   static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(a)};
        key[0] += 0x9E3779B9u;
        key[1] += 0xBB67AE85u;
    }
    return counter;
}

/// The key of a stream: draws of different streams are independent under one seed.
constexpr philox_key stream_key(std::uint64_t seed, std::uint32_t stream) {
    // Mixed by a whole block, so that adjacent seeds and streams have unrelated keys.
    const philox_counter mixed = philox4x32(
        {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32), stream, 0x696E736Fu}, {0, 0});
    return {mixed[0], mixed[1]};
}

/// Uniform in (0, 1), symmetric about 1/2, all 32 bits used; never 0 or 1, so its logarithm is finite.
constexpr double uniform_open(std::uint32_t word) {
    return (static_cast<double>(word) + 0.5) * 0x1p-32;
}

/// Two independent standard normal draws from two words (Box and Muller, 1958); reaches 6.76 sigma.
inline std::array<double, 2> normal_pair(std::uint32_t a, std::uint32_t b) {
    double first, second;
    detail::normal_lanes<1>(first, second, std::uint64_t{a}, std::uint64_t{b});
    return {first, second};
}

/// Sequential draws, for scene parameters and other small jobs. Sequences of one seed need different streams.
class random_sequence {
  public:
    /// @param seed    seed of the run
    /// @param stream  purpose of the numbers; different streams are independent
    /// @param item    index of the image, target or track
    explicit random_sequence(std::uint64_t seed, std::uint32_t stream = 0, std::uint64_t item = 0)
        : key_(stream_key(seed, stream)), item_(item) {}

    std::uint32_t word() {
        if (used_ == 4) {
            block_ = philox4x32(
                {static_cast<std::uint32_t>(item_), static_cast<std::uint32_t>(item_ >> 32), count_++, 0}, key_);
            used_ = 0;
        }
        return block_[used_++];
    }

    /// Uniform in (0, 1).
    double uniform() { return uniform_open(word()); }
    /// Uniform in (low, high); rounding may reach the ends.
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    /// Uniform over 0 ... count - 1; each probability is within a factor 1 +- count / 2^32 of 1 / count.
    /// @throws invalid_input for count = 0
    std::uint32_t below(std::uint32_t count) {
        detail::require(count > 0, "count", count, "at least 1");
        return static_cast<std::uint32_t>((std::uint64_t{word()} * count) >> 32);
    }

  private:
    philox_key key_;
    std::uint64_t item_;
    std::uint32_t count_ = 0;
    philox_counter block_{};
    std::size_t used_ = 4;
};

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
