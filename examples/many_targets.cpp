// Many targets of several classes, and their labels: many_targets prints a table and writes classes.png.
#include <insonify/insonify.hpp>
#include <insonify/io/png.hpp>

#include <cstdio>

namespace in = insonify;
using namespace in::literals;

int main() {
    in::scene scene;
    scene.seabed = in::seabed::mud{.seed = 3};
    const in::shared_mesh crate = to_mesh(in::cube{.size = glm::vec3(0.4f)});
    const in::shared_mesh drum = to_mesh(in::cylinder{.radius = 0.2f, .length = 0.8f});
    const in::shared_mesh mine = to_mesh(in::sphere{.radius = 0.25f});

    in::random_sequence random(11);
    for (int i = 0; i < 40; ++i) {
        const in::pose somewhere{.position = {random.uniform(-5, 5), random.uniform(-5, 5), 0},
                                 .yaw = static_cast<float>(random.uniform(0, 6.28)),
                                 .burial = static_cast<float>(random.uniform(0, 0.1))};
        const in::shared_mesh& shape = i % 3 == 0 ? crate : i % 3 == 1 ? drum : mine;
        const char* const name = i % 3 == 0 ? "crate" : i % 3 == 1 ? "drum" : "mine";
        scene.add(shape, in::rest_on(scene.seabed, *shape, somewhere), name);
    }

    const auto frame = in::render(scene, in::overhead{.altitude = 5, .size = {800, 800}, .grazing = 10_deg});
    const in::class_map map = in::classes_of(frame.labels);
    in::write_png(
        "classes.png", map.classes | [](std::uint16_t c) { return static_cast<std::uint8_t>(80 * c); });
    std::puts("class,instance,x,y,width,height,visible pixels,shadow pixels");
    for (const in::target_label& t : frame.labels.targets)
        std::printf("%s,%d,%d,%d,%d,%d,%lld,%lld\n", t.class_name.c_str(), t.instance, t.box.x0, t.box.y0,
                    t.box.width(), t.box.height(), static_cast<long long>(t.area),
                    static_cast<long long>(t.shadow_area));
    return map.names.size() == 3 ? 0 : 1;
}
