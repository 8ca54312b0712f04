// Floats that are not finite, for tests of extremes and refusals.
#pragma once

#include <limits>

inline constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
inline constexpr float positive_infinity = std::numeric_limits<float>::infinity();
