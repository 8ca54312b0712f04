// Overhead pictures: their options, and the functions that draw them. The renderer is in render.hpp.
#pragma once

#include <insonify/core/executor.hpp>
#include <insonify/raster/draw_options.hpp>
#include <insonify/shadow/policy.hpp>
#include <insonify/sonar/backscatter.hpp>
#include <insonify/sonar/frame.hpp>
#include <insonify/sonar/overhead/rig.hpp>
#include <insonify/sonar/scene.hpp>

#include <cstdint>
#include <type_traits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Options of an overhead picture. The types select what is computed: Shadow is a shadow::policy, Labels are `labels`
/// or `no_labels`, and Depth is how depths between vertices are rounded.
template <class Shadow = shadow::exact, class Labels = labels, backscatter_law Law = lambert,
          depth_precision Depth = depth_precision::quick>
struct render_options {
    Shadow shadow{};
    Law law{};
    double cell = 0;  ///< metres between the vertices at which the seabed is sampled; 0: two pixels on level ground
    /// Largest distance towards the light at which the seabed can cast shadows into the picture, in multiples of the
    /// picture's longer side. Less is sampled if the seabed is too low to cast that far. The default covers
    /// `seabed::rock` under the default rig down to a grazing angle of 0.3 degrees.
    float reach = 8;
    /// See draw_options. Finer with shadows, as the triangle that a pixel shows decides whether it faces the light.
    int subpixel_bits = std::is_same_v<Shadow, shadow::none> ? 8 : 12;
    int tile = 64;  ///< see draw_options
    isa level = best_isa();

    /// The same options with another shadow policy, another law, without labels, or with correctly rounded depths.
    template <shadow::policy Other>
    INSONIFY_MEMBER render_options<Other, Labels, Law, Depth> with(const Other& other) const {
        return retyped<Other, Labels, Law, Depth>(other, law);
    }
    template <backscatter_law Other>
    INSONIFY_MEMBER render_options<Shadow, Labels, Other, Depth> with(const Other& other) const {
        return retyped<Shadow, Labels, Other, Depth>(shadow, other);
    }
    INSONIFY_MEMBER render_options<Shadow, no_labels, Law, Depth> without_labels() const {
        return retyped<Shadow, no_labels, Law, Depth>(shadow, law);
    }
    INSONIFY_MEMBER render_options<Shadow, Labels, Law, depth_precision::exact> with_exact_depth() const {
        return retyped<Shadow, Labels, Law, depth_precision::exact>(shadow, law);
    }

  private:
    template <class S, class L, class B, depth_precision D>
    INSONIFY_MEMBER render_options<S, L, B, D> retyped(const S& policy, const B& backscatter) const {
        return {policy, backscatter, cell, reach, subpixel_bits, tile, level};
    }
};

/// The triangle that each pixel of a picture shows.
struct visibility {
    static constexpr std::uint32_t no_triangle = shadow::invalid_id;

    image<std::uint16_t> instance;  ///< as in labels::instance
    image<std::uint32_t> triangle;  ///< of the target's mesh, or of the seabed's; no_triangle where neither is visible
};

namespace detail::inline INSONIFY_FLAGS {

// Defined in render.hpp.
template <class Shadow, class Labels, class Law, depth_precision Depth>
class overhead_renderer;

template <class Shadow, class Labels, class Law, depth_precision Depth>
auto renderer_of(const scene& s, const overhead& rig, const render_options<Shadow, Labels, Law, Depth>& options,
                 executor_ref ex) {
    using renderer = overhead_renderer<Shadow, Labels, Law, Depth>;
    static_assert(
        requires { sizeof(renderer); },
        "a shadow policy, law or depth other than the built-in ones needs #include "
        "<insonify/sonar/overhead/render.hpp> in the compiled form");
    return renderer(s, rig, options, ex);
}

template <class Shadow, class Labels, class Law, depth_precision Depth>
frame<Labels> render_frame(const scene& s, const overhead& rig,
                           const render_options<Shadow, Labels, Law, Depth>& options, executor_ref ex) {
    return renderer_of(s, rig, options, ex).render_frame(ex);
}
template <class Law, depth_precision Depth>
visibility render_visibility(const scene& s, const overhead& rig,
                             const render_options<shadow::none, labels, Law, Depth>& options, executor_ref ex) {
    return renderer_of(s, rig, options, ex).render_visibility(ex);
}

}  // namespace detail::inline INSONIFY_FLAGS

#if defined(INSONIFY_COMPILED)
namespace detail::inline INSONIFY_ONCE {

template <class Shadow, class Labels>
using built_in = const render_options<Shadow, Labels>&;

#define INSONIFY_PICTURES(each) \
    each(shadow::exact, labels) each(shadow::none, labels) each(shadow::exact, no_labels) each(shadow::none, no_labels)
#define INSONIFY_PICTURE(Shadow, Labels) \
    frame<Labels> render_frame(const scene& s, const overhead& rig, built_in<Shadow, Labels> options, executor_ref ex);
INSONIFY_PICTURES(INSONIFY_PICTURE)
#undef INSONIFY_PICTURE
visibility render_visibility(const scene& s, const overhead& rig, built_in<shadow::none, labels> options,
                             executor_ref ex);

}  // namespace detail::inline INSONIFY_ONCE
#endif

inline namespace INSONIFY_FLAGS {

/// Draws a scene from above.
///
/// @param s        the seabed and its targets
/// @param rig      camera and light; see there for the unit of pixels
/// @param options  shadow policy, labels, backscatter law and depth by type; sampling of the seabed
/// @param ex       runs it; the result is the same bytes for any executor
/// @returns a picture of rig.size pixels, linear in [0, 1], with labels of the same size and statistics
/// @throws invalid_input for a rig, a seabed, a material, a pose or an option out of range
template <class Shadow = shadow::exact, class Labels = labels, backscatter_law Law = lambert,
          depth_precision Depth = depth_precision::quick, executor_argument E = serial_executor>
frame<Labels> render(const scene& s, const overhead& rig,
                     const render_options<Shadow, Labels, Law, Depth>& options = {}, E&& ex = {}) {
    return detail::render_frame(s, rig, options, executor_ref(ex));
}

/// The triangles that `render` shows with the same options. Those of the seabed are numbered in the grid that a picture
/// without shadows samples.
/// @throws invalid_input as `render` does
template <class Shadow = shadow::exact, class Labels = labels, backscatter_law Law = lambert,
          depth_precision Depth = depth_precision::quick, executor_argument E = serial_executor>
visibility visible_triangles(const scene& s, const overhead& rig,
                             const render_options<Shadow, Labels, Law, Depth>& options = {}, E&& ex = {}) {
    const render_options<shadow::none, labels, Law, Depth> seen{.law = options.law,
                                                                .cell = options.cell,
                                                                .reach = options.reach,
                                                                .subpixel_bits = options.subpixel_bits,
                                                                .tile = options.tile,
                                                                .level = options.level};
    return detail::render_visibility(s, rig, seen, executor_ref(ex));
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
