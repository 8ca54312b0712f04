// Draws the images of the sonar recipe; pictures.cpp draws those of the published one.
#include "sonar_pictures.hpp"

#include "../common/png_bytes.hpp"
#include "image_files.hpp"
#include "plan_options.hpp"
#include "sonar_draw.hpp"

namespace generator {

namespace {

/// Upper bound of draws of an image, the first included, while its target shows less than --visible-share.
constexpr std::uint32_t max_attempts = 8;

in::image<std::uint8_t> union_of(const in::image<std::uint8_t>& a, const in::image<std::uint8_t>& b) {
    in::image<std::uint8_t> sum = a;
    for (std::size_t i = 0; i < sum.size(); ++i) sum.pixels()[i] = std::max(a.pixels()[i], b.pixels()[i]);
    return sum;
}

}  // namespace

known_columns columns_of_sonar_recipe(const options& o) {
    sampler s(numbers_of(o, 0, 0), nullptr);
    std::vector<in::mesh> shapes;
    sample_image(o, s, {object_kinds[0].name, "", "", {}}, shapes);
    known_columns known{s.values(), s.choices(), {empty_class}};
    // The second and the third target have what the first one has.
    for (const auto& [column, example] : s.values().items())
        if (column.starts_with("t1_"))
            for (const char* const prefix : {"t2_", "t3_"}) known.examples[prefix + column.substr(3)] = example;
    for (const object_kind& k : object_kinds) known.classes.push_back(k.name);
    return known;
}

std::vector<file> files_of_sonar(const options& o, std::uint64_t index, const view_of_target& view,
                                 const plan_row* given) {
    thread_local in::context memory;  // reused by the next image of this thread
    // A line with an attempt comes from a manifest: draw that attempt.
    const bool is_replay = given != nullptr && given->find("attempt") != nullptr;
    auto attempt = static_cast<std::uint32_t>(is_replay ? given->whole("attempt", 0, 0, 1'000'000) : 0);
    sonar_plan p;
    sonar_picture d;
    json sampled;
    double shown = 1;
    for (;; ++attempt) {
        sampler s(numbers_of(o, index, attempt), given);
        std::vector<in::mesh> shapes;
        p = sample_image(o, s, view, shapes);
        d = draw(o, p, shapes, memory);
        sampled = s.values();
        shown = 1;
        for (std::size_t i = 0; i < p.targets.size(); ++i)
            shown = std::min(shown, static_cast<double>(d.labels.targets[i].area) / std::max(d.footprint[i], 1.0));
        if (shown >= o.visible_share || is_replay || attempt + 1 >= max_attempts) break;
    }
    if (shown < o.visible_share)
        std::fprintf(stderr, "image %llu: its target shows %.1f %% of its outline, less than --visible-share\n",
                     static_cast<unsigned long long>(index), 100 * shown);

    in::image<std::uint8_t> target(o.size, o.size), shadow(o.size, o.size);
    const bool alone_in_picture = p.targets.size() == 1;
    json annotations = json::array();
    std::int64_t target_area = 0, shadow_area = 0;
    for (std::size_t i = 0; i < d.labels.targets.size(); ++i) {
        const in::target_label& label = d.labels.targets[i];
        const bool labelled = i < p.targets.size();
        const auto own = in::target_mask(d.labels, label.instance), dark = in::shadow_mask(d.labels, label.instance);
        const auto file_if_alone = [&](const char* name) { return labelled && alone_in_picture ? name : ""; };
        annotations.push_back(annotation_of(labelled ? label.class_name : clutter_class, file_if_alone("target_mask"),
                                            label.box, label.area, own, d.metres_per_pixel));
        annotations.push_back(annotation_of("shadow", file_if_alone("shadow_mask"), label.shadow_box, label.shadow_area,
                                            dark, d.metres_per_pixel));
        if (labelled) {
            target = union_of(target, own), shadow = union_of(shadow, dark);
            target_area += label.area, shadow_area += label.shadow_area;
        }
    }

    json parameters = columns_of_options(o);
    parameters["attempt"] = attempt;
    parameters.update(sampled);
    const bool any = !p.targets.empty();
    const auto known = [&](const json& value) { return any ? value : json(); };
    parameters["metres_per_pixel"] = d.metres_per_pixel.x;
    parameters["metres_per_row"] = d.metres_per_pixel.y;
    parameters["target_x_m"] = known(any ? d.poses[0].position.x : 0.0);
    parameters["target_y_m"] = known(any ? d.poses[0].position.y : 0.0);
    parameters["target_z_m"] = known(any ? d.poses[0].position.z : 0.0);
    parameters["ground_range_m"] = known(d.geometry.ground_range);
    parameters["slant_range_m"] = known(d.geometry.slant_range);
    parameters["grazing_deg"] = known(in::numeric::to_degrees(d.geometry.grazing));
    parameters["aspect_deg"] = known(in::numeric::to_degrees(d.geometry.aspect));
    parameters["target_height_m"] = known(d.geometry.height);
    parameters["shadow_m"] = known(d.geometry.shadow);
    parameters["shadow_measured_m"] = known(d.geometry.shadow_measured);
    parameters["shadow_is_cut"] = known(d.geometry.shadow_is_cut);
    parameters["target_is_cut"] = known(d.geometry.target_is_cut);
    parameters["visible_share"] = known(shown);
    parameters["target_area_px"] = target_area;
    parameters["shadow_area_px"] = shadow_area;
    return files_of(
        o, {index, p.class_name, examples::png_bytes(d.gray), examples::png_bytes(target), examples::png_bytes(shadow),
            examples::png_bytes(d.labels.seabed), d.values, annotations, parameters});
}

}  // namespace generator
