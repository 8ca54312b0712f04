// The bottom below a ping, at equal distances across the track: depths in the plane of its fan, and the seabed's slopes
// across and along the track.
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
    double down;               ///< metres below the sonar, in the plane of the fan; NaN without seabed
    float slope, slope_along;  ///< rise per metre, across and along the track
    std::uint8_t type;         ///< a seabed::type
};

/// Samples the profile of one ping after the other, reusing memory.
class bottom_profile {
  public:
    /// @param step   metres between vertices, at least those between the fan's rays on the ground
    /// @param range  ground range of the last bin's end; the profile extends up to two steps further, so that a ray at
    ///               the end still meets a facet
    bottom_profile(const bottom_tiles& tiles, double step, double range)
        : tiles_(tiles), step_(step), end_(static_cast<std::size_t>(numeric::floor_to_int(range / step)) + 3) {}

    /// @param start  lower bound of the first vertex's distance across the track
    void sample(const ping_frame& p, double start) {
        first_ = static_cast<std::size_t>(-numeric::floor_to_int(-start / step_));
        points_.resize(end_ - first_);
        lowest_ = 1e30, highest_ = -1e30;
        const glm::vec2 across(p.across()), along(p.along());
        const double altitude = p.position().z;
        const bottom_tiles::depth_range depths = tiles_.depths(p);
        double last_down = level_of_sonar(depths);  // the last depth that is not NaN
        for (std::size_t i = 0; i < points_.size(); ++i) {
            cut at;
            if (p.is_level()) {
                const glm::dvec2 below = p.world(x(i), 0);
                at.vertex = tiles_.at(below.x, below.y);
                at.down = altitude - static_cast<double>(at.vertex.height);
            } else {
                at = cut_near(p, x(i), last_down, depths);
                if (at.down == at.down) last_down = at.down;
            }
            const bottom_vertex& v = at.vertex;
            const auto height = static_cast<double>(v.height);
            points_[i] = {at.down, v.slope_x * across.x + v.slope_y * across.y,
                          v.slope_x * along.x + v.slope_y * along.y, static_cast<std::uint8_t>(v.type)};
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
    /// Where the plane of a pitched fan cuts the seabed, at a distance across the track.
    struct cut {
        double down;
        bottom_vertex vertex;
    };

    /// The depth 0, or the nearest one in a range.
    static double level_of_sonar(const bottom_tiles::depth_range& depths) {
        return (std::max)(depths.shallowest, (std::min)(depths.deepest, 0.0));
    }

    /// The seabed vertically below or above the fan's point (x, down), and the depth in the fan's plane at which its
    /// height lies.
    cut seabed_at(const ping_frame& p, double x, double down) const {
        const glm::dvec2 at = p.below(x, down);
        const bottom_vertex v = tiles_.at(at.x, at.y);
        return {(p.position().z - static_cast<double>(v.height)) / p.cosine_pitch(), v};
    }

    /// The cut near a depth. The seabed's position depends on the depth: a fixed-point iteration, which converges on
    /// slopes below 1 / tan(pitch); where it does not, and beside gaps, a search.
    cut cut_near(const ping_frame& p, double x, double down, const bottom_tiles::depth_range& depths) const {
        const double tolerance = 1e-4 * step_;
        double last_error = std::numeric_limits<double>::infinity();
        while (true) {
            down = (std::max)(depths.shallowest, down);  // rounding may leave the range
            const cut found = seabed_at(p, x, down);
            const double error = numeric::abs(found.down - down);
            if (error <= tolerance) return found;
            if (!(error < 0.7 * last_error)) return first_cut(p, x, depths);
            down = found.down, last_error = error;
        }
    }

    /// The first cut, from above: from the sonar's level, so that a cliff behind the sonar is not met, or from the
    /// shallowest depth where the seabed is higher than the sonar.
    cut first_cut(const ping_frame& p, double x, const bottom_tiles::depth_range& depths) const {
        constexpr int halvings = 20;
        double above = level_of_sonar(depths);
        if (seabed_at(p, x, above).down <= above) above = depths.shallowest;
        const double first = above, range = depths.deepest - first;
        const std::int64_t steps = numeric::floor_to_int(range * numeric::abs(p.sine_pitch()) / step_) + 1;
        bool is_above = true;
        for (std::int64_t i = 0; i <= steps; ++i) {
            const double at = first + range * static_cast<double>(i) / static_cast<double>(steps);
            const double met = seabed_at(p, x, at).down;
            if (is_above && met <= at) {
                double below = at;
                for (int halving = 0; halving < halvings; ++halving) {
                    const double middle = 0.5 * (above + below);
                    (seabed_at(p, x, middle).down > middle ? above : below) = middle;
                }
                return {below, seabed_at(p, x, below).vertex};
            }
            is_above = met > at, above = at;
        }
        return {std::numeric_limits<double>::quiet_NaN(), {std::numeric_limits<float>::quiet_NaN(), 0, 0, 0}};
    }

    const bottom_tiles& tiles_;
    double step_;
    std::size_t first_ = 0, end_;
    double lowest_ = 0, highest_ = 0;
    dynamic_array<bottom_point> points_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
