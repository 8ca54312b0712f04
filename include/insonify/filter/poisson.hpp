// Shot noise: replaces each pixel by a Poisson count with the pixel as its mean.
//
// Means below 10 are sampled by inversion, larger ones by transformed rejection with squeeze, in 1.33 trials at a mean
// of 10, 1.17 at 100 and 1.12 from 10^6. Both follow the Poisson distribution to within the 2^-32 resolution of their
// uniform numbers for means up to 1e6, and to 2e-7 at 1e9.
//
// Based on: Wolfgang Hormann. The Transformed Rejection Method for Generating Poisson Random Variables. Insurance:
// Mathematics and Economics 12, 1993 (algorithm PTRS).
#pragma once

#include <insonify/filter/detail/rejection.hpp>

#include <array>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

/// ln k! less Stirling's (k + 1/2) ln(k + 1) - (k + 1) + ln(2 pi) / 2, for k from 0 to 9.
inline constexpr std::array<double, 10> stirling_error = [] {
    std::array<double, 10> error{};
    double log_factorial = 0;
    for (std::size_t k = 0; k < error.size(); ++k) {
        const double n = static_cast<double>(k + 1);
        error[k] = log_factorial - ((n - 0.5) * numeric::log(n) - n + 0.91893853320467274);
        log_factorial += numeric::log(n);
    }
    return error;
}();

/// ln k! - k ln m + m - ln(k + 1) / 2 for whole k >= 0 and m > 0: minus the logarithm of a Poisson probability,
/// less ln(k + 1) / 2, without the large terms that cancel. Its absolute error is about 1e-13 + 2e-16 m.
template <int N>
INSONIFY_INLINE void poisson_deficit(lanes<double, N>& into, const lanes<double, N>& k, const lanes<double, N>& m) {
    using doubles = lanes<double, N>;
    constexpr double half_log_two_pi = 0.91893853320467274;
    const doubles n = k + 1.0, r = 1.0 / n, s = r * r;
    doubles error = (1.0 / 12 - (1.0 / 360 - (1.0 / 1260 - s * (1.0 / 1680)) * s) * s) * r;
    if (any(lanes<std::int64_t, N>(k < 10.0))) {
        for (int i = 0; i < N; ++i)
            if (lane(k, i) < 10) set_lane(error, i, stirling_error[static_cast<std::size_t>(lane(k, i))]);
    }
    doubles log_ratio;
    log_lanes<N>(log_ratio, m * r);
    into = (m - n) - k * log_ratio + (half_log_two_pi + error);
}

/// Draws Poisson counts for rejection_kernel, two trials a block.
struct poisson_counts {
    static constexpr double min_rejection_mean = 10;

    static std::uint32_t block(std::uint32_t trial) { return trial / 2; }

    template <int N>
    INSONIFY_INLINE void attempt(lanes<double, N>& count, lanes<std::int64_t, N>& accepted,
                                 const lanes<std::uint64_t, N> (&word)[4], const lanes<double, N>& mean,
                                 std::uint32_t trial) const {
        using flags = lanes<std::int64_t, N>;
        lanes<double, N> u, v;
        uniform_lanes<N>(u, word[2 * (trial & 1)]);
        uniform_lanes<N>(v, word[2 * (trial & 1) + 1]);
        const flags is_small = flags(mean < min_rejection_mean);
        count = lanes<double, N>{};
        accepted = is_small;
        if (any(flags(is_small == 0))) reject<N>(count, accepted, u, v, mean);
        if (any(is_small)) invert<N>(count, u, mean);
    }

  private:
    /// The smallest count whose cumulative probability reaches u, where the mean is small.
    template <int N>
    INSONIFY_INLINE static void invert(lanes<double, N>& count, const lanes<double, N>& u,
                                       const lanes<double, N>& mean) {
        for (int i = 0; i < N; ++i) {
            const double m = lane(mean, i);
            if (!(m < min_rejection_mean)) continue;
            double k = 0, p = numeric::exp(-m), sum = p;
            while (sum < lane(u, i) && k < 100) {
                k += 1;
                p *= m / k;
                sum += p;
            }
            set_lane(count, i, k);
        }
    }

    template <int N>
    INSONIFY_INLINE static void reject(lanes<double, N>& count, lanes<std::int64_t, N>& accepted,
                                       const lanes<double, N>& uniform, const lanes<double, N>& v,
                                       const lanes<double, N>& mean) {
        using doubles = lanes<double, N>;
        using flags = lanes<std::int64_t, N>;
        const doubles u = uniform - 0.5;
        doubles root;
        square_root<N>(root, mean);
        const doubles b = 0.931 + 2.53 * root, a = -0.059 + 0.02483 * b;
        const doubles edge = 0.5 - (u < 0.0 ? 0.0 - u : u);
        floor_lanes<N>(count, (2.0 * a / edge + b) * u + mean + 0.43);
        const flags squeezed = flags(edge >= 0.07) & flags((0.9277 - v) * (b - 2.0) >= 3.6224);
        // Hormann's ln(v / (alpha (a / edge^2 + b))) <= k ln m - m - ln k!, in fewer logarithms and quotients.
        const doubles square = edge * edge;
        const doubles height = v * (1.1239 * b - (1.1239 * 3.4 - 1.1328)) * square / ((b - 3.4) * (a + b * square));
        const doubles k = count > 0.0 ? count : doubles{};
        doubles log_height, deficit;
        log_lanes<N>(log_height, height * height * (k + 1.0));
        poisson_deficit<N>(deficit, k, mean);
        accepted = accepted | squeezed |
                   (flags(count >= 0.0) & (flags(edge >= 0.013) | flags(v <= edge)) &
                    flags(0.5 * log_height + deficit <= 0.0));
    }
};

class poisson_law {
  public:
    poisson_law(float photons, noise_key noise) : photons_(photons), noise_(noise) {}

    void row(const float* from, float* to, const noise_run& run) const {
        double mean[run_length], count[run_length];
        pixel_list open;
        for (int i = 0; i < run.count; ++i) {
            count[i] = mean[i] = static_cast<double>(numeric::saturate(from[i]) * photons_);
            add_if(mean[i] == mean[i], i, open.indices, open.count);
        }
        dispatch(rejection_kernel<poisson_counts>{{}, mean, count, &open, run, noise_}, best_isa());
        for (int i = 0; i < run.count; ++i)
            to[i] = numeric::saturate(static_cast<float>(count[i] / static_cast<double>(photons_)));
    }
    void prepare(const pixel_area&) {}

  private:
    float photons_;
    noise_key noise_;
};

}  // namespace detail::inline INSONIFY_FLAGS

/// Poisson counts: J = k / photons, k drawn with the mean I photons. The default is what MATLAB's
/// imnoise(I, "poisson") does to uint8 images; for its other classes, photons is 65535 (uint16) or 1e6 (single); that
/// of double, 1e12, lies beyond the range here and is no visible noise at all.
struct poisson {
    float photons = 255;  ///< mean count of a white pixel, in (0, 1e9]
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for photons outside (0, 1e9]
    INSONIFY_TAGGED auto pass() const {
        detail::require(photons > 0 && photons <= 1e9f, "poisson.photons", photons, "above 0 and at most 1e9");
        return detail::noise_pass(detail::poisson_law(photons, {seed, detail::noise_stream::poisson, frame}));
    }
};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
