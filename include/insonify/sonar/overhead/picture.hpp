// One overhead picture: its options and the functions that draw it. render.hpp has the code behind them.
#pragma once

#include <insonify/core/executor.hpp>
#include <insonify/core/simd/dispatch.hpp>
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

/// How to draw a picture; the types say what is in it. Shadow is a shadow::policy, Labels are `labels` or `no_labels`.
template <class Shadow = shadow::exact, class Labels = labels, backscatter_law Law = lambert>
struct render_options {
    Shadow shadow{};
    Law law{};
    int cells = 0;  ///< of the seabed, along the picture's longer side; 0: one for every two pixels
    /// How far up the light the seabed may cast from, at most, in lengths of the picture; it is sampled no farther than
    /// its heights can throw a shadow anyway. Light below 1 degree over rock comes from farther, and passes there.
    float reach = 8;
    /// Pixels: by how much the seabed's mesh may displace what is seen, and on level ground the edge of a shadow. 0
    /// draws every cell; more draws fewer triangles the smoother the bottom, and costs the time to find out.
    float edge_error = 0;
    float slope_error = 0.02f;  ///< by how much its slopes may then be off, metres per metre
    /// See draw_options. Which triangle a pixel shows decides whether it faces the light, too.
    int subpixel_bits = std::is_same_v<Shadow, shadow::none> ? 8 : 12;
    int tile = 64;  ///< see draw_options
    isa level = best_isa();

    /// The same options with another shadow policy, another law, or without labels.
    template <shadow::policy Other>
    INSONIFY_MEMBER render_options<Other, Labels, Law> with(const Other& other) const {
        return {other, law, cells, reach, edge_error, slope_error, subpixel_bits, tile, level};
    }
    template <backscatter_law Other>
    INSONIFY_MEMBER render_options<Shadow, Labels, Other> with(const Other& other) const {
        return {shadow, other, cells, reach, edge_error, slope_error, subpixel_bits, tile, level};
    }
    INSONIFY_MEMBER render_options<Shadow, no_labels, Law> without_labels() const {
        return {shadow, law, cells, reach, edge_error, slope_error, subpixel_bits, tile, level};
    }
};

/// Which triangle each pixel of a picture shows.
struct visibility {
    static constexpr std::uint32_t no_triangle = shadow::invalid_id;

    image<std::uint16_t> instance;  ///< as in labels::instance
    image<std::uint32_t> triangle;  ///< of the target's mesh, or of the bottom's; no_triangle where nothing is shown
};

namespace detail::inline INSONIFY_FLAGS {

template <class Shadow, class Labels, class Law>
frame<Labels> paint(const scene& s, const overhead& rig, const render_options<Shadow, Labels, Law>& options,
                    executor_ref ex);
template <class Law>
visibility see(const scene& s, const overhead& rig, const render_options<shadow::none, labels, Law>& options,
               executor_ref ex);

}  // namespace detail::inline INSONIFY_FLAGS

#if defined(INSONIFY_COMPILED)
namespace detail::inline INSONIFY_ONCE {

template <class Shadow, class Labels>
using built_in = const render_options<Shadow, Labels>&;

frame<labels> paint(const scene& s, const overhead& rig, built_in<shadow::exact, labels> options, executor_ref ex);
frame<labels> paint(const scene& s, const overhead& rig, built_in<shadow::none, labels> options, executor_ref ex);
frame<no_labels> paint(const scene& s, const overhead& rig, built_in<shadow::exact, no_labels> options,
                       executor_ref ex);
frame<no_labels> paint(const scene& s, const overhead& rig, built_in<shadow::none, no_labels> options, executor_ref ex);
visibility see(const scene& s, const overhead& rig, built_in<shadow::none, labels> options, executor_ref ex);

}  // namespace detail::inline INSONIFY_ONCE
#endif

inline namespace INSONIFY_FLAGS {

/// Draws a scene as the paper's rig sees it.
///
/// @param s        the seabed and its targets
/// @param rig      camera and light; see there for what a pixel means
/// @param options  types of shadow, labels and backscatter law, and how finely the seabed is sampled
/// @param ex       who runs it; the result is the same bytes for any executor
/// @returns a picture of rig.size pixels, linear in [0, 1], with labels of the same size and what was drawn
/// @throws invalid_input for a rig, a seabed, a material, a pose or an option that can't be right
template <class Shadow = shadow::exact, class Labels = labels, backscatter_law Law = lambert,
          executor_argument E = serial_executor>
frame<Labels> render(const scene& s, const overhead& rig, const render_options<Shadow, Labels, Law>& options = {},
                     E&& ex = {}) {
    return detail::paint(s, rig, options, executor_ref(ex));
}

/// The triangles that `render` shows with the same options.
/// @throws invalid_input as `render` does
template <class Shadow = shadow::exact, class Labels = labels, class Law = lambert,
          executor_argument E = serial_executor>
visibility visible_triangles(const scene& s, const overhead& rig,
                             const render_options<Shadow, Labels, Law>& options = {}, E&& ex = {}) {
    const render_options<shadow::none, labels, Law> seen{.law = options.law,
                                                         .cells = options.cells,
                                                         .reach = options.reach,
                                                         .edge_error = options.edge_error,
                                                         .slope_error = options.slope_error,
                                                         .subpixel_bits = options.subpixel_bits,
                                                         .tile = options.tile,
                                                         .level = options.level};
    return detail::see(s, rig, seen, executor_ref(ex));
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
