// Complex Gaussian draws keyed by ping and bin, several at a time: the white noise that speckle is made of.
#pragma once

#include <insonify/core/random.hpp>
#include <insonify/core/simd/dispatch.hpp>
#include <insonify/core/simd/random_lanes.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Draws of unit power for bins in a row, real and imaginary parts in turn: those of normal_pair, to the same bits. One
/// block of Philox serves two bins.
struct speckle_draw_kernel {
    static constexpr std::size_t most_lanes = 4;  ///< blocks at a time

    philox_key key;
    philox_counter first;  ///< counter of the first block; its first word, the bin, grows by 2 from block to block
    float* into;
    std::size_t blocks;  ///< `into` holds 4 values for each, and for as many more as make a multiple of most_lanes

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

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
