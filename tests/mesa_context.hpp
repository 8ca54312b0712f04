// An OpenGL ES 3 context on Mesa's software renderer, without a window.
#pragma once

#include <cstdlib>
#include <string>
#include <utility>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>

namespace testing_mesa {

/// A context on llvmpipe, current on the thread that made it; `renderer()` is empty where there is none.
class context {
  public:
    context() {
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
        if (renderer_.find("llvmpipe") == std::string::npos) renderer_.clear();
    }
    ~context() {
        if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
        if (display_ != EGL_NO_DISPLAY) eglTerminate(display_);
    }
    context(const context&) = delete;
    context& operator=(const context&) = delete;

    const std::string& renderer() const { return renderer_; }

  private:
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
    std::string renderer_;
};

/// A linked program of the current context; 0 if a shader does not compile.
inline GLuint program_of(const char* vertex, const char* fragment) {
    const GLuint program = glCreateProgram();
    for (const auto& [kind, source] : {std::pair{GL_VERTEX_SHADER, vertex}, std::pair{GL_FRAGMENT_SHADER, fragment}}) {
        const GLuint shader = glCreateShader(static_cast<GLenum>(kind));
        glShaderSource(shader, 1, &source, nullptr);
        glCompileShader(shader);
        glAttachShader(program, shader);
        glDeleteShader(shader);
    }
    glLinkProgram(program);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked == 0) {
        glDeleteProgram(program);
        return 0;
    }
    return program;
}

}  // namespace testing_mesa
