// Blends of two seabeds: patches of one in the other, with natural borders and a label at every point.
#pragma once

#include <insonify/seabed/cover.hpp>
#include <insonify/seabed/flat.hpp>
#include <insonify/seabed/ripples.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

inline namespace INSONIFY_FLAGS {

class blend_sampler;

}  // namespace INSONIFY_FLAGS

/// Patches of `first` in `second`, placed by a noise that exceeds a threshold. Across the border one relief sinks below
/// the other, so that ripples end in tips within about a border's width.
struct blend {
    any first = ripples{};
    any second = flat{};
    float coverage = 0.5f;  ///< in [0, 1]: fraction of the area that is `first`, over many patches
    float patch = 12.0f;    ///< metres, > 0: scale of the patches
    float border = 0.6f;    ///< metres, in (0, patch]: typical width of borders, about a ripple or two
    std::uint64_t seed = 1;

    /// @throws invalid_input for parameters out of their range
    INSONIFY_TAGGED blend_sampler prepare() const;
    INSONIFY_TAGGED std::vector<type_properties> legend() const {
        std::vector<type_properties> all = first.legend();
        extend(all, second.legend());
        return all;
    }
};

inline namespace INSONIFY_FLAGS {

/// Evaluates `blend`.
class blend_sampler {
  public:
    explicit blend_sampler(const blend& b)
        : first_(b.first.prepare()),
          second_(b.second.prepare()),
          where_(patches_of(b), b.border, 0, b.seed, 0),
          edge_(b.border, (std::max)(b.first.sink_depth(), b.second.sink_depth())) {}

    void row(const scanline& line, std::span<float> heights, std::span<type> types) const {
        const auto second = [&](const scanline& l, std::span<float> h, std::span<type> t) { second_.row(l, h, t); };
        detail::by_parts(line, heights, types, [&](const scanline& l, std::span<float> h, std::span<type> t) {
            detail::lay_over(where_, edge_, first_, l, h, t, second);
        });
    }

    height_range range() const { return merge(first_.range(), second_.range()); }

  private:
    static patches patches_of(const blend& b) {
        detail::require(b.coverage >= 0 && b.coverage <= 1, "blend.coverage", b.coverage, "0 to 1");
        detail::require(b.patch > 0 && b.patch < 1e6f, "blend.patch", b.patch, "metres above 0");
        detail::require(b.border >= 1e-3f && b.border <= b.patch, "blend.border", b.border,
                        "metres from 0.001 to blend.patch");
        return {b.coverage, b.patch};
    }

    any_sampler first_, second_;
    detail::outline where_;
    detail::border edge_;
};

}  // namespace INSONIFY_FLAGS

inline blend_sampler blend::prepare() const {
    return blend_sampler(*this);
}

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
