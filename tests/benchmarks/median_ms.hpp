// The time of a piece of work.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>

/// Median of nine runs, in milliseconds.
template <class Fn>
double median_ms(const Fn& work) {
    std::array<double, 9> times{};
    for (double& time : times) {
        const auto start = std::chrono::steady_clock::now();
        work();
        time = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    }
    std::nth_element(times.begin(), times.begin() + 4, times.end());
    return times[4];
}
