// One picture: the seabed sampled where the rig looks, shadows, the image in linear values, and its labels.
#pragma once

#include <insonify/geometry/bounds.hpp>
#include <insonify/raster/draw.hpp>
#include <insonify/seabed/sample.hpp>
#include <insonify/seabed/tessellate.hpp>
#include <insonify/sonar/illumination.hpp>
#include <insonify/sonar/rig.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI {

/// Asks for no labels: none are stored or computed.
struct no_labels {};

/// How to draw a picture; the types say what is in it.
template <shadow::policy Shadow = shadow::pcf, class Labels = labels, backscatter_law Law = lambert>
struct render_options {
    Shadow shadow{};
    Law law{};
    int cells = 0;  ///< of the seabed, along the picture's longer side; 0: one for every two pixels
    int tile = 64;  ///< see draw_options
    isa level = best_isa();
};

/// What became of the triangles, and how large the intermediate things were.
struct render_stats {
    draw_stats seabed, targets;
    int seabed_columns = 0, seabed_rows = 0;  ///< vertices sampled
};

/// A picture with all that is known about it.
template <class Labels = labels>
struct frame {
    insonify::image<float> image;  ///< linear, [0, 1]; see the rig for what a value means
    Labels labels;                 ///< or no_labels
    render_stats stats;
};

namespace detail {

/// What a pixel is shaded from, in the rig's frame.
struct surface_point {
    glm::vec3 position;
    glm::vec3 normal;
};

/// A picture under construction, in the rig's frame.
template <class Shadow, class Labels, class Law>
class overhead_painter {
  public:
    template <executor E>
    overhead_painter(const scene& s, const overhead& rig, const render_options<Shadow, Labels, Law>& options, E& ex)
        : scene_(s),
          view_(rig),
          to_light_(view_.light().to_light()),
          options_(options),
          depth_(rig.size.x, rig.size.y) {
        require(s.targets.size() < labels::by_seabed, "scene.targets.size()", s.targets.size(), "below 65535");
        out_.image = image<float>(rig.size.x, rig.size.y);
        validate(options.shadow);
        if constexpr (labelled) out_.labels = labels(rig.size.x, rig.size.y);
        for (const target& t : s.targets) targets_.emplace_back(t.shape, view_.rig_from(to_world(t.placement)));
        sample_seabed(ex);
    }

    template <executor E>
    frame<Labels> paint(E& ex) {
        if constexpr (std::is_same_v<Shadow, shadow::none>)
            draw_all(no_shadow_maps{}, ex);
        else
            draw_all(shadow_maps<Shadow>(
                         options_.shadow, view_.light(), bottom_in_rig(), targets_, receivers(),
                         view_.ground_sampling() / static_cast<double>(options_.shadow.texels_per_pixel), ex),
                     ex);
        if constexpr (labelled) describe_targets(out_.labels, scene_.targets);
        return std::move(out_);
    }

  private:
    static constexpr bool labelled = std::is_same_v<Labels, labels>;

    /// Heights where the picture looks, and up-light of there as far as the relief can throw a shadow.
    template <executor E>
    void sample_seabed(E& ex) {
        const overhead& rig = view_.rig();
        const int longer = (std::max)(rig.size.x, rig.size.y);
        const int cells = options_.cells > 0 ? options_.cells : (longer + 1) / 2;
        require(cells <= 32768, "cells", cells, "at most 32768");
        const double spacing = 2 * (std::max)(view_.half_extent(0).x, view_.half_extent(0).y) / cells;

        // A coarse look, a picture's length up-light too, tells how high and deep the bottom goes; the margin makes up
        // for what it misses.
        const double whole_picture = 2 * (std::max)(view_.half_extent(0).x, view_.half_extent(0).y);
        const double farthest = std::is_same_v<Shadow, shadow::none> ? 0 : whole_picture;
        const auto sample = [&](seabed::grid grid) {
            bottom_origin_ = grid.origin;
            grid.origin += rig.position;
            return seabed::sample(scene_.seabed, grid, ex);
        };
        include_heights(sample(footprint(0, 0, farthest, 4 * spacing)), 0.25f);
        const double reach = static_cast<double>(highest_ - lowest_) * view_.light().cot_elevation();
        field_ = sample(footprint(static_cast<double>(lowest_), static_cast<double>(highest_),
                                  (std::min)(reach, farthest), spacing));
        include_heights(field_, 0);
        bottom_ = seabed::tessellate(field_, ex);
        out_.stats.seabed_columns = field_.heights.width();
        out_.stats.seabed_rows = field_.heights.height();
    }

    /// A grid under the picture of a bottom between two heights, longer by `reach` metres towards the light; its origin
    /// is relative to the rig's position, so that far from the world's origin no bit of it changes.
    seabed::grid footprint(double low, double high, double reach, double spacing) const {
        const glm::dmat3& turn = view_.rig_from({}).linear;
        const glm::dvec2& travel = view_.light().travel();
        const glm::dvec2 up_light = -reach * glm::dvec2(numeric::product(glm::transpose(turn), glm::dvec3(travel, 0)));
        glm::dvec2 first(0), last(0);
        for (int right : {-1, 1})
            for (int up : {-1, 1})
                for (double height : {low, high})
                    for (const glm::dvec2& shift : {glm::dvec2(0), up_light}) {
                        const glm::dvec2 p = view_.corner(height, right, up) + shift;
                        first = {(std::min)(first.x, p.x), (std::min)(first.y, p.y)};
                        last = {(std::max)(last.x, p.x), (std::max)(last.y, p.y)};
                    }
        const auto vertices = [&](double length) {
            return (std::max)(2, static_cast<int>(numeric::floor_to_int(length / spacing + 1e-6)) + 1);
        };
        const int width = vertices(last.x - first.x), height = vertices(last.y - first.y);
        const glm::dvec2 slack = last - first - spacing * glm::dvec2(width - 1, height - 1);
        const bool covers = slack.x < 1e-3 * spacing && slack.y < 1e-3 * spacing;
        return {first, spacing, covers ? width : width + 1, covers ? height : height + 1};
    }

    void include_heights(const seabed::heightfield& field, float margin) {
        for (const float height : field.heights.pixels()) {
            if (!numeric::is_finite(height)) continue;
            lowest_ = (std::min)(lowest_, height);
            highest_ = (std::max)(highest_, height);
        }
        const float room = margin * (highest_ - lowest_);
        lowest_ -= room;
        highest_ += room;
    }

    placed_mesh bottom_in_rig() const {
        const affine under_rig = view_.rig_from({glm::dmat3(1), glm::dvec3(view_.rig().position, 0)});
        return {bottom_, compose(under_rig, {glm::dmat3(1), glm::dvec3(bottom_origin_, 0)})};
    }

    /// All rays of the light that reach something which the picture may show.
    shadow::map_extent receivers() const {
        shadow::map_extent extent;
        double top = static_cast<double>(highest_);
        for (const placed_mesh& t : targets_) {
            const bounding_box box = bounds(*t.shape);
            if (!box.empty())
                for (int corner = 0; corner < 8; ++corner)
                    top = (std::max)(top, transform_point(t.to_rig, {(corner & 1 ? box.upper : box.lower).x,
                                                                     (corner & 2 ? box.upper : box.lower).y,
                                                                     (corner & 4 ? box.upper : box.lower).z})
                                              .z);
        }
        for (const double height : {static_cast<double>(lowest_), top}) {
            const glm::dvec2 half = view_.half_extent(static_cast<double>(lowest_));
            for (const double x : {-half.x, half.x})
                for (const double y : {-half.y, half.y}) extent.include(view_.light()(glm::dvec3(x, y, height)));
        }
        return extent;
    }

    template <class Shadows, executor E>
    void draw_all(const Shadows& shadows, E& ex) {
        const auto type_of = [&](const fragment<surface_point>& f) {
            return field_.types.empty() ? field_.fallback : field_.types.pixels()[nearest_vertex(f)];
        };
        const placed_mesh bottom = bottom_in_rig();
        out_.stats.seabed = draw_one(
            bottom, depth_load::clear,
            [&](const fragment<surface_point>& f) {
                const seabed::type type = type_of(f);
                shade(f, bottom, scene_.bottom_of(type), shadows, labels::no_instance, static_cast<std::uint8_t>(type));
            },
            ex);
        for (std::size_t i = 0; i < targets_.size(); ++i)
            out_.stats.targets += draw_one(
                targets_[i], depth_load::keep,
                [&](const fragment<surface_point>& f) {
                    shade(f, targets_[i], scene_.targets[i].surface, shadows, static_cast<std::uint16_t>(i + 1),
                          labels::no_seabed);
                },
                ex);
    }

    template <class Fragment, executor E>
    draw_stats draw_one(const placed_mesh& object, depth_load load, const Fragment& fragment_callable, E& ex) {
        const glm::mat3 linear(object.to_rig.linear);
        const glm::vec3 offset(object.to_rig.offset);
        const auto place = [&, linear, offset](const vertex& v) {
            const glm::vec3 position = numeric::product(linear, v.position) + offset;
            return placed_vertex<surface_point>{view_.clip(position),
                                                {position, numeric::product(object.normals, v.normal)}};
        };
        return draw(*object.shape, place, fragment_callable, framebuffer<void>{depth_},
                    {.keep = keep_depth::larger, .load = load, .tile = options_.tile, .level = options_.level}, ex);
    }

    /// The seabed's vertex that weighs most at a pixel.
    std::size_t nearest_vertex(const fragment<surface_point>& f) const {
        const glm::uvec3& t = bottom_.triangles[f.triangle];
        return f.weights.x >= f.weights.y ? (f.weights.x >= f.weights.z ? t.x : t.z)
                                          : (f.weights.y >= f.weights.z ? t.y : t.z);
    }

    /// Normal of the triangle that a pixel shows, on the side that is seen; not unit.
    static glm::vec3 facet_normal(const placed_mesh& object, const fragment<surface_point>& f) {
        const glm::uvec3& t = object.shape->triangles[f.triangle];
        const glm::vec3& a = object.shape->positions[t.x];
        const glm::vec3 ab = object.shape->positions[t.y] - a, ac = object.shape->positions[t.z] - a;
        return numeric::product(object.normals, numeric::cross(f.front ? ab : ac, f.front ? ac : ab));
    }

    template <class Shadows>
    void shade(const fragment<surface_point>& f, const placed_mesh& object, const material& surface,
               const Shadows& shadows, std::uint16_t instance, std::uint8_t type) {
        const glm::vec3& n = f.varyings.normal;
        const float length = numeric::square_root(n.x * n.x + n.y * n.y + n.z * n.z);
        const glm::vec3& to_light = to_light_;
        const float sine = (f.front ? 1.0f : -1.0f) * (n.x * to_light.x + n.y * to_light.y + n.z * to_light.z) / length;
        const light_share share = shadows(
            f.varyings.position, [&] { return facet_normal(object, f); },
            instance == labels::no_instance ? labels::by_seabed : instance);

        const overhead& rig = view_.rig();
        const bool is_dark = !(sine > 0) || share.lit == 0;
        const float direct = is_dark ? 0 : rig.intensity * options_.law((std::min)(sine, 1.0f)) * share.lit;
        const float open_sky = 0.5f * (1 + (f.front ? n.z : -n.z) / length);
        out_.image(f.x, f.y) = (std::min)(surface.reflectivity * (direct + rig.sky * open_sky), 1.0f);
        if constexpr (labelled) {
            out_.labels.instance(f.x, f.y) = instance;
            out_.labels.shadow(f.x, f.y) = share.caster;
            out_.labels.seabed(f.x, f.y) = type;
        }
    }

    const scene& scene_;
    overhead_geometry view_;
    glm::vec3 to_light_;
    render_options<Shadow, Labels, Law> options_;
    image<float> depth_;
    frame<Labels> out_;
    seabed::heightfield field_;
    mesh bottom_;
    glm::dvec2 bottom_origin_{};      ///< of the field, from the rig's position
    float lowest_ = 0, highest_ = 0;  ///< of the bottom
    std::vector<placed_mesh> targets_;
};

}  // namespace detail

/// Draws a scene as the paper's rig sees it.
///
/// @param s        the seabed and its targets
/// @param rig      camera and light; see there for what a pixel means
/// @param options  types of shadow, labels and backscatter law, and how finely the seabed is sampled
/// @param ex       who runs it; the result is the same bytes for any executor
/// @returns a picture of rig.size pixels, linear in [0, 1], with labels of the same size and what was drawn
/// @throws invalid_input for a rig, a seabed, a pose or an option that can't be right
template <shadow::policy Shadow = shadow::pcf, class Labels = labels, backscatter_law Law = lambert,
          executor_argument E = serial_executor>
frame<Labels> render(const scene& s, const overhead& rig, const render_options<Shadow, Labels, Law>& options = {},
                     E&& ex = {}) {
    return detail::overhead_painter<Shadow, Labels, Law>(s, rig, options, ex).paint(ex);
}

}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
