// What people bring to a draw: a callable that places vertices, and one that is asked for each visible pixel.
//
// Both are plain callables, inlined into the loops. They must be pure: a vertex may be placed several times, and pixels
// are asked for in any order and on any thread.
#pragma once

#include <insonify/core/detail/portable.hpp>
#include <insonify/core/error.hpp>
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

/// What a vertex callable receives.
struct vertex {
    glm::vec3 position;
    glm::vec3 normal;  ///< zero where the mesh has none
    std::uint32_t index;
};

/// A vertex placed in clip space, with the values that pixels between the vertices shall see interpolated.
/// Visible is -w <= x <= w, -w <= y <= w (y up), 0 <= z <= w.
template <class Varyings>
struct placed_vertex {
    glm::vec4 clip;
    Varyings varyings;
};

/// `shader(vertex)` gives a clip position, alone (glm::vec4) or with varyings (placed_vertex).
template <class S>
concept position_shader = requires(const S& shader, const vertex& v) {
    { shader(v) } -> std::convertible_to<glm::vec4>;
};
template <class S>
concept varying_shader = requires(const S& shader, const vertex& v) {
    { shader(v).clip } -> std::convertible_to<glm::vec4>;
    requires interpolatable<std::remove_cvref_t<decltype(shader(v).varyings)>>;
};
template <class S>
concept vertex_shader = position_shader<S> || varying_shader<S>;

/// Stands for the varyings of a shader that has none.
struct no_varyings {};

namespace detail::inline INSONIFY_FLAGS {

template <vertex_shader S>
struct shader_varyings {
    using type = no_varyings;
};
template <varying_shader S>
struct shader_varyings<S> {
    using type = std::remove_cvref_t<decltype(std::declval<const S&>()(std::declval<const vertex&>()).varyings)>;
};

inline glm::vec4 position_of(const glm::vec4& clip) {
    return clip;
}
template <class Varyings>
INSONIFY_INLINE glm::vec4 position_of(const placed_vertex<Varyings>& placed) {
    return placed.clip;
}

/// A vertex callable that takes several vertices at a time, too: `shader(clip, varyings, position, normal)` sets the
/// first two, float by float, and they are the same bits that `shader(vertex)` gives.
template <class S, class Floats>
concept lane_shader = vertex_shader<S> && requires(const S& shader, Floats (&four)[4], const Floats (&three)[3]) {
    shader(four, &four[0], three, three);
};

template <vertex_shader S>
INSONIFY_INLINE glm::vec4 clip_position(const S& shader, const vertex& v) {
    return position_of(shader(v));
}

template <vertex_shader S>
INSONIFY_INLINE auto varyings_at(const S& shader, const vertex& v) {
    if constexpr (position_shader<S>)
        return no_varyings{};
    else
        return shader(v).varyings;
}

/// The mean of three values by weights, float by float, each rounded once.
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

template <vertex_shader S>
using varyings_of = typename detail::shader_varyings<S>::type;

/// What a fragment callable receives: one visible pixel of one triangle.
template <class Varyings>
struct fragment {
    int x, y;                ///< pixel, row 0 at the top
    float depth;             ///< z / w at the pixel's centre
    std::uint32_t triangle;  ///< index into mesh.triangles
    glm::vec3 weights;       ///< of the triangle's three vertices, perspective-correct, sum 1
    bool front;              ///< seen from its counter-clockwise side
    Varyings varyings;       ///< interpolated perspective-correctly
};

/// `shader(fragment)` gives the pixel's new value, or nothing if it stores what it wants by itself: every visible pixel
/// is asked for exactly once per draw, after all of the draw's triangles have been resolved against each other.
template <class S, class Varyings, class Pixel>
concept fragment_shader = requires(const S& shader, const fragment<Varyings>& f) {
    requires std::is_void_v<Pixel> || std::is_convertible_v<decltype(shader(f)), Pixel>;
};

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
