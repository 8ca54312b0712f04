// A loop over the pixels of a temporary image would read freed memory.
// expect: deleted
#include <insonify/core/image.hpp>

insonify::image<float> made() {
    return {4, 4};
}

int main() {
    float sum = 0;
#if defined(INSONIFY_COMPILE_FAIL)
    for (const float pixel : made().pixels()) sum += pixel;
#else
    const auto image = made();
    for (const float pixel : image.pixels()) sum += pixel;
#endif
    return static_cast<int>(sum);
}
