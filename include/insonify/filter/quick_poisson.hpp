// Shot noise by a formula: nearly the counts of poisson.hpp, several times as fast.
//
// Based on: Edmund A. Cornish, Ronald A. Fisher. Moments and Cumulants in the Specification of Distributions. Review of
// the International Statistical Institute 5, 1938 (third order). William F. Sheppard. On the Calculation of the most
// Probable Values of Frequency-Constants. Proceedings of the London Mathematical Society 29, 1898 (what rounding adds
// to a variance, 1 / 12).
#pragma once

#include <insonify/filter/poisson.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI {

namespace detail {

/// Counts of means of 10 and above from normal draws; the others go on a list.
struct quick_poisson_kernel {
    const float* from;
    const float* normal;
    float* to;
    int count;
    float photons;
    pixel_list* few;

    template <int N>
    INSONIFY_INLINE void run() const {
        const quick_poisson_kernel own = *this;  // which nothing that is stored can change
        int listed = 0, i = 0;
        for (; i + N <= own.count; i += N) own.at<N>(i, listed);
        for (; i < own.count; ++i) own.at<1>(i, listed);
        own.few->count = listed;
    }

  private:
    template <int N>
    INSONIFY_INLINE void at(int i, int& listed) const {
        using floats = lanes<float, N>;
        using flags = lanes<std::int32_t, N>;
        floats value, z, root, whole;
        load(value, from + i);
        load(z, normal + i);
        clip_lanes<N>(value);
        const floats mean = value * photons;
        const flags is_few = flags(mean < 10.0f);
        square_root<N>(root, is_few != 0 ? floats{} + 1.0f : mean - static_cast<float>(1.0 / 12));
        const floats square = z * z;
        const floats skewed =
            (square - 1.0f) * static_cast<float>(1.0 / 6) + z * (1.0f - square) * static_cast<float>(1.0 / 72) / root;
        const floats drawn = mean + (0.5f + root * z + skewed);
        flags counted;
        convert(counted, floats(drawn > 0.0f ? drawn : floats{}));
        convert(whole, counted);
        floats result = whole / photons;
        clip_lanes<N>(result);
        store(to + i, value == value ? result : value);
        if (any(is_few)) {
            for (int k = 0; k < N; ++k)
                add_if((lane(is_few, k) & 1) != 0 && lane(mean, k) == lane(mean, k), i + k, few->places, listed);
        }
    }
};

class quick_poisson_law {
  public:
    quick_poisson_law(float photons, noise_key normal, noise_key exact)
        : photons_(photons), normal_(normal), exact_(exact) {}

    void row(const float* from, float* to, const noise_run& run) const {
        draw_buffer buffer;
        const float* const normal = white_draws<normal_draws>(buffer, normal_, 0, run);
        double mean[run_length], count[run_length];
        pixel_list few;
        float pixel[run_length];
        std::copy_n(from, run.count, pixel);  // `to` may be `from`
        dispatch(quick_poisson_kernel{pixel, normal, to, run.count, photons_, &few}, best_isa());
        if (few.count == 0) return;
        const pixel_list all = few;
        for (int k = 0; k < all.count; ++k) {
            const int i = all.places[k];
            mean[i] = static_cast<double>(clip_to_unit(pixel[i])) * static_cast<double>(photons_);
        }
        dispatch(rejection_kernel<poisson_inversion>{{}, mean, count, &few, run, exact_}, best_isa());
        for (int k = 0; k < all.count; ++k) {
            const int i = all.places[k];
            to[i] = clip_to_unit(static_cast<float>(count[i] / static_cast<double>(photons_)));
        }
    }
    void place(const pixel_area&) {}

  private:
    float photons_;
    noise_key normal_, exact_;
};

}  // namespace detail

/// Poisson counts where a normal draw, bent as the distribution is, will do. Means below 10 are drawn exactly, as
/// `poisson` draws them; from 10 on, no set of counts is more probable or less than it should be by more than 6e-4
/// (that is at 10; 1e-4 at 50), and the variance is right to 3e-5.
struct quick_poisson {
    float photons = 255;  ///< mean count of a white pixel, in (0, 1e6]
    std::uint64_t seed = 0;
    std::uint32_t frame = 0;  ///< which image of a set

    using is_filter = std::true_type;

    /// @throws invalid_input for photons outside (0, 1e6]
    auto pass() const {
        detail::require(photons > 0 && photons <= 1e6f, "quick_poisson.photons", photons, "above 0 and at most 1e6");
        return detail::noise_pass(detail::quick_poisson_law(photons, {seed, detail::noise_stream::quick_poisson, frame},
                                                            {seed, detail::noise_stream::poisson, frame}));
    }
};

}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
