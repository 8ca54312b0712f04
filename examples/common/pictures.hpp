// Reads users' pictures as gray values from 0 to 1: PGM, PPM and PFM by insonify; PNG, JPEG and BMP by stb_image.
// The format is detected from the content, not from the file's name.
#pragma once

#include <insonify/filter/gray.hpp>
#include <insonify/filter/pipe.hpp>
#include <insonify/io/netpbm.hpp>

#if __has_include(<stb_image.h>)
#include <stb_image.h>
#else
#include <stb/stb_image.h>
#endif

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

#include "input_file.hpp"
#include "picture_checks.hpp"

namespace examples {

/// Whether bytes begin like a PGM, PPM or PFM.
inline bool is_netpbm(std::string_view bytes) {
    return bytes.size() >= 3 && bytes[0] == 'P' &&
           std::string_view("2356Ff").find(bytes[1]) != std::string_view::npos &&
           std::string_view(" \t\r\n#").find(bytes[2]) != std::string_view::npos;
}
/// Whether bytes begin like a picture in a format that `parse_gray` reads.
inline bool is_picture(std::string_view bytes) {
    return is_netpbm(bytes) || bytes.starts_with(png_signature) || bytes.starts_with(jpeg_signature) ||
           bytes.starts_with("BM");
}

/// @param limit  bytes that a decoded PNG, JPEG or BMP may take, three samples of 16 bits a pixel; other formats
///               decode to at most four times their own bytes
/// @throws insonify::io_error, with the name, for bytes that are no picture
inline insonify::image<float> parse_gray(std::string_view bytes, const std::string& name,
                                         std::uint64_t limit = 6 * usual_input_limit) {
    const auto fail = [&](const std::string& reason) { throw insonify::io_error(name + ": " + reason); };
    if (is_netpbm(bytes)) {
        const bool is_color = std::string_view("36F").find(bytes[1]) != std::string_view::npos;
        if (!is_color) return insonify::parse_netpbm<float>(bytes, name);
        return insonify::parse_netpbm<insonify::rgb<float>>(bytes, name) | insonify::to_gray{};
    }
    if (!is_picture(bytes)) fail("is not a PNG, JPEG, BMP, PGM, PPM or PFM");

    if (bytes.starts_with(png_signature) && !has_whole_chunks(bytes))
        fail("is a truncated PNG: it ends within a chunk");
    if (bytes.starts_with(jpeg_signature) && !has_sound_huffman_tables(bytes))
        fail("is damaged: a JPEG with a Huffman table of more than 256 symbols, or beyond its segment");

    const auto damaged = [] {
        return "is damaged, or claims more pixels than can be read (" + std::string(stbi_failure_reason()) + ")";
    };
    const auto* const data = reinterpret_cast<const stbi_uc*>(bytes.data());
    if (bytes.size() > 0x7FFFFFFF) fail("is larger than 2 GiB");
    const int size = static_cast<int>(bytes.size());
    int width = 0, height = 0, channels = 0;
    if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0) fail(damaged());
    // A BMP stored from the top down has a negative height here, and a header may hold anything.
    const auto columns = static_cast<std::int64_t>(width), rows = std::abs(static_cast<std::int64_t>(height));
    const std::string shape = std::to_string(columns) + " x " + std::to_string(rows) + " pixels";
    if (columns < 1 || rows < 1) fail(shape + " is not an image size");
    if (static_cast<std::uint64_t>(columns) > limit / 6 / static_cast<std::uint64_t>(rows))
        fail(shape + " are more than " + std::to_string(limit) + " bytes");
    const std::unique_ptr<stbi_us, void (*)(void*)> pixels(
        stbi_load_16_from_memory(data, size, &width, &height, &channels, 3), stbi_image_free);
    if (!pixels) fail(damaged());
    insonify::image<insonify::rgb<float>> color(width, height);
    for (std::size_t i = 0; i < color.size(); ++i) {
        const stbi_us* const p = pixels.get() + 3 * i;
        color.pixels()[i] = {insonify::dequantize(p[0]), insonify::dequantize(p[1]), insonify::dequantize(p[2])};
    }
    return color | insonify::to_gray{};
}

/// @throws insonify::io_error, naming the file, if it can't be read as a picture
inline insonify::image<float> read_gray(const std::string& path) {
    return parse_gray(read_input(path), path);
}

}  // namespace examples
