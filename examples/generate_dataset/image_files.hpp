// The files of one image: picture, masks, values, and the record that describes them.
#pragma once

#include <insonify/core/image.hpp>
#include <insonify/core/rect.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "layout.hpp"
#include "options.hpp"
#include "record.hpp"

namespace generator {

/// What a recipe makes of an image.
struct finished_image {
    std::uint64_t index;
    std::string class_name;
    std::string picture, target_mask, shadow_mask, seabed_mask;  ///< PNG files
    const insonify::image<float>& values;                        ///< before quantization to 8 bits and colour
    json annotations, parameters;
};

/// A COCO annotation of a target or shadow, without its ids, which depend on the whole set.
/// @param mask_file  `target_mask` or `shadow_mask` if that file is its mask alone, else empty
/// @param mask       0 outside of the box
json annotation_of(const std::string& category, const std::string& mask_file, const insonify::rect& box,
                   std::int64_t area, const insonify::image<std::uint8_t>& mask, const glm::dvec2& metres_per_pixel);

/// All files of an image, the record last.
std::vector<file> files_of(const options& o, const finished_image& d);

}  // namespace generator
