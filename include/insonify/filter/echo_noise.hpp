// Speckle filters: Rayleigh, averages of looks, K and Rician, on amplitudes or intensities.
//
// The mean is kept as long as bright pixels do not saturate at 1: keep the image's mean well below 1/2. Clipping,
// codes, colours and NaN are treated as in filter/noise.hpp. `with_speckle` (sonar/speckle.hpp) applies the same laws
// to sonar recordings, which have no largest value.
//
// Based on: E. Jakeman, P. N. Pusey. A Model for Non-Rayleigh Sea Echo. IEEE Transactions on Antennas and Propagation
// 24, 1976 (the K-distribution).
#pragma once

#include <insonify/core/detail/gamma.hpp>
#include <insonify/filter/detail/correlated.hpp>
#include <insonify/filter/detail/gamma_texture.hpp>
#include <insonify/filter/detail/rejection.hpp>
#include <insonify/filter/parameter.hpp>

#include <optional>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// What an image's pixels hold. An amplitude is the square root of an intensity.
enum class echo { amplitude, intensity };

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
    INSONIFY_INLINE void attempt(lanes<double, N>& number, lanes<std::int64_t, N>& settled,
                                 const lanes<std::uint64_t, N> (&word)[4], const lanes<double, N>& shape,
                                 std::uint32_t) const {
        try_gamma<N>(number, settled, word, shape);
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

/// How intensities are drawn. It depends on the filter's type and not on its parameters, so that a map of equal numbers
/// gives the noise of that number.
enum class echo_draw { exponential, gamma, rice };

/// Statistics of an intensity: the three numbers of a speckle_law, by pixel.
struct echo_statistics {
    const char* name;  ///< of the filter's own parameter
    echo_draw draw;
    parameter looks = 1;    ///< 0.01 to 1e6; 1 unless they are drawn as gamma
    parameter texture = 0;  ///< 0: none
    parameter steady = 0;
};

class echo_law {
  public:
    echo_law(noise_key noise, noise_key texture_noise, echo_statistics statistics, echo of,
             const correlation_length& length)
        : noise_(noise), texture_noise_(texture_noise), statistics_(std::move(statistics)), of_(of) {
        const parameter &looks = statistics_.looks, &shape = statistics_.texture, &steady = statistics_.steady;
        is_constant_ = looks.is_constant() && shape.is_constant() && steady.is_constant();
        if (is_constant_ && of == echo::amplitude) last_scale_ = scale_of(looks.value(), shape.value(), steady.value());
        std::fill_n(scale_, run_length, last_scale_);
        if (length.x > 0 || length.y > 0) correlate(length);
    }

    void row(const float* from, float* to, const noise_run& run) {
        draw_buffer buffer;
        float* const intensity = draw(buffer, run);
        texture(intensity, run);
        if (of_ == echo::amplitude) {
            if (!is_constant_) mean_amplitudes(run);
            apply_rule(echo_factor<echo::amplitude>{}, from, intensity, scale_, to, run.count);
        } else {
            apply_rule(echo_factor<echo::intensity>{}, from, intensity, scale_, to, run.count);
        }
    }
    void prepare(const pixel_area& area) {
        for (parameter* p : {&statistics_.looks, &statistics_.texture, &statistics_.steady})
            p->prepare(statistics_.name, area);
    }

  private:
    /// Prepares fields under which the correlation of the intensities has the given length.
    void correlate(const correlation_length& length) {
        const parameter &looks = statistics_.looks, &shape = statistics_.texture, &steady = statistics_.steady;
        const float whole = looks.is_constant() ? looks.value() : 0;
        require(whole >= 1 && whole <= 64 && whole == static_cast<float>(static_cast<int>(whole)),
                "looks of correlated speckle", whole, "a whole number, 1 to 64, for all pixels");
        if (shape.is_constant() && shape.value() > 0) texture_.emplace(static_cast<double>(shape.value()));
        const auto speckle = rice_correlation(steady.is_constant() ? static_cast<double>(steady.value()) : 0);
        const double speckle_index = 1 / static_cast<double>(whole);
        const double texture_index = texture_ ? 1 / static_cast<double>(shape.value()) : 0;
        const double index = (1 + texture_index) * (1 + speckle_index) - 1;  // variance / mean^2 of the intensity
        const auto intensity = [&](double field) {
            const double texture = texture_ ? texture_->correlation(field) : 0;
            return ((1 + texture * texture_index) * (1 + speckle(field) * speckle_index) - 1) / index;
        };
        const auto taps = [&](float pixels) {
            return field_taps(texture_ ? field_length(static_cast<double>(pixels), intensity)
                                       : field_length(static_cast<double>(pixels), speckle));
        };
        correlated_.emplace(noise_, taps(length.x), taps(length.y));
        if (texture_) correlated_texture_.emplace(texture_noise_, taps(length.x), taps(length.y));
    }

    /// Intensities of mean one without texture.
    float* draw(draw_buffer& buffer, const noise_run& run) {
        if (correlated_ || statistics_.draw == echo_draw::rice) {
            fields(buffer, correlated_ ? static_cast<int>(statistics_.looks.value()) : 1, run);
            return buffer;
        }
        if (statistics_.draw == echo_draw::exponential) return white_draws<exponential_draws>(buffer, noise_, 0, run);
        std::fill_n(buffer, run.count, 1.0f);
        gamma(buffer, statistics_.looks, noise_, run);
        return buffer;
    }

    /// |s + n|^2 of complex normal fields n of unit power, averaged over looks.
    void fields(float* intensity, int looks, const noise_run& run) {
        float steady[run_length], re[run_length + 64], im[run_length + 64];
        statistics_.steady.row(steady, run.count, run.x, run.y);
        std::fill_n(intensity, run.count, 0.0f);
        for (int look = 0; look < looks; ++look) {
            field(re, static_cast<std::uint32_t>(2 * look), run);
            field(im, static_cast<std::uint32_t>(2 * look + 1), run);
            constexpr float root_half = 0.70710678f;
            for (int i = 0; i < run.count; ++i) {
                const float real = re[i] * root_half + numeric::square_root(steady[i]), imaginary = im[i] * root_half;
                intensity[i] += (real * real + imaginary * imaginary) / ((1 + steady[i]) * static_cast<float>(looks));
            }
        }
    }
    void field(float (&into)[run_length + 64], std::uint32_t number, const noise_run& run) {
        if (correlated_) {
            correlated_->row(into, number, run);
        } else {
            const float* const draws = white_draws<normal_draws>(into, noise_, number, run);
            std::copy(draws, draws + run.count, static_cast<float*>(into));
        }
    }

    void texture(float* intensity, const noise_run& run) {
        if (texture_) {
            float normal[run_length + 64];
            correlated_texture_->row(normal, 0, run);
            for (int i = 0; i < run.count; ++i) intensity[i] *= (*texture_)(normal[i]);
            return;
        }
        const bool none = statistics_.texture.is_constant() && statistics_.texture.value() == 0;
        if (!none) gamma(intensity, statistics_.texture, texture_noise_, run);
    }

    /// Multiplies by gamma-distributed numbers of mean one where their shape is not 0.
    static void gamma(float* intensity, const parameter& shapes, const noise_key& noise, const noise_run& run) {
        float shape[run_length];
        double wide[run_length], drawn[run_length];
        pixel_list list;
        shapes.row(shape, run.count, run.x, run.y);
        for (int i = 0; i < run.count; ++i) {
            wide[i] = static_cast<double>(shape[i]);
            add_if(shape[i] > 0, i, list.places, list.count);
            drawn[i] = 1;
        }
        dispatch(rejection_kernel<gamma_rejection>{{}, wide, drawn, &list, run, noise}, best_isa());
        for (int i = 0; i < run.count; ++i)
            intensity[i] = static_cast<float>(static_cast<double>(intensity[i]) * drawn[i]);
    }

    /// 1 over the mean amplitude of a unit intensity.
    float scale_of(float looks, float shape, float steady) const {
        const double speckle = statistics_.draw == echo_draw::rice ? mean_of_rice(static_cast<double>(steady))
                                                                   : mean_root_of_gamma(static_cast<double>(looks));
        const double relief = shape > 0 ? mean_root_of_gamma(static_cast<double>(shape)) : 1;
        return static_cast<float>(1 / (speckle * relief));
    }

    /// Scales of a run. Adjacent pixels mostly have equal parameters, so the last scale is kept.
    void mean_amplitudes(const noise_run& run) {
        float looks[run_length], shape[run_length], steady[run_length];
        statistics_.looks.row(looks, run.count, run.x, run.y);
        statistics_.texture.row(shape, run.count, run.x, run.y);
        statistics_.steady.row(steady, run.count, run.x, run.y);
        for (int i = 0; i < run.count; ++i) {
            const std::array<float, 3> now{looks[i], shape[i], steady[i]};
            if (now != last_) last_scale_ = scale_of(looks[i], shape[i], steady[i]);
            last_ = now;
            scale_[i] = last_scale_;
        }
    }

    noise_key noise_, texture_noise_;
    echo_statistics statistics_;
    echo of_;
    std::optional<correlated_draws> correlated_, correlated_texture_;
    std::optional<gamma_texture> texture_;  ///< where it is correlated
    bool is_constant_ = false;
    std::array<float, 3> last_{-1, -1, -1};
    float last_scale_ = 1;
    float scale_[run_length];
};

inline noise_pass<echo_law> echo_pass(noise_stream stream, std::uint64_t seed, std::uint32_t frame,
                                      echo_statistics statistics, echo of, const correlation_length& length) {
    return noise_pass(
        echo_law({seed, stream, frame}, {seed, noise_stream::texture, frame}, std::move(statistics), of, length));
}

inline void check_shape(const char* name, const parameter& shape) {
    shape.check(
        name, [](float v) { return v >= 0.01f && v <= 1e6f; }, "0.01 to 1e6");
}

}  // namespace detail::inline INSONIFY_FLAGS

/// Fully developed speckle: exponential intensities, Rayleigh amplitudes, of which std / mean is 0.5227.
struct rayleigh {
    echo of = echo::amplitude;
    correlation_length correlation{};
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for a correlation length outside 0 to 16
    INSONIFY_MEMBER auto pass() const {
        detail::require_correlation("rayleigh.correlation", correlation);
        return detail::echo_pass(detail::noise_stream::rayleigh, seed, frame,
                                 {"rayleigh", detail::echo_draw::exponential}, of, correlation);
    }
};

/// Speckle averaged over independent looks: gamma-distributed intensities, variance / mean^2 = 1 / looks.
struct gamma_speckle {
    parameter looks = 4;  ///< 0.01 to 1e6, not only whole numbers; 1 is Rayleigh
    echo of = echo::amplitude;
    correlation_length correlation{};  ///< for whole looks, 1 to 64, that are the same for all pixels
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for looks outside 0.01 to 1e6, or a correlation length outside 0 to 16; on application,
    ///         for a map of another size than the image
    INSONIFY_TAGGED auto pass() const {
        detail::check_shape("gamma_speckle.looks", looks);
        detail::require_correlation("gamma_speckle.correlation", correlation);
        return detail::echo_pass(detail::noise_stream::gamma_speckle, seed, frame,
                                 {"gamma_speckle.looks", detail::echo_draw::gamma, looks}, of, correlation);
    }
};

/// The K-distribution: speckle whose mean intensity is itself gamma-distributed from pixel to pixel; for one look,
/// variance / mean^2 of the intensity is 1 + 2 / shape. Rock has shapes of 0.5 to 2, gravel to 4, sand 8 to 20.
struct k_speckle {
    parameter shape = 4;  ///< of the mean, 0.01 to 1e6
    float looks = 1;      ///< 0.01 to 1e6
    echo of = echo::amplitude;
    /// For whole looks, 1 to 64. With a map of shapes, the length is that of the speckle, under a white texture.
    correlation_length correlation{};
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for a shape or looks outside 0.01 to 1e6, or a correlation length outside 0 to 16; on
    ///         application, for a map of another size than the image
    INSONIFY_TAGGED auto pass() const {
        detail::check_shape("k_speckle.shape", shape);
        detail::check_shape("k_speckle.looks", looks);
        detail::require_correlation("k_speckle.correlation", correlation);
        return detail::echo_pass(
            detail::noise_stream::k_speckle, seed, frame,
            {"k_speckle.shape", looks == 1 ? detail::echo_draw::exponential : detail::echo_draw::gamma, looks, shape},
            of, correlation);
    }
};

/// Rician amplitudes: a steady echo among the others, as from mud or a few strong facets. Variance / mean^2 of the
/// intensity is (1 + 2 steady) / (1 + steady)^2.
struct rician {
    parameter steady = 1;  ///< power of the steady echo over that of the others, 0 to 1e6; 0 is Rayleigh
    echo of = echo::amplitude;
    /// With a map, the length is that of the other echoes, and up to 1.4 times as long for the sum.
    correlation_length correlation{};
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for a steady part outside 0 to 1e6, or a correlation length outside 0 to 16; on
    ///         application, for a map of another size than the image
    INSONIFY_TAGGED auto pass() const {
        steady.check(
            "rician.steady", [](float v) { return v >= 0 && v <= 1e6f; }, "0 to 1e6");
        detail::require_correlation("rician.correlation", correlation);
        return detail::echo_pass(detail::noise_stream::rician, seed, frame,
                                 {"rician.steady", detail::echo_draw::rice, 1, 0, steady}, of, correlation);
    }
};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
