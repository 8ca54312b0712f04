// Measures each setting that trades accuracy for speed, in one run. See --help and docs/tradeoff.md.
#include <insonify/all.hpp>
#include <insonify/core/thread_pool.hpp>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <new>

#include "../../marching.hpp"
#include "measure.hpp"
#include "report.hpp"
#include <CLI/CLI.hpp>
#include <malloc.h>

namespace {

void* counted(void* memory) {
    if (memory == nullptr) throw std::bad_alloc();
    const std::size_t now = cost::allocated += malloc_usable_size(memory);
    for (std::size_t peak = cost::peak; now > peak && !cost::peak.compare_exchange_weak(peak, now);) {
    }
    return memory;
}

}  // namespace

// Counts all memory. Not inlined, because g++ would warn of a mismatched pair of operators.
[[gnu::noinline]] void* operator new(std::size_t size) {
    return counted(std::malloc(size));
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
    const auto unit = static_cast<std::size_t>(alignment);
    return counted(std::aligned_alloc(unit, (size + unit - 1) / unit * unit));
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
    if (memory != nullptr) cost::allocated -= malloc_usable_size(memory);
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    operator delete(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    operator delete(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    operator delete(memory);
}

namespace {

namespace in = insonify;
using namespace in::literals;

struct options {
    int pixels = 256, runs = 9;
    std::string out = "docs";
};

options parse(int argc, char** argv) {
    options o;
    CLI::App app("Measures each setting that trades accuracy for speed, and writes tradeoff.md and its charts.",
                 "tradeoff");
    app.add_option("--pixels", o.pixels, "Pixels a side of the pictures (256)")->check(CLI::Range(64, 2048));
    app.add_option("--runs", o.runs, "Runs of each measurement, interleaved; the minimum time counts (9)")
        ->check(CLI::Range(1, 1000));
    app.add_option("--out", o.out, "Folder of the output (docs)");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        std::exit(app.exit(error) == 0 ? 0 : 2);
    }
    return o;
}

const std::vector<std::pair<std::string, in::seabed::any>> seabeds{
    {"ripples", in::seabed::ripples{.wavelength = 0.6f, .steepness = 0.12f, .direction = 0.5f, .seed = 7}},
    {"mud", in::seabed::mud{.mound_height = 0.06f, .pock_depth = 0.06f, .seed = 7}},
    {"rock", in::seabed::rock{.relief = 0.3f, .outcrop = 3, .block = 0.8f, .seed = 7}}};

in::overhead rig_of(const options& o) {
    return {.altitude = 1.5f, .yaw = 0.3f, .size = {o.pixels, o.pixels}, .grazing = 6_deg, .light_azimuth = 0.2f};
}

/// Calls visit(name, policy) with each of the library's shadow policies.
template <class Visit>
void for_each_policy(const Visit& visit) {
    visit("none", in::shadow::none{});
    visit("map", in::shadow::map{});
    visit("pcf", in::shadow::pcf{});
    visit("exact", in::shadow::exact{});
}

in::image<std::uint8_t> dark_of(const in::labels& l) {
    return in::map_pixels(l.shadow,
                          [](std::uint16_t by) { return static_cast<std::uint8_t>(by != in::labels::no_shadow); });
}
/// The dark pixels of the bottom alone: on a target, facets turn dark one by one.
in::image<std::uint8_t> dark_bottom_of(const in::labels& l) {
    auto dark = dark_of(l);
    for (std::size_t i = 0; i < dark.size(); ++i)
        if (l.instance.pixels()[i] != in::labels::no_instance) dark.pixels()[i] = 0;
    return dark;
}
in::image<std::uint8_t> target_of(const in::labels& l) {
    return in::map_pixels(l.instance, [](std::uint16_t i) { return static_cast<std::uint8_t>(i != 0); });
}

/// A configuration to be run several times.
struct candidate {
    report::configuration configuration;
    std::function<in::frame<>()> draw;
    cost::figures cost{};
};

template <class Shadow>
candidate make_candidate(const in::scene& scene, const in::overhead& rig, const std::string& seabed,
                         const std::string& policy, const in::render_options<Shadow>& options) {
    candidate c{.configuration = {.seabed = seabed,
                                  .policy = policy,
                                  .cells = in::overhead_geometry(rig).ground_sampling() / options.cell},
                .draw = [&scene, rig, options] { return in::render(scene, rig, options); }};
    if constexpr (requires { options.shadow.texels_per_pixel; })
        c.configuration.texels = static_cast<double>(options.shadow.texels_per_pixel);
    return c;
}

void measure_pictures(const options& o, report::contents& into) {
    const in::overhead rig = rig_of(o);
    in::thread_pool pool(2);
    for (const auto& seabed : seabeds) {
        const std::string& name = seabed.first;
        const in::seabed::any& bottom = seabed.second;
        std::fprintf(stderr, "%s\n", name.c_str());
        in::scene scene;
        scene.seabed = bottom;
        const auto dark = marching::dark_pixels(bottom, rig, 4, pool);
        const double pixel = in::overhead_geometry(rig).ground_sampling();
        const auto truth = in::render(scene, rig, in::render_options<>{.cell = 0.25 * pixel}, pool);
        std::vector<candidate> candidates;
        for (const double cells : {0.0625, 0.125, 0.25, 0.5, 1.0, 2.0})
            for_each_policy([&](const char* policy, auto shadow) {
                const auto add = [&] {
                    in::render_options<decltype(shadow)> how{.shadow = shadow};
                    how.cell = pixel / cells;
                    candidates.push_back(make_candidate(scene, rig, name, policy, how));
                };
                if constexpr (requires { shadow.texels_per_pixel; }) {
                    for (const float texels : {0.5f, 1.0f, 2.0f, 4.0f, 8.0f}) {
                        shadow.texels_per_pixel = texels;
                        add();
                    }
                } else {
                    add();
                }
            });
        const auto add_named = [&](const char* title, const char* policy, const auto& how) {
            candidates.push_back(make_candidate(scene, rig, name, policy, how.options()));
            candidates.back().configuration.name = title;
        };
        add_named("fast", "exact", in::accuracy::fast(rig));
        add_named("balanced", "exact", in::accuracy::balanced(rig));
        add_named("exact", "exact", in::accuracy::exact(rig));
        for (candidate& c : candidates) c.draw();  // warms up
        for (int run = 0; run < o.runs; ++run)
            for (candidate& c : candidates) {
                in::frame<> drawn;
                c.cost.run([&] { drawn = c.draw(); });
                if (run > 0) continue;
                if (c.cost.mebibytes * 1048576 < sizeof(float) * static_cast<double>(drawn.image.size()))
                    throw std::logic_error("a frame that allocates less than its image: memory is not counted");
                c.configuration.edge =
                    in::accuracy::compare_masks(dark_of(drawn.labels), dark).mean_boundary_displacement();
                c.configuration.intensity = in::accuracy::compare_images(drawn.image, truth.image).rmse();
            }
        for (candidate& c : candidates) {
            c.configuration.ms = c.cost.ms;
            c.configuration.mebibytes = c.cost.mebibytes;
            into.configurations.push_back(c.configuration);
        }
        into.seabeds.push_back(name);
    }
    report::mark_front(into.configurations);
}

/// A bottom without relief, with a lying cylinder and a sphere.
template <class Model>
in::scene targets(const Model& modelled) {
    in::scene scene;
    scene.seabed = in::seabed::flat{.surface = {.rms = 0}};
    const in::pose lying{.position = {-0.6, 0.3, 0.15}, .yaw = 1.2f}, resting{.position = {0.5, -0.4, 0.2}};
    scene.add(modelled(in::cylinder{.radius = 0.15f, .length = 0.9f}, lying), lying, "cylinder");
    scene.add(modelled(in::sphere{.radius = 0.2f}, resting), resting, "sphere");
    return scene;
}

std::string off_by(const in::image<std::uint8_t>& result, const in::image<std::uint8_t>& truth) {
    return svg::number(in::accuracy::compare_masks(result, truth).mean_boundary_displacement(), 3) + " px";
}

void measure_targets(const options& o, report::contents& into) {
    const in::overhead rig = rig_of(o);
    const in::scene fine = targets([](auto shape, const in::pose&) {
        shape.segments = 1024;
        return shape;
    });
    in::render_options<> best{.cell = 8 * in::overhead_geometry(rig).ground_sampling()};
    best.subpixel_bits = 16;
    const auto truth = in::render(fine, rig, best);
    const auto both = [&](const in::frame<>& f) {
        return "outline " + off_by(target_of(f.labels), target_of(truth.labels)) + ", shadow " +
               off_by(dark_bottom_of(f.labels), dark_bottom_of(truth.labels));
    };

    std::vector<in::scene> scenes;
    std::vector<std::string> names;
    for (const double error : {4.0, 1.0, 0.25, 0.05}) {
        in::accuracy::settings<> how{.silhouette_error = error, .shadow_edge_error = error, .rig = rig};
        scenes.push_back(targets([&](const auto& shape, const in::pose& at) { return how.modelled(shape, at); }));
        std::size_t triangles = 0;
        for (const in::target& t : scenes.back().targets) triangles += t.shape->triangles.size();
        names.push_back("facets off by " + svg::number(error, 2) + " px: " + std::to_string(triangles) + " triangles");
    }
    cost::measure_knob(
        o.runs, into, {.name = "curved primitives", .oracle = "1024 segments"}, names,
        [&](std::size_t i) { return in::render(scenes[i], rig, best); },
        [&](std::size_t, const in::frame<>& f) { return both(f); });

    const std::vector<int> bits{4, 6, 8, 12, 16};
    std::vector<std::string> bit_names;
    for (const int b : bits) bit_names.push_back("1/" + std::to_string(1 << b) + " pixel");
    cost::measure_knob(
        o.runs, into, {.name = "coverage: vertices rounded to", .oracle = "1/65536 pixel"}, bit_names,
        [&](std::size_t i) {
            auto how = best;
            how.subpixel_bits = bits[i];
            return in::render(fine, rig, how);
        },
        [&](std::size_t, const in::frame<>& f) { return both(f); });
}

/// How far towards the light the seabed is searched for casters.
void measure_reach(const options& o, report::contents& into) {
    in::overhead rig = rig_of(o);
    rig.grazing = 2_deg;
    in::scene scene;
    scene.seabed = seabeds[2].second;
    in::render_options<> how{.reach = 32};
    const auto truth = in::render(scene, rig, how);
    const std::vector<float> reaches{0, 0.25f, 0.5f, 1, 2, 4, 8};
    std::vector<std::string> names;
    for (const float r : reaches) names.push_back("rock at 2 degrees, " + svg::number(static_cast<double>(r), 2));
    cost::measure_knob(
        o.runs, into, {.name = "reach, in lengths of the picture", .oracle = "32"}, names,
        [&](std::size_t i) {
            how.reach = reaches[i];
            return in::render(scene, rig, how);
        },
        [&](std::size_t, const in::frame<>& f) {
            return "shadow " + off_by(dark_of(f.labels), dark_of(truth.labels));
        });
}

/// Lists the rows of `exact` as a knob: the error of exact shadows that comes from meshing the seabed in cells.
void list_cells(report::contents& into) {
    for (const report::configuration& w : into.configurations)
        if (w.policy == "exact" && w.name.empty())
            into.knobs.push_back({.name = "cells of the seabed per pixel",
                                  .oracle = "rays marched over four vertices per pixel",
                                  .setting = w.seabed + ", " + report::per_pixel(w.cells),
                                  .error = "shadow " + svg::number(w.edge, 3) + " px",
                                  .ms = w.ms,
                                  .mebibytes = w.mebibytes});
}

void measure_geometry(const options& o, report::contents& into) {
    in::scene scene;
    scene.seabed = seabeds[0].second;
    const auto bins = o.pixels;
    const auto rig = rig_of(o);
    const float length = static_cast<float>(2 * in::overhead_geometry(rig).half_extent(0).x);
    cost::measure_knob(
        o.runs, into, {.name = "geometry", .oracle = "each is right for its kind of sonar picture"},
        {"parallel light, camera overhead", "ground range", "slant range, layover"},
        [&](std::size_t i) {
            if (i == 0) return in::render(scene, rig).image;
            const auto track = [&](auto sonar) {
                sonar.altitude = rig.altitude;
                sonar.ping_spacing = length / static_cast<float>(bins);
                sonar.pings = bins;
                sonar.range = length;
                sonar.bins = bins;
                return in::render(scene, sonar).image;
            };
            return i == 1 ? track(in::ground_range{}) : track(in::side_scan{});
        },
        [](std::size_t, const in::image<float>&) { return std::string(""); });
}

/// How densely recordings sample the seabed, and send rays.
void measure_recordings(const options& o, report::contents& into) {
    const in::side_scan rig{.altitude = 5, .pings = o.pixels / 4, .range = 40, .bins = 8 * o.pixels};
    const std::vector<double> cells{0.02, 0.04, 0.08, 0.16};
    for (const auto& [name, bottom] : {seabeds[0], seabeds[2]}) {
        in::scene scene;
        scene.seabed = bottom;
        const auto record = [&](double cell) { return in::render(scene, rig, in::record_options<>{.cell = cell}); };
        const auto amplitude_of = [](const in::frame<>& f) {
            return in::map_pixels(f.image, [](float v) { return in::numeric::square_root(v); });
        };
        const auto truth = record(0.005);
        const auto amplitude = amplitude_of(truth);
        const double scale = in::accuracy::compare_images(amplitude, in::image<float>(rig.bins, rig.pings)).rmse();
        std::vector<std::string> names;
        for (const double cell : cells) names.push_back(name + ", " + svg::number(100 * cell, 0) + " cm");
        cost::measure_knob(
            o.runs, into, {.name = "cell of recordings over 40 m, from 5 m above", .oracle = "cells of 5 mm"}, names,
            [&](std::size_t i) { return record(cells[i]); },
            [&](std::size_t, const in::frame<>& f) {
                std::size_t differing = 0;
                for (std::size_t i = 0; i < f.image.size(); ++i)
                    differing += f.labels.shadow.pixels()[i] != truth.labels.shadow.pixels()[i];
                const double labels = static_cast<double>(differing) / static_cast<double>(f.image.size());
                const double echoes = in::accuracy::compare_images(amplitude_of(f), amplitude).rmse() / scale;
                return "shadow label of " + svg::number(100 * labels, 1) + " % of the bins, amplitude " +
                       svg::number(100 * echoes, 1) + " % rms";
            });
    }
}

double variance_of(const in::image<float>& picture) {
    double mean = 0, square = 0;
    const auto n = static_cast<double>(picture.size());
    for (const float p : picture.pixels()) mean += static_cast<double>(p) / n;
    for (const float p : picture.pixels())
        square += (static_cast<double>(p) - mean) * (static_cast<double>(p) - mean) / n;
    return square / (mean * mean);
}

void measure_filters(const options& o, report::contents& into) {
    const in::image<float> level(o.pixels, o.pixels, 0.25f);
    const in::image<std::uint8_t> sand(o.pixels, o.pixels, std::uint8_t{0});
    const auto law = in::seabed_speckle{}.bottom[0];
    const double looks = law.looks, shape = static_cast<double>(law.texture);
    cost::measure_knob(
        o.runs, into, {.name = "speckle", .oracle = "variance over squared mean, closed form"},
        {"white, of variance 0.1", "K-distributed, its texture correlated"},
        [&](std::size_t i) {
            if (i == 0) return level | in::speckle{.variance = 0.1f, .seed = 3};
            return in::with_speckle(level, sand, in::seabed_speckle{.seed = 3}, in::ping_numbers{});
        },
        [&](std::size_t i, const in::image<float>& noisy) {
            const double expected = i == 0 ? 0.1 : (1 + 1 / shape) * (1 + 1 / looks) - 1;
            return svg::number(100 * (variance_of(noisy) / expected - 1), 2) + " %";
        });

    in::scene scene;
    scene.seabed = seabeds[0].second;
    const auto rig = rig_of(o);
    const auto picture = in::render(scene, rig).image;
    scene.seabed = seabeds[2].second;
    const auto reference = in::render(scene, rig).image;
    const auto exact = picture | in::match_histogram(reference);
    cost::measure_knob(
        o.runs, into, {.name = "histogram match", .oracle = "exact ranks"}, {"64 bins", "1024 bins", "exact ranks"},
        [&](std::size_t i) {
            if (i == 2) return picture | in::match_histogram(reference);
            return picture | in::match_binned(reference, i == 0 ? 64 : 1024);
        },
        [&](std::size_t, const in::image<float>& matched) {
            return svg::number(in::accuracy::compare_images(matched, exact).rmse(), 5) + " rms";
        });
}

void measure_depth(const options& o, report::contents& into) {
    const in::seabed::grid grid{.spacing = 0.01, .width = o.pixels, .height = o.pixels};
    const in::mesh bottom = in::seabed::tessellate(in::seabed::sample(seabeds[2].second, grid));
    const float scale = 2 / (0.01f * static_cast<float>(o.pixels));
    const auto vertex_shader = [=](const in::vertex& v) {
        return glm::vec4(v.position.x * scale - 1, v.position.y * scale - 1, 0.5f + 0.5f * v.position.z, 1.0f);
    };
    const auto draw = [&](bool quick) {
        in::image<float> depth(o.pixels, o.pixels, 0.0f);
        if (quick)
            in::draw(bottom, vertex_shader, in::depth_target{depth},
                     in::draw_options<in::depth_precision::quick>{.compare = in::depth_compare::greater});
        else
            in::draw(bottom, vertex_shader, in::depth_target{depth}, {.compare = in::depth_compare::greater});
        return depth;
    };
    const auto exact = draw(false);
    cost::measure_knob(
        o.runs, into, {.name = "interpolation of depth", .oracle = "`depth_precision::exact`"},
        {"float", "correctly rounded"}, [&](std::size_t i) { return draw(i == 0); },
        [&](std::size_t, const in::image<float>& depth) {
            return svg::number(in::accuracy::compare_images(depth, exact).largest / 0x1p-24, 1) + " x 2^-24 at most";
        });
}

}  // namespace

int main(int argc, char** argv) try {
    const options o = parse(argc, argv);
    report::contents found{.pixels = o.pixels, .grazing_degrees = 6};
    measure_pictures(o, found);
    list_cells(found);
    measure_meshes(o.pixels, o.runs, found);
    measure_targets(o, found);
    measure_reach(o, found);
    measure_geometry(o, found);
    measure_recordings(o, found);
    measure_filters(o, found);
    measure_depth(o, found);
    in::write_file(o.out + "/tradeoff.md", report::page(found));
    in::write_file(o.out + "/tradeoff.svg", report::trade_chart(found));
    in::write_file(o.out + "/tradeoff_saved.svg", report::savings_chart(found));
    for (const report::configuration& w : found.configurations)
        if (w.on_front || !w.name.empty()) std::fputs(report::row_of(w).c_str(), stdout);
} catch (const std::exception& error) {
    std::fprintf(stderr, "tradeoff: %s\n", error.what());
    return 1;
}
