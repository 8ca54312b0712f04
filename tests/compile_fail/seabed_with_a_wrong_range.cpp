// A seabed's range is a height_range.
// expect: range\(\) of a seabed is const and returns a seabed::height_range
#include <insonify/insonify.hpp>

#include <utility>

namespace in = insonify;

struct terrace {
    in::seabed::type kind = in::seabed::type::sand;
    void row(const in::seabed::scanline&, std::span<float> heights) const {
        for (float& height : heights) height = 0.01f;
    }
#if defined(INSONIFY_COMPILE_FAIL)
    std::pair<double, double> range() const {
        return {0, 1};
    }
#else
    in::seabed::height_range range() const {
        return {0, 1};
    }
#endif
};

void set_terrace(in::scene& scene) {
    scene.seabed = terrace{};
}
