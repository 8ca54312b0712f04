// PNG files in memory.
#pragma once

#include <insonify/io/png.hpp>

#include <new>
#include <string>

namespace examples {

/// The bytes of a PNG file, 8 bits gray or colour.
/// @throws std::bad_alloc
template <class Pixel>
std::string png_bytes(const insonify::image<Pixel>& picture) {
    std::string bytes;
    const auto append = [](void* to, void* data, int size) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
    };
    constexpr int channels = sizeof(Pixel);
    static_assert(channels == 1 || channels == 3);
    if (stbi_write_png_to_func(append, &bytes, picture.width(), picture.height(), channels, picture.pixels().data(),
                               channels * picture.width()) == 0)
        throw std::bad_alloc();
    return bytes;
}

}  // namespace examples
