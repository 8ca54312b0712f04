// Depth-only rendering, which compiles no shading: the depth buffer of a scanner above a seabed; depth_only writes
// depth.png.
#include <insonify/insonify.hpp>
#include <insonify/io/png.hpp>
#include <insonify/raster/draw.hpp>
#include <insonify/seabed/sample.hpp>
#include <insonify/seabed/tessellate.hpp>

#include <cstdio>

namespace in = insonify;

int main() {
    const in::seabed::rock rubble{.relief = 0.4f, .seed = 3};
    const auto field = in::seabed::sample(rubble, in::seabed::grid_over({-4, -4}, {4, 4}, 0.02));
    const in::mesh bottom = in::seabed::tessellate(field);

    in::camera scanner{.eye = {-3, -7, 5}, .z_near = 0.1f};
    const in::camera_view view(scanner, {glm::dmat3(1), glm::dvec3(field.origin, 0)});
    in::image<float> depth(512, 512);
    const auto stats = in::draw(bottom, [&](const in::vertex& v) { return view(v.position); }, in::depth_target{depth},
                                {.compare = in::depth_compare::greater, .load = in::depth_load::clear});

    // Depth is z_near / distance along the camera's axis, and empty_depth where no surface covers the pixel.
    float nearest = 0;
    for (const float d : depth.pixels()) nearest = (std::max)(nearest, d);
    std::printf("%llu triangles, the nearest %.2f m along the camera's axis\n",
                static_cast<unsigned long long>(stats.triangles), static_cast<double>(scanner.z_near / nearest));
    const auto shade = [=](float d) { return d > 0 ? 0.8f * d / nearest : 0.0f; };
    in::write_png("depth.png", depth | shade);
    return nearest > 0 ? 0 : 1;
}
