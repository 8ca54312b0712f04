// Who is in whose shadow: one caster for the seabed, and a small tight one for each target, so that a target's shadow
// is fine whatever the size of the picture, and the label of a shadow is the name of who casts it.
#pragma once

#include <insonify/shadow/lookup.hpp>
#include <insonify/shadow/refined.hpp>
#include <insonify/sonar/labels.hpp>
#include <insonify/sonar/placed_mesh.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::detail {

/// How much light arrives at N points, and who stops the rest.
template <int N>
struct light_shares {
    lanes<float, N> lit{};
    lanes<std::int32_t, N> caster{};  ///< as in labels::shadow

    INSONIFY_INLINE light_shares() { lit = lanes<float, N>{} + 1.0f; }

    /// Less light, by `by`'s fault if nobody has been blamed before.
    INSONIFY_INLINE void darken(const lanes<float, N>& share, std::uint16_t by) {
        using ints = lanes<std::int32_t, N>;
        const ints blamed = ints(share < 0.5f) & ints(caster == labels::is_lit);
        caster = blamed ? ints{} + std::int32_t{by} : caster;
        lit = share < lit ? share : lit;
    }
};

/// N points of a surface, in the rig's frame.
template <int N>
struct surface_points {
    int x, y;  ///< the first one's pixel; the others are the next of its row
    lanes<std::int32_t, N> visible;
    lanes<float, N> position[3];
    lanes<float, N> facet[3];  ///< normal of the triangle, of any length, on the side that is seen
    std::uint16_t itself;      ///< to blame where the surface faces away and nobody else stands in the light
};

/// Nothing is ever dark.
struct no_shadow_maps {
    const no_shadow_maps& within(const pixel_box&) const { return *this; }
    template <int N>
    INSONIFY_INLINE void operator()(light_shares<N>&, const surface_points<N>&, const lanes<std::int32_t, N>&) const {}
};

/// All casters of a scene, each in the form that the policy asks for.
template <class Policy>
class shadow_maps {
    static constexpr bool refined = std::same_as<Policy, shadow::refined>;
    using caster_form = std::conditional_t<refined, shadow::refined_caster, shadow::height_map>;

  public:
    /// @param bottom     the seabed, which also receives; it need not cast beyond `receivers`. Null for none
    /// @param targets    in the order of their instance numbers
    /// @param receivers  around all that the picture may show
    /// @param texel      metres
    template <executor E>
    shadow_maps(const Policy& policy, const overhead_geometry& view, const placed_mesh* bottom,
                std::span<const placed_mesh> targets, const bounding_box& receivers, double texel, E& ex)
        : policy_(policy),
          light_(view.light()),
          cot_elevation_(static_cast<float>(light_.cot_elevation())),
          travel_{static_cast<float>(light_.travel().x), static_cast<float>(light_.travel().y)} {
        if (bottom != nullptr) bottom_ = cast(*bottom, receivers, texel, ex);
        targets_.reserve(targets.size());
        for (const placed_mesh& t : targets)
            targets_.push_back({cast(t, receivers, texel, ex), shadowed_pixels(view, t, receivers.lower.z)});
    }

    /// What of it may darken a part of the picture.
    class part {
      public:
        part(const shadow_maps& all, const pixel_box& pixels) : all_(all) {
            for (std::size_t i = 0; i < all.targets_.size(); ++i)
                if (!intersect(all.targets_[i].shadowed, pixels).empty())
                    instances_.push_back(static_cast<std::uint16_t>(i + 1));
        }

        /// @param useful  where a shadow would change what is seen; the others' shares need not be right
        template <int N>
        INSONIFY_INLINE void operator()(light_shares<N>& shares, const surface_points<N>& at,
                                        const lanes<std::int32_t, N>& useful) const {
            if constexpr (refined)
                all_.ask_in_lanes(shares, at, useful, instances_);
            else
                all_.ask_one_by_one(shares, at);
        }

      private:
        const shadow_maps& all_;
        std::vector<std::uint16_t> instances_;  ///< of targets
    };
    part within(const pixel_box& pixels) const { return {*this, pixels}; }

  private:
    struct target_caster {
        caster_form form;
        pixel_box shadowed;
    };

    template <int N>
    INSONIFY_INLINE void ask_in_lanes(light_shares<N>& shares, const surface_points<N>& at,
                                      const lanes<std::int32_t, N>& useful,
                                      std::span<const std::uint16_t> instances) const {
        using ints = lanes<std::int32_t, N>;
        using floats = lanes<float, N>;
        // A target's shadow goes on over what would be dark without it.
        ints dark;
        for (const std::uint16_t instance : instances) {
            const target_caster& target = targets_[instance - 1u];
            const pixel_box& shadowed = target.shadowed;
            if (at.y < shadowed.y0 || at.y > shadowed.y1 || at.x > shadowed.x1 || at.x + N <= shadowed.x0) continue;
            target.form.template darken<N>(dark, useful, at.position);
            shares.darken(dark ? floats{} : floats{} + 1.0f, instance);
        }
        floats cot_elevation, travel_x, travel_y;
        load(cot_elevation, cot_elevation_), load(travel_x, travel_[0]), load(travel_y, travel_[1]);
        const floats facing = at.facet[2] - cot_elevation * (at.facet[0] * travel_x + at.facet[1] * travel_y);
        dark = ints(facing <= 0.0f);
        shares.darken(dark ? floats{} : floats{} + 1.0f, at.itself);
        bottom_.template darken<N>(dark, ints(useful & ints(shares.lit > 0.0f)), at.position);
        shares.darken(dark ? floats{} : floats{} + 1.0f, labels::by_seabed);
    }

    template <int N>
    INSONIFY_INLINE void ask_one_by_one(light_shares<N>& shares, const surface_points<N>& at) const {
        for (int k = 0; k < N; ++k) {
            if (lane(at.visible, k) == 0) continue;
            light_shares<1> share;
            const glm::dvec3 position(lane(at.position[0], k), lane(at.position[1], k), lane(at.position[2], k));
            const glm::dvec3 facet(lane(at.facet[0], k), lane(at.facet[1], k), lane(at.facet[2], k));
            ask_one(share, position, facet, at.itself);
            set_lane(shares.lit, k, share.lit);
            set_lane(shares.caster, k, share.caster);
        }
    }
    void ask_one(light_shares<1>& share, const glm::dvec3& position, const glm::dvec3& facet,
                 std::uint16_t itself) const {
        if constexpr (!refined) {
            const shadow::receiver at(light_, position, facet);
            for (std::size_t i = 0; i < targets_.size(); ++i)
                share.darken(shadow::lit(targets_[i].form, at, policy_), static_cast<std::uint16_t>(i + 1));
            if (!at.faces_light)
                share.darken(0, itself);
            else if (share.lit > 0)
                share.darken(shadow::lit(bottom_, at, policy_), labels::by_seabed);
        }
    }

    template <executor E>
    caster_form cast(const placed_mesh& caster, const bounding_box& receivers, double texel, E& ex) const {
        if constexpr (refined) {
            return caster_form(light_, caster.shape, caster.box, caster.to_rig, caster.is_solid, receivers, texel,
                               policy_.largest, ex);
        } else {
            const shadow::map_extent all = shadow::extent_of(receivers, {}, light_);
            const shadow::map_extent own = shadow::extent_of(caster.box, caster.to_rig, light_).clipped_to(all);
            shadow::height_map map(light_, own, texel, policy_.largest);
            map.cast(caster.shape, caster.to_rig, ex);
            return map;
        }
    }

    Policy policy_;
    shadow::light_frame light_;
    spread<float> cot_elevation_, travel_[2];  ///< the light's, again
    caster_form bottom_;
    std::vector<target_caster> targets_;
};

}  // namespace insonify::inline INSONIFY_ABI::detail

INSONIFY_ARITHMETIC_END
