// World-fixed lattices: coordinates of positions on a lattice, and random bits for each cell.
//
// Random draws are keyed by lattice cell, so that a position has the same relief in any grid, tile or order of
// evaluation. Cells are computed in double and only fractions of a cell in float: for cells of 3 cm or more, precision
// at 10^7 m from the origin is that at the origin.
//
// Based on: Guy L. Steele, Doug Lea, Christine H. Flood. Fast Splittable Pseudorandom Number Generators. OOPSLA, 2014
// (the finaliser "variant 13"). Chris Wellons. Prospecting for Hash Functions. 2018 (the 32-bit finaliser "lowbias32").
#pragma once

#include <insonify/core/numeric.hpp>
#include <insonify/core/random.hpp>
#include <insonify/core/simd/elementary.hpp>
#include <insonify/core/simd/lanes.hpp>

#include <cstdint>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed::detail::inline INSONIFY_FLAGS {

using insonify::detail::lanes;

/// Random streams of the layers of models.
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

/// Two numbers in [-1, 1], from 32 bits each.
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

    /// Shifted by its own hash, so that the lattice lines of different octaves do not coincide.
    static lattice shifted(double cell, const cell_hash& hash) {
        const signed_pair shift(hash[0x7FFFFFFF](0x7FFFFFFF));
        return {1 / cell, static_cast<double>(shift.a), static_cast<double>(shift.b)};
    }
    double u(double x) const { return x * frequency + offset_x; }
    double v(double y) const { return y * frequency + offset_y; }
};

/// A coordinate on a lattice: its cell and the fraction within it.
struct lattice_coordinate {
    std::int64_t cell;
    float fraction;
    explicit lattice_coordinate(double cells)
        : cell(numeric::floor_to_int(cells)), fraction(static_cast<float>(cells - static_cast<double>(cell))) {}
};

}  // namespace seabed::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
