// Gradient noise on the world's lattice, and power-law relief made of its octaves.
//
// Along a row, the noise within a cell is two straight lines blended by the fade curve. Gradients are hashed and
// blended over y once per cell, not once per sample.
//
// Based on: Ken Perlin. Improving Noise. SIGGRAPH, 2002 (gradients on a lattice, quintic fade).
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/simd/transpose.hpp>
#include <insonify/seabed/detail/interpolation.hpp>
#include <insonify/seabed/detail/stretch.hpp>
#include <insonify/seabed/roughness.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed::detail::inline INSONIFY_FLAGS {

/// Gradient noise: mean 0, variance 1, twice differentiable, waves of about one to three cells.
class gradient_noise {
  public:
    /// Scales the variance to 1. The sum over the corners has a variance of 8/3 (181/462) (535/18018) for gradients
    /// uniform in a square, the integral of the squared weights over the cell.
    static constexpr float gain = 5.6777169f;
    /// Upper bound of the absolute value. Along each axis the corners have weights fade(t) and 1 - fade(t), and a
    /// gradient of 1 contributes t or 1 - t: at most t + fade(t) (1 - 2 t) <= 1/2, so both axes together add up to 1.
    static constexpr double upper_bound = 1.00001 * static_cast<double>(gain);
    /// Mean square of the gradient, times the square of the cell: 324744/19367, by the same integral.
    static constexpr float mean_square_slope = 16.767904f;

    /// @param cell  metres, > 0
    gradient_noise(double cell, cell_hash hash) : lattice_(lattice::shifted(cell, hash)), hash_(hash) {}

    /// Gain of the band limit on a stretch's grid; a cell is about half a wavelength.
    float band_gain_on(const stretch& part) const { return band_limit_gain(2 / lattice_.frequency, part.grid_spacing); }

    /// Adds `amplitude` times the noise along a stretch to its values.
    template <int N>
    INSONIFY_INLINE void add(const stretch& part, float amplitude, float* values) const {
        const lattice_coordinate v(lattice_.v(part.y));
        const line_of_cells line{hash_[v.cell], hash_[v.cell + 1], v.fraction, fade(v.fraction), amplitude * gain};
        const std::int64_t first = numeric::floor_to_int(lattice_.u(part.x[0]));
        const std::int64_t last = numeric::floor_to_int(lattice_.u(part.x[part.whole() - 1])) + 1;
        const bool dense = last - first < table_size;
        alignas(32) side sides[table_size + 16];
        if (dense) line.template tabulate<N>(sides, static_cast<std::uint32_t>(first), static_cast<int>(last - first));

        for (std::size_t i = 0; i < part.whole(); i += N) {
            using insonify::detail::lane;
            lanes<float, N> across{}, weight, sum, corner[4];  // height and slope at both sides of the cell
            lanes<std::int32_t, N> cell{};
            const auto fetch = [&](const side* from) INSONIFY_INLINE_LAMBDA {
                insonify::detail::transpose<N>(
                    corner, [&](int k) INSONIFY_INLINE_LAMBDA { return &from[lane(cell, k)].height; });
            };
            if (dense) {
                locate<N>(across, cell, &part.x[i], lattice_.frequency, lattice_.offset_x, static_cast<double>(first));
                const std::int32_t begin = lane(cell, 0);
                if (begin == lane(cell, N - 1)) {
                    const float* const both = &sides[begin].height;
                    for (int k = 0; k < 4; ++k) corner[k] = lanes<float, N>{} + both[k];
                } else {
                    fetch(sides);
                }
            } else {
                // Samples are so far apart that each has its own columns.
                for (int k = 0; k < N; ++k) {
                    const lattice_coordinate u(lattice_.u(part.x[i + static_cast<std::size_t>(k)]));
                    line.template tabulate<1>(sides + 2 * k, static_cast<std::uint32_t>(u.cell), 1);
                    insonify::detail::set_lane(across, k, u.fraction);
                    insonify::detail::set_lane(cell, k, 2 * k);
                }
                fetch(sides);
            }
            const lanes<float, N> left = corner[0] + corner[1] * across,
                                  right = corner[2] + corner[3] * (across - 1.0f);
            fade(weight, across);
            insonify::detail::load(sum, values + i);
            sum = sum + (left + weight * (right - left));
            insonify::detail::store(values + i, sum);
        }
    }

  private:
    template <class T, int N>
    using lanes = insonify::detail::lanes<T, N>;
    template <int N>
    using words = lanes<std::uint32_t, N>;

    /// A column of the lattice at a row's y, already blended over y: a line in x through `height` at the column.
    struct side {
        float height, slope;
    };
    static constexpr std::int64_t table_size = 512;  // columns; samples of wider rows lie in cells of their own

    struct line_of_cells {
        cell_hash::row below, above;
        float up, weight_y, gain;  // the row's fraction within its cells, the fade of it, and the scale

        template <int N>
        INSONIFY_INLINE void sides_of(lanes<float, N>& height, lanes<float, N>& slope, const words<N>& column) const {
            lanes<float, N> low_x, low_y, high_x, high_y;
            gradient<N>(low_x, low_y, below, column);
            gradient<N>(high_x, high_y, above, column);
            low_y = low_y * up;
            high_y = high_y * (up - 1.0f);
            slope = gain * (low_x + weight_y * (high_x - low_x));
            height = gain * (low_y + weight_y * (high_y - low_y));
        }

        /// Both components in [-1, 1), from 16 bits each.
        template <int N>
        INSONIFY_INLINE static void gradient(lanes<float, N>& x, lanes<float, N>& y, const cell_hash::row& row,
                                             const words<N>& column) {
            using ints = lanes<std::int32_t, N>;
            words<N> bits;
            row.hash_lanes(bits, column);
            insonify::detail::convert(x, ints(ints(bits << 16) >> 16));
            insonify::detail::convert(y, ints(ints(bits) >> 16));
            x = x * 0x1p-15f;
            y = y * 0x1p-15f;
        }

        template <int N>
        INSONIFY_INLINE void tabulate(side* sides, std::uint32_t first, int last) const {
            words<N> column;
            insonify::detail::iota<std::uint32_t, N>(column);
            column = column + first;
            for (int i = 0; i <= last; i += N) {
                lanes<float, N> height, slope;
                sides_of<N>(height, slope, column);
                for (int k = 0; k < N; ++k)
                    sides[i + k] = {insonify::detail::lane(height, k), insonify::detail::lane(slope, k)};
                column = column + static_cast<std::uint32_t>(N);
            }
        }
    };

    lattice lattice_;
    cell_hash hash_;
};

/// Octaves of gradient noise, cells halved from one to the next, that make up a `roughness`.
class power_law_noise {
  public:
    /// @throws invalid_input for parameters out of the ranges of `roughness`
    power_law_noise(const roughness& r, std::uint64_t seed, stream purpose, std::uint32_t layer = 0) {
        require_metres("roughness.rms", r.rms);
        require_positive_metres("roughness.longest", r.longest);
        require_range("roughness.shortest", r.shortest, 1e-4f, r.longest, "metres from 1e-4 to roughness.longest");
        require_range("roughness.exponent", r.exponent, 2, 4, "2 to 4");
        if (r.rms == 0) return;

        // An octave spreads its variance over an area of the wave number plane four times that of the one before, so
        // variances in the ratio 2^(2 - exponent) make densities in the ratio 2^-exponent.
        const double ratio = numeric::pow(2, 2 - static_cast<double>(r.exponent));
        double variance = 1, sum = 0;
        double cell = static_cast<double>(r.longest);
        for (std::uint32_t k = 0; k == 0 || cell >= static_cast<double>(r.shortest); ++k) {
            octaves_.push_back({gradient_noise(cell, {seed, purpose, 64 * layer + k}), static_cast<float>(variance)});
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

    /// Adds the relief along a stretch to its values, metres.
    void add(const stretch& part, stretch_values& values, isa level = best_isa()) const {
        if (!octaves_.empty()) add_relief(*this, part, values, level);
    }

    /// Upper bound of the relief's absolute value, metres.
    double upper_bound() const {
        double sum = 0;
        for (const octave& o : octaves_) sum += static_cast<double>(o.amplitude) * gradient_noise::upper_bound;
        return sum;
    }

    /// Expected root mean square of the length of the gradient, metres per metre.
    double rms_slope() const { return slope_; }

  private:
    friend relief_kernel<power_law_noise>;

    struct octave {
        gradient_noise noise;
        float amplitude;
    };
    template <int N>
    INSONIFY_INLINE void add_lanes(const stretch& part, float* values) const {
        for (const octave& o : octaves_) {
            const float band_gain = o.noise.band_gain_on(part);
            if (band_gain == 0) break;  // finer octaves are not resolved either
            o.noise.template add<N>(part, band_gain * o.amplitude, values);
        }
    }
    dynamic_array<octave> octaves_;
    double slope_ = 0;
};

}  // namespace seabed::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
