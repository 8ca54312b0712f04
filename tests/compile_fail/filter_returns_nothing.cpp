// A function that modifies its argument and returns nothing is not a filter.
// expect: filter_for
#include <insonify/filter/noise.hpp>
#include <insonify/filter/pipe.hpp>

namespace in = insonify;

bool doubled() {
    const in::image<float> frame(4, 4);
#if defined(INSONIFY_COMPILE_FAIL)
    return (frame | [](float& v) { v *= 2; }).empty();
#else
    return (frame | [](float v) { return v * 2; }).empty();
#endif
}
