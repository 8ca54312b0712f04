#include "image_files.hpp"

#include "formats.hpp"
#include "run_lengths.hpp"

namespace generator {

json annotation_of(const std::string& category, const std::string& mask_file, const insonify::rect& box,
                   std::int64_t area, const insonify::image<std::uint8_t>& mask, const glm::dvec2& metres_per_pixel) {
    const glm::dvec2 m = metres_per_pixel;
    return {{"category", category},
            {"mask", mask_file},
            {"bbox", {box.x0, box.y0, box.width(), box.height()}},
            {"bbox_m", {box.x0 * m.x, box.y0 * m.y, box.width() * m.x, box.height() * m.y}},
            {"area", area},
            {"segmentation", {{"size", {mask.height(), mask.width()}}, {"counts", run_lengths(mask, box)}}}};
}

std::vector<file> files_of(const options& o, const finished_image& d) {
    std::vector<file> files{{image_path(d.class_name, d.index), d.picture},
                            {mask_path("target", d.index), d.target_mask},
                            {mask_path("shadow", d.index), d.shadow_mask},
                            {mask_path("seabed", d.index), d.seabed_mask}};
    json record{{"id", d.index}};
    record["files"] = {entry_of("image", files[0]), entry_of("target_mask", files[1]),
                       entry_of("shadow_mask", files[2]), entry_of("seabed_mask", files[3])};
    add_formats(o.formats, d.index, d.values, files, record);
    record["size"] = o.size;
    record["annotations"] = d.annotations;
    record["parameters"] = d.parameters;
    files.push_back({record_path(d.index), record_text(record)});
    return files;
}

}  // namespace generator
