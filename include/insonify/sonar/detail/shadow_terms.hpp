// Converts the light of a rig for shadow policies, and casters to shadow labels.
#pragma once

#include <insonify/shadow/policy.hpp>
#include <insonify/sonar/labels.hpp>
#include <insonify/sonar/overhead/rig.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// The light of a rig, in its frame.
inline shadow::any_light light_in_rig(const overhead_geometry& view) {
    if (view.has_near_light()) return shadow::point_light{view.light_position()};
    return shadow::directional_light{numeric::widened(view.rig().light_azimuth), numeric::widened(view.rig().grazing)};
}

/// The label of a caster in labels::shadow. Targets are the first casters.
inline std::uint16_t shadow_label(std::uint32_t caster, std::size_t targets) {
    return caster < targets ? static_cast<std::uint16_t>(caster + 1) : labels::by_seabed;
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
