// Noise is for floats in [0, 1]: on codes of 8 bits it is an error that names the concept, not a white image.
// expect: filter_for
#include <insonify/filter/convert.hpp>
#include <insonify/filter/noise.hpp>
#include <insonify/filter/pipe.hpp>

namespace in = insonify;

int main() {
    const in::image<std::uint8_t> codes(4, 4);
#if defined(INSONIFY_COMPILE_FAIL)
    const auto noisy = codes | in::speckle{};
#else
    const auto noisy = codes | in::to_float | in::speckle{};
#endif
    return noisy.empty();
}
