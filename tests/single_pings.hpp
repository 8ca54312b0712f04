// Recordings of a single ping over level ground, for side-scan tests against closed forms.
#pragma once

#include <insonify/all.hpp>

namespace single_pings {

namespace in = insonify;

/// Level ground without roughness.
inline const in::seabed::flat level_ground{.surface = {.rms = 0}};

/// A bin holds reflectivity x sine^2 x area.
inline const auto cross_sections = in::record_options<>{}.with(in::sonar_equation<>{});

/// A single ping through the middle of the targets at y = 0.
/// @param ping_spacing  metres of track that the ping stands for
inline in::side_scan one_ping(double altitude, double range, int bins, float ping_spacing = 0.02f) {
    return {.altitude = static_cast<float>(altitude),
            .ping_spacing = ping_spacing,
            .pings = 1,
            .range = static_cast<float>(range),
            .bins = bins};
}
/// The same for a metre of track.
inline in::side_scan one_metre(double altitude, double range, int bins) {
    return one_ping(altitude, range, bins, 1);
}

}  // namespace single_pings
