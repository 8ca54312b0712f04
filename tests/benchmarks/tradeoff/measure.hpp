// Costs of a setting: processor time and peak memory.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <ctime>
#include <string>
#include <vector>

#include "report.hpp"

namespace cost {

/// Bytes allocated now, and the peak since the start of the last run. main.cpp's operators new and delete count them.
inline std::atomic<std::size_t> allocated = 0, peak = 0;

/// Processor time of this process, milliseconds; independent of other load.
inline double busy_ms() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

struct figures {
    double ms = 1e30;  ///< minimum of all runs
    double mebibytes = 0;

    /// Measures one more run.
    template <class Work>
    void run(const Work& work) {
        const std::size_t before = allocated;
        peak = before;
        const double start = busy_ms();
        work();
        ms = std::min(ms, busy_ms() - start);
        mebibytes = static_cast<double>(peak - before) / 1048576;
    }
};

/// Measures the settings of a knob `runs` times, interleaved. `error(i, result)` describes the error of setting i.
template <class Make, class Error>
void measure_knob(int runs, report::contents& into, report::knob k, const std::vector<std::string>& settings,
                  const Make& make, const Error& error) {
    std::vector<figures> costs(settings.size());
    std::vector<std::string> errors(settings.size());
    for (int run = 0; run < runs; ++run)
        for (std::size_t i = 0; i < settings.size(); ++i) {
            auto result = make(i);
            costs[i].run([&] { result = make(i); });
            if (run == 0) errors[i] = error(i, result);
        }
    for (std::size_t i = 0; i < settings.size(); ++i) {
        k.setting = settings[i];
        k.ms = costs[i].ms;
        k.mebibytes = costs[i].mebibytes;
        k.error = errors[i];
        into.knobs.push_back(k);
    }
}

}  // namespace cost

/// Shadows on imported meshes by policy, and the effect of rounding their vertices.
void measure_meshes(int pixels, int runs, report::contents& into);
