// One picture: the seabed sampled where the rig looks, shadows, the image in linear values, and its labels.
#pragma once

#include <insonify/geometry/bounds.hpp>
#include <insonify/raster/draw.hpp>
#include <insonify/seabed/adaptive.hpp>
#include <insonify/seabed/sample.hpp>
#include <insonify/sonar/seabed_reach.hpp>
#include <insonify/sonar/shading.hpp>

#include <algorithm>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI {

/// How to draw a picture; the types say what is in it.
template <shadow::policy Shadow = shadow::refined, class Labels = labels, backscatter_law Law = lambert>
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
    int subpixel_bits = shadow::ray_policy<Shadow> ? 12 : 8;
    int tile = 64;  ///< see draw_options
    isa level = best_isa();
};

/// What became of the triangles, and how large the intermediate things were.
struct render_stats {
    draw_stats seabed, targets;
    int seabed_columns = 0, seabed_rows = 0;  ///< vertices sampled, of which the mesh may leave some out
    std::uint64_t seabed_samples = 0;         ///< points at which the seabed was evaluated
};

/// A picture with all that is known about it.
template <class Labels = labels>
struct frame {
    insonify::image<float> image;  ///< linear, [0, 1]; see the rig for what a value means
    Labels labels;                 ///< or no_labels
    render_stats stats;
};

namespace detail {

/// A picture under construction, in the rig's frame.
template <class Shadow, class Labels, class Law>
class overhead_painter {
  public:
    template <executor E>
    overhead_painter(const scene& s, const overhead& rig, const render_options<Shadow, Labels, Law>& options, E& ex)
        : scene_(s), view_(rig), options_(options), depth_(rig.size.x, rig.size.y, unfilled{}) {
        validate(s);
        require(s.targets.size() < labels::by_seabed, "scene.targets.size()", s.targets.size(), "below 65535");
        out_.image = image<float>(rig.size.x, rig.size.y, unfilled{});  // the first draw fills it, and the depths
        validate(options.shadow);
        if constexpr (!shadow::ray_policy<Shadow> && !std::is_same_v<Shadow, shadow::none>)
            require(!view_.has_near_light(), "overhead.light_distance", rig.light_distance,
                    "infinite, or shadow::exact or penumbra");
        require(options.edge_error >= 0, "edge_error", options.edge_error, "pixels, at least 0");
        require(options.slope_error >= 0, "slope_error", options.slope_error, "a slope, at least 0");
        if constexpr (labelled) out_.labels = labels(rig.size.x, rig.size.y, ex);
        for (const target& t : s.targets) {
            targets_.emplace_back(t.shape, bounds(t.shape, ex), view_.rig_from(to_world(t.placement)), t.is_solid);
            target_pixels_.push_back(shown_pixels(view_, targets_.back()));
        }
        if (has_bottom()) sample_seabed(ex);
    }

    template <executor E>
    frame<Labels> paint(E& ex) {
        if constexpr (std::is_same_v<Shadow, shadow::none>) {
            draw_all(no_shadow_maps{}, ex);
        } else {
            const placed_mesh bottom = bottom_in_rig();
            draw_all(cast_shadows(has_bottom() ? &bottom : nullptr, ex), ex);
        }
        if constexpr (labelled) describe_targets(out_.labels, scene_.targets);
        return std::move(out_);
    }

  private:
    static constexpr bool labelled = std::is_same_v<Labels, labels>;

    bool has_bottom() const { return !std::holds_alternative<seabed::none>(scene_.seabed); }

    /// Heights where the picture looks, and up-light of there as far as the relief can throw a shadow.
    template <executor E>
    void sample_seabed(E& ex) {
        const overhead& rig = view_.rig();
        const int longer = (std::max)(rig.size.x, rig.size.y);
        const int cells = options_.cells > 0 ? options_.cells : (longer + 1) / 2;
        require(cells <= 32768, "cells", cells, "at most 32768");
        require(options_.reach >= 0 && numeric::is_finite(options_.reach), "reach", options_.reach, "0 or more");
        const double longer_side = 2 * (std::max)(view_.half_extent(0).x, view_.half_extent(0).y);
        const double spacing = longer_side / cells;

        seabed::height_range range = merge(seabed::prepare(scene_.seabed).range(), {0, 0});
        const double longest = static_cast<double>(options_.reach) * longer_side;
        ground_box ground = shown_ground(view_, range);
        if constexpr (!std::is_same_v<Shadow, shadow::none>)
            ground = casting_ground(view_, range, shadow::radius_of(options_.shadow), longest);
        field_ = seabed::sample(scene_.seabed, grid_under(ground, spacing), ex);
        out_.stats.seabed_samples = field_.heights.size();
        model_seabed(ex);
        for (const float height : field_.heights.pixels()) {
            if (!numeric::is_finite(height)) continue;
            lowest_ = (std::min)(lowest_, height);
            highest_ = (std::max)(highest_, height);
        }
        out_.stats.seabed_columns = field_.heights.width();
        out_.stats.seabed_rows = field_.heights.height();
    }

    /// The bottom's mesh, and the type of each of its vertices where there are several.
    template <executor E>
    void model_seabed(E& ex) {
        const auto every = field_.types.pixels();
        if (options_.edge_error == 0) {
            seabed::detail::tessellate_into(whole_bottom_, field_, ex, bottom_first_);
            bottom_ = whole_bottom_;
            bottom_types_.assign(every.begin(), every.end());
            return;
        }
        // What is off by h throws a shadow that is off by h cot(elevation), whatever the view.
        const double forgiven = static_cast<double>(options_.edge_error) * view_.ground_sampling();
        const double cot = std::is_same_v<Shadow, shadow::none> ? 0 : view_.light().cot_elevation();
        auto [shape, vertices] = seabed::tessellate(field_,
                                                    {.height = forgiven / cot,
                                                     .slope = static_cast<double>(options_.slope_error),
                                                     .lean = forgiven * static_cast<double>(view_.rig().altitude),
                                                     .nadir = -field_.spacing * glm::dvec2(bottom_first_)},
                                                    ex, bottom_first_);
        sparse_bottom_ = std::move(shape);
        bottom_ = sparse_bottom_;
        if (every.empty()) return;
        bottom_types_.resize(vertices.size());
        std::transform(vertices.begin(), vertices.end(), bottom_types_.begin(), [&](auto v) { return every[v]; });
    }

    /// The multiples of the spacing over a part of the ground, counted from the rig's position: where a vertex is
    /// depends neither on what else is sampled nor on how far the world's origin is.
    seabed::grid grid_under(const ground_box& ground, double spacing) {
        seabed::grid grid{.origin = view_.rig().position, .spacing = spacing, .band_limited = true};
        const auto along = [&](int axis) {
            const double first = static_cast<double>(numeric::floor_to_int(ground.first[axis] / spacing + 1e-6));
            const double count = 1 - static_cast<double>(numeric::floor_to_int(-ground.last[axis] / spacing)) - first;
            require(count <= 1 << 20, "vertices of the seabed along an axis", count, "at most 2^20: less `reach`");
            bottom_first_[axis] = static_cast<int>(first);
            return static_cast<int>((std::max)(2.0, count));
        };
        grid.width = along(0);
        grid.height = along(1);
        grid.first = bottom_first_;
        return grid;
    }

    placed_mesh bottom_in_rig() const {
        const affine under_rig = view_.rig_from({glm::dmat3(1), glm::dvec3(view_.rig().position, 0)});
        const glm::ivec2 last = bottom_first_ + glm::ivec2(field_.heights.width() - 1, field_.heights.height() - 1);
        return {bottom_,
                {{field_.spacing * glm::dvec2(bottom_first_), lowest_}, {field_.spacing * glm::dvec2(last), highest_}},
                under_rig,
                true};
    }

    template <executor E>
    auto cast_shadows(const placed_mesh* bottom, E& ex) const {
        if constexpr (shadow::ray_policy<Shadow>) {
            return exact_shadows(options_.shadow, view_, bottom, targets_, receivers(), ex);
        } else {
            const double texel = view_.ground_sampling() / static_cast<double>(options_.shadow.texels_per_pixel);
            return shadow_maps<Shadow>(options_.shadow, view_, bottom, targets_, receivers(), texel, ex);
        }
    }

    /// All that the picture may show.
    bounding_box receivers() const {
        double low = static_cast<double>(lowest_), top = static_cast<double>(highest_);
        if (!has_bottom()) {
            low = (std::numeric_limits<double>::max)();
            top = -low;
        }
        for (const placed_mesh& t : targets_)
            for (int corner = 0; corner < 8 && !t.box.empty(); ++corner) {
                const double z = transform_point(t.to_rig, t.box.corner(corner)).z;
                top = (std::max)(top, z);
                if (!has_bottom()) low = (std::min)(low, z);
            }
        if (low > top) return {};
        const glm::dvec2 half = view_.half_extent(low);
        return {{-half, low}, {half, top}};
    }

    template <class Shadows, executor E>
    void draw_all(const Shadows& shadows, E& ex) {
        depth_load load = depth_load::clear;
        if (has_bottom()) {
            const placed_mesh bottom = bottom_in_rig();
            if (field_.types.empty())
                out_.stats.seabed = draw_one(bottom, load, 0, shadows,
                                             whole_object{scene_.bottom_of(field_.fallback), labels::no_instance,
                                                          static_cast<std::uint8_t>(field_.fallback)},
                                             ex);
            else
                out_.stats.seabed =
                    draw_one(bottom, load, 0, shadows, typed_bottom{bottom_, bottom_types_, scene_.bottom}, ex);
            load = depth_load::keep;
        }
        for (std::size_t i = 0; i < targets_.size(); ++i) {
            const whole_object target{scene_.targets[i].surface, static_cast<std::uint16_t>(i + 1), labels::no_seabed};
            out_.stats.targets += draw_one(targets_[i], load, i + 1, shadows, target, ex);
            load = depth_load::keep;
        }
        if (load == depth_load::clear) std::fill(out_.image.pixels().begin(), out_.image.pixels().end(), 0.0f);
    }

    /// @param later  the first of the targets that are drawn after it
    template <class Shadows, class Object, executor E>
    draw_stats draw_one(const placed_mesh& shape, depth_load load, std::size_t later, const Shadows& shadows,
                        const Object& object, E& ex) {
        const surface_placement placement(view_, shape);
        const surface_shader<Shadows, Labels, Law, Object> shader(view_, placement, shape.shape, options_.subpixel_bits,
                                                                  options_.law, shadows, object, out_.image,
                                                                  out_.labels);
        return draw_lanes(shape.shape, placement, shader, depth_, std::span(target_pixels_).subspan(later),
                          {.cull = shape.hidden(),
                           .keep = keep_depth::larger,
                           .load = load,
                           .subpixel_bits = options_.subpixel_bits,
                           .tile = options_.tile,
                           .level = options_.level},
                          ex);
    }

    const scene& scene_;
    overhead_geometry view_;
    render_options<Shadow, Labels, Law> options_;
    image<float> depth_;
    frame<Labels> out_;
    seabed::heightfield field_;
    unfilled_mesh whole_bottom_;              ///< if every vertex is drawn
    mesh sparse_bottom_;                      ///< if some are left out
    mesh_view bottom_;                        ///< one of them
    std::vector<seabed::type> bottom_types_;  ///< by vertex, or none where there is one type alone
    glm::ivec2 bottom_first_{0, 0};           ///< of the field's vertices, counted from the rig's position
    float lowest_ = 0, highest_ = 0;          ///< of the bottom's vertices, and the datum
    std::vector<placed_mesh> targets_;
    std::vector<pixel_box> target_pixels_;  ///< which may show them
};

}  // namespace detail

/// Draws a scene as the paper's rig sees it.
///
/// @param s        the seabed and its targets
/// @param rig      camera and light; see there for what a pixel means
/// @param options  types of shadow, labels and backscatter law, and how finely the seabed is sampled
/// @param ex       who runs it; the result is the same bytes for any executor
/// @returns a picture of rig.size pixels, linear in [0, 1], with labels of the same size and what was drawn
/// @throws invalid_input for a rig, a seabed, a material, a pose or an option that can't be right
template <shadow::policy Shadow = shadow::refined, class Labels = labels, backscatter_law Law = lambert,
          executor_argument E = serial_executor>
frame<Labels> render(const scene& s, const overhead& rig, const render_options<Shadow, Labels, Law>& options = {},
                     E&& ex = {}) {
    return detail::overhead_painter<Shadow, Labels, Law>(s, rig, options, ex).paint(ex);
}

}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
