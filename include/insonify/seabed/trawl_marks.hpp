// Furrows that bottom trawls leave in mud.
#pragma once

#include <insonify/config.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// Furrows of trawl doors, 0.05 to 0.3 m deep and 0.2 to 2 m wide.
struct trawl_marks {
    /// Furrows crossed per metre perpendicular to them, summed over all directions, in [0, 1 / (4 width)]; 0 for none.
    /// A line in an arbitrary direction crosses 2 / pi as many on average.
    float density = 0;
    float depth = 0.06f;  ///< metres, >= 0
    float width = 0.5f;   ///< metres, from 0.001: between the tops of the berms
    int directions = 2;   ///< 1 to 8: number of directions of towing
    float length = 150;   ///< metres, from 0.001: the shortest furrow; half have this length, the mean is twice it

    friend bool operator==(const trawl_marks&, const trawl_marks&) = default;
};

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
