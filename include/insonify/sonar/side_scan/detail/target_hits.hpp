// First hits of a ping's rays with the targets, and the fraction of each ray's width that they cover: exact for up to
// max_parts segments per ray that do not cross each other, sampled for more. Segments that cross within a part, as
// those of interpenetrating targets, count as whole: the one nearer at the part's middle.
//
// The cross-section of the targets with a ping's plane is a set of line segments. Their ends divide each ray's width
// into parts; in each part the nearest segment is hit, weighted by the part's fraction of the width. A bar
// thinner than the spacing of rays therefore returns its energy in every ping that meets it.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/linear.hpp>
#include <insonify/sonar/labels.hpp>
#include <insonify/sonar/side_scan/detail/ping_fan.hpp>
#include <insonify/sonar/side_scan/detail/target_slices.hpp>

#include <algorithm>
#include <limits>
#include <span>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// The part of a ray that hits a target.
struct target_hit {
    double fraction;              ///< of the ray's width
    double x, down;               ///< of its middle, metres
    double x0, down0, x1, down1;  ///< of its ends
    float grazing_sine;           ///< sine of the grazing angle on the surface
    float reflectivity;
    std::uint16_t instance;

    double square_range() const { return x * x + down * down; }
};

class target_hits {
  public:
    void begin(const ping_fan& fan) {
        fan_ = &fan;
        segments_.clear();
        partial_.clear();
        hits_.clear();
        nearest_.assign(fan.size(), {std::numeric_limits<double>::infinity(), 0});
        first_.assign(fan.size() + 1, 0);
        occluders_.assign(fan.size(), {std::numeric_limits<double>::infinity(), 0});
    }

    /// Adds a segment of a target.
    void add(cut_segment o, std::uint16_t instance, float reflectivity) {
        if (o.a.x * o.b.down > o.a.down * o.b.x) std::swap(o.a, o.b);  // b is farther out
        if (!(o.a.x > 0 || o.b.x > 0)) return;
        cut_at_vertical(o.a, o.b);
        cut_at_vertical(o.b, o.a);
        if (fan_->size() == 0) return;
        const double from = fan_->coordinate(o.a.x, o.a.down), to = fan_->coordinate(o.b.x, o.b.down);
        if (!(from < to)) return;
        const auto id = static_cast<std::uint32_t>(segments_.size());
        segments_.push_back({o, instance, reflectivity});
        const std::size_t first = static_cast<std::size_t>(from) - fan_->first();
        const std::size_t last = (std::min)(static_cast<std::size_t>(to) - fan_->first(), fan_->size() - 1);
        for (std::size_t k = first; k <= last; ++k) {
            const double low = (std::max)(from, ray_start(k)), high = (std::min)(to, ray_start(k) + 1);
            if (!(low < high)) continue;
            if (high - low < 1) {
                partial_.push_back({static_cast<std::uint32_t>(k), id, low, high});
                continue;
            }
            const ping_fan::ray& ray = (*fan_)[k];
            const glm::dvec2 p = point(o, {ray.sine, ray.cosine});
            const double range = numeric::dot(p, p);
            if (range < nearest_[k].range) nearest_[k] = {range, id};
        }
    }

    /// Finds the hits, after all segments have been added.
    void resolve() {
        std::sort(partial_.begin(), partial_.end(),
                  [](const part& a, const part& b) { return a.ray != b.ray ? a.ray < b.ray : a.segment < b.segment; });
        // Pointers: a span of two iterators is beyond older libraries.
        const part *next = partial_.data(), *const last = next + partial_.size();
        for (std::size_t k = 0; k < fan_->size(); ++k) {
            first_[k] = static_cast<std::uint32_t>(hits_.size());
            const part* end = next;
            while (end != last && end->ray == k) ++end;
            const bool is_met = nearest_[k].range < std::numeric_limits<double>::infinity();
            if (next != end)
                divide(k, {next, end}, is_met);
            else if (is_met)
                add_hit(nearest_[k].segment, ray_start(k), ray_start(k) + 1);
            next = end;
            find_occluder(k, hits_.size());
        }
        first_.back() = static_cast<std::uint32_t>(hits_.size());
    }

    /// Removes hits behind the bottom, which ray k meets at a range.
    /// @returns the fraction of the ray that hits targets in front of it
    double cut_off(std::size_t k, double range) {
        double covered = 0;
        bool is_cut = false;
        for (std::size_t i = first_[k]; i < first_[k + 1]; ++i)
            if (hits_[i].square_range() < range * range)
                covered += hits_[i].fraction;
            else if (hits_[i].fraction > 0)
                hits_[i].fraction = 0, is_cut = true;
        if (is_cut) find_occluder(k, first_[k + 1]);
        return covered > 1 - 1e-9 ? 1 : covered;
    }

    /// The target that most of ray k hits, if more than half of the ray hits targets and its nearest hit is in front of
    /// `range`; else no_shadow.
    std::uint16_t occluder(std::size_t k, double range) const {
        return k < occluders_.size() && occluders_[k].range < range ? occluders_[k].instance : labels::no_shadow;
    }

    /// Calls `visit(ray, hit)` in the order of the rays.
    template <class Visit>
    void for_each(const Visit& visit) const {
        for (std::size_t k = 0; k + 1 < first_.size(); ++k)
            for (std::size_t i = first_[k]; i < first_[k + 1]; ++i)
                if (hits_[i].fraction > 0) visit(k, hits_[i]);
    }

  private:
    struct segment {
        cut_segment shape;
        std::uint16_t instance;
        float reflectivity;
    };
    struct part {
        std::uint32_t ray, segment;
        double low, high;  ///< coordinates of the fan
    };
    struct candidate {
        double range;  ///< squared
        std::uint32_t segment;
    };
    struct occluder_of_ray {
        double range;
        std::uint16_t instance;
    };

    /// The coordinate at which ray k begins.
    double ray_start(std::size_t k) const { return static_cast<double>(fan_->first() + k); }

    /// Clips a segment's end on the other side of the track to the vertical through the sonar: the first end below the
    /// sonar, the second above it.
    static void cut_at_vertical(cut_segment::end& from, const cut_segment::end& to) {
        if (from.x > 0) return;
        const double f = from.x / (from.x - to.x);
        from = {0, from.down + f * (to.down - from.down),
                from.normal + static_cast<float>(f) * (to.normal - from.normal)};
    }

    /// The fraction of a segment at which a direction meets it, in [0, 1].
    static double along(const cut_segment& o, const numeric::sine_cosine& d) {
        const double before = o.a.x * d.cosine - o.a.down * d.sine, after = o.b.x * d.cosine - o.b.down * d.sine;
        const double f = before / (before - after);
        return f > 0 ? (f < 1 ? f : 1.0) : 0.0;
    }
    static glm::dvec2 point(const cut_segment& o, const numeric::sine_cosine& d) {
        const double f = along(o, d);
        return {o.a.x + f * (o.b.x - o.a.x), o.a.down + f * (o.b.down - o.a.down)};
    }

    /// Adds the hit of a part of a ray on a segment.
    void add_hit(std::uint32_t id, double low, double high) {
        const segment& p = segments_[id];
        const cut_segment& o = p.shape;
        const numeric::sine_cosine middle = fan_->at(0.5 * (low + high));
        const double f = along(o, middle);
        const glm::dvec2 at(o.a.x + f * (o.b.x - o.a.x), o.a.down + f * (o.b.down - o.a.down));
        const glm::dvec2 from = point(o, fan_->at(low)), to = point(o, fan_->at(high));
        if (!(numeric::dot(at, at) > 0)) return;
        hits_.push_back({high - low, at.x, at.y, from.x, from.y, to.x, to.y,
                         grazing_sine(o, static_cast<float>(f), middle), p.reflectivity, p.instance});
    }

    /// Sine of the grazing angle. The facet decides which side is insonified, and the sign of the normal; it replaces
    /// normals that are zero or not finite.
    static float grazing_sine(const cut_segment& o, float f, const numeric::sine_cosine& d) {
        const auto sine = static_cast<float>(d.sine), cosine = static_cast<float>(d.cosine);
        glm::vec3 n = o.a.normal + f * (o.b.normal - o.a.normal);
        float square = numeric::dot(n, n);
        if (!(square > 0 && numeric::is_finite(square))) n = o.facet, square = numeric::dot(n, n);
        const bool is_front = o.facet.z * cosine - o.facet.x * sine > 0, is_along = numeric::dot(n, o.facet) > 0;
        if (!(square > 0)) return 0;
        return (is_front == is_along ? 1.0f : -1.0f) * (n.z * cosine - n.x * sine) / numeric::square_root(square);
    }

    /// Divides a ray between segments that cover parts of its width and the nearest one that covers all of it.
    void divide(std::size_t k, std::span<const part> parts, bool is_met) {
        // Above max_parts segments, the ray is sampled at fixed positions.
        ends_.clear();
        ends_.push_back(ray_start(k)), ends_.push_back(ray_start(k) + 1);
        if (parts.size() <= max_parts)
            for (const part& p : parts) ends_.push_back(p.low), ends_.push_back(p.high);
        else
            for (std::size_t i = 1; i < max_parts; ++i)
                ends_.push_back(ray_start(k) + static_cast<double>(i) / static_cast<double>(max_parts));
        std::sort(ends_.begin(), ends_.end());
        for (std::size_t i = 0; i + 1 < ends_.size(); ++i) {
            if (!(ends_[i] < ends_[i + 1])) continue;
            const double middle = 0.5 * (ends_[i] + ends_[i + 1]);
            const numeric::sine_cosine d = fan_->at(middle);
            candidate best{std::numeric_limits<double>::infinity(), 0};
            const auto offer = [&](std::uint32_t id) {
                const glm::dvec2 p = point(segments_[id].shape, d);
                const double range = numeric::dot(p, p);
                if (range < best.range) best = {range, id};
            };
            for (const part& p : parts)
                if (p.low <= middle && middle <= p.high) offer(p.segment);
            if (is_met) offer(nearest_[k].segment);
            if (best.range < std::numeric_limits<double>::infinity()) add_hit(best.segment, ends_[i], ends_[i + 1]);
        }
    }

    void find_occluder(std::size_t k, std::size_t end) {
        occluders_[k] = {std::numeric_limits<double>::infinity(), 0};
        double covered = 0, largest = 0;
        for (std::size_t i = first_[k]; i < end; ++i) {
            covered += hits_[i].fraction;
            double of_target = 0, nearest = hits_[i].square_range();
            for (std::size_t j = i; j < end; ++j) {
                if (hits_[j].instance != hits_[i].instance || !(hits_[j].fraction > 0)) continue;
                of_target += hits_[j].fraction;
                nearest = (std::min)(nearest, hits_[j].square_range());
            }
            if (of_target <= largest) continue;
            largest = of_target;
            occluders_[k] = {numeric::square_root(nearest), hits_[i].instance};
        }
        if (!(covered > 0.5)) occluders_[k].range = std::numeric_limits<double>::infinity();
    }

    static constexpr std::size_t max_parts = 64;

    const ping_fan* fan_ = nullptr;
    dynamic_array<segment> segments_;
    dynamic_array<part> partial_;
    dynamic_array<candidate> nearest_;  ///< by ray: the nearest segment that covers all of its width
    dynamic_array<target_hit> hits_;
    dynamic_array<std::uint32_t> first_;  ///< by ray: index of its first hit
    dynamic_array<occluder_of_ray> occluders_;
    dynamic_array<double> ends_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
