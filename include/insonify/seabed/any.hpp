// Every kind of seabed a scene can be given.
#pragma once

#include <insonify/seabed/blend.hpp>
#include <insonify/seabed/detailed.hpp>
#include <insonify/seabed/heightfield.hpp>
#include <insonify/seabed/mixed.hpp>
#include <insonify/seabed/none.hpp>
#include <insonify/seabed/sculpt.hpp>

namespace insonify::inline INSONIFY_ABI::seabed {

/// One of the library's seabeds, by value: `any bottom = ripples{.wavelength = 0.6f};`. `prepare` and `sample` take it
/// as they take a recipe. Other recipes join as the heightfield that `sample` makes of them.
using any = std::variant<flat, ripples, mud, rock, blend, mixed, sculpted, heightfield, detailed, none>;

}  // namespace insonify::inline INSONIFY_ABI::seabed
