// Hashes of everything the library computes, printed one line each: every build of this program must print the same.
// `golden [executor threads]...` adds the same scenes drawn on a pool of that many threads.
#include <insonify/core/thread_pool.hpp>
#include <insonify/insonify.hpp>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace in = insonify;
using namespace in::literals;

namespace {

/// FNV-1a, 64 bits, of any number of values.
struct hash {
    std::uint64_t value = 0xcbf29ce484222325u;

    void bytes(const void* data, std::size_t size) {
        for (std::size_t i = 0; i < size; ++i) {
            value ^= static_cast<const unsigned char*>(data)[i];
            value *= 0x100000001b3u;
        }
    }
    template <class T>
    void add(const in::image<T>& image) {
        bytes(image.pixels().data(), image.pixels().size_bytes());
    }
    void add(const in::mesh& m) {
        bytes(m.positions.data(), m.positions.size() * sizeof(glm::vec3));
        bytes(m.normals.data(), m.normals.size() * sizeof(glm::vec3));
        bytes(m.triangles.data(), m.triangles.size() * sizeof(glm::uvec3));
    }
};

void print(const char* name, const hash& h) {
    std::printf("%-24s %016llx\n", name, static_cast<unsigned long long>(h.value));
}

in::scene scene_over(in::seabed::any seabed) {
    in::scene scene;
    scene.seabed = std::move(seabed);
    scene.add(in::cylinder{.radius = 0.25f, .length = 2.0f}, {.position = {-2, 0.3, 0.3}, .yaw = 60_deg}, "cylinder");
    scene.add(in::cone{.radius = 0.4f, .height = 0.5f}, {.position = {1, 2, 0}, .pitch = 8_deg}, "cone");
    scene.add(in::sphere{.radius = 0.5f}, {.position = {3, -2, 0.2}, .burial = 0.1f}, "sphere");
    scene.add(in::cube{}, {.position = {-4, -3, 0.5}, .yaw = 0.3f, .roll = 0.1f}, "cube");
    return scene;
}

in::seabed::any blended() {
    return in::seabed::blend{};
}

template <class Shadow, class E>
void render(const char* name, const in::scene& scene, const in::overhead& rig, E& executor) {
    for (const int tile : {16, 64, 128})
        for (const in::isa level : {in::isa::scalar, in::isa::baseline, in::best_isa()}) {
            in::render_options<Shadow> options;
            options.tile = tile;
            options.level = level;
            const auto frame = in::render(scene, rig, options, executor);
            hash h;
            h.add(frame.image);
            h.add(frame.labels.instance);
            h.add(frame.labels.shadow);
            h.add(frame.labels.seabed);
            print(name, h);
        }
}

template <class E>
void render_all(E& executor) {
    const in::overhead rig{.position = {3.7, -1.2}, .altitude = 5, .yaw = 0.4f, .size = {200, 150}, .grazing = 7_deg};
    render<in::shadow::pcf>("flat, pcf", scene_over(in::seabed::flat{}), rig, executor);
    render<in::shadow::map>("ripples, map", scene_over(in::seabed::ripples{}), rig, executor);
    render<in::shadow::none>("mud, no shadow", scene_over(in::seabed::mud{}), rig, executor);
    render<in::shadow::pcf>("rock, pcf", scene_over(in::seabed::rock{}), rig, executor);
    render<in::shadow::pcf>("blend, pcf", scene_over(blended()), rig, executor);
}

void geometry() {
    hash h;
    for (const in::mesh& m : {to_mesh(in::cube{}), to_mesh(in::cylinder{}), to_mesh(in::capsule{}), to_mesh(in::cone{}),
                              to_mesh(in::sphere{}), to_mesh(in::hemisphere{})})
        h.add(in::transformed(m,
                              in::to_world({.position = {1e3, 2, 3}, .yaw = 1, .pitch = 2, .roll = 3, .scale = 0.7f})));
    print("primitives", h);
}

void filters() {
    in::image<float> ramp(257, 131);
    for (int y = 0; y < ramp.height(); ++y)
        for (int x = 0; x < ramp.width(); ++x) ramp(x, y) = static_cast<float>((x * 7 + y * 13) % 257) / 256.0f;
    const auto show = [&](const char* name, const auto& filter) {
        hash h;
        h.add(ramp | filter);
        print(name, h);
    };
    show("gaussian", in::gaussian{.seed = 3});
    show("speckle", in::speckle{.variance = 0.1f, .seed = 3});
    show("gaussian and speckle", in::gaussian_speckle{.seed = 3});
    show("rayleigh", in::rayleigh{.seed = 3});
    show("poisson", in::poisson{.seed = 3});
    show("equalize", in::equalize{});
    show("match", in::match_histogram(ramp | in::speckle{.seed = 5}));
    show("copper", in::colormap::copper);
}

}  // namespace

int main(int argc, char** argv) {
    geometry();
    filters();
    in::serial_executor serial;
    render_all(serial);
    for (int i = 1; i < argc; ++i) {
        in::thread_pool pool(static_cast<unsigned>(std::atoi(argv[i])));
        render_all(pool);
    }
}
