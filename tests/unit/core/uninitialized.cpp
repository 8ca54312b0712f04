// Uninitialized arrays: stored values, copies and moves, for small and pooled sizes.
#include <insonify/core/context.hpp>
#include <insonify/core/detail/uninitialized.hpp>

#include <cstdint>
#include <new>
#include <utility>
#include <vector>

#include "../../catch.hpp"

namespace in = insonify;
using bytes = in::detail::uninitialized_array<std::uint8_t>;

TEST_CASE("Uninitialized arrays keep stored values when copied and moved, small or large") {
    constexpr std::size_t megabyte = std::size_t{1} << 20;
    const in::context context;
    const in::detail::shared_pool memory = GENERATE_REF(in::detail::shared_pool(), context.memory());
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, megabyte, 4 * megabyte - 1, 9 * megabyte + 123}) {
        INFO("bytes " << size);
        bytes array(size, memory);
        for (std::size_t i = 0; i < size; i += 4095) array[i] = static_cast<std::uint8_t>(i % 251);
        const bytes copy = array;
        const bytes moved = std::move(array);
        CHECK(copy == moved);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < size; i += 4095) wrong += moved[i] != i % 251;
        CHECK(wrong == 0);
    }
}

TEST_CASE("Given values are stored, and elements with a constructor are constructed") {
    const in::detail::uninitialized_array<int> given(3, 7);
    CHECK(std::vector<int>(given.begin(), given.end()) == std::vector<int>{7, 7, 7});
    CHECK(in::detail::uninitialized_array<bytes>(2)[1].empty());
}

TEST_CASE("Elements are destroyed once, by a new size, an assignment or the end") {
    static int alive;
    struct counted {
        counted() { ++alive; }
        counted(const counted&) { ++alive; }
        counted& operator=(const counted&) = default;
        ~counted() { --alive; }
    };
    alive = 0;
    {
        in::detail::uninitialized_array<counted> some(5), others(2);
        CHECK(alive == 7);
        some.resize(3);
        CHECK(alive == 5);
        others = some;
        CHECK(alive == 6);
        some = std::move(others);
        CHECK(alive == 3);
        CHECK(others.empty());
    }
    CHECK(alive == 0);
}

#if !defined(INSONIFY_SANITIZED)  // sanitizers end a program that asks for so much
TEST_CASE("A size beyond the address space throws std::bad_alloc") {
    constexpr std::size_t largest = SIZE_MAX;
    CHECK_THROWS_AS(in::detail::uninitialized_array<double>(largest), std::bad_alloc);
    CHECK_THROWS_AS(in::detail::uninitialized_array<double>(largest, in::context().memory()), std::bad_alloc);
}
#endif
