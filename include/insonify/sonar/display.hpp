// Filters from intensities to gray values, usually the last step.
//
// Real pictures differ more by their display than by their sonar: amplitude or power at a fixed white, decibels over a
// range below a reference, or a stretch between the picture's own percentiles (P. Blondel. The Handbook of Sidescan
// Sonar, 2009, chapter 4: gain, contrast stretch and dynamic range of displays).
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/image_view.hpp>
#include <insonify/core/numeric.hpp>

#include <algorithm>
#include <concepts>
#include <type_traits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Gray values in [0, 1] by a power law: (intensity / white)^exponent. The default is amplitude, the square root, which
/// most sonars show. NaN is black.
struct display {
    float white = 6;        ///< intensity shown as white, above 0; brighter ones are clamped
    float exponent = 0.5f;  ///< 0.5: amplitude, 1: power; above 0, at most 4

    using is_filter = std::true_type;

    /// @throws invalid_input for a `white` that isn't positive, or an exponent outside its range
    INSONIFY_TAGGED auto pass() const {
        detail::require_positive("display.white", white);
        detail::require(exponent > 0 && exponent <= 4, "display.exponent", exponent, "above 0, at most 4");
        detail::require(numeric::is_finite(1 / white), "display.white", white,
                        "at least 3e-39, so that its inverse is finite");
        return [scale = 1 / white, to = exponent]<std::same_as<float> Pixel>(Pixel intensity, int, int) -> Pixel {
            const float share = intensity * scale;
            if (!(share > 0)) return 0;
            if (share >= 1) return 1;
            if (to == 0.5f) return numeric::square_root(share);
            if (to == 1) return share;
            return static_cast<float>(numeric::pow(static_cast<double>(share), static_cast<double>(to)));
        };
    }
};

/// Gray values by decibels: black at `range` below white, white at `white`, even steps between. NaN, 0 and below are
/// black. Sonars record a dynamic range of 60 to 120 dB; displays show 20 to 50 dB of it.
struct decibel_display {
    float white = 6;   ///< intensity shown as white, above 0
    float range = 40;  ///< decibels from black to white, above 0, at most 400

    using is_filter = std::true_type;

    /// @throws invalid_input for a parameter out of its range
    INSONIFY_TAGGED auto pass() const {
        detail::require_positive("decibel_display.white", white);
        detail::require(range > 0 && range <= 400, "decibel_display.range", range, "above 0, at most 400 dB");
        // 10 log10(e) / range for each natural logarithm
        return [white = static_cast<double>(white),
                step = 4.3429448190325182 / static_cast<double>(range)]<std::same_as<float> Pixel>(Pixel intensity, int,
                                                                                                   int) -> Pixel {
            if (!(intensity > 0)) return 0;
            if (!numeric::is_finite(intensity)) return 1;
            const double gray = 1 + step * numeric::log(static_cast<double>(intensity) / white);
            return gray > 0 ? (gray < 1 ? static_cast<float>(gray) : 1.0f) : 0.0f;
        };
    }
};

/// The scale on which automatic_display is linear.
enum class display_scale { power, amplitude, decibels };

/// A contrast stretch by the picture's own percentiles, like "auto" in survey software: about `black_fraction` of the
/// finite pixels is black, and about `white_fraction` white. The decibel scale takes the percentiles of the positive
/// pixels alone, since shadows and the water column are 0. NaN is black, infinity white.
struct automatic_display {
    display_scale scale = display_scale::amplitude;
    float black_fraction = 0.01f;  ///< fraction of the pixels, 0 to 0.49
    float white_fraction = 0.01f;  ///< fraction of the pixels, 0 to 0.49

    using is_filter = std::true_type;

    /// @throws invalid_input for a parameter out of its range
    INSONIFY_TAGGED auto pass(image_view<const float> picture) const {
        detail::require(
            scale == display_scale::power || scale == display_scale::amplitude || scale == display_scale::decibels,
            "automatic_display.scale", static_cast<int>(scale), "power, amplitude or decibels");
        detail::require_range("automatic_display.black_fraction", black_fraction, 0, 0.49f, "0 to 0.49");
        detail::require_range("automatic_display.white_fraction", white_fraction, 0, 0.49f, "0 to 0.49");
        detail::dynamic_array<float> values;
        values.reserve(picture.size());
        for (int y = 0; y < picture.height(); ++y)
            for (const float v : picture.row(y))
                if (numeric::is_finite(v) && (v > 0 || scale != display_scale::decibels)) values.push_back(v);
        const auto quantile = [&](double share) {
            const auto at =
                values.begin() + numeric::floor_to_int(share * static_cast<double>(values.size() - 1) + 0.5);
            std::nth_element(values.begin(), at, values.end());
            return measure(static_cast<double>(*at), scale);
        };
        double low = 0, high = 1;
        if (!values.empty())
            low = quantile(static_cast<double>(black_fraction)),
            high = quantile(1 - static_cast<double>(white_fraction));
        return [low, step = high > low ? 1 / (high - low) : 0.0, as = scale]<std::same_as<float> Pixel>(
                   Pixel intensity, int, int) -> Pixel {
            const double above = measure(static_cast<double>(intensity), as) - low;
            // If both percentiles are equal, brighter pixels are white and all others black.
            const double gray = step > 0 ? above * step : above > 0 ? 1.0 : 0.0;
            return gray > 0 ? (gray < 1 ? static_cast<float>(gray) : 1.0f) : 0.0f;
        };
    }

  private:
    /// Zero intensity counts as -460 dB and infinite intensity as 390 dB, beyond all positive and finite floats.
    INSONIFY_TAGGED static double measure(double intensity, display_scale as) {
        if (!(intensity > 0)) intensity = as == display_scale::decibels ? 1e-46 : 0.0;
        if (intensity > 1e39) intensity = 1e39;
        if (as == display_scale::power) return intensity;
        if (as == display_scale::amplitude) return numeric::square_root(intensity);
        return 4.3429448190325182 * numeric::log(intensity);
    }
};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
