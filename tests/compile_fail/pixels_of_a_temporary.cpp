// A loop over the pixels of a temporary image would read freed memory.
// expect: deleted
#include <insonify/core/image.hpp>

insonify::image<float> zeros() {
    return {4, 4};
}

float sum_of_pixels() {
    float sum = 0;
#if defined(INSONIFY_COMPILE_FAIL)
    for (const float pixel : zeros().pixels()) sum += pixel;
#else
    const auto image = zeros();
    for (const float pixel : image.pixels()) sum += pixel;
#endif
    return sum;
}
