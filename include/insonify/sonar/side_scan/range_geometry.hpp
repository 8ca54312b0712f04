// Closed forms of side-scan geometry over level seabed: ranges, shadows, layover, and heights measured from them.
//
// Lengths are metres. `altitude` is the sonar's above the seabed, `ground` a distance across the track on the seabed,
// `height` that of a point above the seabed. Results that do not exist are 0 (a distance inside the water column) or
// infinity (the shadow of an object as high as the sonar), never NaN for lengths within 1e150 and angles within a turn.
//
// Based on: P. Blondel. The Handbook of Sidescan Sonar. 2009.
#pragma once

#include <insonify/core/numeric.hpp>

#include <limits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace range_geometry {

inline namespace INSONIFY_FLAGS {

/// Distance from the sonar to a point.
inline double slant_range(double ground, double altitude, double height = 0) {
    const double down = altitude - height;
    return numeric::square_root(ground * ground + down * down);
}

/// Distance across the track of the seabed at a slant range; 0 in the water column.
inline double ground_range(double slant, double altitude) {
    return slant > numeric::abs(altitude) ? numeric::square_root(slant * slant - altitude * altitude) : 0;
}

/// Angle of the ray with the seabed, radians: pi / 2 below the sonar.
inline double grazing_angle(double ground, double altitude) {
    return numeric::atan2(altitude, ground);
}

/// Distance across the track of the shadow of a point.
inline double shadow_tip(double ground, double altitude, double height) {
    return height < altitude ? ground * altitude / (altitude - height) : std::numeric_limits<double>::infinity();
}

/// Length of a shadow on the seabed, from below the point that casts it.
inline double shadow_length(double ground, double altitude, double height) {
    return height < altitude ? height * ground / (altitude - height) : std::numeric_limits<double>::infinity();
}

/// Length of a shadow in a picture of slant ranges, from the echo of the point that casts it.
inline double slant_shadow_length(double ground, double altitude, double height) {
    if (!(height < altitude)) return std::numeric_limits<double>::infinity();
    const double tip = slant_range(shadow_tip(ground, altitude, height), altitude);
    return numeric::is_finite(tip) ? tip - slant_range(ground, altitude, height) : tip;
}

/// Apparent position of a raised point after slant-range correction: layover moves points below twice the altitude
/// towards the sonar, at most to 0, and points higher than that, or below the seabed, away from it.
inline double apparent_ground(double ground, double altitude, double height) {
    return ground_range(slant_range(ground, altitude, height), altitude);
}

/// Height of an object from its shadow.
/// @param front, tip  slant ranges of the object's top and of its shadow's tip; or distances across the track, of its
///                    foot and of its shadow's tip
inline double height_from_shadow(double front, double tip, double altitude) {
    return tip > 0 ? altitude * (tip - front) / tip : 0;
}

/// Metres of seabed in a bin of slant range; infinite straight below the sonar.
inline double ground_resolution(double bin, double grazing) {
    const double cosine = numeric::sin_cos(grazing).cosine;
    return cosine > 0 ? bin / cosine : std::numeric_limits<double>::infinity();
}

/// Metres along the track between the one-way -3 dB points of a beam, given in radians.
inline double along_track_footprint(double slant, double beamwidth) {
    return slant * beamwidth;
}

}  // namespace INSONIFY_FLAGS

}  // namespace range_geometry
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
