// The netpbm reader on any bytes, once for each pixel type: an image that reads back as written, or its own error.
#include <insonify/io/netpbm.hpp>

#include <optional>
#include <string_view>

#include "fuzz.hpp"

namespace in = insonify;
using fuzzing::demand;
using fuzzing::same_bytes;

namespace {

template <class Pixel>
std::optional<in::image<Pixel>> parsed(std::string_view bytes) {
    try {
        return in::parse_netpbm<Pixel>(bytes);
    } catch (const in::io_error&) {  // anything else that is thrown ends the program
        return std::nullopt;
    }
}

template <class Pixel>
std::optional<in::image<Pixel>> check(std::string_view bytes) {
    const auto image = parsed<Pixel>(bytes);
    if (!image) return image;
    demand(!image->empty() && image->size() <= bytes.size(),
           "an image has pixels, and not more than its file has bytes");
    const std::string written = in::format_netpbm(*image);
    const auto again = parsed<Pixel>(written);
    demand(again && same_bytes(*again, *image), "what is written reads back as the same image");
    demand(in::format_netpbm(*again) == written, "the same image is written as the same bytes");
    return image;
}

/// Samples of 8 bits are the same in 16; as floats they are fractions of maxval, hence in the same order.
template <class Narrow, class Wide, class Float, class Sample>
void check_kinds(std::string_view bytes, Sample sample) {
    const auto narrow = check<Narrow>(bytes);
    const auto wide = check<Wide>(bytes);
    const auto floats = check<Float>(bytes);
    demand(!narrow || wide, "what fits 8 bits fits 16");
    demand(!wide || floats, "what is read as integers is read as floats");
    if (narrow)
        for (std::size_t i = 0; i < narrow->size(); ++i)
            demand(sample(narrow->pixels()[i]) == sample(wide->pixels()[i]), "samples don't depend on their type");
    if (wide)
        for (std::size_t i = 0; i < wide->size(); ++i) {
            const float share = sample(floats->pixels()[i]);
            demand(share >= 0 && share <= 1 && (share > 0) == (sample(wide->pixels()[i]) > 0),
                   "fractions are in [0, 1]");
        }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    check_kinds<std::uint8_t, std::uint16_t, float>(bytes, [](auto pixel) { return pixel; });
    check_kinds<in::rgb8, in::rgb<std::uint16_t>, in::rgb<float>>(bytes, [](auto pixel) { return pixel.g; });
    return 0;
}
