// Chooses the cheapest settings whose errors stay within a budget.
//
// The tolerance for a curved target's facets has a closed form in the positions of camera and light. Errors that depend
// on the seabed are measured: a few small pictures are compared with ones of a finer grid, from coarse to fine, and the
// first grid within the budget is chosen. This takes as long as a few large pictures, once per rig and kind of seabed.
#pragma once

#include <insonify/accuracy/seabed_probe.hpp>
#include <insonify/core/linear.hpp>
#include <insonify/geometry/cone.hpp>
#include <insonify/geometry/cylinder.hpp>
#include <insonify/geometry/sphere.hpp>

#include <concepts>
#include <limits>
#include <optional>
#include <type_traits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

/// Largest `subpixel_bits` for pictures of a rig: a side has at most 2^30 sub-pixels.
inline int max_subpixel_bits(const overhead& rig) {
    return (std::max)(rig.size.x, rig.size.y) > 16384 ? 15 : 16;
}

/// Upper bound of the cotangent of the light's elevation in the picture.
inline double largest_cot_elevation(const overhead_geometry& view) {
    if (!view.has_point_light()) return view.light().cot_elevation();
    const glm::dvec3 light = view.light_position();
    return (numeric::length(glm::dvec2(light)) + numeric::length(view.half_extent(0))) / light.z;
}

}  // namespace detail::inline INSONIFY_FLAGS

namespace accuracy {

/// Tolerated errors, each above 0.
using budget = errors;

inline namespace INSONIFY_FLAGS {

/// Whether each error is within its budget; errors that are NaN are not.
inline bool is_within(const errors& found, const budget& tolerated) {
    return found.shadow_edge <= tolerated.shadow_edge && found.silhouette <= tolerated.silhouette &&
           found.height <= tolerated.height && found.intensity <= tolerated.intensity;
}

}  // namespace INSONIFY_FLAGS

/// Settings of a picture: plain values, to read and to change.
template <shadow::policy Shadow = shadow::exact>
struct settings {
    Shadow shadow{};  ///< with its texels per pixel, if it is a map
    double cell = 0;  ///< as in render_options
    int subpixel_bits = render_options<Shadow>{}.subpixel_bits;
    double silhouette_error = 1;     ///< tolerance: pixels by which facets of a curved target may displace its outline
    double shadow_edge_error = 0.5;  ///< tolerance: pixels by which they may displace the edge of its shadow
    /// As measured by settings_for, `silhouette` as tolerated; NaN in named settings.
    errors expected{not_measured, not_measured, not_measured, not_measured};
    overhead rig{};  ///< that the settings are for

    /// The settings as options of `render`; `settings.options<no_labels>()` without labels.
    template <class Labels = labels, backscatter_law Law = lambert>
    INSONIFY_MEMBER render_options<Shadow, Labels, Law> options() const {
        return {.shadow = shadow, .cell = cell, .subpixel_bits = subpixel_bits};
    }

    /// Tolerance for the distance between the facets of a target and its surface, from silhouette_error and
    /// shadow_edge_error: metres in the shape's own frame, before `placement.scale`.
    ///
    /// A distance d across a camera ray that leans by psi from the vertical moves the image by d / cos psi on a plane
    /// at that height (Thatcher Ulrich. Rendering Massive Terrains using Chunked Level of Detail Control. SIGGRAPH
    /// course, 2002). Across a ray of light at an elevation e it moves the shadow on level ground by d / sin e, and by
    /// d H / (H - h) / sin e for a point light at the height H and a target that is h high.
    /// @param placement  of the target, which is taken as a ball of `radius` metres, in its own frame, around its
    /// position
    INSONIFY_TAGGED double deviation(const pose& placement, double radius) const {
        const overhead_geometry view(rig);
        const glm::dvec3 at = view.rig_from(to_world(placement)).offset;
        const double size = radius * static_cast<double>(placement.scale);
        const auto altitude = static_cast<double>(rig.altitude);
        const double below = (std::max)(altitude - at.z - size, 0.05 * altitude);
        const double aside = numeric::length(glm::dvec2(at)) + size;
        const double lean = numeric::square_root(1 + aside * aside / (below * below));
        const double seen = silhouette_error * view.ground_sampling() * below / altitude / lean;
        const double cast = shadow_edge_error * view.ground_sampling() * across_light(view, at, size);
        const bool has_shadow = !std::same_as<Shadow, insonify::shadow::none>;
        return (has_shadow ? (std::min)(seen, cast) : seen) / static_cast<double>(placement.scale);
    }

    /// The shape with the fewest segments that `deviation` allows.
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
        return with_segments(shape,
                             deviation(placement, static_cast<double>(insonify::detail::longest_semi_axis(shape))));
    }

  private:
    static constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

    /// Ratio of a displacement across the ray of light that grazes a ball's far side to the displacement of the
    /// shadow's edge that it causes.
    INSONIFY_TAGGED static double across_light(const overhead_geometry& view, const glm::dvec3& centre, double radius) {
        if (!view.has_point_light()) return view.light().to_light().z;
        const glm::dvec3 light = view.light_position();
        const double above = (std::max)(light.z - centre.z - radius, 0.05 * light.z);
        const double x = centre.x - light.x, y = centre.y - light.y;
        const double level = numeric::square_root(x * x + y * y) + radius;
        const double sine = above / numeric::square_root(level * level + above * above);
        return sine * above / light.z;
    }

    template <class Shape>
    INSONIFY_MEMBER static Shape with_segments(Shape shape, double deviation) {
        constexpr auto largest = static_cast<double>((std::numeric_limits<float>::max)());
        shape.segments = segments_for(shape, static_cast<float>((std::min)(deviation, largest)));
        return shape;
    }
};

inline namespace INSONIFY_FLAGS {

/// The cheapest settings with which pictures of a seabed stay within a budget, as measured on small pictures. If there
/// are none, those that exceed it least; `expected` has their errors.
///
/// Settings are for a given shadow policy, by default exact shadows. For maps, `settings_for<shadow::map>(...)`, the
/// number of texels is minimized too.
/// @param tolerated  each above 0
/// @param bottom     the seabed; pictures of others of its kind have about the same errors
/// @param rig        of the pictures
/// @param how        the small pictures to measure
/// @param ex         runs the measurement
/// @throws invalid_input for a tolerated error that isn't above 0, a probe out of range, and as `render`
template <shadow::policy Shadow = shadow::exact, executor_argument E = serial_executor>
settings<Shadow> settings_for(const budget& tolerated, const insonify::seabed::any& bottom, const overhead& rig,
                              const probe& how = {}, E&& ex = {}) {
    using detail::require;
    require(tolerated.shadow_edge > 0, "budget.shadow_edge", tolerated.shadow_edge, "above 0 pixels");
    require(tolerated.silhouette > 0, "budget.silhouette", tolerated.silhouette, "above 0 pixels");
    require(tolerated.height > 0, "budget.height", tolerated.height, "above 0 pixels");
    require(tolerated.intensity > 0, "budget.intensity", tolerated.intensity, "above 0");
    detail::require_range("probe.chips", how.chips, 1, 1024, "1 to 1024");
    detail::require_range("probe.pixels", how.pixels, 1, 2048, "1 to 2048");
    detail::require_range("probe.finest", how.finest, 1, 8, "1 to 8 cells per pixel");
    require(how.usable_fraction > 0 && how.usable_fraction <= 1, "probe.usable_fraction", how.usable_fraction,
            "above 0 and at most 1");

    const overhead_geometry view(rig);
    settings<Shadow> found{.rig = rig};
    // Snapping moves a vertex by at most half a sub-pixel along each axis.
    if (tolerated.silhouette * 0.05 < 1.0 / (1 << found.subpixel_bits))
        found.subpixel_bits = detail::max_subpixel_bits(rig);
    found.silhouette_error = tolerated.silhouette;
    found.shadow_edge_error = 0.5 * tolerated.shadow_edge;
    if (bottom.empty()) {
        found.expected = {.shadow_edge = 0, .silhouette = tolerated.silhouette, .height = 0, .intensity = 0};
        return found;
    }

    // Maps are compared with exact shadows, the other policies with themselves on the finest grid.
    constexpr bool has_map = requires {
        found.shadow.texels_per_pixel;
    };
    using truth = std::conditional_t<has_map, insonify::shadow::exact, Shadow>;
    const detail::seabed_probe probed(bottom, rig, how, truth{}, ex);
    std::optional<detail::seabed_probe> finer;  // truth for grids above half of `finest`, drawn on first use
    const double pixel = view.ground_sampling();
    const int longer = (std::max)(rig.size.x, rig.size.y);
    const double lowest_light = detail::largest_cot_elevation(view);
    const auto errors_of = [&](double cells_per_pixel, double texels) {
        Shadow policy{};
        if constexpr (has_map) policy.texels_per_pixel = static_cast<float>(texels);
        const bool is_fine = cells_per_pixel > 0.5 * how.finest;
        if (is_fine && !finer) {
            probe twice = how;
            twice.finest *= 2;
            // With the ground towards a low light a grid is up to 9 times as long as the picture along either axis, and
            // has at most 2^28 vertices.
            twice.pixels = (std::min)(twice.pixels, static_cast<int>(1700 / twice.finest));
            finer.emplace(bottom, rig, twice, truth{}, ex);
        }
        errors all = (is_fine ? *finer : probed).errors_of(cells_per_pixel, policy, ex);
        // An error of height h displaces the shadow of a target by h cot(elevation).
        if constexpr (!std::same_as<Shadow, insonify::shadow::none>)
            all.shadow_edge = (std::max)(all.shadow_edge, all.height * lowest_light);
        all.silhouette = tolerated.silhouette;
        return all;
    };
    const budget usable{how.usable_fraction * tolerated.shadow_edge, tolerated.silhouette,
                        how.usable_fraction * tolerated.height, how.usable_fraction * tolerated.intensity};

    // From the coarsest grid on, halving the cell size each time, at first with more texels than can matter. If no grid
    // is within the budget, the one that exceeds it least is taken.
    double many_texels = 8;
    if constexpr (requires { found.shadow.largest; })
        many_texels = (std::min)(many_texels, static_cast<double>(found.shadow.largest) / longer);
    const double finest = (std::min)(how.finest, pixel / detail::min_cell(view));
    double cells = 0, chosen = finest, least_excess = std::numeric_limits<double>::infinity();
    bool is_enough = false;
    do {
        cells = (std::min)((std::max)(2 * cells, 1.0 / 16), finest);
        const errors all = errors_of(cells, many_texels);
        is_enough = is_within(all, usable);
        const double excess = (std::max)((std::max)(all.shadow_edge / usable.shadow_edge, all.height / usable.height),
                                         all.intensity / usable.intensity);
        if (!is_enough && excess >= least_excess) continue;
        least_excess = excess;
        chosen = cells;
    } while (!is_enough && cells < finest);
    const double fewer = chosen * 0.70710678118654752;
    if (is_enough && is_within(errors_of(fewer, many_texels), usable)) chosen = fewer;

    double texels = is_enough ? (std::min)(0.5, many_texels) : many_texels;
    found.expected = errors_of(chosen, texels);
    if constexpr (has_map) {
        while (texels < many_texels && !is_within(found.expected, usable)) {
            texels = (std::min)(2 * texels, many_texels);
            found.expected = errors_of(chosen, texels);
        }
        found.shadow.texels_per_pixel = static_cast<float>(texels);
    }
    found.cell = (std::max)(pixel / chosen, detail::min_cell(view));
    return found;
}

/// A seabed vertex every four pixels along each axis, facets within a pixel. docs/tradeoff.md has the errors and costs
/// of the named settings.
/// @param rig  of the pictures
inline settings<> fast(const overhead& rig) {
    return {.cell = 4 * overhead_geometry(rig).ground_sampling(),
            .silhouette_error = 1,
            .shadow_edge_error = 1,
            .rig = rig};
}
/// A seabed vertex for every two pixels, facets within a quarter of a pixel.
inline settings<> balanced(const overhead& rig) {
    return {.cell = 2 * overhead_geometry(rig).ground_sampling(),
            .silhouette_error = 0.25,
            .shadow_edge_error = 0.25,
            .rig = rig};
}
/// Two seabed vertices per pixel along each axis, facets within 1/50 and vertices rounded to 1/65536 of a pixel. Grids
/// are limited to 32768 cells a side and coordinates to 2^30 sub-pixels: both are coarser for pictures of more than
/// 16384 pixels.
inline settings<> exact(const overhead& rig) {
    const overhead_geometry view(rig);
    return {.cell = (std::max)(0.5 * view.ground_sampling(), detail::min_cell(view)),
            .subpixel_bits = detail::max_subpixel_bits(rig),
            .silhouette_error = 0.02,
            .shadow_edge_error = 0.02,
            .rig = rig};
}

}  // namespace INSONIFY_FLAGS

}  // namespace accuracy
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
