// Replaces the global operator new with one that fails on demand and counts allocations. One file of a program may
// include it.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

#include "catch.hpp"

namespace failing_new {

inline std::atomic<long> calls{0};              ///< so far
inline std::atomic<long> in_use{0};             ///< allocated and not freed
inline std::atomic<long> fails_at{0};           ///< number of the call that fails; 0: none
inline std::atomic<long> failed{0};             ///< calls that were made to fail
inline std::atomic<bool> keeps_failing{false};  ///< whether all later calls fail, too

inline void* allocate(std::size_t size, std::size_t alignment = alignof(std::max_align_t)) noexcept {
    const long number = ++calls, limit = fails_at;
    if (limit > 0 && (keeps_failing ? number >= limit : number == limit)) {
        ++failed;
        return nullptr;
    }
    void* const memory = alignment > alignof(std::max_align_t)
                             ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                             : std::malloc(size > 0 ? size : 1);
    if (memory != nullptr) ++in_use;
    return memory;
}
inline void* allocate_or_throw(std::size_t size, std::size_t alignment = alignof(std::max_align_t)) {
    void* const memory = allocate(size, alignment);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}
inline void release(void* memory) noexcept {
    if (memory != nullptr) --in_use;
    std::free(memory);
}

/// Runs `use` once for each of its allocations and makes that allocation fail: first alone, then with all later ones.
/// Checks that `use` throws std::bad_alloc or returns its usual result, and leaks nothing.
/// @returns the number of allocations that failed
template <class Use>
long fail_each_allocation(const Use& use) {
    const auto expected = use();
    long reached = 0;
    for (const bool all : {false, true})
        for (long at = 1;; ++at) {
            keeps_failing = all;
            const long before = in_use;
            calls = failed = 0;
            fails_at = at;
            bool is_right = true;
            try {
                is_right = use() == expected;
            } catch (const std::bad_alloc&) {
            } catch (...) {
                fails_at = 0;  // the report of this exception allocates, too
                throw;
            }
            fails_at = 0;
            const long left = in_use - before;
            if (left != 0 || !is_right) {
                INFO("allocation " << at << (all ? " and all later ones" : ""));
                CHECK(left == 0);
                CHECK(is_right);
            }
            if (failed == 0) break;
            ++reached;
        }
    return reached;
}

}  // namespace failing_new

// Outlined, so that compilers do not match `free` with `new`.
#if defined(__GNUC__)
#define OPERATOR __attribute__((noinline))
#else
#define OPERATOR
#endif
OPERATOR void* operator new(std::size_t n) {
    return failing_new::allocate_or_throw(n);
}
OPERATOR void* operator new[](std::size_t n) {
    return failing_new::allocate_or_throw(n);
}
OPERATOR void* operator new(std::size_t n, const std::nothrow_t&) noexcept {
    return failing_new::allocate(n);
}
OPERATOR void* operator new[](std::size_t n, const std::nothrow_t&) noexcept {
    return failing_new::allocate(n);
}
OPERATOR void* operator new(std::size_t n, std::align_val_t a) {
    return failing_new::allocate_or_throw(n, static_cast<std::size_t>(a));
}
OPERATOR void* operator new[](std::size_t n, std::align_val_t a) {
    return failing_new::allocate_or_throw(n, static_cast<std::size_t>(a));
}
OPERATOR void operator delete(void* p) noexcept {
    failing_new::release(p);
}
OPERATOR void operator delete[](void* p) noexcept {
    failing_new::release(p);
}
OPERATOR void operator delete(void* p, std::size_t) noexcept {
    failing_new::release(p);
}
OPERATOR void operator delete[](void* p, std::size_t) noexcept {
    failing_new::release(p);
}
OPERATOR void operator delete(void* p, const std::nothrow_t&) noexcept {
    failing_new::release(p);
}
OPERATOR void operator delete[](void* p, const std::nothrow_t&) noexcept {
    failing_new::release(p);
}
OPERATOR void operator delete(void* p, std::align_val_t) noexcept {
    failing_new::release(p);
}
OPERATOR void operator delete[](void* p, std::align_val_t) noexcept {
    failing_new::release(p);
}
OPERATOR void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
    failing_new::release(p);
}
OPERATOR void operator delete[](void* p, std::size_t, std::align_val_t) noexcept {
    failing_new::release(p);
}
#undef OPERATOR
