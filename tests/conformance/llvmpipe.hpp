// Mesa's software renderer, without a window: triangles in clip space to the number of the triangle that each pixel
// shows.
#pragma once

#include <insonify/core/image.hpp>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>

namespace conformance {

namespace in = insonify;

/// What was drawn: rows from the top.
struct picture {
    in::image<std::uint32_t> winner;  ///< number of the visible triangle, counted from 1; 0 for none
    in::image<float> depth;           ///< where there is a winner
};

/// An OpenGL ES 3 context on llvmpipe; `renderer()` is empty where there is none.
class llvmpipe {
  public:
    llvmpipe() {
        setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
        setenv("GALLIUM_DRIVER", "llvmpipe", 1);
        const auto get_display =
            reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
        if (get_display == nullptr) return;
        display_ = get_display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
        if (display_ == EGL_NO_DISPLAY || eglInitialize(display_, nullptr, nullptr) == EGL_FALSE) return;
        eglBindAPI(EGL_OPENGL_ES_API);
        const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
        context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
        if (context_ == EGL_NO_CONTEXT) return;
        if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE) return;
        renderer_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
        if (renderer_.find("llvmpipe") == std::string::npos) {
            renderer_.clear();
            return;
        }
        link();
    }
    ~llvmpipe() {
        if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
        if (display_ != EGL_NO_DISPLAY) eglTerminate(display_);
    }
    llvmpipe(const llvmpipe&) = delete;
    llvmpipe& operator=(const llvmpipe&) = delete;

    const std::string& renderer() const { return renderer_; }

    /// Draws triangles, three corners each with 0 <= z <= w visible; the smallest depth wins, the first in a tie.
    picture draw(const std::vector<glm::vec4>& corners, int width, int height) const {
        struct corner {
            float position[4];
            std::uint32_t number;
        };
        std::vector<corner> data;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            // Rows of an off-screen target are stored in the order of y: turned over, memory has the top row first.
            const glm::vec4& p = corners[i];
            data.push_back({{p.x, -p.y, 2 * p.z - p.w, p.w}, static_cast<std::uint32_t>(i / 3 + 1)});
        }
        GLuint buffer = 0, array = 0, frame = 0, images[2] = {}, depth = 0;
        glGenVertexArrays(1, &array);
        glBindVertexArray(array);
        glGenBuffers(1, &buffer);
        glBindBuffer(GL_ARRAY_BUFFER, buffer);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(data.size() * sizeof(corner)), data.data(),
                     GL_STATIC_DRAW);
        glEnableVertexAttribArray(0);
        glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(corner), nullptr);
        glEnableVertexAttribArray(1);
        glVertexAttribIPointer(1, 1, GL_UNSIGNED_INT, sizeof(corner),
                               reinterpret_cast<const void*>(offsetof(corner, number)));

        glGenFramebuffers(1, &frame);
        glBindFramebuffer(GL_FRAMEBUFFER, frame);
        glGenTextures(2, images);
        const GLenum formats[2] = {GL_R32UI, GL_R32F}, attachments[2] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
        for (int i = 0; i < 2; ++i) {
            glBindTexture(GL_TEXTURE_2D, images[i]);
            glTexStorage2D(GL_TEXTURE_2D, 1, formats[i], width, height);
            glFramebufferTexture2D(GL_FRAMEBUFFER, attachments[i], GL_TEXTURE_2D, images[i], 0);
        }
        glDrawBuffers(2, attachments);
        glGenRenderbuffers(1, &depth);
        glBindRenderbuffer(GL_RENDERBUFFER, depth);
        glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);

        glViewport(0, 0, width, height);
        const GLuint nobody[4] = {};
        const GLfloat nothing[4] = {}, farthest[1] = {1};
        glClearBufferuiv(GL_COLOR, 0, nobody);
        glClearBufferfv(GL_COLOR, 1, nothing);
        glDepthMask(GL_TRUE);
        glClearBufferfv(GL_DEPTH, 0, farthest);
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
        glUseProgram(program_);
        glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(data.size()));

        picture result{in::image<std::uint32_t>(width, height), in::image<float>(width, height)};
        glReadBuffer(attachments[0]);
        glReadPixels(0, 0, width, height, GL_RED_INTEGER, GL_UNSIGNED_INT, result.winner.pixels().data());
        glReadBuffer(attachments[1]);
        glReadPixels(0, 0, width, height, GL_RED, GL_FLOAT, result.depth.pixels().data());
        failed_ |= glGetError() != GL_NO_ERROR;
        glDeleteRenderbuffers(1, &depth);
        glDeleteTextures(2, images);
        glDeleteFramebuffers(1, &frame);
        glDeleteBuffers(1, &buffer);
        glDeleteVertexArrays(1, &array);
        return result;
    }

    /// Whether any call so far was refused.
    bool failed() const { return failed_; }

  private:
    void link() {
        const char* const vertex = R"(#version 300 es
            layout(location = 0) in highp vec4 position;
            layout(location = 1) in highp uint number;
            flat out highp uint triangle;
            void main() { gl_Position = position; triangle = number; })";
        const char* const fragment = R"(#version 300 es
            flat in highp uint triangle;
            layout(location = 0) out highp uint winner;
            layout(location = 1) out highp float depth;
            void main() { winner = triangle; depth = gl_FragCoord.z; })";
        program_ = glCreateProgram();
        for (const auto& [kind, source] :
             {std::pair{GL_VERTEX_SHADER, vertex}, std::pair{GL_FRAGMENT_SHADER, fragment}}) {
            const GLuint shader = glCreateShader(static_cast<GLenum>(kind));
            glShaderSource(shader, 1, &source, nullptr);
            glCompileShader(shader);
            glAttachShader(program_, shader);
            glDeleteShader(shader);
        }
        glLinkProgram(program_);
        GLint linked = 0;
        glGetProgramiv(program_, GL_LINK_STATUS, &linked);
        failed_ |= linked == 0;
    }

    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
    std::string renderer_;
    GLuint program_ = 0;
    mutable bool failed_ = false;
};

}  // namespace conformance
