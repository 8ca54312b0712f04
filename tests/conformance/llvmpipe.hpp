// Mesa's software renderer, without a window: triangles in clip space to the number of the triangle that each pixel
// shows.
#pragma once

#include <insonify/core/image.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "../mesa_context.hpp"

namespace conformance {

namespace in = insonify;

/// A picture; its rows run from the top.
struct picture {
    in::image<std::uint32_t> triangle_id;  ///< number of the visible triangle, counted from 1; 0 for none
    in::image<float> depth;                ///< where a triangle is visible
};

/// Draws on llvmpipe; `renderer()` is empty where there is none.
class llvmpipe {
  public:
    llvmpipe() {
        if (!renderer().empty()) link();
    }

    const std::string& renderer() const { return context_.renderer(); }

    /// Draws triangles, three corners each with 0 <= z <= w visible; the smallest depth is visible, the first in a tie.
    picture draw(const std::vector<glm::vec4>& corners, int width, int height) const {
        struct corner {
            float position[4];
            std::uint32_t number;
        };
        std::vector<corner> data;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            // Rows of an off-screen target are stored in the order of y; flipped, memory has the top row first.
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
        const GLuint no_id[4] = {};
        const GLfloat nothing[4] = {}, farthest[1] = {1};
        glClearBufferuiv(GL_COLOR, 0, no_id);
        glClearBufferfv(GL_COLOR, 1, nothing);
        glDepthMask(GL_TRUE);
        glClearBufferfv(GL_DEPTH, 0, farthest);
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
        glUseProgram(program_);
        glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(data.size()));

        picture result{in::image<std::uint32_t>(width, height), in::image<float>(width, height)};
        glReadBuffer(attachments[0]);
        glReadPixels(0, 0, width, height, GL_RED_INTEGER, GL_UNSIGNED_INT, result.triangle_id.pixels().data());
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

    /// Whether any OpenGL call has failed.
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
            layout(location = 0) out highp uint triangle_id;
            layout(location = 1) out highp float depth;
            void main() { triangle_id = triangle; depth = gl_FragCoord.z; })";
        program_ = testing_mesa::program_of(vertex, fragment);
        failed_ |= program_ == 0;
    }

    testing_mesa::context context_;
    GLuint program_ = 0;
    mutable bool failed_ = false;
};

}  // namespace conformance
