#include "decode.hpp"

#include <algorithm>
#include <iterator>
#include <memory>

#include "formats.hpp"
#include "run_lengths.hpp"

#if __has_include(<stb_image.h>)
#include <stb_image.h>
#else
#include <stb/stb_image.h>
#endif

namespace generator {

std::optional<std::string> decode_fault(const std::string& bytes, const std::string& name,
                                        const nlohmann::ordered_json& record, const nlohmann::ordered_json& entry) {
    const std::string of = entry.at("of").get<std::string>();
    const int size = record.at("size").get<int>();
    if (std::find(std::begin(format_names), std::end(format_names), of) != std::end(format_names)) {
        const std::string fault = format_fault(of, bytes, size);
        return fault.empty() ? std::nullopt : std::optional(name + ": " + fault);
    }
    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()), &width,
                              &height, &channels, 1),
        stbi_image_free);
    if (!pixels) return name + ": does not decode: " + stbi_failure_reason();
    if (width != size || height != size)
        return name + ": has " + std::to_string(width) + " x " + std::to_string(height) + " pixels, expected " +
               std::to_string(size) + " x " + std::to_string(size);
    // Masks are 255 in every pixel that the annotation's run lengths cover.
    insonify::image<std::uint8_t> mask(width, height);
    std::copy_n(pixels.get(), mask.size(), mask.pixels().begin());
    for (const auto& annotation : record.at("annotations"))
        if (annotation.value("mask", "") == of &&
            run_lengths(mask, {0, 0, width, height}) !=
                annotation.at("segmentation").at("counts").get<std::vector<std::int64_t>>())
            return name + ": is not what the annotation says";
    return std::nullopt;
}

}  // namespace generator
