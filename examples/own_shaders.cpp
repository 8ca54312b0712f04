// Own vertex and fragment shaders: a lit, textured ball through a camera; own_shaders writes ball.png.
#include <insonify/insonify.hpp>
#include <insonify/io/png.hpp>
#include <insonify/raster/draw.hpp>

namespace in = insonify;
using namespace in::literals;

struct varyings {  // interpolated: floats and aggregates of them
    glm::vec3 normal;
    glm::vec2 texture;
};

struct vertex_shader {
    in::camera_view view;
    in::vertex_output<varyings> operator()(const in::vertex& v) const {
        return {view(v.position), {v.normal, {4 * (v.position.x + v.position.y), 8 * v.position.z}}};
    }
};

struct fragment_shader {
    glm::vec3 to_light{-0.36f, -0.48f, 0.8f};
    in::rgb8 operator()(const in::fragment<varyings>& f) const {
        const float lit = (std::max)(0.1f, glm::dot(glm::normalize(f.varyings.normal), to_light));
        const auto cell = [](float t) { return in::numeric::floor_to_int(static_cast<double>(t)); };
        const bool is_dark = ((cell(f.varyings.texture.x) + cell(f.varyings.texture.y)) & 1) != 0;
        const glm::u8vec3 c(lit * (is_dark ? glm::vec3(50, 80, 100) : glm::vec3(230, 215, 180)));
        return {c.r, c.g, c.b};
    }
};

int main() {
    const in::mesh ball = to_mesh(in::sphere{.radius = 1});
    in::image<in::rgb8> color(480, 320);
    in::image<float> depth(480, 320);
    in::draw(ball, vertex_shader{in::camera_view({.eye = {0, -4, 1.5}, .field_of_view = 40_deg, .aspect = 1.5f})},
             fragment_shader{}, in::framebuffer<in::rgb8>{color, depth, true, {5, 5, 5}},
             {.compare = in::depth_compare::greater, .load = in::depth_load::clear});
    in::write_png("ball.png", color);
}
