// A vertex shader returns a clip position.
// expect: a vertex shader takes.*and returns
#include <insonify/core/image.hpp>
#include <insonify/geometry/cube.hpp>
#include <insonify/raster/draw.hpp>

namespace in = insonify;

void place_cube(in::image<float>& color, in::image<float>& depth) {
#if defined(INSONIFY_COMPILE_FAIL)
    const auto vertex_shader = [](const in::vertex& v) { return v.position; };
#else
    const auto vertex_shader = [](const in::vertex& v) { return glm::vec4(v.position, 1); };
#endif
    const auto fragment_shader = [](const in::fragment<in::no_varyings>&) { return 1.0f; };
    in::draw(in::to_mesh(in::cube{}), vertex_shader, fragment_shader, in::framebuffer<float>{color, depth});
}
