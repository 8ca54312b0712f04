// Thread pool as an executor, owned by the caller. The only header that includes <thread>; not in the umbrella header.
#pragma once

#include <insonify/core/executor.hpp>

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace insonify {
inline namespace INSONIFY_ABI {

/// A fixed number of threads that share the calls of one `bulk` at a time; the calling thread is one of them.
/// If the pool is busy, `bulk` runs everything on its calling thread instead of waiting, so that nested calls, also
/// across pools, cannot deadlock.
class thread_pool {
  public:
    /// If the system refuses to start some threads (a limit on processes or memory), the pool works with fewer;
    /// `threads()` returns the number.
    /// @param threads  how many threads share the work, the caller included; 0 means one per hardware thread
    /// @throws invalid_input above 4096
    INSONIFY_TAGGED explicit thread_pool(int threads = 0) {
        detail::require(threads >= 0 && threads <= 4096, "threads", threads, "0 to 4096");
        const unsigned hardware = std::thread::hardware_concurrency();
        const int total = threads > 0 ? threads : hardware > 0 ? static_cast<int>(hardware) : 1;
        workers_.reserve(static_cast<std::size_t>(total - 1));
        start(total - 1);
    }

    INSONIFY_TAGGED ~thread_pool() {
        {
            const std::lock_guard lock(mutex_);
            stopping_ = true;
        }
        work_arrived_.notify_all();
        for (std::thread& worker : workers_) worker.join();
    }

    thread_pool(const thread_pool&) = delete;
    thread_pool& operator=(const thread_pool&) = delete;

    INSONIFY_MEMBER int threads() const { return static_cast<int>(workers_.size()) + 1; }

    template <std::invocable<std::size_t> Fn>
    INSONIFY_TAGGED void bulk(std::size_t count, Fn&& fn) {
        if (count == 0) return;
        if (workers_.empty() || count == 1 || busy_.exchange(true)) return serial_executor{}.bulk(count, fn);

        const auto call = [&fn](std::size_t i) { fn(i); };
        job work{[](const void* callable, std::size_t i) { (*static_cast<decltype(call)*>(callable))(i); }, &call,
                 count};
        {
            const std::lock_guard lock(mutex_);
            job_ = &work;
            generation_.fetch_add(1, std::memory_order_relaxed);
        }
        work_arrived_.notify_all();
        run(work);
        {
            const std::lock_guard lock(mutex_);
            job_ = nullptr;  // late workers find no job
        }
        spin_until([&] { return work.helpers.load(std::memory_order_relaxed) == 0; });
        {
            std::unique_lock lock(mutex_);
            helpers_done_.wait(lock, [&] { return work.helpers == 0; });
        }
        busy_ = false;
        if (work.error) std::rethrow_exception(work.error);
    }

  private:
    struct job {
        void (*call)(const void*, std::size_t);
        const void* callable;
        std::size_t count;
        std::atomic<std::size_t> next{0};
        std::atomic<int> helpers{0};  // workers inside run(); changed under mutex_
        std::mutex error_mutex{};
        std::exception_ptr error{};
    };

    INSONIFY_TAGGED static void run(job& work) {
        for (std::size_t i; (i = work.next.fetch_add(1, std::memory_order_relaxed)) < work.count;) {
#if defined(__cpp_exceptions)
            try {
                work.call(work.callable, i);
            } catch (...) {
                const std::lock_guard lock(work.error_mutex);
                if (!work.error) work.error = std::current_exception();
            }
#else
            work.call(work.callable, i);
#endif
        }
    }

    /// Spins until the condition holds, at most about 100 us. A frame makes some twenty bulk calls, and waking a thread
    /// takes longer than most of the gaps between them.
    template <class Condition>
    INSONIFY_TAGGED static void spin_until(const Condition& condition) {
#if defined(__SSE2__)
        for (int i = 0; i < 2000 && !condition(); ++i) __builtin_ia32_pause();
#else
        (void)condition;
#endif
    }

    /// Starts as many workers as the system allows. No exception may leave here: it would destroy members that workers
    /// already started are using.
    INSONIFY_TAGGED void start(int workers) {
#if defined(__cpp_exceptions)
        try {
            for (int i = 0; i < workers; ++i) workers_.emplace_back([this] { serve(); });
        } catch (...) {  // std::system_error or std::bad_alloc
        }
#else
        for (int i = 0; i < workers; ++i) workers_.emplace_back([this] { serve(); });
#endif
    }

    INSONIFY_TAGGED void serve() {
        std::size_t seen = 0;
        for (;;) {
            spin_until([&] { return generation_.load(std::memory_order_relaxed) != seen; });
            std::unique_lock lock(mutex_);
            work_arrived_.wait(lock, [&] {
                return stopping_ || (job_ != nullptr && generation_.load(std::memory_order_relaxed) != seen);
            });
            if (stopping_) return;
            seen = generation_.load(std::memory_order_relaxed);
            job& work = *job_;
            ++work.helpers;
            lock.unlock();
            run(work);
            lock.lock();
            if (--work.helpers == 0) helpers_done_.notify_all();
        }
    }

    std::vector<std::thread> workers_;
    std::atomic<bool> busy_{false};
    std::mutex mutex_;
    std::condition_variable work_arrived_;
    std::condition_variable helpers_done_;
    job* job_ = nullptr;
    std::atomic<std::size_t> generation_{0};  // changed under mutex_
    bool stopping_ = false;
};

}  // namespace INSONIFY_ABI
}  // namespace insonify
