// From plan to picture: builds the scene, renders it, and gives it the look that was asked for.
#pragma once

#include <insonify/insonify.hpp>

#include <filesystem>
#include <map>

#include "../common/pictures.hpp"
#include "facts.hpp"
#include "plan.hpp"

namespace generator {

namespace in = insonify;

/// What all images share: meshes, heightmap and references, read once.
class stock {
  public:
    /// @throws io_error for a file that can't be read
    explicit stock(const options& o) {
        for (const std::string& mesh : o.meshes) {
            const std::size_t equals = mesh.find('=');
            meshes_[mesh.substr(0, equals)] = upright(in::load_obj(mesh.substr(equals + 1)), o.mesh_up == "y");
        }
        if (!o.heightmap.empty()) {
            const in::image<float> picture = examples::read_gray(o.heightmap);
            heightmap_ = in::seabed::from_image(picture, o.heightmap_spacing, static_cast<float>(o.heightmap_scale));
        }
        for (const std::string& path : picture_paths(o))
            references_.push_back(in::match_histogram(examples::read_gray(path)));
        if (references_.empty() && o.demo) references_.push_back(in::match_histogram(made_up_reference()));
    }

    std::size_t references() const { return references_.size(); }
    const in::match_histogram& reference(std::size_t i) const { return references_[i]; }
    const in::seabed::heightfield& heightmap() const { return heightmap_; }

    /// The target of a plan in its own frame, of the size that the plan says.
    in::mesh target(const plan& p) const {
        const auto s = static_cast<float>(p.size), a = static_cast<float>(p.aspect);
        if (p.class_name == "cylinder") return to_mesh(in::cylinder{.radius = s / 2, .length = 3 * s * a});
        if (p.class_name == "cube") return to_mesh(in::cube{.size = {s, s * a, s}});
        if (p.class_name == "cone") return to_mesh(in::cone{.radius = 0.6f * s * a, .height = 1.2f * s});
        if (p.class_name == "sphere") return to_mesh(in::sphere{.radius = s / 2, .aspect = {a, 1, 1}});
        const in::mesh& unit = meshes_.at(p.class_name);
        return in::transformed(unit, {glm::dmat3(2 * p.size), {}});
    }

  private:
    /// Turned so that z is up, moved to its middle, and scaled to a largest extent of 1.
    static in::mesh upright(in::mesh m, bool y_up) {
        if (y_up) m = in::transformed(std::move(m), in::to_world({.roll = in::literals::operator""_deg(90ull)}));
        const in::bounding_box box = in::bounds(m);
        const glm::dvec3 size = box.size();
        const double largest = (std::max)({size.x, size.y, size.z, 1e-9});
        return in::transformed(std::move(m), {glm::dmat3(1 / largest), -box.centre() / largest});
    }

    /// The pictures among the references, folders opened, in the order of their names.
    static std::vector<std::string> picture_paths(const options& o) {
        std::vector<std::string> paths;
        for (const std::string& given : o.references) {
            if (!std::filesystem::is_directory(given)) {
                paths.push_back(given);
                continue;
            }
            std::vector<std::string> inside;
            for (const auto& entry : std::filesystem::directory_iterator(given)) {
                const std::string extension = entry.path().extension().string();
                if (extension == ".png" || extension == ".pgm" || extension == ".pfm" || extension == ".jpg")
                    inside.push_back(entry.path().string());
            }
            std::sort(inside.begin(), inside.end());
            paths.insert(paths.end(), inside.begin(), inside.end());
        }
        return paths;
    }

    /// Gray values as a sonar's: Rayleigh amplitudes around a quarter of full scale.
    static in::image<float> made_up_reference() { return in::image<float>(256, 256, 0.25f) | in::rayleigh{.seed = 1}; }

    std::map<std::string, in::mesh> meshes_;
    in::seabed::heightfield heightmap_;
    std::vector<in::match_histogram> references_;
};

inline in::seabed::any seabed_of(const plan& p, const stock& shared) {
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

/// Of the sonar that makes speckle, metres a second and hertz.
inline constexpr double sound_speed = 1500, frequency = 450e3;

/// A finished image with the numbers that the labels want.
struct drawn {
    in::labels labels;
    in::image<in::rgb8> color;
    in::image<std::uint8_t> gray;  ///< used where the colour map is gray
    in::pose placement;
    facts known;
};

/// Level first, tilted in place then: what one end rises, the other sinks in, and no light passes below.
inline in::pose laid_down(const plan& p, const in::scene& scene, const in::mesh& shape, const glm::dvec2& ground) {
    in::pose placement =
        in::rest_on(scene.seabed, shape, {.position = glm::dvec3(ground, 0), .yaw = static_cast<float>(p.yaw)});
    placement.pitch = static_cast<float>(p.pitch);
    placement.roll = static_cast<float>(p.roll);
    placement.burial = static_cast<float>(p.burial * p.size);
    return placement;
}

/// Where the rig's work is: a heightmap lies where it lies, everything else is endless.
inline glm::dvec2 place_of(const plan& p, const stock& shared) {
    if (p.seabed != "heightmap") return {p.place_x, p.place_y};
    const in::seabed::heightfield& map = shared.heightmap();
    return map.origin + 0.5 * map.spacing * glm::dvec2(map.heights.width() - 1, map.heights.height() - 1);
}

/// The image before noise, in [0, 1], as the paper's camera takes it.
inline in::image<float> photograph(const options& o, const plan& p, const stock& shared, in::scene& scene, drawn& d,
                                   auto& ex) {
    in::overhead rig{.position = place_of(p, shared),
                     .altitude = static_cast<float>(p.altitude),
                     .yaw = static_cast<float>(p.rig_yaw),
                     .size = {o.size, o.size},
                     .grazing = static_cast<float>(p.grazing),
                     .intensity = static_cast<float>(o.intensity),
                     .sky = static_cast<float>(o.sky)};
    if (o.chip > 0) rig.field_of_view = static_cast<float>(2 * in::numeric::atan2(0.5 * o.chip, p.altitude));
    const in::overhead_geometry view(rig);
    const glm::dvec2 half = view.half_extent(0);
    const auto [sine, cosine] = in::numeric::sin_cos(p.rig_yaw);
    const glm::dvec2 share =
        o.chip > 0 ? glm::dvec2(2 * p.third - 1, 2 * p.halfway - 1) : glm::dvec2(p.offset_x, p.offset_y);
    const glm::dvec2 offset{share.x * half.x, share.y * half.y};
    const glm::dvec2 ground =
        rig.position + glm::dvec2(offset.x * cosine - offset.y * sine, offset.x * sine + offset.y * cosine);
    const in::mesh shape = shared.target(p);
    d.placement = laid_down(p, scene, shape, ground);
    scene.add(shape, d.placement, p.class_name, {static_cast<float>(o.reflectivity)});

    auto frame = in::render(scene, rig, {}, ex);
    d.labels = std::move(frame.labels);
    d.known = facts_of(view, scene.targets.front(), d.labels.targets.front());
    return std::move(frame.image);
}

/// The same as a side-scan sonar hears it: `ping` by range, or laid out on the bottom.
template <in::across_track Axis>
in::image<float> recording_of(const options& o, const plan& p, const stock& shared, in::scene& scene, drawn& d,
                              auto& ex) {
    const double ground_range = p.distance * p.altitude, pixel = o.chip / o.size;
    const double centre = Axis == in::across_track::slant_range
                              ? in::range_geometry::slant_range(ground_range, p.altitude)
                              : ground_range;
    const double first = (std::max)(0.0, centre - p.third * o.chip);
    in::side_scan_rig<Axis> rig{.altitude = static_cast<float>(p.altitude),
                                .yaw = static_cast<float>(p.rig_yaw),
                                .ping_spacing = static_cast<float>(pixel),
                                .pings = o.size,
                                .first_range = static_cast<float>(first),
                                .range = static_cast<float>(first + o.chip),
                                .bins = o.size,
                                .side = p.port ? in::side::port : in::side::starboard};
    // The target lies at the place, and the track beside it.
    const glm::dvec2 ground = place_of(p, shared);
    rig.position = ground - in::ping_frame(in::ping_of(rig, 0), rig.side).world(ground_range, p.halfway * o.chip);
    const in::mesh shape = shared.target(p);
    d.placement = laid_down(p, scene, shape, ground);
    scene.add(shape, d.placement, p.class_name, {static_cast<float>(o.reflectivity)});

    const in::horizontal_beam beam{static_cast<float>(p.beam)};
    const in::sonar_equation equation{beam, in::level_gain{}};
    using all = in::record_options<in::labels, in::lambert_backscatter, std::remove_const_t<decltype(equation)>>;
    auto heard = in::render(scene, rig, all{.equation = equation}, ex);
    for (float& intensity : heard.image.pixels()) intensity += static_cast<float>(p.noise);
    for (const noise_step& step : noise_steps(o))
        if (step.kind == "seabed") {
            // The speckle of neighbouring pings is alike as long as the beam makes it so.
            const double slant = in::range_geometry::slant_range(ground_range, p.altitude);
            const double pings = beam.speckle_length(slant, sound_speed / frequency) / pixel;
            heard = in::with_speckle(std::move(heard), rig,
                                     {.along_track = static_cast<float>((std::min)(pings, 16.0)), .seed = p.noise_seed},
                                     ex);
        }
    d.labels = std::move(heard.labels);
    d.known = facts_of(rig, scene.targets.front(), d.labels.targets.front());
    return in::apply(std::move(heard.image), in::display{.white = static_cast<float>(p.white)}, ex);
}

inline drawn draw(const options& o, const plan& p, const stock& shared, auto& ex) {
    in::scene scene;
    scene.seabed = seabed_of(p, shared);
    drawn result{};
    in::image<float> look =
        o.mode == "slant_range"    ? recording_of<in::across_track::slant_range>(o, p, shared, scene, result, ex)
        : o.mode == "ground_range" ? recording_of<in::across_track::ground_range>(o, p, shared, scene, result, ex)
                                   : photograph(o, p, shared, scene, result, ex);
    const auto add = [&](const auto& filter) { look = in::apply(std::move(look), filter, ex); };
    if (p.referenced) add(shared.reference(p.reference));
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
    return result;
}

}  // namespace generator
