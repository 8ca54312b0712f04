// Which points does a lamp reach? Tests positions along a dive for the light of a lamp on a frame above a cube.
#include <insonify/insonify.hpp>
#include <insonify/sonar/occlusion.hpp>

#include <cstdio>
#include <vector>

namespace in = insonify;

int main() {
    in::scene scene;
    scene.seabed = in::seabed::ripples{.wavelength = 1.2f, .steepness = 0.08f};
    scene.add(in::cube{}, {.position = {0, 0, 0.5}}, "cube");

    // Built once for a light; any number of points is tested afterwards.
    const in::shadow::point_light lamp{{-3, 0, 2.5}};
    const auto light = in::occlusion_of(scene, lamp, {.box = {{-4, -2, -0.5}, {4, 2, 3}}, .cell = 0.05});

    std::vector<glm::dvec3> dive;
    for (int i = 0; i < 32; ++i) dive.emplace_back(-4 + 0.25 * i, 0.1, 1.5 - 0.04 * i);
    const auto found = light.test(dive);
    for (std::size_t i = 0; i < dive.size(); ++i) {
        const char* const what = found.shadow[i] == in::labels::no_shadow   ? "lit"
                                 : found.shadow[i] == in::labels::by_seabed ? "dark, behind the seabed"
                                                                            : "dark, behind the cube";
        std::printf("%6.2f m, %5.2f m up: %s\n", dive[i].x, dive[i].z, what);
    }
    return found.shadow[0] == in::labels::no_shadow && found.shadow[18] == 1 ? 0 : 1;  // before the cube, and in it
}
