// A view of a temporary image would dangle.
// expect: deleted
#include <insonify/core/image.hpp>

insonify::image<float> made() {
    return {4, 4};
}

int width_of_view() {
#if defined(INSONIFY_COMPILE_FAIL)
    const auto view = made().view();
#else
    const auto pixels = made();
    const auto view = pixels.view();
#endif
    return view.width();
}
