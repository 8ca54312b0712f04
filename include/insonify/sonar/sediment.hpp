// Brightness by label: the registry of seabed/registry.hpp as materials.
#pragma once

#include <insonify/seabed/sediment.hpp>
#include <insonify/sonar/backscatter.hpp>

#include <array>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

using seabed::sediment;

inline namespace INSONIFY_FLAGS {

/// The backscattering strength of a sediment at normal incidence by Lambert's law, as a factor; for those who compute
/// levels. Use with `lambert_backscatter`.
constexpr material surface_of(sediment s) {
    return {seabed::facts_of(s).strength_at_nadir()};
}

/// A material per label.
using bottom_materials = std::array<material, seabed::label_count>;

/// The reflectivity of labels for which the seabed's own properties count.
inline constexpr float by_seabed_model = -1;

/// The registry's materials; users' own labels are as bright as their seabed says.
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
