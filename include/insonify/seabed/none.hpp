// No seabed at all: for scenes that bring theirs as a mesh.
#pragma once

#include <insonify/seabed/model.hpp>

#include <limits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::seabed {

/// Nothing there: no height is known anywhere (NaN), nothing is drawn and nothing rests on it.
struct none {
    static constexpr type kind = type::sand;

    struct sampler {
        void row(const scanline&, std::span<float> heights) const {
            std::fill(heights.begin(), heights.end(), std::numeric_limits<float>::quiet_NaN());
        }
        height_range range() const { return {}; }
    };
    sampler prepare() const { return {}; }
    float operator()(double, double) const { return std::numeric_limits<float>::quiet_NaN(); }
};

}  // namespace insonify::inline INSONIFY_ABI::seabed

INSONIFY_ARITHMETIC_END
