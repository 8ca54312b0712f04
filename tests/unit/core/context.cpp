// context: scratch memory that the caller owns and successive renders reuse.
#include <insonify/core/context.hpp>
#include <insonify/core/thread_pool.hpp>
#include <insonify/geometry/sphere.hpp>
#include <insonify/seabed/ripples.hpp>
#include <insonify/sonar/overhead/render.hpp>

#include <algorithm>
#include <optional>
#include <thread>
#include <vector>

#include "../../catch.hpp"

namespace in = insonify;
using in::detail::block_pool, in::detail::memory_of, in::detail::uninitialized;
using floats = in::detail::uninitialized_array<float>;

static_assert(in::executor<in::context> && in::executor<const in::context>);
static_assert(!std::is_copy_constructible_v<in::context>);

namespace {

constexpr std::size_t megabyte = std::size_t{1} << 20;

in::frame<> picture(auto& ex, int side = 256) {
    in::scene scene;
    scene.seabed = in::seabed::ripples{.seed = 3};
    scene.add(in::sphere{.radius = 0.5f}, {.position = {0.2, 0, 0.4}}, "sphere");
    return in::render(scene, in::overhead{.altitude = 4, .size = {side, side}}, {}, ex);
}

/// An executor whose memory() is no scratch memory.
struct executor_with_other_memory {
    std::size_t memory() const { return 0; }
    template <class Fn>
    void bulk(std::size_t count, Fn&& fn) const {
        for (std::size_t i = 0; i < count; ++i) fn(i);
    }
};

}  // namespace

TEST_CASE("A context runs its executor's loops, and serial ones without an executor") {
    in::thread_pool pool(2);
    in::context of_pool(pool), serial;
    std::vector<int> calls(100, 0);
    of_pool.bulk(calls.size(), [&](std::size_t i) { ++calls[i]; });
    CHECK(calls == std::vector<int>(100, 1));
    std::vector<std::size_t> order;
    serial.bulk(3, [&](std::size_t i) { order.push_back(i); });
    CHECK(order == std::vector<std::size_t>{0, 1, 2});
}

TEST_CASE("render() with a context gives the same bytes, frame after frame, with any number of threads") {
    in::serial_executor plain;
    const in::frame<> expected = picture(plain);
    in::thread_pool pool(3);
    in::context context(pool), serial;
    for (int i = 0; i < 3; ++i) {
        CHECK(picture(context).image == expected.image);
        const in::frame<> again = picture(serial);
        CHECK(again.image == expected.image);
        CHECK(again.labels.shadow == expected.labels.shadow);
    }
}

TEST_CASE("A second frame reuses the first one's memory, for its image and for temporaries") {
    in::context context;
    const float* first = nullptr;
    {
        const in::frame<> frame = picture(context);
        first = frame.image.pixels().data();
    }
    const std::size_t kept = context.kept_bytes();
    CHECK(kept >= 2 * 256 * 256 * sizeof(float));
    const in::frame<> second = picture(context);
    CHECK(second.image.pixels().data() == first);
    CHECK(context.kept_bytes() < kept);
}

TEST_CASE("A type-erased executor passes on the context's memory") {
    in::context context;
    const in::executor_ref erased(context);
    CHECK(memory_of(erased) == context.memory());
    CHECK(memory_of(in::executor_ref(erased)) == context.memory());
    CHECK(memory_of(in::serial_executor{}) == nullptr);
}

TEST_CASE("Images may outlive their context and be destroyed on any thread; their copies use the heap") {
    in::image<float> kept, copy;
    {
        in::context context;
        kept = in::image<float>(512, 512, uninitialized{}, context.memory());
        std::fill(kept.pixels().begin(), kept.pixels().end(), 7.0f);
        std::thread([moved = in::image<float>(512, 512, uninitialized{}, context.memory())] {}).join();
        copy = kept;
        CHECK(context.kept_bytes() == megabyte);
    }
    CHECK(kept == copy);
    CHECK(kept == in::image<float>(512, 512, 7.0f));
}

TEST_CASE("Images move and swap between contexts and the heap") {
    in::context a, b;
    in::image<float> one(512, 512, uninitialized{}, a.memory()), two(512, 512, uninitialized{}, b.memory());
    one(0, 0) = 1, two(0, 0) = 2;
    std::swap(one, two);
    CHECK((one(0, 0) == 2 && two(0, 0) == 1));
    one = std::move(two);
    CHECK(one(0, 0) == 1);
    CHECK(b.kept_bytes() == megabyte);
    one = in::image<float>(3, 3);
    CHECK(a.kept_bytes() == megabyte);
}

TEST_CASE("release() frees the kept blocks") {
    in::context context;
    picture(context);
    REQUIRE(context.kept_bytes() > 0);
    context.release();
    CHECK(context.kept_bytes() == 0);
    picture(context);
    CHECK(context.kept_bytes() > 0);
}

TEST_CASE("release() resets the peak: a block in use is freed later, not kept, unless more is allocated first") {
    in::context context;
    in::image<float> in_use(512, 512, uninitialized{}, context.memory());
    context.release();
    in_use = {};
    CHECK(context.kept_bytes() == 0);
}

TEST_CASE("Small arrays bypass the context's memory") {
    in::context context;
    floats(block_pool::min_bytes / sizeof(float) - 1, context.memory());
    CHECK(context.kept_bytes() == 0);
    floats(block_pool::min_bytes / sizeof(float), context.memory());
    CHECK(context.kept_bytes() == block_pool::min_bytes);
}

TEST_CASE("A pool reuses blocks of the same size class; there are two classes per octave") {
    CHECK(block_pool::size_class(4 * megabyte) == 4 * megabyte);
    CHECK(block_pool::size_class(4 * megabyte + 1) == 6 * megabyte);
    CHECK(block_pool::size_class(6 * megabyte + 1) == 8 * megabyte);

    block_pool pool;
    void* const block = pool.allocate(5 * megabyte);
    pool.deallocate(block, 5 * megabyte);
    void* const larger = pool.allocate(7 * megabyte);
    void* const smaller = pool.allocate(2 * megabyte);
    CHECK((larger != block && smaller != block));
    void* const same = pool.allocate(6 * megabyte - 1);
    CHECK(same == block);
    pool.deallocate(smaller, 2 * megabyte);
    pool.deallocate(larger, 7 * megabyte);
    pool.deallocate(same, 6 * megabyte - 1);
}

TEST_CASE("A pool keeps at most 1.5 times its peak use, and frees the oldest blocks first") {
    block_pool pool;
    for (const std::size_t size : {1u, 2u, 3u, 4u, 6u})
        pool.deallocate(pool.allocate(size * megabyte), size * megabyte);
    CHECK(pool.kept_bytes() == 6 * megabyte);  // 3 + 4 + 6 and 4 + 6 exceed 9
    void* const two = pool.allocate(2 * megabyte);
    void* const six = pool.allocate(6 * megabyte);
    CHECK(pool.kept_bytes() == 0);
    pool.deallocate(two, 2 * megabyte);
    pool.deallocate(six, 6 * megabyte);
    CHECK(pool.kept_bytes() == 8 * megabyte);
    pool.release();
    CHECK(pool.kept_bytes() == 0);
}

TEST_CASE("As many blocks as necessary are freed, in the order of their age") {
    block_pool pool;
    void* blocks[4];
    for (std::size_t i = 0; i < 4; ++i) blocks[i] = pool.allocate((i + 1) * megabyte);  // 15 MB may be kept
    for (std::size_t i = 0; i < 4; ++i) pool.deallocate(blocks[i], (i + 1) * megabyte);
    pool.deallocate(pool.allocate(8 * megabyte), 8 * megabyte);
    CHECK(pool.kept_bytes() == 15 * megabyte);  // 3, 4 and 8
}

TEST_CASE("A pool keeps at most 64 blocks") {
    block_pool pool;
    std::vector<void*> blocks;
    for (int i = 0; i < 70; ++i) blocks.push_back(pool.allocate(block_pool::min_bytes));
    for (void* const block : blocks) pool.deallocate(block, block_pool::min_bytes);
    CHECK(pool.kept_bytes() == 64 * block_pool::min_bytes);
}

TEST_CASE("An executor may have a memory() of its own") {
    executor_with_other_memory ex;
    CHECK(in::render(in::scene{}, in::overhead{.size = {8, 8}}, in::render_options<>{}, ex).image.width() == 8);
}

TEST_CASE("Threads that share a context never get the same block") {
    in::context context;
    std::vector<std::thread> threads;
    std::vector<int> wrong(4, 0);
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            for (int round = 0; round < 200; ++round) {
                in::image<int> mine(128 + 64 * (round % 3), 256, uninitialized{}, context.memory());
                std::fill(mine.pixels().begin(), mine.pixels().end(), t);
                for (const int value : mine.pixels()) wrong[static_cast<std::size_t>(t)] += value != t;
            }
        });
    for (std::thread& thread : threads) thread.join();
    CHECK(wrong == std::vector<int>(4, 0));
}
