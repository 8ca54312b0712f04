// Backscatter laws: returned intensity as a function of the grazing angle.
#pragma once

#include <insonify/core/numeric.hpp>

#include <concepts>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// The material of a surface.
struct material {
    float reflectivity = 0.5f;  ///< relative, 0 or more
};

/// `law(s)` is the backscatter at s, the sine of the grazing angle on the surface (the cosine of incidence), in [0, 1].
/// It is linear, finite and 0 or more. An optional `in_lanes(into, s)` computes several pixels at a time; an optional
/// `validate(law)`, found by argument-dependent lookup, is called before drawing.
template <class L>
concept backscatter_law = requires(const L& law, float s) {
    { law(s) } -> std::convertible_to<float>;
};

/// Lambert's law of optics, s.
struct lambert {
    INSONIFY_MEMBER float operator()(float s) const { return s; }
    template <class Lanes>
    INSONIFY_MEMBER void in_lanes(Lanes& into, const Lanes& s) const {
        into = s;
    }
};

/// Lambert's law for backscattered intensity, s^2 (K. V. Mackenzie. Bottom Reverberation for 530- and 1030-cps Sound in
/// Deep Water. JASA 33, 1961, without its level): one factor s for the projected area that intercepts the sound, one
/// for the radiation that it scatters back.
struct lambert_backscatter {
    INSONIFY_MEMBER float operator()(float s) const { return s * s; }
    template <class Lanes>
    INSONIFY_MEMBER void in_lanes(Lanes& into, const Lanes& s) const {
        into = s * s;
    }
};

/// Lambert's law plus what it leaves out, s^2 + volume s + facets exp(-tan^2(incidence) / (2 slope^2)):
/// scatterers in the upper sediment, or in the growth on a wreck, whose echo falls off with s alone (Lommel and
/// Seeliger's law where sound comes and returns along one line: D. R. Jackson, M. D. Richardson. High-Frequency
/// Seafloor Acoustics, 2007, chapter 14), and the mirror-like echo of facets near normal incidence, which makes the
/// bright band below the sonar (P. Beckmann, A. Spizzichino. The Scattering of Electromagnetic Waves from Rough
/// Surfaces, 1963, chapter 5; Jackson and Richardson, chapter 13: the high-frequency Kirchhoff approximation, without
/// its factor 1 / cos^4(incidence), which is unbounded at grazing incidence).
struct facet_backscatter {
    float facets = 4;     ///< echo at normal incidence over that of Lambert's law, >= 0
    float slope = 0.15f;  ///< rms slope of the facets, above 0: smooth mud 0.05, sand 0.1 to 0.2, gravel 0.3
    float volume = 0;     ///< echo of the volume at normal incidence over that of Lambert's law, >= 0

    INSONIFY_TAGGED float operator()(float s) const {
        if (!(s > 0)) return 0;
        const double square = static_cast<double>(s) * static_cast<double>(s);
        const double tangent_square = 1 / square - 1, spread = static_cast<double>(slope);
        const double exponent = 0.5 * tangent_square / (spread * spread);
        return static_cast<float>(square + static_cast<double>(volume) * static_cast<double>(s) +
                                  (exponent < 80 ? static_cast<double>(facets) * numeric::exp(-exponent) : 0.0));
    }
};

inline namespace INSONIFY_FLAGS {

/// @throws invalid_input for a value out of its range
inline void validate(const facet_backscatter& f) {
    detail::require_not_negative("facet_backscatter.facets", f.facets);
    detail::require_positive("facet_backscatter.slope", f.slope);
    detail::require_not_negative("facet_backscatter.volume", f.volume);
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
