// The shadow policies on imported meshes.
#include <insonify/all.hpp>
#include <insonify/core/thread_pool.hpp>

#include <algorithm>
#include <cstdio>
#include <functional>

#include "../../foreign_scenes.hpp"
#include "../../shadow_oracle.hpp"
#include "measure.hpp"

namespace {

namespace in = insonify;

constexpr double elevations[] = {6, 33};

/// A scene under one light, with the oracle's verdict on each pixel.
struct lit_scene {
    const in::scene* scene;
    in::overhead rig;
    in::image<shadow_oracle::judged_pixel> truth;
    in::image<std::uint8_t> dark;

    lit_scene(const in::scene& s, const shadow_oracle::oracle& oracle, double elevation, int pixels,
              in::thread_pool& pool)
        : scene(&s), rig(foreign_scenes::rig(23.7, elevation, pixels)) {
        truth = oracle.judge(rig, in::visible_triangles(s, rig, in::render_options<>{}, pool), pool);
        dark = in::map_pixels(truth, [](const shadow_oracle::judged_pixel& p) {
            return static_cast<std::uint8_t>(p.answer == shadow_oracle::verdict::dark);
        });
    }
};

/// A policy on a mesh, under both lights.
struct trial {
    report::mesh_configuration configuration;
    std::function<in::frame<>(const lit_scene&)> draw;
    cost::figures under[2]{};

    void run(const std::vector<lit_scene>& lights, bool is_first) {
        for (std::size_t i = 0; i < lights.size(); ++i) {
            in::frame<> drawn;
            under[i].run([&] { drawn = draw(lights[i]); });
            if (!is_first) continue;
            const auto found = shadow_oracle::compare(lights[i].truth, drawn.labels);
            const auto dark = in::map_pixels(drawn.labels.shadow, [](std::uint16_t by) {
                return static_cast<std::uint8_t>(by != in::labels::no_shadow);
            });
            configuration.wrong += 0.5e6 * found.share_with_beside();
            configuration.edge += 0.5 * in::accuracy::compare_masks(dark, lights[i].dark).mean_boundary_displacement();
        }
        configuration.ms = 0.5 * (under[0].ms + under[1].ms);
        configuration.mebibytes = std::max(under[0].mebibytes, under[1].mebibytes);
    }
};

template <class Shadow>
trial make_trial(const std::string& mesh, std::size_t triangles, const char* policy, const Shadow& shadow) {
    // All policies draw the same triangles in each pixel, so that their shadows alone differ.
    in::render_options<Shadow> how{.shadow = shadow};
    how.subpixel_bits = in::render_options<>{}.subpixel_bits;
    trial t{.configuration = {.mesh = mesh, .policy = policy, .triangles = triangles},
            .draw = [how](const lit_scene& s) { return in::render(*s.scene, s.rig, how); }};
    if constexpr (requires { shadow.texels_per_pixel; })
        t.configuration.texels = static_cast<double>(shadow.texels_per_pixel);
    return t;
}

void measure_rounding(int pixels, int runs, report::contents& into, const std::string& name, const in::scene& scene,
                      const shadow_oracle::oracle& oracle, in::thread_pool& pool) {
    const in::overhead rig = foreign_scenes::rig(23.7, elevations[1], pixels);
    const std::vector<int> bits{6, 8, 10, 12, 16};
    std::vector<std::string> names;
    for (const int b : bits)
        names.push_back(name + ", 1/" + std::to_string(1 << b) + " pixel" +
                        (b == in::render_options<>{}.subpixel_bits ? " (default)" : ""));
    cost::measure_knob(
        runs, into,
        {.name = "visibility: vertices rounded to",
         .oracle = "the triangle at each pixel's centre, rays in long double"},
        names,
        [&](std::size_t i) {
            in::render_options<> how;
            how.subpixel_bits = bits[i];
            return in::render(scene, rig, how);
        },
        [&](std::size_t i, const in::frame<>& f) {
            in::render_options<> how;
            how.subpixel_bits = bits[i];
            const auto truth = oracle.judge(rig, in::visible_triangles(scene, rig, how, pool), pool);
            const auto found = shadow_oracle::compare(truth, f.labels);
            const auto in_a_million = [&](std::int64_t count) {
                return svg::number(1e6 * static_cast<double>(count) / static_cast<double>(found.shown), 1);
            };
            return in_a_million(found.beside) + " ppm of the pixels show a neighbouring triangle, " +
                   in_a_million(found.wrong() + found.beside_wrong) + " ppm have a wrong shadow";
        });
}

}  // namespace

void measure_meshes(int pixels, int runs, report::contents& into) {
    in::thread_pool pool(2);
    const std::vector<std::string> chosen{"tilted sheet", "moebius strip",      "cow", "hall", "statue 72k",
                                          "fine grid",    "fine grid, shuffled"};
    for (const foreign_scenes::foreign_scene& item : foreign_scenes::all()) {
        const std::string& name = item.name;  // clang 14 captures no structured bindings
        const in::scene& scene = item.scene;
        if (std::find(chosen.begin(), chosen.end(), name) == chosen.end()) continue;
        std::fprintf(stderr, "%s\n", name.c_str());
        const shadow_oracle::oracle oracle(scene, foreign_scenes::rig(0, 45, 64));
        std::vector<lit_scene> lights;
        for (const double e : elevations) lights.emplace_back(scene, oracle, e, pixels, pool);
        std::vector<trial> trials;
        const auto add = [&](const char* policy, const auto& shadow) {
            trials.push_back(make_trial(name, oracle.triangles(), policy, shadow));
        };
        add("none", in::shadow::none{});
        for (const float texels : {1.0f, 2.0f, 4.0f}) {
            add("map", in::shadow::map{.texels_per_pixel = texels});
            add("pcf", in::shadow::pcf{.texels_per_pixel = texels});
        }
        add("exact", in::shadow::exact{});
        for (int run = 0; run < runs; ++run)
            for (trial& t : trials) t.run(lights, run == 0);
        for (const trial& t : trials) into.mesh_configurations.push_back(t.configuration);
        if (name == "statue 72k" || name == "fine grid, shuffled")
            measure_rounding(pixels, runs, into, name, scene, oracle, pool);
    }
}
