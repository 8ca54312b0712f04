// A chain does not apply to an image if a stage does not accept the pixels of the stage before it.
// expect: filter_for
#include <insonify/filter/colormap.hpp>
#include <insonify/filter/histogram.hpp>
#include <insonify/filter/pipe.hpp>

namespace in = insonify;

bool colored() {
    const in::image<float> frame(4, 4);
#if defined(INSONIFY_COMPILE_FAIL)
    const auto look = in::colormap::copper | in::equalize{};
#else
    const auto look = in::equalize{} | in::colormap::copper;
#endif
    return (frame | look).empty();
}
