// Pool of large memory blocks, reused from frame to frame.
//
// The operating system maps and clears fresh pages, which takes up to half the time of a frame of 2048 x 2048 pixels.
// A pool keeps freed blocks instead. A `context` and the arrays that allocate from its pool share ownership of it, so
// images may outlive their context.
#pragma once

#include <insonify/config.hpp>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <memory>
#include <new>

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail {

/// Thread-safe: frames are often destroyed on a thread other than the one that rendered them.
class block_pool {
  public:
    static constexpr std::size_t min_bytes = std::size_t{1} << 16;  ///< smaller blocks are left to the allocator
    static constexpr std::size_t alignment = 64;

    block_pool() = default;
    block_pool(const block_pool&) = delete;
    block_pool& operator=(const block_pool&) = delete;
    INSONIFY_TAGGED ~block_pool() { release(); }

    /// A block of at least `bytes` bytes: the latest kept one of the same size class, or a new one.
    /// @throws std::bad_alloc
    INSONIFY_TAGGED void* allocate(std::size_t bytes) {
        const std::size_t size = size_class(bytes);
        void* memory = take_kept(size);
        if (memory == nullptr) memory = fresh_block(size);
        const guard lock(busy_);
        in_use_ += size;
        peak_ = (std::max)(peak_, in_use_);
        return memory;
    }

    /// Keeps a block for later if kept blocks and those in use then total at most 1.5 times the peak since the last
    /// release. The oldest kept blocks are freed to make room, and this one if that is not enough.
    INSONIFY_TAGGED void deallocate(void* memory, std::size_t bytes) noexcept {
        const std::size_t size = size_class(bytes);
        const guard lock(busy_);
        in_use_ -= size;
        while (count_ > 0 && (count_ == max_blocks || kept_ + in_use_ + size > peak_ + peak_ / 2)) free_oldest();
        if (kept_ + in_use_ + size > peak_ + peak_ / 2) return free_block(memory);
        blocks_[count_++] = {memory, size};
        kept_ += size;
    }

    /// Frees the kept blocks and resets the peak: a block in use is then freed, not kept, when it is returned, unless
    /// more memory comes into use first.
    INSONIFY_TAGGED void release() noexcept {
        const guard lock(busy_);
        while (count_ > 0) free_oldest();
        peak_ = 0;
    }

    INSONIFY_TAGGED std::size_t kept_bytes() const noexcept {
        const guard lock(busy_);
        return kept_;
    }

    /// Two classes an octave: images of nearly the same size, as in a data set, share their blocks.
    /// @pre bytes >= 2
    INSONIFY_TAGGED static std::size_t size_class(std::size_t bytes) {
        const std::size_t step = std::bit_floor(bytes) / 2;
        return (bytes + step - 1) / step * step;
    }

  private:
    struct block {
        void* memory;
        std::size_t size;
    };
    struct guard {
        std::atomic_flag& busy;

        INSONIFY_TAGGED explicit guard(std::atomic_flag& flag) : busy(flag) {
            while (busy.test_and_set(std::memory_order_acquire)) {
            }
        }
        guard(const guard&) = delete;
        INSONIFY_MEMBER ~guard() { busy.clear(std::memory_order_release); }
    };

    INSONIFY_TAGGED void* take_kept(std::size_t size) noexcept {
        const guard lock(busy_);
        for (int i = count_ - 1; i >= 0; --i)
            if (blocks_[i].size == size) return take(i);
        return nullptr;
    }
    INSONIFY_TAGGED static void* new_block(std::size_t size) {
        return ::operator new (size, std::align_val_t{alignment});
    }
    /// A new block. If allocation fails, frees the kept blocks and tries once more.
    INSONIFY_TAGGED void* fresh_block(std::size_t size) {
#if defined(__cpp_exceptions)
        try {
            return new_block(size);
        } catch (const std::bad_alloc&) {
            const guard lock(busy_);
            while (count_ > 0) free_oldest();
        }
#endif
        return new_block(size);
    }
    INSONIFY_TAGGED static void free_block(void* memory) noexcept {
        ::operator delete (memory, std::align_val_t{alignment});
    }

    INSONIFY_TAGGED void* take(int i) noexcept {
        const block taken = blocks_[i];
        std::copy(blocks_ + i + 1, blocks_ + count_, blocks_ + i);
        --count_;
        kept_ -= taken.size;
        return taken.memory;
    }
    INSONIFY_TAGGED void free_oldest() noexcept {
        free_block(take(0));
    }

    static constexpr int max_blocks = 64;

    mutable std::atomic_flag busy_{};
    block blocks_[max_blocks];  ///< oldest first
    int count_ = 0;
    std::size_t kept_ = 0;    ///< bytes of all blocks_
    std::size_t in_use_ = 0;  ///< bytes allocated and not yet deallocated
    std::size_t peak_ = 0;    ///< largest in_use_ that an allocation reached since the last release
};

using shared_pool = std::shared_ptr<block_pool>;

}  // namespace detail
}  // namespace INSONIFY_ABI
}  // namespace insonify
