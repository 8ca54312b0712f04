// Executor with scratch memory, for callers who render frame after frame.
#pragma once

#include <insonify/core/detail/block_pool.hpp>
#include <insonify/core/executor.hpp>

#include <memory>

namespace insonify {
inline namespace INSONIFY_ABI {

/// Pass one in place of the executor: the renderers' large temporaries, and the images that renderers and pixel
/// filters return, take their memory from it and return it when they are destroyed, so that the next frame finds it
/// mapped. Without one, every frame allocates afresh.
///
///     in::thread_pool pool;
///     in::context context(pool);
///     for (const in::scene& scene : scenes) save(in::render(scene, rig, {}, context));
///
/// Results are ordinary values: they may outlive the context and be destroyed on another thread. Copies of them
/// allocate afresh. What is kept never exceeds 1.5 times the peak in use.
class context {
  public:
    /// Runs everything on the calling thread.
    INSONIFY_TAGGED context() : context(serial()) {}
    /// @param ex  runs the loops; has to outlive the context
    template <executor E>
        requires(!std::same_as<std::remove_const_t<E>, context>)
    INSONIFY_TAGGED explicit context(E& ex) : executor_(ex), memory_(std::make_shared<detail::block_pool>()) {}

    ~context() { release(); }
    context(const context&) = delete;
    context& operator=(const context&) = delete;

    template <std::invocable<std::size_t> Fn>
    INSONIFY_TAGGED void bulk(std::size_t count, Fn&& fn) const {
        executor_.bulk(count, fn);
    }

    /// Frees the memory that no image uses.
    INSONIFY_TAGGED void release() noexcept { memory_->release(); }
    /// Bytes of free blocks that are kept for the next frame.
    INSONIFY_TAGGED std::size_t kept_bytes() const noexcept { return memory_->kept_bytes(); }

    const detail::shared_pool& memory() const { return memory_; }

  private:
    INSONIFY_TAGGED static const serial_executor& serial() {
        static constexpr serial_executor instance;
        return instance;
    }

    executor_ref executor_;
    detail::shared_pool memory_;
};

}  // namespace INSONIFY_ABI
}  // namespace insonify
