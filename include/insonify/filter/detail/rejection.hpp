// Rejection sampling over SIMD lanes: pixels whose trial fails are compacted and tried again together.
#pragma once

#include <insonify/filter/detail/noise_pass.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Indices of some pixels of a run.
struct pixel_list {
    int count = 0;
    std::uint16_t indices[run_length + 8];
};

/// Appends an index if the condition holds, without a branch: on random outcomes it would be mispredicted.
INSONIFY_INLINE void add_if(bool condition, int index, std::uint16_t* indices, int& count) {
    indices[count] = static_cast<std::uint16_t>(index);
    count += condition ? 1 : 0;
}

/// Draws a number for each pixel of a list. Overwrites the list's indices, not its count.
///
/// `method.template attempt<N>(result, accepted, words, parameter, trial)` makes one trial for N pixels and sets the
/// lanes of `accepted` whose result is final; `words` are those of block `method.block(trial)` of each pixel.
template <class Method>
struct rejection_kernel {
    Method method;
    const double* parameter;
    double* result;
    pixel_list* list;
    noise_run at;
    noise_key noise;

    template <int Width>
    INSONIFY_INLINE void run() const {
        constexpr int N = Width > 1 ? Width / 2 : 1;
        using words = lanes<std::uint64_t, N>;
        using doubles = lanes<double, N>;
        std::uint16_t* const indices = list->indices;
        int count = list->count;
        for (std::uint32_t trial = 0; count > 0; ++trial) {
            int left = 0;
            for (int first = 0; first < count; first += N) {
                // Lanes past the last pixel repeat it.
                int index[static_cast<unsigned>(N)];
                for (int k = 0; k < N; ++k) index[k] = indices[first + k < count ? first + k : count - 1];
                words block[4];
                gather<N>(block[0], [&](int k) {
                    return std::uint64_t{static_cast<std::uint32_t>(at.x) + static_cast<std::uint32_t>(index[k])};
                });
                block[1] = words{} + std::uint64_t{static_cast<std::uint32_t>(at.y)};
                block[2] = words{} + std::uint64_t{method.block(trial) | at.channel << 24};
                block[3] = words{} + std::uint64_t{noise.frame};
                philox_lanes<N>(block, noise.key[0], noise.key[1]);
                doubles given, made;
                gather<N>(given, [&](int k) { return parameter[index[k]]; });
                lanes<std::int64_t, N> accepted;
                method.template attempt<N>(made, accepted, block, given, trial);
                for (int k = 0; k < N && first + k < count; ++k) {
                    result[index[k]] = lane(made, k);
                    add_if(lane(accepted, k) == 0, index[k], indices, left);
                }
            }
            count = left;
        }
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
