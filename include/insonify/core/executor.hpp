// Executors run the library's parallel loops. An executor is an argument, serial by default; the library starts no
// threads.
#pragma once

#include <insonify/core/detail/block_pool.hpp>
#include <insonify/core/error.hpp>

#include <concepts>
#include <cstddef>
#include <type_traits>

namespace insonify {
inline namespace INSONIFY_ABI {

/// `ex.bulk(count, fn)` calls `fn(i)` once for every i in [0, count), in any order and on any thread, and returns when
/// all calls have returned. If calls throw, it waits for those that run and rethrows one of the exceptions; calls that
/// have not begun may be skipped. No result of the library depends on which executor ran it.
template <class E>
concept executor = requires(E& ex, void (*fn)(std::size_t)) {
    ex.bulk(std::size_t{}, fn);
};

/// Runs everything on the calling thread, in order.
struct serial_executor {
    template <std::invocable<std::size_t> Fn>
    INSONIFY_MEMBER void bulk(std::size_t count, Fn&& fn) const {
        for (std::size_t i = 0; i < count; ++i) fn(i);
    }
};

/// Accepts temporaries, as in the default argument `Executor&& ex = serial_executor{}`.
template <class E>
concept executor_argument = executor<std::remove_reference_t<E>>;

namespace detail::inline INSONIFY_FLAGS {

/// The scratch memory of an executor that is a context; null for others.
template <class E>
shared_pool memory_of(const E& ex) {
    if constexpr (requires { shared_pool(ex.memory()); }) return ex.memory();
    return {};
}

}  // namespace detail::inline INSONIFY_FLAGS

/// Type-erased reference to an executor: functions that take it are compiled once, at the cost of one indirect call per
/// index. The executor has to outlive it.
class executor_ref {
  public:
    template <executor E>
        requires(!std::same_as<std::remove_const_t<E>, executor_ref>)
    INSONIFY_TAGGED executor_ref(E& ex)
        : executor_(&ex),
          bulk_([](const void* to, std::size_t count, call_type call, const void* fn) {
              const_cast<E*>(static_cast<const E*>(to))->bulk(count, [=](std::size_t i) { call(fn, i); });
          }),
          memory_(detail::memory_of(ex)) {}

    template <std::invocable<std::size_t> Fn>
    INSONIFY_TAGGED void bulk(std::size_t count, Fn&& fn) const {
        using function = std::remove_reference_t<Fn>;
        if constexpr (std::is_function_v<function>)
            bulk(count, &fn);
        else
            bulk_(
                executor_, count,
                [](const void* to, std::size_t i) { (*const_cast<function*>(static_cast<const function*>(to)))(i); },
                &fn);
    }

    const detail::shared_pool& memory() const { return memory_; }

  private:
    using call_type = void (*)(const void* fn, std::size_t i);

    const void* executor_;
    void (*bulk_)(const void* to, std::size_t count, call_type call, const void* fn);
    detail::shared_pool memory_;
};

inline namespace INSONIFY_FLAGS {

/// Splits [0, count) into runs of `grain` and calls `fn(first, last)` for each. The split depends on the arguments
/// alone, so that sums per run are the same on any executor.
template <executor E, std::invocable<std::size_t, std::size_t> Fn>
void bulk_ranges(E& ex, std::size_t count, std::size_t grain, Fn&& fn) {
    detail::require(grain > 0, "grain", grain, "at least 1");
    ex.bulk(count / grain + (count % grain != 0 ? 1 : 0), [&](std::size_t run) {
        const std::size_t first = run * grain;
        fn(first, count - first < grain ? count : first + grain);
    });
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify
