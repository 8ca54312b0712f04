// One system of sand ripples: crests of equal height that meander, end and fork, as wave-made ripples do.
//
// The amplitude of a Gaussian random field varies; that of real ripples does not. Here the phase of such a field,
// psi(x) = sum_n exp i(k_n . x + phi_n), drives a profile of constant amplitude: height = (eta / 2) cos arg psi. Crests
// fork at the zeros of psi, around which the phase winds once.
//
// The envelope psi exp(-i k_0 . x) varies slowly. Along a row it is summed on a lattice of at most one wavelength (a
// third of it by default), coarser than the samples of a picture, and interpolated; across rows it is exact. The
// lattice is fixed to the world: a height depends on seed and position alone.
//
// Based on: Dajun Tang, Frank S. Henyey, Brian T. Hefner, Peter A. Traykovski. Simulating Realistic-Looking Sediment
// Ripple Fields. IEEE Journal of Oceanic Engineering 34, 2009 (why ripples are not Gaussian).
// M. V. Berry, M. R. Dennis. Phase Singularities in Isotropic Random Waves. Proc. R. Soc. A 456, 2000 (how many forks).
#pragma once

#include <insonify/core/simd/elementary.hpp>
#include <insonify/core/simd/transpose.hpp>
#include <insonify/seabed/detail/interpolation.hpp>
#include <insonify/seabed/detail/stretch.hpp>
#include <insonify/seabed/ripple_system.hpp>

#include <array>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed::detail::inline INSONIFY_FLAGS {

/// Evaluates a `ripple_system`.
class ripple_train {
  public:
    static constexpr std::size_t waves = 32;

    /// Regularizes the zeros of psi, relative to its rms: the amplitude falls to zero at a fork over 0.15 /
    /// (2 pi spread) wavelengths, a quarter of one by default, and slopes stay bounded.
    static constexpr float softening = 0.15f;

    /// @param name  of the system, for errors
    ripple_train(const ripple_system& r, std::uint64_t seed, stream purpose, const std::string& name)
        : wavelength_(static_cast<double>(r.wavelength)), half_height_(r.height() / 2), sharpness_(r.sharpness) {
        require_range(name + ".wavelength", r.wavelength, 1e-4f, 1e6f, "metres, 0.0001 to 10^6");
        require_range(name + ".steepness", r.steepness, 0, 0.5f, "0 to 0.5");
        insonify::detail::require_angle(name + ".direction", r.direction);
        require_range(name + ".spread", r.spread, 0, 0.5f, "0 to 0.5 radians");
        require_range(name + ".bandwidth", r.bandwidth, 0, 0.25f, "0 to 0.25");
        require_range(name + ".sharpness", r.sharpness, 0, 0.9f, "0 to 0.9");
        if (half_height_ > 0) make_waves(r, random_sequence(seed, static_cast<std::uint32_t>(purpose)));
    }

    /// Adds the relief along a stretch to its values, metres.
    void add(const stretch& part, stretch_values& values, isa level = best_isa()) const {
        if (half_height_ > 0 && band_limit_gain(wavelength_, part.grid_spacing) > 0)
            add_relief(*this, part, values, level);
    }

    /// Upper bound of the relief's absolute value, metres: the profile is within half the height, up to the carrier's
    /// error of 2e-6, which the sharpest crests multiply by 19.
    double upper_bound() const { return 1.0001 * static_cast<double>(half_height_); }

    /// psi at a point, summed without interpolation: mean square 1, the phase of the crests, zeros at their forks.
    struct phasor {
        double re, im;
    };
    phasor psi(double x, double y) const {
        phasor sum{0, 0};
        for (std::size_t n = 0; n < waves; ++n) {
            const auto [sine, cosine] =
                numeric::sin_cos_turns((wave_x_[n] + carrier_x_) * x + (wave_y_[n] + carrier_y_) * y + phase_[n]);
            sum.re += cosine;
            sum.im += sine;
        }
        const double scale = numeric::square_root(1.0 / static_cast<double>(waves));
        return {sum.re * scale, sum.im * scale};
    }

  private:
    friend relief_kernel<ripple_train>;

    static constexpr std::size_t block = 32;    // lattice points whose rotations are tabulated
    static constexpr std::size_t points = 256;  // size of the table that a stretch shares

    void make_waves(const ripple_system& r, random_sequence random) {
        // Latin hypercube sampling of direction and wave number: few waves suffice for the required moments.
        std::array<double, waves> strata{};
        for (std::uint32_t n = 0; n < waves; ++n) {
            const std::uint32_t other = random.below(n + 1);
            strata[n] = strata[other];
            strata[other] = n;
        }
        const double frequency = 1 / static_cast<double>(r.wavelength), angle = static_cast<double>(r.direction);
        const auto heading = numeric::sin_cos(angle);
        carrier_x_ = frequency * heading.cosine;
        carrier_y_ = frequency * heading.sine;
        double largest = 0;
        for (std::size_t n = 0; n < waves; ++n) {
            const double k = frequency * (1 + static_cast<double>(r.bandwidth) *
                                                  triangular((static_cast<double>(n) + random.uniform()) / waves));
            const double angle_offset =
                static_cast<double>(r.spread) * triangular((strata[n] + random.uniform()) / waves);
            const auto along = numeric::sin_cos(angle + angle_offset);
            wave_x_[n] = k * along.cosine - carrier_x_;
            wave_y_[n] = k * along.sine - carrier_y_;
            phase_[n] = random.uniform();
            largest = (std::max)(largest, numeric::abs(wave_x_[n]));
        }

        // The fastest wave turns by a sixteenth per lattice step: cubic interpolation is then off by at most 0.0011
        // of its amplitude.
        step_ = (std::min)(static_cast<double>(r.wavelength), 1 / (16 * (std::max)(largest, 1e-6 * frequency)));
        const double scale = numeric::square_root(1.0 / static_cast<double>(waves));
        for (std::size_t n = 0; n < waves; ++n) {
            const auto once = numeric::sin_cos_turns(wave_x_[n] * step_);
            double re = scale, im = 0;
            for (std::size_t i = 0; i < block; ++i) {
                turn_re_[n][i] = static_cast<float>(re);
                turn_im_[n][i] = static_cast<float>(im);
                const double next = re * once.cosine - im * once.sine;
                im = re * once.sine + im * once.cosine;
                re = next;
            }
        }
    }

    /// A triangular variable of mean 0 and standard deviation 1 from a uniform one. It is bounded by 2.45; the tails of
    /// a normal one would widen the band.
    static double triangular(double u) {
        const double side = u < 0.5 ? numeric::square_root(2 * u) - 1 : 1 - numeric::square_root(2 - 2 * u);
        return side * 2.449489742783178;
    }

    /// The envelope at `count` points of the lattice.
    template <int N>
    INSONIFY_INLINE void envelope(float* re, float* im, std::int64_t from, double y, std::size_t count) const {
        for (std::size_t done = 0; done < count;) {
            const std::int64_t first = from + static_cast<std::int64_t>(done);
            const std::int64_t origin = first & ~static_cast<std::int64_t>(block - 1);
            const auto begin = static_cast<std::size_t>(first - origin);
            const std::size_t length = (std::min)(block - begin, count - done);
            // Turn each wave to the block's origin in double, then step through the block by its table.
            alignas(32) float start_re[waves], start_im[waves];
            constexpr int wide = N > 1 ? N / 2 : 1;
            const double x = step_ * static_cast<double>(origin);
            for (std::size_t n = 0; n < waves; n += wide) {
                lanes<double, wide> wave_x, wave_y, phase, cosine, sine, floor;
                insonify::detail::load(wave_x, &wave_x_[n]);
                insonify::detail::load(wave_y, &wave_y_[n]);
                insonify::detail::load(phase, &phase_[n]);
                phase = wave_x * x + wave_y * y + phase;
                insonify::detail::floor_lanes<wide>(floor, phase);
                insonify::detail::cos_sin_turns<wide>(cosine, sine, phase - floor);
                lanes<float, wide> narrow;
                insonify::detail::convert(narrow, cosine);
                insonify::detail::store(start_re + n, narrow);
                insonify::detail::convert(narrow, sine);
                insonify::detail::store(start_im + n, narrow);
            }
            for (std::size_t i = begin & ~static_cast<std::size_t>(N - 1); i < begin + length; i += N) {
                lanes<float, N> sum_re{}, sum_im{}, table_re, table_im;
                for (std::size_t n = 0; n < waves; ++n) {
                    insonify::detail::load(table_re, &turn_re_[n][i]);
                    insonify::detail::load(table_im, &turn_im_[n][i]);
                    sum_re = sum_re + (start_re[n] * table_re - start_im[n] * table_im);
                    sum_im = sum_im + (start_re[n] * table_im + start_im[n] * table_re);
                }
                for (int k = 0; k < N; ++k) {
                    const std::size_t at = i + static_cast<std::size_t>(k);
                    if (at < begin || at >= begin + length) continue;
                    re[done + at - begin] = insonify::detail::lane(sum_re, k);
                    im[done + at - begin] = insonify::detail::lane(sum_im, k);
                }
            }
            done += length;
        }
    }

    template <int N>
    INSONIFY_INLINE void add_lanes(const stretch& part, float* values) const {
        using insonify::detail::lane;
        const double frequency = 1 / step_, across_rows = carrier_y_ * part.y;
        // The harmonic that sharpens crests has half their wavelength.
        const float half_height = half_height_ * band_limit_gain(wavelength_, part.grid_spacing);
        const float sharpness = sharpness_ * band_limit_gain(wavelength_ / 2, part.grid_spacing);
        const std::int64_t first = numeric::floor_to_int(part.x[0] * frequency) - 1;
        const std::int64_t last = numeric::floor_to_int(part.x[part.whole() - 1] * frequency) + 2;
        const bool dense = last - first < static_cast<std::int64_t>(points);
        std::array<float, points> table_re, table_im;
        if (dense)
            envelope<N>(table_re.data(), table_im.data(), first, part.y, static_cast<std::size_t>(last - first) + 1);

        for (std::size_t i = 0; i < part.whole(); i += N) {
            lanes<float, N> across{}, stencil_re[4], stencil_im[4], a, b, cosine, sine, magnitude, sum;
            lanes<std::int32_t, N> cell{};
            if (dense) {
                locate<N>(across, cell, &part.x[i], frequency, 0, static_cast<double>(first));
            } else {
                // Samples are so far apart that each has its own stencil.
                for (int k = 0; k < N; ++k) {
                    const lattice_coordinate u(part.x[i + static_cast<std::size_t>(k)] * frequency);
                    envelope<N>(&table_re[static_cast<std::size_t>(4 * k)], &table_im[static_cast<std::size_t>(4 * k)],
                                u.cell - 1, part.y, 4);
                    insonify::detail::set_lane(across, k, u.fraction);
                    insonify::detail::set_lane(cell, k, 4 * k + 1);
                }
            }
            const auto stencil = [&](lanes<float, N>(&into)[4], const float* table) INSONIFY_INLINE_LAMBDA {
                insonify::detail::transpose<N>(into,
                                               [&](int k) INSONIFY_INLINE_LAMBDA { return table + lane(cell, k) - 1; });
            };
            stencil(stencil_re, table_re.data());
            stencil(stencil_im, table_im.data());
            catmull_rom(a, stencil_re, across);
            catmull_rom(b, stencil_im, across);

            lanes<float, N> phase;
            turns<N>(phase, &part.x[i], carrier_x_, across_rows);
            insonify::detail::cos_sin_turns<N>(cosine, sine, phase);
            const lanes<float, N> real = a * cosine - b * sine;
            insonify::detail::square_root<N>(magnitude, a * a + b * b + softening * softening);
            // With c = cos arg psi, the profile is (c - s) / (1 - s c): -1 to 1 like c itself, the curvature of its
            // crests (1 + s) / (1 - s) times a sinusoid's and that of its troughs the inverse. A trochoid's curvatures
            // have the same ratio; it would take Kepler's equation.
            insonify::detail::load(sum, values + i);
            sum = sum + half_height * (real - sharpness * magnitude) / (magnitude - sharpness * real);
            insonify::detail::store(values + i, sum);
        }
    }

    alignas(32) std::array<double, waves> wave_x_{}, wave_y_{}, phase_{};  // turns per metre about the carrier; turns
    alignas(32) std::array<std::array<float, block>, waves> turn_re_{}, turn_im_{};
    double carrier_x_ = 0, carrier_y_ = 0;
    double step_ = 1, wavelength_;
    float half_height_, sharpness_;
};

}  // namespace seabed::detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
