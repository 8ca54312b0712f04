// Counts the pixels of an image by bin, in bands that executors run in parallel.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/executor.hpp>
#include <insonify/core/image.hpp>
#include <insonify/core/quantize.hpp>
#include <insonify/filter/concept.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// The bin of a value: the nearest level of `bins` equidistant ones, ties up.
constexpr std::size_t bin_of(float value, int bins) {
    const double scale = bins - 1;
    if (!(value > 0)) return 0;
    return static_cast<std::size_t>(value < 1 ? static_cast<double>(value) * scale + 0.5 : scale);
}
template <pixel_code Code>
constexpr std::size_t bin_of(Code code, int bins) {
    constexpr std::uint64_t largest = (std::numeric_limits<Code>::max)();
    return (2 * std::uint64_t{code} * static_cast<std::uint64_t>(bins - 1) + largest) / (2 * largest);
}

/// Counts NaN.
struct count_nan_kernel {
    const float* values;
    int count;
    int* found;

    template <int N>
    INSONIFY_INLINE void run() const {
        using ints = lanes<std::int32_t, N>;
        ints sum{};
        int i = 0;
        for (; i + N <= count; i += N) {
            lanes<float, N> value;
            load(value, values + i);
            sum = sum + (value == value ? ints{} : ints{} + 1);
        }
        int total = 0;
        for (int k = 0; k < N; ++k) total += lane(sum, k);
        for (; i < count; ++i) total += values[i] == values[i] ? 0 : 1;
        *found = total;
    }
};

inline int count_nan(const float* values, int count) {
    int found = 0;
    dispatch(count_nan_kernel{values, count, &found}, best_isa());
    return found;
}

/// Counts codes. Those of 8 bits are counted in four tables in rotation, since incrementing one counter twice in a row
/// stalls on store-to-load forwarding.
template <pixel_code Code>
class code_counter {
  public:
    /// Bands of fewer pixels take longer to merge than to count.
    static constexpr std::size_t min_pixels = sizeof(Code) == 1 ? 1 << 16 : 1 << 20;

    code_counter() : counts_(tables * levels) {}

    void add(const Code* codes, int count) {
        std::uint32_t* const table = counts_.data();
        int i = 0;
        if constexpr (tables == 4) {
            for (; i + 4 <= count; i += 4) {
                ++table[codes[i]];
                ++table[levels + codes[i + 1]];
                ++table[2 * levels + codes[i + 2]];
                ++table[3 * levels + codes[i + 3]];
            }
        }
        for (; i < count; ++i) ++table[codes[i]];
    }
    /// NaN is not counted.
    void add(const float* values, int count) {
        Code codes[run_length];
        quantize_row(values, codes, count);
        add(codes, count);
        counts_[0] -= static_cast<std::uint32_t>(count_nan(values, count));
    }

    void add_to(std::span<std::uint64_t> sums) const {
        for (std::size_t i = 0; i < levels; ++i) {
            std::uint32_t count = 0;  // modulo 2^32, as NaN is subtracted from one table; bands have fewer pixels
            for (std::size_t table = 0; table < tables; ++table) count += counts_[table * levels + i];
            sums[i] += count;
        }
    }

  private:
    static constexpr std::size_t levels = std::size_t{(std::numeric_limits<Code>::max)()} + 1;
    static constexpr std::size_t tables = sizeof(Code) == 1 ? 4 : 1;
    dynamic_array<std::uint32_t> counts_;
};

/// Counts any pixel type into any number of bins. NaN is not counted.
template <class Pixel>
class bin_counter {
  public:
    static constexpr std::size_t min_pixels = 1 << 20;

    explicit bin_counter(int bins) : bins_(bins), counts_(static_cast<std::size_t>(bins)) {}

    void add(const Pixel* pixels, int count) {
        for (int i = 0; i < count; ++i)
            if (pixels[i] == pixels[i]) ++counts_[bin_of(pixels[i], bins_)];
    }
    void add_to(std::span<std::uint64_t> sums) const {
        for (std::size_t i = 0; i < counts_.size(); ++i) sums[i] += counts_[i];
    }

  private:
    int bins_;
    dynamic_array<std::uint32_t> counts_;
};

/// Counts bands of an image, each with a counter of its own from `make()`, and adds them up.
template <class Pixel, executor E, class Make>
std::vector<std::uint64_t> count_bands(image_view<const Pixel> source, int bins, E& ex, const Make& make) {
    using counter = decltype(make());
    // About 16 bands, each below 2^31 pixels.
    const std::size_t rows = static_cast<std::size_t>(source.height());
    const auto width = static_cast<std::size_t>((std::max)(source.width(), 1));
    const std::size_t max_rows = (std::size_t{1} << 31) / width, min_rows = counter::min_pixels / width + 1;
    const std::size_t grain = (std::max)((std::min)(rows / 16 + 1, max_rows), min_rows);
    const auto size = static_cast<std::size_t>(bins);
    dynamic_array<std::uint64_t> bands((rows + grain - 1) / grain * size);
    bulk_ranges(ex, rows, grain, [&](std::size_t first, std::size_t last) {
        counter own = make();
        for (std::size_t y = first; y < last; ++y) {
            const auto row = source.row(static_cast<int>(y));
            for (int x = 0; x < source.width(); x += run_length)
                own.add(row.data() + x, (std::min)(run_length, source.width() - x));
        }
        own.add_to({bands.data() + first / grain * size, size});
    });
    std::vector<std::uint64_t> sums(size);
    for (std::size_t band = 0; band < bands.size(); band += size)
        for (std::size_t i = 0; i < size; ++i) sums[i] += bands[band + i];
    return sums;
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
