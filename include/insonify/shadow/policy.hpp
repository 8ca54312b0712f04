// Which shadows a picture has, as types: what is not asked for is not compiled.
#pragma once

#include <insonify/core/numeric.hpp>

#include <concepts>

namespace insonify::inline INSONIFY_ABI::shadow {

/// No shadows: no map, no look-up, no memory.
struct none {};

/// A map of the casters' heights along the light, looked up at the nearest texel: hard edges.
struct map {
    float texels_per_pixel = 1.5f;  ///< of the picture's ground sampling; a shadow edge is off by half a texel at most
    int largest = 8192;             ///< texels a side; what would need more gets coarser texels
};

/// The same map, averaged over (2 radius + 1)^2 texels: edges are soft over as many.
struct pcf {
    float texels_per_pixel = 1.5f;
    int largest = 8192;
    int radius = 1;  ///< texels, 0 to 8
};

/// Hard edges where the casters' triangles have them. A heightfield over a regular grid, as seabeds mostly are, is
/// swept along lines of the light, two thirds of a texel apart. Of anything else a map says who casts near a point, and
/// where its texels disagree the triangles are asked. What lies between two lines or meets no texel's centre is missed,
/// so texels should not be larger than pixels.
struct refined {
    float texels_per_pixel = 1;  ///< across the light; along it up to a third fewer
    int largest = 8192;          ///< texels a side, or lines
};

/// The edges of the casters themselves in every pixel: each is asked about every triangle that may stand in its light.
/// No map, no resolution, no bias; the only shadows that light from nearby can cast.
struct exact {};

/// Soft edges: the same for several points of a round light that isn't small, of which a pixel gets its share. Each
/// point costs as much as `exact`. Labels are those of the light's middle.
struct penumbra {
    float diameter = static_cast<float>(numeric::to_radians(0.5));  ///< of the light, in radians as the ground sees it
    int samples = 16;                                               ///< points of it, the first in the middle
};

/// Radius of the light over its distance; of all but `penumbra` 0.
inline double radius_of(const auto&) {
    return 0;
}
inline double radius_of(const penumbra& p) {
    return numeric::tan(0.5 * static_cast<double>(p.diameter));
}

/// @throws invalid_input for a value out of its range
inline void validate(const none&) {}
inline void validate(const exact&) {}
inline void validate(const penumbra& p) {
    detail::require(p.diameter >= 0 && p.diameter <= 1, "diameter", p.diameter, "0 to 1 radian");
    detail::require(p.samples >= 1 && p.samples <= 1024, "samples", p.samples, "1 to 1024");
}
inline void validate(const map& m) {
    detail::require(m.texels_per_pixel > 0 && numeric::is_finite(m.texels_per_pixel), "texels_per_pixel",
                    m.texels_per_pixel, "above 0");
    detail::require(m.largest >= 1 && m.largest <= 32768, "largest", m.largest, "1 to 32768");
}
inline void validate(const pcf& p) {
    validate(map{p.texels_per_pixel, p.largest});
    detail::require(p.radius >= 0 && p.radius <= 8, "radius", p.radius, "0 to 8 texels");
}

inline void validate(const refined& r) {
    validate(map{r.texels_per_pixel, r.largest});
}

template <class P>
concept policy = std::same_as<P, none> || std::same_as<P, map> || std::same_as<P, pcf> || std::same_as<P, refined> ||
    std::same_as<P, exact> || std::same_as<P, penumbra>;

/// Those that ask rays instead of a map.
template <class P>
concept ray_policy = std::same_as<P, exact> || std::same_as<P, penumbra>;

}  // namespace insonify::inline INSONIFY_ABI::shadow
