// Flat sand with power-law roughness.
#pragma once

#include <insonify/seabed/any.hpp>
#include <insonify/seabed/roughness.hpp>

#if INSONIFY_BODIES
#include <insonify/seabed/detail/noise.hpp>
#endif

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// Level sand with power-law roughness; `{.surface = {.rms = 0}}` is a plane.
struct flat {
    roughness surface{.rms = 0.007f, .longest = 4, .shortest = 0.06f};
    std::uint64_t seed = 1;
    type kind = type::sand;

    /// @throws invalid_input for parameters out of the ranges of `roughness`
    INSONIFY_TAGGED_ONCE any_sampler prepare() const;
    INSONIFY_MEMBER float sink_depth() const { return 2 * surface.rms; }
};

#if INSONIFY_BODIES

inline namespace INSONIFY_FLAGS {

/// Evaluates `flat`.
class flat_sampler {
  public:
    explicit flat_sampler(const flat& f) : surface_(f.surface, f.seed, detail::stream::sand) {}

    void row(const scanline& line, std::span<float> heights) const {
        detail::by_stretches(line, heights, [&](const detail::stretch& part, detail::stretch_values& values) {
            surface_.add(part, values);
        });
    }

    height_range range() const { return {-surface_.upper_bound(), surface_.upper_bound()}; }

  private:
    detail::power_law_noise surface_;
};

}  // namespace INSONIFY_FLAGS

INSONIFY_FUNCTION any_sampler flat::prepare() const {
    return detail::hold_sampler(detail::with_kind<flat_sampler>{flat_sampler(*this), kind});
}

#endif

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
