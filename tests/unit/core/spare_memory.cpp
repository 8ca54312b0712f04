// Memory given back waits for who asks for as much next; a thread holds hardly more than it has had in use at once.
#include <insonify/core/detail/spare_memory.hpp>
#include <insonify/core/detail/uninitialized.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <thread>
#include <vector>

#include "../../catch.hpp"

namespace in = insonify;
using in::detail::memory_block;
using in::detail::spare_memory;

namespace {

constexpr std::size_t page = memory_block::page;

}  // namespace

TEST_CASE("What was given back comes again, to who asks for about as much") {
    spare_memory spare;
    void* const first = spare.take(6 * page);
    CHECK(std::bit_cast<std::uintptr_t>(first) % page == 0);
    spare.give(first);
    CHECK(spare.kept() == 6 * page);
    void* const again = spare.take(4 * page + 1);
    CHECK(again == first);
    CHECK(spare.kept() == 0);
    spare.give(again);
    spare.release();
    CHECK(spare.kept() == 0);
}

TEST_CASE("A larger one serves, too, up to twice as large; the smallest that does") {
    spare_memory spare;
    void* const blocks[3] = {spare.take(8 * page), spare.take(4 * page), spare.take(6 * page)};
    for (void* const memory : blocks) spare.give(memory);
    void* const little = spare.take(3 * page);
    CHECK(little == blocks[1]);
    CHECK(spare.kept() == 14 * page);
    CHECK(spare.take(4 * page) == blocks[2]);
    void* const tiny = spare.take(2 * page);  // the one that is left holds four times as much
    CHECK(spare.kept() == 8 * page);
    // It is as large as ever.
    spare.give(little);
    CHECK(spare.kept() == 12 * page);
    CHECK(spare.take(4 * page) == little);
    for (void* const memory : {little, tiny, blocks[2]}) spare.give(memory);
    spare.release();
}

TEST_CASE("Pictures of one size, made one after another, share their memory") {
    for (const std::size_t bytes : {memory_block::least, 5 * memory_block::least, 3 * page}) {
        INFO(bytes);
        const float* seen = nullptr;
        for (int i = 0; i < 3; ++i) {
            const in::detail::uninitialized_vector<float> picture(bytes / sizeof(float));
            if (i > 0 && INSONIFY_KEEP_MEMORY) CHECK(picture.data() == seen);
            seen = picture.data();
        }
        CHECK(spare_memory::mine()->kept() >= (INSONIFY_KEEP_MEMORY ? bytes : 0));
        in::release_memory();
        CHECK(spare_memory::mine()->kept() == 0);
    }
    const in::detail::uninitialized_vector<char> little(memory_block::least - 1);
    CHECK(in::detail::uninitialized_vector<char>(little).size() == little.size());
    CHECK(spare_memory::mine()->kept() == 0);
}

TEST_CASE("What comes and goes does not drive out what a picture's peak needs") {
    spare_memory spare;
    std::vector<void*> seen;
    for (int picture = 0; picture < 4; ++picture) {
        void* const passing = spare.take(page);
        spare.give(passing);
        std::vector<void*> taken;
        for (std::size_t pages = 3; pages <= 7; ++pages) taken.push_back(spare.take(pages * page));
        for (std::size_t pages = 3; pages <= 7; ++pages) spare.give(taken[pages - 3]);
        taken.push_back(passing);
        if (picture > 1) CHECK(taken == seen);
        seen = taken;
    }
    CHECK(spare.kept() == (1 + 3 + 4 + 6 + 6 + 8) * page);
    spare.release();
}

TEST_CASE("Kept and in use together stay within half as much again as has been in use at once") {
    spare_memory spare;
    std::vector<void*> taken;
    for (int i = 0; i < 4; ++i) taken.push_back(spare.take(2 * page));
    for (void* const memory : taken) spare.give(memory);
    CHECK(spare.kept() == 8 * page);
    // Beside twelve pages in use six may wait: three of the four blocks.
    void* const larger = spare.take(12 * page);
    CHECK(spare.kept() == 6 * page);
    spare.give(larger);
    CHECK(spare.kept() == 18 * page);
    // For as much in smaller blocks the one of twelve has to go, too.
    for (void*& memory : taken) memory = spare.take(3 * page);
    CHECK(spare.kept() + 12 * page <= 18 * page);
    for (void* const memory : taken) spare.give(memory);
    CHECK(spare.kept() <= 18 * page);
    spare.release();
}

TEST_CASE("A thread that frees what others took keeps no more than it has had itself") {
    spare_memory maker, taker;
    for (int i = 0; i < 3; ++i) taker.give(maker.take(2 * page));
    CHECK(taker.kept() == 0);
    void* const own = taker.take(2 * page);
    taker.give(maker.take(2 * page));
    taker.give(own);
    CHECK(taker.kept() == 2 * page);
    taker.release();
}

TEST_CASE("However many blocks are given back, few are kept") {
    spare_memory spare;
    std::vector<void*> taken;
    for (int i = 0; i < 80; ++i) taken.push_back(spare.take(2 * page));
    for (void* const memory : taken) spare.give(memory);
    CHECK(spare.kept() == 64 * 2 * page);
    spare.release();
}

TEST_CASE("Who waits longest makes room first") {
    spare_memory spare;
    void* const blocks[3] = {spare.take(2 * page), spare.take(3 * page), spare.take(4 * page)};
    for (const std::size_t i : {1u, 0u, 2u}) spare.give(blocks[i]);
    CHECK(spare.kept() == 9 * page);
    void* const other = spare.take(6 * page);
    CHECK(spare.kept() == 6 * page);
    CHECK(spare.take(2 * page) == blocks[0]);
    CHECK(spare.take(4 * page) == blocks[2]);
    spare.give(blocks[0]), spare.give(blocks[2]), spare.give(other);
    spare.release();
}

TEST_CASE("Sizes count as the same in steps of a third to a half of them") {
    CHECK(memory_block::rounded(2 * page) == 2 * page);
    CHECK(memory_block::rounded(2 * page + 1) == 3 * page);
    for (std::size_t bytes = memory_block::least; bytes < 100 * page; bytes += bytes / 99) {
        const std::size_t size = memory_block::rounded(bytes);
        CHECK(size >= bytes);
        CHECK(size < bytes + bytes / 2);
        CHECK(size == memory_block::rounded(size));
        if (size >= 2 * page) CHECK(size % page == 0);
    }
    for (const std::size_t bytes : {memory_block::least, memory_block::least + 1, 2 * page - 1, 2 * page, 5 * page}) {
        char* const memory = static_cast<char*>(memory_block::allocate(bytes));
        CHECK(memory_block::size_of(memory) == memory_block::rounded(bytes));
        CHECK(std::bit_cast<std::uintptr_t>(memory) % memory_block::alignment == 0);
        std::fill_n(memory, memory_block::rounded(bytes), 'x');
        CHECK(memory_block::size_of(memory) == memory_block::rounded(bytes));
        memory_block::free(memory);
    }
}

TEST_CASE("More than the system has is refused, and nothing is lost") {
    spare_memory spare;
    void* const first = spare.take(2 * page);
    CHECK_THROWS_AS(spare.take(std::size_t{1} << 60), std::bad_alloc);
    spare.give(first);
    spare.give(memory_block::allocate(2 * page));
    CHECK(spare.kept() == 2 * page);  // as much as has been in use
    CHECK(spare.take(2 * page) == first);
    spare.give(first);
    spare.release();
}

TEST_CASE("Memory may be given back on another thread, and after the thread's own end") {
    in::detail::uninitialized_vector<char> picture;
    std::thread([&] { picture.resize(4 * page, 'x'); }).join();
    CHECK(picture.back() == 'x');
    std::thread([last = std::move(picture)]() mutable { last = {}; }).join();
    static const in::detail::uninitialized_vector<char> until_the_end(2 * page);
    CHECK(until_the_end.size() == 2 * page);
}
