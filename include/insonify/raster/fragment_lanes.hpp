// The input of fragment shaders over SIMD lanes: N adjacent pixels of a row.
//
//     struct surface { float height, brightness; };  // the varyings of the vertex shader
//
//     struct shade_surface {
//         image<float>& picture;
//         template <int N>  // 4 or 8 by instruction set, 1 without SIMD
//         INSONIFY_INLINE void operator()(const fragment_lanes<N, surface>& f) const {
//             typename fragment_lanes<N, surface>::floats height, brightness;
//             f.interpolate(height, 0);
//             f.interpolate(brightness, 1);
//             f.store(picture, height < 1.0f ? brightness : 0.5f * brightness);
//         }
//     };
//
//     draw(mesh, vertex_shader, shade_surface{picture}, framebuffer<void>{depth});
//
// INSONIFY_INLINE compiles the shader for each instruction set. To read a single lane, copy all of them to an array:
// `float heights[N]; std::memcpy(heights, &height, sizeof height);`.
#pragma once

#include <insonify/core/simd/lanes.hpp>
#include <insonify/raster/shader.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {
template <class Screen, class Varyings, class Shader>
struct lane_shading_kernel;
}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Values of N pixels. Operators and `mask ? a : b` work lane by lane, for N = 1 on plain numbers.
template <class T, int N>
using pixel_lanes = detail::lanes<T, N>;

/// N adjacent pixels of a row, of which some may not be visible. Shaders take it by reference and pass lanes on by
/// reference only: the calling convention of wide vectors depends on the instruction set that is compiled for.
template <int N, class Varyings>
class fragment_lanes {
  public:
    using ints = pixel_lanes<std::int32_t, N>;  ///< masks: 0 or -1
    using floats = pixel_lanes<float, N>;

    int x, y;      ///< pixel of the first lane, row 0 at the top
    ints visible;  ///< mask of the pixels that this draw shades
    bool all_visible;
    std::uint32_t triangles[static_cast<unsigned>(N)];  ///< indices into mesh.triangles
    ints front;                                         ///< mask: seen from the counter-clockwise side
    floats weights[3];                                  ///< barycentric, perspective-correct

    /// Sets `into` to float k of the varyings, interpolated perspective-correctly. Exchanging the triangle's second
    /// and third vertices changes no bit.
    INSONIFY_INLINE void interpolate(floats& into, int k) const {
        into = weights[0] * values_[0][k] + (weights[1] * values_[1][k] + weights[2] * values_[2][k]);
    }
    /// Sets `into` to z / w at the pixels' centres.
    INSONIFY_INLINE void depth(floats& into) const {
        detail::load(into, depth_);
        into = into * depth_sign_ + 0.0f;
    }
    /// Stores one value per visible pixel, converted to the image's type.
    template <class Image, class Values>
    INSONIFY_INLINE void store(Image&& into, const Values& values) const {
        using pixel = std::remove_cvref_t<decltype(into(x, y))>;
        if constexpr (std::is_same_v<pixel, decltype(detail::lane(values, 0))>)
            if (all_visible) return detail::store(&into(x, y), values);
        for (int k = 0; k < N; ++k)
            if (detail::lane(visible, k) != 0) into(x + k, y) = static_cast<pixel>(detail::lane(values, k));
    }

  private:
    template <class Screen, class V, class Shader>
    friend struct detail::lane_shading_kernel;

    static constexpr int varyings_size = (static_cast<int>(sizeof(Varyings)) + 15) / 16 * 4;  ///< as varyings_record
    floats values_[3][static_cast<unsigned>(varyings_size)];  ///< varyings of the vertices
    const float* depth_;                                      ///< in the tile
    float depth_sign_;
};

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
