// What bottoms send back, in decibels, for those who want sediments by name instead of relative gray values.
//
// Values are relative: they are for 100 kHz, a side-scan sonar's 300 to 900 kHz extrapolates them, and the report gives
// 3 dB for well known sands and silts, 10 dB for rock.
#pragma once

#include <insonify/sonar/backscatter.hpp>
#include <insonify/sonar/sonar_equation.hpp>

#include <string_view>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI {

/// A kind of bottom: with Lambert's law, S_b = level + 20 log10(sin grazing).
struct sediment {
    std::string_view name;
    float level;  ///< decibels

    /// For `scene::bottom`; use with `lambert_backscatter`.
    material surface() const { return {static_cast<float>(from_decibels(static_cast<double>(level)))}; }
};

/// From rough rock to mud: Lambert levels that meet the backscattering strengths of APL-UW's model at 20 degrees
/// (APL-UW High-Frequency Ocean Environmental Acoustic Models Handbook, TR 9407, 1994).
inline constexpr sediment sediments[] = {
    {"rough rock", 3.1f},    {"rock", -2.7f},         {"cobble", -6.9f},      {"sandy gravel", -10.0f},
    {"coarse sand", -12.5f}, {"medium sand", -14.9f}, {"fine sand", -17.9f},  {"very fine sand", -17.7f},
    {"coarse silt", -18.5f}, {"sandy mud", -22.5f},   {"silty clay", -22.6f},
};

/// One of `sediments` by its name.
/// @throws invalid_input for a name that isn't there
inline const sediment& sediment_of(std::string_view name) {
    for (const sediment& s : sediments)
        if (s.name == name) return s;
    detail::raise(
        invalid_input("sediment \"" + std::string(name) + "\" is unknown, expected one of insonify::sediments"));
}

}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
