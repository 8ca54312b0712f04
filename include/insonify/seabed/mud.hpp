// Mud: gentle relief with mounds by burrowing animals, pock marks of seeps, and trawl tracks.
#pragma once

#include <insonify/seabed/any.hpp>
#include <insonify/seabed/roughness.hpp>
#include <insonify/seabed/trawl_marks.hpp>

#if INSONIFY_BODIES
#include <insonify/seabed/detail/noise.hpp>
#include <insonify/seabed/detail/strewn.hpp>
#include <insonify/seabed/detail/trawls.hpp>
#endif

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// Fine sediment: low, smooth relief; scattered mounds and pock marks, each a round bump or dent; furrows, if any.
struct mud {
    roughness surface{.rms = 0.008f, .longest = 4, .shortest = 0.06f};
    float density = 0.2f;        ///< mounds and pock marks per square metre, at most 1 / (4 size)^2; 0 for none
    float size = 0.35f;          ///< metres, from 0.001: radius of the largest; the smallest have 0.4 of it
    float mound_height = 0.04f;  ///< metres, >= 0: of the largest mounds
    float pock_depth = 0.04f;    ///< metres, >= 0: of the largest pock marks
    float pock_fraction = 0.4f;  ///< in [0, 1]: fraction of them that are pock marks
    trawl_marks trawls{};        ///< none unless they have a density
    std::uint64_t seed = 1;
    type kind = type::mud;

    /// @throws invalid_input for parameters out of their range
    INSONIFY_TAGGED_ONCE any_sampler prepare() const;
    INSONIFY_MEMBER float sink_depth() const {
        const float furrows = trawls.density > 0 ? trawls.depth : 0;
        return (std::max)({mound_height, pock_depth, furrows, 2 * surface.rms});
    }
};

#if INSONIFY_BODIES

inline namespace INSONIFY_FLAGS {

/// Evaluates `mud`.
class mud_sampler {
  public:
    explicit mud_sampler(const mud& m) : surface_(m.surface, m.seed, detail::stream::mud), trawls_(m.trawls, m.seed) {
        const float cell = 4 * m.size;
        detail::require_range("mud.size", m.size, 1e-3f, 1e6f, "0.001 to 10^6 metres");
        detail::require(m.density >= 0 && m.density * cell * cell <= 1, "mud.density", m.density,
                        "0 to 1 / (4 size)^2 per square metre");
        detail::require_metres("mud.mound_height", m.mound_height);
        detail::require_metres("mud.pock_depth", m.pock_depth);
        detail::require_fraction("mud.pock_fraction", m.pock_fraction);
        const float filled = m.density * cell * cell;
        marks_ = {static_cast<double>(cell),       filled, filled * (1 - m.pock_fraction), m.mound_height, m.pock_depth,
                  {m.seed, detail::stream::mounds}};
    }

    void row(const scanline& line, std::span<float> heights) const {
        detail::by_stretches(line, heights, [&](const detail::stretch& part, detail::stretch_values& values) {
            surface_.add(part, values);
            marks_.add(part, values);
            trawls_.add(part, values);
        });
    }

    height_range range() const {
        return {marks_.lowest() + trawls_.lowest() - surface_.upper_bound(),
                marks_.highest() + trawls_.highest() + surface_.upper_bound()};
    }

  private:
    detail::power_law_noise surface_;
    detail::round_marks marks_;
    detail::trawl_furrows trawls_;
};

}  // namespace INSONIFY_FLAGS

INSONIFY_FUNCTION any_sampler mud::prepare() const {
    return detail::hold_sampler(detail::with_kind<mud_sampler>{mud_sampler(*this), kind});
}

#endif

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
