// A fragment shader takes the varyings of the vertex shader.
// expect: a fragment shader takes.*varyings
#include <insonify/core/image.hpp>
#include <insonify/geometry/cube.hpp>
#include <insonify/raster/draw.hpp>

namespace in = insonify;

struct lit {
    float light;
};

void shade_cube(in::image<float>& color, in::image<float>& depth) {
    const auto vertex_shader = [](const in::vertex& v) {
        return in::vertex_output<lit>{glm::vec4(v.position, 1), {v.normal.z}};
    };
#if defined(INSONIFY_COMPILE_FAIL)
    const auto fragment_shader = [](const in::fragment<float>& f) { return f.varyings; };
#else
    const auto fragment_shader = [](const in::fragment<lit>& f) { return f.varyings.light; };
#endif
    in::draw(in::to_mesh(in::cube{}), vertex_shader, fragment_shader, in::framebuffer<float>{color, depth});
}
