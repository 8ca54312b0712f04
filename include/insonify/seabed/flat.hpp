// Flat sand with power-law roughness.
#pragma once

#include <insonify/seabed/detail/noise.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

inline namespace INSONIFY_FLAGS {

class flat_sampler;

}  // namespace INSONIFY_FLAGS

/// Level sand with power-law roughness; `{.surface = {.rms = 0}}` is a plane.
struct flat {
    roughness surface{.rms = 0.007f, .longest = 4, .shortest = 0.06f};
    std::uint64_t seed = 1;
    type kind = type::sand;

    /// @throws invalid_input for parameters out of the ranges of `roughness`
    INSONIFY_TAGGED flat_sampler prepare() const;
    INSONIFY_TAGGED float operator()(double x, double y) const;
    INSONIFY_MEMBER float sink_depth() const { return 2 * surface.rms; }
};

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
    power_law_noise surface_;
};

}  // namespace INSONIFY_FLAGS

inline flat_sampler flat::prepare() const {
    return flat_sampler(*this);
}
inline float flat::operator()(double x, double y) const {
    return height_at(prepare(), x, y);
}

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
