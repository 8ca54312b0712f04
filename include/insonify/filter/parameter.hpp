// Parameters of filters: a number for all pixels, for each pixel or for each seabed type; correlation lengths of noise;
// the meaning of pixel values.
#pragma once

#include <insonify/core/image_view.hpp>
#include <insonify/filter/concept.hpp>

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

/// @throws invalid_input for a map of another size than the area
inline void check_size(const std::string& name, int width, int height, const pixel_area& area) {
    require_equal("width of the " + name, width, area.width, "that of the image");
    require_equal("height of the " + name, height, area.height, "that of the image");
}

}  // namespace detail::inline INSONIFY_FLAGS

/// One number for all pixels, or a map of the image's size. Maps are read when the filter runs and must exist until
/// then.
///
///     in::speckle{.variance = 0.05f}
///     in::speckle{.variance = variances.view()}
///     in::speckle{.variance = {labels.seabed, {0.02f, 0.05f, 0.05f, 0.1f}}}   // by seabed::type
class parameter {
  public:
    /// Moving copies: a parameter that was moved from still has its values.
    INSONIFY_MEMBER parameter(const parameter&) = default;
    INSONIFY_MEMBER parameter& operator=(const parameter&) = default;

    template <std::convertible_to<float> Number>
        requires(std::is_arithmetic_v<Number>)
    INSONIFY_MEMBER parameter(Number value) : values_{static_cast<float>(value)} {}

    /// A number for each pixel.
    INSONIFY_MEMBER parameter(image_view<const float> map) : map_(map) {}
    INSONIFY_MEMBER parameter(image_view<float> map) : map_(map) {}

    /// `values[type]` for a pixel of that type; types past the end take the last value.
    /// @throws invalid_input for no values
    INSONIFY_MEMBER parameter(image_view<const std::uint8_t> types, std::vector<float> values)
        : values_(std::move(values)), types_(types), by_type_(true) {
        detail::require(!values_.empty(), "number of values by type", values_.size(), "at least 1");
    }

    INSONIFY_MEMBER bool is_constant() const { return !by_type_ && !values_.empty(); }

    /// The value that all pixels share. @pre is_constant()
    INSONIFY_MEMBER float value() const { return values_.front(); }

    /// Sets the image's origin and size before the first call of `row`.
    /// @throws invalid_input for a map of another size
    INSONIFY_TAGGED void prepare(const std::string& name, const pixel_area& area) {
        x_ = area.x, y_ = area.y;
        if (by_type_)
            detail::check_size("map for " + name, types_.width(), types_.height(), area);
        else if (!is_constant())
            detail::check_size("map for " + name, map_.width(), map_.height(), area);
    }

    /// Writes the numbers of `count` pixels of a row, the first at (x, y), to `buffer`.
    INSONIFY_TAGGED void row(float* buffer, int count, int x, int y) const {
        if (by_type_) {
            const std::uint8_t* const type = types_.row(y - y_).data() + (x - x_);
            for (int i = 0; i < count; ++i) buffer[i] = values_[(std::min)(std::size_t{type[i]}, values_.size() - 1)];
        } else if (values_.empty()) {
            std::copy_n(map_.row(y - y_).data() + (x - x_), count, buffer);
        } else {
            std::fill_n(buffer, count, values_.front());
        }
    }

    /// @throws invalid_input for a number that isn't `allowed`
    template <std::predicate<float> Allowed>
    INSONIFY_TAGGED void check(std::string_view name, const Allowed& allowed, std::string_view expected) const {
        for (const float value : values_) detail::require(allowed(value), name, value, expected);
        for (int y = 0; y < map_.height(); ++y)
            for (const float value : map_.row(y)) detail::require(allowed(value), name, value, expected);
    }

  private:
    std::vector<float> values_;  // one for all, or one for each type
    image_view<const float> map_;
    image_view<const std::uint8_t> types_;
    bool by_type_ = false;
    int x_ = 0, y_ = 0;
};

/// Distance in pixels at which the noise's autocorrelation has fallen to 1 / e; for echo noise, that of the intensity.
/// 0: white noise. Between lengths of 0 and 1 the correlation of adjacent pixels rises from 0 to 1 / e.
struct correlation_length {
    float x = 0, y = 0;  ///< 0 to 16
};

/// Meaning of pixel values. An amplitude is the square root of an intensity.
enum class echo { amplitude, intensity };

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
