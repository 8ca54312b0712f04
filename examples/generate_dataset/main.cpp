// generate_dataset: thousands of labelled sonar images by one command. See --help.
#include <insonify/core/thread_pool.hpp>

#include <atomic>
#include <csignal>

#if __has_include(<malloc.h>)
#include <malloc.h>
#endif

#include "../common/progress.hpp"
#include "configuration.hpp"
#include "folder.hpp"
#include "lock.hpp"
#include "pictures.hpp"
#include "record.hpp"
#include "summary.hpp"
#include "tables.hpp"
#include "views.hpp"
#include "writer.hpp"

namespace {

std::atomic<int> stop_signal = 0;
static_assert(std::atomic<int>::is_always_lock_free);

void request_stop(int signal) {
    stop_signal = signal;
}

/// Keeps freed memory in the process: returned to the system, each image would fault thousands of pages in again.
void keep_freed_memory() {
#if defined(__GLIBC__)
    ::mallopt(M_MMAP_THRESHOLD, 32 << 20);  // glibc's maximum
    ::mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
}

/// Calls `fn(next)` once per thread. `next()` takes the next index of the range, and returns `work.last` at the end or
/// after a signal. The first exception stops all threads.
void for_each_index(insonify::thread_pool& pool, const generator::index_range& work, const auto& fn) {
    std::atomic<std::uint64_t> next = work.first;
    pool.bulk(static_cast<std::size_t>(pool.threads()), [&](std::size_t) {
        try {
            fn([&] {
                const std::uint64_t i = stop_signal == 0 ? next++ : work.last;
                return i < work.last ? i : work.last;
            });
        } catch (...) {
            next = work.last;
            throw;
        }
    });
}

/// Checks each file of the set without changing any.
int verify(const generator::options& o, const generator::shared_inputs& shared, insonify::thread_pool& pool) {
    const std::filesystem::path root = generator::folder_path(o.out);
    const generator::json before = generator::pinned(root, "config.json");
    if (before.is_null()) throw insonify::io_error(o.out + ": --verify: holds no data set");
    generator::check_pinned(root, before, generator::configuration_of(o, shared.inputs()));
    const generator::index_range work = generator::range_of(o.first, o.count, o.shard);
    examples::progress bar(work.size());
    std::mutex mutex;
    std::uint64_t faults = 0;
    const auto report = [&](const std::string& fault) {
        const std::lock_guard lock(mutex);
        if (++faults <= 100) std::fprintf(stderr, "%s\n", fault.c_str());
    };
    for_each_index(pool, work, [&](const auto& next) {
        for (std::uint64_t i = next(); i < work.last; i = next()) {
            if (const auto fault =
                    generator::fault_of(root, generator::image_id(o, i), before, generator::depth::pixels))
                report(*fault);
            bar.finished_one();
        }
    });
    if (!o.shard.given)
        for (const std::string& fault : generator::table_faults(root)) report(fault);
    if (stop_signal != 0) return 128 + stop_signal;
    std::printf("%s: %llu images checked, %llu faults\n", o.out.c_str(), static_cast<unsigned long long>(work.size()),
                static_cast<unsigned long long>(faults));
    if (faults > 0) std::fprintf(stderr, "The same command without --verify repairs them.\n");
    return faults > 0 ? 1 : 0;
}

/// Prints what the run will make. Of fewer than 256 images it estimates time and bytes only with --dry-run, since
/// estimating draws some.
void describe(const generator::options& o, const generator::shared_inputs& shared, int threads) {
    const generator::index_range work = generator::range_of(o.first, o.count, o.shard);
    generator::image_cost cost;
    if (o.dry_run || work.size() >= 256) cost = generator::measured_cost(o, work, shared);
    std::fputs(generator::summary_of(o, work, cost, threads).c_str(), o.dry_run ? stdout : stderr);
}

/// Whether the set is merged already and holds this shard's images: a job may be queued again after the merge.
bool is_joined(const generator::options& o, const std::filesystem::path& root, const generator::json& config) {
    if (std::filesystem::exists(root / "shards.json") || !std::filesystem::exists(root / "manifest.csv")) return false;
    const generator::index_range work = generator::range_of(o.first, o.count, o.shard);
    for (std::uint64_t i = work.first; i < work.last; ++i)
        if (generator::fault_of(root, generator::image_id(o, i), config, generator::depth::sizes)) return false;
    return true;
}

int generate(const generator::options& o, const generator::shared_inputs& shared, insonify::thread_pool& pool) {
    const std::filesystem::path root = generator::open_folder(o.out);
    const generator::folder_lock lock(root, o.shard.given ? static_cast<std::int64_t>(o.shard.number) : -1);
    if (!lock.without().empty())
        std::fprintf(stderr, "%s: no file locks here (%s); concurrent runs may make the same images twice\n",
                     o.out.c_str(), lock.without().c_str());
    generator::staging into(root, o.shard.given ? "shard" + std::to_string(o.shard.number) : "all");
    const generator::json config = generator::configuration_of(o, shared.inputs());
    generator::pin(root, "config.json", config, into);
    if (o.shard.given && is_joined(o, root, config)) {
        std::printf("%s: is joined and has the images of shard %llu\n", o.out.c_str(),
                    static_cast<unsigned long long>(o.shard.number));
        return 0;
    }
    if (o.shard.given)
        generator::pin(root, "shards.json", generator::shards_of(o), into);
    else if (std::filesystem::exists(root / "shards.json"))
        throw insonify::io_error(o.out + ": is made in shards: continue with --shard, or join them with tools/merge");

    // One image per thread: encoding a PNG is serial and takes as long as drawing it.
    const generator::index_range work = generator::range_of(o.first, o.count, o.shard);
    describe(o, shared, pool.threads());
    examples::progress bar(work.size());
    std::atomic<std::uint64_t> made = 0, repaired = 0;
    for_each_index(pool, work, [&](const auto& next) {
        generator::writer files(into);
        for (std::uint64_t i = next(); i < work.last; i = next()) {
            const std::uint64_t id = generator::image_id(o, i);
            if (const auto fault = generator::fault_of(root, id, config, generator::depth::checksums)) {
                files.add(generator::files_of(o, i, shared));
                ++made;
                if (std::filesystem::exists(root / generator::record_path(id)) && ++repaired <= 100)
                    std::fprintf(stderr, "%s; made again\n", fault->c_str());
            }
            bar.finished_one();
        }
        files.finish();
    });

    const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
    if (bar.done() > 0) {  // else stopped before the first image: there may be nothing to list
        if (o.shard.given)
            std::printf("%s, shard %llu of %llu: %llu images", o.out.c_str(), number(o.shard.number),
                        number(o.shard.of), number(bar.done()));
        else
            std::printf("%s: %llu images", o.out.c_str(), number(generator::write_tables(root, o.preview, into)));
        std::printf(", %llu of them new, %.2f images/s\n", number(made), static_cast<double>(made) / bar.elapsed());
        if (!o.shard.given) std::fputs(generator::where_to_look(o).c_str(), stdout);
    }
    if (stop_signal != 0 && bar.done() < work.size()) {
        std::fprintf(stderr, "Stopped; the same command continues from here.\n");
        return 128 + stop_signal;
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) try {
    const generator::options o = generator::parse(argc, argv);
    const generator::shared_inputs shared(o);
    generator::check_plan(o, shared);
    std::signal(SIGINT, request_stop);
    std::signal(SIGTERM, request_stop);
    generator::set_png_compression();
    keep_freed_memory();
    insonify::thread_pool pool(o.threads);
    if (pool.threads() < o.threads)
        std::fprintf(stderr, "--threads %d: the system started only %d\n", o.threads, pool.threads());
    if (o.dry_run) return describe(o, shared, pool.threads()), 0;
    return o.verify ? verify(o, shared, pool) : generate(o, shared, pool);
} catch (const std::exception& error) {
    std::fprintf(stderr, "generate_dataset: %s\n", error.what());
    return 1;
}
