// Shot noise by a formula where counts are large: nearly those of poisson.hpp, and faster.
//
// Based on: Edmund A. Cornish, Ronald A. Fisher. Moments and Cumulants in the Specification of Distributions. Review of
// the International Statistical Institute 5, 1938 (third order). William F. Sheppard. On the Calculation of the most
// Probable Values of Frequency-Constants. Proceedings of the London Mathematical Society 29, 1898 (what rounding adds
// to a variance, 1 / 12).
#pragma once

#include <insonify/filter/poisson.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

/// The count that a normal draw z means, for means of 256 and above.
template <int N>
INSONIFY_INLINE void count_of_normal(lanes<float, N>& into, const lanes<float, N>& mean, const lanes<float, N>& z) {
    using floats = lanes<float, N>;
    floats root;
    square_root<N>(root, mean - static_cast<float>(1.0 / 12));
    const floats square = z * z;
    const floats skewed =
        (square - 1.0f) * static_cast<float>(1.0 / 6) + z * (1.0f - square) * static_cast<float>(1.0 / 72) / root;
    lanes<std::int32_t, N> whole;
    convert(whole, floats(mean + (0.5f + root * z + skewed)));
    convert(into, whole);
}

struct quick_poisson_kernel {
    const float* normal;
    float* pixels;
    const pixel_list* large;
    float photons;

    template <int N>
    INSONIFY_INLINE void run() const {
        const quick_poisson_kernel own = *this;  // which nothing that is stored can change
        int i = 0;
        for (; i + N <= own.large->count; i += N) own.at<N>(own.large->places + i);
        for (; i < own.large->count; ++i) own.at<1>(own.large->places + i);
    }

  private:
    template <int N>
    INSONIFY_INLINE void at(const std::uint16_t* places) const {
        lanes<float, N> mean, z, count;
        gather<N>(mean, [&](int k) { return pixels[places[k]]; });
        gather<N>(z, [&](int k) { return normal[places[k]]; });
        count_of_normal<N>(count, mean, z);
        count = count / photons;
        clip_lanes<N>(count);
        for (int k = 0; k < N; ++k) pixels[places[k]] = lane(count, k);
    }
};

/// Counts of means of 256 and above, nearly.
struct quick_large_counts {
    noise_key noise;

    /// Pixels of the list become counts over photons; they held their means.
    void operator()(float* pixels, const pixel_list& large, const noise_run& run, float photons) const {
        draw_buffer buffer;
        const float* const normal = white_draws<normal_draws>(buffer, noise, 0, run);
        dispatch(quick_poisson_kernel{normal, pixels, &large, photons}, best_isa());
    }
};

}  // namespace detail::inline INSONIFY_FLAGS

/// Poisson counts where a normal draw, bent as the distribution is, will do. Means below 256 are drawn exactly, to
/// `poisson`'s very counts; from there on, no set of counts is more probable or less than it should be by more than
/// 3e-5, less for larger means.
struct quick_poisson {
    float photons = 255;  ///< mean count of a white pixel, in (0, 1e6]
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for photons outside (0, 1e6]
    INSONIFY_TAGGED auto pass() const {
        detail::require(photons > 0 && photons <= 1e6f, "quick_poisson.photons", photons, "above 0 and at most 1e6");
        using namespace detail;
        return noise_pass(
            poisson_law(photons, seed, frame, quick_large_counts{{seed, noise_stream::quick_poisson, frame}}));
    }
};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
