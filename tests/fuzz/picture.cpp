// Pictures that users name (PNG, JPEG, BMP, PGM, PPM, PFM by their content) on any bytes, through to pixels of an image
// that has the picture's look: gray values, or the reader's own error.
#include <insonify/filter/match.hpp>

#include "../../examples/common/pictures.hpp"
#include "fuzz.hpp"

namespace in = insonify;
using fuzzing::demand;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const in::image<float> picture =
            examples::parse_gray({reinterpret_cast<const char*>(data), size}, "picture", 1 << 22);
        demand(!picture.empty() && picture.size() <= 1 << 22, "a picture has pixels, and no more than its limit");
        bool any = false;
        for (const float value : picture.pixels()) any = any || in::numeric::is_finite(value);
        if (!any) return 0;
        in::image<float> drawn(8, 8);
        for (std::size_t i = 0; i < drawn.size(); ++i) drawn.pixels()[i] = static_cast<float>(i) / 64;
        const in::image<float> alike = drawn | in::match_histogram(picture);
        for (const float value : alike.pixels())
            demand(in::numeric::is_finite(value), "a look is made of finite values");
    } catch (const in::io_error&) {  // anything else that is thrown ends the program
    }
    return 0;
}
