// Parameters of image i of the published recipe: drawn from the seed and i alone, or given by a plan.
#pragma once

#include <algorithm>
#include <string>

#include "options.hpp"
#include "sampler.hpp"
#include "shared_inputs.hpp"
#include "views.hpp"

namespace generator {

struct plan {
    std::uint64_t index;
    std::string class_name, seabed;
    bool referenced;
    std::size_t reference;  ///< index, if `referenced`

    double size;                      ///< metres: a height or diameter, of a mesh half of its largest extent
    glm::dvec3 extents;               ///< length, width and height, metres
    double yaw, pitch, roll, burial;  ///< radians, share of the height
    double altitude, light, rig_yaw;  ///< metres, radians
    double across, along;             ///< of the target: shares from the left, and from below (a sonar's: from above)
    double place_x, place_y;          ///< world position of the camera or of the sonar's target, metres
    std::uint32_t seabed_seed, noise_seed;
    double relief, wavelength, direction;  ///< of the seabed: in [0, 1], metres, radians
    double distance, beam;                 ///< of the target from the track, in altitudes; beamwidth, radians
    bool port;                             ///< the target is to port of the track
    double noise;                          ///< noise floor of a side-scan picture
    std::string display;                   ///< of a side-scan picture: amplitude, power or decibels
    double white, display_range;           ///< intensity shown white, decibels from black to white

    nlohmann::ordered_json values;  ///< all values, by column
    std::map<std::string, std::vector<std::string>> choices;
};

namespace detail {

inline double radians(double degrees) {
    return insonify::numeric::to_radians(degrees);
}

/// Size, tilt and burial of the target. With a target id, the random sequence depends on the id alone.
inline void sample_target(sampler& s, plan& p, const options& o, const shared_inputs& shared) {
    const auto from = [&](const char* name, const range& r) { return s.uniform(name, r.low, r.high); };
    p.size = from("target_size_m", o.target_size);
    const double a = from("aspect", o.aspect);
    const glm::dvec3 usual = p.class_name == "cylinder" ? glm::dvec3(3 * a, 1, 1)
                             : p.class_name == "cube"   ? glm::dvec3(1, a, 1)
                             : p.class_name == "cone"   ? glm::dvec3(1.2 * a, 1.2 * a, 1.2)
                             : p.class_name == "sphere" ? glm::dvec3(a, 1, 1)
                                                        : 2.0 * shared.extents_of_mesh(p.class_name);
    // A flat mesh has an extent of 0.
    p.extents.x = s.derived("length_m", (std::max)(usual.x * p.size, 1e-3));
    p.extents.y = s.derived("width_m", (std::max)(usual.y * p.size, 1e-3));
    p.extents.z = s.derived("height_m", (std::max)(usual.z * p.size, 1e-3));
    p.pitch = radians(from("pitch_deg", o.tilt));
    p.roll = radians(from("roll_deg", o.tilt));
    p.burial = from("burial", o.burial);
}

inline void sample_reference(sampler& s, plan& p, const shared_inputs& shared, bool is_drawn) {
    const auto count = static_cast<int>(shared.references());
    const auto drawn = static_cast<int>(s.drawn(0, count));
    int chosen = s.derived_whole("reference", is_drawn && count > 0 ? drawn : -1);
    if (const std::string* const name = s.given("reference_name")) {
        const std::optional<std::size_t> found = shared.find_reference(*name, chosen);
        if (!found) s.refuse("reference_name", "the name of a file of --reference");
        chosen = static_cast<int>(*found);
    } else if (chosen >= count) {
        s.refuse("reference", "-1, or the number of a --reference");
    }
    p.referenced = chosen >= 0;
    p.reference = p.referenced ? static_cast<std::size_t>(chosen) : 0;
    s.name_of("reference_name", p.referenced ? shared.reference_name(p.reference) : "");
    if (!p.referenced) s.drop("reference_name");
}

}  // namespace detail

/// @param index  of the image
/// @param given  a line of a plan, or null
inline plan plan_image(const options& o, std::uint64_t index, const view_of_target& view, const shared_inputs& shared,
                       const plan_row* given) {
    using detail::radians;
    // --demo shows the same scenes twice: plain, and matched with a reference.
    const std::uint64_t scenes = class_names(o).size() * (std::max<std::size_t>)(o.seabeds.size(), 1);
    const insonify::random_sequence of_image(o.seed, 1, o.demo ? index % scenes : index);
    sampler s(of_image, given);
    const auto from = [&](const char* name, const range& r) { return s.uniform(name, r.low, r.high); };
    plan p{};
    p.index = index;
    p.class_name = s.name_of("class", view.class_name);
    if (const auto known = class_names(o); std::find(known.begin(), known.end(), p.class_name) == known.end())
        s.refuse("class", "a class of --targets or --mesh");
    std::vector<weighted> seabeds;
    for (const char* const name : seabed_names)
        if (name != std::string("heightmap") || !o.heightmap.empty()) seabeds.push_back({name});
    p.seabed = s.choice("seabed", seabeds, view.seabed);
    const std::string target_id = s.name_of("target_id", view.target_id);
    if (target_id.empty())
        s.drop("target_id");
    else
        s.draw_from(insonify::random_sequence(o.seed, 2, target_key(target_id)));
    detail::sample_target(s, p, o, shared);
    s.draw_from(of_image);

    const bool sonar = !o.is_overhead();
    p.altitude = from("altitude_m", o.altitude);
    p.light = radians(from("light_deg", o.grazing));
    const double rig_yaw = s.uniform("rig_yaw_deg", 0, 360);
    p.rig_yaw = radians(rig_yaw);
    p.port = s.choice("side", {{"port"}, {"starboard"}}) == "port";
    double yaw = s.drawn(0, 360);
    if (const std::optional<double> aspect = aspect_of(s, view))
        yaw = rig_yaw + *aspect + (sonar && p.port ? 180.0 : 0.0);
    p.yaw = radians(s.derived("yaw_deg", yaw));
    const placement_range place = placement_range_of(o);
    p.across = from("across", place.across);
    p.along = from("along", place.along);
    p.place_x = s.uniform("place_x_m", -500, 500);
    p.place_y = s.uniform("place_y_m", -500, 500);
    p.seabed_seed = s.word("seabed_seed");
    p.noise_seed = s.word("noise_seed");
    p.relief = s.uniform("relief", 0, 1);
    p.wavelength = s.uniform("ripple_wavelength_m", 0.5, 1.1);
    p.direction = radians(s.uniform("ripple_direction_deg", 0, 360));
    p.distance = from("distance", o.distance);
    p.beam = radians(from("beam_deg", o.beam));
    p.noise = s.uniform("noise_floor", 0.003, 0.03);
    p.white = from("white", o.white.value_or(range{4, 12}));
    detail::sample_reference(s, p, shared, !o.demo || index >= scenes);
    p.display = s.choice("display", {{"amplitude"}, {"power", 0}, {"decibels", 0}}, o.display);
    p.display_range = from("display_range_db", o.display_range.value_or(range{40, 40}));

    // Drop values without meaning in this image.
    const auto drop_unless = [&](bool has_meaning, std::initializer_list<const char*> names) {
        if (!has_meaning)
            for (const char* const name : names) s.drop(name);
    };
    const bool rippled = p.seabed == "ripples" || p.seabed == "mixed";
    drop_unless(sonar, {"side", "distance", "beam_deg", "noise_floor", "white", "display"});
    drop_unless(sonar && p.display == "decibels", {"display_range_db"});
    drop_unless(!sonar, {"light_deg"});
    drop_unless(rippled || p.seabed == "rock", {"relief"});
    drop_unless(rippled, {"ripple_wavelength_m", "ripple_direction_deg"});
    drop_unless(p.seabed != "heightmap", {"place_x_m", "place_y_m"});
    p.values = s.values();
    p.choices = s.choices();
    return p;
}

/// The same without a plan.
inline plan plan_image(const options& o, std::uint64_t index, const shared_inputs& shared) {
    return plan_image(o, index, view_of(o, index), shared, nullptr);
}

}  // namespace generator
