// A seabed needs a label.
// expect: a seabed has row.*and kind
#include <insonify/insonify.hpp>

namespace in = insonify;

struct slope {
#ifndef INSONIFY_COMPILE_FAIL
    in::seabed::type kind = in::seabed::type::sand;
#endif
    void row(const in::seabed::scanline& line, std::span<float> heights) const {
        for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = 0.01f * static_cast<float>(line.x(i));
    }
};

void set_slope(in::scene& scene) {
    scene.seabed = slope{};
}
