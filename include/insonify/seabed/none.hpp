// No seabed: for scenes whose bottom is a mesh, or that have none.
#pragma once

#include <insonify/seabed/model.hpp>

#include <limits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// The absence of a seabed. Heights are NaN everywhere, nothing is drawn, and nothing rests on it.
struct none {
    static constexpr type kind = type::sand;

    // These make it a model; `any` never evaluates it.
    INSONIFY_MEMBER void row(const scanline&, std::span<float> heights) const {
        std::fill(heights.begin(), heights.end(), std::numeric_limits<float>::quiet_NaN());
    }
    INSONIFY_MEMBER height_range range() const { return {}; }
};

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
