// Masked filters: `image | where(shadow_mask(labels, 1), match)` measures and changes only the pixels of the mask.
#pragma once

#include <insonify/filter/parameter.hpp>
#include <insonify/filter/pipe.hpp>

#include <memory>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

/// Applies a pass where the mask is not 0 and copies the other pixels. Whole rows go through the pass; its results
/// outside the mask are discarded.
template <class Pass>
class masked_pass {
  public:
    masked_pass(Pass pass, image_view<const std::uint8_t> mask) : pass_(std::move(pass)), mask_(mask) {}

    template <class Pixel>
    Pixel operator()(const Pixel& pixel, int x, int y) {
        return mask_(x - x_, y - y_) != 0 ? call_pixel(pass_, pixel, x, y) : pixel;
    }
    template <class Pixel>
    void row(const Pixel* from, Pixel* to, int count, int x, int y) {
        Pixel changed[run_length];
        call_row(pass_, from, changed, count, x, y);
        const std::uint8_t* const chosen = mask_.row(y - y_).data() + (x - x_);
        for (int i = 0; i < count; ++i) to[i] = chosen[i] != 0 ? changed[i] : from[i];
    }
    void prepare(const pixel_area& area) {
        check_size("mask", mask_.width(), mask_.height(), area);
        x_ = area.x, y_ = area.y;
        prepare_pass(pass_, area);
    }
    int rows_above() const { return detail::rows_above(pass_); }

  private:
    Pass pass_;
    image_view<const std::uint8_t> mask_;
    int x_ = 0, y_ = 0;
};

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// The pixels where the mask is not 0, as one row. Use it as a reference for `histogram_of`, `distribution_of` and the
/// matching filters, to measure part of an image.
/// @throws invalid_input for a mask of another size, or of more than 2^30 such pixels
template <class Pixel>
image<std::remove_const_t<Pixel>> pixels_where(image_view<const std::uint8_t> mask, image_view<Pixel> source) {
    detail::check_size("mask", mask.width(), mask.height(), {0, 0, source.width(), source.height()});
    std::size_t count = 0;
    for (int y = 0; y < mask.height(); ++y)
        for (const std::uint8_t chosen : mask.row(y)) count += chosen != 0 ? 1u : 0u;
    detail::require(count <= std::size_t{1} << 30, "number of pixels where the mask is not 0", count, "at most 2^30");
    image<std::remove_const_t<Pixel>> result(static_cast<int>(count), count > 0 ? 1 : 0);
    auto* next = result.pixels().data();
    for (int y = 0; y < mask.height(); ++y)
        for (int x = 0; x < mask.width(); ++x)
            if (mask(x, y) != 0) *next++ = source(x, y);
    return result;
}
/// The same for an image.
template <class Pixel>
image<Pixel> pixels_where(image_view<const std::uint8_t> mask, const image<Pixel>& source) {
    return pixels_where(mask, source.view());
}

/// Made by `where(mask, filter)`.
template <class F>
struct where_filter {
    image_view<const std::uint8_t> mask;
    F filter;
    std::shared_ptr<const image<std::uint8_t>> kept{};  ///< the mask, if it was a temporary

    using is_filter = std::true_type;

    /// @throws invalid_input for a mask of another size, and as the filter
    template <class Pixel, executor_argument E = serial_executor>
        requires((measured_filter<F, Pixel> ||
                  pixel_filter<F, Pixel>)&&std::same_as<typename detail::filter_result<F, Pixel>::type, Pixel>)
    auto pass(image_view<const Pixel> source, E&& ex = {}) const {
        image<Pixel> chosen;
        if constexpr (measured_filter<F, Pixel>) chosen = pixels_where(mask, source);
        auto inner = detail::make_pass(filter, image_view<const Pixel>(chosen), ex);
        return detail::masked_pass<decltype(inner)>(std::move(inner), mask);
    }
};

}  // namespace INSONIFY_FLAGS

namespace detail::inline INSONIFY_FLAGS {

using kept_mask = std::shared_ptr<const image<std::uint8_t>>;

template <class F>
where_filter<F> masked(image_view<const std::uint8_t> mask, const kept_mask& kept, F filter) {
    return {mask, std::move(filter), kept};
}
/// Each stage of a chain.
template <class... Stages>
filter_chain<where_filter<Stages>...> masked(image_view<const std::uint8_t> mask, const kept_mask& kept,
                                             filter_chain<Stages...> chain) {
    return std::apply(
        [&](Stages&... stages) {
            return filter_chain<where_filter<Stages>...>{{{mask, std::move(stages), kept}...}};
        },
        chain.stages);
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Applies a filter, or each stage of a chain, where `mask` is not 0; the other pixels are unchanged. Measured filters
/// measure the masked pixels alone, so their masks don't nest: pass one mask that combines them. A mask of zeros leaves
/// the image unchanged.
///
///     image | where(is_seabed, match_histogram(pixels_where(reference_mask, reference)))
///
/// @param mask    of the image's size; its pixels must exist until the filter has run
/// @param filter  of pixels or measured, not of images, with results of the same pixel type
template <class Filter>
auto where(image_view<const std::uint8_t> mask, Filter&& filter) {
    return detail::masked(mask, nullptr, std::forward<Filter>(filter));
}
/// The same with a mask that is a temporary, which the filter keeps.
template <class Filter>
auto where(image<std::uint8_t>&& mask, Filter&& filter) {
    const auto kept = std::make_shared<const image<std::uint8_t>>(std::move(mask));
    return detail::masked(kept->view(), kept, std::forward<Filter>(filter));
}
/// The same with a constant temporary, which is copied.
template <class Filter>
auto where(const image<std::uint8_t>&& mask, Filter&& filter) {
    return where(image<std::uint8_t>(mask), std::forward<Filter>(filter));
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
