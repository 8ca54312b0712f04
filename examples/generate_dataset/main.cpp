// generate_dataset: thousands of labelled sonar images by one command. See --help.
#include <insonify/core/thread_pool.hpp>

#include <atomic>
#include <csignal>

#if __has_include(<malloc.h>)
#include <malloc.h>
#endif

#include "../common/progress.hpp"
#include "folder.hpp"

namespace {

volatile std::sig_atomic_t stop_signal = 0;

void request_stop(int signal) {
    stop_signal = signal;
}

/// Lets the memory that one file is packed in serve the next, instead of going back to the system, which would have to
/// clear thousands of pages for every image.
void keep_freed_memory() {
#if defined(__GLIBC__)
    ::mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the most there is
    ::mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
}

/// What is left to make, in index order.
std::vector<generator::plan> unfinished(const generator::options& o, const generator::stock& shared,
                                        const generator::dataset_folder& folder) {
    std::vector<generator::plan> plans;
    for (std::size_t i = o.first; i < o.first + o.count; ++i) {
        generator::plan p = generator::plan_image(o, i, shared.references());
        if (!folder.has(p)) plans.push_back(std::move(p));
    }
    return plans;
}

}  // namespace

int main(int argc, char** argv) try {
    const generator::options o = generator::parse(argc, argv);
    const generator::stock shared(o);
    generator::dataset_folder folder(o);
    const std::vector<generator::plan> plans = unfinished(o, shared, folder);
    std::signal(SIGINT, request_stop);
    std::signal(SIGTERM, request_stop);

    // Noise and flat masks pack no worse as they are than filtered any of PNG's ways, which to try takes twice as long,
    // and no better for longer looking.
    stbi_write_force_png_filter = 0;
    stbi_write_png_compression_level = 1;
    keep_freed_memory();

    // Whole images run side by side, each by itself on one thread: encoding a PNG is as long as drawing it, and serial.
    insonify::thread_pool pool(o.threads);
    examples::progress bar(plans.size());
    pool.bulk(plans.size(), [&](std::size_t i) {
        if (stop_signal != 0) return;
        insonify::serial_executor alone;
        folder.add(o, plans[i], generator::draw(o, plans[i], shared, alone));
        bar.finished_one();
    });
    const std::size_t listed = folder.write_tables();

    std::printf("%s: %zu images, %zu of them new, %.2f images/s\n", o.out.c_str(), listed, bar.done(),
                static_cast<double>(bar.done()) / bar.elapsed());
    if (stop_signal != 0 && bar.done() < plans.size()) {
        std::fprintf(stderr, "Stopped; the same command goes on from here.\n");
        return 128 + stop_signal;
    }
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "generate_dataset: %s\n", error.what());
    return 1;
}
