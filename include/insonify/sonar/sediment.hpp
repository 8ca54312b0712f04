// Materials by label, from the registry (seabed/registry.hpp).
#pragma once

#include <insonify/seabed/sediment.hpp>
#include <insonify/sonar/backscatter.hpp>

#include <array>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

using seabed::sediment;

inline namespace INSONIFY_FLAGS {

/// The backscattering strength of a sediment at normal incidence by Lambert's law, as a factor. Use with
/// `lambert_backscatter` to compute levels. This is absolute; `scene.bottom` and `type_properties` are relative to a
/// bright target: there medium sand, 0.032 here, has 0.45, `properties_of(type_of(s)).reflectivity`.
constexpr material surface_of(sediment s) {
    return {seabed::parameters_of(s).strength_at_nadir()};
}

/// Materials by label.
using bottom_materials = std::array<material, seabed::label_count>;

/// Marks labels that take the reflectivity of the seabed's model.
inline constexpr float by_seabed_model = -1;

/// The registry's materials; labels outside of the registry take those of the seabed's model.
constexpr bottom_materials default_bottom() {
    bottom_materials bottom{};
    bottom.fill({by_seabed_model});
    for (const seabed::type_properties& t : seabed::built_in_types)
        bottom[seabed::index_of(t.label)] = {t.reflectivity};
    return bottom;
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
