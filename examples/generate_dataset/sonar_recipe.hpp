// Samples the recipe `sonar`: side-scan and synthetic-aperture chips of wrecks, aeroplanes, clutter and bare bottoms,
// cut from survey lines. Each value is sampled by name and written to manifest.csv; docs/recipe.md explains all of
// them.
#pragma once

#include <insonify/geometry/objects/footprint.hpp>
#include <insonify/seabed/blend.hpp>
#include <insonify/seabed/edit.hpp>
#include <insonify/seabed/moat.hpp>
#include <insonify/seabed/sculpt.hpp>
#include <insonify/sonar/bottom_tone.hpp>
#include <insonify/sonar/instruments.hpp>
#include <insonify/sonar/side_scan/ping_gain.hpp>
#include <insonify/sonar/side_scan/sonar_equation.hpp>
#include <insonify/sonar/side_scan/water_column.hpp>

#include "objects.hpp"
#include "options.hpp"
#include "sampler.hpp"
#include "target_geometry.hpp"
#include "views.hpp"

namespace generator {

/// The class of images without a target.
inline constexpr const char* empty_class = "empty";
/// The category of objects that are not targets.
inline constexpr const char* clutter_class = "clutter";

inline constexpr int max_targets = 3;

/// One object and its pose in the scene.
struct placed_object {
    object_form form;
    double yaw, pitch, roll, burial, reflectivity;  ///< radians; share of the height; relative to the bottom's
    double across, along;                           ///< of its centre, in chips from the first range and the first ping
    double scour;                                   ///< depth over the object's height
};

/// All sampled values of one image.
struct sonar_plan {
    std::string class_name;
    in::instrument sonar;
    std::vector<placed_object> targets;
    double chip, track;                                       ///< across and along the track, metres
    double altitude, first_range, rig_yaw, place_x, place_y;  ///< metres, radians
    bool port, ground_range;

    std::string bottom;
    std::uint32_t bottom_seed;
    double feature, steepness, direction, disorder, roughness, cover, swell,
        trawls;  ///< of the bottom; lengths in metres
    int clutter, debris;
    double clutter_size;
    std::uint32_t clutter_seed;

    double facets, facet_slope, volume_scatter, pulse, beam;  ///< -, -, -, metres, radians
    double growth, growth_length;                             ///< decibels, metres
    std::uint32_t growth_seed;
    in::bottom_tone tone;
    in::range_gain_error gain;
    in::ping_banding banding;
    in::water_column water;
    int looks;
    double speckle_length_across, speckle_length_along;  ///< pixels
    double texture;                                      ///< shape of the K-distribution; 0: none
    std::uint32_t noise_seed;
    std::string display;
    double white, exponent, dynamic_range, black_share, white_share;
    double enlarged;  ///< image pixels per screen pixel
    int turn;         ///< quarter turns, plus 4 for a mirrored image
};

namespace detail {

/// How objects of a kind lie on the bottom, and what surrounds them.
struct found_objects {
    range fill{0.1, 0.4};                ///< extent over the chip's
    double inspected = 0.15;             ///< share recorded by a line that runs along the object
    double line_step = in::numeric::pi;  ///< angle between the headings that such lines choose from, radians
    double on_side = 0;                  ///< share that lies on its side
    double proud = 0.5, deepest = 0.3;   ///< share that isn't buried; burial of the others, at most
    double list_unburied = 1.0 / 6;      ///< list of what isn't buried, over that of what is buried deepest
    range reflectivity{0.5, 10};         ///< over the bottom's
    double unscoured = 0.7;              ///< share without scour
    double debris = 0.1;                 ///< share with debris about it
    range growth{0.5, 3.5};              ///< decibels
    double greatest_drift = 2.5;         ///< of the bottom's tone, decibels
};

inline found_objects found_objects_of(const std::string& kind) {
    // Hulls sink in. The sediment that they have trapped and scoured differs from the bottom's, and their chips are
    // large.
    if (kind == "ship")
        return {.fill = {0.7, 1.35},
                .on_side = 0.15,
                .proud = 0.1,
                .deepest = 0.55,
                .list_unburied = 1,
                .reflectivity = {1, 10},
                .debris = 0.85,
                .growth = {1.5, 5},
                .greatest_drift = 4};
    // Aeroplanes are light and flat: buried ones aren't found. Lines run along the fuselage or along the wings. Scour
    // around their outline is too small to tell from wreckage.
    if (kind == "plane")
        return {.fill = {0.7, 1.35},
                .inspected = 0.6,
                .line_step = in::numeric::pi / 2,
                .proud = 0.9,
                .deepest = 0.4,
                .list_unburied = 1,
                .reflectivity = {1, 20},
                .unscoured = 0.95,
                .debris = 0.55,
                .greatest_drift = 1.2};
    if (kind == "pipe") return {.fill = {0.4, 1.2}};
    // Chips of small objects show their shadows, at the resolution of a sonar. They stand on the bottom, upright, or
    // have sunk in a little and tilted. Wood and rubber echo less than gravel.
    return {};
}

/// Samples one object. The values of an unused object are sampled, too, so that those after it stay the same, and then
/// dropped from the manifest.
/// @param track  direction of the sonar's track, radians
inline placed_object sample_object(sampler& s, const std::string& prefix, const std::string& kind, bool used,
                                   const placement_range& place, double track) {
    const auto name = [&](const char* what) { return prefix + what; };
    const object_kind* const known = kind_named(kind);
    placed_object o{};
    o.form.kind = kind;
    o.form.seed = s.word(name("form"));
    o.form.length = s.logarithmic(name("length_m"), known->shortest, known->longest);
    if (prefix == "t1_" && s.given("t1_length_m") == nullptr && s.given("length_m") != nullptr)
        o.form.length = s.derived("t1_length_m", s.number_or("length_m", 0));
    o.form.damage = s.uniform(name("damage"), 0, 1);
    const found_objects found = found_objects_of(kind);
    // Inspection lines run along a wreck; survey lines cross it at any angle.
    const bool is_inspected = s.chance(name("along_line"), found.inspected);
    double heading = s.uniform(name("heading_rad"), -in::numeric::pi, in::numeric::pi);
    if (is_inspected) {
        const double along =
            found.line_step * static_cast<double>(in::numeric::floor_to_int(heading / found.line_step + 0.5));
        heading = along + (0.6 / found.line_step) * (heading - along);
    }
    o.yaw = s.derived(name("yaw_rad"), track + heading);
    o.pitch = s.uniform(name("pitch_rad"), -0.06, 0.06);
    const bool on_side = s.chance(name("on_side"), found.on_side);
    const double list = on_side ? s.uniform(name("list_rad"), 0.9, 1.8) : s.uniform(name("list_rad"), -0.3, 0.3);
    const bool is_settled = kind == "ship" && o.form.damage > 0.5;
    o.burial = s.uniform_or_0(name("burial"), found.proud, 0.02, is_settled ? 0.8 : found.deepest);
    const double sunk = (std::min)(o.burial / found.deepest, 1.0);
    o.roll = s.derived(name("roll_rad"), list * (found.list_unburied + (1 - found.list_unburied) * sunk));
    o.reflectivity = s.logarithmic(name("reflectivity"), found.reflectivity.low, found.reflectivity.high);
    o.across = s.uniform(name("across"), place.across.low, place.across.high);
    o.along = s.uniform(name("along"), place.along.low, place.along.high);
    o.scour = s.uniform_or_0(name("scour"), found.unscoured, 0.02, 0.15);
    if (!used)
        for (const char* const what :
             {"form", "length_m", "damage", "along_line", "heading_rad", "yaw_rad", "pitch_rad", "on_side", "list_rad",
              "roll_rad", "burial", "reflectivity", "across", "along", "scour"})
            s.drop(name(what));
    return o;
}

/// Scales a mesh to the width and height that a plan gives, if it gives any.
/// @param is_first  whether it is the first target, whose size a plan may give without a prefix
inline in::mesh sized(sampler& s, const std::string& prefix, in::mesh shape, bool is_first) {
    const glm::dvec3 size = in::bounds(shape).size();
    const auto factor = [&](const char* plain, double as_it_is) {
        const double given = is_first ? s.number_or(plain, as_it_is) : as_it_is;
        return s.derived(prefix + plain, given) / as_it_is;
    };
    const double y = factor("width_m", size.y), z = factor("height_m", size.z);
    if (y == 1 && z == 1) return shape;
    return in::transformed(std::move(shape), {glm::dmat3({1, 0, 0}, {0, y, 0}, {0, 0, z}), {}});
}

/// The longer horizontal side of a mesh's box, metres.
inline double extent_of(const in::mesh& m) {
    const in::bounding_box box = in::bounds(m);
    return (std::max)(box.size().x, box.size().y);
}

/// Extent of a mesh along the track over its extent across it, clamped to [0.5, 2].
/// @param heading  of the mesh, from across the track, radians
inline double slenderness(const in::mesh& m, double heading) {
    const glm::dvec3 size = in::bounds(m).size();
    const auto turn = in::numeric::sin_cos(heading);
    const double c = (std::max)(turn.cosine, -turn.cosine), s = (std::max)(turn.sine, -turn.sine);
    const double ratio = (size.x * s + size.y * c) / (size.x * c + size.y * s);
    return (std::min)((std::max)(ratio, 0.5), 2.0);
}

inline void sample_bottom(sampler& s, sonar_plan& p, double pixel, const view_of_target& view) {
    p.bottom = s.choice("seabed", {{"sand", 0.45}, {"ripples", 0.25}, {"mud", 0.12}, {"rock", 0.04}, {"mixed", 0.12}},
                        view.seabed);
    p.bottom_seed = s.word("seabed_seed");
    p.feature = s.derived("feature_m", pixel * s.logarithmic("feature_px", 2.2, 14));
    p.steepness = s.logarithmic("steepness", 0.02, 0.12);
    p.direction = s.uniform("ripple_direction_rad", 0, 2 * in::numeric::pi);
    p.disorder = s.uniform("disorder", 0.06, 0.3);
    p.roughness = s.logarithmic("roughness", 4e-4, 0.1);
    p.cover = s.uniform("cover", 0.15, 0.75);
    p.swell = s.uniform_or_0("swell", 0.45, 0.01, 0.08);
    p.trawls = s.uniform_or_0("trawls", 0.65, 0.3, 2);

    const found_objects found = found_objects_of(p.class_name);
    p.tone.drift = static_cast<float>(p.targets.empty() ? s.logarithmic("tone_drift_db", 0.1, 1.4)
                                                        : s.logarithmic("tone_drift_db", 0.05, found.greatest_drift));
    p.tone.drift_length =
        static_cast<float>(s.derived("tone_drift_length_m", pixel * s.logarithmic("drift_px", 15, 120)));
    p.tone.streaks = static_cast<float>(s.uniform_or_0("tone_streaks_db", 0.7, 0.2, 1.1));
    p.tone.streak_width = static_cast<float>(s.derived("streak_width_m", pixel * s.uniform("streak_px", 1.2, 5)));
    p.tone.streak_length = static_cast<float>(
        s.derived("streak_length_m", static_cast<double>(p.tone.streak_width) * s.uniform("streak_ratio", 8, 60)));
    p.tone.direction = static_cast<float>(s.uniform("streak_direction_rad", 0, in::numeric::pi));
    p.tone.patches = static_cast<float>(s.uniform_or_0("tone_patches_db", 0.78, -4, 4));
    p.tone.patch_size = static_cast<float>(s.derived("patch_size_m", pixel * s.logarithmic("patch_px", 15, 70)));
    p.tone.patch_coverage = static_cast<float>(s.uniform("patch_share", 0.1, 0.6));
    p.tone.seed = s.word("tone_seed");

    p.clutter = s.whole("clutter", 1, 9);
    if (!s.chance("has_clutter", p.class_name == empty_class ? 0.1 : 0.3)) p.clutter = 0, s.drop("clutter");
    // Debris lies around a wreck.
    p.debris = s.whole("debris", 3, 36);
    if (!s.chance("has_debris", found.debris) || p.targets.empty()) p.debris = 0, s.drop("debris");
    p.clutter_size = s.derived("clutter_size_m", pixel * s.uniform("clutter_px", 1.2, 4.5));
    p.clutter_seed = s.word("clutter_seed");
}

inline void sample_look(const options& o, sampler& s, sonar_plan& p, double pixel, double slant) {
    p.facets = s.uniform("facets", 0, 6);
    p.facet_slope = s.uniform("facet_slope", 0.08, 0.3);
    p.volume_scatter = s.logarithmic("volume_scatter", 0.05, 0.8);
    const range growth = found_objects_of(p.class_name).growth;
    p.growth = s.uniform("growth_db", growth.low, growth.high);
    p.growth_length = s.derived("growth_length_m", pixel * s.uniform("growth_px", 1.2, 4));
    p.growth_seed = s.word("growth_seed");
    const double pulse =
        (std::max)(static_cast<double>(p.sonar.range_resolution), pixel * s.uniform("pulse_px", 0.2, 1.2));
    p.pulse = s.derived("pulse_m", (std::min)(pulse, p.chip));
    if (p.pulse > p.chip) s.refuse("pulse_m", "metres up to the width of the chip");
    const double beam = p.sonar.is_synthetic_aperture() ? static_cast<double>(p.sonar.along_track_resolution) / slant
                                                        : static_cast<double>(p.sonar.beamwidth);
    p.beam = s.derived("beam_rad", (std::max)(beam * s.uniform("beam_factor", 0.7, 1.5), 0.3 * pixel / slant));

    p.gain.rms = static_cast<float>(s.logarithmic("gain_error_db", 0.05, 1.5));
    p.gain.length = static_cast<float>(s.uniform("gain_error_px", 25, 120));
    // Up or down by 0.2 to 8 dB over the chip, uniform in the logarithm: spreading, absorption and the beam pattern are
    // compensated by rules of thumb.
    const double tilt = s.drawn(-1, 1), size = 0.2 * in::numeric::exp(in::numeric::abs(tilt) * in::numeric::log(40.0));
    p.gain.slope = static_cast<float>(s.derived("gain_slope_db", tilt < 0 ? -size : size));
    p.gain.seed = s.word("gain_seed");
    p.banding.drift = static_cast<float>(s.uniform_or_0("banding_drift_db", 0.5, 0.1, 0.9));
    p.banding.length = static_cast<float>(s.uniform("banding_px", 3, 30));
    p.banding.jitter = static_cast<float>(s.uniform_or_0("banding_jitter_db", 0.6, 0.05, 0.5));
    p.banding.seed = s.word("banding_seed");

    p.water.noise = static_cast<float>(s.logarithmic("noise_floor", 3e-4, 0.04));
    p.water.noise_range = static_cast<float>(slant);
    p.water.absorption_per_km = p.sonar.absorption_per_km;
    p.water.volume = static_cast<float>(s.logarithmic("volume", 1e-4, 1e-2));
    p.water.surface = static_cast<float>(s.uniform_or_0("surface_return", 0.6, 0.01, 0.6));
    p.water.surface_range = static_cast<float>(p.altitude * s.uniform("depth_over_altitude", 0.3, 3));
    p.water.surface_tail = static_cast<float>(0.04 * p.altitude);
    p.water.waves = static_cast<float>(0.01 * p.altitude);
    p.water.seed = p.banding.seed;

    p.looks = s.derived_whole("looks", static_cast<int>(s.logarithmic("looks_drawn", 1.2, 17)));
    p.speckle_length_across = (std::min)(
        (std::max)(p.sonar.speckle_length_across() / pixel, s.uniform_or_0("grain_across_px", 0.92, 0.3, 1.1)), 16.0);
    p.speckle_length_along = (std::min)(
        (std::max)(p.sonar.speckle_length_along(slant) / pixel, s.uniform_or_0("grain_along_px", 0.55, 0.3, 2)), 16.0);
    p.speckle_length_across = s.derived("correlation_across_px", p.speckle_length_across);
    p.speckle_length_along = s.derived("correlation_along_px", p.speckle_length_along);
    p.texture = s.uniform_or_0("texture", 0.75, 4, 15);
    if (p.texture > 0 && p.texture < 0.01) s.refuse("texture", "0, or a number from 0.01");
    p.noise_seed = s.word("noise_seed");

    p.display =
        s.choice("display", {{"amplitude", 0.5}, {"decibels", 0.25}, {"power", 0.05}, {"automatic", 0.2}}, o.display);
    // Operators set the gain so that the bottom is mid-gray; white lies 6 to 18 dB above it.
    const range white = o.white.value_or(range{2, 32});
    p.white = s.logarithmic("white", white.low, white.high);
    p.exponent = s.uniform("exponent", 0.33, 0.62);
    const double factor = s.uniform("display_range_factor", 0.5, 1.1);
    p.dynamic_range = factor * static_cast<double>(p.sonar.dynamic_range);
    if (const auto& r = o.display_range) p.dynamic_range = r->low + (r->high - r->low) * (factor - 0.5) / 0.6;
    p.dynamic_range = s.derived("display_range_db", p.dynamic_range);
    p.black_share = s.uniform("black_share", 0, 0.02);
    p.white_share = s.uniform("white_share", 0, 0.03);
    // Images of targets are often zoomed.
    p.enlarged = s.uniform_or_0("enlarged", p.targets.empty() ? 0.88 : 0.55, 1.1, 2.2);
    // Waterfall displays run up or down the screen; charts have any orientation.
    const int turned = s.whole("quarter_turns", 0, 7);
    p.turn = s.derived_whole("turn", s.chance("is_chart", 0.3) ? turned : turned / 2 * 2);
}

}  // namespace detail

/// The random numbers of one attempt at an image.
inline in::random_sequence numbers_of(const options& o, std::uint64_t index, std::uint32_t attempt) {
    return in::random_sequence(o.seed, 0x736F6E00u + attempt, index);
}

/// Samples an image.
/// @param view    values used where the plan gives none
/// @param shapes  set to the targets' meshes, in their own frames
inline sonar_plan sample_image(const options& o, sampler& s, const view_of_target& view,
                               std::vector<in::mesh>& shapes) {
    sonar_plan p{};
    p.class_name = s.name_of("class", view.class_name);
    const bool empty = p.class_name == empty_class;
    if (!empty && kind_named(p.class_name) == nullptr) s.refuse("class", "empty, or a kind of object");
    const std::string target_id = s.name_of("target_id", view.target_id);
    if (target_id.empty()) s.drop("target_id");
    const int more = s.choice("targets", {{"1", 0.9}, {"2", 0.07}, {"3", 0.03}})[0] - '0';
    p.rig_yaw = s.uniform("rig_yaw_rad", 0, 2 * in::numeric::pi);
    for (int i = 0; i < max_targets; ++i) {
        const std::string prefix = "t" + std::to_string(i + 1) + "_";
        const bool used = !empty && i < more;
        const std::string kind = s.name_of(prefix + "kind", empty ? "boulder" : p.class_name);
        if (kind != (empty ? "boulder" : p.class_name)) s.refuse(prefix + "kind", "the image's class");
        // All images with the same target_id show the same object.
        const bool is_shared = used && i == 0 && !target_id.empty();
        in::random_sequence of_image(0);
        if (is_shared) of_image = s.draw_from(in::random_sequence(o.seed, 0x74617200u, target_key(target_id)));
        placed_object t =
            detail::sample_object(s, prefix, kind, used, placement_range_of(o), p.rig_yaw + in::numeric::pi / 2);
        if (is_shared) s.draw_from(of_image);
        if (!used) s.drop(prefix + "kind");
        if (used) p.targets.push_back(t), shapes.push_back(detail::sized(s, prefix, mesh_of(t.form), i == 0));
        if (!used) s.drop(prefix + "width_m"), s.drop(prefix + "height_m");
    }

    p.port = s.chance("port", 0.5);
    if (const auto aspect = aspect_of(s, view); aspect && !p.targets.empty()) {
        const double line_of_sight = p.rig_yaw + (p.port ? in::numeric::pi : 0);
        p.targets.front().yaw = s.derived("t1_yaw_rad", line_of_sight + in::numeric::to_radians(*aspect));
    }

    // The first target sizes the chip; that of an empty image is sampled.
    const double share = s.chance("is_small", 0.06) ? 0.4 : 1.0;
    const range filled = detail::found_objects_of(p.class_name).fill;
    const double fill = share * s.uniform("fill", filled.low, filled.high), bare = s.logarithmic("bare_chip_m", 6, 160);
    // Crops follow the target's outline: the chip is longer along a slender target.
    const double closeness = s.uniform("crop_share", 0, 1),
                 slender = empty ? 1 : detail::slenderness(shapes.front(), p.targets.front().yaw - p.rig_yaw);
    const double crop = in::numeric::exp(0.5 * closeness * in::numeric::log(slender));
    p.chip = s.derived("chip_m", empty ? bare : detail::extent_of(shapes.front()) / (fill * crop));
    const double pixel = p.chip / o.size;
    // A ping is one row at any speed of the vehicle: pixels are stretched along the track.
    p.track = s.derived("track_m", crop * crop * p.chip * s.logarithmic("ping_stretch", 0.67, 1.5));

    // Candidates reach beyond the chip's width, but at most 60 times as far: long-range sonars are too coarse for
    // small chips.
    std::vector<weighted> sonars;
    bool any_fits = false;
    for (const in::instrument& i : in::instruments::all) {
        const double range = static_cast<double>(i.range);
        const bool fits = range > 1.15 * p.chip && range < 60 * p.chip;
        sonars.push_back({std::string(i.name), fits ? 1.0 : 0.0});
        any_fits = any_fits || fits;
    }
    const std::string otherwise = any_fits ? "" : p.chip > 20 ? "side_scan_450" : "side_scan_1800";
    p.sonar = in::instrument_named(s.choice("sonar", sonars, otherwise));
    // The range is limited so that the beam is at most 5 pixels wide.
    const double sharp = p.sonar.is_synthetic_aperture() ? 1e9 : 5 * pixel / static_cast<double>(p.sonar.beamwidth);
    const double reach = (std::max)((std::min)(static_cast<double>(p.sonar.range), sharp), 1.3 * p.chip);
    const double lead = p.targets.empty() ? 0.5 : std::clamp(p.targets.front().across, 0.05, 1.0);
    // The slant range to the target is anything that the sonar's range allows. The altitude gives it the grazing angle
    // of survey or inspection lines. Unless the water column is to be in view, the chip begins beyond the first return.
    const double sine = in::numeric::sin_cos(in::numeric::to_radians(s.logarithmic("survey_grazing_deg", 10, 44))).sine;
    double slant = lead * p.chip + s.uniform("range_share", 0.03, 1) * (reach - p.chip);
    if (!s.chance("water_in_view", empty ? 0.04 : 0.2))
        slant = (std::max)(slant, lead * p.chip / (1 - sine / (0.75 * sine + 0.25)));
    p.first_range = s.derived("first_range_m", slant - lead * p.chip);
    // Noise, beam and grain depend on the range, which a plan may have given.
    slant = p.first_range + lead * p.chip;
    p.altitude = s.derived("altitude_m", slant * sine);
    p.place_x = s.uniform("place_x_m", -500, 500);
    p.place_y = s.uniform("place_y_m", -500, 500);
    p.ground_range = s.chance("ground_range", 0.3);
    detail::sample_bottom(s, p, pixel, view);
    detail::sample_look(o, s, p, pixel, slant);
    return p;
}

}  // namespace generator
