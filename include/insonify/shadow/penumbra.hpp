// Soft shadows of a disc light: exact shadows from several sample points on the disc, averaged.
//
// Sample points fill the disc in Vogel's sunflower spiral, the first at the centre.
//
// Based on: Helmut Vogel. A Better Way to Construct the Sunflower Head. Mathematical Biosciences 44, 1979.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/shadow/exact.hpp>

#include <optional>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow {

inline namespace INSONIFY_FLAGS {

/// Casters under several points of one light.
class penumbra_occlusion {
  public:
    /// See casting_policy.
    /// @param radius   of the light over its distance
    /// @param samples  points on the disc; those of parallel light below the horizon are counted but give no light
    /// @throws invalid_input as exact_occlusion does
    template <executor E>
    penumbra_occlusion(double radius, int samples, std::span<const caster> casters, const any_light& light,
                       const point_bounds& bounds, E& ex)
        : casters_(casters), samples_(samples) {
        for (int i = 0; i < samples; ++i) {
            const double share = i == 0 ? 0 : numeric::square_root((i + 0.5) / samples);
            const auto [sine, cosine] = numeric::sin_cos_turns(0.6180339887498949 * i);
            const auto at = sample_of(light, radius * share * glm::dvec2(cosine, sine));
            if (at) lights_.push_back({casters, *at, bounds, ex});
        }
    }

    /// See occlusion.
    void test(const points& at, const results& into) const {
        lights_.front().test(at, into);
        insonify::detail::uninitialized_array<float> lit(at.size());
        insonify::detail::uninitialized_array<std::uint32_t> blocking(at.size());
        const results one{lit, blocking};
        for (std::size_t i = 1; i < lights_.size(); ++i) {
            lights_[i].test(at, one);
            add(lights_[i], at, one, into);
        }
        for (float& lit_sum : into.lit) lit_sum /= static_cast<float>(samples_);
    }

  private:
    /// A point of the light, or none below the horizon.
    /// @param disc_offset  from the disc's centre, across and down, divided by the light's distance
    static std::optional<any_light> sample_of(const any_light& light, const glm::dvec2& disc_offset) {
        if (disc_offset == glm::dvec2(0)) return light;
        if (const auto* source = std::get_if<point_light>(&light))
            return point_light{point_of_disc(source->position, disc_offset)};
        const light_frame frame(std::get<directional_light>(light));
        const glm::dvec3 d = toward_disc(frame.to_light(), frame.travel(), disc_offset);
        const double elevation = numeric::atan2(d.z, numeric::length(glm::dvec2(d)));
        if (!(elevation >= directional_light::lowest_elevation)) return std::nullopt;
        return directional_light{numeric::atan2(-d.y, -d.x), elevation};
    }

    /// Adds the light of one sample to the points whose facets show it and the light's centre the same side.
    void add(const exact_occlusion& here, const points& at, const results& one, const results& into) const {
        for (std::size_t i = 0; i < at.size(); ++i) {
            if (!(one.lit[i] > 0)) continue;
            const glm::dvec3 facet = facet_of(casters_, at, i);
            const bool faces = facet == glm::dvec3(0) || (numeric::dot(facet, here.toward(at[i])) > 0) ==
                                                             (numeric::dot(facet, lights_.front().toward(at[i])) > 0);
            if (faces) into.lit[i] += one.lit[i];
        }
    }

    detail::dynamic_array<caster> casters_;
    int samples_;
    detail::dynamic_array<exact_occlusion> lights_;  ///< the middle first
};

}  // namespace INSONIFY_FLAGS

/// Soft edges: exact shadows from several points of a disc light. Each sample costs as much time as `exact`,
/// and holds its memory until the picture is finished. The caster is the one that blocks the light's centre. The disc
/// of a point light faces the origin of the frame in which the light is described.
struct penumbra {
    float diameter = static_cast<float>(numeric::to_radians(0.5));  ///< seen from the ground, 0 to 1 radian
    int samples = 16;  ///< points on the disc, the first at its centre; 1 to 1024

    /// Radius of the light over its distance.
    /// @throws invalid_input for a diameter out of range
    INSONIFY_MEMBER double light_radius() const {
        insonify::detail::require(diameter >= 0 && diameter <= 1, "penumbra.diameter", diameter, "0 to 1 radian");
        return numeric::tan(0.5 * static_cast<double>(diameter));
    }

    /// See casting_policy.
    /// @throws invalid_input for a diameter or samples out of range, else as exact_occlusion does
    template <executor E>
    INSONIFY_MEMBER penumbra_occlusion build(std::span<const caster> casters, const any_light& light,
                                             const point_bounds& bounds, E& ex) const {
        insonify::detail::require(samples >= 1 && samples <= 1024, "penumbra.samples", samples, "1 to 1024");
        return {light_radius(), samples, casters, light, bounds, ex};
    }
};

}  // namespace shadow
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
