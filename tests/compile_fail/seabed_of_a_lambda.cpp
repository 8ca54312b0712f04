// A seabed is a model, which a lambda is not.
// expect: a seabed has row.*and kind
#include <insonify/insonify.hpp>

namespace in = insonify;

struct ramp {
    in::seabed::type kind = in::seabed::type::sand;
    void row(const in::seabed::scanline& line, std::span<float> heights) const {
        for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = 0.01f * static_cast<float>(line.x(i));
    }
};

void set_ramp(in::scene& scene) {
#ifdef INSONIFY_COMPILE_FAIL
    scene.seabed = [](double x, double) { return 0.01 * x; };
#else
    scene.seabed = ramp{};
#endif
}
