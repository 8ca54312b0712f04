// W by the library's public interface: one shadow map for all, and each object drawn with the shading below.
#pragma once

#include <insonify/core/thread_pool.hpp>
#include <insonify/raster/draw.hpp>
#include <insonify/shadow/lookup.hpp>

#include <algorithm>
#include <span>

#include "workload.hpp"

namespace peers {

namespace in = insonify;

class insonify_renderer {
  public:
    insonify_renderer(const workload::scene& scene, int threads)
        : scene_(scene),
          task_(scene.task()),
          pool_(threads),
          light_(
              {in::numeric::to_radians(workload::light_azimuth), in::numeric::to_radians(workload::light_elevation)}),
          depth_(task_.pixels, task_.pixels) {}

    void render(std::span<std::uint8_t> out) {
        const in::shadow::map_extent extent =
            in::shadow::merge(in::shadow::extent_of(scene_.seabed, {}, light_, pool_),
                              in::shadow::extent_of(scene_.cylinder, {}, light_, pool_));
        const double texel = 2 * task_.half_width / task_.pixels / 1.5;
        in::shadow::height_map map(light_, extent, texel);
        map.cast(scene_.seabed, {}, pool_);
        map.cast(scene_.cylinder, {}, pool_);

        std::fill(out.begin(), out.end(), workload::task::background);
        const in::image_view<std::uint8_t> picture(out.data(), task_.pixels, task_.pixels);
        draw(scene_.seabed, map, picture, in::depth_load::clear);
        draw(scene_.cylinder, map, picture, in::depth_load::keep);
    }

  private:
    struct surface_point {
        glm::vec3 position, normal;
    };

    void draw(const in::mesh& m, const in::shadow::height_map& map, in::image_view<std::uint8_t> picture,
              in::depth_load load) {
        const auto altitude = static_cast<float>(task_.altitude);
        const auto scale = static_cast<float>(task_.altitude / task_.half_width);
        const auto place = [=](const in::vertex& v) {
            const glm::vec3& p = v.position;
            return in::placed_vertex<surface_point>{{scale * p.x, scale * p.y, 1e-3f * altitude, altitude - p.z},
                                                    {p, v.normal}};
        };
        const auto shade = [&](const in::fragment<surface_point>& f) {
            const glm::vec3& n = f.varyings.normal;
            const float facing = in::numeric::dot(n, task_.to_light) / in::numeric::square_root(in::numeric::dot(n, n));
            const float value = workload::task::ambient + (facing > 0 ? facing * lit(m, map, f) : 0.0f);
            return static_cast<std::uint8_t>((std::min)(value, 1.0f) * 255 + 0.5f);
        };
        in::draw(m, place, shade, in::framebuffer<std::uint8_t>{picture, depth_},
                 {.cull = in::cull_mode::back, .keep = in::keep_depth::larger, .load = load}, pool_);
    }

    float lit(const in::mesh& m, const in::shadow::height_map& map, const in::fragment<surface_point>& f) const {
        const glm::uvec3& t = m.triangles[f.triangle];
        const glm::vec3& a = m.positions[t.x];
        const glm::vec3 facet = in::numeric::cross(m.positions[t.y] - a, m.positions[t.z] - a);
        const in::shadow::receiver at(light_, glm::dvec3(f.varyings.position), glm::dvec3(facet));
        return at.faces_light ? in::shadow::lit(map, at, in::shadow::pcf{}) : 0.0f;
    }

    const workload::scene& scene_;
    workload::task task_;
    in::thread_pool pool_;
    in::shadow::light_frame light_;
    in::image<float> depth_;
};

}  // namespace peers
