// Shadow tests of points in a scene, without a picture: built once per light, then tested for any number of points.
//
// The casters are those of `render`: the targets, and the seabed sampled around the points and towards the light.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/seabed/sample.hpp>
#include <insonify/seabed/tessellate.hpp>
#include <insonify/shadow/exact.hpp>
#include <insonify/sonar/detail/casting_ground.hpp>
#include <insonify/sonar/labels.hpp>
#include <insonify/sonar/overhead/rig.hpp>
#include <insonify/sonar/scene.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// The region of the points that will be tested, and the sampling of the seabed there.
struct occlusion_bounds {
    bounding_box box;  ///< contains all points, in the world; not empty
    double cell = 0;   ///< metres between vertices of the seabed; 0: 1/512 of the longest of the box's sides along x
                       ///< and y, a thousandth of its height, and the height of the seabed above its lower side
    double reach = 8;  ///< largest distance towards the light, along either axis, at which the seabed is sampled, in
                       ///< multiples of the same length
};

inline namespace INSONIFY_FLAGS {

/// The light of a rig, in the world.
inline shadow::any_light light_of(const overhead& rig) {
    shadow::any_light light = overhead_geometry(rig).world_light();
    if (auto* source = std::get_if<shadow::point_light>(&light)) source->position += glm::dvec3(rig.position, 0);
    return light;
}

}  // namespace INSONIFY_FLAGS

/// Fraction of the light that reaches points, and the casters of their shadows.
struct occlusion_results {
    std::vector<float> lit;             ///< 0 to 1
    std::vector<std::uint16_t> shadow;  ///< as in labels::shadow: 0, an instance, or labels::by_seabed
};

inline namespace INSONIFY_FLAGS {

/// The casters of a scene under one light. Shares the targets' meshes; the scene need not outlive it.
/// @param Occlusion  built by a shadow policy
template <class Occlusion>
class scene_occlusion {
  public:
    /// See occlusion_of.
    template <class Shadow, executor E>
    scene_occlusion(const scene& s, const shadow::any_light& light, const occlusion_bounds& within,
                    const Shadow& policy, E& ex)
        : centre_((validate(s), detail::require_numbered_targets(s), require_box(within), require_light(light),
                   within.box.centre())),
          ground_(sampling_of(s, within)),
          shapes_(shapes_of(s, light, within, shadow::radius_of(policy), ex)),
          targets_(s.targets.size()),
          built_(policy.build(casters(), from_centre(light), local(within), ex)) {}

    /// @param at  in the world, within the bounds. This is not checked: the seabed is not sampled for points outside,
    ///            which may come out lit, as do points that are not finite
    template <executor_argument E = serial_executor>
    occlusion_results test(std::span<const glm::dvec3> at, E&& ex = {}) const {
        occlusion_results all{std::vector<float>(at.size()), std::vector<std::uint16_t>(at.size())};
        bulk_ranges(ex, at.size(), max_points, [&](std::size_t first, std::size_t last) {
            const std::size_t count = last - first;
            detail::dynamic_array<double> x(count), y(count), z(count);
            for (std::size_t i = 0; i < count; ++i) {
                x[i] = at[first + i].x - centre_.x;
                y[i] = at[first + i].y - centre_.y;
                z[i] = at[first + i].z;
            }
            const detail::dynamic_array<std::uint32_t> none(count, shadow::invalid_id);
            detail::dynamic_array<std::uint32_t> caster(count);
            built_.test(shadow::points{x, y, z, none, none},
                        shadow::results{std::span(all.lit).subspan(first, count), caster});
            for (std::size_t i = 0; i < count; ++i)
                if (caster[i] != shadow::invalid_id && all.lit[first + i] < 0.5f)
                    all.shadow[first + i] = labels::of_caster(caster[i], targets_);
        });
        return all;
    }

  private:
    static constexpr std::size_t max_points = 16384;

    struct placed {
        shared_mesh shape;
        affine placement;  ///< into a frame around the centre of the bounds, over the datum
    };

    /// How the seabed is sampled.
    struct sampling {
        seabed::height_range range{};  ///< of its heights
        double cell, reach;            ///< metres
    };

    static void require_box(const occlusion_bounds& within) {
        for (const auto& [name, corner] : {std::pair{"occlusion_bounds.box.lower", within.box.lower},
                                           std::pair{"occlusion_bounds.box.upper", within.box.upper}})
            for (int i = 0; i < 3; ++i)
                detail::require(corner[i] == corner[i], std::string(name) + "." + "xyz"[i], corner[i], "a number");
        const glm::dvec3 size = within.box.size();
        detail::require(!within.box.empty() && numeric::is_finite(size.x + size.y + size.z),
                        "occlusion_bounds.box.size()", size.x + size.y + size.z, "that of a box around the points");
        seabed::detail::require_metres("occlusion_bounds.cell", within.cell);
        detail::require_range("occlusion_bounds.reach", within.reach, 0, 1e6, "0 to 10^6");
        seabed::detail::require_position("occlusion_bounds.box.lower", glm::dvec2(within.box.lower));
        seabed::detail::require_position("occlusion_bounds.box.upper", glm::dvec2(within.box.upper));
    }
    static void require_light(const shadow::any_light& light) {
        if (const auto* parallel = std::get_if<shadow::directional_light>(&light)) {
            static_cast<void>(shadow::light_frame(*parallel));
            return;
        }
        detail::require_finite("point_light.position", std::get<shadow::point_light>(light).position);
    }
    affine around_centre(affine to_world) const {
        to_world.offset -= glm::dvec3(centre_.x, centre_.y, 0);
        return to_world;
    }
    shadow::any_light from_centre(shadow::any_light light) const {
        if (auto* source = std::get_if<shadow::point_light>(&light))
            source->position -= glm::dvec3(centre_.x, centre_.y, 0);
        return light;
    }
    shadow::point_bounds local(const occlusion_bounds& within) const {
        const glm::dvec3 away(centre_.x, centre_.y, 0);
        return {{within.box.lower - away, within.box.upper - away}, 0.5 * ground_.cell};
    }
    static sampling sampling_of(const scene& s, const occlusion_bounds& within) {
        const glm::dvec3 size = within.box.size();
        double length = (std::max)({size.x, size.y, 1e-3 * size.z, 1e-9});
        seabed::height_range range;
        if (!s.seabed.empty()) {
            range = s.seabed.prepare().range();
            seabed::detail::require_finite(range);
            // A box around one point has no sides: the ground that may shade it goes by the height of the seabed.
            length = (std::max)(length, range.highest - within.box.lower.z);
        }
        return {range, within.cell > 0 ? within.cell : length / 512, within.reach * length};
    }

    detail::dynamic_array<shadow::caster> casters() const {
        detail::dynamic_array<shadow::caster> all;
        for (const placed& p : shapes_) all.push_back(shadow::caster{p.shape, p.placement, p.shape.box()});
        return all;
    }

    template <executor E>
    detail::dynamic_array<placed> shapes_of(const scene& s, const shadow::any_light& light,
                                            const occlusion_bounds& within, double radius, E& ex) const {
        detail::dynamic_array<placed> all;
        for (const target& t : s.targets) all.push_back({t.shape, around_centre(to_world(t.placement))});
        if (s.seabed.empty()) return all;
        // Around the centre, as the light: the ground below the box, and towards the light.
        const glm::dvec2 centre(centre_);
        const auto& [range, cell, reach] = ground_;
        const detail::ground_rect below{glm::dvec2(within.box.lower) - centre - cell,
                                        glm::dvec2(within.box.upper) - centre + cell};
        const detail::ground_rect ground =
            detail::casting_ground(below, {within.box.lower.z, range.highest}, from_centre(light), radius, reach);
        const glm::dvec2 cells = (ground.upper - ground.lower) / cell;
        seabed::detail::require_vertices(cells.x * cells.y,
                                         "enlarge `occlusion_bounds.cell`, or reduce its box or its reach");
        seabed::grid grid = seabed::grid_over(ground.lower + centre, ground.upper + centre, cell);
        grid.band_limited = true;
        const seabed::heightfield field = seabed::sample(s.seabed, grid, ex);
        all.push_back({seabed::tessellate(field, ex), around_centre({glm::dmat3(1), glm::dvec3(field.origin, 0)})});
        const bounding_box& box = all.back().shape.box();
        seabed::detail::require_within(range, box.lower.z, box.upper.z);
        return all;
    }

    glm::dvec3 centre_;
    sampling ground_;
    detail::dynamic_array<placed> shapes_;  ///< the targets, then the seabed
    std::size_t targets_;
    Occlusion built_;
};

/// Builds the shadow test of a scene for one light.
///
/// A point on a surface is not in the shadow of the triangle that it lies on, up to rounding: compute it in doubles
/// from that triangle's vertices. The seabed's mesh differs from its analytic heights by the error of sampling.
/// @param light   in the world; `light_of(rig)` is that of a rig
/// @param within  region of the points, and sampling of the seabed
/// @param policy  any shadow policy
/// @param ex      runs it; the result is the same for any executor
/// @throws invalid_input for bounds that are empty, not finite or beyond 1e9 metres, a seabed that states no `range` or
///         leaves it, more than 2^28 vertices of it, a light, a policy, a pose or a material out of range, or more than
///         65534 targets
template <shadow::casting_policy Shadow = shadow::exact, executor_argument E = serial_executor>
auto occlusion_of(const scene& s, const shadow::any_light& light, const occlusion_bounds& within,
                  const Shadow& policy = {}, E&& ex = {}) {
    using built = decltype(policy.build(std::span<const shadow::caster>(), light, shadow::point_bounds{}, ex));
    return scene_occlusion<built>(s, light, within, policy, ex);
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
