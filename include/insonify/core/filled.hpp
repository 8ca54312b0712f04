// Images of one value, made by all threads: filling a large one takes as long as drawing a small picture, most of it
// to get hold of the memory.
#pragma once

#include <insonify/core/executor.hpp>
#include <insonify/core/image.hpp>

#include <algorithm>

namespace insonify::inline INSONIFY_ABI::detail {

template <class T, executor E>
image<T> filled(int width, int height, T value, E& ex) {
    image<T> result(width, height, unfilled{});
    const std::size_t rows = (std::size_t{1} << 18) / (static_cast<std::size_t>((std::max)(width, 1)) * sizeof(T)) + 1;
    bulk_ranges(ex, static_cast<std::size_t>(height), rows, [&](std::size_t first, std::size_t last) {
        for (std::size_t y = first; y < last; ++y) std::ranges::fill(result.row(static_cast<int>(y)), value);
    });
    return result;
}

}  // namespace insonify::inline INSONIFY_ABI::detail
