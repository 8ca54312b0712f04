// Masks as COCO run lengths.
#pragma once

#include <insonify/core/image.hpp>
#include <insonify/core/rect.hpp>

#include <cstdint>
#include <vector>

namespace generator {

/// Run lengths of a mask in COCO's order: column by column, zeros first. Pixels outside of the box must be 0.
inline std::vector<std::int64_t> run_lengths(const insonify::image<std::uint8_t>& mask, const insonify::rect& box) {
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
    append(false, box.x0 * height);
    for (int x = box.x0; x < box.x1; ++x) {
        append(false, box.y0);
        for (int y = box.y0; y < box.y1; ++y) append(mask(x, y) != 0, 1);
        append(false, height - box.y1);
    }
    append(false, (mask.width() - box.x1) * height);
    runs.push_back(run);
    return runs;
}

}  // namespace generator
