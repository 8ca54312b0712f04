// A parameter of a filter: one number, a number for each pixel, or a number for each type of seabed.
#pragma once

#include <insonify/core/image_view.hpp>
#include <insonify/core/numeric.hpp>

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI {

/// One number for all pixels, or a map of them. Views are looked at when the filter runs, and not kept alive.
///
///     in::speckle{.variance = 0.05f}
///     in::speckle{.variance = variances.view()}
///     in::speckle{.variance = {labels.seabed, {0.02f, 0.05f, 0.05f, 0.1f}}}   // by seabed::type
class parameter {
  public:
    template <std::convertible_to<float> Number>
        requires(std::is_arithmetic_v<Number>)
    parameter(Number value) : values_{static_cast<float>(value)} {}

    /// A number for each pixel.
    parameter(image_view<const float> map) : map_(map) {}
    parameter(image_view<float> map) : map_(map) {}

    /// `values[type]` for a pixel of that type, the last of them for types beyond.
    /// @throws invalid_input for no values
    parameter(image_view<const std::uint8_t> types, std::vector<float> values)
        : values_(std::move(values)), types_(types), by_type_(true) {
        detail::require(!values_.empty(), "values of a parameter by type", values_.size(), "at least 1");
    }

    bool is_constant() const { return !by_type_ && !values_.empty(); }

    /// The number of all pixels. @pre is_constant()
    float value() const { return values_.front(); }

    /// The numbers of `count` pixels of a row, in `buffer`.
    void row(float* buffer, int count, int x, int y) const {
        if (by_type_) {
            const std::uint8_t* const type = types_.row(y).data() + x;
            for (int i = 0; i < count; ++i) buffer[i] = values_[(std::min)(std::size_t{type[i]}, values_.size() - 1)];
        } else if (values_.empty()) {
            std::copy_n(map_.row(y).data() + x, count, buffer);
        } else {
            std::fill_n(buffer, count, values_.front());
        }
    }

    /// @throws invalid_input for a number that isn't `allowed`
    template <std::predicate<float> Allowed>
    void check(std::string_view name, const Allowed& allowed, std::string_view expected) const {
        for (const float value : values_) detail::require(allowed(value), name, value, expected);
        for (int y = 0; y < map_.height(); ++y)
            for (const float value : map_.row(y)) detail::require(allowed(value), name, value, expected);
    }

    /// @throws invalid_input unless a map covers an image of that size
    void check_size(std::string_view name, int width, int height) const {
        if (is_constant()) return;
        const int own_width = by_type_ ? types_.width() : map_.width();
        const int own_height = by_type_ ? types_.height() : map_.height();
        detail::require(own_width == width, std::string(name) + ": width of the map", own_width, "that of the image");
        detail::require(own_height == height, std::string(name) + ": height of the map", own_height,
                        "that of the image");
    }

  private:
    std::vector<float> values_;  // one for all, or one for each type
    image_view<const float> map_;
    image_view<const std::uint8_t> types_;
    bool by_type_ = false;
};

}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
