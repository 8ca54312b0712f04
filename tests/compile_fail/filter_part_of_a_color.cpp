// A filter that returns gray pixels cannot write into an image of colours.
// expect: same_as
#include <insonify/filter/gray.hpp>
#include <insonify/filter/pipe.hpp>

namespace in = insonify;

void gray_picture() {
    in::image<in::rgb8> colors(4, 4);
#if defined(INSONIFY_COMPILE_FAIL)
    in::apply_in_place(colors.view(), in::to_gray{});
#else
    in::image<std::uint8_t> gray(4, 4);
    in::apply_into(colors.view(), gray.view(), in::to_gray{});
#endif
}
