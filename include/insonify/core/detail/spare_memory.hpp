// Memory that was given back, for who asks for as much next.
//
// The system clears every page before it hands it out, and what is freed in large pieces goes back to it. Where
// pictures are made one after another, in new memory each time, that is up to a third of the time. So a thread holds on
// to the blocks that it gives back; together with what it has in use, never to more than half as much again as it has
// had in use at once. The half is for what comes and goes within a picture: without it, that would drive out what the
// picture's peak needs.
#pragma once

#include <insonify/core/detail/portable.hpp>
#include <insonify/core/error.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

/// Blocks as they come from the system and go back to it. Before its first byte each knows how much it holds.
struct memory_block {
    static constexpr std::size_t least = std::size_t{1} << 16;  ///< bytes that are worth a block
    static constexpr std::size_t page = std::size_t{1} << 21;   ///< a large one, which the system clears in one go
    static constexpr std::size_t alignment = 64;                ///< at least

    /// How much a block for so many bytes, `least` of them, holds. Sizes that differ by less than a third mostly get
    /// the same, as those of a data set's pictures do; what nobody touches of it costs nothing.
    static std::size_t rounded(std::size_t bytes) {
        const std::size_t step = std::bit_floor(bytes) / 2;
        return (bytes + step - 1) / step * step;
    }
    /// How much a block holds.
    static std::size_t size_of(const void* memory) {
        std::size_t size;
        std::memcpy(&size, static_cast<const char*>(memory) - sizeof size, sizeof size);
        return size;
    }

    // Not inlined: compilers that see through both doubt that what is freed is what was allocated.

    /// @throws std::bad_alloc
    INSONIFY_RARE static void* allocate(std::size_t bytes) {
        const std::size_t size = rounded(bytes);
        char* const memory = is_paged(size) ? map(size, bytes) : new_bytes(alignment, size, alignment);
        std::memcpy(memory - sizeof size, &size, sizeof size);
        return memory;
    }

    INSONIFY_RARE static void free(void* memory) noexcept {
        const std::size_t size = size_of(memory);
        char* const first = static_cast<char*>(memory);
        if (!is_paged(size)) return ::operator delete (first - alignment, std::align_val_t{alignment});
#if defined(__linux__)
        ::munmap(first - margin, margin + size);
#else
        ::operator delete (first - page, std::align_val_t{page});
#endif
    }

  private:
    static constexpr std::size_t margin = std::size_t{1} << 16;  ///< before mapped blocks; no system's pages are larger

    /// At least two large pages, of which the first and the last waste one at most.
    static bool is_paged(std::size_t bytes) {
        return bytes >= 2 * page;
    }

    static char* new_bytes(std::size_t before, std::size_t size, std::size_t aligned_to) {
        return static_cast<char*>(::operator new (before + size, std::align_val_t{aligned_to})) + before;
    }
    /// @param used  of its bytes, from the first on
    static char* map(std::size_t size, std::size_t used) {
#if defined(__linux__)
        const std::size_t all = margin + size + page;
        void* const mapped = ::mmap(nullptr, all, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (mapped == MAP_FAILED) raise(std::bad_alloc());
        char* const start = static_cast<char*>(mapped);
        const std::size_t past = numeric::bit_cast<std::uintptr_t>(start + margin) % page;
        const std::size_t before = past == 0 ? 0 : page - past, after = page - before;
        if (before > 0) ::munmap(start, before);
        if (after > 0) ::munmap(start + all - after, after);
        char* const memory = start + before + margin;
#if defined(MADV_HUGEPAGE)
        ::madvise(memory, used / page * page, MADV_HUGEPAGE);  // refused, it is memory all the same
#endif
        return memory;
#else
        static_cast<void>(used);
        return new_bytes(page, size, page);
#endif
    }
};

/// The blocks that one thread keeps.
class spare_memory {
  public:
    /// The calling thread's, or null at its end.
    static spare_memory* mine() {
        static thread_local bool is_over = false;
        struct keeper {
            spare_memory memory;
            bool& over;
            ~keeper() {
                over = true;
                memory.release();
            }
        };
        if (is_over) return nullptr;
        static thread_local keeper kept{{}, is_over};
        return &kept.memory;
    }

    /// Memory for so many bytes: of 4 MB and more, at the beginning of a large page. It may hold twice as many.
    /// @throws std::bad_alloc
    void* take(std::size_t bytes) {
        const std::size_t least = memory_block::rounded(bytes);
        const int spare = closest(least);
        void* memory = nullptr;
        if (spare < count_) {
            memory = drop(spare);
        } else {
            const std::size_t most = (std::max)(most_, in_use_ + least);
            while (count_ > 0 && kept_ + in_use_ + least > limit(most)) free(0);
            memory = memory_block::allocate(bytes);
        }
        in_use_ += memory_block::size_of(memory);
        most_ = (std::max)(most_, in_use_);
        return memory;
    }

    /// Takes back what `take`, of any thread, gave.
    void give(void* memory) noexcept {
        const std::size_t size = memory_block::size_of(memory);
        in_use_ -= (std::min)(in_use_, size);
        if (count_ == most_blocks || kept_ + in_use_ + size > limit(most_)) return memory_block::free(memory);
        blocks_[count_++] = {memory, size};
        kept_ += size;
    }

    /// Bytes that are waiting.
    std::size_t kept() const { return kept_; }

    void release() noexcept {
        while (count_ > 0) free(0);
        most_ = in_use_;
    }

  private:
    struct block {
        void* memory;
        std::size_t size;
    };

    static std::size_t limit(std::size_t most) { return most + most / 2; }

    /// The smallest block of so many bytes to twice as many; `count_` if there is none.
    int closest(std::size_t least) const {
        int best = count_;
        for (int i = 0; i < count_; ++i) {
            const std::size_t size = blocks_[i].size;
            if (size >= least && size <= 2 * least && (best == count_ || size < blocks_[best].size)) best = i;
        }
        return best;
    }
    void free(int i) noexcept { memory_block::free(drop(i)); }
    void* drop(int i) noexcept {
        const block dropped = blocks_[i];
        std::copy(blocks_ + i + 1, blocks_ + count_, blocks_ + i);
        --count_;
        kept_ -= dropped.size;
        return dropped.memory;
    }

    static constexpr int most_blocks = 64;
    block blocks_[most_blocks]{};  ///< who waits longest first
    int count_ = 0;
    std::size_t kept_ = 0;    ///< bytes of all blocks
    std::size_t in_use_ = 0;  ///< taken by this thread and not given back to it
    std::size_t most_ = 0;    ///< that was in use at once
};

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Gives back to the system what the calling thread has kept of memory for its next picture. A thread keeps blocks of
/// 64 KB and more, together with what it has in use never more than half as much again as it has had in use at once;
/// its end releases them, too.
inline void release_memory() noexcept {
    if (detail::spare_memory* const spare = detail::spare_memory::mine()) spare->release();
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify
