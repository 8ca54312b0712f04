// Histogram matching by exact ranks: an image takes the distribution of a reference, without bins.
//
// Based on: Rafael C. Gonzalez, Richard E. Woods. Digital Image Processing, section 3.3 (histogram specification), with
// the rule of scikit-image's match_histograms: the share of pixels up to a value, looked up in the reference's shares
// with linear interpolation between values that are present.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/detail/portable.hpp>
#include <insonify/core/detail/radix_sort.hpp>
#include <insonify/core/image.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/core/quantize.hpp>
#include <insonify/filter/histogram.hpp>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// The distinct values of an image in rising order, and how many pixels have at most that value.
struct distribution {
    std::vector<float> values;
    std::vector<std::uint64_t> cumulative;

    INSONIFY_MEMBER std::uint64_t total() const { return cumulative.empty() ? 0 : cumulative.back(); }
};

inline namespace INSONIFY_ONCE {

/// Distribution of the finite pixels; others are skipped.
INSONIFY_FUNCTION distribution distribution_of(image_view<const float> source);

#if INSONIFY_BODIES
INSONIFY_FUNCTION distribution distribution_of(image_view<const float> source) {
    detail::dynamic_array<std::uint32_t> keys;
    keys.reserve(source.size());
    for (int y = 0; y < source.height(); ++y) {
        for (const float pixel : source.row(y)) {
            // Adding 0 makes one value of both zeros.
            if (numeric::is_finite(pixel)) keys.push_back(detail::ordered_bits(pixel + 0.0f));
        }
    }
    detail::radix_sort(keys);
    distribution result;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (i + 1 < keys.size() && keys[i + 1] == keys[i]) continue;
        result.values.push_back(detail::from_ordered_bits(keys[i]));
        result.cumulative.push_back(i + 1);
    }
    return result;
}
#endif

}  // namespace INSONIFY_ONCE

inline namespace INSONIFY_FLAGS {

/// Distribution of codes; values are code / 255 or code / 65535.
template <class Viewed, executor_argument E = serial_executor>
    requires(pixel_code<std::remove_const_t<Viewed>>)
distribution distribution_of(image_view<Viewed> source, E&& ex = {}) {
    using Code = std::remove_const_t<Viewed>;
    const histogram codes = histogram_of(source, (std::numeric_limits<Code>::max)() + 1, ex);
    distribution result;
    std::uint64_t up_to = 0;
    for (std::size_t code = 0; code < codes.counts.size(); ++code) {
        if (codes.counts[code] == 0) continue;
        result.values.push_back(dequantize(static_cast<Code>(code)));
        result.cumulative.push_back(up_to += codes.counts[code]);
    }
    return result;
}
/// The same for an image.
template <countable_pixel Pixel>
distribution distribution_of(const image<Pixel>& source) {
    return distribution_of(source.view());
}

}  // namespace INSONIFY_FLAGS

namespace detail::inline INSONIFY_FLAGS {

/// The value of `reference` at the rank of each value of `source`.
inline dynamic_array<float> values_at_ranks(const distribution& source, const distribution& reference) {
    const auto total = static_cast<double>(source.total());
    const auto reference_total = static_cast<double>(reference.total());
    const auto share = [&](std::size_t i) { return static_cast<double>(reference.cumulative[i]) / reference_total; };
    dynamic_array<float> result(source.values.size());
    std::size_t above = 0;
    for (std::size_t i = 0; i < result.size(); ++i) {
        const double rank = static_cast<double>(source.cumulative[i]) / total;
        // Galloping search for the first share that is not less, starting at the last one found.
        std::size_t step = 1, last = reference.values.size() - 1;
        while (above + step < last && share(above + step) < rank) above += std::exchange(step, 2 * step);
        last = (std::min)(last, above + step);
        while (above < last) {
            const std::size_t middle = above + (last - above) / 2;
            if (share(middle) < rank)
                above = middle + 1;
            else
                last = middle;
        }
        const auto high = static_cast<double>(reference.values[above]);
        if (above == 0 || share(above) == rank) {
            result[i] = static_cast<float>(high);
        } else {
            const auto low = static_cast<double>(reference.values[above - 1]);
            const double slope = (high - low) / (share(above) - share(above - 1));
            result[i] = static_cast<float>((std::min)(low + slope * (rank - share(above - 1)), high));
        }
    }
    return result;
}

/// Replaces each value by the reference value of the same rank. A uniform grid of buckets over the values narrows the
/// binary search.
class rank_pass {
  public:
    rank_pass(distribution source, const distribution& reference) {
        auto made = std::make_shared<table>();
        if (!source.values.empty()) made->ranked = values_at_ranks(source, reference);
        made->values = std::move(source.values);
        if (made->values.size() > 1) {
            const auto first = static_cast<double>(made->values.front());
            made->scale = static_cast<double>(made->values.size()) / (static_cast<double>(made->values.back()) - first);
            made->starts.assign(made->values.size() + 1, 0);
            for (const float value : made->values) ++made->starts[made->bucket(value) + 1];
            for (std::size_t i = 1; i < made->starts.size(); ++i) made->starts[i] += made->starts[i - 1];
        }
        table_ = std::move(made);
    }

    template <std::same_as<float> Pixel>
    Pixel operator()(Pixel pixel) const {
        const table& t = *table_;
        if (!(pixel == pixel) || t.values.empty()) return pixel;
        if (pixel <= t.values.front()) return t.ranked.front();
        if (pixel >= t.values.back()) return t.ranked.back();
        const std::size_t bucket = t.bucket(pixel);
        const auto found =
            std::lower_bound(t.values.data() + t.starts[bucket], t.values.data() + t.starts[bucket + 1], pixel);
        return t.ranked[static_cast<std::size_t>(found - t.values.data())];
    }

  private:
    struct table {
        std::vector<float> values;            // of the source, rising
        dynamic_array<float> ranked;          // the reference's values at their ranks
        dynamic_array<std::uint32_t> starts;  // where each bucket of values begins
        double scale = 0;

        std::size_t bucket(float value) const {
            const double position = (static_cast<double>(value) - static_cast<double>(values.front())) * scale;
            return (std::min)(static_cast<std::size_t>(position), values.size() - 1);
        }
    };
    std::shared_ptr<const table> table_;  // passes are copied; the table isn't
};

}  // namespace detail::inline INSONIFY_FLAGS

/// Gives an image the distribution of a reference, by exact ranks. The reference's distribution is computed once and
/// shared by copies of the filter. Floats become floats: NaN stays NaN, infinities become the lowest or the highest
/// rank's value. Codes become the codes nearest to those floats. An image without a finite pixel passes through.
///
/// A constant image becomes the reference's largest value, as in scikit-image: all its pixels have the highest rank.
///
/// Floats are sorted. `image | to_uint16 | match | to_float` counts instead and is faster; values closer than 1 / 65535
/// then share a rank.
class match_histogram {
  public:
    using is_filter = std::true_type;

    /// @throws invalid_input for a reference without a finite pixel
    template <class Pixel>
        requires(countable_pixel<std::remove_const_t<Pixel>>)
    INSONIFY_MEMBER explicit match_histogram(image_view<Pixel> reference)
        : match_histogram(distribution_of(reference)) {}
    template <countable_pixel Pixel>
    INSONIFY_MEMBER explicit match_histogram(const image<Pixel>& reference) : match_histogram(reference.view()) {}

    /// @throws invalid_input for an empty distribution, values and cumulative of different sizes, values that are
    /// not finite, or either not strictly rising
    INSONIFY_TAGGED explicit match_histogram(distribution reference) {
        detail::require(reference.total() > 0, "number of finite pixels in the reference", reference.total(),
                        "1 or more");
        detail::require_equal("reference.values.size()", reference.values.size(), reference.cumulative.size(),
                              "that of cumulative");
        for (std::size_t i = 0; i < reference.values.size(); ++i) {
            const float value = reference.values[i];
            detail::require(numeric::is_finite(value) && (i == 0 || reference.values[i - 1] < value),
                            "reference.values", value, "finite values, each above the one before");
            const std::uint64_t up_to = reference.cumulative[i];
            detail::require(up_to > (i == 0 ? 0 : reference.cumulative[i - 1]), "reference.cumulative", up_to,
                            "numbers of pixels, each above the one before");
        }
        reference_ = std::make_shared<const distribution>(std::move(reference));
    }
    /// Moving copies: a filter that was moved from still works.
    INSONIFY_MEMBER match_histogram(const match_histogram&) = default;
    INSONIFY_MEMBER match_histogram& operator=(const match_histogram&) = default;

    template <std::same_as<float> Pixel>
    INSONIFY_MEMBER detail::rank_pass pass(image_view<const Pixel> source) const {
        return {distribution_of(source), *reference_};
    }
    template <pixel_code Code, executor_argument E = serial_executor>
    INSONIFY_TAGGED detail::level_map<Code> pass(image_view<const Code> source, E&& ex = {}) const {
        const distribution codes = distribution_of(source, ex);
        const detail::dynamic_array<float> ranked =
            codes.values.empty() ? detail::dynamic_array<float>{} : detail::values_at_ranks(codes, *reference_);
        detail::dynamic_array<Code> values(static_cast<std::size_t>((std::numeric_limits<Code>::max)()) + 1);
        for (std::size_t i = 0; i < ranked.size(); ++i)
            values[quantize<Code>(codes.values[i])] = quantize<Code>(ranked[i]);
        return detail::level_map<Code>(std::move(values));
    }

  private:
    std::shared_ptr<const distribution> reference_;
};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
