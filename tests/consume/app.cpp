// A program outside of the project that uses the library: one include, one picture.
#include <insonify/insonify.hpp>

namespace in = insonify;

int main() {
    in::image<float> depth(64, 64, in::empty_depth(in::depth_compare::less));
    const auto above = [](const in::vertex& v) { return glm::vec4(v.position.x, v.position.y, 0.5f, 1); };
    in::draw(in::to_mesh(in::cube{}), above, in::depth_target{depth});

    // A cube of edge 1 in a window of edge 2 covers a quarter of it.
    int covered = 0;
    for (const float value : depth.pixels()) covered += value == 0.5f;
    return covered == 32 * 32 ? 0 : 1;
}
