// Chooses the cheapest settings whose errors keep to a budget.
//
// What has a closed form is computed: how far a curved target's facets may be from its surface follows from where the
// camera and the light stand. What depends on the seabed is measured: a few small pictures of it are compared with
// marched rays, from coarse ones to fine ones, and the first that is close enough decides. That takes as long as a few
// large pictures, once for as many pictures as share a rig and a kind of seabed.
#pragma once

#include <insonify/accuracy/seabed_probe.hpp>
#include <insonify/geometry/cone.hpp>
#include <insonify/geometry/cylinder.hpp>
#include <insonify/geometry/sphere.hpp>

#include <concepts>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace accuracy {

/// Errors that are tolerated, each above 0.
using budget = errors;

inline namespace INSONIFY_FLAGS {

/// Whether each error is within its budget.
inline bool keeps_to(const errors& found, const budget& tolerated) {
    return found.shadow_edge <= tolerated.shadow_edge && found.silhouette <= tolerated.silhouette &&
           found.height <= tolerated.height && found.intensity <= tolerated.intensity;
}

}  // namespace INSONIFY_FLAGS

/// What a picture is made of: plain values, to read and to change.
template <shadow::policy Shadow = shadow::exact>
struct settings {
    Shadow shadow{};  ///< with its texels per pixel, if it has any
    int cells = 0;    ///< of the seabed along the picture's longer side, as in render_options
    int subpixel_bits = render_options<Shadow>{}.subpixel_bits;
    float edge_error = 0;       ///< as in render_options
    double side_error = 1;      ///< pixels by which facets of a curved target may displace its outline
    double shadow_error = 0.5;  ///< pixels by which they may displace the edge of its shadow
    errors expected{};          ///< of these settings, as far as they are known
    overhead rig{};             ///< for which they were made

    /// The same for `render`; `settings.options<no_labels>()` leaves the labels out.
    template <class Labels = labels, backscatter_law Law = lambert>
    INSONIFY_MEMBER render_options<Shadow, Labels, Law> options() const {
        return {.shadow = shadow, .cells = cells, .edge_error = edge_error, .subpixel_bits = subpixel_bits};
    }

    /// Metres by which the facets of a target may deviate from its surface, for its outline and its shadow's to stay
    /// within side_error and shadow_error.
    ///
    /// A deviation d across a camera's ray that leans by psi from the vertical moves its image by d / cos psi on a
    /// plane at that height; across a ray of light at an elevation e it moves the shadow on level ground by d / sin e.
    /// (Thatcher Ulrich. Rendering Massive Terrains using Chunked Level of Detail Control. SIGGRAPH course, 2002, has
    /// the first; the second is the same for the light's parallel rays.)
    /// @param placement  of the target; what counts is the top of a ball of `radius` metres around its position
    INSONIFY_TAGGED double deviation(const pose& placement, double radius) const {
        const overhead_geometry view(rig);
        const glm::dvec3 at = view.rig_from(to_world(placement)).offset;
        const double size = radius * static_cast<double>(placement.scale);
        const auto altitude = static_cast<double>(rig.altitude);
        const double below = (std::max)(altitude - at.z - size, 0.05 * altitude);
        const double aside = numeric::square_root(at.x * at.x + at.y * at.y) + size;
        const double lean = numeric::square_root(1 + aside * aside / (below * below));
        const double seen = side_error * view.ground_sampling() * below / altitude / lean;
        const double cast = shadow_error * view.ground_sampling() * view.light().to_light().z;
        const bool has_shadow = !std::same_as<Shadow, insonify::shadow::none>;
        return (has_shadow ? (std::min)(seen, cast) : seen) / static_cast<double>(placement.scale);
    }

    /// The shape with as few segments as `deviation` allows.
    INSONIFY_MEMBER cylinder modelled(cylinder shape, const pose& placement) const {
        const double half = 0.5 * static_cast<double>(shape.length), radius = static_cast<double>(shape.radius);
        return with_segments(shape, deviation(placement, numeric::square_root(half * half + radius * radius)));
    }
    INSONIFY_MEMBER capsule modelled(capsule shape, const pose& placement) const {
        return with_segments(shape, deviation(placement, 0.5 * static_cast<double>(shape.length)));
    }
    INSONIFY_TAGGED cone modelled(cone shape, const pose& placement) const {
        const double half = 0.5 * static_cast<double>(shape.height);
        const auto radius = static_cast<double>((std::max)(shape.radius, shape.top_radius));
        return with_segments(shape, deviation(placement, numeric::square_root(half * half + radius * radius)));
    }
    template <class Round>
        requires(std::same_as<Round, sphere> || std::same_as<Round, hemisphere>)
    INSONIFY_MEMBER Round modelled(Round shape, const pose& placement)
    const {
        const float longest = (std::max)((std::max)(shape.aspect.x, shape.aspect.y), shape.aspect.z);
        return with_segments(shape, deviation(placement, static_cast<double>(shape.radius * longest)));
    }

  private:
    template <class Shape>
    INSONIFY_MEMBER static Shape with_segments(Shape shape, double deviation) {
        shape.segments = segments_for(shape, static_cast<float>(deviation));
        return shape;
    }
};

inline namespace INSONIFY_FLAGS {

/// The cheapest settings with which pictures of a seabed keep to a budget, as far as a probe can tell; where none does,
/// those that are the least beyond it, and `expected` says how far off they are.
///
/// Settings are found for a shadow policy, exact shadows if none is named. One that has texels,
/// `settings_for<shadow::map>(...)`, gets as few as will do.
/// @param tolerated  each above 0
/// @param bottom     the seabed; pictures of others of its kind have about the same errors
/// @param rig        of the pictures
/// @param ex         runs it
/// @throws invalid_input for a tolerated error that isn't above 0, a probe that can't be, and as `render`
template <shadow::policy Shadow = shadow::exact, executor_argument E = serial_executor>
settings<Shadow> settings_for(const budget& tolerated, const insonify::seabed::any& bottom, const overhead& rig,
                              const probe& how = {}, E&& ex = {}) {
    using detail::require;
    require(tolerated.shadow_edge > 0, "budget.shadow_edge", tolerated.shadow_edge, "pixels above 0");
    require(tolerated.silhouette > 0, "budget.silhouette", tolerated.silhouette, "pixels above 0");
    require(tolerated.height > 0, "budget.height", tolerated.height, "pixels above 0");
    require(tolerated.intensity > 0, "budget.intensity", tolerated.intensity, "above 0");
    require(how.chips > 0 && how.chips <= 1024, "probe.chips", how.chips, "1 to 1024");
    require(how.pixels > 0 && how.pixels <= 2048, "probe.pixels", how.pixels, "1 to 2048");
    require(how.finest >= 1 && how.finest <= 8, "probe.finest", how.finest, "1 to 8 cells per pixel");
    require(how.spare > 0 && how.spare <= 1, "probe.spare", how.spare, "above 0 and at most 1");

    const overhead_geometry view(rig);
    settings<Shadow> found{.rig = rig};
    // Rounding a vertex moves it by half a sub-pixel at most, along each axis.
    if (tolerated.silhouette * 0.05 < 1.0 / (1 << found.subpixel_bits)) found.subpixel_bits = 16;
    found.side_error = tolerated.silhouette;
    found.shadow_error = 0.5 * tolerated.shadow_edge;
    if (bottom.empty()) return found;

    const detail::seabed_probe probed(bottom, rig, how, ex);
    const double pixel = view.ground_sampling();
    const int longer = (std::max)(rig.size.x, rig.size.y);
    const auto errors_of = [&](double cells_per_pixel, double texels) {
        Shadow policy{};
        if constexpr (requires { policy.texels_per_pixel; }) policy.texels_per_pixel = static_cast<float>(texels);
        errors all = probed.errors_of(cells_per_pixel, policy, ex);
        all.height /= pixel;
        // A bottom that is off by h displaces the shadow that a target throws on it by h cot(elevation).
        const double cot = std::same_as<Shadow, insonify::shadow::none> ? 0 : view.light().cot_elevation();
        all.shadow_edge = (std::max)(all.shadow_edge, all.height * cot);
        all.silhouette = tolerated.silhouette;
        return all;
    };
    const budget usable{how.spare * tolerated.shadow_edge, tolerated.silhouette, how.spare * tolerated.height,
                        how.spare * tolerated.intensity};

    // From the coarsest grid on, each of half the cells of the next; first with more texels than can matter. If none
    // keeps to the budget, the one that is the least beyond it is taken.
    double many_texels = 8;
    if constexpr (requires { found.shadow.largest; })
        many_texels = (std::min)(many_texels, static_cast<double>(found.shadow.largest) / longer);
    double chosen = how.finest, least_excess = std::numeric_limits<double>::infinity();
    bool keeps = false;
    for (double cells = 1.0 / 16; cells <= how.finest && !keeps; cells *= 2) {
        const errors all = errors_of(cells, many_texels);
        keeps = keeps_to(all, usable);
        const double excess = (std::max)((std::max)(all.shadow_edge / usable.shadow_edge, all.height / usable.height),
                                         all.intensity / usable.intensity);
        if (!keeps && excess >= least_excess) continue;
        least_excess = excess;
        chosen = cells;
    }
    const double fewer = chosen * 0.70710678118654752;
    if (keeps && keeps_to(errors_of(fewer, many_texels), usable)) chosen = fewer;

    double texels = keeps ? (std::min)(0.5, many_texels) : many_texels;
    found.expected = errors_of(chosen, texels);
    if constexpr (requires { found.shadow.texels_per_pixel; }) {
        while (texels < many_texels && !keeps_to(found.expected, usable)) {
            texels = (std::min)(2 * texels, many_texels);
            found.expected = errors_of(chosen, texels);
        }
        found.shadow.texels_per_pixel = static_cast<float>(texels);
    }
    const double cells = (std::min)(32768.0, (std::max)(1.0, longer * chosen));
    found.cells = static_cast<int>(numeric::floor_to_int(cells + 0.5));
    return found;
}

/// Settings with names: from the first to the last, errors fall and the time goes up. What each costs and how far off
/// it is, is in docs/tradeoff.md.
/// @param rig  of the pictures
inline settings<> fast(const overhead& rig) {
    return {.cells = ((std::max)(rig.size.x, rig.size.y) + 3) / 4, .side_error = 1, .shadow_error = 1, .rig = rig};
}
inline settings<> balanced(const overhead& rig) {
    return {
        .cells = ((std::max)(rig.size.x, rig.size.y) + 1) / 2, .side_error = 0.25, .shadow_error = 0.25, .rig = rig};
}
inline settings<> exact(const overhead& rig) {
    return {.cells = (std::min)(2 * (std::max)(rig.size.x, rig.size.y), 32768),
            .subpixel_bits = 16,
            .side_error = 0.02,
            .shadow_error = 0.02,
            .rig = rig};
}

}  // namespace INSONIFY_FLAGS

}  // namespace accuracy
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
