// Times of a frame and of steps like its own: frame [threads] [cells] [pixels] prints the median of nine of each, in
// milliseconds; among them a shadow map, which the default picture does without.
//
// A scene like the reference workload's, with the library's own ripples and the light along x: a seabed of cells x
// cells and a cylinder, seen from 10 m by a camera of 120 degrees, lit at 6 degrees. Everything but memory is
// recomputed in every frame.
#include <insonify/all.hpp>
#include <insonify/core/thread_pool.hpp>

#include <cstdio>
#include <cstdlib>

#include "median_ms.hpp"

namespace in = insonify;

int main(int argc, char** argv) {
    const int threads = argc > 1 ? std::atoi(argv[1]) : 2;
    const int cells = argc > 2 ? std::atoi(argv[2]) : 1024;
    const int pixels = argc > 3 ? std::atoi(argv[3]) : 2048;
    in::thread_pool pool(threads);
    in::context context(pool);

    in::scene scene;
    scene.seabed = in::seabed::ripples{};
    scene.add(in::cylinder{.radius = 0.5f, .length = 2}, {.position = {0, 0, 0.5}, .yaw = 0.5f}, "cylinder");
    const in::overhead rig{.altitude = 10, .size = {pixels, pixels}};

    const double side = 2 * in::overhead_geometry(rig).half_extent(0).x;
    const in::seabed::grid grid{{-side / 2, -side / 2}, side / cells, cells + 1, cells + 1};
    const auto field = in::seabed::sample(scene.seabed, grid, pool);
    const in::mesh bottom = in::seabed::tessellate(field, pool);
    const in::shadow::light_frame light({0, static_cast<double>(rig.grazing)});
    const double texel = in::overhead_geometry(rig).ground_sampling() / 1.5;
    const in::affine place{glm::dmat3(1), glm::dvec3(grid.origin, 0)};

    std::printf("%d x %d cells, %zu triangles, %d x %d pixels, %d threads\n", cells, cells, bottom.triangles.size(),
                pixels, pixels, pool.threads());
    std::printf("  sample the seabed       %7.1f ms\n",
                median_ms([&] { in::seabed::sample(scene.seabed, grid, pool); }));
    std::printf("  tessellate it           %7.1f ms\n", median_ms([&] { in::seabed::tessellate(field, pool); }));
    std::printf("  draw its shadow map     %7.1f ms\n", median_ms([&] {
                    in::shadow::height_map map(light, in::shadow::extent_of(in::bounds(bottom), place, light), texel);
                    map.cast(bottom, place, pool);
                }));
    const auto frame_ms = [&]<class Shadow, class Labels>(in::render_options<Shadow, Labels> options) {
        options.cell = side / cells;
        return median_ms([&] { in::render(scene, rig, options, context); });
    };
    using in::render_options, in::no_labels;
    namespace shadow = in::shadow;
    std::printf("  frame, no shadows       %7.1f ms\n", frame_ms(render_options<shadow::none, no_labels>{}));
    std::printf("  frame, shadows          %7.1f ms\n", frame_ms(render_options<shadow::exact, no_labels>{}));
    std::printf("  frame, shadows, labels  %7.1f ms\n", frame_ms(render_options<>{}));
    std::printf("    without a context     %7.1f ms\n",
                median_ms([&] { in::render(scene, rig, render_options<>{.cell = side / cells}, pool); }));
    std::printf("  frame with labels, shadows by a map / exact\n");
    const auto by_policy = [&](const char* bottom_name) {
        std::printf("    %-8s %7.1f / %.1f ms\n", bottom_name, frame_ms(render_options<shadow::map>{}),
                    frame_ms(render_options<shadow::exact>{}));
    };
    by_policy("ripples");
    scene.seabed = in::seabed::mud{};
    by_policy("mud");
    scene.seabed = in::seabed::flat{};
    by_policy("flat");
}
