// Renders one image of the recipe `sonar`, with its labels.
#pragma once

#include "sonar_screen.hpp"

namespace generator {

struct sonar_picture {
    in::labels labels;
    in::image<float> values;  ///< before quantization to 8 bits
    in::image<std::uint8_t> gray;
    target_geometry geometry{};     ///< of the first target, before the image is turned
    std::vector<in::pose> poses;    ///< of the targets
    std::vector<double> footprint;  ///< of each target on the bottom, pixels
    glm::dvec2 rig{0, 0};
    glm::dvec2 metres_per_pixel{0, 0};  ///< along a row and along a column of the turned image
};

namespace detail {

inline in::seabed::any bottom_of(const sonar_plan& p, double pixel) {
    namespace sb = in::seabed;
    const auto of = [](double metres) { return static_cast<float>(metres); };
    // The seabed models take most lengths from 1 mm on.
    const auto length = [](double metres) { return static_cast<float>((std::max)(metres, 1e-3)); };
    const auto feature = of(p.feature), fine = of(1.2 * pixel);
    // Relief is proportional to its length scale, which keeps its slopes.
    const auto rough = [&](double longest, double share) {
        return sb::roughness{
            .rms = of(share * longest), .longest = of(longest), .shortest = (std::min)(fine, of(longest))};
    };
    const sb::flat sand{.surface = rough((std::max)(4 * p.feature, 8 * pixel), 0.25 * p.roughness),
                        .seed = p.bottom_seed};
    const sb::ripples ripples{.wavelength = feature,
                              .steepness = of(p.steepness),
                              .direction = of(p.direction),
                              .spread = of(p.disorder),
                              .bandwidth = of(0.8 * p.disorder),
                              .second = {.wavelength = of(7 * p.feature),
                                         .steepness = of(p.swell),
                                         .direction = of(p.direction + 0.5),
                                         .spread = 0.2f,
                                         .bandwidth = 0.2f},
                              .surface = rough((std::max)(p.feature, 3 * pixel), 0.3 * p.roughness),
                              .seed = p.bottom_seed};
    const sb::trawl_marks trawls{.density = of((std::min)({4 * p.trawls / p.chip, 0.08 / pixel, 200.0})),
                                 .depth = of(0.25 * pixel),
                                 .width = length(2.5 * pixel),
                                 .length = of(2 * p.chip)};
    if (p.bottom == "ripples") return ripples;
    if (p.bottom == "mud")
        return sb::mud{.surface = rough((std::max)(4 * p.feature, 8 * pixel), 0.06 * p.roughness),
                       .density = of(0.004 / (p.feature * p.feature) * p.cover),
                       .size = length(0.5 * p.feature),
                       .mound_height = of(0.05 * p.feature),
                       .pock_depth = of(0.08 * p.feature),
                       .trawls = trawls,
                       .seed = p.bottom_seed};
    if (p.bottom == "rock")
        return sb::rock{.relief = of(0.35 * p.feature * (0.3 + p.cover)),
                        .outcrop = length(4 * p.feature),
                        .block = length(p.feature),
                        .smallest = (std::max)(length(0.3 * p.feature), (std::min)(fine, feature)),
                        .steepness = 1.2f,
                        .surface = rough(p.feature, 0.3 * p.roughness),
                        .seed = p.bottom_seed};
    if (p.bottom == "mixed")
        return sb::blend{.first = ripples,
                         .second = sand,
                         .coverage = of(p.cover),
                         .patch = length(6 * p.feature),
                         .border = length(0.7 * p.feature),
                         .seed = p.bottom_seed};
    return sand;
}

/// Places a piece of debris: within a wreck's length, mostly inside the hull or close to it, about as reflective. The
/// square root of a chip's area is about the wreck's length.
inline void scatter_about(const placed_object& wreck, const sonar_plan& p, in::random_sequence& dice,
                          placed_object& t) {
    const double reach = 0.35 * std::sqrt(p.chip * p.track);
    const double away = reach * dice.uniform() * dice.uniform(), along = reach * dice.uniform(-1, 1);
    const auto turn = in::numeric::sin_cos(wreck.yaw - p.rig_yaw);
    const double side = dice.uniform() < 0.5 ? -away : away;
    const double to_starboard = along * turn.cosine - side * turn.sine;
    t.across = wreck.across + (p.port ? -to_starboard : to_starboard) / p.chip;
    t.along = wreck.along + (along * turn.sine + side * turn.cosine) / p.track;
    t.reflectivity = wreck.reflectivity * dice.uniform(0.5, 1.2);
    t.pitch = dice.uniform(-0.5, 0.5);
}

/// Varies the reflectivity over targets, as growth, holes and loose plates do.
inline void grow(in::frame<in::labels>& recording, const sonar_plan& p, double pixel, double ping) {
    const in::bottom_tone growth{.drift = static_cast<float>(p.growth),
                                 .drift_length = static_cast<float>(p.growth_length),
                                 .octaves = 2,
                                 .seed = p.growth_seed};
    for (int y = 0; y < recording.image.height(); ++y)
        for (int x = 0; x < recording.image.width(); ++x)
            if (recording.labels.instance(x, y) != 0)
                recording.image(x, y) *=
                    static_cast<float>(in::from_decibels(in::level_of(growth, {x * pixel, y * ping})));
}

template <in::across_track Axis>
sonar_picture record_chip(const options& o, const sonar_plan& p, const std::vector<in::mesh>& shapes, auto& ex) {
    const double pixel = p.chip / o.size, ping = p.track / o.size;
    sonar_picture out;
    out.metres_per_pixel = p.turn % 2 == 0 ? glm::dvec2(pixel, ping) : glm::dvec2(ping, pixel);
    double first = p.first_range;
    if (Axis == in::across_track::ground_range)
        first = in::range_geometry::ground_range((std::max)(first, p.altitude), p.altitude);
    in::side_scan_rig<Axis> rig{.position = {p.place_x, p.place_y},
                                .altitude = static_cast<float>(p.altitude),
                                .yaw = static_cast<float>(p.rig_yaw),
                                .ping_spacing = static_cast<float>(ping),
                                .pings = o.size,
                                .first_range = static_cast<float>(first),
                                .range = static_cast<float>(first + p.chip),
                                .bins = o.size,
                                .side = p.port ? in::side::port : in::side::starboard};
    out.rig = rig.position;
    const in::ping_frame frame(in::ping_of(rig, 0), rig.side);
    const auto ground_at = [&](double across) {
        const double range = first + across * p.chip;
        if (Axis == in::across_track::ground_range) return range;
        return range > p.altitude ? in::range_geometry::ground_range(range, p.altitude) : 0.0;
    };

    const in::seabed::any bottom = bottom_of(p, pixel);
    const auto sampled = in::seabed::prepare(bottom);
    in::scene scene;
    scene.seabed = bottom;
    std::vector<in::seabed::edit> scours;
    const in::seabed::any level = in::seabed::flat{.surface = {.rms = 0}};
    const auto lay = [&](const in::mesh& shape, const placed_object& t, const std::string& name) {
        const glm::dvec2 at = frame.world(ground_at(t.across), t.along * p.track);
        in::pose pose = in::rest_on(level, shape,
                                    {.position = {at.x, at.y, 0},
                                     .yaw = static_cast<float>(t.yaw),
                                     .pitch = static_cast<float>(t.pitch),
                                     .roll = static_cast<float>(t.roll)});
        const double ground = static_cast<double>(in::seabed::at(sampled, at.x, at.y).height);
        if (in::numeric::is_finite(ground)) pose.position.z += ground;
        const in::bounding_box box = in::bounds(in::transformed(shape, in::to_world(pose)));
        pose.burial = static_cast<float>(t.burial * box.size().z);
        if (t.scour > 0) {
            const double depth = t.scour * (std::min)(box.size().z, 0.3 * p.chip);
            in::seabed::moat moat{.outline = in::footprint(shape, pose, static_cast<float>(0.4 * box.size().z)),
                                  .depth = static_cast<float>(depth),
                                  .width = static_cast<float>(4 * depth + pixel),
                                  .current = static_cast<float>(p.direction),
                                  .mound = static_cast<float>(0.6 * depth),
                                  .tail = static_cast<float>(0.2 * p.chip)};
            if (moat.outline.size() >= 3) scours.emplace_back(std::move(moat));
        }
        scene.add(shape, pose, name, {static_cast<float>(0.45 * t.reflectivity)});
        return pose;
    };
    for (std::size_t i = 0; i < p.targets.size(); ++i) {
        out.poses.push_back(lay(shapes[i], p.targets[i], p.targets[i].form.kind));
        const auto outline = in::footprint(shapes[i], out.poses.back(), 1e9f);
        double area = 0;
        for (std::size_t a = 0, b = outline.size() - 1; a < outline.size(); b = a++)
            area += 0.5 * (outline[b].x * outline[a].y - outline[a].x * outline[b].y);
        out.footprint.push_back(area / (pixel * ping));
    }
    in::random_sequence dice(p.clutter_seed, 0x636C7500);
    for (int i = 0; i < p.clutter + p.debris; ++i) {
        const double kind = dice.uniform();
        placed_object t{};
        t.form = {kind < 0.75   ? "boulder"
                  : kind < 0.85 ? "lobster_pot"
                  : kind < 0.95 ? "crate"
                                : "tyre",
                  (std::max)(p.clutter_size * dice.uniform(0.5, 1.3), 1e-3), dice.uniform(), dice.word()};
        t.yaw = dice.uniform(0, 2 * in::numeric::pi);
        t.burial = dice.uniform(0, 0.5);
        t.reflectivity = dice.uniform(0.8, 3);
        t.across = dice.uniform(0.02, 0.98), t.along = dice.uniform(0.02, 0.98);
        if (i >= p.clutter) scatter_about(p.targets.front(), p, dice, t);
        lay(mesh_of(t.form), t, clutter_class);
    }
    if (!scours.empty()) scene.seabed = in::seabed::sculpted{.ground = bottom, .edits = scours};

    const in::facet_backscatter law{static_cast<float>(p.facets), static_cast<float>(p.facet_slope),
                                    static_cast<float>(p.volume_scatter)};
    const in::sonar_equation equation{in::pulse{static_cast<float>(p.pulse)},
                                      in::horizontal_beam{static_cast<float>(p.beam)}, in::level_gain{}};
    auto recording = in::render(scene, rig, in::record_options<>{}.with(law).with(equation), ex);
    if (!scene.targets.empty() && !p.targets.empty())
        out.geometry = geometry_of(rig, scene.targets.front(), recording.labels.targets.front());

    recording = in::with_tone(std::move(recording), rig, p.tone, ex);
    grow(recording, p, pixel, ping);
    in::water_column water = p.water;
    water.first_range = static_cast<float>(first);
    water.bin = static_cast<float>(rig.bin());
    if (Axis == in::across_track::ground_range) water.surface = 0;
    recording.image = in::apply(std::move(recording.image), p.gain | water, ex);
    in::seabed_speckle speckle{.elsewhere = {.looks = p.looks},
                               .along_track = static_cast<float>(p.speckle_length_along),
                               .across_track = static_cast<float>(p.speckle_length_across),
                               .seed = p.noise_seed};
    for (in::speckle_law& l : speckle.bottom) l = {.looks = p.looks, .texture = static_cast<float>(p.texture)};
    recording = in::with_speckle(std::move(recording), speckle, ex);
    recording.image = in::apply(std::move(recording.image), p.banding, ex);
    out.values = on_screen(std::move(recording.image), p, ex);
    out.labels = std::move(recording.labels);
    if (p.turn != 0) {
        out.values = turned(out.values, p.turn);
        out.labels.instance = turned(out.labels.instance, p.turn);
        out.labels.shadow = turned(out.labels.shadow, p.turn);
        out.labels.seabed = turned(out.labels.seabed, p.turn);
        in::measure_targets(out.labels);
    }
    out.gray = in::apply(out.values, in::to_uint8, ex);
    return out;
}

}  // namespace detail

inline sonar_picture draw(const options& o, const sonar_plan& p, const std::vector<in::mesh>& shapes, auto& ex) {
    return p.ground_range ? detail::record_chip<in::across_track::ground_range>(o, p, shapes, ex)
                          : detail::record_chip<in::across_track::slant_range>(o, p, shapes, ex);
}

}  // namespace generator
