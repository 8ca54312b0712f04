// Draws an image of the published recipe: scene, rendering, histogram matching, noise and colour.
#pragma once

#include <insonify/insonify.hpp>

#include "masked_match.hpp"
#include "plan.hpp"
#include "shared_inputs.hpp"
#include "target_geometry.hpp"

namespace generator {

namespace in = insonify;

inline in::seabed::any seabed_of(const plan& p, const shared_inputs& shared) {
    const auto relief = static_cast<float>(p.relief);
    const auto wavelength = static_cast<float>(p.wavelength);
    const in::seabed::ripples ripples{.wavelength = wavelength,
                                      .steepness = 0.03f + 0.05f * relief,
                                      .direction = static_cast<float>(p.direction),
                                      .seed = p.seabed_seed};
    const in::seabed::mud mud{.seed = p.seabed_seed};
    const in::seabed::rock rock{.relief = 0.08f + 0.12f * relief, .seed = p.seabed_seed};
    if (p.seabed == "ripples") return ripples;
    if (p.seabed == "mud") return mud;
    if (p.seabed == "rock") return rock;
    if (p.seabed == "mixed") return in::seabed::blend{.first = ripples, .second = mud, .seed = p.seabed_seed};
    if (p.seabed == "heightmap") return shared.heightmap();
    return in::seabed::flat{.seed = p.seabed_seed};
}

/// Sonar parameters that decide the speckle, metres per second and hertz.
inline constexpr double sound_speed = 1500, frequency = 450e3;

/// A finished image with its labels and measurements.
struct rendered_image {
    in::labels labels;
    in::image<float> values;  ///< before quantization to 8 bits and colour
    in::image<in::rgb8> color;
    in::image<std::uint8_t> gray;  ///< empty with a colour map other than gray
    in::pose placement;
    glm::dvec2 rig{0, 0};  ///< position of the camera, or of the sonar at the first ping
    target_geometry geometry;
};

/// The target in its own frame: length along x, width along y, height along z.
inline in::mesh target_of(const plan& p, const shared_inputs& shared) {
    const auto [length, width, height] = std::tuple(p.extents.x, p.extents.y, p.extents.z);
    const auto of = [](double metres) { return static_cast<float>(metres); };
    const auto scaled = [](in::mesh m, double x, double y, double z) {
        return x == 1 && y == 1 && z == 1
                   ? m
                   : in::transformed(std::move(m), {glm::dmat3({x, 0, 0}, {0, y, 0}, {0, 0, z}), {}});
    };
    if (p.class_name == "cylinder")
        return scaled(to_mesh(in::cylinder{.radius = of(height / 2), .length = of(length)}), 1, width / height, 1);
    if (p.class_name == "cube") return to_mesh(in::cube{.size = {of(length), of(width), of(height)}});
    if (p.class_name == "cone")
        return scaled(to_mesh(in::cone{.radius = of(length / 2), .height = of(height)}), 1, width / length, 1);
    if (p.class_name == "sphere")
        return to_mesh(in::sphere{.radius = of(height / 2), .aspect = {of(length / height), of(width / height), 1}});
    const glm::dvec3 unit = shared.extents_of_mesh(p.class_name);
    const auto factor = [&](double to, double from) { return from > 0 ? to / from : 1; };
    return scaled(shared.unit_mesh(p.class_name), factor(length, unit.x), factor(width, unit.y),
                  factor(height, unit.z));
}

/// Rests the level target on the seabed, then tilts it about its centre: one end sinks in as the other rises, and no
/// light passes below.
inline in::pose resting_pose(const plan& p, const in::scene& scene, const in::mesh& shape, const glm::dvec2& ground) {
    in::pose placement =
        in::rest_on(scene.seabed, shape, {.position = glm::dvec3(ground, 0), .yaw = static_cast<float>(p.yaw)});
    placement.pitch = static_cast<float>(p.pitch);
    placement.roll = static_cast<float>(p.roll);
    placement.burial = static_cast<float>(p.burial * p.extents.z);
    return placement;
}

/// World position of the image: the centre of a heightmap, or the plan's position on an unbounded seabed.
inline glm::dvec2 world_position(const plan& p, const shared_inputs& shared) {
    if (p.seabed != "heightmap") return {p.place_x, p.place_y};
    const in::seabed::heightfield& map = shared.heightmap();
    return map.origin + 0.5 * map.spacing * glm::dvec2(map.heights.width() - 1, map.heights.height() - 1);
}

/// Renders the overhead camera of the paper; pixels are in [0, 1], without noise.
inline in::image<float> render_overhead(const options& o, const plan& p, const shared_inputs& shared, in::scene& scene,
                                        rendered_image& d, auto& ex) {
    in::overhead rig{.position = world_position(p, shared),
                     .altitude = static_cast<float>(p.altitude),
                     .yaw = static_cast<float>(p.rig_yaw),
                     .size = {o.size, o.size},
                     .grazing = static_cast<float>(p.light),
                     .intensity = static_cast<float>(o.intensity),
                     .sky = static_cast<float>(o.sky)};
    if (o.chip > 0) rig.field_of_view = static_cast<float>(2 * in::numeric::atan2(0.5 * o.chip, p.altitude));
    d.rig = rig.position;
    const in::overhead_geometry view(rig);
    const glm::dvec2 half = view.half_extent(0);
    const auto [sine, cosine] = in::numeric::sin_cos(p.rig_yaw);
    const glm::dvec2 share(2 * p.across - 1, 2 * p.along - 1);
    const glm::dvec2 offset{share.x * half.x, share.y * half.y};
    const glm::dvec2 ground =
        rig.position + glm::dvec2(offset.x * cosine - offset.y * sine, offset.x * sine + offset.y * cosine);
    const in::mesh shape = target_of(p, shared);
    d.placement = resting_pose(p, scene, shape, ground);
    scene.add(shape, d.placement, p.class_name, {static_cast<float>(o.reflectivity)});

    auto frame = in::render(scene, rig, {}, ex);
    d.labels = std::move(frame.labels);
    d.geometry = geometry_of(view, scene.targets.front(), d.labels.targets.front());
    return std::move(frame.image);
}

/// Renders a side-scan recording, in slant or ground range.
template <in::across_track Axis>
in::image<float> render_side_scan(const options& o, const plan& p, const shared_inputs& shared, in::scene& scene,
                                  rendered_image& d, auto& ex) {
    const double ground_range = p.distance * p.altitude, pixel = o.chip / o.size;
    const double centre = Axis == in::across_track::slant_range
                              ? in::range_geometry::slant_range(ground_range, p.altitude)
                              : ground_range;
    const double first = (std::max)(0.0, centre - p.across * o.chip);
    in::side_scan_rig<Axis> rig{.altitude = static_cast<float>(p.altitude),
                                .yaw = static_cast<float>(p.rig_yaw),
                                .ping_spacing = static_cast<float>(pixel),
                                .pings = o.size,
                                .first_range = static_cast<float>(first),
                                .range = static_cast<float>(first + o.chip),
                                .bins = o.size,
                                .side = p.port ? in::side::port : in::side::starboard};
    // The target is at the world position; the track is beside it.
    const glm::dvec2 ground = world_position(p, shared);
    rig.position = ground - in::ping_frame(in::ping_of(rig, 0), rig.side).world(ground_range, p.along * o.chip);
    d.rig = rig.position;
    const in::mesh shape = target_of(p, shared);
    d.placement = resting_pose(p, scene, shape, ground);
    scene.add(shape, d.placement, p.class_name, {static_cast<float>(o.reflectivity)});

    const in::horizontal_beam beam{static_cast<float>(p.beam)};
    const in::sonar_equation equation{beam, in::level_gain{}};
    auto recording = in::render(scene, rig, in::record_options<>{}.with(equation), ex);
    for (float& intensity : recording.image.pixels()) intensity += static_cast<float>(p.noise);
    for (const noise_step& step : noise_steps(o))
        if (step.kind == "seabed") {
            // The beamwidth decides over how many pings the speckle stays correlated.
            const double slant = in::range_geometry::slant_range(ground_range, p.altitude);
            const double pings = beam.speckle_length(slant, sound_speed / frequency) / pixel;
            recording = in::with_speckle(
                std::move(recording),
                {.along_track = static_cast<float>((std::min)(pings, 16.0)), .seed = p.noise_seed}, ex);
        }
    d.labels = std::move(recording.labels);
    d.geometry = geometry_of(rig, scene.targets.front(), d.labels.targets.front());
    const auto white = static_cast<float>(p.white), decibels = static_cast<float>(p.display_range);
    if (p.display == "decibels")
        return in::apply(std::move(recording.image), in::decibel_display{.white = white, .range = decibels}, ex);
    const float exponent = p.display == "power" ? 1.0f : 0.5f;
    return in::apply(std::move(recording.image), in::display{.white = white, .exponent = exponent}, ex);
}

inline rendered_image draw(const options& o, const plan& p, const shared_inputs& shared, auto& ex) {
    in::scene scene;
    scene.seabed = seabed_of(p, shared);
    rendered_image result{};
    in::image<float> look =
        o.mode == "slant_range"    ? render_side_scan<in::across_track::slant_range>(o, p, shared, scene, result, ex)
        : o.mode == "ground_range" ? render_side_scan<in::across_track::ground_range>(o, p, shared, scene, result, ex)
                                   : render_overhead(o, p, shared, scene, result, ex);
    const auto add = [&](const auto& filter) { look = in::apply(std::move(look), filter, ex); };
    if (p.referenced && o.match == "masked")
        look = match_masked(std::move(look), shadows_of(result.labels), shared.reference(p.reference));
    else if (p.referenced)
        add(in::match_histogram(shared.reference(p.reference)));
    for (const noise_step& step : noise_steps(o)) {
        const auto strength = static_cast<float>(step.strength);
        if (step.kind == "speckle") add(in::speckle{.variance = strength, .seed = p.noise_seed});
        if (step.kind == "gaussian") add(in::gaussian{.variance = strength, .seed = p.noise_seed});
        if (step.kind == "poisson") add(in::poisson{.photons = strength, .seed = p.noise_seed});
        if (step.kind == "rayleigh") add(in::rayleigh{.seed = p.noise_seed});
    }
    if (o.colormap == "copper")
        result.color = in::apply(look, in::colormap::copper, ex);
    else
        result.gray = in::apply(look, in::to_uint8, ex);
    result.values = std::move(look);
    return result;
}

}  // namespace generator
