// Who is in whose shadow: one map for the seabed, and a small tight one for each target, so that a target's shadow is
// fine whatever the size of the picture, and the label of a shadow is the name of who casts it.
#pragma once

#include <insonify/shadow/lookup.hpp>
#include <insonify/sonar/labels.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::detail {

/// How much light arrives at a point, and who stops the rest.
struct light_share {
    float lit;
    std::uint16_t caster;
};

/// Nothing is ever dark, and nobody needs to know which way a facet looks.
struct no_shadow_maps {
    template <class Facet>
    light_share operator()(const glm::vec3&, const Facet&, std::uint16_t) const {
        return {1, labels::is_lit};
    }
};

/// An object in the rig's frame.
struct placed_mesh {
    const mesh* shape;
    affine to_rig;
    glm::mat3 normals;  ///< takes normals along

    placed_mesh(const mesh& m, const affine& map) : shape(&m), to_rig(map), normals(numeric::cofactors(map.linear)) {}
};

/// The maps of all casters of a scene.
template <class Policy>
class shadow_maps {
  public:
    /// @param bottom     the seabed, which also receives; it need not cast beyond `receivers`
    /// @param targets    in the order of their instance numbers
    /// @param receivers  which rays reach something that the picture may show
    /// @param texel      metres
    template <executor E>
    shadow_maps(const Policy& policy, const shadow::light_frame& light, const placed_mesh& bottom,
                std::span<const placed_mesh> targets, const shadow::map_extent& receivers, double texel, E& ex)
        : policy_(policy), light_(light), bottom_(cast(bottom, receivers, texel, ex)) {
        targets_.reserve(targets.size());
        for (const placed_mesh& t : targets) targets_.push_back(cast(t, receivers, texel, ex));
    }

    /// @param position  in the rig's frame
    /// @param facet     called for the normal of the triangle at that point, of any length
    /// @param itself    who is to blame if the surface faces away and nobody else stands in the light
    template <class Facet>
    light_share operator()(const glm::vec3& position, const Facet& facet, std::uint16_t itself) const {
        // A target's shadow goes on over what would be dark without it.
        const shadow::receiver at(light_, glm::dvec3(position), glm::dvec3(facet()));
        light_share share{1, labels::is_lit};
        for (std::size_t i = 0; i < targets_.size(); ++i)
            darken(share, shadow::lit(targets_[i], at, policy_), static_cast<std::uint16_t>(i + 1));
        if (!at.faces_light)
            darken(share, 0, itself);
        else if (share.lit > 0)
            darken(share, shadow::lit(bottom_, at, policy_), labels::by_seabed);
        return share;
    }

  private:
    static void darken(light_share& share, float lit, std::uint16_t caster) {
        if (lit < 0.5f && share.caster == labels::is_lit) share.caster = caster;
        share.lit = (std::min)(share.lit, lit);
    }

    template <executor E>
    shadow::height_map cast(const placed_mesh& caster, const shadow::map_extent& receivers, double texel, E& ex) const {
        const shadow::map_extent own = shadow::extent_of(*caster.shape, caster.to_rig, light_, ex);
        shadow::height_map map(light_, own.clipped_to(receivers), texel, policy_.largest);
        map.cast(*caster.shape, caster.to_rig, ex);
        return map;
    }

    Policy policy_;
    shadow::light_frame light_;
    shadow::height_map bottom_;
    std::vector<shadow::height_map> targets_;
};

}  // namespace insonify::inline INSONIFY_ABI::detail

INSONIFY_ARITHMETIC_END
