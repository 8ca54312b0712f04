// A scene by Mesa's llvmpipe through OpenGL ES 3: an orthographic shadow map fitted to what the picture shows, then the
// picture.
#pragma once

#include <memory>
#include <span>

#include "task.hpp"

namespace peers {

class llvmpipe_renderer {
  public:
    llvmpipe_renderer(const workload::task& task, int threads);
    ~llvmpipe_renderer();
    llvmpipe_renderer(llvmpipe_renderer&&) noexcept;

    void render(std::span<std::uint8_t> out);

  private:
    class pipeline;
    std::unique_ptr<pipeline> pipeline_;
};

}  // namespace peers
