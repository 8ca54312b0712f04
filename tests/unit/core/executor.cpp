// Executors: each index is called once, exceptions reach the caller, nested bulks do not deadlock.
#include <insonify/core/executor.hpp>
#include <insonify/core/thread_pool.hpp>

#include <atomic>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <thread>
#include <vector>

#include "../../catch.hpp"

namespace in = insonify;

namespace {

struct ignores_work {
    void bulk(int) {}
};
static_assert(in::executor<in::serial_executor> && in::executor<const in::serial_executor>);
static_assert(in::executor<in::thread_pool>);
static_assert(!in::executor<ignores_work>);

// How often each of `count` calls was made.
template <class Executor>
std::vector<int> calls(Executor& ex, std::size_t count) {
    std::vector<std::atomic<int>> made(count);
    ex.bulk(count, [&](std::size_t i) { ++made[i]; });
    return {made.begin(), made.end()};
}

}  // namespace

TEST_CASE("The serial executor calls in order, on the calling thread") {
    std::vector<std::size_t> order;
    in::serial_executor{}.bulk(5, [&](std::size_t i) { order.push_back(i); });
    CHECK(order == std::vector<std::size_t>{0, 1, 2, 3, 4});
}

TEST_CASE("A pool makes every call exactly once, with fewer or more threads than calls", "[threads]") {
    const int threads = GENERATE(1, 2, 3, 8);
    const std::size_t count = GENERATE(0u, 1u, 2u, 3u, 7u, 1000u);
    in::thread_pool pool(threads);
    CHECK(pool.threads() == threads);
    CHECK(calls(pool, count) == std::vector<int>(count, 1));
}

TEST_CASE("A pool has one thread per hardware thread by default and refuses sizes out of range", "[threads]") {
    const int threads = in::thread_pool().threads();
    CHECK(threads >= 1);
    if (const int hardware = static_cast<int>(std::thread::hardware_concurrency()); hardware > 0)
        CHECK(threads == in::thread_pool(hardware).threads());  // fewer if the system refuses to start some
    CHECK_THROWS_WITH(in::thread_pool(-1), ContainsSubstring("threads is -1"));
    CHECK_THROWS_AS(in::thread_pool(4097), in::invalid_input);
}

TEST_CASE("A plain function can be the work of a bulk", "[threads]") {
    static std::atomic<int> made{0};
    struct work {
        static void count(std::size_t) { ++made; }
    };
    in::thread_pool pool(2);
    pool.bulk(3, work::count);
    in::executor_ref(pool).bulk(4, work::count);
    in::serial_executor{}.bulk(5, work::count);
    CHECK(made == 12);
}

TEST_CASE("Every call of many short bulks has returned before its bulk does", "[threads]") {
    in::thread_pool pool(3);
    int wrong = 0;
    for (std::size_t round = 0; round < 3000; ++round) {
        const std::size_t count = round % 5;
        std::atomic<std::size_t> sum{0};  // destroyed after the round: a late call would write to it
        pool.bulk(count, [&](std::size_t i) { sum += i + 1; });
        wrong += sum != count * (count + 1) / 2;
    }
    CHECK(wrong == 0);
}

TEST_CASE("A pool uses more than one thread", "[threads]") {
    in::thread_pool pool(2);
    // Two calls that wait for each other meet only if they run at the same time.
    std::atomic<int> arrived{0}, met{0};
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    pool.bulk(2, [&](std::size_t) {
        ++arrived;
        while (arrived < 2 && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
        if (arrived == 2) ++met;
    });
    CHECK(met == 2);
}

TEST_CASE("An exception reaches the caller after all other calls have returned, and the pool stays usable",
          "[threads]") {
    in::thread_pool pool(GENERATE(1, 4));
    const bool parallel = pool.threads() > 1;
    std::atomic<int> made{0};
    const auto fails_in_the_middle = [&](std::size_t i) {
        if (i == 37) throw std::runtime_error("call 37");
        ++made;
    };
    CHECK_THROWS_WITH(pool.bulk(100, fails_in_the_middle), "call 37");
    CHECK(made == (parallel ? 99 : 37));
    CHECK_THROWS_AS(pool.bulk(100, [](std::size_t i) { throw i; }), std::size_t);
    CHECK(calls(pool, 50) == std::vector<int>(50, 1));
}

TEST_CASE("Nested bulks complete, within one pool and across two", "[threads]") {
    in::thread_pool outer(3), other(2);
    std::atomic<int> made{0};
    outer.bulk(8, [&](std::size_t) {
        outer.bulk(8, [&](std::size_t) { ++made; });
        other.bulk(8, [&](std::size_t) { outer.bulk(2, [&](std::size_t) { ++made; }); });
    });
    CHECK(made == 8 * 8 + 8 * 8 * 2);
}

TEST_CASE("Several threads may share a pool", "[threads]") {
    in::thread_pool pool(2);
    std::atomic<int> made{0};
    std::vector<std::thread> callers;
    for (int caller = 0; caller < 4; ++caller)
        callers.emplace_back([&] {
            for (int round = 0; round < 100; ++round) pool.bulk(7, [&](std::size_t) { ++made; });
        });
    for (std::thread& caller : callers) caller.join();
    CHECK(made == 4 * 100 * 7);
}

TEST_CASE("bulk_ranges() splits at multiples of the grain for any executor", "[threads]") {
    in::thread_pool pool(2);
    std::vector<std::size_t> ends(4, 0);
    in::bulk_ranges(pool, 10, 3, [&](std::size_t first, std::size_t last) { ends[first / 3] = last; });
    CHECK(ends == std::vector<std::size_t>{3, 6, 9, 10});

    in::serial_executor serial;
    int made = 0;
    in::bulk_ranges(serial, 0, 3, [&](std::size_t, std::size_t) { ++made; });
    CHECK(made == 0);
    in::bulk_ranges(serial, 3, 100, [&](std::size_t first, std::size_t last) { made += first == 0 && last == 3; });
    CHECK(made == 1);
    CHECK_THROWS_AS(in::bulk_ranges(serial, 3, 0, [](std::size_t, std::size_t) {}), in::invalid_input);
    // A grain beyond the count is one run, however large it is.
    int calls = 0;
    in::bulk_ranges(serial, 10, std::numeric_limits<std::size_t>::max(), [&](std::size_t first, std::size_t last) {
        CHECK((first == 0 && last == 10));
        ++calls;
    });
    CHECK(calls == 1);
}
