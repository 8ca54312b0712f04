// Smooth noise: drift of gain from ping to ping, and of the seabed's brightness.
//
// Standard normal numbers at the nodes of a lattice, blended with weights whose squares sum to one, so that the
// variance is one everywhere. Each value is a function of (key, position).
#pragma once

#include <insonify/core/random.hpp>

#include <cstdint>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Random streams of smooth fields. Changing one changes the results of every seed.
enum class drift_stream : std::uint32_t {
    range_gain = 0x64726900,
    ping_gain,
    ping_jitter,
    surface,
    tone,
    streaks,
    patches
};

/// The nodes around a position, and their weights.
struct lattice_place {
    std::int64_t node;
    double low, high;  // weights, whose squares sum to one

    explicit lattice_place(double position) : node(numeric::floor_to_int(position)) {
        const double t = position - static_cast<double>(node), s = t * t * (3 - 2 * t);
        const double norm = 1 / numeric::square_root(s * s + (1 - s) * (1 - s));
        low = (1 - s) * norm, high = s * norm;
    }
};

inline double lattice_normal(std::int64_t i, std::int64_t j, std::uint32_t layer, const philox_key& key) {
    const auto row = static_cast<std::uint64_t>(j);
    const philox_counter word = philox4x32(
        {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(row >> 32), layer},
        key);
    return normal_pair(word[0], word[1])[0];
}

/// Mean 0 and variance 1. Values at least two nodes apart are independent.
inline double smooth_noise(double position, const philox_key& key) {
    const lattice_place p(position);
    return p.low * lattice_normal(p.node, 0, 0, key) + p.high * lattice_normal(p.node + 1, 0, 0, key);
}

/// The same over a plane.
inline double smooth_noise(double x, double y, std::uint32_t layer, const philox_key& key) {
    const lattice_place p(x), q(y);
    const auto at = [&](int i, int j) { return lattice_normal(p.node + i, q.node + j, layer, key); };
    return q.low * (p.low * at(0, 0) + p.high * at(1, 0)) + q.high * (p.low * at(0, 1) + p.high * at(1, 1));
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
