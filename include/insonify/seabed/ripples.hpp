// Sand ripples: one system of crests or two that cross, with fine roughness.
#pragma once

#include <insonify/seabed/any.hpp>
#include <insonify/seabed/ripple_system.hpp>
#include <insonify/seabed/roughness.hpp>

#if INSONIFY_BODIES
#include <insonify/seabed/detail/noise.hpp>
#include <insonify/seabed/detail/ripple_train.hpp>
#endif

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// Rippled sand. The first six parameters are those of `ripple_system`.
struct ripples {
    float wavelength = 0.8f;  ///< metres, 0.0001 to 10^6: from crest to crest; nature has 0.05 to 1.5
    float steepness = 0.11f;  ///< in [0, 0.5]: height / wavelength; nature has 0.05 to 0.2
    float direction = 0;      ///< radians from +x: across the crests
    float spread = 0.09f;     ///< radians, in [0, 0.5]: of the direction
    float bandwidth = 0.09f;  ///< in [0, 0.25]: of the wave number, relative
    /// In [0, 0.9]: of the crests, 0 for a sinusoid. The mean level lies below the datum: by 0.06 of the height at
    /// 0.25, by 0.31 at 0.9.
    float sharpness = 0.25f;
    ripple_system second{.steepness = 0};  ///< a second system that crosses the first; none if its steepness is 0
    roughness surface{.rms = 0.0025f, .longest = 0.4f};  ///< added to the ripples
    std::uint64_t seed = 1;
    type kind = type::ripples;

    /// @throws invalid_input for parameters out of their range
    INSONIFY_TAGGED_ONCE any_sampler prepare() const;

    INSONIFY_MEMBER ripple_system first() const {
        return {wavelength, steepness, direction, spread, bandwidth, sharpness};
    }
    /// Metres from trough to crest, of the first system.
    INSONIFY_MEMBER float height() const { return steepness * wavelength; }
    INSONIFY_MEMBER float sink_depth() const { return 0.5f * (height() + second.height()) + 2 * surface.rms; }
    /// Ends of crests per square metre to expect, of the first system.
    INSONIFY_MEMBER double forks() const {
        return 2 * numeric::pi * static_cast<double>(spread) * static_cast<double>(bandwidth) /
               (static_cast<double>(wavelength) * static_cast<double>(wavelength));
    }
};

#if INSONIFY_BODIES

inline namespace INSONIFY_FLAGS {

/// Evaluates `ripples`.
class ripples_sampler {
  public:
    explicit ripples_sampler(const ripples& r)
        : first_(r.first(), r.seed, detail::stream::ripples, "ripples"),
          second_(r.second, r.seed, detail::stream::second_ripples, "ripples.second"),
          surface_(r.surface, r.seed, detail::stream::ripples) {}

    void row(const scanline& line, std::span<float> heights) const {
        detail::by_stretches(line, heights, [&](const detail::stretch& part, detail::stretch_values& values) {
            first_.add(part, values);
            second_.add(part, values);
            surface_.add(part, values);
        });
    }

    /// See ripple_train::psi: of the first system.
    detail::ripple_train::phasor psi(double x, double y) const { return first_.psi(x, y); }

    height_range range() const {
        const double highest = first_.upper_bound() + second_.upper_bound() + surface_.upper_bound();
        return {-highest, highest};
    }

  private:
    detail::ripple_train first_, second_;
    detail::power_law_noise surface_;
};

}  // namespace INSONIFY_FLAGS

INSONIFY_FUNCTION any_sampler ripples::prepare() const {
    return detail::hold_sampler(detail::with_kind<ripples_sampler>{ripples_sampler(*this), kind});
}

#endif

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
