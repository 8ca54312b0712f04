// 128-bit integers for exact geometry: products of two 64-bit numbers, sums, differences, signs. Two's complement in
// two halves, portable to every compiler; sums wrap.
#pragma once

#include <insonify/config.hpp>

#include <cstdint>
#include <limits>

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

struct int128 {
    std::int64_t high = 0;
    std::uint64_t low = 0;

    static constexpr int128 from(std::int64_t value) { return {value < 0 ? -1 : 0, static_cast<std::uint64_t>(value)}; }

    static constexpr int128 product(std::int64_t a, std::int64_t b) {
        const bool negative = (a < 0) != (b < 0);
        const std::uint64_t x = abs(a), y = abs(b);
        const std::uint64_t x0 = x & half, x1 = x >> 32, y0 = y & half, y1 = y >> 32;
        const std::uint64_t middle = x1 * y0 + ((x0 * y0) >> 32);
        const std::uint64_t carry = x0 * y1 + (middle & half);
        const int128 result{static_cast<std::int64_t>(x1 * y1 + (middle >> 32) + (carry >> 32)), x * y};
        return negative ? -result : result;
    }

    constexpr int128 operator-() const {
        const std::uint64_t flipped = ~low + 1;
        return {static_cast<std::int64_t>(~static_cast<std::uint64_t>(high) + (flipped == 0 ? 1u : 0u)), flipped};
    }
    friend constexpr int128 operator+(const int128& a, const int128& b) {
        const std::uint64_t sum = a.low + b.low;
        return {static_cast<std::int64_t>(static_cast<std::uint64_t>(a.high) + static_cast<std::uint64_t>(b.high) +
                                          (sum < a.low ? 1u : 0u)),
                sum};
    }
    friend constexpr int128 operator-(const int128& a, const int128& b) { return a + -b; }

    /// -1, 0 or 1.
    constexpr int sign() const { return high < 0 ? -1 : (high > 0 || low > 0) ? 1 : 0; }

    /// Divides by 2^bits, 0 < bits < 64, rounding down, and saturates to 64 bits.
    constexpr std::int64_t shifted_down(int bits) const {
        constexpr auto top = (std::numeric_limits<std::int64_t>::max)();
        constexpr auto bottom = (std::numeric_limits<std::int64_t>::min)();
        const std::int64_t rest = high >> (bits - 1);
        if (rest > 0) return top;
        if (rest < -1) return bottom;
        return static_cast<std::int64_t>((static_cast<std::uint64_t>(high) << (64 - bits)) | (low >> bits));
    }

  private:
    static constexpr std::uint64_t half = 0xFFFFFFFFu;
    static constexpr std::uint64_t abs(std::int64_t v) {
        return v < 0 ? ~static_cast<std::uint64_t>(v) + 1 : static_cast<std::uint64_t>(v);
    }
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify
