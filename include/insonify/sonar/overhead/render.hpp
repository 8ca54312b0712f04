// Draws overhead pictures: samples the seabed in view, draws it and the targets, casts shadows, and labels pixels.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/geometry/bounds.hpp>
#include <insonify/raster/draw.hpp>
#include <insonify/shadow/exact.hpp>
#include <insonify/sonar/detail/casting_ground.hpp>
#include <insonify/sonar/detail/checked_materials.hpp>
#include <insonify/sonar/overhead/detail/picture_casters.hpp>
#include <insonify/sonar/overhead/detail/sampled_bottom.hpp>
#include <insonify/sonar/overhead/detail/shadow_pass.hpp>
#include <insonify/sonar/overhead/picture.hpp>

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

namespace detail::inline INSONIFY_FLAGS {

/// A picture under construction, in the rig's frame.
template <class Shadow, class Labels, class Law, depth_precision Depth>
class overhead_renderer {
  public:
    overhead_renderer(const scene& s, const overhead& rig, const render_options<Shadow, Labels, Law, Depth>& options,
                      executor_ref ex)
        : scene_(s), materials_(checked_materials(s, options)), view_(rig), options_(options), bottom_(memory_of(ex)) {
        static_assert(shadow::policy<Shadow>,
                      "a shadow policy has build(casters, light, bounds, executor) const, for a light of type const "
                      "shadow::any_light&, which returns an object with test(points, results) const: see "
                      "shadow/policy.hpp");
        out_.rows.step = 0;
        // The first draw clears it.
        out_.image = image<float>(rig.size.x, rig.size.y, uninitialized{}, memory_of(ex));
        require_not_negative("reach", options.reach);
        check(draw_options_of(depth_load::clear), out_.image.view());  // tiles are counted before the first draw
        if constexpr (labelled) out_.labels = labels(s, rig.size.x, rig.size.y, ex);
        if (has_bottom()) add_seabed(ex);
        for (std::size_t i = 0; i < s.targets.size(); ++i) {
            const target& t = s.targets[i];
            add({t.shape, t.shape.box(), view_.rig_from(to_world(t.placement)), t.shape.kind(), t.shape.grid()}, i,
                static_cast<std::uint16_t>(i + 1), labels::no_seabed, t.surface);
        }
    }

    frame<Labels> render_frame(executor_ref ex) {
        if constexpr (casts) {
            dynamic_array<shadow::caster> casters;
            for (const drawn_object& t : targets()) casters.push_back(as_caster(view_, t.placed));
            if (has_bottom()) casters.push_back(as_caster(view_, objects_.front().placed));
            const shadow::point_bounds bounds{receivers(), view_.ground_sampling(), options_.level};
            const auto occlusion =
                options_.shadow.build(std::span<const shadow::caster>(casters), view_.light_source(), bounds, ex);
            const auto known = decide_triangles(occlusion, ex);
            draw_all(ex);
            shadow_pass<Labels>(view_, objects_, {undecided_, out_.image, out_.labels}, targets().size(), options_.tile,
                                options_.level)
                .cast(occlusion, ex);
        } else {
            draw_all(ex);
        }
        if constexpr (labelled) {
            label_objects(ex);
            measure_targets(out_.labels);
        }
        return std::move(out_);
    }

    /// The visibility buffer alone.
    visibility render_visibility(executor_ref ex) {
        draw_all(ex);
        visibility shown{image<std::uint16_t>(ids_.width(), ids_.height(), labels::no_instance), std::move(ids_)};
        for (std::size_t i = 0; i < shown.triangle.size(); ++i) {
            std::uint32_t& id = shown.triangle.pixels()[i];
            if (id == visibility::no_triangle) continue;
            const drawn_object& s = object_of(objects_, id);
            shown.instance.pixels()[i] = s.instance;
            id -= s.first_id;
        }
        return shown;
    }

  private:
    static constexpr bool labelled = std::is_same_v<Labels, labels>;
    static constexpr bool casts = !std::is_same_v<Shadow, shadow::none>;

    bool has_bottom() const { return !scene_.seabed.empty(); }
    std::span<const drawn_object> targets() const {
        return {objects_.data() + (has_bottom() ? 1 : 0), scene_.targets.size()};
    }

    /// @param caster  targets are numbered from 0 on, the seabed follows
    void add(const placed_mesh& placed, std::size_t caster, std::uint16_t instance, std::uint8_t seabed,
             const material& m) {
        const std::uint64_t first =
            objects_.empty() ? 0
                             : std::uint64_t{objects_.back().first_id} + objects_.back().placed.shape.triangles.size();
        const std::uint64_t end = first + placed.shape.triangles.size();
        require(end < shadow::invalid_id, "triangles of the scene", end, "below 2^32 - 1");
        const auto number = static_cast<std::uint32_t>(caster);
        objects_.push_back({.placed = placed,
                            .first_id = static_cast<std::uint32_t>(first),
                            .caster = number,
                            .instance = instance,
                            .seabed = seabed,
                            .whole = m,
                            .self_shadow_label = labels::of_caster(number, scene_.targets.size())});
    }

    /// Samples the ground in view, and towards the light as far as its relief can cast a shadow into view.
    void add_seabed(executor_ref ex) {
        const overhead& rig = view_.rig();
        seabed::detail::require_position("overhead.position", rig.position);
        const int longer = (std::max)(rig.size.x, rig.size.y);
        const double spacing = options_.cell > 0 ? options_.cell : longer_side(view_) / ((longer + 1) / 2);
        require(spacing >= min_cell(view_) && spacing < 1e6, "cell", spacing,
                "at least 1/32768 of the picture's longer side, and below 10^6 metres");

        seabed::height_range range = scene_.seabed.prepare().range();
        seabed::detail::require_finite(range);
        seabed::detail::require_above(range, "overhead.altitude", static_cast<double>(rig.altitude));
        range = merge(range, {0, 0});
        const auto sample = [&](const seabed::height_range& heights) {
            ground_rect ground = shown_ground(view_, heights);
            if constexpr (casts)
                ground = casting_ground(ground, heights, view_.world_light(), shadow::radius_of(options_.shadow),
                                        static_cast<double>(options_.reach) * longer_side(view_));
            bottom_.sample(scene_.seabed, rig.position, ground, spacing, ex);
        };
        sample(range);
        // Targets below the seabed are seen through its gaps, and ground farther towards the light shades them.
        const double deepest = casts && bottom_.is_open() ? lowest_target() : range.lowest;
        if (deepest < range.lowest) sample({deepest, range.highest});
        seabed::detail::require_within(range, static_cast<double>(bottom_.lowest()),
                                       static_cast<double>(bottom_.highest()));
        const seabed::heightfield& field = bottom_.field();
        out_.stats.seabed_samples = field.heights.size();
        out_.stats.cell = spacing;
        out_.stats.seabed_columns = field.heights.width();
        out_.stats.seabed_rows = field.heights.height();
        add(bottom_.placed_under(view_), scene_.targets.size(), labels::no_instance,
            static_cast<std::uint8_t>(field.fallback), materials_[seabed::index_of(field.fallback)]);
        if (field.types.empty()) return;
        objects_.back().types = field.types.pixels().data();
        objects_.back().materials = materials_.data();
    }

    double lowest_target() const {
        double lowest = std::numeric_limits<double>::infinity();
        for (const target& t : scene_.targets)
            lowest = (std::min)(lowest, transformed(t.shape.box(), to_world(t.placement)).lower.z);
        return lowest;
    }

    /// A box around everything that the picture may show.
    bounding_box receivers() const {
        double low = static_cast<double>(bottom_.lowest()), top = static_cast<double>(bottom_.highest());
        if (!has_bottom()) {
            low = (std::numeric_limits<double>::max)();
            top = -low;
        }
        for (const drawn_object& t : targets()) {
            const bounding_box box = transformed(t.placed.box, t.placed.to_rig);
            top = (std::max)(top, box.upper.z);
            if (bottom_.is_open()) low = (std::min)(low, box.lower.z);
        }
        if (low > top) return {};
        const glm::dvec2 half = view_.half_extent(low);
        return {{-half, low}, {half, top}};
    }

    /// Decides whole triangles before they are drawn, lit or dark. The objects point to the results.
    template <class Occlusion>
    dynamic_array<uninitialized_array<shadow::decision>> decide_triangles(const Occlusion& occlusion, executor_ref ex) {
        dynamic_array<uninitialized_array<shadow::decision>> known;
        if constexpr (shadow::triangle_occlusion<Occlusion>)
            for (drawn_object& s : objects_) {
                // A mesh much finer than the picture has more triangles than points to test.
                if (s.placed.shape.triangles.size() > 2 * out_.image.size()) continue;
                known.push_back(occlusion.decide_triangles(s.caster, view_.eye(), ex));
                if (!known.back().empty()) s.known = known.back().data();
            }
        return known;
    }

    draw_options<Depth> draw_options_of(depth_load load) const {
        return {.compare = depth_compare::greater,
                .load = load,
                .subpixel_bits = options_.subpixel_bits,
                .tile = options_.tile,
                .level = options_.level};
    }

    /// Draws all objects: light where it is decided, and the visibility buffer.
    void draw_all(executor_ref ex) {
        const overhead& rig = view_.rig();
        image<float> depth(rig.size.x, rig.size.y, uninitialized{}, memory_of(ex));
        shaded_images into{out_.image};
        if constexpr (casts) {
            undecided_ = undecided_light(rig.size.x, rig.size.y, options_.tile, memory_of(ex));
            into.undecided = &undecided_;
            if constexpr (labelled) into.shadow = &out_.labels.shadow;
        }
        if constexpr (labelled) {
            ids_ = image<std::uint32_t>(rig.size.x, rig.size.y, uninitialized{}, memory_of(ex));
            into.ids = &ids_;
            into.types = &out_.labels.seabed;
        }
        if (objects_.empty()) into.clear({0, 0, rig.size.x, rig.size.y});
        for (std::size_t i = 0; i < objects_.size(); ++i) {
            const placed_mesh& placed = objects_[i].placed;
            const draw_stats stats =
                draw(placed.shape, surface_vertex_shader(view_, placed),
                     surface_shader<Law>(view_, objects_[i], options_.law, into), framebuffer<void>{depth},
                     draw_options_of(i == 0 ? depth_load::clear : depth_load::keep), ex);
            (has_bottom() && i == 0 ? out_.stats.seabed : out_.stats.targets) += stats;
        }
    }

    /// Labels instances and seabed types from the visibility buffer.
    void label_objects(executor_ref ex) {
        if (objects_.empty()) return;
        ex.bulk(static_cast<std::size_t>(ids_.height()), [&](std::size_t row) {
            const int y = static_cast<int>(row);
            const drawn_object* last = objects_.data();
            for (int x = 0; x < ids_.width(); ++x) {
                const std::uint32_t id = ids_(x, y);
                if (id == shadow::invalid_id) continue;
                if (id - last->first_id >= last->placed.shape.triangles.size()) last = &object_of(objects_, id);
                out_.labels.instance(x, y) = last->instance;
                if (last->types == nullptr) out_.labels.seabed(x, y) = last->seabed;
            }
        });
    }

    const scene& scene_;
    bottom_materials materials_;  ///< by seabed::type
    overhead_geometry view_;
    render_options<Shadow, Labels, Law, Depth> options_;
    image<std::uint32_t> ids_;  ///< the visibility buffer; triangles are numbered in the order of objects_
    undecided_light undecided_;
    frame<Labels> out_;
    sampled_bottom bottom_;
    dynamic_array<drawn_object> objects_;  ///< the seabed, if there is one, and the targets, as they are drawn
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
