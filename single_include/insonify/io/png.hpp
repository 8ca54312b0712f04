// Writes PNG files with stb_image_write, which this header declares but does not implement: one translation unit of the
// program must define STB_IMAGE_WRITE_IMPLEMENTATION before it includes stb_image_write.h. Not in the umbrella header.
#pragma once

#include <insonify/insonify.hpp>

#include <cstring>
#include <limits>
#include <string>
#include <vector>

// Including stb_image_write.h twice with STB_IMAGE_WRITE_IMPLEMENTATION defined would define its functions twice.
#if defined(INCLUDE_STB_IMAGE_WRITE_H)
#elif __has_include(<stb_image_write.h>)
#include <stb_image_write.h>
#elif __has_include(<stb/stb_image_write.h>)
#include <stb/stb_image_write.h>
#else
#error "insonify/io/png.hpp needs stb_image_write.h (Debian: libstb-dev) on the include path."
#endif

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

inline void write_png_bytes(const std::string& path, const void* pixels, int width, int height, int channels,
                            std::ptrdiff_t row_bytes) {
    require(width > 0, "image width", width, "at least 1");
    require(height > 0, "image height", height, "at least 1");
    // stb counts bytes in int, and doubles its buffers.
    const std::size_t bytes =
        static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(channels);
    require(bytes <= (std::size_t{1} << 29), "bytes of the image", bytes, "at most 2^29");

    // stb computes the offsets of rows in int: rows that lie far apart are copied next to each other.
    const auto packed_row = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
    std::vector<unsigned char> packed;
    if (row_bytes > (std::numeric_limits<int>::max)() / height) {
        packed.resize(bytes);
        for (int y = 0; y < height; ++y)
            std::memcpy(&packed[static_cast<std::size_t>(y) * packed_row],
                        static_cast<const unsigned char*>(pixels) + y * row_bytes, packed_row);
        pixels = packed.data();
        row_bytes = static_cast<std::ptrdiff_t>(packed_row);
    }

    replacement_file file(path);
    const auto append = [](void* context, void* data, int size) {
        static_cast<replacement_file*>(context)->write(data, static_cast<std::size_t>(size));
    };
    if (stbi_write_png_to_func(append, &file, width, height, channels, pixels, static_cast<int>(row_bytes)) == 0)
        raise_io(path, "can't encode as PNG: out of memory");
    file.commit();
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Writes an 8-bit gray or colour PNG, all or nothing. Floats are quantized: 1 is white, to the nearest of 256 levels.
/// The library reads no PNG.
/// stb's own switches (`stbi_write_png_compression_level` and others) apply.
/// @throws invalid_input for an image without pixels or above 2^29 bytes; io_error, naming the file, if it can't be
///         written
inline void write_png(const std::string& path, image_view<const std::uint8_t> source) {
    detail::write_png_bytes(path, source.data(), source.width(), source.height(), 1, source.stride());
}
/// The same in colour.
inline void write_png(const std::string& path, image_view<const rgb8> source) {
    detail::write_png_bytes(path, source.data(), source.width(), source.height(), 3, 3 * source.stride());
}
/// The same for values in [0, 1], rounded to 8 bits.
inline void write_png(const std::string& path, image_view<const float> source) {
    write_png(path, map_pixels(source, quantize<std::uint8_t>));
}
/// Labels and classes have 16 bits: `write_netpbm` of io/netpbm.hpp writes them.
inline void write_png(const std::string& path, image_view<const std::uint16_t> source) = delete;

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify
