// A scene by the library: its seabed and its target are two meshes of a scene, and `render` does the rest.
#pragma once

#include <insonify/core/context.hpp>
#include <insonify/core/quantize.hpp>
#include <insonify/core/thread_pool.hpp>
#include <insonify/sonar/overhead/render.hpp>

#include <span>
#include <utility>

#include "workload.hpp"

namespace peers::inline INSONIFY_FLAGS {

namespace in = insonify;

template <insonify::shadow::policy Shadow>
class insonify_renderer {
  public:
    insonify_renderer(workload::scene w, int threads) : pool_(threads) {
        scene_.seabed = in::seabed::none{};
        scene_.add(std::move(w.seabed), {}, "seabed", {.reflectivity = 1});
        scene_.add(std::move(w.target), {}, "target", {.reflectivity = 1});
        const auto radians = [](double degrees) { return static_cast<float>(in::numeric::to_radians(degrees)); };
        rig_ = {.altitude = static_cast<float>(w.setting.altitude),
                .field_of_view = radians(workload::field_of_view),
                .size = {w.size.pixels, w.size.pixels},
                .grazing = radians(workload::light_elevation),
                .light_azimuth = radians(workload::light_azimuth),
                .intensity = 1,
                .sky = 0,
                .ambient = workload::task::ambient};
    }

    void render(std::span<std::uint8_t> out) {
        const auto frame = in::render(scene_, rig_, options{}, context_);
        pool_.bulk(static_cast<std::size_t>(rig_.size.y), [&](std::size_t row) {
            const auto width = static_cast<std::size_t>(rig_.size.x);
            in::quantize_row(frame.image.row(static_cast<int>(row)), out.subspan(row * width, width));
        });
    }

  private:
    using options = in::render_options<Shadow, in::no_labels>;

    in::thread_pool pool_;
    in::context context_{pool_};
    in::scene scene_;
    in::overhead rig_;
};

}  // namespace peers::inline INSONIFY_FLAGS
