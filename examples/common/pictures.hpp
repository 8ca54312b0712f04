// Reading people's pictures as gray values from 0 to 1: PGM and PFM by insonify, everything else by stb_image.
#pragma once

#include <insonify/filter/gray.hpp>
#include <insonify/filter/pipe.hpp>
#include <insonify/io/netpbm.hpp>

#if __has_include(<stb_image.h>)
#include <stb_image.h>
#else
#include <stb/stb_image.h>
#endif

#include <memory>
#include <string>

namespace examples {

/// @throws insonify::io_error, naming the file, if it can't be read as a picture
inline insonify::image<float> read_gray(const std::string& path) {
    const auto ends_with = [&](const char* end) { return path.ends_with(end); };
    if (ends_with(".pgm") || ends_with(".pfm")) return insonify::read_netpbm<float>(path);

    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<stbi_us, void (*)(void*)> pixels(stbi_load_16(path.c_str(), &width, &height, &channels, 3),
                                                           stbi_image_free);
    if (!pixels) throw insonify::io_error(path + ": " + stbi_failure_reason());
    insonify::image<insonify::rgb<float>> color(width, height);
    for (std::size_t i = 0; i < color.size(); ++i) {
        const stbi_us* const p = pixels.get() + 3 * i;
        color.pixels()[i] = {insonify::dequantize(p[0]), insonify::dequantize(p[1]), insonify::dequantize(p[2])};
    }
    return color | insonify::to_gray{};
}

}  // namespace examples
