// Convolves rows of noise with symmetric taps (see correlation.hpp), along a row or across rows.
#pragma once

#include <insonify/core/simd/lanes.hpp>

#include <cstddef>
#include <span>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Calls `block.template operator()<N>(i)` for blocks of N values from 0 on, and one by one for the rest.
template <int N, class Block>
INSONIFY_INLINE void for_each_block(std::size_t count, const Block& block) {
    std::size_t i = 0;
    for (; i + N <= count; i += N) block.template operator()<N>(i);
    for (; i < count; ++i) block.template operator()<1>(i);
}

/// into[i] = taps[0] from[i] + sum over j of taps[j] (from[i - j step] + from[i + j step])
struct taps_along_row {
    std::span<const float> taps;  ///< half of a symmetric kernel: the centre tap, then one side
    const float* from;            ///< readable (taps.size() - 1) step values before and after the `count` ones
    std::size_t step;             ///< 2 for complex values
    float* into;
    std::size_t count;

    template <int N>
    INSONIFY_INLINE void run() const {
        for_each_block<N>(count, [this]<int M>(std::size_t i) INSONIFY_INLINE_LAMBDA {
            lanes<float, M> sum, left, right;
            load(sum, from + i);
            sum = taps[0] * sum;
            for (std::size_t j = 1; j < taps.size(); ++j) {
                load(left, from + i - j * step);
                load(right, from + i + j * step);
                sum += taps[j] * (left + right);
            }
            store(into + i, sum);
        });
    }
};

/// into[i] = sum over k of taps[|k - middle|] rows[k][i]
struct taps_across_rows {
    std::span<const float> taps;         ///< half of a symmetric kernel: the centre tap, then one side
    std::span<const float* const> rows;  ///< 2 taps.size() - 1
    float* into;
    std::size_t count;

    template <int N>
    INSONIFY_INLINE void run() const {
        const std::size_t middle = taps.size() - 1;
        for_each_block<N>(count, [this, middle]<int M>(std::size_t i) INSONIFY_INLINE_LAMBDA {
            lanes<float, M> sum{}, value;
            for (std::size_t k = 0; k < rows.size(); ++k) {
                load(value, rows[k] + i);
                sum += taps[k < middle ? middle - k : k - middle] * value;
            }
            store(into + i, sum);
        });
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
