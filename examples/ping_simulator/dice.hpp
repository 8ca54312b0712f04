// Random numbers from the standard library's engine, which is portable. Its distributions are not, hence these.
#pragma once

#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <random>

namespace pings {

class dice {
  public:
    /// @param item  index of the chip in the run with this seed
    dice(std::uint64_t seed, std::uint64_t item) {
        std::seed_seq words{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                            static_cast<std::uint32_t>(item), static_cast<std::uint32_t>(item >> 32)};
        engine_.seed(words);
    }
    /// Uniform in (0, 1).
    double uniform() { return (static_cast<double>(engine_() >> 12) + 0.5) * 0x1p-52; }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    std::size_t below(std::size_t count) { return static_cast<std::size_t>(uniform() * static_cast<double>(count)); }
    /// A circular complex Gaussian number of unit power.
    std::complex<double> gaussian() {
        // One draw a statement: compilers evaluate arguments in different orders.
        const double phase = uniform(0, 2 * std::numbers::pi);
        return std::polar(std::sqrt(-std::log(uniform())), phase);
    }

  private:
    std::mt19937_64 engine_;
};

}  // namespace pings
