// Pieces of work whose instructions are counted: work <name> <times>, on one thread. See instructions.py.
#include <insonify/all.hpp>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "peers/insonify_renderer.hpp"

namespace {

namespace in = insonify;

using piece = std::function<void()>;

/// The reference workload in size S.
piece frame() {
    const workload::size size = workload::sizes[0];
    const auto renderer = std::make_shared<peers::insonify_renderer<in::shadow::exact>>(workload::scene(size), 1);
    const auto pixels = static_cast<std::size_t>(size.pixels);
    return [=, out = std::vector<std::uint8_t>(pixels * pixels)]() mutable { renderer->render(out); };
}

in::scene ripples_with_a_cylinder() {
    in::scene scene;
    scene.seabed = in::seabed::ripples{};
    scene.add(in::cylinder{.radius = 0.25f, .length = 1}, {.position = {0, 4, 0.25}, .yaw = 0.5f}, "cylinder");
    return scene;
}

/// A picture of a sampled seabed with all labels that a data set stores.
piece labelled_frame() {
    return [scene = ripples_with_a_cylinder()] { in::render(scene, in::overhead{.altitude = 5, .size = {256, 256}}); };
}

piece swath() {
    return [scene = ripples_with_a_cylinder()] {
        in::render(scene, in::side_scan{.altitude = 3, .pings = 64, .bins = 256});
    };
}

/// Targets far smaller than the picture, each with its shadow.
piece many_targets() {
    in::scene scene;
    const in::shared_mesh pebble(in::to_mesh(in::cube{.size = glm::vec3(0.02f)}));
    in::random_sequence places(1);
    for (int i = 0; i < 2000; ++i) {
        const double x = places.uniform(-5, 5), y = places.uniform(-5, 5);
        scene.add(pebble, {.position = {x, y, 0.01}}, "pebble");
    }
    return [=] { in::render(scene, in::overhead{.altitude = 5, .size = {256, 256}}); };
}

/// The fixture of a unit test: scene and frame.
piece fixture() {
    return [] {
        in::scene scene;
        scene.seabed = in::seabed::ripples{};
        scene.add(in::cube{.size = glm::vec3(0.3f)}, {.position = {0.5, 0, 0.15}}, "cube");
        in::render(scene, in::overhead{.altitude = 3, .size = {128, 128}});
    };
}

template <class Seabed>
piece sampling(const Seabed& seabed) {
    return [=] { in::seabed::sample(seabed, {{-5, -5}, 0.04, 256, 256}); };
}

template <class Filter>
piece filtering(const Filter& filter) {
    return [=, image = in::image<float>(256, 256, 0.5f)] { (void)(image | filter); };
}

const std::map<std::string_view, std::function<piece()>> pieces{
    {"frame", frame},
    {"labelled_frame", labelled_frame},
    {"swath", swath},
    {"fixture", fixture},
    {"many_targets", many_targets},
    {"flat", [] { return sampling(in::seabed::flat{}); }},
    {"ripples", [] { return sampling(in::seabed::ripples{}); }},
    {"mud", [] { return sampling(in::seabed::mud{}); }},
    {"rock", [] { return sampling(in::seabed::rock{}); }},
    {"gaussian", [] { return filtering(in::gaussian{.variance = 0.01f}); }},
    {"speckle", [] { return filtering(in::speckle{.variance = 0.1f}); }},
    {"noise_and_match",
     [] {
         const in::histogram wanted{std::vector<std::uint64_t>(64, 1)};
         return filtering(in::gaussian{} | in::speckle{} | in::match_binned(wanted) | in::to_uint8);
     }},
    {"poisson", [] { return filtering(in::poisson{.photons = 100}); }},
};

}  // namespace

int main(int argc, char** argv) {
    if (argc == 2 && std::string_view(argv[1]) == "names") {
        for (const auto& [name, make] : pieces) std::printf("%.*s\n", static_cast<int>(name.size()), name.data());
        return 0;
    }
    const auto found = argc == 3 ? pieces.find(argv[1]) : pieces.end();
    if (found == pieces.end()) {
        std::fprintf(stderr, "usage: work names | work <name> <times>\n");
        return 2;
    }
    const piece work = found->second();
    for (int i = 0; i < std::atoi(argv[2]); ++i) work();
}
