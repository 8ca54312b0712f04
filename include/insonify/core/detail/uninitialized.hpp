// Vectors whose elements start uninitialized, for storage that is overwritten at once. Large ones may draw on a
// context's memory.
#pragma once

#include <insonify/core/detail/block_pool.hpp>

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail {

/// Constructor tag: elements are left uninitialized.
struct uninitialized {};

/// Allocates blocks of 64 KB and more from a pool, all others from the heap; `construct` without arguments leaves
/// scalars uninitialized.
template <class T>
class uninitialized_allocator {
  public:
    using value_type = T;
    using propagate_on_container_move_assignment = std::true_type;
    using propagate_on_container_swap = std::true_type;

    uninitialized_allocator() = default;
    uninitialized_allocator(const shared_pool& pool) : pool_(pool) {}
    template <class U>
    INSONIFY_MEMBER uninitialized_allocator(const uninitialized_allocator<U>& other) : pool_(other.pool()) {}

    INSONIFY_TAGGED T* allocate(std::size_t count) {
        return pooled(count) ? static_cast<T*>(pool_->allocate(count * sizeof(T)))
                             : std::allocator<T>().allocate(count);
    }
    INSONIFY_TAGGED void deallocate(T* memory, std::size_t count) noexcept {
        pooled(count) ? pool_->deallocate(memory, count * sizeof(T)) : std::allocator<T>().deallocate(memory, count);
    }

    template <class U>
    INSONIFY_MEMBER void construct(U* at) {
        ::new (static_cast<void*>(at)) U;
    }
    template <class U, class... From>
    INSONIFY_MEMBER void construct(U* at, From&&... from) {
        std::construct_at(at, std::forward<From>(from)...);
    }

    /// Copies of a vector allocate from the heap.
    uninitialized_allocator select_on_container_copy_construction() const { return {}; }

    const shared_pool& pool() const { return pool_; }
    friend bool operator==(const uninitialized_allocator& a, const uninitialized_allocator& b) {
        return a.pool_ == b.pool_;
    }

  private:
    static_assert(alignof(T) <= block_pool::alignment);

    INSONIFY_MEMBER bool pooled(std::size_t count) const { return pool_ && count >= block_pool::min_bytes / sizeof(T); }

    shared_pool pool_;
};

template <class T>
using uninitialized_vector = std::vector<T, uninitialized_allocator<T>>;

}  // namespace detail
}  // namespace INSONIFY_ABI
}  // namespace insonify
