// Two seabeds side by side: patches of one in the other, with natural borders, and the type at every point.
#pragma once

#include <insonify/seabed/cover.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::seabed {

template <preparable First, preparable Second>
class blend_sampler;

/// Patches of `first` in `second`: where a noise exceeds a threshold there is one, else the other. Across the border
/// one relief sinks beneath the other, so ripples end in tips within about a border's width.
///
/// `blend` holds any two simple recipes; spell out the template for recipes of your own. For more than two, see
/// `mixed`.
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

/// Evaluates `basic_blend`.
template <preparable First, preparable Second>
class blend_sampler {
  public:
    explicit blend_sampler(const basic_blend<First, Second>& b)
        : first_(seabed::prepare(b.first)),
          second_(seabed::prepare(b.second)),
          where_(patches_of(b), b.border, 0, b.seed, 0),
          edge_(b.border, (std::max)(detail::relief_of(b.first), detail::relief_of(b.second))) {}

    void row(const scanline& line, std::span<float> heights, std::span<type> types) const {
        const auto second = [&](const scanline& l, std::span<float> h, std::span<type> t) { second_.row(l, h, t); };
        detail::by_parts(line, heights, types, [&](const scanline& l, std::span<float> h, std::span<type> t) {
            detail::lay_over(where_, edge_, first_, l, h, t, second);
        });
    }

    height_range range() const { return merge(first_.range(), second_.range()); }

  private:
    static patches patches_of(const basic_blend<First, Second>& b) {
        detail::require(b.coverage >= 0 && b.coverage <= 1, "blend.coverage", b.coverage, "0 to 1");
        detail::require(b.patch > 0 && b.patch < 1e6f, "blend.patch", b.patch, "metres above 0");
        detail::require(b.border >= 1e-3f && b.border <= b.patch, "blend.border", b.border,
                        "metres from 0.001 to blend.patch");
        return {b.coverage, b.patch};
    }

    decltype(seabed::prepare(std::declval<const First&>())) first_;
    decltype(seabed::prepare(std::declval<const Second&>())) second_;
    detail::outline where_;
    detail::border edge_;
};

}  // namespace insonify::inline INSONIFY_ABI::seabed

INSONIFY_ARITHMETIC_END
