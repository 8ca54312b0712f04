// The sonar equation as a list of parts. Parts that are not in the list are neither computed nor compiled.
//
// Pixels are linear intensities (power). Without any part, a bin holds the backscattering cross-section of the surfaces
// in it: reflectivity x law(sine of the grazing angle) x area, summed, in square metres at 1 m for source level 0. In
// decibels, in the order of propagation (R. J. Urick. Principles of Underwater Sound, 3rd edition, 1983):
//
//   RL = source_level + vertical_beam - spreading_loss - absorption + 10 log10(cross-section x footprint / spacing),
//   then pulse and horizontal_beam blur it, noise_floor is added, and time_varied_gain or level_gain amplify the sum.
#pragma once

#include <insonify/core/numeric.hpp>

#include <concepts>
#include <string_view>
#include <tuple>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

inline namespace INSONIFY_FLAGS {

/// 10^(decibels / 10): for powers.
inline double from_decibels(double decibels) {
    return numeric::exp(decibels * 0.23025850929940458);
}

}  // namespace INSONIFY_FLAGS

/// The source level.
struct source_level {
    float decibels = 0;
    INSONIFY_MEMBER double over_range(double) const { return from_decibels(static_cast<double>(decibels)); }
};

/// Two-way spherical spreading: 40 log10 R, R in metres.
struct spreading_loss {
    INSONIFY_MEMBER double over_range(double range) const { return 1 / (range * range * range * range); }
};

/// Two-way absorption of sea water: 2 alpha R. About 76, 116, 169, 322 dB/km at 300, 450, 600, 900 kHz in salt
/// water, 30, 68, 122, 274 in fresh (M. A. Ainslie, J. G. McColm. A Simplified Formula for Viscous and Chemical
/// Absorption in Sea Water. JASA 103, 1998, at 10 degrees, 20 m).
struct absorption {
    float decibels_per_km = 169;
    INSONIFY_MEMBER double over_range(double range) const {
        return from_decibels(-0.002 * static_cast<double>(decibels_per_km) * range);
    }
};

/// The two-way vertical beam pattern: Gaussian about an axis below the horizon, plus omnidirectional side lobes. Side
/// lobes receive the first return from straight below.
struct vertical_beam {
    float beamwidth = static_cast<float>(numeric::to_radians(50));  ///< between the -3 dB points of one way, radians
    float tilt = static_cast<float>(numeric::to_radians(20));       ///< of the axis below the horizon, radians
    float side_lobes = 1e-3f;                                       ///< two-way power relative to that on the axis
    /// @param across, down  of the unit vector along the ray
    INSONIFY_MEMBER double over_direction(double across, double down) const {
        double off_axis = numeric::atan2(down, across) - static_cast<double>(tilt);
        if (off_axis > numeric::pi) off_axis -= 2 * numeric::pi;
        if (off_axis < -numeric::pi) off_axis += 2 * numeric::pi;
        off_axis /= static_cast<double>(beamwidth);
        return static_cast<double>(side_lobes) + numeric::exp(-5.545177444479562 * off_axis * off_axis);  // 8 ln 2
    }
};

/// The two-way horizontal beam pattern: a Gaussian along the track whose width in metres grows with range. It blurs
/// over adjacent pings, and the insonified area grows with it.
struct horizontal_beam {
    float beamwidth = static_cast<float>(numeric::to_radians(0.3));  ///< between the -3 dB points of one way, radians
    /// Equivalent width along the track, metres: the integral of the pattern.
    INSONIFY_MEMBER double footprint(double range) const { return 0.7526967 * range * static_cast<double>(beamwidth); }
    /// Metres to either side beyond which the pattern counts as 0.
    INSONIFY_MEMBER double reach(double range) const { return range * static_cast<double>(beamwidth); }
    INSONIFY_MEMBER double pattern(double along, double range) const {
        const double off_axis = along / (range * static_cast<double>(beamwidth));
        return numeric::exp(-5.545177444479562 * off_axis * off_axis);
    }
    /// Correlation length (1 / e) of speckle intensities along the track, metres. Two pings correlate while the sonar
    /// has moved by only a fraction of its array (phases persist) and of the footprint (scatterers persist). Gaussian
    /// patterns make both correlations Gaussian, with lengths of 0.2650 wavelength / beamwidth and 0.6006 range x
    /// beamwidth.
    /// @param wavelength  of the sound, metres: 0.0033 at 450 kHz
    INSONIFY_TAGGED double speckle_length(double range, double wavelength) const {
        const double by_footprint = 0.6005612 * range * static_cast<double>(beamwidth);
        const double by_phase = 0.2650104 * wavelength / static_cast<double>(beamwidth);
        return by_footprint * by_phase / numeric::square_root(by_footprint * by_footprint + by_phase * by_phase);
    }
};

/// The pulse: a rectangle around the range of every echo.
struct pulse {
    float length = 0.03f;  ///< metres of range: c x duration / 2, or c / (2 x bandwidth)
    INSONIFY_MEMBER double range_length() const { return static_cast<double>(length); }
};

/// The mean intensity of the receiver's noise. Speckle makes it fluctuate.
struct noise_floor {
    float intensity = 1e-13f;  ///< before gain, in the unit of the bins: m^2 at 1 m, after source level and losses
    INSONIFY_MEMBER double noise() const { return static_cast<double>(intensity); }
};

namespace detail {

/// Below this sine the law is extended linearly: law(min_grazing_sine) x sine / min_grazing_sine.
inline constexpr float min_grazing_sine = 1e-3f;

}  // namespace detail

/// The echo of level seabed at the datum that gains are computed for.
struct flat_echo {
    double range, altitude;  ///< metres; above the datum
    double bin, spacing;     ///< metres
    bool is_slant_range;     ///< bins are of slant range, or else of ground range
};

/// Gain that compensates spreading and absorption. Seabed whose strength does not depend on the angle comes out level,
/// up to 1 / cos(grazing angle), at 40 dB per decade, or at 30 with a horizontal beam.
struct time_varied_gain {
    float spreading = 40;         ///< decibels per tenfold range
    float absorption_per_km = 0;  ///< decibels, one way, as in `absorption`
    float decibels = 0;           ///< at 1 m
    template <class LevelAt>
    INSONIFY_MEMBER double gain(const flat_echo& e, const LevelAt&) const {
        return numeric::pow(e.range, 0.1 * static_cast<double>(spreading)) *
               from_decibels(static_cast<double>(decibels) + 0.002 * static_cast<double>(absorption_per_km) * e.range);
    }
};

/// Gain under which level seabed at the datum, of reflectivity 1, has intensity 1, whatever the other parts are: beam
/// pattern, spreading, law and area. Above `steepest`, and before the first return, it takes the grazing angle to be
/// `steepest`, so that the first return stays bright; losses by range are still compensated.
struct level_gain {
    float steepest = static_cast<float>(numeric::pi / 4);  ///< radians, below pi / 2
    template <class LevelAt>
    INSONIFY_TAGGED double gain(const flat_echo& e, const LevelAt& level_at) const {
        const double limit = numeric::sin_cos(static_cast<double>(steepest)).sine;
        const double sine = e.altitude / e.range;
        const double level = level_at(sine > 0 && sine < limit ? sine : limit);
        return level > 0 ? 1 / level : 0;
    }
};

namespace detail::inline INSONIFY_FLAGS {

inline void require_beamwidth(std::string_view name, float radians) {
    require(radians > 0 && static_cast<double>(radians) <= 2 * numeric::pi, name, radians,
            "radians, above 0 and at most 2 pi");
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

// Recordings call `validate` for each part whose type has one, also for your own. They throw invalid_input for a value
// out of range.

inline void validate(const source_level& s) {
    detail::require_range("source_level.decibels", s.decibels, -300, 300, "-300 to 300 dB");
}
inline void validate(const absorption& a) {
    detail::require_range("absorption.decibels_per_km", a.decibels_per_km, 0, 3000, "0 to 3000 dB");
}
inline void validate(const vertical_beam& b) {
    detail::require_beamwidth("vertical_beam.beamwidth", b.beamwidth);
    detail::require_range("vertical_beam.tilt", static_cast<double>(b.tilt), -numeric::pi, numeric::pi,
                          "-pi to pi radians");
    detail::require_not_negative("vertical_beam.side_lobes", b.side_lobes);
}
inline void validate(const horizontal_beam& b) {
    detail::require_beamwidth("horizontal_beam.beamwidth", b.beamwidth);
}
inline void validate(const pulse& p) {
    detail::require_range("pulse.length", p.length, 0, 1e5f, "0 to 10^5 metres");
}
inline void validate(const noise_floor& n) {
    detail::require_not_negative("noise_floor.intensity", n.intensity);
}
inline void validate(const time_varied_gain& g) {
    detail::require_range("time_varied_gain.spreading", g.spreading, 0, 60, "0 to 60 dB");
    detail::require_range("time_varied_gain.absorption_per_km", g.absorption_per_km, 0, 3000, "0 to 3000 dB");
    detail::require_range("time_varied_gain.decibels", g.decibels, -300, 300, "-300 to 300 dB");
}
inline void validate(const level_gain& g) {
    detail::require(g.steepest > 0 && static_cast<double>(g.steepest) < numeric::pi / 2, "level_gain.steepest",
                    g.steepest, "above 0 and below pi / 2");
}

}  // namespace INSONIFY_FLAGS

namespace detail::inline INSONIFY_FLAGS {
template <class P>
concept direction_part = requires(const P& p) {
    { p.over_direction(1.0, 0.0) } -> std::convertible_to<double>;
};
template <class P>
concept range_part = requires(const P& p) {
    { p.over_range(1.0) } -> std::convertible_to<double>;
};
template <class P>
concept footprint_part = requires(const P& p) {
    { p.footprint(1.0) } -> std::convertible_to<double>;
    { p.reach(1.0) } -> std::convertible_to<double>;
    { p.pattern(0.0, 1.0) } -> std::convertible_to<double>;
};
template <class P>
concept pulse_part = requires(const P& p) {
    { p.range_length() } -> std::convertible_to<double>;
};
template <class P>
concept noise_part = requires(const P& p) {
    { p.noise() } -> std::convertible_to<double>;
};
/// Placeholder for the `level_at` argument of gain(), whose type depends on the equation.
struct any_level {
    double operator()(double sine) const;
};
template <class P>
concept gain_part = requires(const P& p, const flat_echo& e, const any_level& level_at) {
    { p.gain(e, level_at) } -> std::convertible_to<double>;
};
}  // namespace detail::inline INSONIFY_FLAGS

/// A part of the sonar equation: one of the above, or your own type with the functions of one of them.
template <class P>
concept equation_part = detail::direction_part<P> || detail::range_part<P> || detail::footprint_part<P> ||
    detail::pulse_part<P> || detail::noise_part<P> || detail::gain_part<P>;

/// A list of parts, as in `sonar_equation{spreading_loss{}, absorption{}, time_varied_gain{}}`, in any order; at
/// most one horizontal beam and one pulse. Gains multiply, and a level_gain takes no account of others: use one.
template <class... Parts>
class sonar_equation {
  public:
    static_assert((equation_part<Parts> && ...),
                  "a part of the sonar equation has one of over_direction(across, down), over_range(metres), "
                  "range_length(), noise() and gain(flat_echo, level_at), or footprint(range), reach(range) and "
                  "pattern(along, range); they are const and return double");
    static constexpr bool has_ranges = (detail::range_part<Parts> || ...) || (detail::footprint_part<Parts> || ...);
    static constexpr bool has_noise = (detail::noise_part<Parts> || ...);
    static constexpr bool has_gain = (detail::gain_part<Parts> || ...);
    static_assert((int{detail::footprint_part<Parts>} + ... + 0) <= 1, "a sonar has one horizontal beam");
    static_assert((int{detail::pulse_part<Parts>} + ... + 0) <= 1, "a sonar has one pulse");

    sonar_equation() = default;
    INSONIFY_MEMBER explicit(sizeof...(Parts) == 1) sonar_equation(Parts... parts) requires(sizeof...(Parts) > 0)
        : parts_(parts...) {}

    /// Factor on power along a ray, given by its unit vector.
    INSONIFY_TAGGED double over_direction(double across, double down) const {
        return product([&](const auto& p) {
            if constexpr (detail::direction_part<decltype(p)>)
                return static_cast<double>(p.over_direction(across, down));
            else
                return 1.0;
        });
    }
    /// Factor on power from a range, with pings `spacing` metres apart.
    INSONIFY_TAGGED double over_range(double range, double spacing) const {
        return product([&](const auto& p) {
            if constexpr (detail::range_part<decltype(p)>)
                return static_cast<double>(p.over_range(range));
            else if constexpr (detail::footprint_part<decltype(p)>)
                return static_cast<double>(p.footprint(range)) / spacing;
            else
                return 1.0;
        });
    }
    /// Factor of the receiver's gain. `law` is that of the seabed.
    template <class Law>
    INSONIFY_TAGGED double gain(const flat_echo& e, const Law& law) const {
        const auto level_at = [&](double sine) {
            const double cosine = numeric::square_root(1 - sine * sine);
            const double length = e.is_slant_range ? e.bin / cosine : e.bin;
            // As for rays, the law is extended linearly below min_grazing_sine.
            const double clamped = (std::max)(sine, static_cast<double>(detail::min_grazing_sine));
            return static_cast<double>(law(static_cast<float>(clamped))) * (sine / clamped) * length * e.spacing *
                   over_direction(cosine, sine) * over_range(e.range, e.spacing);
        };
        return product([&](const auto& p) {
            if constexpr (detail::gain_part<decltype(p)>)
                return static_cast<double>(p.gain(e, level_at));
            else
                return 1.0;
        });
    }
    /// Mean intensity of noise.
    INSONIFY_TAGGED double noise() const {
        double sum = 0;
        for_each([&](const auto& p) {
            if constexpr (detail::noise_part<decltype(p)>) sum += p.noise();
        });
        return sum;
    }
    /// Calls `fn` with each part.
    template <class Fn>
    INSONIFY_MEMBER void for_each(const Fn& fn) const {
        std::apply([&](const auto&... p) { (fn(p), ...); }, parts_);
    }

  private:
    template <class Fn>
    INSONIFY_MEMBER double product(const Fn& factor) const {
        return std::apply([&](const auto&... p) { return (factor(p) * ... * 1.0); }, parts_);
    }

    std::tuple<Parts...> parts_;
};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
