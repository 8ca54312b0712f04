// Memory that is left as it comes: whatever its size it holds what is put there, and large memory begins a large page.
#include <insonify/core/detail/uninitialized.hpp>

#include <bit>
#include <cstdint>
#include <utility>

#include "../../catch.hpp"

namespace in = insonify;
using bytes = in::detail::uninitialized_vector<std::uint8_t>;

TEST_CASE("Memory holds what is put there, small or large, moved or copied") {
    constexpr std::size_t megabyte = std::size_t{1} << 20;
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{1}, megabyte, 4 * megabyte - 1, 4 * megabyte, 9 * megabyte + 123}) {
        INFO("bytes " << size);
        bytes memory(size);
        for (std::size_t i = 0; i < size; i += 4095) memory[i] = static_cast<std::uint8_t>(i % 251);
        const bytes copy = memory;
        const bytes moved = std::move(memory);
        CHECK(copy == moved);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < size; i += 4095) wrong += moved[i] != i % 251;
        CHECK(wrong == 0);
    }
}

TEST_CASE("Memory of two large pages or more begins one, where it is kept, and a smaller block a line of the cache") {
    if (!INSONIFY_KEEP_MEMORY) return;
    constexpr std::size_t page = std::size_t{1} << 21;
    CHECK(std::bit_cast<std::uintptr_t>(bytes(2 * page).data()) % page == 0);
    CHECK(std::bit_cast<std::uintptr_t>(in::detail::uninitialized_vector<double>(page).data()) % page == 0);
    CHECK(std::bit_cast<std::uintptr_t>(bytes(page / 9).data()) % in::detail::memory_block::alignment == 0);
}

TEST_CASE("What is given is kept, what isn't is left to be set") {
    const in::detail::uninitialized_vector<int> given(3, 7);
    CHECK(given == in::detail::uninitialized_vector<int>{7, 7, 7});
    CHECK(in::detail::uninitialized_vector<bytes>(2)[1].empty());  // what has a constructor is made
}
