// A bottom without fine relief, so that tests see the features alone.
#pragma once

#include <insonify/seabed/roughness.hpp>

inline constexpr insonify::seabed::roughness smooth{.rms = 0};
