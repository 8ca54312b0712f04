// The larger of two errors, where NaN counts as infinite: std::max would pass over it.
#pragma once

#include <limits>

inline double larger(double worst, double error) {
    return error <= worst ? worst : error > worst ? error : std::numeric_limits<double>::infinity();
}
