// Power-law roughness of a seabed.
#pragma once

#include <insonify/config.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// Random relief whose 2-D spectrum falls as a power of the wave number, W(K) ~ K^-exponent, from wavelengths of about
/// 1.9 `longest` down to the smallest cell (half power at both).
///
/// Measured exponents of sea floors are 2.4 to 3.9, 3.25 where nothing is known: APL-UW High-Frequency Ocean
/// Environmental Acoustic Models Handbook. TR 9407, 1994 (eqs. 7-8).
struct roughness {
    float rms = 0.01f;       ///< metres, 0 to below 10^6; 0 costs nothing
    float longest = 1.0f;    ///< metres, below 10^6: cell of the coarsest octave, whose waves are 1 to 3.5 cells long
    float shortest = 0.04f;  ///< metres, 0.0001 to longest: no octave has smaller cells
    float exponent = 3.25f;  ///< in [2, 4]

    friend bool operator==(const roughness&, const roughness&) = default;
};

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
