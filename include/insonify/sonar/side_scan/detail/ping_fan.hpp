// The rays of a ping, in the plane across the track, from nadir outwards.
//
// Rays that meet level ground within the range are equally spaced on it. Those farther out, up to the zenith, meet
// objects above it and are equally spaced in angle: at most a bin apart on a vertical wall at the largest range.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/numeric.hpp>

#include <algorithm>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Parameters of a fan. Heights are rounded so that few different fans serve a whole track.
struct fan_shape {
    double above_lowest = 1;   ///< metres above the lowest seabed; no rays if not above 0
    double above_highest = 1;  ///< metres above the highest seabed
    double above_all = 1;      ///< metres above seabed and targets; rays up to the zenith if not above 0

    friend bool operator==(const fan_shape&, const fan_shape&) = default;

    static fan_shape around(double lowest, double highest, double top) {
        return {rounded(lowest, true), rounded(highest, false), rounded(top, false)};
    }

  private:
    /// To an eighth of a power of two.
    static double rounded(double length, bool up) {
        if (!(length > 1e-3)) return up && length > 0 ? 1e-3 : 0;
        double unit = 0x1p-12;
        while (unit * 16 <= length) unit *= 2;
        const std::int64_t units = up ? -numeric::floor_to_int(-length / unit) : numeric::floor_to_int(length / unit);
        return static_cast<double>(units) * unit;
    }
};

class ping_fan {
  public:
    struct ray {
        double sine, cosine;  ///< across and down
        double width;         ///< radians
    };

    ping_fan() = default;

    /// @param step                metres between adjacent rays: on level ground, and on a wall at the largest range
    /// @param first_range, range  slant ranges, metres; nearer and farther surfaces need no rays
    ping_fan(const fan_shape& shape, double step, double first_range, double range) : shape_(shape) {
        const double low = shape.above_lowest;
        if (!(low > 0)) return;
        // Tangents from nadir: where level ground is at a slant range.
        const auto tangent_at = [](double r, double height) {
            return r > height ? numeric::square_root(r * r - height * height) / height : 0;
        };
        const double spacing = step / low;
        // Ground above the lowest needs rays farther out to be met up to the largest range. They end at those that meet
        // ground a sixteenth as deep as the lowest.
        const double flattest = (std::max)(1.0, 16 * range / low);
        const double end =
            shape.above_highest > 0 ? (std::min)(tangent_at(range, shape.above_highest), flattest) : flattest;
        const std::int64_t first = numeric::floor_to_int(tangent_at(first_range, low) / spacing);
        const std::int64_t last = numeric::floor_to_int(end / spacing) + 1;
        require(last - first < (1 << 25), "rays of a ping", last - first, "below 2^25; use wider bins or larger cells");
        rays_.reserve(static_cast<std::size_t>(last - first));
        for (std::int64_t i = first; i < last; ++i) {
            const double tangent = (static_cast<double>(i) + 0.5) * spacing;
            const double cosine = 1 / numeric::square_root(1 + tangent * tangent);
            rays_.push_back({tangent * cosine, cosine, spacing * cosine * cosine});
        }
        spacing_ = spacing, first_ = static_cast<double>(first), wall_first_ = static_cast<double>(last);
        const double from = numeric::atan2(static_cast<double>(last) * spacing, 1);
        const double up_to = shape.above_all > 0 ? numeric::atan2(range, shape.above_all) : numeric::pi;
        const double angle = step / range;
        wall_from_ = from, wall_angle_ = angle;
        require((up_to - from) / angle < 0x1p25, "rays of a ping above the ground", (up_to - from) / angle,
                "below 2^25; use wider bins or larger cells");
        for (std::int64_t i = 0; from + angle * static_cast<double>(i) < up_to; ++i) {
            const auto [sine, cosine] = numeric::sin_cos(from + angle * (static_cast<double>(i) + 0.5));
            rays_.push_back({sine, cosine, angle});
        }
    }

    const fan_shape& shape() const { return shape_; }
    std::size_t size() const { return rays_.size(); }
    const ray& operator[](std::size_t i) const { return rays_[i]; }

    /// Positive for points farther out than a ray: the sine of the angle between them times the point's distance.
    static double beyond(const ray& r, double x, double down) { return x * r.cosine - down * r.sine; }

    /// Index of the first ray that passes through a point or farther out.
    std::size_t first_over(double x, double down) const {
        const auto at =
            std::partition_point(rays_.begin(), rays_.end(), [&](const ray& r) { return beyond(r, x, down) > 0; });
        return static_cast<std::size_t>(at - rays_.begin());
    }

    /// Number of the first ray. Numbers count from nadir, also in fans that begin farther out.
    std::size_t first() const { return static_cast<std::size_t>(first_); }
    /// Position of a point among the rays: ray i covers [first() + i, first() + i + 1). Clamped to the fan.
    double coordinate(double x, double down) const {
        double t = down > 0 ? x / down / spacing_ : wall_first_;
        if (t >= wall_first_) t = wall_first_ + (numeric::atan2(x, down) - wall_from_) / wall_angle_;
        return (std::min)((std::max)(t, first_), first_ + static_cast<double>(size()));
    }
    /// The inverse of `coordinate`: across and down.
    numeric::sine_cosine at(double t) const {
        if (t >= wall_first_) return numeric::sin_cos(wall_from_ + wall_angle_ * (t - wall_first_));
        const double tangent = t * spacing_;
        const double cosine = 1 / numeric::square_root(1 + tangent * tangent);
        return {tangent * cosine, cosine};
    }

  private:
    fan_shape shape_{0, 0, 0};
    dynamic_array<ray> rays_;
    double spacing_ = 1, first_ = 0;                          ///< on level ground: step of the tangent, first number
    double wall_first_ = 0, wall_from_ = 0, wall_angle_ = 1;  ///< beyond: first number, first angle, step
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
