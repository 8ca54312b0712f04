// Fills an image with one value in parallel: on one thread, a large image takes as long to fill as a small one to draw.
#pragma once

#include <insonify/core/detail/portable.hpp>
#include <insonify/core/executor.hpp>
#include <insonify/core/image.hpp>

#include <algorithm>
#include <array>
#include <cstring>

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

template <class T, executor E>
image<T> filled(int width, int height, T value, E& ex) {
    image<T> result(width, height, uninitialized{}, memory_of(ex));
    if (result.empty()) return result;
    const std::size_t rows = (std::size_t{1} << 18) / (static_cast<std::size_t>(width) * sizeof(T)) + 1;
    bulk_ranges(ex, static_cast<std::size_t>(height), rows, [&](std::size_t first, std::size_t last) {
        T* const start = result.row(static_cast<int>(first)).data();
        const std::size_t count = (last - first) * static_cast<std::size_t>(width);
        // memset is the fastest fill for values of equal bytes.
        const auto bytes = numeric::bit_cast<std::array<unsigned char, sizeof(T)>>(value);
        if (std::count(bytes.begin(), bytes.end(), bytes[0]) == std::ssize(bytes))
            std::memset(start, bytes[0], count * sizeof(T));
        else
            std::fill_n(start, count, value);
    });
    return result;
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify
