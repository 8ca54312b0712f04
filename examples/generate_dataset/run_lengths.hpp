// Masks as COCO writes them: run lengths.
#pragma once

#include <insonify/core/image.hpp>

#include <cstdint>
#include <vector>

namespace generator {

/// Run lengths of a mask in COCO's order: down the columns, beginning with zeros. Nothing is set outside of the box.
/// @param box  has x, y, width and height
inline std::vector<std::int64_t> run_lengths(const insonify::image<std::uint8_t>& mask, const auto& box) {
    std::vector<std::int64_t> runs;
    bool inside = false;
    std::int64_t run = 0;
    const auto append = [&](bool is_set, std::int64_t pixels) {
        if (is_set != inside && pixels > 0) {
            runs.push_back(run);
            run = 0;
            inside = is_set;
        }
        run += pixels;
    };
    const std::int64_t height = mask.height();
    append(false, box.x * height);
    for (int x = box.x; x < box.x + box.width; ++x) {
        append(false, box.y);
        for (int y = box.y; y < box.y + box.height; ++y) append(mask(x, y) != 0, 1);
        append(false, height - box.y - box.height);
    }
    append(false, (mask.width() - box.x - box.width) * height);
    runs.push_back(run);
    return runs;
}

}  // namespace generator
