// Interpolation and falloff functions of seabed relief, for floats and lanes.
#pragma once

#include <insonify/core/numeric.hpp>
#include <insonify/core/simd/lanes.hpp>

#include <algorithm>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed::detail::inline INSONIFY_FLAGS {

using numeric::saturate;

/// Perlin's quintic: from 0 to 1, first and second derivatives 0 at both ends.
template <class T>
INSONIFY_INLINE constexpr void fade(T& into, const T& t) {
    into = t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}
constexpr float fade(float t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
}
/// Catmull-Rom interpolation from the second (t = 0) to the third (t = 1) of four values.
template <class T>
INSONIFY_INLINE void catmull_rom(T& into, const T (&p)[4], const T& t) {
    const T b = 0.5f * (p[2] - p[0]), c = p[0] - 2.5f * p[1] + 2.0f * p[2] - 0.5f * p[3],
            d = 0.5f * (p[3] - p[0]) + 1.5f * (p[1] - p[2]);
    into = p[1] + t * (b + t * (c + t * d));
}
/// A coordinate in cells, clamped to the grid: the cell's index and the fraction within it, in [0, 1]. NaN counts as 0.
struct grid_coordinate {
    int cell;
    double across;
    grid_coordinate(double c, int cells) {
        const double clamped = c > 0 ? (std::min)(c, static_cast<double>(cells)) : 0.0;
        cell = (std::min)(static_cast<int>(clamped), cells - 1);
        across = clamped - cell;
    }
};

/// Linear interpolation, exact at both ends.
constexpr float lerp(float a, float b, float t) {
    return a * (1 - t) + b * t;
}
/// The biweight kernel (1 - r^2)^2: 1 in the middle; its value and slope are 0 from a distance of 1 on.
template <class T>
constexpr T biweight(T r) {
    const T inside = r * r < 1 ? 1 - r * r : T(0);
    return inside * inside;
}
template <class Lanes>
INSONIFY_INLINE void saturate_lanes(Lanes& t) {
    const Lanes zero{}, one = zero + 1.0f;
    t = t > 0.0f ? t : zero;
    t = t < 1.0f ? t : one;
}

}  // namespace seabed::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
