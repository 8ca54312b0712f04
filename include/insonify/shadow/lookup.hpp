// Whether a point is lit, asked of a shadow map: at the nearest texel, or averaged over some (PCF).
//
// The point's own surface is in the map too. Its facet's plane is carried to each texel's centre before heights are
// compared, and what lies on a neighbouring facet is covered by a bias of one texel's rise along the slope, as the
// light sees it. Level ground has no slope in the light's frame, hence no bias and no gap between an object and its
// shadow; where the slope goes to infinity, the surface faces away and is dark anyway. Half the bias leaves three times
// as much false shadow on rubble at 60 degrees, twice of it a third more leaks at 6 degrees.
//
// Based on: William T. Reeves, David H. Salesin, Robert L. Cook. Rendering Antialiased Shadows with Depth Maps. 1987
#pragma once

#include <insonify/shadow/map.hpp>
#include <insonify/shadow/policy.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::shadow {

/// A surface point as a light sees it: where it lies in the light's frame, and how its plane rises there.
struct receiver {
    /// What gets less than this share of the light on level ground counts as facing away: the last 2 %, where the slope
    /// goes to infinity and every map leaks.
    static constexpr double grazed = 0.02;

    glm::dvec3 uvz{};
    double slope_u = 0, slope_v = 0;  ///< dz / du, dz / dv; 0 where it faces away
    bool faces_light = false;

    receiver() = default;

    /// @param position  in the frame in which the light is described, metres
    /// @param facet     normal of the triangle it lies on, of any length; a smoothed one costs half of the accuracy
    receiver(const light_frame& frame, const glm::dvec3& position, const glm::dvec3& facet) : uvz(frame(position)) {
        const glm::dvec2& travel = frame.travel();
        const double along = facet.x * travel.x + facet.y * travel.y;
        const double across = facet.y * travel.x - facet.x * travel.y;
        const double facing = facet.z - along * frame.cot_elevation();
        faces_light = facing > 0 && facing * facing > grazed * grazed * numeric::dot(facet, facet);
        if (faces_light) {
            slope_u = -along / facing;
            slope_v = -across / facing;
        }
    }
};

namespace detail {

/// A receiver in the units of one map.
class map_receiver {
  public:
    map_receiver(const height_map& map, const receiver& r)
        : map_(map), at_(map.on_map(r.uvz)), slope_u_(map.on_map(r.slope_u)), slope_v_(map.on_map(r.slope_v)) {
        bias_ = 1e-6f + numeric::magnitude(slope_u_) + numeric::magnitude(slope_v_);  // heights are rounded to 1e-7
    }

    /// Whether no texel within `radius` of the nearest one is on the map: nothing can be in the way.
    bool is_beyond(int radius) const {
        const auto reach = static_cast<float>(radius);
        return !(at_.x >= -reach && at_.y >= -reach && at_.x < static_cast<float>(map_.columns()) + reach &&
                 at_.y < static_cast<float>(map_.rows()) + reach);
    }

    /// How many of the (2 radius + 1)^2 rays around the point get past the map to this surface. Expects !is_beyond.
    int open_rays(int radius) const {
        const int column = static_cast<int>(at_.x + 64) - 64, row = static_cast<int>(at_.y + 64) - 64;  // rounds down
        int open = 0;
        for (int j = row - radius; j <= row + radius; ++j)
            for (int i = column - radius; i <= column + radius; ++i) open += is_open(i, j) ? 1 : 0;
        return open;
    }

  private:
    bool is_open(int column, int row) const {
        if (column < 0 || row < 0 || column >= map_.columns() || row >= map_.rows()) return true;
        const float plane = at_.z + slope_u_ * (static_cast<float>(column) + 0.5f - at_.x) +
                            slope_v_ * (static_cast<float>(row) + 0.5f - at_.y);
        return map_(column, row) <= plane + bias_;
    }

    const height_map& map_;
    glm::vec3 at_;
    float slope_u_, slope_v_, bias_;
};

}  // namespace detail

/// Share of light that reaches a point: 0 or 1, from the nearest texel. Surfaces that face away count as level.
inline float lit(const height_map& map, const receiver& r, const shadow::map&) {
    const detail::map_receiver at(map, r);
    return at.is_beyond(0) || at.open_rays(0) == 1 ? 1.0f : 0.0f;
}

/// Share of light that reaches a point, averaged over (2 radius + 1)^2 texels; radius from 0 to 8.
inline float lit(const height_map& map, const receiver& r, const pcf& how) {
    const detail::map_receiver at(map, r);
    if (at.is_beyond(how.radius)) return 1;
    const int rays = (2 * how.radius + 1) * (2 * how.radius + 1);
    return static_cast<float>(at.open_rays(how.radius)) / static_cast<float>(rays);
}

}  // namespace insonify::inline INSONIFY_ABI::shadow

INSONIFY_ARITHMETIC_END
