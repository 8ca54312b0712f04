#include "embree_renderer.hpp"

#include <insonify/core/thread_pool.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "../../embree.hpp"

namespace peers {

namespace {

constexpr int lanes = 16, block = 4;   // a packet is a block of 4 x 4 pixels
constexpr int tile = 32;               // pixels a side, the work item of a thread
constexpr float shadow_start = 1e-3f;  // metres along the ray within which hits are ignored

struct triangle_corners {
    glm::uvec3 index;
    glm::vec3 weights;
};

}  // namespace

class embree_renderer::tracer {
  public:
    tracer(const workload::task& task, embree_tree tree, int threads)
        : task_(task),
          tree_(tree),
          pool_(threads),
          device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())) {
        if (device_ == nullptr) throw std::runtime_error("Embree provides no device");
        if (task.pixels % tile != 0) throw std::invalid_argument("pixels must be a multiple of 32");
        scene_ = rtcNewScene(device_);
        if (tree == embree_tree::exact) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        // A tree for one frame is cheapest as a Morton build of each object, which only a dynamic scene gets.
        if (is_rebuilt()) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
        rtcSetSceneBuildQuality(scene_, is_rebuilt() ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_HIGH);
        attach(is_grid() ? grid() : triangles(task.seabed));
        attach(triangles(task.target));
        rtcCommitScene(scene_);
        if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw std::runtime_error("Embree rejects the scene");
    }
    ~tracer() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    tracer(const tracer&) = delete;
    tracer& operator=(const tracer&) = delete;

    void render(std::span<std::uint8_t> out) {
        if (is_rebuilt()) rebuild();
        const int columns = task_.pixels / tile;
        pool_.bulk(static_cast<std::size_t>(columns) * static_cast<std::size_t>(columns), [&](std::size_t i) {
            const int x0 = static_cast<int>(i) % columns * tile, y0 = static_cast<int>(i) / columns * tile;
            embree::query query(true);
            for (int y = y0; y < y0 + tile; y += block)
                for (int x = x0; x < x0 + tile; x += block) trace(x, y, query, out);
        });
    }

  private:
    bool is_grid() const { return tree_ == embree_tree::grid_kept || tree_ == embree_tree::grid_rebuilt; }
    bool is_rebuilt() const { return tree_ == embree_tree::mesh_rebuilt || tree_ == embree_tree::grid_rebuilt; }

    void attach(RTCGeometry geometry) {
        if (is_rebuilt()) rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
    }

    /// Embree's own copy of vertices, so that it may read past the last one.
    static glm::vec3* vertices(RTCGeometry geometry, std::size_t count) {
        return static_cast<glm::vec3*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), count));
    }

    RTCGeometry triangles(const workload::surface& s) const {
        const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        std::copy(s.positions.begin(), s.positions.end(), vertices(geometry, s.positions.size()));
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, s.triangles.data(), 0,
                                   sizeof(glm::uvec3), s.triangles.size());
        return geometry;
    }

    /// The seabed as one grid. Embree cuts its cells from (i + 1, j) to (i, j + 1), so rows are mirrored: then it cuts
    /// them as the mesh is cut.
    RTCGeometry grid() const {
        const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_GRID);
        const std::size_t side = static_cast<std::size_t>(task_.cells) + 1;
        glm::vec3* const mirrored = vertices(geometry, side * side);
        for (std::size_t j = 0; j < side; ++j)
            for (std::size_t i = 0; i < side; ++i)
                mirrored[j * side + i] = task_.seabed.positions[j * side + side - 1 - i];
        auto* const whole = static_cast<RTCGrid*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID, sizeof(RTCGrid), 1));
        *whole = {0, static_cast<unsigned>(side), static_cast<unsigned short>(side), static_cast<unsigned short>(side)};
        return geometry;
    }

    /// Marks the seabed's vertices as modified, so that the commit rebuilds the tree.
    void rebuild() {
        const RTCGeometry seabed = rtcGetGeometry(scene_, 0);
        rtcUpdateGeometryBuffer(seabed, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(seabed);
        rtcCommitScene(scene_);
    }

    /// The corners around a hit in a grid, u and v running over the whole of it.
    triangle_corners in_grid(float u, float v) const {
        const auto cells = static_cast<float>(task_.cells);
        const auto cell_of = [&](float t) { return std::fmin(std::floor(t), cells - 1); };
        const float x = (1 - u) * cells, y = v * cells, i = cell_of(x), j = cell_of(y), s = x - i, t = y - j;
        const auto side = static_cast<unsigned>(task_.cells) + 1;
        const unsigned corner = static_cast<unsigned>(j) * side + static_cast<unsigned>(i),
                       opposite = corner + side + 1;
        if (s > t) return {{corner, corner + 1, opposite}, {1 - s, s - t, t}};
        return {{corner, opposite, opposite - 1}, {1 - t, s, t - s}};
    }

    glm::vec3 normal_at(const RTCHit16& hit, int lane) const {
        const bool is_seabed = hit.geomID[lane] == 0;
        const workload::surface& s = is_seabed ? task_.seabed : task_.target;
        const float u = hit.u[lane], v = hit.v[lane];
        const triangle_corners at =
            is_seabed && is_grid() ? in_grid(u, v) : triangle_corners{s.triangles[hit.primID[lane]], {1 - u - v, u, v}};
        return at.weights.x * s.normals[at.index.x] + at.weights.y * s.normals[at.index.y] +
               at.weights.z * s.normals[at.index.z];
    }

    void trace(int x0, int y0, embree::query& query, std::span<std::uint8_t> out) const {
        const auto step = static_cast<float>(2 * task_.half_width / task_.altitude / task_.pixels);
        const float middle = 0.5f * static_cast<float>(task_.pixels);
        const auto altitude = static_cast<float>(task_.altitude);
        const glm::vec3 to_light = task_.to_light;

        alignas(64) int wanted[lanes];
        RTCRayHit16 primary;
        for (int i = 0; i < lanes; ++i) {
            wanted[i] = -1;
            primary.ray.org_x[i] = primary.ray.org_y[i] = 0;
            primary.ray.org_z[i] = altitude;
            // Not of unit length: the distance is then the altitude less the height.
            primary.ray.dir_x[i] = (static_cast<float>(x0 + i % block) + 0.5f - middle) * step;
            primary.ray.dir_y[i] = (middle - static_cast<float>(y0 + i / block) - 0.5f) * step;
            primary.ray.dir_z[i] = -1;
            primary.ray.tnear[i] = primary.ray.time[i] = 0;
            primary.ray.tfar[i] = std::numeric_limits<float>::infinity();
            primary.ray.mask[i] = ~0u;
            primary.ray.flags[i] = primary.ray.id[i] = 0;
            primary.hit.geomID[i] = primary.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        }
        query.intersect(scene_, wanted, primary);

        RTCRay16 shadow;
        float facing[lanes];
        bool any = false;
        for (int i = 0; i < lanes; ++i) {
            facing[i] = 0;
            wanted[i] = 0;
            if (primary.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
            const glm::vec3 n = normal_at(primary.hit, i);
            const float along = n.x * to_light.x + n.y * to_light.y + n.z * to_light.z;
            if (!(along > 0)) continue;
            facing[i] = along / std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
            wanted[i] = -1;
            any = true;
        }
        if (any) {
            for (int i = 0; i < lanes; ++i) {
                const float t = wanted[i] != 0 ? primary.ray.tfar[i] : 0;  // all must be finite
                shadow.org_x[i] = t * primary.ray.dir_x[i];
                shadow.org_y[i] = t * primary.ray.dir_y[i];
                shadow.org_z[i] = altitude - t;
                shadow.dir_x[i] = to_light.x;
                shadow.dir_y[i] = to_light.y;
                shadow.dir_z[i] = to_light.z;
                shadow.tnear[i] = shadow_start;
                shadow.time[i] = 0;
                shadow.tfar[i] = std::numeric_limits<float>::infinity();
                shadow.mask[i] = ~0u;
                shadow.flags[i] = shadow.id[i] = 0;
            }
            query.occlude(scene_, wanted, shadow);
        }
        for (int i = 0; i < lanes; ++i) {
            const bool is_lit = wanted[i] != 0 && shadow.tfar[i] >= 0;  // minus infinity: a hit
            const float value = workload::task::ambient + (is_lit ? facing[i] : 0.0f);
            const bool is_empty = primary.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID;
            out[static_cast<std::size_t>(y0 + i / block) * static_cast<std::size_t>(task_.pixels) +
                static_cast<std::size_t>(x0 + i % block)] =
                is_empty ? workload::task::background : static_cast<std::uint8_t>(std::fmin(value, 1.0f) * 255 + 0.5f);
        }
    }

    workload::task task_;
    embree_tree tree_;
    insonify::thread_pool pool_;
    RTCDevice device_;
    RTCScene scene_{};
};

embree_renderer::embree_renderer(const workload::task& task, embree_tree tree, int threads)
    : tracer_(std::make_unique<tracer>(task, tree, threads)) {}
embree_renderer::~embree_renderer() = default;
embree_renderer::embree_renderer(embree_renderer&&) noexcept = default;

void embree_renderer::render(std::span<std::uint8_t> out) {
    tracer_->render(out);
}

}  // namespace peers
