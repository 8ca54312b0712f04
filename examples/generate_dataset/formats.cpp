#include "formats.hpp"

#include <insonify/core/quantize.hpp>
#include <insonify/io/netpbm.hpp>

#include <bit>
#include <cstring>
#include <new>

#include "record.hpp"
#include <png.h>

namespace generator {

namespace {

/// NumPy's format 1.0: magic, version, length of the header, a Python dictionary, padded to 64 bytes.
std::string npy_header(int width, int height) {
    std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(height) + ", " +
                         std::to_string(width) + "), }";
    constexpr std::size_t fixed = 10, alignment = 64;
    header.append(alignment - (fixed + header.size() + 1) % alignment, ' ');
    header += '\n';
    std::string bytes("\x93NUMPY\x01\x00", 8);
    bytes += static_cast<char>(header.size() & 255);
    bytes += static_cast<char>(header.size() >> 8);
    return bytes + header;
}

std::string float_path(std::uint64_t index, const std::string& extension) {
    return "values/" + block_of(index) + "/" + id_of(index) + extension;
}

void append_to_string(png_structp png, png_bytep data, png_size_t size) {
    try {
        static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), size);
    } catch (...) {
        png_error(png, "out of memory");
    }
}

/// libpng reports errors by longjmp, which runs no destructors: all locals here are trivial.
/// @param samples  big-endian, row by row
/// @returns false if memory ran out
bool encode_png16(const png_byte* samples, int width, int height, std::string* bytes) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
    if (info == nullptr) {
        png_destroy_write_struct(&png, nullptr);
        return false;
    }
    if (setjmp(png_jmpbuf(png)) != 0) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_set_write_fn(png, bytes, append_to_string, nullptr);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 16, PNG_COLOR_TYPE_GRAY,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(png, 1);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
    png_write_info(png, info);
    for (int y = 0; y < height; ++y)
        png_write_row(png, samples + 2 * static_cast<std::size_t>(width) * static_cast<std::size_t>(y));
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return true;
}

/// A 16-bit gray PNG; 1 becomes 65535, rounded to nearest.
std::string png16_bytes(const insonify::image<float>& picture) {
    std::vector<png_byte> samples;
    samples.reserve(2 * picture.size());
    for (const float value : picture.pixels()) {
        const std::uint16_t code = insonify::quantize<std::uint16_t>(value);
        samples.push_back(static_cast<png_byte>(code >> 8));
        samples.push_back(static_cast<png_byte>(code & 255));
    }
    std::string bytes;
    if (!encode_png16(samples.data(), picture.width(), picture.height(), &bytes)) throw std::bad_alloc();
    return bytes;
}

/// A NumPy array: float32, little endian, top row first.
std::string npy_bytes(const insonify::image<float>& picture) {
    std::string bytes = npy_header(picture.width(), picture.height());
    bytes.reserve(bytes.size() + 4 * picture.size());
    for (const float value : picture.pixels()) {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        for (int i = 0; i < 4; ++i) bytes += static_cast<char>(bits >> 8 * i & 255);
    }
    return bytes;
}

}  // namespace

void add_formats(const std::vector<std::string>& formats, std::uint64_t index, const insonify::image<float>& values,
                 std::vector<file>& files, nlohmann::ordered_json& record) {
    for (const std::string& name : formats) {
        if (name == "webdataset") continue;
        if (name == "png16") files.push_back({float_path(index, "_16.png"), png16_bytes(values)});
        if (name == "npy") files.push_back({float_path(index, ".npy"), npy_bytes(values)});
        if (name == "pfm") files.push_back({float_path(index, ".pfm"), insonify::format_netpbm(values)});
        record["files"].push_back(entry_of(name, files.back()));
    }
}

std::string format_fault(const std::string& of, const std::string& bytes, int size) {
    if (of == "npy") {
        const std::string header = npy_header(size, size);
        const auto pixels = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
        return bytes.starts_with(header) && bytes.size() == header.size() + 4 * pixels
                   ? ""
                   : "is not an array of the image's size";
    }
    if (of == "pfm") {
        const auto picture = insonify::parse_netpbm<float>(bytes, of);
        return picture.width() == size && picture.height() == size ? "" : "does not have the image's size";
    }
    png_image picture{};
    picture.version = PNG_IMAGE_VERSION;
    std::string fault;
    if (png_image_begin_read_from_memory(&picture, bytes.data(), bytes.size()) == 0)
        return std::string("does not decode: ") + picture.message;
    if (picture.format != PNG_FORMAT_LINEAR_Y || picture.width != static_cast<png_uint_32>(size) ||
        picture.height != static_cast<png_uint_32>(size)) {
        fault = "is not a 16-bit gray PNG of the image's size";
    } else {
        std::vector<png_uint_16> pixels(PNG_IMAGE_SIZE(picture) / 2);
        if (png_image_finish_read(&picture, nullptr, pixels.data(), 0, nullptr) == 0)
            fault = std::string("does not decode: ") + picture.message;
    }
    png_image_free(&picture);
    return fault;
}

}  // namespace generator
