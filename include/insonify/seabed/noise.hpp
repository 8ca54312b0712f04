// Gradient noise on the world's lattice, and power-law relief made of its octaves.
//
// Along a row, the height of a cell's noise is a fixed pair of lines blended by the fade curve, so hashing and the
// whole y direction are paid for once per cell crossed, not once per sample.
//
// Based on: Ken Perlin. Improving Noise. SIGGRAPH, 2002 (gradients on a lattice, quintic fade).
// Guy L. Steele, Doug Lea, Christine H. Flood. Fast Splittable Pseudorandom Number Generators. OOPSLA, 2014 (the
// finaliser that hashes cells, "variant 13").
#pragma once

#include <insonify/core/numeric.hpp>
#include <insonify/core/random.hpp>
#include <insonify/seabed/recipe.hpp>

#include <cstdint>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::seabed {

namespace detail {

/// What draws are for: every layer of every recipe has its own stream of the seed.
enum class stream : std::uint32_t { sand = 0x5EAB0000, ripples, mud, mounds, ridges, blocks, stones, rubble, mask };

constexpr std::uint64_t scramble(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

/// 64 random bits for each cell of a plane: a pure function of (seed, stream, layer, column, row). Philox draws the
/// key; the cells themselves are hashed by two finalisers, five times cheaper and the row's shared along it.
class cell_hash {
  public:
    cell_hash(std::uint64_t seed, stream purpose, std::uint32_t layer = 0) {
        const philox_key key = stream_key(seed, static_cast<std::uint32_t>(purpose) + (layer << 8));
        key_ = (std::uint64_t{key[1]} << 32) | key[0];
    }

    class row {
      public:
        explicit row(std::uint64_t key) : key_(key) {}
        std::uint64_t operator()(std::int64_t column) const {
            return scramble(key_ + static_cast<std::uint64_t>(column) * 0x9E3779B97F4A7C15u);
        }

      private:
        std::uint64_t key_;
    };
    row operator[](std::int64_t index) const {
        return row(scramble(key_ + static_cast<std::uint64_t>(index) * 0xD1342543DE82EF95u));
    }

  private:
    std::uint64_t key_;
};

/// Two numbers in [-1, 1) from 64 bits.
struct pair_of_bits {
    float a, b;
    explicit constexpr pair_of_bits(std::uint64_t bits)
        : a(static_cast<float>(static_cast<std::int32_t>(static_cast<std::uint32_t>(bits))) * 0x1p-31f),
          b(static_cast<float>(static_cast<std::int32_t>(bits >> 32)) * 0x1p-31f) {}
};

/// A square lattice laid over the world, in cells per metre and cells of offset.
struct lattice {
    double frequency = 1;
    double offset_x = 0, offset_y = 0;

    /// Shifted by its own hash: what is special at lattice lines must not line up over the layers of a sum.
    static lattice shifted(double cell, const cell_hash& hash) {
        const pair_of_bits shift(hash[0x7FFFFFFF](0x7FFFFFFF));
        return {1 / cell, static_cast<double>(shift.a), static_cast<double>(shift.b)};
    }
};

/// Where a coordinate lies on a lattice. The cell is found in double, so what goes to float is the fraction alone.
struct lattice_coordinate {
    std::int64_t cell;
    float fraction;
    explicit lattice_coordinate(double cells)
        : cell(numeric::floor_to_int(cells)), fraction(static_cast<float>(cells - static_cast<double>(cell))) {}
};

/// Walks the cells of a lattice that a row crosses: `enter(cell)` at each change, `visit(i, t)` at each sample, with t
/// in [0, 1] across the cell.
template <class Enter, class Visit>
void walk(const lattice& l, const scanline& line, std::size_t count, Enter&& enter, Visit&& visit) {
    const auto cells = [&](std::size_t i) { return line.x(i) * l.frequency + l.offset_x; };
    for (std::size_t i = 0; i < count;) {
        const std::int64_t cell = numeric::floor_to_int(cells(i));
        const auto begin = static_cast<double>(cell);
        const double end = begin + 1;
        enter(cell);
        for (double c; i < count && (c = cells(i)) < end; ++i) visit(i, static_cast<float>(c - begin));
    }
}

/// Perlin's quintic: 0 to 1 with two derivatives zero at both ends.
constexpr float fade(float t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
}
constexpr float mix(float a, float b, float t) {
    return a + t * (b - a);
}
constexpr float clamp01(float t) {
    return t < 0 ? 0 : t > 1 ? 1 : t;
}

}  // namespace detail

/// Gradient noise: mean 0, variance 1, twice differentiable, waves of about one to three cells.
class gradient_noise {
  public:
    /// Brings the variance to 1: that of the sum over the corners is 8/3 (181/462) (535/18018) for gradients uniform in
    /// the square, by integrating the squared weights over the cell.
    static constexpr float gain = 5.6777169f;
    /// Mean square of the gradient, times the square of the cell: 324744/19367, by the same integral.
    static constexpr float mean_square_slope = 16.767904f;

    /// @param cell  metres, > 0
    gradient_noise(double cell, detail::cell_hash hash) : lattice_(detail::lattice::shifted(cell, hash)), hash_(hash) {}

    /// The share of it that the row's grid carries; a cell is about half a wave.
    float carried_by(const scanline& line) const { return carried(2 / lattice_.frequency, line.grid_spacing); }

    /// Calls `visit(i, value)` for each sample of the row.
    template <class Visit>
    void row(const scanline& line, std::size_t count, Visit&& visit) const {
        const float scale = gain * carried_by(line);
        if (scale == 0) {
            for (std::size_t i = 0; i < count; ++i) visit(i, 0.0f);
            return;
        }
        const detail::lattice_coordinate v(line.y * lattice_.frequency + lattice_.offset_y);
        const auto below = hash_[v.cell], above = hash_[v.cell + 1];
        const float rise = detail::fade(v.fraction);

        // The lattice column at a cell's side, already blended over y: a line in x through `height` at the column.
        struct side {
            float slope, height;
        };
        const auto side_of = [&](std::int64_t column) {
            const detail::pair_of_bits low(below(column)), high(above(column));
            return side{scale * detail::mix(low.a, high.a, rise),
                        scale * detail::mix(low.b * v.fraction, high.b * (v.fraction - 1), rise)};
        };
        side left{}, right{};
        std::int64_t column = 0;
        bool started = false;
        detail::walk(
            lattice_, line, count,
            [&](std::int64_t cell) {
                left = started && cell == column + 1 ? right : side_of(cell);
                right = side_of(cell + 1);
                column = cell;
                started = true;
            },
            [&](std::size_t i, float t) {
                visit(i,
                      detail::mix(left.height + left.slope * t, right.height + right.slope * (t - 1), detail::fade(t)));
            });
    }

  private:
    detail::lattice lattice_;
    detail::cell_hash hash_;
};

/// Random relief whose 2-D spectrum falls as a power of the wave number, W(K) ~ K^-exponent between two wavelengths.
///
/// Measured exponents of sea floors are 2.4 to 3.9, 3.25 where nothing is known: APL-UW High-Frequency Ocean
/// Environmental Acoustic Models Handbook. TR 9407, 1994 (eqs. 7-8).
struct roughness {
    float rms = 0.01f;       ///< metres, >= 0; 0 costs nothing
    float longest = 1.0f;    ///< metres, > 0: cell of the coarsest octave
    float shortest = 0.04f;  ///< metres, in (0, longest]: no octave has smaller cells
    float exponent = 3.25f;  ///< in [2, 4]

    friend bool operator==(const roughness&, const roughness&) = default;
};

/// Octaves of gradient noise, cells halved from one to the next, that make up a `roughness`.
class power_law_noise {
  public:
    /// @throws invalid_input for parameters out of the ranges above
    power_law_noise(const roughness& r, std::uint64_t seed, detail::stream purpose) {
        detail::require(r.rms >= 0 && r.rms < 1e6f, "roughness.rms", r.rms, "metres, at least 0");
        detail::require(r.longest > 0 && r.longest < 1e6f, "roughness.longest", r.longest, "metres above 0");
        detail::require(r.shortest >= 1e-4f && r.shortest <= r.longest, "roughness.shortest", r.shortest,
                        "metres from 1e-4 to roughness.longest");
        detail::require(r.exponent >= 2 && r.exponent <= 4, "roughness.exponent", r.exponent, "2 to 4");
        if (r.rms == 0) return;

        // An octave spreads its variance over an area of the wave number plane four times that of the one before, so
        // variances in the ratio 2^(2 - exponent) make densities in the ratio 2^-exponent.
        const double ratio = numeric::pow(2, 2 - static_cast<double>(r.exponent));
        double variance = 1, sum = 0;
        double cell = static_cast<double>(r.longest);
        for (std::uint32_t k = 0; k == 0 || cell >= static_cast<double>(r.shortest); ++k) {
            octaves_.push_back({gradient_noise(cell, {seed, purpose, k}), static_cast<float>(variance)});
            slope_ += variance * static_cast<double>(gradient_noise::mean_square_slope) / (cell * cell);
            sum += variance;
            variance *= ratio;
            cell /= 2;
        }
        const double scale = static_cast<double>(r.rms) * static_cast<double>(r.rms) / sum;
        slope_ = numeric::square_root(slope_ * scale);
        for (octave& o : octaves_)
            o.amplitude = static_cast<float>(numeric::square_root(static_cast<double>(o.amplitude) * scale));
    }

    /// Adds the relief along a row to `heights`, metres.
    void add_row(const scanline& line, std::span<float> heights) const {
        for (const octave& o : octaves_) {
            if (o.noise.carried_by(line) == 0) break;  // nor the finer ones
            o.noise.row(line, heights.size(), [&](std::size_t i, float n) { heights[i] += o.amplitude * n; });
        }
    }

    /// Expected root mean square of the length of the gradient, metres per metre.
    double rms_slope() const { return slope_; }

  private:
    struct octave {
        gradient_noise noise;
        float amplitude;
    };
    std::vector<octave> octaves_;
    double slope_ = 0;
};

}  // namespace insonify::inline INSONIFY_ABI::seabed

INSONIFY_ARITHMETIC_END
