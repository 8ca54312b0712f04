// Options of a draw, and the counts that it returns.
#pragma once

#include <insonify/core/simd/dispatch.hpp>

#include <cstdint>
#include <limits>

namespace insonify {
inline namespace INSONIFY_ABI {

/// The side of a triangle that is not drawn. A triangle's front is where its vertices run counter-clockwise.
enum class cull_mode { none, back, front };

/// The depth test: a surface replaces the pixel's if its depth is less, or greater, than the stored one.
enum class depth_compare {
    less,     ///< z = 0 at the near plane, growing away from the camera
    greater,  ///< reversed z, or heights seen from above
};

/// Contents of the target before a draw.
enum class depth_load {
    keep,   ///< depths of earlier draws, which occlude this one
    clear,  ///< none: the target is overwritten without being read; see framebuffer for its color
};

inline namespace INSONIFY_FLAGS {

/// Depth of a pixel without a visible triangle.
constexpr float empty_depth(depth_compare compare) {
    return compare == depth_compare::less ? std::numeric_limits<float>::infinity()
                                          : -std::numeric_limits<float>::infinity();
}

}  // namespace INSONIFY_FLAGS

/// How depth between the vertices is computed.
enum class depth_precision {
    exact,  ///< correctly rounded: the float nearest to the plane through the three snapped vertices
    /// In float, clamped to the vertices' depths. Depth alone takes a quarter of the time where a mesh has no more
    /// vertices than pixels, and about the same time on finer meshes. Off by at most 2^-22 of the largest depth, plus
    /// 2^-19 of the triangle's range of depths where it fills half of its bounding box, and 2^-7 of it on the thinnest.
    quick,
};

/// Options of a draw. `tile` and `level` never change the result, except that a depth of -0 that was in the target may
/// become +0.
template <depth_precision Depth = depth_precision::exact>
struct draw_options {
    cull_mode cull = cull_mode::none;
    depth_compare compare = depth_compare::less;
    depth_load load = depth_load::keep;  ///< a new image is full of 0, the nearest depth under `less`: clear it
    int subpixel_bits = 8;               ///< 4 to 16: vertices are rounded to 2^-bits pixels
    int tile = 64;                       ///< pixels, a power of two from 8 to 256
    isa level = best_isa();              ///< the widest instruction set to use
};

/// What happened to the triangles of a draw. Each of `triangles` is counted once among drawn, culled, missed,
/// degenerate and not_finite; one beyond a side of the picture is always counted as missed.
struct draw_stats {
    std::uint64_t triangles = 0;   ///< submitted
    std::uint64_t drawn = 0;       ///< the others, whether or not they covered a pixel centre
    std::uint64_t culled = 0;      ///< faced the wrong way
    std::uint64_t missed = 0;      ///< had no pixel centre of the picture in their bounding box
    std::uint64_t degenerate = 0;  ///< had no area on the sub-pixel grid
    std::uint64_t not_finite = 0;  ///< had a vertex that is NaN or infinite
    std::uint64_t clipped = 0;     ///< number of the above that a clipping plane cut
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
