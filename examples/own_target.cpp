// A target from an OBJ file, ten times in a scene without copying its mesh: own_target mesh.obj writes herd.png.
#include <insonify/geometry/obj.hpp>
#include <insonify/insonify.hpp>
#include <insonify/io/png.hpp>

#include <cstdio>

namespace in = insonify;
using namespace in::literals;

int main(int argc, char** argv) try {
    if (argc < 2) return std::fputs("own_target mesh.obj\n", stderr), 2;
    // Bounds, normals and what shadows need of the shape are computed once. Copies refer to the same triangles.
    const in::shared_mesh shape = in::transformed(in::load_obj(argv[1]), in::to_world({.roll = 90_deg}));  // y is up
    const glm::dvec3 size = shape.box().size();
    const auto scale = static_cast<float>(1 / (std::max)({size.x, size.y, size.z}));

    in::scene scene;
    scene.seabed = in::seabed::flat{.seed = 5};
    for (int i = 0; i < 10; ++i) {
        const in::pose place{.position = {1.3 * (i % 5) - 2.6, 2.0 * (i / 5) - 1, 0},
                             .yaw = 36_deg * static_cast<float>(i),
                             .scale = scale};
        scene.add(shape, in::rest_on(scene.seabed, *shape, place), "cow", {.reflectivity = 0.8f});
    }
    const auto frame = in::render(scene, in::overhead{.altitude = 4, .size = {640, 640}, .grazing = 15_deg});
    in::write_png("herd.png", frame.image | in::speckle{.variance = 0.03f} | in::colormap::copper);

    int visible = 0;
    for (const in::target_label& t : frame.labels.targets) visible += t.area > 0;
    std::printf("%zu triangles, drawn %d times\n", shape->triangles.size(), visible);
    return visible == 10 ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "own_target: %s\n", error.what());
    return 1;
}
