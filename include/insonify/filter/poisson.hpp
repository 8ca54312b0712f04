// Shot noise: each pixel becomes the count of a Poisson draw whose mean it was.
//
// Based on: Wolfgang Hormann. The Transformed Rejection Method for Generating Poisson Random Variables. Insurance:
// Mathematics and Economics 12, 1993 (algorithm PTRS, means of 10 and above; below, inversion by summing).
#pragma once

#include <insonify/filter/noise.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI {

namespace detail {

/// ln k! for whole k >= 0: a table, then Stirling's series to below 1e-11.
inline double log_factorial(double k) {
    constexpr std::array<double, 10> table = {0.0,
                                              0.0,
                                              0.69314718055994531,
                                              1.7917594692280550,
                                              3.1780538303479458,
                                              4.7874917427820458,
                                              6.5792512120101012,
                                              8.5251613610654147,
                                              10.604602902745251,
                                              12.801827480081469};
    if (k < 10) return table[static_cast<std::size_t>(k)];
    constexpr double half_log_two_pi = 0.91893853320467274;
    const double n = k + 1, square = n * n;
    const double tail = (1.0 / 12 - (1.0 / 360 - (1.0 / 1260 - 1.0 / 1680 / square) / square) / square) / n;
    return (n - 0.5) * numeric::log(n) - n + half_log_two_pi + tail;
}

/// The words of one pixel in order, as many as its draw needs.
class pixel_words {
  public:
    pixel_words(int x, int y, std::uint32_t frame, philox_key key)
        : counter_{static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, frame}, key_(key) {}

    double uniform() {
        if (used_ == 4) {
            block_ = philox4x32(counter_, key_);
            ++counter_[2];
            used_ = 0;
        }
        return uniform_open(block_[used_++]);
    }

  private:
    philox_counter counter_;
    philox_key key_;
    philox_counter block_{};
    std::size_t used_ = 4;
};

/// For means below 10: the first count whose cumulative probability reaches u.
inline double poisson_by_inversion(double mean, pixel_words& words) {
    const double u = words.uniform();
    double probability = numeric::exp(-mean), cumulative = probability, count = 0;
    while (cumulative < u && probability > 0) {
        ++count;
        probability *= mean / count;
        cumulative += probability;
    }
    return count;
}

/// For means of 10 and above: transformed rejection with squeeze; 1.1 to 1.4 attempts.
inline double poisson_by_rejection(double mean, pixel_words& words) {
    const double b = 0.931 + 2.53 * numeric::square_root(mean);
    const double a = -0.059 + 0.02483 * b;
    const double squeeze = 0.9277 - 3.6224 / (b - 2);
    for (;;) {
        const double u = words.uniform() - 0.5, v = words.uniform();
        const double edge = 0.5 - (u < 0 ? -u : u);
        const auto count = static_cast<double>(numeric::floor_to_int((2 * a / edge + b) * u + mean + 0.43));
        if (edge >= 0.07 && v <= squeeze) return count;
        if (count < 0 || (edge < 0.013 && v > edge)) continue;
        const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
        if (numeric::log(v * inverse_alpha / (a / (edge * edge) + b)) <=
            count * numeric::log(mean) - mean - log_factorial(count)) {
            return count;
        }
    }
}

class poisson_pass {
  public:
    poisson_pass(double photons, philox_key key, std::uint32_t frame) : photons_(photons), key_(key), frame_(frame) {}

    template <std::same_as<float> Pixel>
    Pixel operator()(Pixel pixel, int x, int y) const {
        const double mean = static_cast<double>(clip_to_unit(pixel)) * photons_;
        if (!(mean > 0)) return pixel == pixel ? 0.0f : pixel;
        pixel_words words(x, y, frame_, key_);
        const double count = mean < 10 ? poisson_by_inversion(mean, words) : poisson_by_rejection(mean, words);
        return clip_to_unit(static_cast<float>(count / photons_));
    }

  private:
    double photons_;
    philox_key key_;
    std::uint32_t frame_;
};

}  // namespace detail

/// Poisson counts: J = k / photons, k drawn with the mean I photons. The default is what MATLAB's
/// imnoise(I, "poisson") does to uint8 images; its rule for doubles, photons = 1e12, is no noise at all to the eye.
struct poisson {
    float photons = 255;  ///< mean count of a white pixel, in (0, 1e9]
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for photons outside (0, 1e9]
    detail::poisson_pass pass() const {
        detail::require(photons > 0 && photons <= 1e9f, "poisson.photons", photons, "above 0 and at most 1e9");
        return {static_cast<double>(photons), detail::noise_key(seed, detail::noise_stream::poisson), frame};
    }
};

}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
