// Times of seabeds: seabeds [threads] prints the minimum of 25 runs, in milliseconds, for 1024 x 1024 samples over
// 35 m with and without their normals, and for one of 65 x 65 on one thread, the size of a small scene.
#include <insonify/all.hpp>
#include <insonify/core/thread_pool.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

namespace in = insonify;
namespace sb = insonify::seabed;

namespace {

template <class Fn>
double best_ms(const Fn& work) {
    double best = 1e9;
    for (int i = 0; i < 25; ++i) {
        const auto start = std::chrono::steady_clock::now();
        work();
        const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
        best = (std::min)(best, taken.count());
    }
    return best;
}

/// Ripples as a user's model: forwards to the library's.
struct own_ripples {
    static constexpr sb::type_properties kind{sb::user_type(0), "own ripples", 0.5f, {}};
    sb::any_sampler prepare() const { return sb::ripples{}.prepare(); }
};

}  // namespace

int main(int argc, char** argv) {
    in::thread_pool pool(argc > 1 ? std::atoi(argv[1]) : 2);
    const sb::grid large{.origin = {-17, -17}, .spacing = 35.0 / 1024, .width = 1024, .height = 1024};
    const sb::grid compact{.origin = {-3, -3}, .spacing = 6.0 / 64, .width = 65, .height = 65};
    std::printf("%-10s %10s %14s %16s\n", "seabed", "samples", "with normals", "65 x 65, serial");
    const auto time = [&](const char* name, const sb::any& seabed) {
        std::printf("%-10s %10.2f %14.2f %16.3f\n", name, best_ms([&] { sb::sample(seabed, large, pool); }),
                    best_ms([&] { sb::normals(sb::sample(seabed, large, pool), pool); }),
                    best_ms([&] { sb::sample(seabed, compact); }));
    };
    time("flat", sb::flat{});
    time("ripples", sb::ripples{});
    time("own", own_ripples{});
    time("mud", sb::mud{});
    time("rock", sb::rock{});
    time("blend", sb::blend{});
}
