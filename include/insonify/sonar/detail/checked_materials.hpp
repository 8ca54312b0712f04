// Checks of a scene and of the options that all sonars share.
#pragma once

#include <insonify/sonar/labels.hpp>
#include <insonify/sonar/scene.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Checks a law at 64 angles, once for each picture.
/// @throws invalid_input for a value that is negative, infinite or NaN
template <class Law>
void require_echoes(const Law& law) {
    constexpr int angles = 64;
    for (int i = 1; i <= angles; ++i) {
        const float sine = static_cast<float>(i) / angles;
        const auto echo = static_cast<float>(law(sine));
        if (!(echo >= 0 && numeric::is_finite(echo))) refuse("law(" + to_text(sine) + ")", echo, "finite, 0 or more");
    }
}

/// The materials of a valid scene's bottom, by seabed::type.
/// @throws invalid_input for a scene, a cell or a law out of range
template <class Options>
bottom_materials checked_materials(const scene& s, const Options& options) {
    validate(s);
    require_numbered_targets(s);
    require(options.cell >= 0 && numeric::is_finite(options.cell), "cell", options.cell, "0 metres or more");
    validate_if_possible(options.law);
    require_echoes(options.law);
    return resolved_bottom(s);
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
