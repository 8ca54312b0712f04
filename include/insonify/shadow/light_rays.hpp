// The rays of a light, parallel or from a point, and planes over which each of them stands upright: there whatever may
// stop a ray lies over one point.
//
// Of parallel light it is the sea floor in the light's frame. Around a point it is the six sides of a cube, each as its
// centre sees it; a triangle that lies before several of them is over each.
#pragma once

#include <insonify/core/linear.hpp>
#include <insonify/shadow/box_tree.hpp>
#include <insonify/shadow/light.hpp>

#include <optional>
#include <span>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::shadow {

/// Where light comes from, to be asked in doubles. Everything it is asked about lies within `reach` of the origin.
///
/// Bounds are meant for coordinates that are themselves off by a few units in the last place: `slack` and the margins
/// are 2^-40 of the largest number that goes into a coordinate, of which the rounding of a handful of sums and products
/// is less than 2^-49.
class light_rays {
  public:
    light_rays(const light_frame& light, double reach)
        : source_(light.to_light()),
          frame_(light),
          reach_(reach),
          size_(reach),
          slack_(small_share * (1 + frame_.cot_elevation()) * reach) {}
    /// @throws invalid_input for a position that isn't finite
    light_rays(const point_light& light, double reach)
        : source_(light.position), frame_(directional_light{}), is_near_(true) {
        for (int i = 0; i < 3; ++i)
            insonify::detail::require(numeric::is_finite(source_[i]), "point_light.position", source_[i],
                                      "finite coordinates");
        size_ = reach_ = reach;
        for (int i = 0; i < 3; ++i) size_ = (std::max)(size_, numeric::magnitude(source_[i]));
    }

    /// From a point to the light: unit length if it is parallel, the whole way if it isn't.
    glm::dvec3 toward(const glm::dvec3& p) const { return is_near_ ? source_ - p : source_; }
    /// Whether rays end where `toward` does.
    bool end() const { return is_near_; }
    double reach() const { return reach_; }
    /// Of the coordinates of all that is asked about and of the light, if it is near.
    double size() const { return size_; }

    std::size_t planes() const { return is_near_ ? 6 : 1; }

    /// Of parallel light, rays outside of a rectangle of its frame will not be asked about.
    void keep_to(const glm::dvec2& lowest, const glm::dvec2& highest) {
        lowest_ = lowest;
        highest_ = highest;
    }

    /// Over which plane a point is.
    std::size_t plane_of(const glm::dvec3& p) const {
        if (!is_near_) return 0;
        const glm::dvec3 d = p - source_;
        const glm::dvec3 size{numeric::magnitude(d.x), numeric::magnitude(d.y), numeric::magnitude(d.z)};
        const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
        return static_cast<std::size_t>(2 * axis + (d[axis] < 0 ? 1 : 0));
    }
    /// Where it is over it, and how near to the light.
    point_range range_of(std::size_t plane, const glm::dvec3& p) const {
        if (!is_near_) {
            const glm::dvec3 uvz = frame_(p);
            return {uvz.x, uvz.y, uvz.z, slack_};
        }
        const int axis = static_cast<int>(plane / 2);
        const glm::dvec3 d = p - source_;
        const double depth = (std::max)(numeric::magnitude(d[axis]), smallest_depth());
        return {d[(axis + 1) % 3] / depth, d[(axis + 2) % 3] / depth, 1 / depth * (1 - small_share),
                small_share * size_ / depth};
    }

    /// What a triangle covers of a plane, and how near it comes to the light there; none if it isn't over the plane.
    /// A little too large, never too small.
    std::optional<topped_box> over(std::size_t plane, const glm::dvec3& a, const glm::dvec3& b,
                                   const glm::dvec3& c) const {
        if (!is_near_) {
            const topped_box box = around(frame_(a), frame_(b), frame_(c), slack_);
            const bool is_asked =
                static_cast<double>(box.u_low) <= highest_.x && static_cast<double>(box.u_high) >= lowest_.x &&
                static_cast<double>(box.v_low) <= highest_.y && static_cast<double>(box.v_high) >= lowest_.y;
            return is_asked ? std::optional(box) : std::nullopt;
        }
        const int axis = static_cast<int>(plane / 2), next = (axis + 1) % 3, last = (axis + 2) % 3;
        const double sign = plane % 2 == 0 ? 1 : -1;
        // (u, v, depth) before the division.
        const auto before = [&](const glm::dvec3& p) {
            const glm::dvec3 d = p - source_;
            return glm::dvec3(d[next], d[last], sign * d[axis]);
        };
        const glm::dvec3 corner[3] = {before(a), before(b), before(c)};
        const double little = small_share * size_;
        bool outside[4] = {true, true, true, true};
        double nearest = corner[0].z;
        for (const glm::dvec3& p : corner) {
            outside[0] = outside[0] && p.x - p.z > little;
            outside[1] = outside[1] && -p.x - p.z > little;
            outside[2] = outside[2] && p.y - p.z > little;
            outside[3] = outside[3] && -p.y - p.z > little;
            nearest = (std::min)(nearest, p.z);
        }
        if (outside[0] || outside[1] || outside[2] || outside[3]) return std::nullopt;
        if (nearest < smallest_depth()) {
            // It comes past the light, close by: it may be anywhere.
            return topped_box{-2, 2, -2, 2, (std::numeric_limits<float>::max)(), 0};
        }
        const auto seen = [](const glm::dvec3& p) { return glm::dvec3(p.x / p.z, p.y / p.z, 1 / p.z); };
        std::optional<topped_box> box =
            around(seen(corner[0]), seen(corner[1]), seen(corner[2]), small_share * size_ / nearest);
        box->top = rounded_up(1 / nearest * (1 + small_share));
        return box;
    }

  private:
    static constexpr double small_share = 0x1p-40;
    /// Nearer to the light than this, directions aren't told apart.
    double smallest_depth() const { return 0x1p-20 * size_; }

    static topped_box around(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double margin) {
        const auto least = [](double x, double y, double z) { return (std::min)((std::min)(x, y), z); };
        const auto most = [](double x, double y, double z) { return (std::max)((std::max)(x, y), z); };
        return {rounded_down(least(a.x, b.x, c.x) - margin), rounded_up(most(a.x, b.x, c.x) + margin),
                rounded_down(least(a.y, b.y, c.y) - margin), rounded_up(most(a.y, b.y, c.y) + margin),
                rounded_up(most(a.z, b.z, c.z) + margin),    0};
    }

    glm::dvec3 source_;  ///< direction, or position
    light_frame frame_;
    bool is_near_ = false;
    double reach_ = 0, size_ = 0, slack_ = 0;
    glm::dvec2 lowest_{-(std::numeric_limits<double>::max)()}, highest_{(std::numeric_limits<double>::max)()};
};

}  // namespace insonify::inline INSONIFY_ABI::shadow

INSONIFY_ARITHMETIC_END
