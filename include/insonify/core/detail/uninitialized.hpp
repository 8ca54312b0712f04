// Arrays whose elements start uninitialized, for storage that is overwritten immediately. Blocks of 64 KiB and more can
// come from a context's pool.
#pragma once

#include <insonify/core/detail/array_bytes.hpp>
#include <insonify/core/detail/block_pool.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <utility>

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail {

/// Constructor tag: elements are left uninitialized.
struct uninitialized {};

/// Raw memory, from the pool if there is one and the size is at least 64 KiB, else from the heap.
class memory_block {
  public:
    INSONIFY_MEMBER memory_block() noexcept {}
    INSONIFY_MEMBER explicit memory_block(const shared_pool& pool) : pool_(pool) {}
    /// @throws std::bad_alloc
    INSONIFY_TAGGED memory_block(std::size_t bytes, const shared_pool& pool) : pool_(pool), bytes_(bytes) {
        if (bytes_ == 0) return;
        start_ =
            is_pooled() ? pool_->allocate(bytes_) : ::operator new (bytes_, std::align_val_t{block_pool::alignment});
    }
    INSONIFY_MEMBER memory_block(memory_block&& other) noexcept { swap(other); }
    INSONIFY_MEMBER memory_block& operator=(memory_block other) noexcept {
        swap(other);
        return *this;
    }
    INSONIFY_TAGGED ~memory_block() {
        if (start_ == nullptr) return;
        if (is_pooled())
            pool_->deallocate(start_, bytes_);
        else
            ::operator delete (start_, std::align_val_t{block_pool::alignment});
    }
    INSONIFY_MEMBER void swap(memory_block& other) noexcept {
        std::swap(start_, other.start_);
        std::swap(bytes_, other.bytes_);
        pool_.swap(other.pool_);
    }

    void* start() const { return start_; }
    std::size_t bytes() const { return bytes_; }
    const shared_pool& pool() const { return pool_; }

  private:
    INSONIFY_MEMBER bool is_pooled() const { return pool_ && bytes_ >= block_pool::min_bytes; }

    shared_pool pool_;
    void* start_ = nullptr;
    std::size_t bytes_ = 0;
};

/// An array whose elements are left uninitialized unless they have a constructor. Much less to compile than a vector
/// with an allocator.
template <class T>
class uninitialized_array {
  public:
    using value_type = T;  ///< spans of libc++ 14 are deduced from it

    INSONIFY_MEMBER uninitialized_array() noexcept {}
    INSONIFY_MEMBER explicit uninitialized_array(const shared_pool& pool) : memory_(pool) {}
    INSONIFY_MEMBER explicit uninitialized_array(std::size_t count, const shared_pool& pool = {})
        : uninitialized_array(pool) {
        resize(count);
    }
    INSONIFY_TAGGED uninitialized_array(std::size_t count, const T& value) : uninitialized_array(count) {
        std::fill_n(data(), count, value);
    }
    /// Copies allocate from the heap.
    INSONIFY_TAGGED uninitialized_array(const uninitialized_array& other) : uninitialized_array(other.size_) {
        std::copy_n(other.data(), size_, data());
    }
    INSONIFY_MEMBER uninitialized_array(uninitialized_array&& other) noexcept { swap(other); }
    /// If allocation fails, the array is unchanged.
    INSONIFY_MEMBER uninitialized_array& operator=(uninitialized_array other) noexcept {
        swap(other);
        return *this;
    }
    INSONIFY_MEMBER ~uninitialized_array() { std::destroy_n(data(), size_); }

    /// Discards all elements and creates `count` new ones.
    /// @throws std::bad_alloc
    INSONIFY_TAGGED void resize(std::size_t count) {
        const std::size_t bytes = array_bytes<T>(count);
        std::destroy_n(data(), size_);
        size_ = 0;
        if (bytes > memory_.bytes()) memory_ = memory_block(bytes, memory_.pool());
        std::uninitialized_default_construct_n(data(), count);
        size_ = count;
    }

    INSONIFY_MEMBER T* data() { return static_cast<T*>(memory_.start()); }
    INSONIFY_MEMBER const T* data() const { return static_cast<const T*>(memory_.start()); }
    INSONIFY_MEMBER std::size_t size() const { return size_; }
    INSONIFY_MEMBER bool empty() const { return size_ == 0; }
    INSONIFY_MEMBER T* begin() { return data(); }
    INSONIFY_MEMBER T* end() { return data() + size_; }
    INSONIFY_MEMBER const T* begin() const { return data(); }
    INSONIFY_MEMBER const T* end() const { return data() + size_; }
    INSONIFY_MEMBER T& operator[](std::size_t i) { return data()[i]; }
    INSONIFY_MEMBER const T& operator[](std::size_t i) const { return data()[i]; }

    INSONIFY_TAGGED friend bool operator==(const uninitialized_array& a, const uninitialized_array& b) {
        return a.size_ == b.size_ && std::equal(a.begin(), a.end(), b.begin());
    }

  private:
    static_assert(alignof(T) <= block_pool::alignment);

    INSONIFY_MEMBER void swap(uninitialized_array& other) noexcept {
        memory_.swap(other.memory_);
        std::swap(size_, other.size_);
    }

    memory_block memory_;
    std::size_t size_ = 0;
};

}  // namespace detail
}  // namespace INSONIFY_ABI
}  // namespace insonify
