#include "llvmpipe_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <utility>

#include <glm/mat4x4.hpp>

#include "../../mesa_context.hpp"

namespace peers {

namespace {

constexpr double shadow_bias = 0.05;  // metres along the ray

constexpr const char* cast_vertex = R"(#version 300 es
    layout(location = 0) in highp vec3 position;
    uniform highp mat4 to_light_clip;
    void main() { gl_Position = to_light_clip * vec4(position, 1); })";

constexpr const char* cast_fragment = R"(#version 300 es
    void main() {})";

constexpr const char* draw_vertex = R"(#version 300 es
    layout(location = 0) in highp vec3 position;
    layout(location = 1) in highp vec3 normal;
    uniform highp mat4 to_clip, to_map;
    out highp vec3 n, on_map;
    void main() {
        gl_Position = to_clip * vec4(position, 1);
        on_map = (to_map * vec4(position, 1)).xyz;
        n = normal;
    })";

constexpr const char* draw_fragment = R"(#version 300 es
    precision highp float;
    precision highp sampler2DShadow;
    in vec3 n, on_map;
    uniform sampler2DShadow map;
    uniform vec3 to_light;
    uniform float ambient;
    layout(location = 0) out vec4 color;
    void main() {
        float facing = dot(n, to_light) * inversesqrt(dot(n, n)), value = ambient;
        if (facing > 0.0) {
            float open = textureOffset(map, on_map, ivec2(-1, -1)) + textureOffset(map, on_map, ivec2(0, -1)) +
                         textureOffset(map, on_map, ivec2(1, -1)) + textureOffset(map, on_map, ivec2(-1, 0)) +
                         texture(map, on_map) + textureOffset(map, on_map, ivec2(1, 0)) +
                         textureOffset(map, on_map, ivec2(-1, 1)) + textureOffset(map, on_map, ivec2(0, 1)) +
                         textureOffset(map, on_map, ivec2(1, 1));
            value += facing * open / 9.0;
        }
        color = vec4(value, value, value, 1);
    })";

/// Coordinates along three axes, each stretched so that [low, high] becomes [-1, 1].
struct box_projection {
    glm::dvec3 axes[3];
    double low[3] = {1e30, 1e30, 1e30}, high[3] = {-1e30, -1e30, -1e30};

    void include(const glm::vec3& p) {
        for (int k = 0; k < 3; ++k) {
            const double c = axes[k].x * static_cast<double>(p.x) + axes[k].y * static_cast<double>(p.y) +
                             axes[k].z * static_cast<double>(p.z);
            low[k] = (std::min)(low[k], c);
            high[k] = (std::max)(high[k], c);
        }
    }

    /// @param scale, shift  of the result: 1 and 0 for [-1, 1], 1/2 and 1/2 for [0, 1]
    /// @param towards       subtracted from the third coordinate before, metres
    glm::mat4 matrix(double scale, double shift, double towards = 0) const {
        glm::mat4 m(1);
        for (int k = 0; k < 3; ++k) {
            const double stretch = 2 * scale / (high[k] - low[k]);
            const glm::dvec3 row = stretch * axes[k];
            m[0][k] = static_cast<float>(row.x);
            m[1][k] = static_cast<float>(row.y);
            m[2][k] = static_cast<float>(row.z);
            m[3][k] = static_cast<float>(shift - stretch * ((k == 2 ? towards : 0) + 0.5 * (low[k] + high[k])));
        }
        return m;
    }
};

}  // namespace

class llvmpipe_renderer::pipeline {
  public:
    pipeline(const workload::task& task, int threads) : task_(task), context_(with_threads(threads)) {
        if (context_.renderer().empty()) throw std::runtime_error("no llvmpipe through EGL's surfaceless platform");
        upload(seabed_, task.seabed);
        upload(target_, task.target);
        make_map();
        make_target();
        make_programs();
        check();
    }

    void render(std::span<std::uint8_t> out) {
        glBindFramebuffer(GL_FRAMEBUFFER, map_frame_);
        glViewport(0, 0, map_size_, map_size_);
        glFrontFace(GL_CCW);
        glClear(GL_DEPTH_BUFFER_BIT);
        glUseProgram(cast_);
        draw(seabed_);
        draw(target_);

        glBindFramebuffer(GL_FRAMEBUFFER, frame_);
        glViewport(0, 0, task_.pixels, task_.pixels);
        glFrontFace(GL_CW);  // flipped vertically, so that memory has the top row first
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glUseProgram(draw_);
        draw(target_);
        draw(seabed_);
        glReadPixels(0, 0, task_.pixels, task_.pixels, GL_RED, GL_UNSIGNED_BYTE, out.data());
        check();
    }

  private:
    struct object {
        GLuint array = 0;
        GLsizei indices = 0;
    };

    static testing_mesa::context with_threads(int threads) {
        setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
        return {};
    }

    static void check() {
        if (glGetError() != GL_NO_ERROR) throw std::runtime_error("llvmpipe reports an OpenGL error");
    }

    static void upload(object& o, const workload::surface& s) {
        GLuint buffers[3];
        glGenVertexArrays(1, &o.array);
        glBindVertexArray(o.array);
        glGenBuffers(3, buffers);
        for (GLuint i = 0; i < 2; ++i) {
            const std::span<const glm::vec3> data = i == 0 ? s.positions : s.normals;
            glBindBuffer(GL_ARRAY_BUFFER, buffers[i]);
            glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(data.size_bytes()), data.data(), GL_STATIC_DRAW);
            glEnableVertexAttribArray(i);
            glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
        }
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[2]);
        glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(s.triangles.size_bytes()), s.triangles.data(),
                     GL_STATIC_DRAW);
        o.indices = static_cast<GLsizei>(3 * s.triangles.size());
    }

    static void draw(const object& o) {
        glBindVertexArray(o.array);
        glDrawElements(GL_TRIANGLES, o.indices, GL_UNSIGNED_INT, nullptr);
    }

    void make_map() {
        map_size_ = task_.cells <= 256 ? 2048 : 4096;
        GLuint texture = 0;
        glGenTextures(1, &texture);
        glBindTexture(GL_TEXTURE_2D, texture);
        glTexStorage2D(GL_TEXTURE_2D, 1, GL_DEPTH_COMPONENT24, map_size_, map_size_);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
        glGenFramebuffers(1, &map_frame_);
        glBindFramebuffer(GL_FRAMEBUFFER, map_frame_);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture, 0);
    }

    void make_target() {
        GLuint buffers[2];
        glGenRenderbuffers(2, buffers);
        glGenFramebuffers(1, &frame_);
        glBindFramebuffer(GL_FRAMEBUFFER, frame_);
        glBindRenderbuffer(GL_RENDERBUFFER, buffers[0]);
        glRenderbufferStorage(GL_RENDERBUFFER, GL_R8, task_.pixels, task_.pixels);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers[0]);
        glBindRenderbuffer(GL_RENDERBUFFER, buffers[1]);
        glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, task_.pixels, task_.pixels);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffers[1]);
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glClearColor(workload::task::background / 255.0f, 0, 0, 0);
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
        glEnable(GL_CULL_FACE);
    }

    /// The lowest and the highest vertex.
    std::pair<double, double> heights() const {
        double lowest = 0, highest = 0;
        for (const workload::surface* s : {&task_.seabed, &task_.target})
            for (const glm::vec3& p : s->positions) {
                lowest = std::min(lowest, static_cast<double>(p.z));
                highest = std::max(highest, static_cast<double>(p.z));
            }
        return {lowest, highest};
    }

    void make_programs() {
        cast_ = testing_mesa::program_of(cast_vertex, cast_fragment);
        draw_ = testing_mesa::program_of(draw_vertex, draw_fragment);
        if (cast_ == 0 || draw_ == 0) throw std::runtime_error("llvmpipe does not compile a shader");

        // The light looks along -to_light; its picture's right is level, so that the map's rows are the ground's.
        const glm::dvec3 back(task_.to_light);
        const double level = std::hypot(back.x, back.y);
        const glm::dvec3 right(-back.y / level, back.x / level, 0);
        const glm::dvec3 up(back.y * right.z - back.z * right.y, back.z * right.x - back.x * right.z,
                            back.x * right.y - back.y * right.x);
        // The ground in view, extended towards the light as far as anything can cast a shadow.
        const auto [lowest, highest] = heights();
        const double shown = task_.half_width * (task_.altitude - lowest) / task_.altitude,
                     reach = (highest - lowest) / back.z;
        const auto matters = [&](double at, double towards) {
            return at >= -shown + std::min(towards, 0.0) * reach && at <= shown + std::max(towards, 0.0) * reach;
        };
        box_projection light{{right, up, -back}};
        for (const workload::surface* s : {&task_.seabed, &task_.target})
            for (const glm::vec3& p : s->positions)
                if (matters(static_cast<double>(p.x), back.x) && matters(static_cast<double>(p.y), back.y))
                    light.include(p);
        const glm::mat4 to_light_clip = light.matrix(1, 0), to_map = light.matrix(0.5, 0.5, shadow_bias);

        const double room = 0.1 * task_.altitude, z_near = task_.altitude - highest - room,
                     z_far = task_.altitude - lowest + room;
        const auto scale = static_cast<float>(task_.altitude / task_.half_width);
        glm::mat4 to_clip(0);
        to_clip[0][0] = scale;
        to_clip[1][1] = -scale;
        to_clip[2][2] = static_cast<float>(-(z_far + z_near) / (z_far - z_near));
        to_clip[3][2] = static_cast<float>((task_.altitude * (z_far + z_near) - 2 * z_far * z_near) / (z_far - z_near));
        to_clip[2][3] = -1;
        to_clip[3][3] = static_cast<float>(task_.altitude);

        const auto set = [](GLuint program, const char* name, const glm::mat4& m) {
            glUniformMatrix4fv(glGetUniformLocation(program, name), 1, GL_FALSE, &m[0][0]);
        };
        glUseProgram(cast_);
        set(cast_, "to_light_clip", to_light_clip);
        glUseProgram(draw_);
        set(draw_, "to_clip", to_clip);
        set(draw_, "to_map", to_map);
        glUniform3fv(glGetUniformLocation(draw_, "to_light"), 1, &task_.to_light[0]);
        glUniform1f(glGetUniformLocation(draw_, "ambient"), workload::task::ambient);
    }

    workload::task task_;
    testing_mesa::context context_;
    object seabed_, target_;
    GLuint map_frame_ = 0, frame_ = 0, cast_ = 0, draw_ = 0;
    GLsizei map_size_ = 0;
};

llvmpipe_renderer::llvmpipe_renderer(const workload::task& task, int threads)
    : pipeline_(std::make_unique<pipeline>(task, threads)) {}
llvmpipe_renderer::~llvmpipe_renderer() = default;
llvmpipe_renderer::llvmpipe_renderer(llvmpipe_renderer&&) noexcept = default;

void llvmpipe_renderer::render(std::span<std::uint8_t> out) {
    pipeline_->render(out);
}

}  // namespace peers
