// Exact shadows beside Embree's robust rays: which pixels of whole pictures are lit.
//
// Embree's coordinates and ray origins are floats, so pixels may differ where a ray passes an edge within float
// rounding.
#include "../embree.hpp"

#include <cmath>
#include <iterator>
#include <limits>

#include "../catch.hpp"
#include "../shadow_scenes.hpp"

namespace in = insonify;
namespace scenes = shadow_scenes;

namespace {

class embree_scene {
  public:
    explicit embree_scene(const std::vector<scenes::triangle>& triangles)
        : triangles_(triangles), device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST | embree::filtered_by_queries);
        const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* const corners = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), 3 * triangles.size()));
        auto* const indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), triangles.size()));
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            corners[3 * i] = glm::vec3(triangles[i].a);
            corners[3 * i + 1] = glm::vec3(triangles[i].b);
            corners[3 * i + 2] = glm::vec3(triangles[i].c);
            for (unsigned k = 0; k < 3; ++k) indices[3 * i + k] = static_cast<unsigned>(3 * i) + k;
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
        REQUIRE(rtcGetDeviceError(device_) == RTC_ERROR_NONE);
    }
    ~embree_scene() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    embree_scene(const embree_scene&) = delete;
    embree_scene& operator=(const embree_scene&) = delete;

    scenes::difference compare(const in::labels& labels, const glm::dvec3& to_light) const {
        const int pixels = labels.shadow.width();
        outward_query query;
        scenes::difference d;
        for (int y = 0; y < pixels; ++y)
            for (int x = 0; x < pixels; ++x) {
                const glm::dvec3 along(2 * (x + 0.5) / pixels - 1, 1 - 2 * (y + 0.5) / pixels, -1);
                RTCRayHit first{};
                first.ray = ray({0, 0, 4}, along, 0);
                first.hit.geomID = first.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
                query.receiver_id = RTC_INVALID_GEOMETRY_ID;
                query.intersect(scene_, first);
                if (first.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
                const scenes::triangle& t = triangles_[first.hit.primID];
                const glm::dvec3 n = glm::cross(t.b - t.a, t.c - t.a);
                bool lit = glm::dot(n, to_light) * -glm::dot(n, along) > 0;
                if (lit) {
                    const glm::dvec3 eye(0, 0, 4);
                    const glm::dvec3 p = eye + glm::dot(n, t.a - eye) / glm::dot(n, along) * along;
                    RTCRay shadow = ray(p, to_light, 1e-6f);
                    query.receiver_id = first.hit.primID;
                    query.occlude(scene_, shadow);
                    lit = shadow.tfar >= 0;
                }
                d.add(labels.shadow(x, y) == in::labels::no_shadow, lit);
            }
        return d;
    }

  private:
    /// A ray that starts on a triangle does not hit it, however origins are rounded.
    struct outward_query : embree::query {
        outward_query() : query(false, &skip_self_hit) {}

        unsigned receiver_id = RTC_INVALID_GEOMETRY_ID;

        static void skip_self_hit(const RTCFilterFunctionNArguments* arguments) {
            if (RTCHitN_primID(arguments->hit, arguments->N, 0) ==
                static_cast<const outward_query*>(arguments->context)->receiver_id)
                arguments->valid[0] = 0;
        }
    };

    static RTCRay ray(const glm::dvec3& from, const glm::dvec3& along, float start) {
        RTCRay r{};
        r.org_x = static_cast<float>(from.x);
        r.org_y = static_cast<float>(from.y);
        r.org_z = static_cast<float>(from.z);
        r.dir_x = static_cast<float>(along.x);
        r.dir_y = static_cast<float>(along.y);
        r.dir_z = static_cast<float>(along.z);
        r.tnear = start;
        r.tfar = std::numeric_limits<float>::infinity();
        r.mask = ~0u;
        return r;
    }

    std::vector<scenes::triangle> triangles_;
    RTCDevice device_;
    RTCScene scene_;
};

}  // namespace

TEST_CASE("Exact shadows equal Embree's: three seabeds, four targets, an imported mesh, an open sheet") {
    constexpr int size = 320;
    constexpr long pictures = std::size(scenes::elevations) * std::size(scenes::azimuths);
    scenes::difference total;
    for (int kind = 0; kind < 3; ++kind) {
        const in::scene s = scenes::make(kind, 0.04);
        const embree_scene embree(scenes::triangles(s));
        scenes::difference all;
        for (const double elevation : scenes::elevations) {
            scenes::difference here;
            for (const double azimuth : scenes::azimuths) {
                const in::overhead rig = scenes::rig(azimuth, elevation, size);
                const auto frame = in::render(s, rig, in::render_options<in::shadow::exact>{});
                here += embree.compare(frame.labels, in::overhead_geometry(rig).light().to_light());
            }
            UNSCOPED_INFO(scenes::seabed_names[kind] << ", " << elevation << " degrees: " << here.wrong << " of "
                                                     << here.pixels << " pixels differ, IoU " << here.iou());
            CHECK(here.iou() >= 0.9999);
            all += here;
        }
        // The picture shows 8 m of 10 m of seabed, so every ray hits; 30 to 56 % of the pixels are dark.
        CHECK(all.pixels == pictures * size * size);
        CHECK(all.both > all.pixels / 5);
        CHECK(all.pixels - all.either > all.pixels / 5);
        CHECK(all.share() <= 1e-5);
        total += all;
    }
    WARN(total.wrong << " of " << total.pixels << " pixels differ");
}
