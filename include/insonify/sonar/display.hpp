// From intensities to gray values: the last step, and the only one that isn't linear.
#pragma once

#include <insonify/core/numeric.hpp>

#include <concepts>
#include <type_traits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI {

/// A filter that makes gray values in [0, 1] of intensities: their square root, the amplitude, is what sonars show.
struct display {
    float white = 6;  ///< the intensity that is white, above 0; brighter ones are cut

    using is_filter = std::true_type;

    /// @throws invalid_input for a `white` that isn't positive
    auto pass() const {
        detail::require(white > 0 && numeric::is_finite(white), "display.white", white, "above 0");
        return [scale = 1 / white]<std::same_as<float> Pixel>(Pixel intensity, int, int) -> Pixel {
            const float share = intensity * scale;
            return share > 0 ? (share < 1 ? numeric::square_root(share) : 1.0f) : 0.0f;
        };
    }
};

}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
