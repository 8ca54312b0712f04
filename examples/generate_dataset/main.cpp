// generate_dataset: thousands of labelled sonar images by one command. See --help.
#include <insonify/core/thread_pool.hpp>

#include <atomic>
#include <csignal>
#include <future>

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
    // While the disk takes an image, its thread draws the next.
    insonify::thread_pool pool(o.threads);
    examples::progress bar(plans.size());
    std::atomic<std::size_t> next = 0;
    const auto make_some = [&] {
        insonify::serial_executor alone;
        std::future<void> written;
        for (std::size_t i = next++; i < plans.size() && stop_signal == 0; i = next++) {
            auto files = folder.files_of(o, plans[i], generator::draw(o, plans[i], shared, alone));
            if (written.valid()) written.get();
            written = std::async(std::launch::async, [&bar, files = std::move(files)] {
                for (const generator::file& f : files) insonify::write_file(f.path, f.bytes);
                bar.finished_one();
            });
        }
        if (written.valid()) written.get();
    };
    pool.bulk(static_cast<std::size_t>(pool.threads()), [&](std::size_t) {
        try {
            make_some();
        } catch (...) {
            next = plans.size();  // nobody begins another
            throw;
        }
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
