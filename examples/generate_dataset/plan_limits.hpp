// Limits of a plan's numbers: wide enough for any sea floor, narrow enough that each scene can be drawn.
#pragma once

#include <string_view>

namespace generator {

struct limits {
    double low, high;
};

/// Limits of a column, by its name or the ending of its name.
constexpr limits limits_of(std::string_view column) {
    struct rule {
        std::string_view ending;
        limits within;
    };
    constexpr rule rules[] = {
        // Counts.
        {"clutter", {0, 1000}},
        {"debris", {0, 1000}},
        {"looks", {1, 64}},
        {"looks_drawn", {1, 64}},
        {"quarter_turns", {0, 7}},
        {"surface_return", {0, 1000}},
        {"turn", {0, 7}},
        {"trawls", {0, 100}},
        {"fill", {0.01, 100}},
        {"reference", {-1, 1e9}},
        // Sizes and positions.
        {"chip_m", {0.01, 1e4}},
        {"track_m", {0.01, 1e4}},
        {"place_x_m", {-1e6, 1e6}},
        {"place_y_m", {-1e6, 1e6}},
        {"first_range_m", {0, 9e4}},
        {"altitude_m", {0.01, 1e4}},
        {"distance", {0, 1e3}},
        {"target_size_m", {1e-3, 1e3}},
        // Those of the bottom's look are some of its pixels, at any size of the chip.
        {"drift_length_m", {1e-5, 1e9}},
        {"streak_length_m", {1e-5, 1e9}},
        {"streak_width_m", {1e-5, 1e5}},
        {"growth_length_m", {1e-5, 1e9}},
        {"patch_size_m", {1e-5, 1e9}},
        {"length_m", {1e-2, 1e3}},
        {"width_m", {1e-3, 1e3}},
        {"height_m", {1e-3, 1e3}},
        {"wavelength_m", {1e-2, 1e3}},
        {"feature_m", {1e-5, 1e4}},
        {"pulse_m", {0, 1e3}},
        {"clutter_size_m", {1e-5, 1e3}},
        {"_m", {1e-4, 1e5}},
        {"gain_error_px", {1, 1e5}},
        {"banding_px", {1, 1e5}},
        {"pulse_px", {0, 16}},
        {"across_px", {0, 16}},
        {"along_px", {0, 16}},
        {"_px", {0.1, 1e4}},
        {"across", {-1, 2}},
        {"along", {-1, 2}},
        // Shares.
        {"damage", {0, 1}},
        {"burial", {0, 0.95}},
        {"scour", {0, 1}},
        {"cover", {0, 1}},
        {"relief", {0, 1}},
        {"patch_share", {0.01, 0.99}},
        {"black_share", {0, 0.49}},
        {"white_share", {0, 0.49}},
        {"share", {0, 1}},
        // Angles.
        {"light_deg", {0.01, 90}},
        {"beam_deg", {1e-3, 20}},
        {"beam_rad", {1e-6, 1}},
        {"survey_grazing_deg", {0.01, 80}},
        {"grazing_deg", {0.01, 90}},
        {"_deg", {-1e4, 1e4}},
        {"_rad", {-1e3, 1e3}},
        // Levels and strengths.
        {"growth_db", {0, 30}},
        {"tone_drift_db", {0, 30}},
        {"tone_streaks_db", {0, 30}},
        {"tone_patches_db", {-30, 30}},
        {"gain_error_db", {0, 60}},
        {"gain_slope_db", {-60, 60}},
        {"banding_drift_db", {0, 60}},
        {"banding_jitter_db", {0, 60}},
        {"display_range_db", {1, 400}},
        {"_db", {-100, 100}},
        {"reflectivity", {0, 1e6}},
        {"aspect", {1e-2, 1e2}},
        {"steepness", {0, 0.5}},
        {"swell", {0, 0.5}},
        {"roughness", {0, 1}},
        {"disorder", {0, 0.3}},
        {"facets", {0, 100}},
        {"volume_scatter", {0, 100}},
        {"enlarged", {0, 100}},
        {"facet_slope", {0.01, 1}},
        {"white", {1e-3, 1e6}},
        {"exponent", {0.01, 4}},
        {"noise_floor", {0, 1e6}},
        {"volume", {0, 1e6}},
        {"texture", {0, 1e6}},
        // Ratios.
        {"beam_factor", {0, 100}},
        {"depth_over_altitude", {1e-3, 1e3}},
        {"display_range_factor", {0.01, 7}},
        {"ping_stretch", {0.01, 100}},
        {"streak_ratio", {0.01, 1e4}},
    };
    for (const rule& r : rules)
        if (column.size() >= r.ending.size() && column.substr(column.size() - r.ending.size()) == r.ending)
            return r.within;
    return {-1e6, 1e6};
}

}  // namespace generator
