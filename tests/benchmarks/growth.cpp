// How the work of a frame grows: growth [sizes] draws the reference workload in S, M, L and twice L, on one thread and
// on two, and prints a line for each: medians, cost per triangle and pixel, and peak memory.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "peers/insonify_renderer.hpp"
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

struct job {
    const char* name;
    workload::size size;
};
constexpr job jobs[] = {
    {"S", workload::sizes[0]}, {"M", workload::sizes[1]}, {"L", workload::sizes[2]}, {"2L", {'2', 2048, 4096}}};
constexpr int frames = 7;

double megabytes_in_use() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

double median_ms(const workload::scene& scene, int threads, std::vector<std::uint8_t>& out) {
    peers::insonify_renderer<insonify::shadow::exact> renderer(scene, threads);
    std::vector<double> times;
    for (int frame = -1; frame < frames; ++frame) {
        const auto start = std::chrono::steady_clock::now();
        renderer.render(out);
        const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
        if (frame >= 0) times.push_back(time.count());
    }
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
}

/// Size of the caller's buffers.
double megabytes(const workload::scene& scene) {
    const auto bytes = [](const insonify::mesh& m) {
        return m.positions.size() * sizeof m.positions[0] + m.normals.size() * sizeof m.normals[0] +
               m.triangles.size() * sizeof m.triangles[0];
    };
    return static_cast<double>(bytes(scene.seabed) + bytes(scene.target)) / (1024 * 1024);
}

void measure_times(const job& j) {
    const workload::scene scene(j.size);
    const auto pixels = static_cast<std::size_t>(j.size.pixels) * static_cast<std::size_t>(j.size.pixels);
    std::vector<std::uint8_t> out(pixels);
    const double one = median_ms(scene, 1, out), two = median_ms(scene, 2, out);
    const std::size_t triangles = scene.seabed.triangles.size() + scene.target.triangles.size();
    std::printf("%-4s %10zu %10zu %10.1f %10.1f %8.2f x %12.1f", j.name, triangles, pixels, one, two, one / two,
                1e6 * one / static_cast<double>(triangles + pixels));
}

void measure_memory(const job& j) {
    workload::scene scene(j.size);
    const double given = megabytes(scene);
    std::vector<std::uint8_t> out(static_cast<std::size_t>(j.size.pixels) * static_cast<std::size_t>(j.size.pixels));
    peers::insonify_renderer<insonify::shadow::exact>(std::move(scene), 2).render(out);
    std::printf(" %10.0f %10.0f\n", megabytes_in_use(), given);
}

/// Runs in a child process, because peak memory is counted by process.
template <class Work>
void apart(const Work& work) {
    std::fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        work();
        std::fflush(stdout);
        _exit(0);
    }
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) < 0 || status != 0) std::printf(" failed\n");
}

}  // namespace

int main(int argc, char** argv) {
    std::printf("%-4s %10s %10s %10s %10s %10s %12s %10s %10s\n", "size", "triangles", "pixels", "1 thr. ms",
                "2 thr. ms", "1 to 2", "ns per both", "peak MB", "given MB");
    for (const job& j : jobs) {
        if (argc > 1 &&
            std::none_of(argv + 1, argv + argc, [&](const char* name) { return j.name == std::string(name); }))
            continue;
        apart([&] { measure_times(j); });
        apart([&] { measure_memory(j); });
    }
}
