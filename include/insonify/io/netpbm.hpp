// Reading and writing PGM, PPM and PFM images. Malformed files are refused; writes are atomic.
//
//     pixel                     written as            read from
//     std::uint8_t              P5, maxval 255        P2, P5 up to maxval 255: the samples as they are
//     std::uint16_t             P5, maxval 65535      P2, P5: the samples as they are (instance maps)
//     rgb8, rgb<std::uint16_t>  P6                    P3, P6, as above
//     float                     Pf, little endian     Pf of either endianness; P2, P5 as sample / maxval
//     rgb<float>                PF, little endian     PF of either endianness; P3, P6 as sample / maxval
//
// Based on: Jef Poskanzer and others. Netpbm, pgm(5) and ppm(5). Paul Debevec. PFM Portable FloatMap.
#pragma once

#include <insonify/core/detail/portable.hpp>
#include <insonify/core/image.hpp>
#include <insonify/io/detail/netpbm_reader.hpp>
#include <insonify/io/file.hpp>

#include <concepts>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

template <class Pixel>
struct netpbm_pixel {
    using sample = Pixel;
    static constexpr int channels = 1;
};
template <class Sample>
struct netpbm_pixel<rgb<Sample>> {
    using sample = Sample;
    static constexpr int channels = 3;
};

template <class T>
concept netpbm_sample = std::same_as<T, std::uint8_t> || std::same_as<T, std::uint16_t> || std::same_as<T, float>;

inline void append_sample(std::string& bytes, std::uint8_t sample) {
    bytes.push_back(static_cast<char>(sample));
}
inline void append_sample(std::string& bytes, std::uint16_t sample) {
    bytes.push_back(static_cast<char>(sample >> 8));
    bytes.push_back(static_cast<char>(sample & 0xFF));
}
inline void append_sample(std::string& bytes, float sample) {
    const auto bits = numeric::bit_cast<std::uint32_t>(sample);
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>(bits >> shift & 0xFF));
}
template <class Sample>
void append_sample(std::string& bytes, const rgb<Sample>& pixel) {
    append_sample(bytes, pixel.r);
    append_sample(bytes, pixel.g);
    append_sample(bytes, pixel.b);
}

}  // namespace detail::inline INSONIFY_FLAGS

/// Pixels that have a netpbm file format.
template <class T>
concept storable_pixel = detail::netpbm_sample<typename detail::netpbm_pixel<T>::sample>;

inline namespace INSONIFY_FLAGS {

/// Parses the image in the bytes of a netpbm file; the table at the top lists the formats that each pixel type accepts.
/// Bytes after the image are ignored, as is the absolute value of a PFM's scale.
/// @param name  of the data, for error messages
/// @throws io_error if the bytes are not a netpbm file, or its format doesn't fit the pixel type
template <storable_pixel Pixel>
image<Pixel> parse_netpbm(std::string_view bytes, std::string_view name = "netpbm data") {
    using sample = typename detail::netpbm_pixel<Pixel>::sample;
    constexpr int channels = detail::netpbm_pixel<Pixel>::channels;
    detail::netpbm_reader reader(bytes, name);
    if (reader.channels() != channels)
        reader.fail(channels == 1 ? "a colour image, expected gray" : "a gray image, expected colour");
    if constexpr (!std::same_as<sample, float>) {
        constexpr int largest = (std::numeric_limits<sample>::max)();
        if (reader.is_float()) reader.fail("an image of floats, expected integer samples");
        if (reader.maxval() > largest) {
            reader.fail("maxval is " + detail::to_text(reader.maxval()) + ", expected at most " +
                        detail::to_text(largest));
        }
    }
    image<Pixel> out(reader.width(), reader.height());
    for (int row = 0; row < out.height(); ++row) {
        // PFM stores rows from the bottom up.
        for (Pixel& pixel : out.row(reader.is_float() ? out.height() - 1 - row : row)) {
            if constexpr (channels == 1) {
                pixel = detail::next_sample<sample>(reader);
            } else {
                pixel.r = detail::next_sample<sample>(reader);
                pixel.g = detail::next_sample<sample>(reader);
                pixel.b = detail::next_sample<sample>(reader);
            }
        }
    }
    return out;
}

/// The image in a netpbm file: `read_netpbm<float>("reference.pgm")`.
/// @throws io_error, naming the file, if it can't be read or parsed
template <storable_pixel Pixel>
image<Pixel> read_netpbm(const std::string& path) {
    return parse_netpbm<Pixel>(read_file(path), path);
}

/// The bytes of a binary netpbm file with this image: PGM, PPM or PFM by the pixel type.
/// @throws invalid_input for an image without pixels, which the formats cannot store
template <class Pixel>
    requires(storable_pixel<std::remove_const_t<Pixel>>)
std::string format_netpbm(image_view<Pixel> source) {
    using stored = detail::netpbm_pixel<std::remove_const_t<Pixel>>;
    using sample = typename stored::sample;
    constexpr bool gray = stored::channels == 1;
    constexpr bool floats = std::same_as<sample, float>;
    detail::require(!source.empty(), "pixels of the image", source.size(), "at least 1");
    std::string bytes = floats ? (gray ? "Pf" : "PF") : (gray ? "P5" : "P6");
    bytes += '\n' + detail::to_text(source.width()) + ' ' + detail::to_text(source.height()) + '\n';
    if constexpr (floats)
        bytes += "-1.0\n";
    else
        bytes += detail::to_text((std::numeric_limits<sample>::max)()) + '\n';
    bytes.reserve(bytes.size() + source.size() * sizeof(Pixel));
    for (int row = 0; row < source.height(); ++row)
        for (const Pixel& pixel : source.row(floats ? source.height() - 1 - row : row))
            detail::append_sample(bytes, pixel);
    return bytes;
}

/// The same for an image.
template <storable_pixel Pixel>
std::string format_netpbm(const image<Pixel>& source) {
    return format_netpbm(source.view());
}

/// Writes PGM, PPM or PFM by the pixel type, all or nothing.
/// @throws invalid_input for an image without pixels; io_error, naming the file, if it can't be written
template <class Pixel>
    requires(storable_pixel<std::remove_const_t<Pixel>>)
void write_netpbm(const std::string& path, image_view<Pixel> source) {
    write_file(path, format_netpbm(source));
}
/// The same for an image.
template <storable_pixel Pixel>
void write_netpbm(const std::string& path, const image<Pixel>& source) {
    write_netpbm(path, source.view());
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
