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

#include <insonify/core/dispatch.hpp>
#include <insonify/core/random.hpp>

#include <concepts>
#include <cstdint>
#include <type_traits>

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // wide vectors stay inside always-inlined code
#endif

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

/// Noise of one draw per pixel. Four pixels in a row share a Philox block; the draws of 64 pixels are made at once, and
/// kept.
template <class Law>
class noise_pass {
  public:
    noise_pass(Law law, philox_key key, std::uint32_t frame) : law_(law), key_(key), frame_(frame) {}

    template <std::same_as<float> Pixel>
    Pixel operator()(Pixel pixel, int x, int y) {
        if (x >> 6 != group_ || y != row_) {
            group_ = x >> 6;
            row_ = y;
            dispatch(*this, best_isa());
        }
        return clip_to_unit(law_.add(clip_to_unit(pixel), draws_[x & 63]));
    }

    /// Makes the draws of the row's 64 pixels.
    template <int Width>
    INSONIFY_INLINE void run() const {
        constexpr int N = Width > 1 ? 4 : 1;
        using words = lanes<std::uint64_t, N>;
        words step;
        count_up<std::uint64_t, N>(step);
        for (int block = 0; block < 16; block += N) {
            const auto first = static_cast<std::uint64_t>(static_cast<std::uint32_t>(16 * group_ + block));
            words word[4] = {step + first, words{} + std::uint64_t{static_cast<std::uint32_t>(row_)}, words{},
                             words{} + std::uint64_t{frame_}};
            philox_lanes<N>(word, key_[0], key_[1]);
            float draw[4][static_cast<unsigned>(N)];
            law_.template draw<N>(draw, word);
            for (int k = 0; k < N; ++k)
                for (int i = 0; i < 4; ++i) draws_[4 * (block + k) + i] = draw[i][k];
        }
    }

  private:
    Law law_;
    philox_key key_;
    std::uint32_t frame_;
    int group_ = -1;
    int row_ = -1;
    mutable float draws_[64] = {};
};

/// Draws as floats, in memory.
template <int N>
INSONIFY_INLINE void narrow(float* into, const lanes<double, N>& draws) {
    lanes<float, N> floats;
    convert(floats, draws);
    store(into, floats);
}

struct normal_law {
    double mean;
    double deviation;

    template <int N>
    INSONIFY_INLINE void draw(float (&into)[4][static_cast<unsigned>(N)],
                              const lanes<std::uint64_t, N> (&word)[4]) const {
        lanes<double, N> a, b;
        for (int i = 0; i < 4; i += 2) {
            normal_lanes<N>(a, b, word[i], word[i + 1]);
            narrow<N>(into[i], mean + deviation * a);
            narrow<N>(into[i + 1], mean + deviation * b);
        }
    }
};

struct additive_normal : normal_law {
    static float add(float pixel, float draw) { return pixel + draw; }
};
struct multiplicative_normal : normal_law {
    static float add(float pixel, float draw) { return pixel + draw * pixel; }
};

struct multiplicative_uniform {
    double half_width;

    template <int N>
    INSONIFY_INLINE void draw(float (&into)[4][static_cast<unsigned>(N)],
                              const lanes<std::uint64_t, N> (&word)[4]) const {
        lanes<double, N> u;
        for (int i = 0; i < 4; ++i) {
            uniform_lanes<N>(u, word[i]);
            narrow<N>(into[i], half_width * (2.0 * u - 1.0));
        }
    }
    static float add(float pixel, float draw) { return pixel + draw * pixel; }
};

struct rayleigh_factor {
    /// sqrt(-ln u) has the mean sqrt(pi) / 2.
    template <int N>
    INSONIFY_INLINE void draw(float (&into)[4][static_cast<unsigned>(N)],
                              const lanes<std::uint64_t, N> (&word)[4]) const {
        lanes<double, N> u;
        for (int i = 0; i < 4; ++i) {
            uniform_lanes<N>(u, word[i]);
            log_lanes<N>(u, u);
            square_root<N>(u, -4 / numeric::pi * u);
            narrow<N>(into[i], u);
        }
    }
    static float add(float pixel, float draw) { return draw * pixel; }
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

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

INSONIFY_ARITHMETIC_END
