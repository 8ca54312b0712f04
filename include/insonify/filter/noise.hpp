// Noise filters of sensors and channels: gaussian, speckle (uniform or gaussian), salt and pepper.
//
// As in MATLAB's imnoise, the image is clipped to [0, 1] before and after, codes of 8 and 16 bits stand for code / 255
// and code / 65535, and colours get noise in each channel. NaN (no data) stays NaN.
//
// The noise of a pixel is a function of (seed, kind of noise, frame, channel, x, y) and nothing else. Images of a set
// differ by `.frame`; two filters of one kind in one chain must differ by `.seed`.
//
// Based on: George E. P. Box, Mervin E. Muller. A Note on the Generation of Random Normal Deviates. Annals of
// Mathematical Statistics 29, 1958.
#pragma once

#include <insonify/filter/detail/correlated.hpp>
#include <insonify/filter/detail/noise_pass.hpp>
#include <insonify/filter/parameter.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

inline void check_variance(const char* name, const parameter& variance) {
    variance.check(
        name, [](float v) { return numeric::is_finite(v) && v >= 0; }, "finite and at least 0");
}

/// Standard deviations of a variance parameter, run by run.
class deviation {
  public:
    /// @param factor  by which the variance is multiplied first
    deviation(const char* name, parameter variance, double factor)
        : name_(name), variance_(std::move(variance)), factor_(factor) {
        if (variance_.is_constant()) std::fill_n(values_, run_length, root(variance_.value()));
    }

    const float* row(const noise_run& run) {
        if (!variance_.is_constant()) {
            variance_.row(values_, run.count, run.x, run.y);
            for (int i = 0; i < run.count; ++i) values_[i] = root(values_[i]);
        }
        return values_;
    }
    void prepare(const pixel_area& area) { variance_.prepare(name_, area); }

  private:
    float root(float variance) const {
        return static_cast<float>(numeric::square_root(factor_ * static_cast<double>(variance)));
    }

    const char* name_;
    parameter variance_;
    double factor_;
    float values_[run_length] = {};
};

struct added_draw {
    float mean;

    template <int N>
    INSONIFY_INLINE void apply(lanes<float, N>& value, const lanes<float, N>& draw,
                               const lanes<float, N>& scale) const {
        value = value + (mean + scale * draw);
    }
};
struct multiplied_draw {
    template <int N>
    INSONIFY_INLINE void apply(lanes<float, N>& value, const lanes<float, N>& draw,
                               const lanes<float, N>& scale) const {
        value = value + scale * draw * value;
    }
};

/// A rule applied with one draw per pixel, scaled by the deviation.
template <class Draws, class Rule>
class scaled_law {
  public:
    /// @param draws  independent_draws or field_draws
    scaled_law(Rule rule, Draws draws, deviation scale)
        : rule_(rule), draws_(std::move(draws)), scale_(std::move(scale)) {}

    void row(const float* from, float* to, const noise_run& run) {
        draw_buffer buffer;
        apply_rule(rule_, from, draws_.row(buffer, 0, run), scale_.row(run), to, run.count);
    }
    void prepare(const pixel_area& area) { scale_.prepare(area); }
    int rows_above() const { return detail::rows_above(draws_); }

  private:
    Rule rule_;
    Draws draws_;
    deviation scale_;
};

/// Replaces a pixel where p, uniform in (0, 1], is at most the density: by black below half the density, else by white.
struct struck_pixel {
    template <int N>
    INSONIFY_INLINE void apply(lanes<float, N>& value, const lanes<float, N>& p, const lanes<float, N>& density) const {
        using floats = lanes<float, N>;
        using flags = lanes<std::int32_t, N>;
        const floats struck = p + p < density ? floats{} : floats{} + 1.0f;
        value = (flags(p <= density) & flags(value == value)) != 0 ? struck : value;
    }
};

class salt_law {
  public:
    salt_law(noise_key noise, parameter density) : noise_(noise), density_(std::move(density)) {}

    void row(const float* from, float* to, const noise_run& run) const {
        float density[run_length];
        density_.row(density, run.count, run.x, run.y);
        draw_buffer buffer;
        const float* const p = white_draws<unit_draws>(buffer, noise_, 0, run);
        apply_rule(struck_pixel{}, from, p, density, to, run.count);
    }
    void prepare(const pixel_area& area) { density_.prepare("salt_and_pepper.density", area); }

  private:
    noise_key noise_;
    parameter density_;
};

}  // namespace detail::inline INSONIFY_FLAGS

/// Adds normal noise: J = I + N(mean, variance). MATLAB, Octave: imnoise(I, "gaussian", mean, variance); scikit-image:
/// random_noise(I, "gaussian").
struct gaussian {
    float mean = 0;
    parameter variance = 0.01f;
    correlation_length correlation{};  ///< of the noise
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for a mean that is not finite, a variance that is negative or not finite, or a correlation
    ///         length outside 0 to 16; on application, for a map of another size than the image
    INSONIFY_TAGGED auto pass() const {
        detail::require(numeric::is_finite(mean), "gaussian.mean", mean, "finite");
        detail::check_variance("gaussian.variance", variance);
        detail::require_correlation("gaussian.correlation", correlation);
        return detail::noise_pass(detail::scaled_law<detail::normal_fields, detail::added_draw>(
            {mean}, {{seed, detail::noise_stream::gaussian, frame}, correlation}, {"gaussian.variance", variance, 1}));
    }
};

/// Uniform multiplicative noise: J = I + n I, n uniform in +-sqrt(3 variance). MATLAB: imnoise(I, "speckle", variance);
/// Octave and scikit-image draw n from the normal distribution, which is `gaussian_speckle` here.
struct speckle {
    parameter variance = 0.05f;
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for a variance that is negative or not finite; on application, for a map of another size
    ///         than the image
    INSONIFY_MEMBER auto pass() const {
        detail::check_variance("speckle.variance", variance);
        using draws = detail::independent_draws<detail::symmetric_draws>;
        return detail::noise_pass(detail::scaled_law<draws, detail::multiplied_draw>(
            {}, {{seed, detail::noise_stream::speckle, frame}}, {"speckle.variance", variance, 3}));
    }
};

/// Normal multiplicative noise: J = I + n I, n from N(0, variance). Octave: imnoise(I, "speckle", variance) with 0.04;
/// scikit-image: random_noise(I, "speckle", var=variance) with 0.01.
struct gaussian_speckle {
    parameter variance = 0.04f;
    correlation_length correlation{};  ///< of the noise
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input as `gaussian`
    INSONIFY_TAGGED auto pass() const {
        detail::check_variance("gaussian_speckle.variance", variance);
        detail::require_correlation("gaussian_speckle.correlation", correlation);
        return detail::noise_pass(detail::scaled_law<detail::normal_fields, detail::multiplied_draw>(
            {}, {{seed, detail::noise_stream::gaussian_speckle, frame}, correlation},
            {"gaussian_speckle.variance", variance, 1}));
    }
};

/// Makes a fraction of the pixels black or white, half each. MATLAB, Octave: imnoise(I, "salt & pepper", density);
/// scikit-image: random_noise(I, "s&p", amount=density). NaN stays NaN.
struct salt_and_pepper {
    parameter density = 0.05f;  ///< fraction of the pixels, 0 to 1
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for a density outside 0 to 1; on application, for a map of another size than the image
    INSONIFY_TAGGED auto pass() const {
        density.check(
            "salt_and_pepper.density", [](float d) { return d >= 0 && d <= 1; }, "0 to 1");
        return detail::noise_pass(detail::salt_law({seed, detail::noise_stream::salt_and_pepper, frame}, density));
    }
};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
