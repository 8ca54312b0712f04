// Radix sort of keyed items against std::stable_sort, and of plain 32-bit values against std::sort.
#include <insonify/core/detail/radix_sort.hpp>
#include <insonify/core/random.hpp>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <vector>

#include "../../catch.hpp"

namespace in = insonify;
using in::detail::keyed;

TEST_CASE("The ordered bits of floats compare as the floats do, with -0 below 0 and NaN at the ends") {
    using in::detail::from_ordered_bits, in::detail::ordered_bits;
    using own = std::numeric_limits<float>;
    const float ascending[] = {-own::quiet_NaN(),
                               -own::infinity(),
                               own::lowest(),
                               -1.0f,
                               -own::denorm_min(),
                               -0.0f,
                               0.0f,
                               own::denorm_min(),
                               1.0f,
                               (own::max)(),
                               own::infinity(),
                               own::quiet_NaN()};
    for (std::size_t i = 0; i < std::size(ascending); ++i) {
        const std::uint32_t bits = ordered_bits(ascending[i]);
        CHECK(in::numeric::bit_cast<std::uint32_t>(from_ordered_bits(bits)) ==
              in::numeric::bit_cast<std::uint32_t>(ascending[i]));
        if (i > 0) CHECK(ordered_bits(ascending[i - 1]) < bits);
    }
}

TEST_CASE("radix_sort() orders by key and keeps the order of equal ones, as a stable sort does") {
    // Sizes around 64, below which insertion sort is used; few distinct keys, keys of few digits that vary, all bits.
    const std::uint32_t size = GENERATE(0u, 1u, 2u, 63u, 64u, 65u, 5000u);
    // Values of GENERATE have the type of the first one.
    const std::uint64_t mask = GENERATE(std::uint64_t{0x3}, 0xFFFF00000000u, 0x700000000007u, ~std::uint64_t{0});
    INFO(size << " items, keys within " << mask);
    in::random_sequence random(1, size, mask);
    in::detail::dynamic_array<keyed> items;
    in::detail::dynamic_array<std::uint32_t> words;
    for (std::uint32_t i = 0; i < size; ++i) {
        items.push_back({(std::uint64_t{random.word()} << 32 | random.word()) & mask, i});
        words.push_back(random.word() & static_cast<std::uint32_t>(mask));
    }
    std::vector<keyed> expected(items.begin(), items.end());
    std::stable_sort(expected.begin(), expected.end(), [](const keyed& a, const keyed& b) { return a.key < b.key; });
    in::detail::radix_sort(items);
    const auto same = [](const keyed& a, const keyed& b) { return a.key == b.key && a.number == b.number; };
    CHECK(std::equal(items.begin(), items.end(), expected.begin(), expected.end(), same));

    std::vector<std::uint32_t> sorted(words.begin(), words.end());
    std::sort(sorted.begin(), sorted.end());
    in::detail::radix_sort(words);
    CHECK(std::equal(words.begin(), words.end(), sorted.begin(), sorted.end()));
}
