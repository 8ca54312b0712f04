// ping_simulator: chips of a simulated side-scan sonar. See --help.
//
// Makes a test set for classifiers trained on this library's pictures, so it uses the library only to write files: rays
// intersect solids in closed form, the bottom is a function, and a picture is the coherent sum of some 100 000 points.
//
// Based on: D. A. Abraham, A. P. Lyons. Novel Physical Interpretations of K-Distributed Reverberation. IEEE Journal of
// Oceanic Engineering 27, 2002 (why a sum of points); P. Blondel. The Handbook of Sidescan Sonar. 2009.
#include <insonify/io/manifest.hpp>
#include <insonify/io/png.hpp>

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <mutex>
#include <set>
#include <system_error>
#include <thread>

#include "../common/option_values.hpp"
#include "../common/refusal.hpp"
#include "chip.hpp"
#include <CLI/CLI.hpp>

namespace {

struct options {
    std::string out;
    std::vector<std::size_t> counts{308, 88, 66};
    std::vector<std::string> seabeds{"flat", "ripples"};
    std::uint64_t seed = 1;
    double chip = 5;
    std::size_t pixels = 128;
    unsigned threads = 0;
};

options parse(int argc, char** argv) {
    options o;
    CLI::App app{
        "Computes chips of cylinders, cubes and spheres on the sea floor as a side-scan sonar records them: coherent "
        "sums\nover scatterers, ping by ping. Range increases to the right, the target lies a third from the left.",
        "ping_simulator"};
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    app.add_option("--out", o.out, "Folder for images/<class>/<index>.png and manifest.csv; created if missing")
        ->required()
        ->check(examples::folder_to_fill());
    app.add_option("--counts", o.counts, "Number of cylinders, cubes and spheres (308,88,66)")
        ->delimiter(',')
        ->check(examples::whole_number(0, 1'000'000));
    app.add_option("--seabeds", o.seabeds, "Of flat,ripples; taken in turn (flat,ripples)")
        ->delimiter(',')
        ->expected(1, 16)
        ->check(CLI::IsMember({"flat", "ripples"}));
    app.add_option("--seed", o.seed, "Seed of all random values (1)")->check(examples::whole_number(0, INT64_MAX));
    app.add_option("--chip", o.chip, "Metres a side (5)")->check(examples::number(0.5, 100));
    app.add_option("--pixels", o.pixels, "Pixels a side (128)")->check(examples::whole_number(16, 4096));
    app.add_option("--threads", o.threads,
                   "Number of threads, 0 for one per hardware thread (0); does not change the output")
        ->check(examples::whole_number(0, 1024));
    try {
        app.parse(argc, argv);
        if (o.counts.size() != pings::class_names.size())
            throw CLI::ValidationError(
                "--counts", std::to_string(o.counts.size()) + " numbers; there are three classes, as in 308,88,66");
        if (o.chip / static_cast<double>(o.pixels) > 0.4)
            throw CLI::ValidationError("--chip", "a pixel is longer than 0.4 m, the smallest target");
    } catch (const CLI::ParseError& error) {
        examples::exit_after(app, error);
    }
    return o;
}

/// Calls `fn(i)` for i below `count` on several threads; the first exception is rethrown.
template <class Fn>
void on_threads(unsigned threads, std::size_t count, const Fn& fn) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex failing;
    const auto work = [&] {
        for (std::size_t i = next++; i < count; i = next++) try {
                fn(i);
            } catch (...) {
                const std::lock_guard lock(failing);
                if (!failure) failure = std::current_exception();
                next = count;
            }
    };
    {
        std::vector<std::thread> others;
        try {
            for (unsigned t = 1; t < threads; ++t) others.emplace_back(work);
        } catch (const std::system_error&) {  // no more threads: those that started do the work
        }
        work();
        for (std::thread& t : others) t.join();
    }
    if (failure) std::rethrow_exception(failure);
}

/// Removes the chips of an earlier set in the folder, which may have had more.
void remove_other_chips(const std::string& out, const std::set<std::string>& kept) {
    for (const char* const name : pings::class_names) {
        const std::string folder = std::string("images/") + name + "/";
        std::vector<std::string> others;
        for (const auto& entry : std::filesystem::directory_iterator(out + "/" + folder)) {
            const std::string file = entry.path().filename().string();
            const bool is_chip =
                file.size() >= 10 && file.find_first_not_of("0123456789") == file.size() - 4 && file.ends_with(".png");
            if (is_chip && !kept.contains(folder + file)) others.push_back(folder + file);
        }
        for (const std::string& other : others) std::filesystem::remove(out + "/" + other);
    }
}

}  // namespace

int main(int argc, char** argv) try {
    const options o = parse(argc, argv);
    std::vector<std::size_t> kinds;
    for (std::size_t kind = 0; kind < o.counts.size(); ++kind) {
        kinds.insert(kinds.end(), o.counts[kind], kind);
        std::filesystem::create_directories(o.out + "/images/" + pings::class_names[kind]);
    }
    const auto scene_at = [&](std::size_t i) {
        return pings::make_scene(o.seed, i, kinds[i], o.seabeds[i % o.seabeds.size()], o.chip);
    };
    const auto file_of = [&](std::size_t i) {
        const std::string digits = std::to_string(i);
        return std::string("images/") + pings::class_names[kinds[i]] + "/" +
               std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits + ".png";
    };
    std::filesystem::remove(o.out + "/manifest.csv");  // the new one is written last
    std::set<std::string> files;
    for (std::size_t i = 0; i < kinds.size(); ++i) files.insert(file_of(i));
    remove_other_chips(o.out, files);
    const unsigned threads = o.threads > 0 ? o.threads : std::max(1u, std::thread::hardware_concurrency());
    on_threads(threads, kinds.size(), [&](std::size_t i) {
        pings::scene s = scene_at(i);
        const pings::chip c = pings::draw_chip(s, o.chip, o.pixels);
        const auto side = static_cast<int>(c.pixels);
        insonify::write_png(o.out + "/" + file_of(i),
                            insonify::image_view<const std::uint8_t>(c.gray.data(), side, side));
    });

    insonify::csv_table manifest{"file",        "class",        "seabed",   "altitude_m", "ground_range_m", "along_m",
                                 "left_edge_m", "size_m",       "length_m", "height_m",   "yaw_deg",        "burial",
                                 "beam_deg",    "resolution_m", "white",    "gamma"};
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        const pings::scene s = scene_at(i);
        manifest.add(file_of(i), s.class_name, s.seabed, s.rig.altitude, s.ground_range, s.along, s.left_edge, s.size,
                     s.length, s.target_body().centre().z, glm::degrees(s.yaw), s.burial, glm::degrees(s.rig.beam),
                     s.rig.resolution, s.rig.white, s.rig.gamma);
    }
    manifest.write(o.out + "/manifest.csv");
    std::printf("%s: %zu chips\n", o.out.c_str(), kinds.size());
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "ping_simulator: %s\n", error.what());
    return 1;
}
