// Histograms over equally spaced levels, and MATLAB's two histogram filters: equalization and matching.
//
// NaN is not counted and stays NaN. By MATLAB's rule, a constant image becomes the level at which the target's
// cumulative fraction reaches one half, or the target's highest occupied level if the image is at level 0 or the last.
//
// Based on: MathWorks. Image Processing Toolbox, imhist, histeq, imhistmatch (64 bins, 256 source levels, 65536 for
// codes of 16 bits).
#pragma once

#include <insonify/core/numeric.hpp>
#include <insonify/filter/detail/level_map.hpp>

#include <concepts>
#include <cstdint>
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
        detail::require_equal("bin count of the added histogram", other.counts.size(), counts.size(),
                              "that of the sum");
        for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += other.counts[i];
        return *this;
    }

    friend bool operator==(const histogram&, const histogram&) = default;
};

namespace detail::inline INSONIFY_FLAGS {

inline void require_bins(const char* name, int bins) {
    require_range(name, bins, 2, 65536, "2 to 65536");
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// MATLAB's imhist. Pixels are floats in [0, 1], of which NaN is not counted, or codes that mean code / 255 or / 65535.
/// @throws invalid_input for bins outside 2 to 65536
template <class Viewed, executor_argument E = serial_executor>
    requires(countable_pixel<std::remove_const_t<Viewed>>)
histogram histogram_of(image_view<Viewed> pixels, int bins = 256, E&& ex = {}) {
    using Pixel = std::remove_const_t<Viewed>;
    detail::require_bins("bins", bins);
    const image_view<const Pixel> source = pixels;
    constexpr bool narrow = std::same_as<Pixel, std::uint8_t>, wide = std::same_as<Pixel, std::uint16_t>;
    if constexpr (!wide) {
        if (bins == 256)
            return {detail::count_bands(source, bins, ex, [] { return detail::code_counter<std::uint8_t>(); })};
    }
    if constexpr (!narrow) {
        if (bins == 65536)
            return {detail::count_bands(source, bins, ex, [] { return detail::code_counter<std::uint16_t>(); })};
    }
    return {detail::count_bands(source, bins, ex, [bins] { return detail::bin_counter<Pixel>(bins); })};
}
/// The same for an image.
template <countable_pixel Pixel, executor_argument E = serial_executor>
histogram histogram_of(const image<Pixel>& source, int bins = 256, E&& ex = {}) {
    return histogram_of(source.view(), bins, ex);
}

}  // namespace INSONIFY_FLAGS

/// Histogram equalization: spreads the values evenly over [0, 1]. MATLAB: histeq(I, levels).
struct equalize {
    int levels = 64;  ///< number of distinct values in the result, 2 to 65536

    using is_filter = std::true_type;

    /// @throws invalid_input for levels outside 2 to 65536
    template <countable_pixel Pixel, executor_argument E = serial_executor>
    INSONIFY_MEMBER detail::level_map<Pixel> pass(image_view<const Pixel> source, E&& ex = {}) const {
        detail::require_bins("equalize.levels", levels);
        const std::vector<std::uint64_t> flat(static_cast<std::size_t>(levels), 1);
        return detail::map_levels<Pixel>(histogram_of(source, detail::source_levels<Pixel>, ex).counts, flat);
    }
};

/// Gives an image the histogram of a reference, by bins: fast, and as coarse as the bins. MATLAB: imhistmatch(I,
/// reference, bins). The reference is counted once and not kept; a histogram of one or many images is taken as well.
/// Floats become floats, codes become codes.
class match_binned {
  public:
    using is_filter = std::true_type;

    /// @throws invalid_input for a reference that is empty or all NaN, or bins outside 2 to 65536
    template <class Pixel>
        requires(countable_pixel<std::remove_const_t<Pixel>>)
    INSONIFY_MEMBER explicit match_binned(image_view<Pixel> reference, int bins = 64)
        : match_binned(histogram_of(reference, bins)) {}
    template <countable_pixel Pixel>
    INSONIFY_MEMBER explicit match_binned(const image<Pixel>& reference, int bins = 64)
        : match_binned(reference.view(), bins) {}

    /// @throws invalid_input for an empty histogram, or bins outside 2 to 65536
    INSONIFY_MEMBER explicit match_binned(histogram wanted) : wanted_(std::move(wanted)) {
        detail::require(wanted_.counts.size() >= 2 && wanted_.counts.size() <= 65536, "number of bins of match_binned",
                        wanted_.counts.size(), "2 to 65536");
        detail::require(wanted_.total() > 0, "number of pixels in the reference", wanted_.total(), "at least 1");
    }
    /// Moving copies: a filter that was moved from still works.
    INSONIFY_MEMBER match_binned(const match_binned&) = default;
    INSONIFY_MEMBER match_binned& operator=(const match_binned&) = default;

    template <countable_pixel Pixel, executor_argument E = serial_executor>
    INSONIFY_MEMBER detail::level_map<Pixel> pass(image_view<const Pixel> source, E&& ex = {}) const {
        return detail::map_levels<Pixel>(histogram_of(source, detail::source_levels<Pixel>, ex).counts, wanted_.counts);
    }

  private:
    histogram wanted_;
};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
