// Noise by pixel: gaussian, speckle (uniform, gaussian, Rayleigh) and poisson, on floats in [0, 1].
//
// As in MATLAB's imnoise, the image is clipped to [0, 1] before and after. NaN (no data) stays NaN.
//
// The noise of a pixel is a function of (seed, kind of noise, frame, x, y) and nothing else. Images of a set differ by
// `.frame`; two filters of one kind in one chain must differ by `.seed`.
//
// Based on: George E. P. Box, Mervin E. Muller. A Note on the Generation of Random Normal Deviates. Annals of
// Mathematical Statistics 29, 1958. Wolfgang Hormann. The Transformed Rejection Method for Generating Poisson Random
// Variables. Insurance: Mathematics and Economics 12, 1993 (algorithm PTRS).
#pragma once

#include <insonify/core/random.hpp>

#include <array>
#include <concepts>
#include <cstdint>
#include <type_traits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI {

namespace detail {

/// One stream per kind of noise; the numbers are part of what a seed means.
enum class noise_stream : std::uint32_t { gaussian = 0x6E6F6900, speckle, gaussian_speckle, rayleigh, poisson };

inline philox_key noise_key(std::uint64_t seed, noise_stream stream) {
    return stream_key(seed, static_cast<std::uint32_t>(stream));
}

constexpr float clip_to_unit(float value) {
    return value < 0 ? 0.0f : value > 1 ? 1.0f : value;
}

inline void require_variance(const char* name, float variance) {
    require(numeric::is_finite(variance) && variance >= 0, name, variance, "finite and at least 0");
}

/// Noise of one draw per pixel. Four pixels in a row share a Philox block, which is kept for the next three.
template <class Law>
class noise_pass {
  public:
    noise_pass(Law law, philox_key key, std::uint32_t frame) : law_(law), key_(key), frame_(frame) {}

    template <std::same_as<float> Pixel>
    Pixel operator()(Pixel pixel, int x, int y) {
        if (x >> 2 != group_ || y != row_) {
            group_ = x >> 2;
            row_ = y;
            draws_ = law_.draw(
                philox4x32({static_cast<std::uint32_t>(group_), static_cast<std::uint32_t>(y), 0, frame_}, key_));
        }
        return clip_to_unit(law_.add(clip_to_unit(pixel), draws_[static_cast<std::size_t>(x & 3)]));
    }

  private:
    Law law_;
    philox_key key_;
    std::uint32_t frame_;
    int group_ = -1;
    int row_ = -1;
    std::array<float, 4> draws_{};
};

struct normal_law {
    double mean;
    double deviation;
    std::array<float, 4> draw(const philox_counter& block) const {
        const auto [a, b] = normal_pair(block[0], block[1]);
        const auto [c, d] = normal_pair(block[2], block[3]);
        return {scaled(a), scaled(b), scaled(c), scaled(d)};
    }

  private:
    float scaled(double normal) const { return static_cast<float>(mean + deviation * normal); }
};

struct additive_normal : normal_law {
    static float add(float pixel, float draw) { return pixel + draw; }
};
struct multiplicative_normal : normal_law {
    static float add(float pixel, float draw) { return pixel + draw * pixel; }
};

struct multiplicative_uniform {
    double half_width;
    std::array<float, 4> draw(const philox_counter& block) const {
        return {scaled(block[0]), scaled(block[1]), scaled(block[2]), scaled(block[3])};
    }
    static float add(float pixel, float draw) { return pixel + draw * pixel; }

  private:
    float scaled(std::uint32_t word) const { return static_cast<float>(half_width * (2 * uniform_open(word) - 1)); }
};

struct rayleigh_factor {
    static std::array<float, 4> draw(const philox_counter& block) {
        return {factor(block[0]), factor(block[1]), factor(block[2]), factor(block[3])};
    }
    static float add(float pixel, float draw) { return draw * pixel; }

  private:
    /// sqrt(-ln u) has the mean sqrt(pi) / 2.
    static float factor(std::uint32_t word) {
        return static_cast<float>(numeric::square_root(-4 / numeric::pi * numeric::log(uniform_open(word))));
    }
};

}  // namespace detail

/// Adds normal noise: J = I + N(mean, variance). MATLAB: imnoise(I, "gaussian", mean, variance).
struct gaussian {
    float mean = 0;
    float variance = 0.01f;
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for a mean that is not finite, or a variance that is negative or not finite
    auto pass() const {
        detail::require(numeric::is_finite(mean), "gaussian.mean", mean, "finite");
        detail::require_variance("gaussian.variance", variance);
        const detail::additive_normal law{
            {static_cast<double>(mean), numeric::square_root(static_cast<double>(variance))}};
        return detail::noise_pass(law, detail::noise_key(seed, detail::noise_stream::gaussian), frame);
    }
};

/// Uniform multiplicative noise: J = I + n I, n uniform in +-sqrt(3 variance). MATLAB: imnoise(I, "speckle", variance);
/// Octave and scikit-image draw n from the normal distribution, which is `gaussian_speckle` here.
struct speckle {
    float variance = 0.05f;
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for a variance that is negative or not finite
    auto pass() const {
        detail::require_variance("speckle.variance", variance);
        const detail::multiplicative_uniform law{numeric::square_root(3 * static_cast<double>(variance))};
        return detail::noise_pass(law, detail::noise_key(seed, detail::noise_stream::speckle), frame);
    }
};

/// Normal multiplicative noise: J = I + n I, n from N(0, variance). Octave: imnoise(I, "speckle", variance).
struct gaussian_speckle {
    float variance = 0.04f;
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for a variance that is negative or not finite
    auto pass() const {
        detail::require_variance("gaussian_speckle.variance", variance);
        const detail::multiplicative_normal law{{0, numeric::square_root(static_cast<double>(variance))}};
        return detail::noise_pass(law, detail::noise_key(seed, detail::noise_stream::gaussian_speckle), frame);
    }
};

/// Fully developed speckle of an amplitude image: J = I a, a Rayleigh with mean 1, hence std 0.5227. Bright pixels
/// saturate at 1: keep the image's mean well below 1/2.
struct rayleigh {
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    auto pass() const {
        return detail::noise_pass(detail::rayleigh_factor{}, detail::noise_key(seed, detail::noise_stream::rayleigh),
                                  frame);
    }
};

}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
