// Uninitialized vectors: stored values, copies and moves, for small and pooled sizes.
#include <insonify/core/context.hpp>
#include <insonify/core/detail/uninitialized.hpp>

#include <cstdint>
#include <utility>

#include "../../catch.hpp"

namespace in = insonify;
using bytes = in::detail::uninitialized_vector<std::uint8_t>;

TEST_CASE("Uninitialized vectors keep stored values when copied and moved, small or large") {
    constexpr std::size_t megabyte = std::size_t{1} << 20;
    const in::context context;
    const in::detail::shared_pool memory = GENERATE_REF(in::detail::shared_pool(), context.memory());
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, megabyte, 4 * megabyte - 1, 9 * megabyte + 123}) {
        INFO("bytes " << size);
        bytes vector(size, memory);
        for (std::size_t i = 0; i < size; i += 4095) vector[i] = static_cast<std::uint8_t>(i % 251);
        const bytes copy = vector;
        const bytes moved = std::move(vector);
        CHECK(copy == moved);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < size; i += 4095) wrong += moved[i] != i % 251;
        CHECK(wrong == 0);
    }
}

TEST_CASE("Given values are stored, and elements with a constructor are constructed") {
    const in::detail::uninitialized_vector<int> given(3, 7);
    CHECK(given == in::detail::uninitialized_vector<int>{7, 7, 7});
    CHECK(in::detail::uninitialized_vector<bytes>(2)[1].empty());
}
