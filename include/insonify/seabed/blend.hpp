// Blends of two seabeds: patches of one in the other, with natural borders and a label at every point.
#pragma once

#include <insonify/seabed/mixed.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// Patches of `first` in `second`, placed by a noise that exceeds a threshold: `mixed` with one layer. Across the
/// border one relief sinks below the other, so that ripples end in tips within about a border's width.
struct blend {
    any first = ripples{};
    any second = flat{};
    /// In [0, 1]: fraction of the area inside the outlines, over many patches. Labels follow the upper surface: within
    /// the border the higher bottom wins, so rock in sand is labelled on 0.34 for 0.3, ripples in sand on 0.29.
    float coverage = 0.5f;
    float patch = 12.0f;  ///< metres, > 0: scale of the patches
    float border = 0.6f;  ///< metres, 0.001 to `patch`: typical width of borders, about a ripple or two
    std::uint64_t seed = 1;

    /// @throws invalid_input for parameters out of their range
    INSONIFY_TAGGED mixed_sampler prepare() const {
        detail::require_fraction("blend.coverage", coverage);
        detail::require_positive_metres("blend.patch", patch);
        detail::require_range("blend.border", border, 1e-3f, patch, "metres from 0.001 to blend.patch");
        const layer top{.bottom = first, .where = patches{coverage, patch}, .border = border};
        return mixed{.base = second, .layers = {top}, .seed = seed}.prepare();
    }
    INSONIFY_TAGGED std::vector<type_properties> legend() const {
        std::vector<type_properties> all = first.legend();
        extend(all, second.legend());
        return all;
    }
};

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
