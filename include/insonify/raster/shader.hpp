// Shaders: callables that the rasterizer inlines into its loops.
//
// A vertex shader maps a vertex to clip space; a fragment shader is called once for every visible pixel. Either may be
// written for one vertex or pixel, or over SIMD lanes for several at a time. Both must be pure: vertices may be shaded
// more than once, and pixels in any order and on any thread.
#pragma once

#include <insonify/core/detail/portable.hpp>
#include <insonify/core/error.hpp>
#include <insonify/core/simd/lanes.hpp>
#include <insonify/raster/interpolatable.hpp>

#include <array>
#include <concepts>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Input of a vertex shader.
struct vertex {
    glm::vec3 position;
    glm::vec3 normal;  ///< zero where the mesh has none
    std::uint32_t index;
};

/// Output of a vertex shader that has varyings. The view volume is -w <= x <= w, -w <= y <= w (y up), 0 <= z <= w.
template <class Varyings>
struct vertex_output {
    glm::vec4 clip;
    Varyings varyings;  ///< interpolated between the vertices for fragment shaders
};

/// `shader(vertex)` returns a clip position.
template <class S>
concept position_shader = requires(const S& shader, const vertex& v) {
    { shader(v) } -> std::convertible_to<glm::vec4>;
};
/// `shader(vertex)` returns a vertex_output, or a type of the caller's with the same members.
template <class S>
concept varying_shader = requires(const S& shader, const vertex& v) {
    { shader(v).clip } -> std::convertible_to<glm::vec4>;
    requires interpolatable<std::remove_cvref_t<decltype(shader(v).varyings)>>;
};
/// A shader with or without varyings.
template <class S>
concept vertex_shader = position_shader<S> || varying_shader<S>;

/// A vertex shader that can also shade several vertices at a time: `shader(clip, varyings, position, normal)` takes
/// arrays of SIMD values, one array element per float, and sets the first two to the same bits that `shader(vertex)`
/// returns. Normals are zero if the mesh has none.
template <class S, class Floats>
concept vertex_lane_shader = vertex_shader<S> &&
    requires(const S& shader, Floats (&four)[4], const Floats (&three)[3]) {
    shader(four, &four[0], three, three);
};

/// The varyings of a shader that has none.
struct no_varyings {};

namespace detail::inline INSONIFY_FLAGS {

template <class Output>
INSONIFY_INLINE glm::vec4 position_of(const Output& output) {
    if constexpr (requires { output.clip; })
        return output.clip;
    else
        return output;
}

template <vertex_shader S>
INSONIFY_INLINE auto varyings_at(const S& shader, const vertex& v) {
    if constexpr (position_shader<S>)
        return no_varyings{};
    else
        return shader(v).varyings;
}

/// The weighted mean of three values, computed in double and rounded once per float.
template <class V>
INSONIFY_INLINE V weighted(const V& a, const V& b, const V& c, const glm::dvec3& weights) {
    if constexpr (std::is_empty_v<V>) {
        return a;
    } else {
        using floats = std::array<float, sizeof(V) / sizeof(float)>;
        const auto fa = numeric::bit_cast<floats>(a);
        const auto fb = numeric::bit_cast<floats>(b);
        const auto fc = numeric::bit_cast<floats>(c);
        floats sum;
        for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] =
                static_cast<float>(static_cast<double>(fa[i]) * weights.x + static_cast<double>(fb[i]) * weights.y +
                                   static_cast<double>(fc[i]) * weights.z);
        return numeric::bit_cast<V>(sum);
    }
}

}  // namespace detail::inline INSONIFY_FLAGS

/// The varyings of a vertex shader; no_varyings if it has none.
template <vertex_shader S>
using varyings_of = decltype(detail::varyings_at(std::declval<const S&>(), std::declval<const vertex&>()));

/// Input of a fragment shader: one visible pixel of one triangle.
template <class Varyings>
struct fragment {
    int x, y;                ///< pixel, row 0 at the top
    float depth;             ///< z / w at the pixel's centre
    std::uint32_t triangle;  ///< index into mesh.triangles
    glm::vec3 weights;       ///< barycentric, perspective-correct
    bool front;              ///< seen from its counter-clockwise side
    Varyings varyings;       ///< interpolated perspective-correctly
};

/// `shader(fragment)` returns the pixel's new value, or nothing if it stores its results itself. It is called exactly
/// once for every visible pixel, after all triangles of the draw have been tested against each other.
template <class S, class Varyings, class Pixel>
concept fragment_shader = requires(const S& shader, const fragment<Varyings>& f) {
    shader(f);
    requires std::is_void_v<Pixel> || std::is_convertible_v<decltype(shader(f)), Pixel>;
};

inline namespace INSONIFY_FLAGS {

template <int N, class Varyings>
class fragment_lanes;

}  // namespace INSONIFY_FLAGS

/// `shader(fragment_lanes<N, Varyings>)` shades N adjacent pixels of a row and stores its results itself, for every N
/// that the build dispatches to (1, 4, 8). Weights and varyings are computed in float; those of a fragment_shader are
/// rounded once from doubles.
///
/// If it has a member `clear(rect)`, draws that clear the depth call it for each tile before the tile's pixels are
/// shaded.
template <class S, class Varyings>
concept fragment_lane_shader = requires(const S& shader, const fragment_lanes<INSONIFY_SIMD ? 4 : 1, Varyings>& f) {
    shader(f);
};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
