// Times of filters: filters [threads] [pixels] [runs] prints the best of `runs` (15) in milliseconds, for an image
// of `pixels` x `pixels`.
//
// Filters run in turn, so that other load affects all of them alike.
#include <insonify/all.hpp>
#include <insonify/core/thread_pool.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

namespace in = insonify;

namespace {

struct task {
    std::string name;
    std::function<void()> run;
    double best = 1e9;
};

void measure(std::vector<task>& tasks, int runs) {
    for (int run_number = 0; run_number < runs; ++run_number) {
        for (task& t : tasks) {
            const auto start = std::chrono::steady_clock::now();
            t.run();
            const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
            t.best = (std::min)(t.best, time.count());
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    const int threads = argc > 1 ? std::atoi(argv[1]) : 2;
    const int side = argc > 2 ? std::atoi(argv[2]) : 2048;
    in::thread_pool pool(threads);

    // Something like a recording: a slope, waves and grain.
    in::image<float> source(side, side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            source(x, y) = 0.15f + 0.3f * static_cast<float>(x) / static_cast<float>(side) +
                           0.2f * static_cast<float>((x + 3 * y) % 97) / 97.0f;
    source = apply(source, in::speckle{.seed = 99}, pool);
    const in::image<float> reference = apply(source, in::rayleigh{.seed = 98}, pool);
    const auto source_8 = apply(source, in::to_uint8, pool);
    const auto source_16 = apply(source, in::to_uint16, pool);

    in::image<float> work(side, side), between(side, side);
    in::image<std::uint8_t> work_8(side, side);
    in::image<std::uint16_t> work_16(side, side);
    std::vector<task> tasks;
    const auto add = [&](const char* name, const auto& from, auto& to, const auto& filter) {
        tasks.push_back({name, [&from, &to, &pool, filter] { in::apply_into(from.view(), to.view(), filter, pool); }});
    };
    const auto invert = [](float v) { return 1 - v; };
    const auto halve = [](float v) { return 0.5f * v; };

    add("copy", source, work, in::filter_chain<>{});
    add("gaussian", source, work, in::gaussian{});
    add("gaussian, 8 bits", source_8, work_8, in::gaussian{});
    add("speckle", source, work, in::speckle{});
    add("gaussian speckle", source, work, in::gaussian_speckle{});
    add("salt and pepper", source, work, in::salt_and_pepper{});
    add("rayleigh", source, work, in::rayleigh{});
    add("4 looks", source, work, in::gamma_speckle{});
    add("K", source, work, in::k_speckle{});
    add("rician", source, work, in::rician{});
    add("poisson", source, work, in::poisson{});
    add("rayleigh, correlated", source, work, in::rayleigh{.correlation = {2, 2}});
    add("match, 64 bins", source, work, in::match_binned(reference));
    add("match, 64 bins, 8 bits", source_8, work_8, in::match_binned(reference));
    add("match, ranks, 8 bits", source_8, work_8, in::match_histogram(reference));
    add("match, ranks, 16 bits", source_16, work_16, in::match_histogram(reference));
    add("match, ranks, floats", source, work, in::match_histogram(reference));
    add("equalize", source, work, in::equalize{});
    add("8 bits", source, work_8, in::to_uint8);
    add("gaussian + speckle", source, work, in::gaussian{} | in::speckle{});
    add("chain to 8 bits", source, work_8, in::gaussian{} | in::speckle{} | in::match_binned(reference) | in::to_uint8);
    add("four functions, fused", source, work, in::filter_chain<>{} | invert | halve | invert | halve);
    tasks.push_back({"four functions, one by one", [&] {
                         in::apply_into(source.view(), between.view(), invert, pool);
                         in::apply_into(between.view(), work.view(), halve, pool);
                         in::apply_into(work.view(), between.view(), invert, pool);
                         in::apply_into(between.view(), work.view(), halve, pool);
                     }});
    measure(tasks, argc > 3 ? std::atoi(argv[3]) : 15);

    std::printf("insonify, %d x %d pixels, %d threads\n", side, side, pool.threads());
    for (const task& t : tasks) std::printf("  %-28s %8.3f ms\n", t.name.c_str(), t.best);
}
