// Presets of sonar classes: resolution, range and display.
//
// Values are typical of a class, rounded from data sheets of the instruments that are named; a generator varies them:
// beamwidths are one-way, between the -3 dB points, resolutions are c / (2 bandwidth), ranges are usable ones over
// sand. Absorption is that of salt water (M. A. Ainslie, J. G. McColm. A Simplified Formula for Viscous and Chemical
// Absorption in Sea Water. JASA 103, 1998, at 10 degrees, 20 m). A towed sonar is flown at 10 to 20 % of its range
// above the bottom (NOAA. Hydrographic Surveys Field Procedures Manual, 2014, side scan sonar: 8 to 20 %).
#pragma once

#include <insonify/sonar/side_scan/sonar_equation.hpp>
#include <insonify/sonar/speckle.hpp>

#include <array>
#include <string>
#include <string_view>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Properties of a class of sonars.
struct instrument {
    std::string_view name;
    float frequency;               ///< hertz
    float beamwidth;               ///< along the track, radians
    float range_resolution;        ///< metres of slant range
    float along_track_resolution;  ///< metres at every range of a synthetic aperture; 0: given by the beam
    float range;                   ///< metres of slant range to one side
    int looks;                     ///< intensities averaged per pixel
    float dynamic_range;           ///< of the display, decibels
    float absorption_per_km;       ///< decibels, one way
    float vertical_beamwidth;      ///< radians
    float tilt;                    ///< of the vertical beam's axis below the horizon, radians

    INSONIFY_MEMBER float wavelength() const { return 1500 / frequency; }
    INSONIFY_MEMBER horizontal_beam horizontal() const { return {beamwidth}; }
    INSONIFY_MEMBER bool is_synthetic_aperture() const { return along_track_resolution > 0; }
    /// Resolution along the track at a slant range, metres.
    INSONIFY_MEMBER double along_track(double slant_range) const {
        return is_synthetic_aperture() ? static_cast<double>(along_track_resolution)
                                       : slant_range * static_cast<double>(beamwidth);
    }
    /// Correlation length (1 / e) of speckle intensities, in resolutions, for a pulse or an aperture with a flat band,
    /// whose correlation is the square of sin(u) / u.
    static constexpr double flat_band_speckle_ratio = 0.5234;
    /// Correlation length of speckle intensities across the track, metres.
    INSONIFY_MEMBER double speckle_length_across() const {
        return flat_band_speckle_ratio * static_cast<double>(range_resolution);
    }
    /// The same along the track: see horizontal_beam::speckle_length.
    INSONIFY_MEMBER double speckle_length_along(double slant_range) const {
        return is_synthetic_aperture() ? flat_band_speckle_ratio * static_cast<double>(along_track_resolution)
                                       : horizontal().speckle_length(slant_range, static_cast<double>(wavelength()));
    }
};

namespace instruments {

/// 450 kHz side-scan: Klein 3900 at 445 kHz, EdgeTech 4200 at 400 kHz (0.3 to 0.5 degrees), StarFish 450.
inline constexpr instrument side_scan_450{"side_scan_450", 450e3f, 0.0070f, 0.03f, 0, 150, 1, 40, 116, 0.87f, 0.26f};
/// 600 kHz side-scan: EdgeTech 4125 at 600 kHz, 4205 at 520 kHz.
inline constexpr instrument side_scan_600{"side_scan_600", 600e3f, 0.0058f, 0.015f, 0, 100, 1, 40, 169, 0.87f, 0.35f};
/// 900 kHz side-scan: Klein 3900 and EdgeTech 4125 at 900 kHz, Marine Sonic ARC.
inline constexpr instrument side_scan_900{"side_scan_900", 900e3f, 0.0049f, 0.01f, 0, 60, 1, 36, 322, 0.87f, 0.35f};
/// 1800 kHz side-scan of small vehicles: EdgeTech 2205 and 4125 at 1600 kHz, Marine Sonic at 1800 kHz.
inline constexpr instrument side_scan_1800{
    "side_scan_1800", 1800e3f, 0.0035f, 0.006f, 0, 25, 1, 34, 1143, 0.87f, 0.35f};
/// Interferometric synthetic aperture of 60 to 120 kHz: Kongsberg HISAS 1032 (R. E. Hansen. Introduction to Synthetic
/// Aperture Sonar. In: Sonar Systems, 2011).
inline constexpr instrument synthetic_aperture{
    "synthetic_aperture", 100e3f, 0.35f, 0.03f, 0.03f, 180, 2, 50, 34, 0.6f, 0.3f};

inline constexpr std::array<instrument, 5> all{side_scan_450, side_scan_600, side_scan_900, side_scan_1800,
                                               synthetic_aperture};

}  // namespace instruments

inline namespace INSONIFY_FLAGS {

/// An instrument by its name.
/// @throws invalid_input for an unknown name
inline const instrument& instrument_named(std::string_view name) {
    for (const instrument& i : instruments::all)
        if (i.name == name) return i;
    std::string known;
    for (const instrument& i : instruments::all) known += (known.empty() ? "" : ", ") + std::string(i.name);
    detail::throw_error(invalid_input("instrument is '" + std::string(name) + "', expected one of " + known));
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
