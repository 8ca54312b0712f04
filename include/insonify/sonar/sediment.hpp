// How bright sediments are: the table of seabed/sediment.hpp as materials.
#pragma once

#include <insonify/seabed/sediment.hpp>
#include <insonify/sonar/backscatter.hpp>

#include <array>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI {

using seabed::sediment;

/// The backscattering strength of a sediment at normal incidence by Lambert's law, as a factor; for those who compute
/// levels. Use with `lambert_backscatter`.
inline material surface_of(sediment s) {
    return {static_cast<float>(numeric::pow(10, static_cast<double>(seabed::facts_of(s).level) / 10))};
}

/// What a scene takes the bottom to be made of, by seabed::type: gray values that the paper's pictures have, and
/// sediments relative to those, medium sand as bright as sand.
inline std::array<material, seabed::type_count> default_bottom() {
    std::array<material, seabed::type_count> bottom{{{0.45f}, {0.5f}, {0.4f}, {0.6f}}};
    const float sand = bottom[0].reflectivity / surface_of(sediment::medium_sand).reflectivity;
    for (std::size_t i = 0; i < seabed::sediment_count; ++i) {
        const auto s = static_cast<sediment>(i);
        bottom[static_cast<std::size_t>(seabed::type_of(s))] = {sand * surface_of(s).reflectivity};
    }
    return bottom;
}

}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
