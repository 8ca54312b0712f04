// Noise for broken edges, relief and decay of objects.
#pragma once

#include <insonify/core/numeric.hpp>
#include <insonify/core/random.hpp>

#include <cstdint>

#include <glm/vec3.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Value noise on the integer lattice, in [-1, 1], continuous with its slope.
inline double lattice_noise(const glm::dvec3& p, const philox_key& key) {
    std::int64_t cell[3];
    double weight[3];
    for (int i = 0; i < 3; ++i) {
        cell[i] = numeric::floor_to_int(p[i]);
        const double t = p[i] - static_cast<double>(cell[i]);
        weight[i] = t * t * (3 - 2 * t);
    }
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        philox_counter at{};
        double share = 1;
        for (int i = 0; i < 3; ++i) {
            const int step = (corner >> i) & 1;
            at[static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(cell[i] + step);
            share *= step == 1 ? weight[i] : 1 - weight[i];
        }
        sum += share * (2 * uniform_open(philox4x32(at, key)[0]) - 1);
    }
    return sum;
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
