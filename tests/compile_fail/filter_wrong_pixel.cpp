// Noise is for floats in [0, 1] and codes of 8 and 16 bits: on doubles it is an error that names the concept.
// expect: filter_for
#include <insonify/filter/noise.hpp>
#include <insonify/filter/pipe.hpp>

namespace in = insonify;

bool noisy_picture() {
    const in::image<double> picture(4, 4);
#if defined(INSONIFY_COMPILE_FAIL)
    const auto noisy = picture | in::speckle{};
#else
    const auto noisy = picture | [](double v) { return static_cast<float>(v); } | in::speckle{};
#endif
    return noisy.empty();
}
