// Draws the images of the published recipe. All rendering of the generator is compiled here and in sonar_pictures.cpp,
// which take minutes.
#include "pictures.hpp"

#include <span>

#include "../common/png_bytes.hpp"
#include "draw.hpp"
#include "image_files.hpp"
#include "plan_options.hpp"
#include "sonar_pictures.hpp"

namespace generator {

namespace {

double degrees(double radians) {
    return in::numeric::to_degrees(radians);
}

/// The columns of manifest.csv: sampled values, derived ones and measurements; null without meaning in this image.
json parameters_of(const options& o, const plan& p, const rendered_image& d) {
    const in::target_label& label = d.labels.targets.front();
    json parameters = columns_of_options(o);
    parameters.update(p.values);
    parameters.update({{"target_x_m", d.placement.position.x},
                       {"target_y_m", d.placement.position.y},
                       {"target_z_m", d.placement.position.z},
                       {"burial_m", static_cast<double>(d.placement.burial)},
                       {"rig_x_m", d.rig.x},
                       {"rig_y_m", d.rig.y},
                       {"metres_per_pixel", d.geometry.metres_per_pixel},
                       {"left_edge_m", d.geometry.left_edge},
                       {"ground_range_m", d.geometry.ground_range},
                       {"slant_range_m", d.geometry.slant_range},
                       {"grazing_deg", degrees(d.geometry.grazing)},
                       {"aspect_deg", degrees(d.geometry.aspect)},
                       {"target_height_m", d.geometry.height},
                       {"shadow_m", d.geometry.shadow},
                       {"shadow_measured_m", d.geometry.shadow_measured},
                       {"shadow_is_cut", d.geometry.shadow_is_cut},
                       {"target_is_cut", d.geometry.target_is_cut},
                       {"target_area_px", label.area},
                       {"shadow_area_px", label.shadow_area}});
    return parameters;
}

/// Replaces the library's name of an argument by the options that decide it, in recipe sonar by the columns.
std::string with_option_names(std::string message, bool is_sonar) {
    using renamed = const char* const[2];
    constexpr renamed columns[] = {{"side_scan.altitude", "altitude_m"},
                                   {"side_scan.ping_spacing", "the ping spacing (track_m over size_px)"},
                                   {"side_scan.range", "the range (first_range_m, chip_m)"},
                                   {"side_scan.first_range", "first_range_m"},
                                   {"pings in the horizontal beam", "pings in the beam (beam_rad, track_m)"}};
    constexpr renamed names[] = {{"overhead.altitude", "--altitude"},
                                 {"overhead.field_of_view", "the field of view (--chip over --altitude)"},
                                 {"overhead.grazing", "--grazing"},
                                 {"overhead.intensity", "--intensity"},
                                 {"overhead.sky", "--sky"},
                                 {"overhead.size", "--size"},
                                 {"side_scan.altitude", "--altitude"},
                                 {"side_scan.ping_spacing", "the ping spacing (--chip over --size)"},
                                 {"side_scan.range", "the range (--distance, --altitude, --chip)"},
                                 {"side_scan.first_range", "the range (--distance, --altitude, --chip)"},
                                 {"pings in the horizontal beam", "pings in the beam (--beam, --chip, --size)"},
                                 {"rays of a ping", "rays of a ping (--chip, --size)"},
                                 {"seabed tiles", "tiles of the seabed (--chip, --size)"},
                                 {"heightfield.spacing", "--heightmap-spacing"},
                                 {"heightfield.", "--heightmap "}};
    const std::span<renamed> all = is_sonar ? std::span<renamed>(columns) : std::span<renamed>(names);
    for (const auto& [from, to] : all)
        if (const std::size_t at = message.find(from); at != std::string::npos)
            return message.replace(at, std::string_view(from).size(), to);
    return message;
}

std::vector<file> files_of_published(const options& o, const plan& p, const shared_inputs& shared) {
    thread_local in::context memory;  // reused by the next image of this thread
    const rendered_image d = draw(o, p, shared, memory);
    const in::target_label& label = d.labels.targets.front();
    const auto target = in::target_mask(d.labels, label.instance);
    const auto shadow = in::shadow_mask(d.labels, label.instance);
    const glm::dvec2 metres(d.geometry.metres_per_pixel);
    return files_of(o, {p.index,
                        p.class_name,
                        d.gray.empty() ? examples::png_bytes(d.color) : examples::png_bytes(d.gray),
                        examples::png_bytes(target),
                        examples::png_bytes(shadow),
                        examples::png_bytes(d.labels.seabed),
                        d.values,
                        {annotation_of(p.class_name, "target_mask", label.box, label.area, target, metres),
                         annotation_of("shadow", "shadow_mask", label.shadow_box, label.shadow_area, shadow, metres)},
                        parameters_of(o, p, d)});
}

}  // namespace

std::vector<file> files_of(const options& all, std::uint64_t i, const shared_inputs& shared) {
    const std::uint64_t index = image_id(all, i);
    const plan_row line = all.table ? line_of_plan(all, i) : plan_row{};
    const plan_row* const given = all.table ? &line : nullptr;
    const std::string where = "image " + std::to_string(index) +
                              (given ? ", --plan " + line.table + ", line " + std::to_string(line.line) : "") + ": ";
    try {
        const options o = given ? with_line(all, line) : all;
        if (o.is_sonar()) return files_of_sonar(o, index, view_of_sonar(all, i), given);
        return files_of_published(o, plan_image(o, index, view_of(all, i), shared, given), shared);
    } catch (const plan_error&) {
        throw;
    } catch (const in::invalid_input& error) {
        throw in::io_error(where + with_option_names(error.what(), all.is_sonar()));
    } catch (const in::io_error& error) {
        throw in::io_error(where + error.what());
    }
}

void check_plan(const options& o, const shared_inputs& shared) {
    if (!o.table) return;
    options without = o;
    without.table = nullptr;
    if (o.is_sonar()) {
        check_columns(o, columns_of_sonar_recipe(without));
    } else {
        const plan example = plan_image(without, 0, shared);
        check_columns(o, {example.values, example.choices, class_names(o)});
    }
    for (std::uint64_t i = 0; i < o.table->size() * views_of_each(o); i += views_of_each(o)) {
        const plan_row line = line_of_plan(o, i);
        const options own = with_line(o, line);
        // Some columns have a meaning, and their values are checked, in some modes and on some seabeds only.
        if (!o.is_sonar()) static_cast<void>(plan_image(own, image_id(o, i), view_of(o, i), shared, &line));
    }
}

void set_png_compression() {
    // PNG's row filters and higher compression levels do not make noise and flat masks smaller; trying the filters
    // doubles the time.
    stbi_write_force_png_filter = 0;
    stbi_write_png_compression_level = 1;
}

}  // namespace generator
