// The bottom below a ping: depths and slopes in the plane of its fan, at equal distances across the track.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/sonar/side_scan/detail/bottom_tiles.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A vertex of the profile.
struct bottom_point {
    double down;  ///< below the sonar
    float slope, slope_along;
    std::uint8_t type;
};

/// Samples the profile of one ping after the other, reusing memory.
class bottom_profile {
  public:
    /// @param start  lower bound of the first vertex's distance across the track
    bottom_profile(const bottom_tiles& tiles, double step, double start, double range)
        : tiles_(tiles),
          step_(step),
          first_(static_cast<std::size_t>(-numeric::floor_to_int(-start / step))),
          end_(static_cast<std::size_t>(numeric::floor_to_int(range / step)) + 2) {}

    void sample(const ping_frame& p) {
        points_.resize(end_ - first_);
        lowest_ = 1e30, highest_ = -1e30;
        const glm::vec2 across(p.across()), along(p.along());
        const double altitude = p.position().z;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            bottom_vertex v;
            double depth;
            if (p.is_level()) {
                const glm::dvec2 at = p.world(x(i), 0);
                v = tiles_.at(at.x, at.y);
                depth = altitude - static_cast<double>(v.height);
            } else {
                // The position depends on the depth: a fixed-point iteration, which converges on slopes below
                // 1 / tan(pitch).
                depth = i > 0 ? points_[i - 1].down : 0;
                for (int step = 0; step < 5; ++step) {
                    const glm::dvec2 at = p.below(x(i), tiles_.clamped(p, depth));
                    v = tiles_.at(at.x, at.y);
                    depth = (altitude - static_cast<double>(v.height)) / p.cosine_pitch();
                }
            }
            const auto height = static_cast<double>(v.height);
            points_[i] = {depth, v.slope_x * across.x + v.slope_y * across.y, v.slope_x * along.x + v.slope_y * along.y,
                          static_cast<std::uint8_t>(v.type)};
            lowest_ = (std::min)(lowest_, height);  // in this order, NaN is ignored
            highest_ = (std::max)(highest_, height);
        }
    }

    std::size_t size() const { return points_.size(); }
    const bottom_point& operator[](std::size_t i) const { return points_[i]; }
    /// Distance across the track of a vertex.
    double x(std::size_t i) const { return step_ * static_cast<double>(first_ + i); }
    bool starts_at_nadir() const { return first_ == 0; }
    /// Heights; lowest() > highest() if there is no bottom.
    double lowest() const { return lowest_; }
    double highest() const { return highest_; }
    bool has_gaps() const {
        return std::any_of(points_.begin(), points_.end(), [](const bottom_point& p) { return p.down != p.down; });
    }

  private:
    const bottom_tiles& tiles_;
    double step_;
    std::size_t first_, end_;
    double lowest_ = 0, highest_ = 0;
    dynamic_array<bottom_point> points_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
