// Sand ripples: crests of one height that meander, end and fork, as waves over sand make them.
//
// A Gaussian random field of ripples fades in and out, which real ones don't. Here the phase of such a field,
// psi(x) = sum_n exp i(k_n . x + phi_n), drives a profile of constant amplitude: height = (eta / 2) cos arg psi. Crests
// fork at the zeros of psi, around which the phase winds once.
//
// The carrier exp(i k_0 . x) is divided out of psi. What is left varies slowly, so along a row it is summed on a
// lattice several times coarser than the ripples and interpolated; across rows it is exact. The lattice is the world's:
// a height depends on seed and position alone.
//
// Based on: Dajun Tang, Frank S. Henyey, Brian T. Hefner, Peter A. Traykovski. Simulating Realistic-Looking Sediment
// Ripple Fields. IEEE Journal of Oceanic Engineering 34, 2009 (why ripples are not Gaussian).
#pragma once

#include <insonify/seabed/noise.hpp>

#include <array>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::seabed {

class ripples_sampler;

/// Rippled sand. The ratio height / wavelength is about 0.1 to 0.2 under waves and never far from it.
struct ripples {
    static constexpr type kind = type::ripples;

    float wavelength = 0.8f;  ///< metres, > 0: from crest to crest
    float height = 0.09f;     ///< metres, >= 0: from crest to trough
    float direction = 0;      ///< radians from +x: where the wave vector points, across the crests
    float spread = 0.09f;     ///< radians, in [0, 0.5]: standard deviation of the direction; more of it, more forks
    float bandwidth = 0.09f;  ///< in [0, 0.25]: relative standard deviation of the wave number
    float sharpness = 0.25f;  ///< in [0, 0.9]: 0 is sinusoidal, more is narrower crests and wider troughs
    roughness surface{.rms = 0.0025f, .longest = 0.4f};  ///< what lies on the ripples, beyond `height`
    std::uint64_t seed = 1;

    /// @throws invalid_input for parameters out of their range
    ripples_sampler prepare() const;
    float operator()(double x, double y) const;
};

namespace detail {

/// A complex number, planar in arrays: re[i], im[i].
template <std::size_t N>
struct complex_array {
    std::array<float, N> re, im;
};

/// Sine and cosine of 2 pi x for |x| <= 1/2, absolute error < 2e-6, without a branch.
struct turn {
    float sine, cosine;
    explicit turn(float x) {
        // Series of the half angle, which stays below pi / 2, and then its double.
        const float a = x * static_cast<float>(numeric::pi);
        const float t = a * a;
        const float s =
            a * (1 + t * (-1.0f / 6 + t * (1.0f / 120 + t * (-1.0f / 5040 + t * (1.0f / 362880 - t / 39916800)))));
        const float c =
            1 + t * (-0.5f +
                     t * (1.0f / 24 + t * (-1.0f / 720 + t * (1.0f / 40320 + t * (-1.0f / 3628800 + t / 479001600)))));
        sine = 2 * s * c;
        cosine = 1 - 2 * s * s;
    }
};

}  // namespace detail

/// Evaluates `ripples`.
class ripples_sampler {
  public:
    static constexpr std::size_t waves = 32;

    /// Softens the zeros of psi, as a share of its rms: the amplitude dips to nothing at the very fork, over a few
    /// hundredths of a wavelength more than a phase jump would, and slopes stay bounded.
    static constexpr float softening = 0.15f;

    explicit ripples_sampler(const ripples& r)
        : surface_(r.surface, r.seed, detail::stream::ripples),
          wavelength_(static_cast<double>(r.wavelength)),
          half_height_(r.height / 2),
          sharpness_(r.sharpness) {
        detail::require(r.wavelength > 0 && r.wavelength < 1e6f, "ripples.wavelength", r.wavelength, "metres above 0");
        detail::require(r.height >= 0 && r.height < 1e6f, "ripples.height", r.height, "metres, at least 0");
        detail::require(numeric::is_finite(r.direction), "ripples.direction", r.direction, "a finite angle");
        detail::require(r.spread >= 0 && r.spread <= 0.5f, "ripples.spread", r.spread, "0 to 0.5 radians");
        detail::require(r.bandwidth >= 0 && r.bandwidth <= 0.25f, "ripples.bandwidth", r.bandwidth, "0 to 0.25");
        detail::require(r.sharpness >= 0 && r.sharpness <= 0.9f, "ripples.sharpness", r.sharpness, "0 to 0.9");

        // Draw the waves, in turns per metre about the carrier.
        const double frequency = 1 / static_cast<double>(r.wavelength);
        const auto heading = numeric::sin_cos(static_cast<double>(r.direction));
        carrier_ = {frequency * heading.cosine, frequency * heading.sine};
        random_sequence draw(r.seed, static_cast<std::uint32_t>(detail::stream::ripples));
        double largest = 0;
        for (wave& w : waves_) {
            const double k = frequency * (1 + static_cast<double>(r.bandwidth) * spread_draw(draw));
            const auto along =
                numeric::sin_cos(static_cast<double>(r.direction) + static_cast<double>(r.spread) * spread_draw(draw));
            w = {k * along.cosine - carrier_.x, k * along.sine - carrier_.y, draw.uniform()};
            largest = (std::max)(largest, w.x < 0 ? -w.x : w.x);
        }

        // Space the lattice so that the fastest wave turns by a sixteenth per step: cubic interpolation then errs by
        // less than 0.0006 of it.
        step_ = (std::min)(static_cast<double>(r.wavelength), 1 / (16 * (std::max)(largest, 1e-6 * frequency)));
        const double scale = numeric::square_root(1.0 / static_cast<double>(waves));
        for (std::size_t n = 0; n < waves; ++n) {
            for (std::size_t i = 0; i < block; ++i) {
                const auto [sine, cosine] = numeric::sin_cos_turns(waves_[n].x * step_ * static_cast<double>(i));
                table_[n].re[i] = static_cast<float>(scale * cosine);
                table_[n].im[i] = static_cast<float>(scale * sine);
            }
        }
    }

    void row(const scanline& line, std::span<float> heights) const {
        // What sharpens crests has half their wavelength.
        const float half_height = half_height_ * carried(wavelength_, line.grid_spacing);
        const float sharpness = sharpness_ * carried(wavelength_ / 2, line.grid_spacing);
        if (half_height == 0) {
            std::fill(heights.begin(), heights.end(), 0.0f);
            return surface_.add_row(line, heights);
        }
        const detail::lattice steps{.frequency = 1 / step_};
        // Cut the row where its lattice points would outgrow the scratch space.
        const double per_sample = line.spacing * steps.frequency;
        const double fit = static_cast<double>(points - 8) / (std::max)(per_sample, 1e-9);
        const std::size_t part = fit < 1 ? 1 : static_cast<std::size_t>((std::min)(fit, 1e9));
        for (std::size_t i = 0; i < heights.size(); i += part) {
            add_profile(steps, line.from(i), heights.subspan(i, (std::min)(part, heights.size() - i)), half_height,
                        sharpness);
        }
        surface_.add_row(line, heights);
    }

    /// psi at a point, its waves summed in full: mean square 1, phase that of the crests, zeros where they fork.
    struct phasor {
        double re, im;
    };
    phasor psi(double x, double y) const {
        phasor sum{0, 0};
        for (const wave& w : waves_) {
            const auto [sine, cosine] =
                numeric::sin_cos_turns((w.x + carrier_.x) * x + (w.y + carrier_.y) * y + w.phase);
            sum.re += cosine;
            sum.im += sine;
        }
        const double scale = numeric::square_root(1.0 / static_cast<double>(waves));
        return {sum.re * scale, sum.im * scale};
    }

  private:
    static constexpr std::size_t block = 128;  // lattice points whose rotations are tabulated
    static constexpr std::size_t points = 2 * block;

    struct wave {
        double x, y, phase;  // turns per metre, and turns
    };
    struct wave_vector {
        double x, y;
    };

    /// Mean 0, standard deviation 1, never beyond 2.45: the tails of a normal would only widen the band.
    static double spread_draw(random_sequence& draw) {
        const double first = draw.uniform();
        return (first + draw.uniform() - 1) * 2.449489742783178;
    }

    /// psi without its carrier at `count` points of the lattice.
    void envelope(std::int64_t from, double y, std::size_t count, detail::complex_array<points>& out) const {
        for (std::size_t done = 0; done < count;) {
            const std::int64_t first = from + static_cast<std::int64_t>(done);
            const std::int64_t origin = first & ~static_cast<std::int64_t>(block - 1);
            const auto begin = static_cast<std::size_t>(first - origin);
            const std::size_t length = (std::min)(block - begin, count - done);
            // Turn each wave to the block's origin in double, then step through the block by its table.
            detail::complex_array<block> sum{};
            for (std::size_t n = 0; n < waves; ++n) {
                const wave& w = waves_[n];
                const auto [sine, cosine] =
                    numeric::sin_cos_turns(w.x * step_ * static_cast<double>(origin) + w.y * y + w.phase);
                const auto re = static_cast<float>(cosine), im = static_cast<float>(sine);
                const detail::complex_array<block>& table = table_[n];
                for (std::size_t i = begin; i < begin + length; ++i) {
                    sum.re[i] += re * table.re[i] - im * table.im[i];
                    sum.im[i] += re * table.im[i] + im * table.re[i];
                }
            }
            std::copy_n(sum.re.begin() + static_cast<std::ptrdiff_t>(begin), length,
                        out.re.begin() + static_cast<std::ptrdiff_t>(done));
            std::copy_n(sum.im.begin() + static_cast<std::ptrdiff_t>(begin), length,
                        out.im.begin() + static_cast<std::ptrdiff_t>(done));
            done += length;
        }
    }

    /// Catmull-Rom through four points, as a polynomial of the way from the second to the third.
    struct cubic {
        float a = 0, b = 0, c = 0, d = 0;
        cubic() = default;
        explicit cubic(const float* p)
            : a(p[1]),
              b(0.5f * (p[2] - p[0])),
              c(p[0] - 2.5f * p[1] + 2 * p[2] - 0.5f * p[3]),
              d(0.5f * (p[3] - p[0]) + 1.5f * (p[1] - p[2])) {}
        float operator()(float t) const { return a + t * (b + t * (c + t * d)); }
    };

    void add_profile(const detail::lattice& steps, const scanline& line, std::span<float> heights, float half_height,
                     float sharpness) const {
        const std::int64_t from = numeric::floor_to_int(line.x(0) * steps.frequency) - 1;
        const std::int64_t to = numeric::floor_to_int(line.x(heights.size() - 1) * steps.frequency) + 2;
        detail::complex_array<points> psi;
        envelope(from, line.y, static_cast<std::size_t>(to - from) + 1, psi);

        const double across = carrier_.y * line.y;
        cubic re, im;
        detail::walk(
            steps, line, heights.size(),
            [&](std::int64_t cell) {
                const auto stencil = static_cast<std::size_t>(cell - 1 - from);
                re = cubic(&psi.re[stencil]);
                im = cubic(&psi.im[stencil]);
            },
            [&](std::size_t i, float t) {
                const double turns = carrier_.x * line.x(i) + across;
                const detail::turn carrier(
                    static_cast<float>(turns - static_cast<double>(numeric::floor_to_int(turns + 0.5))));
                const float a = re(t), b = im(t);
                const float real = a * carrier.cosine - b * carrier.sine;
                const float magnitude = numeric::square_root(a * a + b * b + softening * softening);
                // With c = cos arg psi, the profile is (c - s) / (1 - s c): -1 to 1 like c itself, the curvature of
                // its crests (1 + s) / (1 - s) times a sinusoid's and that of its troughs the inverse.
                heights[i] = half_height * (real - sharpness * magnitude) / (magnitude - sharpness * real);
            });
    }

    std::array<wave, waves> waves_{};
    std::array<detail::complex_array<block>, waves> table_{};
    wave_vector carrier_{};
    double step_ = 1;
    power_law_noise surface_;
    double wavelength_;
    float half_height_, sharpness_;
};

inline ripples_sampler ripples::prepare() const {
    return ripples_sampler(*this);
}
inline float ripples::operator()(double x, double y) const {
    return height_at(prepare(), x, y);
}

}  // namespace insonify::inline INSONIFY_ABI::seabed

INSONIFY_ARITHMETIC_END
