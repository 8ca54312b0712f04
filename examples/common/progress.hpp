// A progress bar with rate and remaining time, drawn only on terminals.
#pragma once

#include <chrono>
#include <cstdio>
#include <mutex>
#include <string>

#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#endif

namespace examples {

/// Counts finished items from any thread and draws itself on standard error.
class progress {
  public:
    explicit progress(std::size_t total) : total_(total), start_(clock::now()) {
#if defined(__unix__) || defined(__APPLE__)
        shown_ = ::isatty(STDERR_FILENO) != 0;
#endif
    }
    ~progress() {
        if (shown_) std::fputs("\r\033[K", stderr);
    }
    progress(const progress&) = delete;
    progress& operator=(const progress&) = delete;

    void finished_one() {
        const std::lock_guard lock(mutex_);
        ++done_;
        if (!shown_) return;
        const double seconds = elapsed(), rate = static_cast<double>(done_) / seconds;
        const double left = static_cast<double>(total_ - done_) / rate;
        const std::size_t filled = 30 * done_ / total_;
        std::string bar(30, '.');
        bar.replace(0, filled, filled, '#');
        std::fprintf(stderr, "\r\033[K[%s] %zu/%zu  %.2f/s  %d:%02d left", bar.c_str(), done_, total_, rate,
                     static_cast<int>(left) / 60, static_cast<int>(left) % 60);
        std::fflush(stderr);
    }

    std::size_t done() const {
        return done_;
    }
    /// Seconds since the start.
    double elapsed() const {
        return std::chrono::duration<double>(clock::now() - start_).count();
    }

  private:
    using clock = std::chrono::steady_clock;
    std::size_t total_, done_ = 0;
    clock::time_point start_;
    std::mutex mutex_;
    bool shown_ = false;
};

}  // namespace examples
