// What a setting costs: processor time, and memory at its peak.
#pragma once

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <vector>

namespace cost {

/// Bytes that are allocated, now and at most since `forget_peak`; main.cpp's operators new and delete count them.
inline std::size_t allocated = 0, peak = 0;

/// Milliseconds that this process has kept a processor busy. What else runs on the machine doesn't count.
inline double busy_ms() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

struct figures {
    double ms = 1e30;  ///< the least of all runs
    double mebibytes = 0;

    /// Runs something once more.
    template <class Work>
    void run(const Work& work) {
        const std::size_t before = peak = allocated;
        const double start = busy_ms();
        work();
        ms = std::min(ms, busy_ms() - start);
        mebibytes = static_cast<double>(peak - before) / 1048576;
    }
};

}  // namespace cost
