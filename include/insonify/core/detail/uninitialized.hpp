// Memory that is left as it comes, for what is all about to be written: not to be written twice, nor by one thread what
// many will.
//
// From 64 KB on it stays with the thread for the next that is as large, unless INSONIFY_KEEP_MEMORY is 0.
#pragma once

#include <insonify/core/detail/spare_memory.hpp>

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail {

/// For constructors: leave the elements unset.
struct uninitialized {};

/// Makes values that nobody gave as `T value;` does, not as `T value{};`.
template <class T>
class uninitialized_allocator {
  public:
    using value_type = T;

    uninitialized_allocator() = default;
    template <class U>
    INSONIFY_MEMBER uninitialized_allocator(const uninitialized_allocator<U>&) {}

    INSONIFY_TAGGED T* allocate(std::size_t count) {
        if (!is_block(count)) return std::allocator<T>().allocate(count);
        spare_memory* const spare = spare_memory::mine();
        const std::size_t bytes = count * sizeof(T);
        return static_cast<T*>(spare != nullptr ? spare->take(bytes) : memory_block::allocate(bytes));
    }
    INSONIFY_TAGGED void deallocate(T* memory, std::size_t count) {
        if (!is_block(count)) return std::allocator<T>().deallocate(memory, count);
        if (spare_memory* const spare = spare_memory::mine())
            spare->give(memory);
        else
            memory_block::free(memory);
    }

    template <class U>
    INSONIFY_MEMBER void construct(U* at) {
        ::new (static_cast<void*>(at)) U;
    }
    template <class U, class... From>
    INSONIFY_MEMBER void construct(U* at, From&&... from) {
        std::construct_at(at, std::forward<From>(from)...);
    }

    friend bool operator==(const uninitialized_allocator&, const uninitialized_allocator&) { return true; }

  private:
    static_assert(alignof(T) <= memory_block::alignment);

    INSONIFY_MEMBER static bool is_block(std::size_t count) {
        return INSONIFY_KEEP_MEMORY && count >= memory_block::least / sizeof(T);
    }
};

/// Elements stay unset until somebody sets them.
template <class T>
using uninitialized_vector = std::vector<T, uninitialized_allocator<T>>;

}  // namespace detail
}  // namespace INSONIFY_ABI
}  // namespace insonify
