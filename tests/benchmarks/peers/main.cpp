// Draws the reference workload W, and others, with the library and its peers, interleaved frame by frame. See --help
// and docs/speed.md.
#include <insonify/accuracy/metrics.hpp>
#include <insonify/core/random.hpp>
#include <insonify/io/netpbm.hpp>
#include <insonify/shadow/map.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>

#include "insonify_builds.hpp"
#include "insonify_renderer.hpp"
#include "report.hpp"
#include <CLI/CLI.hpp>
#if defined(PEERS_EMBREE)
#include "embree_renderer.hpp"
#endif
#if defined(PEERS_LLVMPIPE)
#include "llvmpipe_renderer.hpp"
#endif

namespace {

namespace in = insonify;

using bytes = std::vector<std::uint8_t>;

const std::vector<std::string> every_renderer{"insonify",
                                              "insonify_no_grid",
                                              "insonify_shuffled",
                                              "insonify_no_shadows",
                                              "insonify_map",
                                              "insonify_native",
                                              "insonify_scalar",
                                              "embree_mesh_kept",
                                              "embree_mesh_rebuilt",
                                              "embree_grid_kept",
                                              "embree_grid_rebuilt",
                                              "llvmpipe"};

struct options {
    std::vector<std::string> workloads{"W"};
    std::vector<std::string> sizes{"S", "M", "L"};
    std::vector<std::string> only = every_renderer;
    int threads = 2, frames = 9;
    bool processor_time = false;
    std::string json, svg, dump;
};

options parse(int argc, char** argv) {
    options o;
    CLI::App app("Draws the reference workload by insonify and by its peers, in turn, and compares them.", "bench");
    app.add_option("--workloads", o.workloads,
                   "W, a target on ripples from 10 m; close, one from 1 m; mesh, a mesh of up to 4 million triangles "
                   "over rock (W)")
        ->delimiter(',')
        ->check(CLI::IsMember({"W", "close", "mesh"}));
    app.add_option("--sizes", o.sizes, "S,M,L: 256, 512, 1024 cells and 512, 1024, 2048 pixels a side (all)")
        ->delimiter(',')
        ->check(CLI::IsMember({"S", "M", "L"}));
    app.add_option("--only", o.only, "Of " + CLI::detail::join(every_renderer) + "; embree is all of its four (all)")
        ->delimiter(',');
    app.add_option("--threads", o.threads, "Threads of each renderer (2)")->check(CLI::Range(1, 256));
    app.add_option("--frames", o.frames, "Measured frames, after two to warm up (9)")->check(CLI::Range(1, 10000));
    app.add_flag("--processor-time", o.processor_time,
                 "Measures the processor time of all threads together, for machines with other load");
    app.add_option("--json", o.json, "File for the figures");
    app.add_option("--svg", o.svg, "File for a bar chart");
    app.add_option("--dump", o.dump, "Folder for the pictures, as PGM");
    try {
        app.parse(argc, argv);
        for (const std::string& name : o.only)
            if (name != "embree" &&
                std::find(every_renderer.begin(), every_renderer.end(), name) == every_renderer.end())
                throw CLI::ValidationError("--only", "'" + name + "' is not a renderer");
    } catch (const CLI::ParseError& error) {
        std::exit(app.exit(error) == 0 ? 0 : 2);
    }
    return o;
}

/// A renderer that is measured.
struct runner {
    std::string name;
    std::function<void(std::span<std::uint8_t>)> render;
    bytes picture;
    std::vector<double> times{};  // ms

    void run(bool is_measured, bool processor_time) {
        const auto start = std::chrono::steady_clock::now();
        const std::clock_t processor_start = std::clock();
        render(picture);
        const std::chrono::duration<double, std::milli> passed = std::chrono::steady_clock::now() - start;
        const double computed = 1e3 * static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC;
        if (is_measured) times.push_back(processor_time ? computed : passed.count());
    }
};

/// The requested renderers that can run; reports those that cannot.
std::vector<runner> make_runners(const workload::scene& scene, const options& o) {
    const auto pixels = static_cast<std::size_t>(scene.size.pixels);
    const auto is_wanted = [&](const std::string& name) {
        const auto named = [&](const std::string& n) {
            return std::find(o.only.begin(), o.only.end(), n) != o.only.end();
        };
        return named(name) || (named("embree") && name.starts_with("embree_"));
    };
    std::vector<runner> runners;
    // `make` returns a renderer, or throws.
    const auto add = [&](const std::string& name, const auto& make) {
        if (!is_wanted(name)) return;
        try {
            auto renderer = make();
            runners.push_back(
                {name, [renderer](std::span<std::uint8_t> out) { renderer->render(out); }, bytes(pixels * pixels)});
        } catch (const std::exception& reason) {
            std::fprintf(stderr, "%s is skipped: %s\n", name.c_str(), reason.what());
        }
    };
    [[maybe_unused]] const auto add_build = [&](const std::string& name, const auto& build) {
        if (is_wanted(name))
            runners.push_back({name, build(scene.size.name, scene.setting.name, o.threads), bytes(pixels * pixels)});
    };
    enum class order { grid, nearly, shuffled };
    const auto own = [&]<class Shadow>(const Shadow&, order triangles = order::grid) {
        return [&, triangles] {
            workload::scene given = scene;
            // The same surface in orders that are not a grid's: two triangles exchanged, or all shuffled.
            auto& all = given.seabed.triangles;
            in::random_sequence random(1);
            for (std::size_t left = triangles == order::shuffled ? all.size() : 0; left > 1; --left)
                std::swap(all[left - 1], all[random.below(static_cast<std::uint32_t>(left))]);
            if (triangles == order::nearly) std::swap(all[0], all[1]);
            return std::make_shared<peers::insonify_renderer<Shadow>>(std::move(given), o.threads);
        };
    };
    add("insonify", own(in::shadow::exact{}));
    add("insonify_no_grid", own(in::shadow::exact{}, order::nearly));
    add("insonify_shuffled", own(in::shadow::exact{}, order::shuffled));
    add("insonify_no_shadows", own(in::shadow::none{}));
    add("insonify_map", own(in::shadow::map{}));
#if defined(PEERS_BUILDS)
    add_build("insonify_native", peers::insonify_native);
    add_build("insonify_scalar", peers::insonify_scalar);
#endif
#if defined(PEERS_EMBREE)
    const auto embree = [&](peers::embree_tree tree) {
        return [&, tree] { return std::make_shared<peers::embree_renderer>(scene.task(), tree, o.threads); };
    };
    add("embree_mesh_kept", embree(peers::embree_tree::mesh_kept));
    add("embree_mesh_rebuilt", embree(peers::embree_tree::mesh_rebuilt));
    add("embree_grid_kept", embree(peers::embree_tree::grid_kept));
    add("embree_grid_rebuilt", embree(peers::embree_tree::grid_rebuilt));
#endif
#if defined(PEERS_LLVMPIPE)
    add("llvmpipe", [&] { return std::make_shared<peers::llvmpipe_renderer>(scene.task(), o.threads); });
#endif
    return runners;
}

/// The picture by one primary and one shadow ray per pixel; empty without Embree.
bytes exact_picture([[maybe_unused]] const workload::scene& scene, [[maybe_unused]] int threads) {
#if defined(PEERS_EMBREE)
    const auto pixels = static_cast<std::size_t>(scene.size.pixels);
    bytes picture(pixels * pixels);
    peers::embree_renderer(scene.task(), peers::embree_tree::exact, threads).render(picture);
    return picture;
#else
    return {};
#endif
}

report::row summary(const runner& r, const workload::scene& scene, const bytes& exact) {
    const int pixels = scene.size.pixels;
    std::vector<double> times = r.times;
    std::sort(times.begin(), times.end());
    report::row row{scene.setting.name, scene.size.name, r.name, times[times.size() / 2], times.front(), {}};
    if (!exact.empty()) {
        std::size_t off = 0;
        for (std::size_t i = 0; i < exact.size(); ++i) off += std::abs(int{r.picture[i]} - int{exact[i]}) > 8;
        const in::image_view<const std::uint8_t> result(r.picture.data(), pixels, pixels);
        const in::image_view<const std::uint8_t> truth(exact.data(), pixels, pixels);
        row.from_exact = {in::accuracy::compare_images(result, truth).psnr(255),
                          100.0 * static_cast<double>(off) / static_cast<double>(exact.size())};
    }
    return row;
}

void dump(const options& o, const workload::scene& scene, const std::string& name, const bytes& picture) {
    if (o.dump.empty() || picture.empty()) return;
    std::filesystem::create_directories(o.dump);
    const int pixels = scene.size.pixels;
    in::write_netpbm(o.dump + "/" + scene.setting.name + "_" + scene.size.name + "_" + name + ".pgm",
                     in::image_view<const std::uint8_t>(picture.data(), pixels, pixels));
}

void measure(const workload::scene& scene, const options& o, std::vector<report::row>& rows) {
    const bytes exact = exact_picture(scene, o.threads);
    dump(o, scene, "exact", exact);
    std::vector<runner> runners = make_runners(scene, o);
    for (int frame = -2; frame < o.frames; ++frame)
        for (runner& r : runners) r.run(frame >= 0, o.processor_time);
    for (const runner& r : runners) {
        dump(o, scene, r.name, r.picture);
        rows.push_back(summary(r, scene, exact));
    }
}

}  // namespace

int main(int argc, char** argv) try {
    const options o = parse(argc, argv);
#if !defined(PEERS_EMBREE)
    std::fprintf(stderr, "embree is skipped, and with it the exact picture: built without Embree\n");
#endif
#if !defined(PEERS_LLVMPIPE)
    std::fprintf(stderr, "llvmpipe is skipped: built without EGL and OpenGL ES\n");
#endif
    std::vector<report::row> rows;
    const auto contains = [](const std::vector<std::string>& list, const std::string& name) {
        return std::find(list.begin(), list.end(), name) != list.end();
    };
    for (const workload::setting& what : workload::settings)
        for (const workload::size& size : workload::sizes)
            if (contains(o.workloads, what.name) && contains(o.sizes, std::string(1, size.name)))
                measure(workload::scene(size, what), o, rows);
    if (rows.empty()) return 1;
    std::printf("threads %d; frames %d of each renderer, in turn; %s\n", o.threads, o.frames,
                o.processor_time ? "processor time of all threads" : "elapsed time");
    report::print_table(rows);
    if (!o.json.empty()) in::write_file(o.json, report::to_json(rows));
    if (!o.svg.empty()) in::write_file(o.svg, report::to_svg(rows));
} catch (const std::exception& error) {
    std::fprintf(stderr, "bench: %s\n", error.what());
    return 1;
}
