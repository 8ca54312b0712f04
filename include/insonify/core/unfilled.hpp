// Memory that is left as it comes, for what is all about to be written: not to be written twice, nor by one thread what
// many will.
//
// The system hands memory out page by page, as each is touched first. By pages of 4 kB that takes a tenth of the time
// of a large picture, so for large memory it is asked for pages of 2 MB, where it has them.
#pragma once

#include <insonify/config.hpp>

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace insonify::inline INSONIFY_ABI::detail {

/// For constructors: leave the elements unset.
struct unfilled {};

/// Makes values that nobody gave as `T value;` does, not as `T value{};`.
template <class T>
class unfilled_allocator {
  public:
    using value_type = T;

    unfilled_allocator() = default;
    template <class U>
    unfilled_allocator(const unfilled_allocator<U>&) {}

    T* allocate(std::size_t count) {
        if (!is_large(count)) return std::allocator<T>().allocate(count);
        const std::size_t bytes = count * sizeof(T);
        void* const memory = ::operator new (bytes, std::align_val_t{page});
#if defined(__linux__) && defined(MADV_HUGEPAGE)
        ::madvise(memory, bytes / page * page, MADV_HUGEPAGE);  // refused, it is memory all the same
#endif
        return static_cast<T*>(memory);
    }
    void deallocate(T* memory, std::size_t count) {
        if (is_large(count))
            ::operator delete (memory, std::align_val_t{page});
        else
            std::allocator<T>().deallocate(memory, count);
    }

    template <class U>
    void construct(U* at) {
        ::new (static_cast<void*>(at)) U;
    }
    template <class U, class... From>
    void construct(U* at, From&&... from) {
        std::construct_at(at, std::forward<From>(from)...);
    }

    friend bool operator==(const unfilled_allocator&, const unfilled_allocator&) {
        return true;
    }

  private:
    static constexpr std::size_t page = std::size_t{1} << 21;
    static_assert(alignof(T) <= page);

    /// At least two pages, of which the first and the last waste one at most.
    static bool is_large(std::size_t count) {
        return count >= 2 * page / sizeof(T);
    }
};

/// Elements stay unset until somebody sets them.
template <class T>
using unfilled_vector = std::vector<T, unfilled_allocator<T>>;

}  // namespace insonify::inline INSONIFY_ABI::detail
