// A scene by Embree: a ray for each pixel and one towards the light, in packets of 16.
#pragma once

#include <memory>
#include <span>

#include "task.hpp"

namespace peers {

/// How the seabed is given to Embree, and whether its tree lives longer than a frame.
enum class embree_tree { mesh_kept, mesh_rebuilt, grid_kept, grid_rebuilt, exact };

class embree_renderer {
  public:
    embree_renderer(const workload::task& task, embree_tree tree, int threads);
    ~embree_renderer();
    embree_renderer(embree_renderer&&) noexcept;

    void render(std::span<std::uint8_t> out);

  private:
    class tracer;
    std::unique_ptr<tracer> tracer_;
};

}  // namespace peers
