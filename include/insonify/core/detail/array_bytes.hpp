// Size of an array in bytes, for allocation.
#pragma once

#include <insonify/config.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail {

/// A size that would overflow is clamped to that of the largest object, which a 64-bit machine cannot allocate: it
/// throws like any other size that is too large.
template <class T>
INSONIFY_MEMBER constexpr std::size_t array_bytes(std::size_t count) {
    constexpr std::size_t largest = PTRDIFF_MAX / sizeof(T);
    return (std::min)(count, largest) * sizeof(T);
}

}  // namespace detail
}  // namespace INSONIFY_ABI
}  // namespace insonify
