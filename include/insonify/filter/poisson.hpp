// Shot noise: each pixel becomes the count of a Poisson draw whose mean it was.
//
// Based on: Wolfgang Hormann. The Transformed Rejection Method for Generating Poisson Random Variables. Insurance:
// Mathematics and Economics 12, 1993 (algorithm PTRS, means of 10 and above; below, inversion by summing).
#pragma once

#include <insonify/filter/rejection.hpp>

#include <array>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI {

namespace detail {

/// ln k! - k ln m + m for whole k >= 0 and m > 0, less half of ln(k + 1): what is left of a Poisson probability,
/// without the large terms that cancel. A table below 10, then Stirling's series to below 1e-11.
template <int N>
INSONIFY_INLINE void poisson_deficit(lanes<double, N>& into, const lanes<double, N>& k, const lanes<double, N>& m) {
    constexpr std::array<double, 10> log_factorial = {0.0,
                                                      0.0,
                                                      0.69314718055994531,
                                                      1.7917594692280550,
                                                      3.1780538303479458,
                                                      4.7874917427820458,
                                                      6.5792512120101012,
                                                      8.5251613610654147,
                                                      10.604602902745251,
                                                      12.801827480081469};
    using doubles = lanes<double, N>;
    constexpr double half_log_two_pi = 0.91893853320467274;
    const doubles n = k + 1.0, r = 1.0 / n, s = r * r;
    const doubles tail = (1.0 / 12 - (1.0 / 360 - (1.0 / 1260 - s * (1.0 / 1680)) * s) * s) * r;
    doubles log_ratio;
    log_lanes<N>(log_ratio, m * r);
    into = (m - n) - k * log_ratio + (half_log_two_pi + tail);
    for (int i = 0; i < N; ++i) {
        const double count = lane(k, i);
        if (count < 10) {
            set_lane(into, i,
                     log_factorial[static_cast<std::size_t>(count)] - count * numeric::log(lane(m, i)) + lane(m, i) -
                         0.5 * numeric::log(count + 1));
        }
    }
}

/// What transformed rejection makes of two uniform numbers before it asks whether to keep it.
template <int N>
struct poisson_proposal {
    using doubles = lanes<double, N>;
    using flags = lanes<std::int64_t, N>;

    doubles v, a, b, edge, count;
    flags squeezed;  ///< to be kept in any case, as most are

    /// @param mean  10 or above
    INSONIFY_INLINE poisson_proposal(const lanes<std::uint64_t, N>& first, const lanes<std::uint64_t, N>& second,
                                     const doubles& mean) {
        doubles u;
        uniform_lanes<N>(u, first);
        uniform_lanes<N>(v, second);
        u = u - 0.5;
        square_root<N>(b, mean);
        b = 0.931 + 2.53 * b;
        a = -0.059 + 0.02483 * b;
        edge = 0.5 - (u < 0.0 ? 0.0 - u : u);
        floor_lanes<N>(count, (2.0 * a / edge + b) * u + mean + 0.43);
        squeezed = flags(edge >= 0.07) & flags((0.9277 - v) * (b - 2.0) >= 3.6224);
    }
};

/// For means of 10 and above: transformed rejection with squeeze; 1.1 to 1.4 attempts, two of them from one block.
struct poisson_rejection {
    static std::uint32_t block(std::uint32_t trial) { return trial / 2; }

    template <int N>
    INSONIFY_INLINE void attempt(lanes<double, N>& count, lanes<std::int64_t, N>& settled,
                                 const lanes<std::uint64_t, N> (&word)[4], const lanes<double, N>& mean,
                                 std::uint32_t trial) const {
        using doubles = lanes<double, N>;
        using flags = lanes<std::int64_t, N>;
        const poisson_proposal<N> p(word[2 * (trial & 1)], word[2 * (trial & 1) + 1], mean);
        count = p.count;
        // Hormann's ln(v / (alpha (a / edge^2 + b))) <= k ln m - m - ln k!, in fewer logarithms and quotients.
        const doubles square = p.edge * p.edge;
        const doubles height =
            p.v * (1.1239 * p.b - (1.1239 * 3.4 - 1.1328)) * square / ((p.b - 3.4) * (p.a + p.b * square));
        const doubles whole = count > 0.0 ? count : doubles{};
        doubles log_height, deficit;
        log_lanes<N>(log_height, height * height * (whole + 1.0));
        poisson_deficit<N>(deficit, whole, mean);
        settled = p.squeezed | (flags(count >= 0.0) & (flags(p.edge >= 0.013) | flags(p.v <= p.edge)) &
                                flags(0.5 * log_height + deficit <= 0.0));
    }
};

/// A run of pixels while their counts are drawn.
struct poisson_run {
    static constexpr int room = run_length + 8;  // the last lanes reach beyond the last pixel
    float pixel[room] = {};
    double mean[room], count[room];
    pixel_list few;   ///< means below 10
    pixel_list many;  ///< those of 10 and above whose first attempt is undecided
};

/// The means, and the first attempt of poisson_rejection as far as it goes without logarithms: that is the end of it
/// for two pixels out of three.
struct poisson_squeeze_kernel {
    poisson_run* pixels;
    double photons;
    noise_run at;
    noise_key noise;

    template <int Width>
    INSONIFY_INLINE void run() const {
        constexpr int N = Width > 1 ? Width / 2 : 1;
        using words = lanes<std::uint64_t, N>;
        const poisson_squeeze_kernel own = *this;  // which nothing that is stored can change
        words step;
        count_up<std::uint64_t, N>(step);
        const words y = words{} + std::uint64_t{static_cast<std::uint32_t>(own.at.y)},
                    channel = words{} + std::uint64_t{own.at.channel << 24},
                    frame = words{} + std::uint64_t{own.noise.frame};
        int few = 0, many = 0;
        for (int x = 0; x < own.at.count; x += 2 * N) {
            const words first = step + std::uint64_t{static_cast<std::uint32_t>(own.at.x + x)};
            words block[2][4] = {{first, y, channel, frame}, {first + std::uint64_t{N}, y, channel, frame}};
            philox_rounds<N, 2>(block, own.noise.key[0], own.noise.key[1]);
            unroll<2>([&](int half) INSONIFY_INLINE_LAMBDA {
                const std::uint64_t low = 0xFFFFFFFFu;
                own.at_once<N>(x + half * N, block[half][0] & low, block[half][1] & low, few, many);
            });
        }
        own.pixels->few.count = few;
        own.pixels->many.count = many;
    }

  private:
    template <int N>
    INSONIFY_INLINE void at_once(int i, const lanes<std::uint64_t, N>& first, const lanes<std::uint64_t, N>& second,
                                 int& few, int& many) const {
        using doubles = lanes<double, N>;
        using flags = lanes<std::int64_t, N>;
        lanes<float, N> pixel;
        load(pixel, pixels->pixel + i);
        clip_lanes<N>(pixel);
        doubles mean;
        convert(mean, pixel);
        mean = mean * photons;
        store(pixels->mean + i, mean);
        const auto large = mean >= 10.0;
        const poisson_proposal<N> p(first, second, large ? mean : doubles{} + 10.0);
        store(pixels->count + i, large ? p.count : doubles{});
        const flags is_open = flags(large) & ~p.squeezed, is_few = flags(mean > 0.0) & flags(mean < 10.0);
        for (int k = 0; k < N; ++k) add_if((lane(is_open, k) & 1) != 0, i + k, pixels->many.places, many);
        if (any(is_few)) {
            for (int k = 0; k < N; ++k) add_if((lane(is_few, k) & 1) != 0, i + k, pixels->few.places, few);
        }
    }
};

/// Counts as pixels: J = k / photons. NaN stays.
struct poisson_pixel_kernel {
    const poisson_run* pixels;
    float* to;
    double photons;
    int count;

    template <int Width>
    INSONIFY_INLINE void run() const {
        constexpr int N = Width > 1 ? Width / 2 : 1;
        const poisson_pixel_kernel own = *this;  // which nothing that is stored can change
        int i = 0;
        for (; i + N <= own.count; i += N) own.at<N>(i);
        for (; i < own.count; ++i) own.at<1>(i);
    }

  private:
    template <int N>
    INSONIFY_INLINE void at(int i) const {
        lanes<double, N> counted;
        lanes<float, N> pixel, result;
        load(counted, pixels->count + i);
        load(pixel, pixels->pixel + i);
        convert(result, lanes<double, N>(counted / photons));
        clip_lanes<N>(result);
        store(to + i, pixel == pixel ? result : pixel);
    }
};

/// For means below 10, the first count whose cumulative probability reaches u; always at the first attempt.
struct poisson_inversion {
    static std::uint32_t block(std::uint32_t trial) { return trial; }

    template <int N>
    INSONIFY_INLINE void attempt(lanes<double, N>& count, lanes<std::int64_t, N>& settled,
                                 const lanes<std::uint64_t, N> (&word)[4], const lanes<double, N>& mean,
                                 std::uint32_t) const {
        using doubles = lanes<double, N>;
        using flags = lanes<std::int64_t, N>;
        doubles u, probability;
        uniform_lanes<N>(u, word[0]);
        exp_lanes<N>(probability, 0.0 - mean);
        doubles cumulative = probability;
        count = doubles{};
        for (double next = 1;; ++next) {
            const flags below = flags(cumulative < u) & flags(probability > 0.0);
            if (!any(below)) break;
            count = below != 0 ? doubles{} + next : count;
            probability = probability * (mean * (1 / next));
            cumulative = cumulative + probability;
        }
        settled = flags{} + 1;
    }
};

class poisson_law {
  public:
    /// @param photons  for a pixel of 1; 0: as many as the pixel has levels, or 1e6 for floats
    poisson_law(double photons, noise_key noise) : photons_(photons), noise_(noise) {}

    void row(const float* from, float* to, const noise_run& run) const {
        const double photons = photons_ > 0 ? photons_ : run.levels > 1 ? run.levels : 1e6;
        poisson_run pixels;
        std::copy_n(from, run.count, pixels.pixel);
        dispatch(poisson_squeeze_kernel{&pixels, photons, run, noise_}, best_isa());
        // Behind the last pixel there are zeros, whose counts are zeros.
        dispatch(rejection_kernel<poisson_rejection>{{}, pixels.mean, pixels.count, &pixels.many, run, noise_},
                 best_isa());
        dispatch(rejection_kernel<poisson_inversion>{{}, pixels.mean, pixels.count, &pixels.few, run, noise_},
                 best_isa());
        dispatch(poisson_pixel_kernel{&pixels, to, photons, run.count}, best_isa());
    }
    void place(const pixel_area&) {}

  private:
    double photons_;
    noise_key noise_;
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
    auto pass() const {
        detail::require(photons > 0 && photons <= 1e9f, "poisson.photons", photons, "above 0 and at most 1e9");
        return detail::noise_pass(
            detail::poisson_law(static_cast<double>(photons), {seed, detail::noise_stream::poisson, frame}));
    }
};

/// MATLAB's rule by class: codes of 8 and 16 bits are counts themselves, floats (MATLAB: single) count 1e6 for white.
/// On 8 bits the same draws as `poisson{}`.
struct matlab_poisson {
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    auto pass() const {
        return detail::noise_pass(detail::poisson_law(0, {seed, detail::noise_stream::poisson, frame}));
    }
};

}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
