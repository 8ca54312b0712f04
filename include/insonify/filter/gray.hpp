// Filter from colour to gray, as a weighted sum of the channels.
#pragma once

#include <insonify/core/image.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/core/quantize.hpp>

#include <concepts>
#include <type_traits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Weights of red, green and blue.
struct gray_weights {
    double r, g, b;
};

/// MATLAB's rgb2gray: the luma row of the inverse of its YIQ matrix.
inline constexpr gray_weights matlab_weights{0.298936021293775, 0.587043074451121, 0.114020904255103};
/// Octave's rgb2gray, the same to six digits.
inline constexpr gray_weights octave_weights{0.298936, 0.587043, 0.114021};
/// The same to four digits, as papers quote them; they add up to 0.9999.
inline constexpr gray_weights paper_weights{0.2989, 0.5870, 0.1140};
/// ITU-R BT.601, three digits: OpenCV's weights.
inline constexpr gray_weights rec601_weights{0.299, 0.587, 0.114};
/// ITU-R BT.709 as scikit-image rounds it; not a drop-in for the others.
inline constexpr gray_weights rec709_weights{0.2125, 0.7154, 0.0721};

/// rgb8 -> uint8 and rgb<uint16_t> -> uint16 to the nearest, ties up; rgb<float> -> float.
struct to_gray {
    gray_weights weights = matlab_weights;

    using is_filter = std::true_type;

    /// The function of a pixel that `to_gray` applies.
    struct weighted_sum {
        gray_weights weights;
        template <pixel_code Channel>
        INSONIFY_MEMBER Channel operator()(const rgb<Channel>& color) const {
            return static_cast<Channel>(weights.r * color.r + weights.g * color.g + weights.b * color.b + 0.5);
        }
        template <std::same_as<float> Channel>
        INSONIFY_MEMBER Channel operator()(const rgb<Channel>& color) const {
            const double r = static_cast<double>(color.r), g = static_cast<double>(color.g),
                         b = static_cast<double>(color.b);
            return static_cast<Channel>(weights.r * r + weights.g * g + weights.b * b);
        }
    };

    /// @throws invalid_input for a weight that is not in [0, 1], or a sum above 1 (by more than rounding)
    INSONIFY_TAGGED weighted_sum pass() const {
        for (const double weight : {weights.r, weights.g, weights.b})
            detail::require_range("to_gray.weights", weight, 0, 1, "in [0, 1]");
        const double sum = weights.r + weights.g + weights.b;
        detail::require(sum <= 1 + 1e-9, "the sum of to_gray.weights", sum, "at most 1");
        return {weights};
    }
};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
