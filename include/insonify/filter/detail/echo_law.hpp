// Speckle as a noise pass: draws intensities of mean 1 and multiplies pixels by them or by their square roots.
#pragma once

#include <insonify/core/detail/echo_statistics.hpp>
#include <insonify/filter/detail/correlated.hpp>
#include <insonify/filter/detail/gamma_texture.hpp>
#include <insonify/filter/detail/rejection.hpp>
#include <insonify/filter/parameter.hpp>

#include <array>
#include <optional>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

struct exponential_draws {
    template <int N>
    static INSONIFY_INLINE void draw(lanes<float, N> (&into)[4], const lanes<std::uint32_t, N> (&word)[4]) {
        unroll<4>([&](int i) INSONIFY_INLINE_LAMBDA {
            log_uniform_lanes<N>(into[i], word[i]);
            into[i] = 0.0f - into[i];
        });
    }
};

struct gamma_rejection {
    static std::uint32_t block(std::uint32_t trial) { return trial; }

    template <int N>
    INSONIFY_INLINE void attempt(lanes<double, N>& number, lanes<std::int64_t, N>& accepted,
                                 const lanes<std::uint64_t, N> (&word)[4], const lanes<double, N>& shape,
                                 std::uint32_t) const {
        try_gamma<N>(number, accepted, word, shape);
    }
};

/// Multiplies by a drawn intensity or its square root; the scale makes the factor's mean one.
template <echo Of>
struct echo_factor {
    template <int N>
    INSONIFY_INLINE void apply(lanes<float, N>& value, const lanes<float, N>& intensity,
                               const lanes<float, N>& scale) const {
        lanes<float, N> factor = intensity;
        if constexpr (Of == echo::amplitude) square_root<N>(factor, intensity);
        value = value * (factor * scale);
    }
};

/// How intensities are drawn; `by_looks` is exponential for one look, else gamma. The choice never depends on whether a
/// parameter is a map: without correlation, a map of equal values gives the same noise as that value.
enum class echo_draw { gamma, by_looks, rice };

/// Statistics of an intensity: the three numbers of a speckle_law, by pixel.
struct echo_statistics {
    const char* name;      ///< of the filter's parameter, for error messages
    parameter looks = 1;   ///< 0.01 to 1e6; 1 unless they are drawn as gamma
    parameter shape = 0;   ///< of the K-distribution's texture; 0: none
    parameter steady = 0;  ///< power of a steady echo over that of the others
};

/// Law of a noise_pass that multiplies pixels by random intensities, or by their square roots.
template <echo_draw Draw>
class echo_law {
  public:
    echo_law(noise_key noise, noise_key texture_noise, echo_statistics statistics, echo of,
             const correlation_length& length)
        : noise_(noise),
          texture_noise_(texture_noise),
          fields_(noise),
          texture_field_(texture_noise),
          statistics_(std::move(statistics)),
          of_(of) {
        const parameter &looks = statistics_.looks, &shape = statistics_.shape, &steady = statistics_.steady;
        is_constant_ = looks.is_constant() && shape.is_constant() && steady.is_constant();
        if (is_constant_ && of == echo::amplitude) last_scale_ = scale_of(looks.value(), shape.value(), steady.value());
        std::fill_n(scale_, run_length, last_scale_);
        if (length.x > 0 || length.y > 0) correlate(length);
    }

    void row(const float* from, float* to, const noise_run& run) {
        draw_buffer buffer;
        float* const intensity = draw(buffer, run);
        apply_texture(intensity, run);
        if (of_ == echo::amplitude) {
            if (!is_constant_) mean_amplitudes(run);
            apply_rule(echo_factor<echo::amplitude>{}, from, intensity, scale_, to, run.count);
        } else {
            apply_rule(echo_factor<echo::intensity>{}, from, intensity, scale_, to, run.count);
        }
    }
    int rows_above() const { return fields_.rows_above(); }
    void prepare(const pixel_area& area) {
        for (parameter* p : {&statistics_.looks, &statistics_.shape, &statistics_.steady})
            p->prepare(statistics_.name, area);
    }

  private:
    /// Chooses taps for the fields such that the autocorrelation of the intensities falls to 1 / e at the given length.
    void correlate(const correlation_length& length) {
        const parameter &looks = statistics_.looks, &shape = statistics_.shape, &steady = statistics_.steady;
        if (!looks.is_constant())
            refuse_text("number of looks of correlated speckle", "a map", "one whole number for all pixels, 1 to 64");
        const float whole = looks.value();
        require(whole >= 1 && whole <= 64 && whole == static_cast<float>(static_cast<int>(whole)),
                "number of looks of correlated speckle", whole, "a whole number, 1 to 64, for all pixels");
        if (shape.is_constant() && shape.value() > 0) texture_.emplace(static_cast<double>(shape.value()));
        const auto speckle = rice_correlation(steady.is_constant() ? static_cast<double>(steady.value()) : 0);
        const double speckle_index = 1 / static_cast<double>(whole);
        const double texture_index = texture_ ? 1 / static_cast<double>(shape.value()) : 0;
        const double index = (1 + texture_index) * (1 + speckle_index) - 1;  // variance / mean^2 of the intensity
        const auto intensity = [&](double field) {
            const double of_texture = texture_ ? texture_->correlation(field) : 0;
            return ((1 + of_texture * texture_index) * (1 + speckle(field) * speckle_index) - 1) / index;
        };
        const auto taps = [&](float pixels) {
            return field_taps(texture_ ? field_length(static_cast<double>(pixels), intensity)
                                       : field_length(static_cast<double>(pixels), speckle));
        };
        const auto along_rows = taps(length.x), along_columns = taps(length.y);
        fields_.correlate(along_rows, along_columns);
        if (texture_) texture_field_.correlate(along_rows, along_columns);
    }

    /// Intensities of mean one without texture.
    float* draw(draw_buffer& buffer, const noise_run& run) {
        if (Draw == echo_draw::rice || fields_.is_correlated()) {
            average_looks(buffer, fields_.is_correlated() ? static_cast<int>(statistics_.looks.value()) : 1, run);
            return buffer;
        }
        if (Draw == echo_draw::by_looks && statistics_.looks.value() == 1)
            return white_draws<exponential_draws>(buffer, noise_, 0, run);
        std::fill_n(buffer, run.count, 1.0f);
        gamma(buffer, statistics_.looks, noise_, run);
        return buffer;
    }

    /// Averages looks of complex normal fields.
    void average_looks(float* intensity, int looks, const noise_run& run) {
        float steady[run_length];
        draw_buffer buffers[2];
        statistics_.steady.row(steady, run.count, run.x, run.y);
        std::fill_n(intensity, run.count, 0.0f);
        for (int look = 0; look < looks; ++look) {
            const auto field = static_cast<std::uint32_t>(2 * look);
            const float* const re = fields_.row(buffers[0], field, run);
            const float* const im = fields_.row(buffers[1], field + 1, run);
            constexpr float root_half = 0.70710678f;
            for (int i = 0; i < run.count; ++i)
                intensity[i] += look_intensity(re[i] * root_half, im[i] * root_half, steady[i], looks);
        }
    }

    void apply_texture(float* intensity, const noise_run& run) {
        if (texture_) {
            draw_buffer buffer;
            const float* const normal = texture_field_.row(buffer, 0, run);
            for (int i = 0; i < run.count; ++i) intensity[i] *= (*texture_)(normal[i]);
            return;
        }
        const bool none = statistics_.shape.is_constant() && statistics_.shape.value() == 0;
        if (!none) gamma(intensity, statistics_.shape, texture_noise_, run);
    }

    /// Multiplies by gamma-distributed numbers of mean one where their shape is not 0.
    static void gamma(float* intensity, const parameter& shapes, const noise_key& noise, const noise_run& run) {
        float shape[run_length];
        double wide[run_length], drawn[run_length];
        pixel_list list;
        shapes.row(shape, run.count, run.x, run.y);
        for (int i = 0; i < run.count; ++i) {
            wide[i] = static_cast<double>(shape[i]);
            add_if(shape[i] > 0, i, list.indices, list.count);
            drawn[i] = 1;
        }
        dispatch(rejection_kernel<gamma_rejection>{{}, wide, drawn, &list, run, noise}, best_isa());
        for (int i = 0; i < run.count; ++i)
            intensity[i] = static_cast<float>(static_cast<double>(intensity[i]) * drawn[i]);
    }

    /// 1 over the mean amplitude of a unit intensity.
    float scale_of(float looks, float shape, float steady) const {
        const double speckle = Draw == echo_draw::rice ? mean_of_rice(static_cast<double>(steady))
                                                       : mean_root_of_gamma(static_cast<double>(looks));
        const double texture = shape > 0 ? mean_root_of_gamma(static_cast<double>(shape)) : 1;
        return static_cast<float>(1 / (speckle * texture));
    }

    /// Scales of a run. Adjacent pixels mostly have equal parameters, so the last scale is kept.
    void mean_amplitudes(const noise_run& run) {
        float looks[run_length], shape[run_length], steady[run_length];
        statistics_.looks.row(looks, run.count, run.x, run.y);
        statistics_.shape.row(shape, run.count, run.x, run.y);
        statistics_.steady.row(steady, run.count, run.x, run.y);
        for (int i = 0; i < run.count; ++i) {
            const std::array<float, 3> now{looks[i], shape[i], steady[i]};
            if (now != last_) last_scale_ = scale_of(looks[i], shape[i], steady[i]);
            last_ = now;
            scale_[i] = last_scale_;
        }
    }

    noise_key noise_, texture_noise_;
    normal_fields fields_, texture_field_;  ///< of Rician and of correlated speckle
    echo_statistics statistics_;
    echo of_;
    std::optional<gamma_texture> texture_;  ///< where it is correlated
    bool is_constant_ = false;
    std::array<float, 3> last_{-1, -1, -1};
    float last_scale_ = 1;
    float scale_[run_length];
};

template <echo_draw Draw>
noise_pass<echo_law<Draw>> echo_pass(noise_stream stream, std::uint64_t seed, std::uint32_t frame,
                                     echo_statistics statistics, echo of, const correlation_length& length) {
    return noise_pass(
        echo_law<Draw>({seed, stream, frame}, {seed, noise_stream::texture, frame}, std::move(statistics), of, length));
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
