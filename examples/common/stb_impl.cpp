// The one translation unit that implements stb's PNG writer and image reader for the examples. With libdeflate, PNG
// files are packed by it instead of by stb's own packer, which takes most of a data set's time and leaves larger files.
#include <cstdlib>

#if defined(EXAMPLES_LIBDEFLATE)
#include <libdeflate.h>

static unsigned char* packed(unsigned char* bytes, int count, int* packed_count, int level) {
    libdeflate_compressor* const compressor = libdeflate_alloc_compressor(level);
    if (compressor == nullptr) return nullptr;
    const std::size_t most = libdeflate_zlib_compress_bound(compressor, static_cast<std::size_t>(count));
    auto* const out = static_cast<unsigned char*>(std::malloc(most));  // stb frees it
    const std::size_t size =
        out == nullptr ? 0 : libdeflate_zlib_compress(compressor, bytes, static_cast<std::size_t>(count), out, most);
    libdeflate_free_compressor(compressor);
    *packed_count = static_cast<int>(size);
    return out;
}
#define STBIW_ZLIB_COMPRESS packed
#endif

// Formats that are known by their first bytes; stb takes nearly anything for a TGA, and reads 16-bit PNM beyond its
// buffer.
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
