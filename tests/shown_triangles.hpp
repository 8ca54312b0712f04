// Which triangle of which target a picture shows at each pixel: render()'s own visibility, replayed. The only place
// that depends on how render() draws.
#pragma once

#include <insonify/insonify.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace shadow_oracle {

/// Visibility buffer of a scene without a library seabed.
struct shown_triangles {
    static constexpr std::uint32_t none = 0xFFFFFFFFu;
    insonify::image<std::uint16_t> instance;  ///< 1 for the first target; 0 where nothing is shown
    insonify::image<std::uint32_t> triangle;  ///< of that target; `none` where nothing is shown
};

/// @param s        its seabed is seabed::none
/// @param options  those of the picture: sub-pixel bits, tile and instruction set are taken from it
template <class Options, insonify::executor_argument E = insonify::serial_executor>
shown_triangles shown_by(const insonify::scene& s, const insonify::overhead& rig, const Options& options, E&& ex = {}) {
    namespace in = insonify;
    using triangles = std::uint32_t;
    const in::overhead_geometry view(rig);
    shown_triangles shown{in::image<std::uint16_t>(rig.size.x, rig.size.y, 0),
                          in::image<triangles>(rig.size.x, rig.size.y, shown_triangles::none)};
    in::image<float> depth(rig.size.x, rig.size.y);
    in::depth_load load = in::depth_load::clear;
    std::uint16_t instance = 0;
    for (const in::target& t : s.targets) {
        const in::detail::placed_mesh placed(t.shape, in::bounds(t.shape, ex), view.rig_from(in::to_world(t.placement)),
                                             t.is_solid);
        in::image<triangles> won(rig.size.x, rig.size.y, shown_triangles::none);
        in::detail::draw_names(t.shape, in::detail::surface_placement(view, placed), depth, won,
                               {.cull = placed.hidden(),
                                .keep = in::keep_depth::larger,
                                .load = load,
                                .subpixel_bits = options.subpixel_bits,
                                .tile = options.tile,
                                .level = options.level},
                               ex);
        load = in::depth_load::keep;
        ++instance;
        for (std::size_t i = 0; i < won.size(); ++i) {
            if (won.pixels()[i] == shown_triangles::none) continue;
            shown.instance.pixels()[i] = instance;
            shown.triangle.pixels()[i] = won.pixels()[i];
        }
    }
    return shown;
}

}  // namespace shadow_oracle
