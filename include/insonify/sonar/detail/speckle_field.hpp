// The random fields of speckle, keyed by side, ping and bin: correlated complex Gaussian noise, and gamma textures.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/detail/echo_statistics.hpp>
#include <insonify/core/detail/tap_kernels.hpp>
#include <insonify/core/image.hpp>
#include <insonify/core/random.hpp>
#include <insonify/core/simd/dispatch.hpp>
#include <insonify/core/simd/random_lanes.hpp>
#include <insonify/sonar/side_scan/side_scan.hpp>

#include <span>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Random streams; changing one changes the noise of every seed.
enum class speckle_stream : std::uint32_t { field = 0x73706B00, texture = 0x73706B02, choice = 0x73706B04 };

/// Random numbers keyed by ping and bin.
class ping_noise {
  public:
    ping_noise(std::uint64_t seed, side s, speckle_stream stream)
        : key_(stream_key(seed, static_cast<std::uint32_t>(stream) + static_cast<std::uint32_t>(s))) {}

    philox_counter operator()(std::int64_t ping, std::uint32_t bin, std::uint32_t draw) const {
        return philox4x32(counter(ping, bin, draw), key_);
    }

    static philox_counter counter(std::int64_t ping, std::uint32_t bin, std::uint32_t draw) {
        const auto number = static_cast<std::uint64_t>(ping);
        return {bin, static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32), draw};
    }
    const philox_key& key() const { return key_; }

  private:
    philox_key key_;
};

/// Complex normal draws of unit power for consecutive bins, real and imaginary parts interleaved, bit-identical to
/// normal_pair. One block of Philox serves two bins.
struct speckle_draw_kernel {
    static constexpr std::size_t max_lanes = 4;  ///< blocks at a time

    philox_key key;
    philox_counter first;  ///< counter of the first block; its first word, the bin, grows by 2 from block to block
    float* into;
    std::size_t blocks;  ///< `into` holds 4 values for each, and for as many more as make a multiple of max_lanes

    template <int N>
    INSONIFY_INLINE void run() const {
        constexpr int M = N > 1 ? N / 2 : 1;
        for (std::size_t i = 0; i < blocks; i += static_cast<std::size_t>(M)) {
            const std::uint32_t bin = first[0] + 2 * static_cast<std::uint32_t>(i);
            lanes<std::uint64_t, M> word[4];
            gather<M>(word[0], [&](int k) INSONIFY_INLINE_LAMBDA {
                return std::uint64_t{bin + 2 * static_cast<std::uint32_t>(k)};
            });
            for (int w = 1; w < 4; ++w)
                word[w] = lanes<std::uint64_t, M>{} + std::uint64_t{first[static_cast<std::size_t>(w)]};
            philox_lanes<M>(word, key[0], key[1]);
            for (int bin_of_two = 0; bin_of_two < 2; ++bin_of_two) {
                lanes<double, M> re, im;
                normal_lanes<M>(re, im, word[2 * bin_of_two], word[2 * bin_of_two + 1]);
                re = re * 0.70710678118654752;
                im = im * 0.70710678118654752;
                float* const to = into + 4 * i + 2 * bin_of_two;
                for (int k = 0; k < M; ++k) {
                    to[4 * k] = static_cast<float>(lane(re, k));
                    to[4 * k + 1] = static_cast<float>(lane(im, k));
                }
            }
        }
    }
};

/// A correlated complex Gaussian field of unit power, by rows, with real and imaginary parts interleaved.
class speckle_field {
  public:
    /// @param along, across  correlation lengths of intensities, pings and bins
    speckle_field(std::uint64_t seed, side facing, float along, float across, int bins)
        : noise_(seed, facing, speckle_stream::field),
          bins_(static_cast<std::size_t>(bins)),
          across_(intensity_taps(static_cast<double>(across))),
          along_(intensity_taps(static_cast<double>(along))) {}

    /// The field of one look for consecutive pings, from number `first` on.
    image<float> pings(std::int64_t first, int count, std::uint32_t look) const {
        const int reach = static_cast<int>(along_.size()) - 1;
        image<float> blurred(static_cast<int>(2 * bins_), count + 2 * reach);
        for (int i = 0; i < blurred.height(); ++i) row(first - reach + i, look, blurred.row(i));
        if (reach == 0) return blurred;
        image<float> field(static_cast<int>(2 * bins_), count);
        dynamic_array<const float*> rows(static_cast<std::size_t>(2 * reach + 1));
        for (int i = 0; i < count; ++i) {
            for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = blurred.row(i + static_cast<int>(k)).data();
            dispatch(taps_across_rows{along_, rows, field.row(i).data(), 2 * bins_}, best_isa());
        }
        return field;
    }

  private:
    /// One ping, correlated across the track.
    void row(std::int64_t ping, std::uint32_t look, std::span<float> out) const {
        const std::size_t reach = across_.size() - 1, margin = reach + (reach & 1);
        const std::size_t blocks = (bins_ + 2 * margin + 1) / 2;
        dynamic_array<float> white(4 * (blocks + speckle_draw_kernel::max_lanes));
        const std::uint32_t first = 0u - static_cast<std::uint32_t>(margin);
        dispatch(speckle_draw_kernel{noise_.key(), ping_noise::counter(ping, first, look), white.data(), blocks},
                 best_isa());
        dispatch(taps_along_row{across_, &white[2 * margin], 2, out.data(), out.size()}, best_isa());
    }

    ping_noise noise_;
    std::size_t bins_;
    dynamic_array<float> across_, along_;
};

/// The texture of the K-distribution: gamma-distributed at the nodes of a lattice. A bin takes the value of one of the
/// four nodes around it, chosen at random with bilinear weights, so that textures are correlated and keep their
/// distribution.
class speckle_texture {
  public:
    /// @param length  distance between nodes, pings and bins
    speckle_texture(std::uint64_t seed, side facing, float length)
        : nodes_(seed, facing, speckle_stream::texture),
          choices_(seed, facing, speckle_stream::choice),
          frequency_(1 / static_cast<double>(length)) {}

    float operator()(std::int64_t ping, std::uint32_t bin, float shape) const {
        const philox_counter words = choices_(ping, bin, 0);
        // Rounding a coordinate plus a uniform number chooses either adjacent node with its linear weight.
        const std::int64_t row = numeric::floor_to_int(static_cast<double>(ping) * frequency_ + uniform_open(words[0]));
        const auto column =
            static_cast<std::uint32_t>(numeric::floor_to_int(bin * frequency_ + uniform_open(words[1])));
        return static_cast<float>(gamma_of_mean_one(static_cast<double>(shape),
                                                    [&](std::uint32_t trial) { return nodes_(row, column, trial); }));
    }

  private:
    ping_noise nodes_, choices_;
    double frequency_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
