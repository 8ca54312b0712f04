// From the errors that somebody can live with to the cheapest settings that keep to them.
//
// What has a closed form is computed: how far a curved target's facets may be from its surface follows from where the
// camera and the light stand. What depends on the seabed is measured: a few small pictures of it are drawn as finely as
// makes sense, then coarser and coarser, and the coarsest that is close enough decides. That costs about as much as one
// large picture, once for as many pictures as share a rig and a kind of seabed.
#pragma once

#include <insonify/accuracy/metrics.hpp>
#include <insonify/geometry/cone.hpp>
#include <insonify/geometry/cylinder.hpp>
#include <insonify/geometry/sphere.hpp>
#include <insonify/sonar/render.hpp>

#include <concepts>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::accuracy {

/// Errors of a picture, measured as `metrics.hpp` does; as a budget, what is tolerated.
struct errors {
    double shadow_edge = 1;   ///< pixels by which edges of shadows are displaced, on average along them
    double silhouette = 1;    ///< pixels by which outlines of targets are displaced, at most
    double height = 1;        ///< of the seabed, root mean square, in pixels on the ground
    double intensity = 0.05;  ///< root mean square error of the linear picture
};
using budget = errors;

/// Whether each error is within its budget.
inline bool keeps_to(const errors& found, const budget& tolerated) {
    return found.shadow_edge <= tolerated.shadow_edge && found.silhouette <= tolerated.silhouette &&
           found.height <= tolerated.height && found.intensity <= tolerated.intensity;
}

/// How `settings_for` looks at a seabed.
struct probe {
    int chips = 5;       ///< small pictures, spread over the large one
    int pixels = 128;    ///< along their sides
    double finest = 4;   ///< cells per pixel of what counts as the truth
    double spare = 0.7;  ///< share of a budget that may be used where others have not been looked at
};

/// What a picture is made of: plain values, to read and to change.
template <shadow::policy Shadow = shadow::refined>
struct settings {
    Shadow shadow{};            ///< with its texels per pixel
    int cells = 0;              ///< of the seabed along the picture's longer side, as in render_options
    int subpixel_bits = 8;      ///< as in render_options
    float edge_error = 0;       ///< as in render_options
    double side_error = 1;      ///< pixels by which facets of a curved target may displace its outline
    double shadow_error = 0.5;  ///< pixels by which they may displace the edge of its shadow
    errors expected{};          ///< of these settings, as far as they are known
    overhead rig{};             ///< for which they were made

    /// The same for `render`; `settings.options<no_labels>()` leaves the labels out.
    template <class Labels = labels, backscatter_law Law = lambert>
    render_options<Shadow, Labels, Law> options() const {
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
    double deviation(const pose& placement, double radius) const {
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
    cylinder modelled(cylinder shape, const pose& placement) const {
        const double half = 0.5 * static_cast<double>(shape.length), radius = static_cast<double>(shape.radius);
        return with_segments(shape, deviation(placement, numeric::square_root(half * half + radius * radius)));
    }
    capsule modelled(capsule shape, const pose& placement) const {
        return with_segments(shape, deviation(placement, 0.5 * static_cast<double>(shape.length)));
    }
    cone modelled(cone shape, const pose& placement) const {
        const double half = 0.5 * static_cast<double>(shape.height);
        const auto radius = static_cast<double>((std::max)(shape.radius, shape.top_radius));
        return with_segments(shape, deviation(placement, numeric::square_root(half * half + radius * radius)));
    }
    template <class Round>
        requires(std::same_as<Round, sphere> || std::same_as<Round, hemisphere>)
    Round modelled(Round shape, const pose& placement)
    const {
        const float longest = (std::max)((std::max)(shape.aspect.x, shape.aspect.y), shape.aspect.z);
        return with_segments(shape, deviation(placement, static_cast<double>(shape.radius * longest)));
    }

  private:
    template <class Shape>
    static Shape with_segments(Shape shape, double deviation) {
        shape.segments = segments_for(shape, static_cast<float>(deviation));
        return shape;
    }
};

}  // namespace insonify::inline INSONIFY_ABI::accuracy

namespace insonify::inline INSONIFY_ABI::detail {

/// Small pictures of a seabed, as fine as makes sense, to compare coarser ones with.
class seabed_probe {
  public:
    template <executor E>
    seabed_probe(const seabed::any& bottom, const overhead& rig, const accuracy::probe& how, E& ex) : how_(how) {
        scene_.seabed = bottom;
        const overhead_geometry view(rig);
        pixels_ = (std::min)(how.pixels, (std::min)(rig.size.x, rig.size.y));
        spacing_ = view.ground_sampling() / how.finest;
        // Places of a sequence that fills a square evenly however many are taken.
        // Martin Roberts. The Unreasonable Effectiveness of Quasirandom Sequences. 2018.
        for (int i = 0; i < how.chips; ++i) {
            const auto place = [&](double step, int size) {
                const double turn = 0.5 + step * i;
                const double share = turn - static_cast<double>(numeric::floor_to_int(turn));
                return (share - 0.5) * (1 - static_cast<double>(pixels_) / size);
            };
            const glm::dvec2 in_picture(place(0.7548776662466927, rig.size.x) * 2 * view.half_extent(0).x,
                                        place(0.5698402909980532, rig.size.y) * 2 * view.half_extent(0).y);
            overhead chip = rig;
            const auto [sine, cosine] = numeric::sin_cos(static_cast<double>(rig.yaw));
            chip.position +=
                glm::dvec2(in_picture.x * cosine - in_picture.y * sine, in_picture.x * sine + in_picture.y * cosine);
            chip.size = {pixels_, pixels_};
            const double half = view.half_extent(0).x * pixels_ / rig.size.x;
            chip.field_of_view = static_cast<float>(2 * numeric::atan2(half, static_cast<double>(rig.altitude)));
            chips_.push_back(chip);
            truths_.push_back(draw(chip, how.finest, shadow::refined{.texels_per_pixel = 4}, ex));
        }
    }

    /// How far pictures of so many cells per pixel are from the truth, over all chips.
    template <class Shadow, executor E>
    accuracy::errors errors_of(double cells_per_pixel, const Shadow& shadow, E& ex) const {
        accuracy::mask_difference edges;
        double squares = 0, pixels = 0, heights = 0;
        for (std::size_t i = 0; i < chips_.size(); ++i) {
            const auto result = draw(chips_[i], cells_per_pixel, shadow, ex);
            const auto found = accuracy::compare_masks(result.dark, truths_[i].dark);
            edges.false_pixels += found.false_pixels;
            edges.missed_pixels += found.missed_pixels;
            edges.boundary_pixels += found.boundary_pixels;
            const auto off = accuracy::compare_images(result.values, truths_[i].values);
            squares += off.mean_square * static_cast<double>(off.pixels);
            pixels += static_cast<double>(off.pixels);
            heights += mean_square_height_error(chips_[i], cells_per_pixel) / static_cast<double>(chips_.size());
        }
        accuracy::errors all{.shadow_edge = 0, .silhouette = 0};
        // Without an edge there is nothing to be displaced, but by the few wrong pixels.
        const auto wrong = static_cast<double>(edges.wrong_pixels());
        const auto few = static_cast<double>(pixels_) / 16;
        all.shadow_edge = wrong / (std::max)(static_cast<double>(edges.boundary_pixels), few);
        all.intensity = numeric::square_root(squares / pixels);
        all.height = numeric::square_root(heights);
        return all;
    }

  private:
    struct picture {
        image<float> values;
        image<std::uint8_t> dark;
    };

    template <class Shadow, executor E>
    picture draw(const overhead& chip, double cells_per_pixel, const Shadow& shadow, E& ex) const {
        render_options<Shadow> options{.shadow = shadow};
        options.cells = (std::max)(1, static_cast<int>(numeric::floor_to_int(pixels_ * cells_per_pixel + 0.5)));
        auto drawn = render(scene_, chip, options, ex);
        return {std::move(drawn.image), map_pixels(drawn.labels.shadow, [](std::uint16_t by) {
                    return static_cast<std::uint8_t>(by != labels::is_lit);
                })};
    }

    /// Of a grid against the finest one, over a net of points; in square metres.
    double mean_square_height_error(const overhead& chip, double cells_per_pixel) const {
        constexpr int net = 24;
        const double side = 2 * overhead_geometry(chip).half_extent(0).x;
        const glm::dvec2 low = chip.position - 0.5 * side;
        const double spacing = spacing_ * how_.finest / cells_per_pixel;
        seabed::grid coarse = seabed::grid_over(low, low + side, spacing);
        coarse.band_limited = true;
        const seabed::heightfield field = seabed::sample(scene_.seabed, coarse);
        const auto prepared = seabed::prepare(scene_.seabed);
        double sum = 0;
        int known = 0;
        for (int j = 0; j < net; ++j) {
            std::array<float, net> heights;
            const seabed::scanline line{.y = low.y + side * (j + 0.5) / net,
                                        .origin = low.x + side * 0.5 / net,
                                        .spacing = side / net,
                                        .grid_spacing = spacing_};
            prepared.row(line, heights, {});
            for (std::size_t i = 0; i < heights.size(); ++i) {
                const double off =
                    static_cast<double>(heights[i]) - static_cast<double>(field.height_at(line.x(i), line.y));
                if (!numeric::is_finite(off)) continue;
                sum += off * off;
                ++known;
            }
        }
        return known > 0 ? sum / known : 0;
    }

    accuracy::probe how_;
    scene scene_;
    int pixels_ = 0;
    double spacing_ = 1;  ///< of the finest grid, metres
    std::vector<overhead> chips_;
    std::vector<picture> truths_;
};

}  // namespace insonify::inline INSONIFY_ABI::detail

namespace insonify::inline INSONIFY_ABI::accuracy {

/// The cheapest settings with which pictures of a seabed keep to a budget, as far as a probe can tell; where none does,
/// the finest, and `expected` says how far off they are.
///
/// Settings are found for a shadow policy: `settings_for<shadow::map>(...)`. One that has texels is given as few as
/// will do.
/// @param tolerated  each above 0
/// @param bottom     the seabed; pictures of others of its kind have about the same errors
/// @param rig        of the pictures
/// @param ex         who runs it
/// @throws invalid_input for a tolerated error that isn't above 0, a probe that can't be, and as `render`
template <shadow::policy Shadow = shadow::refined, executor_argument E = serial_executor>
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
    found.subpixel_bits = tolerated.silhouette * 0.05 < 1.0 / 256 ? 16 : 8;
    found.side_error = tolerated.silhouette;
    found.shadow_error = 0.5 * tolerated.shadow_edge;
    if (std::holds_alternative<insonify::seabed::none>(bottom)) return found;

    const detail::seabed_probe probed(bottom, rig, how, ex);
    const double pixel = view.ground_sampling();
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

    // From the coarsest grid on, each of half the cells of the next; first with more texels than can matter.
    constexpr double many_texels = 4;
    double cells_per_pixel = 1.0 / 16;
    while (cells_per_pixel < how.finest / 2 && !keeps_to(errors_of(cells_per_pixel, many_texels), usable))
        cells_per_pixel *= 2;
    const double fewer = cells_per_pixel * 0.70710678118654752;
    if (keeps_to(errors_of(fewer, many_texels), usable)) cells_per_pixel = fewer;

    double texels = 0.5;
    found.expected = errors_of(cells_per_pixel, texels);
    if constexpr (requires { found.shadow.texels_per_pixel; }) {
        while (texels < many_texels && !keeps_to(found.expected, usable)) {
            texels *= 2;
            found.expected = errors_of(cells_per_pixel, texels);
        }
        found.shadow.texels_per_pixel = static_cast<float>(texels);
    }
    const int longer = (std::max)(rig.size.x, rig.size.y);
    const double cells = (std::min)(32768.0, (std::max)(1.0, longer * cells_per_pixel));
    found.cells = static_cast<int>(numeric::floor_to_int(cells + 0.5));
    return found;
}

/// Settings with names: from the first to the last, errors fall and the time goes up. What each costs and how far off
/// it is, is in docs/tradeoff.md.
/// @param rig  of the pictures
inline settings<> fast(const overhead& rig) {
    return {.shadow = {.texels_per_pixel = 0.5f},
            .cells = ((std::max)(rig.size.x, rig.size.y) + 3) / 4,
            .side_error = 1,
            .shadow_error = 1,
            .rig = rig};
}
inline settings<> balanced(const overhead& rig) {
    return {.shadow = {.texels_per_pixel = 1},
            .cells = ((std::max)(rig.size.x, rig.size.y) + 1) / 2,
            .side_error = 0.25,
            .shadow_error = 0.25,
            .rig = rig};
}
inline settings<> exact(const overhead& rig) {
    return {.shadow = {.texels_per_pixel = 2},
            .cells = (std::min)(2 * (std::max)(rig.size.x, rig.size.y), 32768),
            .subpixel_bits = 16,
            .side_error = 0.02,
            .shadow_error = 0.02,
            .rig = rig};
}

}  // namespace insonify::inline INSONIFY_ABI::accuracy

INSONIFY_ARITHMETIC_END
