// One system of sand ripples, as the waves of one direction make it.
#pragma once

#include <insonify/config.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// Parameters of one system of ripples. Wave ripples are 0.05 to 1.5 m long and 0.05 to 0.2 times as high.
///
/// Crests fork 2 pi spread bandwidth / wavelength^2 times per square metre.
struct ripple_system {
    float wavelength = 0.8f;  ///< metres, 0.0001 to 10^6: from crest to crest
    float steepness = 0.11f;  ///< in [0, 0.5]: height from trough to crest, over the wavelength
    float direction = 0;      ///< radians from +x: where the wave vector points, across the crests
    float spread = 0.09f;     ///< radians, in [0, 0.5]: standard deviation of the direction; forks grow with it
    float bandwidth = 0.09f;  ///< in [0, 0.25]: relative standard deviation of the wave number
    float sharpness =
        0.25f;  ///< in [0, 0.9]: 0 is sinusoidal; larger is trochoidal, with narrow crests and wide troughs

    INSONIFY_MEMBER float height() const { return steepness * wavelength; }
    friend bool operator==(const ripple_system&, const ripple_system&) = default;
};

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
