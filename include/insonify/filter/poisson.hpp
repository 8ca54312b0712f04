// Shot noise: each pixel becomes the count of a Poisson draw whose mean it was.
//
// Based on: Wolfgang Hormann. The Transformed Rejection Method for Generating Poisson Random Variables. Insurance:
// Mathematics and Economics 12, 1993 (algorithm PTRS, means of 256 and above; below there are tables).
#pragma once

#include <insonify/filter/detail/poisson_tables.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

/// ln k! - k ln m + m for whole k >= 10 and m > 0, less half of ln(k + 1): what is left of a Poisson probability,
/// without the large terms that cancel. Stirling's series to below 1e-11.
template <int N>
INSONIFY_INLINE void poisson_deficit(lanes<double, N>& into, const lanes<double, N>& k, const lanes<double, N>& m) {
    using doubles = lanes<double, N>;
    constexpr double half_log_two_pi = 0.91893853320467274;
    const doubles n = k + 1.0, r = 1.0 / n, s = r * r;
    const doubles tail = (1.0 / 12 - (1.0 / 360 - (1.0 / 1260 - s * (1.0 / 1680)) * s) * s) * r;
    doubles log_ratio;
    log_lanes<N>(log_ratio, m * r);
    into = (m - n) - k * log_ratio + (half_log_two_pi + tail);
}

/// For means of 256 and above, where counts below 10 don't occur: transformed rejection with squeeze; 1.1 attempts, two
/// of them from one block.
struct poisson_rejection {
    static std::uint32_t block(std::uint32_t trial) { return trial / 2; }

    template <int N>
    INSONIFY_INLINE void attempt(lanes<double, N>& count, lanes<std::int64_t, N>& settled,
                                 const lanes<std::uint64_t, N> (&word)[4], const lanes<double, N>& mean,
                                 std::uint32_t trial) const {
        using doubles = lanes<double, N>;
        using flags = lanes<std::int64_t, N>;
        doubles u, v, b;
        uniform_lanes<N>(u, word[2 * (trial & 1)]);
        uniform_lanes<N>(v, word[2 * (trial & 1) + 1]);
        u = u - 0.5;
        square_root<N>(b, mean);
        b = 0.931 + 2.53 * b;
        const doubles a = -0.059 + 0.02483 * b;
        const doubles edge = 0.5 - (u < 0.0 ? 0.0 - u : u);
        floor_lanes<N>(count, (2.0 * a / edge + b) * u + mean + 0.43);
        const flags squeezed = flags(edge >= 0.07) & flags((0.9277 - v) * (b - 2.0) >= 3.6224);
        // Hormann's ln(v / (alpha (a / edge^2 + b))) <= k ln m - m - ln k!, in fewer logarithms and quotients.
        const doubles square = edge * edge;
        const doubles height = v * (1.1239 * b - (1.1239 * 3.4 - 1.1328)) * square / ((b - 3.4) * (a + b * square));
        const doubles whole = count > 10.0 ? count : doubles{} + 10.0;
        doubles log_height, deficit;
        log_lanes<N>(log_height, height * height * (whole + 1.0));
        poisson_deficit<N>(deficit, whole, mean);
        settled = squeezed | (flags(count >= 10.0) & (flags(edge >= 0.013) | flags(v <= edge)) &
                              flags(0.5 * log_height + deficit <= 0.0));
    }
};

/// Counts of means of 256 and above, exactly.
struct rejected_large_counts {
    noise_key noise;

    /// Pixels of the list become counts over photons; they held their means.
    void operator()(float* pixels, const pixel_list& large, const noise_run& run, float photons) const {
        double mean[run_length], count[run_length];
        pixel_list open = large;
        for (int k = 0; k < large.count; ++k) mean[large.places[k]] = static_cast<double>(pixels[large.places[k]]);
        dispatch(rejection_kernel<poisson_rejection>{{}, mean, count, &open, run, noise}, best_isa());
        for (int k = 0; k < large.count; ++k) {
            const std::uint16_t i = large.places[k];
            pixels[i] = clip_to_unit(static_cast<float>(count[i] / static_cast<double>(photons)));
        }
    }
};

/// @tparam LargeCounts  what draws for means of 256 and above
template <class LargeCounts>
class poisson_law {
  public:
    /// @param photons  for a pixel of 1; 0: as many as the pixel has levels, or 1e6 for floats
    poisson_law(float photons, std::uint64_t seed, std::uint32_t frame, LargeCounts large_counts)
        : photons_(photons), small_(seed, noise_stream::small_poisson, frame), large_counts_(large_counts) {}

    void row(const float* from, float* to, const noise_run& run) const {
        const float photons = photons_ > 0 ? photons_ : run.levels > 1 ? static_cast<float>(run.levels) : 1e6f;
        draw_buffer words, uniforms;
        const float* const word = white_draws<word_draws>(words, small_, 0, run);
        const float* const uniform = white_draws<unit_draws>(uniforms, small_, 1, run);
        pixel_list large;
        dispatch(poisson_table_kernel{poisson_tables::shared().entries(), from, word, uniform, to, run.count, photons,
                                      &large},
                 best_isa());
        if (large.count > 0) large_counts_(to, large, run, photons);
    }
    void place(const pixel_area&) {}

  private:
    float photons_;
    noise_key small_;
    LargeCounts large_counts_;
};

inline auto exact_poisson(float photons, std::uint64_t seed, std::uint32_t frame) {
    return noise_pass(poisson_law(photons, seed, frame, rejected_large_counts{{seed, noise_stream::poisson, frame}}));
}

}  // namespace detail::inline INSONIFY_FLAGS

/// Poisson counts: J = k / photons, k drawn with the mean I photons. The default is what MATLAB's
/// imnoise(I, "poisson") does to uint8 images; its rule for doubles, photons = 1e12, is no noise at all to the eye.
struct poisson {
    float photons = 255;  ///< mean count of a white pixel, in (0, 1e9]
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for photons outside (0, 1e9]
    INSONIFY_MEMBER auto pass() const {
        detail::require(photons > 0 && photons <= 1e9f, "poisson.photons", photons, "above 0 and at most 1e9");
        return detail::exact_poisson(photons, seed, frame);
    }
};

/// MATLAB's rule by class: codes of 8 and 16 bits are counts themselves, floats (MATLAB: single) count 1e6 for white.
/// On 8 bits the same draws as `poisson{}`.
struct matlab_poisson {
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    INSONIFY_MEMBER auto pass() const { return detail::exact_poisson(0, seed, frame); }
};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
