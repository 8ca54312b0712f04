// Implements stb's PNG writer and image reader for the examples. Where available, libdeflate compresses PNG files:
// stb's own compressor would take most of a data set's time and make larger files.
#include <cstdlib>

#if defined(EXAMPLES_LIBDEFLATE)
#include <libdeflate.h>

static unsigned char* packed(unsigned char* bytes, int count, int* packed_count, int level) {
    libdeflate_compressor* const compressor = libdeflate_alloc_compressor(level);
    if (compressor == nullptr) return nullptr;
    const std::size_t upper_bound = libdeflate_zlib_compress_bound(compressor, static_cast<std::size_t>(count));
    auto* const out = static_cast<unsigned char*>(std::malloc(upper_bound));  // stb frees it
    const std::size_t size =
        out == nullptr ? 0
                       : libdeflate_zlib_compress(compressor, bytes, static_cast<std::size_t>(count), out, upper_bound);
    libdeflate_free_compressor(compressor);
    *packed_count = static_cast<int>(size);
    return out;
}
#define STBIW_ZLIB_COMPRESS packed
#endif

// Formats with a signature. TGA is left out because stb accepts nearly any file as one, PNM because stb reads 16-bit
// files beyond its buffer.
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_IMPLEMENTATION
#if __has_include(<stb_image_write.h>)
#include <stb_image.h>
#include <stb_image_write.h>
#else
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#endif
