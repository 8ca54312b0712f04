// A rectangle of pixels.
#pragma once

#include <insonify/config.hpp>

#include <algorithm>

namespace insonify {
inline namespace INSONIFY_ABI {

/// The pixels (x, y) with x0 <= x < x1 and y0 <= y < y1; y grows downwards. Empty if either range is.
struct rect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

    INSONIFY_MEMBER constexpr bool empty() const { return x1 <= x0 || y1 <= y0; }
    INSONIFY_MEMBER constexpr int width() const { return x1 - x0; }
    INSONIFY_MEMBER constexpr int height() const { return y1 - y0; }
    INSONIFY_MEMBER constexpr bool contains(int x, int y) const { return x0 <= x && x < x1 && y0 <= y && y < y1; }

    friend constexpr bool operator==(const rect&, const rect&) = default;
};

inline namespace INSONIFY_FLAGS {

/// The pixels that lie in both; empty if there are none.
constexpr rect intersect(const rect& a, const rect& b) {
    return {(std::max)(a.x0, b.x0), (std::max)(a.y0, b.y0), (std::min)(a.x1, b.x1), (std::min)(a.y1, b.y1)};
}

/// The smallest rectangle that contains both.
constexpr rect merge(const rect& a, const rect& b) {
    if (a.empty() || b.empty()) return a.empty() ? b : a;
    return {(std::min)(a.x0, b.x0), (std::min)(a.y0, b.y0), (std::max)(a.x1, b.x1), (std::max)(a.y1, b.y1)};
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify
