// Two seabeds side by side: patches with ragged borders, and the type at every point.
#pragma once

#include <insonify/seabed/flat.hpp>
#include <insonify/seabed/mud.hpp>
#include <insonify/seabed/ripples.hpp>
#include <insonify/seabed/rock.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::seabed {

/// The recipes of a single type.
using simple = std::variant<flat, ripples, mud, rock>;

template <preparable First, preparable Second>
class blend_sampler;

/// Patches of `first` in `second`: where a noise exceeds a threshold there is one, else the other. Across the border
/// one relief dies out as the other grows, so ripples end within about a border's width.
///
/// `blend` holds any two simple recipes; spell out the template for recipes of your own.
template <preparable First, preparable Second>
struct basic_blend {
    First first = ripples{};
    Second second = flat{};
    float coverage = 0.5f;  ///< in [0, 1]: share of the area that is `first`, over many patches
    float patch = 12.0f;    ///< metres, > 0: scale of the patches
    float border = 0.6f;    ///< metres, in (0, patch]: typical width of borders, about a ripple or two
    std::uint64_t seed = 1;

    /// @throws invalid_input for parameters out of their range
    blend_sampler<First, Second> prepare() const { return blend_sampler<First, Second>(*this); }
    float operator()(double x, double y) const { return at(prepare(), x, y).height; }
    type type_at(double x, double y) const { return at(prepare(), x, y).kind; }
};
using blend = basic_blend<simple, simple>;

namespace detail {

/// The value that a standard normal variable exceeds with probability p, absolute error < 4.5e-4.
/// Milton Abramowitz, Irene A. Stegun. Handbook of Mathematical Functions. 1964 (eq. 26.2.23, by C. Hastings).
inline double normal_exceeded(double p) {
    const double tail = p < 0.5 ? p : 1 - p;
    const double t = numeric::square_root(-2 * numeric::log(tail));
    const double value =
        t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
    return p < 0.5 ? value : -value;
}

}  // namespace detail

/// Evaluates `basic_blend`.
template <preparable First, preparable Second>
class blend_sampler {
  public:
    explicit blend_sampler(const basic_blend<First, Second>& b)
        : first_(seabed::prepare(b.first)), second_(seabed::prepare(b.second)), mask_(outline(b)) {
        detail::require(b.coverage >= 0 && b.coverage <= 1, "blend.coverage", b.coverage, "0 to 1");
        // The noise falls by its slope per metre across a border: scaled so that it goes from 0 to 1 over the width.
        const double per_metre = 1 / (static_cast<double>(b.border) * mask_.rms_slope());
        const auto share = static_cast<double>(b.coverage);
        scale_ = static_cast<float>(per_metre);
        offset_ = b.coverage <= 0   ? -never
                  : b.coverage >= 1 ? never
                                    : static_cast<float>(0.5 - per_metre * detail::normal_exceeded(share));
    }

    void row(const scanline& line, std::span<float> heights, std::span<type> types) const {
        for (std::size_t i = 0; i < heights.size(); i += detail::chunk) {
            const std::size_t count = (std::min)(detail::chunk, heights.size() - i);
            part(line.from(i), heights.subspan(i, count), types.empty() ? types : types.subspan(i, count));
        }
    }

    height_range range() const { return merge(first_.range(), second_.range()); }

  private:
    static constexpr float never = 1e30f;  // beyond any value of the noise

    static power_law_noise outline(const basic_blend<First, Second>& b) {
        detail::require(b.patch > 0 && b.patch < 1e6f, "blend.patch", b.patch, "metres above 0");
        detail::require(b.border >= 1e-3f && b.border <= b.patch, "blend.border", b.border,
                        "metres from 0.001 to blend.patch");
        return {{.rms = 1, .longest = b.patch, .shortest = b.border, .exponent = 3.6f}, b.seed, detail::stream::mask};
    }

    void part(const scanline& line, std::span<float> heights, std::span<type> types) const {
        std::array<float, detail::chunk> share_buffer{};
        const std::span<float> share(share_buffer.data(), heights.size());
        mask_.add_row(line, share);
        bool any_first = false, any_second = false;
        for (float& s : share) {
            s = detail::clamp01(offset_ + scale_ * s);
            any_first |= s > 0;
            any_second |= s < 1;
        }
        // Away from borders one of the two is all there is to evaluate.
        if (!any_second) return first_.row(line, heights, types);
        if (!any_first) return second_.row(line, heights, types);

        std::array<float, detail::chunk> other;
        std::array<type, detail::chunk> other_types;
        first_.row(line, {other.data(), heights.size()}, {other_types.data(), types.size()});
        second_.row(line, heights, types);
        for (std::size_t i = 0; i < heights.size(); ++i) {
            // In this form shares of 0 and 1 give the very bits that the shortcuts above give.
            const float weight = detail::fade(share[i]);
            heights[i] = heights[i] * (1 - weight) + other[i] * weight;
        }
        for (std::size_t i = 0; i < types.size(); ++i) {
            if (share[i] >= 0.5f) types[i] = other_types[i];
        }
    }

    decltype(seabed::prepare(std::declval<const First&>())) first_;
    decltype(seabed::prepare(std::declval<const Second&>())) second_;
    power_law_noise mask_;
    float scale_ = 1, offset_ = 0;
};

}  // namespace insonify::inline INSONIFY_ABI::seabed

INSONIFY_ARITHMETIC_END
