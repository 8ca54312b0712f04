// Histograms of equal bins, and the two filters that MATLAB builds on them: equalize and match.
//
// Based on: MathWorks. Image Processing Toolbox, imhist, histeq, imhistmatch (64 bins, 256 source levels).
#pragma once

#include <insonify/core/image.hpp>
#include <insonify/core/quantize.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI {

/// How many pixels there are of each level. Level k of n stands for the value k / (n - 1) and takes what is nearest to
/// it, ties up; values outside [0, 1] count at the ends.
struct histogram {
    std::vector<std::uint64_t> counts;

    std::uint64_t total() const {
        std::uint64_t sum = 0;
        for (const std::uint64_t count : counts) sum += count;
        return sum;
    }
};

namespace detail {

inline void require_bins(const char* name, int bins) {
    require(bins >= 2 && bins <= 65536, name, bins, "2 to 65536");
}

constexpr std::size_t bin_of(float value, int bins) {
    const double scale = bins - 1;
    if (!(value > 0)) return 0;
    return static_cast<std::size_t>(value < 1 ? static_cast<double>(value) * scale + 0.5 : scale);
}
constexpr std::size_t bin_of(std::uint8_t code, int bins) {
    return (2u * code * static_cast<unsigned>(bins - 1) + 255) / 510;
}

template <class Pixel>
histogram count_bins(image_view<const Pixel> source, int bins) {
    require_bins("bins", bins);
    histogram result{std::vector<std::uint64_t>(static_cast<std::size_t>(bins))};
    for (int y = 0; y < source.height(); ++y) {
        for (const Pixel pixel : source.row(y)) {
            if (pixel == pixel) ++result.counts[bin_of(pixel, bins)];
        }
    }
    return result;
}

}  // namespace detail

/// MATLAB's imhist. Pixels are floats in [0, 1], of which NaN is not counted, or codes of 8 bits that mean code / 255.
/// @throws invalid_input for bins outside 2 to 65536
inline histogram histogram_of(image_view<const float> source, int bins = 256) {
    return detail::count_bins(source, bins);
}
inline histogram histogram_of(image_view<const std::uint8_t> source, int bins = 256) {
    return detail::count_bins(source, bins);
}

namespace detail {

/// A new value for each of 256 levels; floats take that of the nearest level, NaN stays.
template <class Pixel>
struct level_map {
    std::array<Pixel, 256> values;

    template <std::same_as<Pixel> P>
    P operator()(P pixel) const {
        if constexpr (std::is_same_v<P, float>) {
            return pixel == pixel ? values[quantize<std::uint8_t>(pixel)] : pixel;
        } else {
            return values[pixel];
        }
    }
};

/// The map of histeq: each source level goes to the first level of `wanted` whose cumulative share reaches that of the
/// source, less half of the level's own share (which levels 0 and 255 don't get).
template <class Pixel>
level_map<Pixel> map_levels(const histogram& source, const histogram& wanted) {
    const auto source_total = static_cast<double>((std::max)(source.total(), std::uint64_t{1}));
    const auto wanted_total = static_cast<double>(wanted.total());
    constexpr double tolerance = 0x1p-26;
    level_map<Pixel> map;
    std::uint64_t below = 0, reached = wanted.counts[0];
    std::size_t target = 0;
    for (std::size_t level = 0; level < 256; ++level) {
        below += source.counts[level];
        const bool inner = level > 0 && level < 255;
        const double share = static_cast<double>(below) - (inner ? 0.5 * static_cast<double>(source.counts[level]) : 0);
        while (static_cast<double>(reached) / wanted_total < share / source_total - tolerance) {
            reached += wanted.counts[++target];
        }
        const double value = static_cast<double>(target) / static_cast<double>(wanted.counts.size() - 1);
        if constexpr (std::is_same_v<Pixel, float>) {
            map.values[level] = static_cast<float>(value);
        } else {
            map.values[level] = static_cast<Pixel>(255 * value + 0.5);
        }
    }
    return map;
}

}  // namespace detail

/// Spreads the values evenly over [0, 1]. MATLAB: histeq(I, levels).
struct equalize {
    int levels = 64;  ///< how many different values come out, 2 to 65536

    using is_filter = std::true_type;

    /// @throws invalid_input for levels outside 2 to 65536
    detail::level_map<float> pass(image_view<const float> source) const { return spread(source); }
    detail::level_map<std::uint8_t> pass(image_view<const std::uint8_t> source) const { return spread(source); }

  private:
    template <class Pixel>
    detail::level_map<Pixel> spread(image_view<const Pixel> source) const {
        detail::require_bins("equalize.levels", levels);
        const histogram flat{std::vector<std::uint64_t>(static_cast<std::size_t>(levels), 1)};
        return detail::map_levels<Pixel>(histogram_of(source), flat);
    }
};

/// Gives an image the histogram of a reference, by bins: fast, and as coarse as the bins. MATLAB: imhistmatch(I,
/// reference, bins). The reference is counted once and not kept. Floats become floats, codes of 8 bits codes.
class match_binned {
  public:
    using is_filter = std::true_type;

    /// @throws invalid_input for a reference without a number in it, or bins outside 2 to 65536
    explicit match_binned(image_view<const float> reference, int bins = 64)
        : match_binned(histogram_of(reference, bins)) {}
    explicit match_binned(image_view<const std::uint8_t> reference, int bins = 64)
        : match_binned(histogram_of(reference, bins)) {}

    /// @throws invalid_input for an empty histogram, or bins outside 2 to 65536
    explicit match_binned(histogram wanted) : wanted_(std::move(wanted)) {
        detail::require(wanted_.counts.size() >= 2 && wanted_.counts.size() <= 65536, "wanted.counts.size()",
                        wanted_.counts.size(), "2 to 65536");
        detail::require(wanted_.total() > 0, "pixels in the reference", wanted_.total(), "at least 1");
    }

    detail::level_map<float> pass(image_view<const float> source) const {
        return detail::map_levels<float>(histogram_of(source), wanted_);
    }
    detail::level_map<std::uint8_t> pass(image_view<const std::uint8_t> source) const {
        return detail::map_levels<std::uint8_t>(histogram_of(source), wanted_);
    }

  private:
    histogram wanted_;
};

}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
