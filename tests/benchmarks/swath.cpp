// Times of the parts of a swath: swath [threads] [pings] [bins] prints the median of nine, in milliseconds, part by
// part.
//
// The scene is 40 m x 40 m of ripples with the four targets, heard from 5 m; everything but memory is recomputed in
// every picture.
#include <insonify/all.hpp>
#include <insonify/core/thread_pool.hpp>

#include <cstdio>
#include <cstdlib>
#include <type_traits>

#include "median_ms.hpp"

namespace in = insonify;

namespace {

template <class Fn>
void print_median(const char* what, const Fn& work) {
    std::printf("  %-34s %7.1f ms\n", what, median_ms(work));
}

}  // namespace

int main(int argc, char** argv) {
    in::thread_pool threads(argc > 1 ? std::atoi(argv[1]) : 2);
    in::context context(threads);
    in::side_scan rig{.pings = argc > 2 ? std::atoi(argv[2]) : 1024, .bins = argc > 3 ? std::atoi(argv[3]) : 2048};
    rig.ping_spacing = 40.96f / static_cast<float>(rig.pings);

    in::scene scene;
    scene.seabed = in::seabed::ripples{};
    scene.add(in::cube{.size = glm::vec3(1)}, {.position = {12, 20, 0.5}, .yaw = 0.2f}, "cube");
    scene.add(in::cylinder{.radius = 0.3f, .length = 2}, {.position = {20, 10, 0.3}, .yaw = 0.9f}, "cylinder");
    scene.add(in::sphere{.radius = 0.5f}, {.position = {25, 30, 0.5}}, "sphere");
    scene.add(in::cone{.radius = 0.5f, .height = 1}, {.position = {30, 20, 0.5}}, "cone");

    const in::sonar_equation whole{in::spreading_loss{},  in::absorption{}, in::vertical_beam{},
                                   in::horizontal_beam{}, in::pulse{},      in::level_gain{}};
    using equation = std::remove_const_t<decltype(whole)>;
    using bare = in::record_options<in::no_labels>;
    const in::frame<> labelled = in::render(scene, rig, {}, context);
    std::printf("%d pings x %d bins, %llu vertices of seabed, %d threads\n", rig.pings, rig.bins,
                static_cast<unsigned long long>(labelled.stats.seabed_samples), threads.threads());
    print_median("picture", [&] { in::render(scene, rig, bare{}, context); });
    print_median("picture, labels", [&] { in::render(scene, rig, {}, context); });
    print_median("picture, labels, without a context", [&] { in::render(scene, rig, {}, threads); });
    print_median("picture, labels, sonar equation", [&] {
        in::render(scene, rig, in::record_options<in::labels, in::lambert_backscatter, equation>{.equation = whole},
                   context);
    });
    print_median("speckle on top", [&] { in::with_speckle(labelled, {}, context); });
    in::side_scan slanting = rig;
    slanting.yaw = 0.7f;
    print_median("picture, across the lattice", [&] { in::render(scene, slanting, bare{}, context); });
}
