// What became of the triangles of a draw, as counts.
#pragma once

#include <insonify/config.hpp>

#include <cstdint>

namespace insonify {
inline namespace INSONIFY_ABI {

/// What became of a mesh's triangles. Nothing that a draw meets by the million is an error.
/// Each of `triangles` is counted once among drawn, culled, missed, degenerate and not_finite. What lies outside of
/// the picture and needn't be clipped is missed, whatever else it is.
struct draw_stats {
    std::uint64_t triangles = 0;   ///< submitted
    std::uint64_t drawn = 0;       ///< reached the pixel loop
    std::uint64_t culled = 0;      ///< faced the wrong way
    std::uint64_t missed = 0;      ///< covered no pixel centre of the picture
    std::uint64_t degenerate = 0;  ///< no area left on the sub-pixel grid
    std::uint64_t not_finite = 0;  ///< a vertex was NaN or infinite
    std::uint64_t clipped = 0;     ///< of all these, how many were cut by a clipping plane
    std::uint64_t pixels = 0;      ///< shaded; 0 for depth alone

    INSONIFY_TAGGED draw_stats& operator+=(const draw_stats& other) {
        triangles += other.triangles;
        drawn += other.drawn;
        culled += other.culled;
        missed += other.missed;
        degenerate += other.degenerate;
        not_finite += other.not_finite;
        clipped += other.clipped;
        pixels += other.pixels;
        return *this;
    }
    friend bool operator==(const draw_stats&, const draw_stats&) = default;
};

}  // namespace INSONIFY_ABI
}  // namespace insonify
