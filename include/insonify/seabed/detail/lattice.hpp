// World-fixed lattices: cell coordinates of positions, and random bits by cell.
//
// Random draws are keyed by lattice cell, so that a position has the same relief in any grid, tile or order of
// evaluation. Cells are computed in double and only fractions of a cell in float: precision at 10^7 m from the origin
// is that at the origin.
//
// Based on: Guy L. Steele, Doug Lea, Christine H. Flood. Fast Splittable Pseudorandom Number Generators. OOPSLA, 2014
// (the finaliser "variant 13"). Chris Wellons. Prospecting for Hash Functions. 2018 (the 32-bit finaliser "lowbias32").
#pragma once

#include <insonify/core/numeric.hpp>
#include <insonify/core/random.hpp>
#include <insonify/core/simd/dispatch.hpp>
#include <insonify/core/simd/elementary.hpp>
#include <insonify/core/simd/lanes.hpp>
#include <insonify/seabed/model.hpp>

#include <array>
#include <cstdint>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed::detail::inline INSONIFY_FLAGS {

using insonify::detail::dispatch;
using insonify::detail::lanes;

/// Random streams: every layer of every model has its own.
enum class stream : std::uint32_t {
    sand = 0x5EAB0000,
    ripples,
    mud,
    mounds,
    outcrops,
    blocks,
    rubble,
    mask,
    second_ripples,
    trawls,
    survey,
};

constexpr std::uint64_t scramble(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

/// 64 random bits for each cell of a plane: a pure function of (seed, stream, layer, column, row). Philox draws the
/// key. Two finalisers hash the cell, five times cheaper than Philox; that of the row is evaluated once per row.
class cell_hash {
  public:
    cell_hash(std::uint64_t seed, stream purpose, std::uint32_t layer = 0) {
        const philox_key key = stream_key(seed, static_cast<std::uint32_t>(purpose) + (layer << 8));
        key_ = (std::uint64_t{key[1]} << 32) | key[0];
    }

    class row {
      public:
        row() = default;
        explicit row(std::uint64_t key) : key_(key) {}
        std::uint64_t operator()(std::int64_t column) const {
            return scramble(key_ + static_cast<std::uint64_t>(column) * 0x9E3779B97F4A7C15u);
        }
        /// 32 bits for each of several columns at once, from the last 32 bits of their indices, so with a period of
        /// 2^32 columns. They differ from those above.
        template <class Columns>
        INSONIFY_INLINE void hash_lanes(Columns& bits, const Columns& columns) const {
            bits = columns ^ static_cast<std::uint32_t>(key_);
            bits = (bits ^ (bits >> 16)) * 0x7FEB352Du;
            bits = bits + static_cast<std::uint32_t>(key_ >> 32);
            bits = (bits ^ (bits >> 15)) * 0x846CA68Bu;
            bits = bits ^ (bits >> 16);
        }

      private:
        std::uint64_t key_ = 0;
    };
    row operator[](std::int64_t index) const {
        return row(scramble(key_ + static_cast<std::uint64_t>(index) * 0xD1342543DE82EF95u));
    }

  private:
    std::uint64_t key_;
};

/// Two numbers in [-1, 1) from 64 bits.
struct signed_pair {
    float a, b;
    explicit constexpr signed_pair(std::uint64_t bits)
        : a(static_cast<float>(static_cast<std::int32_t>(static_cast<std::uint32_t>(bits))) * 0x1p-31f),
          b(static_cast<float>(static_cast<std::int32_t>(bits >> 32)) * 0x1p-31f) {}
};

/// A square lattice laid over the world, in cells per metre and cells of offset.
struct lattice {
    double frequency = 1;
    double offset_x = 0, offset_y = 0;

    /// Shifted by its own hash, so that the lattice lines of a sum's layers do not coincide.
    static lattice shifted(double cell, const cell_hash& hash) {
        const signed_pair shift(hash[0x7FFFFFFF](0x7FFFFFFF));
        return {1 / cell, static_cast<double>(shift.a), static_cast<double>(shift.b)};
    }
    double u(double x) const { return x * frequency + offset_x; }
    double v(double y) const { return y * frequency + offset_y; }
};

/// The nearest length of eight bits. Its multiples are exact, so that nodes at multiples of it are the same in every
/// row.
inline double rounded_to_eight_bits(double length) {
    double unit = 1;
    while (unit * 256 <= length) unit *= 2;
    while (unit * 128 > length) unit /= 2;
    return static_cast<double>(numeric::floor_to_int(length / unit + 0.5)) * unit;
}

/// A coordinate on a lattice: its cell and the fraction within it.
struct lattice_coordinate {
    std::int64_t cell;
    float fraction;
    explicit lattice_coordinate(double cells)
        : cell(numeric::floor_to_int(cells)), fraction(static_cast<float>(cells - static_cast<double>(cell))) {}
};

/// The part of a row that is processed at a time: its positions, padded with the last to whole vectors.
struct stretch {
    static constexpr std::size_t padded = chunk;  // which is a multiple of every lane count

    double y, spacing;
    double grid_spacing;                       ///< see scanline
    std::size_t count;                         ///< at least 1
    alignas(32) std::array<double, padded> x;  ///< rising

    stretch(const scanline& line, std::size_t samples)
        : y(line.y), spacing(line.spacing), grid_spacing(line.grid_spacing), count(samples) {
        // The positions of line.x(i); four independent sums hide the latency of the additions.
        auto number = static_cast<double>(line.first);
        for (std::size_t i = 0; i < whole(); i += 4, number += 4) {
            x[i] = line.origin + line.spacing * number;
            x[i + 1] = line.origin + line.spacing * (number + 1);
            x[i + 2] = line.origin + line.spacing * (number + 2);
            x[i + 3] = line.origin + line.spacing * (number + 3);
        }
        for (std::size_t i = count; i < whole(); ++i) x[i] = x[count - 1];
    }
    /// The count rounded up to whole vectors.
    std::size_t whole() const { return (count + 15) & ~std::size_t{15}; }
    double last() const { return x[count - 1]; }

    /// The samples that may lie in [low, high], rounded outwards to whole vectors.
    struct range {
        std::size_t begin, end;
    };
    range within(double low, double high) const {
        const double n = static_cast<double>(count), per_metre = 1 / (std::max)(spacing, 1e-9);
        const double first = (low - x[0]) * per_metre - 1, past = (high - x[0]) * per_metre + 2;
        if (first >= n || past <= 0) return {0, 0};
        const auto begin = first > 0 ? static_cast<std::size_t>(first) : 0;
        const auto end = past < n ? static_cast<std::size_t>(past) : count;
        return {begin & ~std::size_t{15}, (end + 15) & ~std::size_t{15}};
    }
};

/// A float for each position of a stretch.
struct alignas(32) stretch_values : std::array<float, stretch::padded> {};

/// Cuts a row into stretches, calls `fill(stretch, values)` for each, which writes or adds to whole vectors of values
/// that begin at 0, and copies them out.
template <class Fill>
void by_stretches(const scanline& line, std::span<float> heights, Fill&& fill) {
    for (std::size_t i = 0; i < heights.size(); i += chunk) {
        const stretch part(line.from(i), (std::min)(chunk, heights.size() - i));
        stretch_values values{};
        fill(part, values);
        std::copy_n(values.begin(), part.count, heights.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

/// Kernel that calls `model.add_lanes<N>(part, values)`: adds a model's relief along a stretch to its values.
template <class Model>
struct relief_kernel {
    static constexpr int widest = 16;

    const Model& model;
    const stretch& part;
    float* values;

    template <int N>
    INSONIFY_INLINE void run() const {
        model.template add_lanes<N>(part, values);
    }
};

template <class Model>
void add_relief(const Model& model, const stretch& part, stretch_values& values, isa level) {
    dispatch(relief_kernel<Model>{model, part, values.data()}, level);
}

/// Concatenates two halves.
template <int N, class Whole, class Half>
INSONIFY_INLINE void join(Whole& into, const Half& low, const Half& high) {
#if INSONIFY_SIMD
    [&]<int... I>(std::integer_sequence<int, I...>) INSONIFY_INLINE_LAMBDA {
        into = __builtin_shufflevector(low, high, I...);
    }
    (std::make_integer_sequence<int, N>{});
#else
    static_cast<void>(high);
    into = low;
#endif
}

/// N positions on a lattice: fractions within their cells, in [0, 1], and indices of the cells, counted from `first`.
template <int N>
INSONIFY_INLINE void locate(lanes<float, N>& across, lanes<std::int32_t, N>& cell, const double* x, double frequency,
                            double offset, double first) {
    if constexpr (N == 1) {
        double floor;
        const double u = *x * frequency + offset;
        insonify::detail::floor_lanes<1>(floor, u);
        cell = static_cast<std::int32_t>(floor - first);
        across = static_cast<float>(u - floor);
    } else {
        constexpr int half = N / 2;
        lanes<float, half> part[2];
        lanes<std::int32_t, half> index[2];
        for (int k = 0; k < 2; ++k) {
            lanes<double, half> u, floor;
            insonify::detail::load(u, x + k * half);
            u = u * frequency + offset;
            insonify::detail::floor_lanes<half>(floor, u);
            insonify::detail::convert(index[k], lanes<double, half>(floor - first));
            insonify::detail::convert(part[k], lanes<double, half>(u - floor));
        }
        join<N>(across, part[0], part[1]);
        join<N>(cell, index[0], index[1]);
    }
}

/// x[i] frequency + offset for N positions, rounded to float: the sum has to be small.
template <int N>
INSONIFY_INLINE void offsets(lanes<float, N>& into, const double* x, double frequency, double offset) {
    if constexpr (N == 1) {
        into = static_cast<float>(*x * frequency + offset);
    } else {
        constexpr int half = N / 2;
        lanes<float, half> part[2];
        for (int k = 0; k < 2; ++k) {
            lanes<double, half> u;
            insonify::detail::load(u, x + k * half);
            u = u * frequency + offset;
            insonify::detail::convert(part[k], u);
        }
        join<N>(into, part[0], part[1]);
    }
}

/// Perlin's quintic: from 0 to 1, first and second derivatives 0 at both ends.
template <class T>
INSONIFY_INLINE constexpr void fade(T& into, const T& t) {
    into = t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}
constexpr float fade(float t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
}
/// Catmull-Rom interpolation from the second (t = 0) to the third (t = 1) of four values.
template <class T>
INSONIFY_INLINE void catmull_rom(T& into, const T (&p)[4], const T& t) {
    const T b = 0.5f * (p[2] - p[0]), c = p[0] - 2.5f * p[1] + 2.0f * p[2] - 0.5f * p[3],
            d = 0.5f * (p[3] - p[0]) + 1.5f * (p[1] - p[2]);
    into = p[1] + t * (b + t * (c + t * d));
}
constexpr float mix(float a, float b, float t) {
    return a + t * (b - a);
}
[[nodiscard]] constexpr float clamp01(float t) {
    return t < 0 ? 0 : t > 1 ? 1 : t;
}
/// (1 - r^2)^2: 1 in the middle; its value and slope are 0 from a distance of 1 on.
template <class T>
constexpr T brush(T r) {
    const T inside = r * r < 1 ? 1 - r * r : T(0);
    return inside * inside;
}
template <class Lanes>
INSONIFY_INLINE void clamp_lanes(Lanes& t) {
    const Lanes zero{}, one = zero + 1.0f;
    t = t > 0.0f ? t : zero;
    t = t < 1.0f ? t : one;
}

}  // namespace seabed::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
