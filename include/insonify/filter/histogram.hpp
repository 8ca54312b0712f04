// Histograms of equal bins, and MATLAB's two filters on them: equalize and match.
//
// NaN is not counted and stays NaN. An image of NaN alone passes through. A constant image takes one level, that of its
// rank: the wanted level at which the cumulative share reaches one half (or 1 at level 0 and the last, by MATLAB's
// rule).
//
// Based on: MathWorks. Image Processing Toolbox, imhist, histeq, imhistmatch (64 bins, 256 source levels, 65536 for
// codes of 16 bits).
#pragma once

#include <insonify/core/executor.hpp>
#include <insonify/core/image.hpp>
#include <insonify/core/quantize.hpp>
#include <insonify/filter/concept.hpp>

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Pixel counts by level. Level k of n counts the values nearest to k / (n - 1), ties up; values outside [0, 1] count
/// at the ends. Histograms of many images add up to that of a data set:
///
///     in::histogram all = in::histogram_of(first);
///     all += in::histogram_of(second);
///     const auto look = in::match_binned(all);
struct histogram {
    std::vector<std::uint64_t> counts;

    INSONIFY_TAGGED std::uint64_t total() const {
        std::uint64_t sum = 0;
        for (const std::uint64_t count : counts) sum += count;
        return sum;
    }

    /// @throws invalid_input for another number of bins
    INSONIFY_TAGGED histogram& operator+=(const histogram& other) {
        detail::require(other.counts.size() == counts.size(), "bins of the histogram to add", other.counts.size(),
                        "those of the sum");
        for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += other.counts[i];
        return *this;
    }

    friend bool operator==(const histogram&, const histogram&) = default;
};

/// Pixel types that histograms count: floats in [0, 1] and codes.
template <class T>
concept countable_pixel = std::same_as<T, float> || pixel_code<T>;

namespace detail::inline INSONIFY_FLAGS {

inline void require_bins(const char* name, int bins) {
    require(bins >= 2 && bins <= 65536, name, bins, "2 to 65536");
}

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

/// Counts codes. For 8 bits, four tables take turns, so that equal adjacent pixels do not wait for one another's
/// increment.
template <pixel_code Code>
class code_counter {
  public:
    /// Fewer pixels cost more to merge than to count.
    static constexpr std::size_t least_pixels = sizeof(Code) == 1 ? 1 << 16 : 1 << 20;

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
        quantize_row(std::span<const float>(values, static_cast<std::size_t>(count)),
                     std::span<Code>(codes, static_cast<std::size_t>(count)));
        add(codes, count);
        counts_[0] -= static_cast<std::uint32_t>(count_nan(values, count));
    }

    void add_to(histogram& sum) const {
        for (std::size_t i = 0; i < levels; ++i) {
            std::uint32_t count = 0;  // sums wrap correctly: below 2^32 pixels
            for (std::size_t table = 0; table < tables; ++table) count += counts_[table * levels + i];
            sum.counts[i] += count;
        }
    }

  private:
    static constexpr std::size_t levels = std::size_t{(std::numeric_limits<Code>::max)()} + 1;
    static constexpr std::size_t tables = sizeof(Code) == 1 ? 4 : 1;
    std::vector<std::uint32_t> counts_;
};

/// Counts any pixel type into any number of bins.
template <class Pixel>
class bin_counter {
  public:
    static constexpr std::size_t least_pixels = 1 << 20;

    explicit bin_counter(int bins) : bins_(bins), counts_(static_cast<std::size_t>(bins)) {}

    void add(const Pixel* pixels, int count) {
        for (int i = 0; i < count; ++i)
            if (pixels[i] == pixels[i]) ++counts_[bin_of(pixels[i], bins_)];
    }
    void add_to(histogram& sum) const {
        for (std::size_t i = 0; i < counts_.size(); ++i) sum.counts[i] += counts_[i];
    }

  private:
    int bins_;
    std::vector<std::uint32_t> counts_;
};

/// Counts bands of an image with counters made by `make()`, and adds them up.
template <class Pixel, executor E, class Make>
histogram count_parts(image_view<const Pixel> source, int bins, E& ex, const Make& make) {
    using counter = decltype(make());
    // About 16 bands, each below 2^31 pixels.
    const std::size_t rows = static_cast<std::size_t>(source.height());
    const auto width = static_cast<std::size_t>((std::max)(source.width(), 1));
    const std::size_t most = (std::size_t{1} << 31) / width, least = counter::least_pixels / width + 1;
    const std::size_t grain = (std::max)((std::min)(rows / 16 + 1, most), least);
    std::vector<histogram> sums((rows + grain - 1) / grain);
    bulk_ranges(ex, rows, grain, [&](std::size_t first, std::size_t last) {
        counter own = make();
        for (std::size_t y = first; y < last; ++y) {
            const auto row = source.row(static_cast<int>(y));
            for (int x = 0; x < source.width(); x += run_length)
                own.add(row.data() + x, (std::min)(run_length, source.width() - x));
        }
        histogram& sum = sums[first / grain];
        sum.counts.resize(static_cast<std::size_t>(bins));
        own.add_to(sum);
    });
    histogram result{std::vector<std::uint64_t>(static_cast<std::size_t>(bins))};
    for (const histogram& sum : sums) result += sum;
    return result;
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// MATLAB's imhist. Pixels are floats in [0, 1], of which NaN is not counted, or codes that mean code / 255 or / 65535.
/// @throws invalid_input for bins outside 2 to 65536
template <countable_pixel Pixel, executor_argument E = serial_executor>
histogram histogram_of(image_view<const Pixel> source, int bins = 256, E&& ex = {}) {
    detail::require_bins("bins", bins);
    constexpr bool narrow = std::same_as<Pixel, std::uint8_t>, wide = std::same_as<Pixel, std::uint16_t>;
    if constexpr (!wide) {
        if (bins == 256)
            return detail::count_parts(source, bins, ex, [] { return detail::code_counter<std::uint8_t>(); });
    }
    if constexpr (!narrow) {
        if (bins == 65536)
            return detail::count_parts(source, bins, ex, [] { return detail::code_counter<std::uint16_t>(); });
    }
    return detail::count_parts(source, bins, ex, [bins] { return detail::bin_counter<Pixel>(bins); });
}
/// The same of an image.
template <countable_pixel Pixel, executor_argument E = serial_executor>
histogram histogram_of(const image<Pixel>& source, int bins = 256, E&& ex = {}) {
    return histogram_of(source.view(), bins, ex);
}

}  // namespace INSONIFY_FLAGS

namespace detail::inline INSONIFY_FLAGS {

/// Number of levels that a source is counted by.
template <class Pixel>
inline constexpr int source_levels = std::same_as<Pixel, std::uint16_t> ? 65536 : 256;

/// Maps each level to a value; floats take that of the nearest of 256 levels, NaN stays NaN.
template <countable_pixel Pixel>
class level_map {
  public:
    explicit level_map(std::vector<Pixel> values)
        : values_(std::make_shared<const std::vector<Pixel>>(std::move(values))) {}

    template <std::same_as<Pixel> P>
    P operator()(P pixel) const {
        const std::vector<Pixel>& values = *values_;
        if constexpr (std::is_same_v<P, float>) {
            return pixel == pixel ? values[quantize<std::uint8_t>(pixel)] : pixel;
        } else {
            return values[pixel];
        }
    }
    void row(const Pixel* from, Pixel* to, int count, int, int) const {
        const Pixel* const values = values_->data();
        if constexpr (std::is_same_v<Pixel, float>) {
            std::uint8_t codes[run_length];
            quantize_row(std::span<const float>(from, static_cast<std::size_t>(count)),
                         std::span<std::uint8_t>(codes, static_cast<std::size_t>(count)));
            if (count_nan(from, count) == 0) {
                for (int i = 0; i < count; ++i) to[i] = values[codes[i]];
            } else {
                for (int i = 0; i < count; ++i) to[i] = from[i] == from[i] ? values[codes[i]] : from[i];
            }
        } else {
            for (int i = 0; i < count; ++i) to[i] = values[from[i]];
        }
    }

  private:
    std::shared_ptr<const std::vector<Pixel>> values_;  // passes are copied; the table isn't
};

/// The map of histeq: each source level goes to the first level of `wanted` whose cumulative share reaches the
/// source's, less half of the level's own share except at the first and the last level.
template <class Pixel>
level_map<Pixel> map_levels(const histogram& source, const histogram& wanted) {
    const auto source_total = static_cast<double>((std::max)(source.total(), std::uint64_t{1}));
    const auto wanted_total = static_cast<double>(wanted.total());
    constexpr double tolerance = 0x1p-26;
    const std::size_t levels = source.counts.size();
    std::vector<Pixel> values(levels);
    std::uint64_t below = 0, reached = wanted.counts[0];
    std::size_t target = 0;
    for (std::size_t level = 0; level < levels; ++level) {
        below += source.counts[level];
        const bool inner = level > 0 && level + 1 < levels;
        const double share = static_cast<double>(below) - (inner ? 0.5 * static_cast<double>(source.counts[level]) : 0);
        while (static_cast<double>(reached) / wanted_total < share / source_total - tolerance) {
            reached += wanted.counts[++target];
        }
        const double value = static_cast<double>(target) / static_cast<double>(wanted.counts.size() - 1);
        if constexpr (std::is_same_v<Pixel, float>) {
            values[level] = static_cast<float>(value);
        } else {
            values[level] = static_cast<Pixel>((std::numeric_limits<Pixel>::max)() * value + 0.5);
        }
    }
    return level_map<Pixel>(std::move(values));
}

}  // namespace detail::inline INSONIFY_FLAGS

/// Spreads the values evenly over [0, 1]. MATLAB: histeq(I, levels).
struct equalize {
    int levels = 64;  ///< number of distinct values in the result, 2 to 65536

    using is_filter = std::true_type;

    /// @throws invalid_input for levels outside 2 to 65536
    template <countable_pixel Pixel, executor_argument E = serial_executor>
    INSONIFY_MEMBER detail::level_map<Pixel> pass(image_view<const Pixel> source, E&& ex = {}) const {
        detail::require_bins("equalize.levels", levels);
        const histogram flat{std::vector<std::uint64_t>(static_cast<std::size_t>(levels), 1)};
        return detail::map_levels<Pixel>(histogram_of(source, detail::source_levels<Pixel>, ex), flat);
    }
};

/// Gives an image the histogram of a reference, by bins: fast, and as coarse as the bins. MATLAB: imhistmatch(I,
/// reference, bins). The reference is counted once and not kept; a histogram of one or many images is taken as well.
/// Floats become floats, codes become codes.
class match_binned {
  public:
    using is_filter = std::true_type;

    /// @throws invalid_input for a reference without a number in it, or bins outside 2 to 65536
    template <countable_pixel Pixel>
    INSONIFY_MEMBER explicit match_binned(image_view<const Pixel> reference, int bins = 64)
        : match_binned(histogram_of(reference, bins)) {}
    template <countable_pixel Pixel>
    INSONIFY_MEMBER explicit match_binned(const image<Pixel>& reference, int bins = 64)
        : match_binned(reference.view(), bins) {}

    /// @throws invalid_input for an empty histogram, or bins outside 2 to 65536
    INSONIFY_MEMBER explicit match_binned(histogram wanted) : wanted_(std::move(wanted)) {
        detail::require(wanted_.counts.size() >= 2 && wanted_.counts.size() <= 65536, "wanted.counts.size()",
                        wanted_.counts.size(), "2 to 65536");
        detail::require(wanted_.total() > 0, "pixels in the reference", wanted_.total(), "at least 1");
    }

    template <countable_pixel Pixel, executor_argument E = serial_executor>
    INSONIFY_MEMBER detail::level_map<Pixel> pass(image_view<const Pixel> source, E&& ex = {}) const {
        return detail::map_levels<Pixel>(histogram_of(source, detail::source_levels<Pixel>, ex), wanted_);
    }

  private:
    histogram wanted_;
};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
