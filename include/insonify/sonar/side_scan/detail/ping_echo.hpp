// The echo of one ping, bin by bin.
//
// The sonar is monostatic, so the first surface along a ray is both insonified and received. A ray's power is
// distributed evenly over the bins between the ranges at which its edges meet the surface; level ground then shows
// neither gaps nor moire between rays and bins. Seabed that no ray meets is in shadow; its caster is the surface that
// the rays met in front of it.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/linear.hpp>
#include <insonify/seabed/any.hpp>
#include <insonify/sonar/side_scan/detail/bottom_profile.hpp>
#include <insonify/sonar/side_scan/detail/echo_bins.hpp>
#include <insonify/sonar/side_scan/detail/ping_fan.hpp>
#include <insonify/sonar/side_scan/detail/range_axis.hpp>
#include <insonify/sonar/side_scan/detail/range_bins.hpp>
#include <insonify/sonar/side_scan/detail/target_hits.hpp>

#include <array>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Traces one ping after the other, reusing memory and, if the attitude is the same, the fan.
template <class Law, bool Labelled>
class ping_tracer {
  public:
    ping_tracer(const scene& s, const bottom_materials& materials, std::span<const sliced_target> targets,
                const bottom_tiles& bottom, const range_bins& window, const Law& law,
                const equation_interface& equation, double cell, const seabed::height_range& relief)
        : scene_(s),
          materials_(materials),
          targets_(targets),
          law_(law),
          equation_(equation),
          relief_(relief),
          window_(window),
          cell_(cell),
          range_(static_cast<double>(window.range)),
          axis_{static_cast<double>(window.first_range), window.bin, window.is_slant_range},
          step_((std::min)(axis_.bin, cell)),
          profile_(bottom, (std::max)(step_, 0.5 * cell), range_),
          bins_(static_cast<std::size_t>(window.bins)) {
        for (const sliced_target& t : targets) highest_target_ = (std::max)(highest_target_, t.highest());
    }

    /// @returns one per bin, valid until the next call
    std::span<const echo_bin> trace(const ping_frame& p) {
        bins_.clear();
        profile_.sample(p, start(window_, cell_, relief_, p, targets_));
        const double altitude = p.position().z;
        double lowest_target = 1e30;
        for (const sliced_target& t : targets_)
            if (meets(p, t)) lowest_target = (std::min)(lowest_target, t.lowest());
        double lowest = profile_.lowest(), highest = profile_.highest();
        if (skips_foreground(relief_, axis_.first, p)) lowest = relief_.lowest, highest = relief_.highest;
        if (!(lowest <= highest))  // no seabed here: rays for the targets alone
            lowest = highest = (std::min)(lowest_target, altitude - range_ / 16);
        // Through a gap, targets lower than the seabed are received in the window from rays closer to nadir.
        if (axis_.first > 0 && lowest_target < lowest && profile_.has_gaps()) lowest = lowest_target;
        // Depths along a pitched fan are longer by `stretch`. above_highest and above_all are lower bounds, for which
        // the vertical depths serve.
        const double stretch = 1 / p.cosine_pitch();
        const fan_shape shape = fan_shape::around((altitude - lowest) * stretch, altitude - highest,
                                                  altitude - (std::max)(highest_target_, highest));
        const std::array<double, 3> attitude{p.sine_roll(), p.cosine_roll(), p.cosine_pitch()};
        if (!(shape == fan_.shape()) || attitude != attitude_) build_fan(shape, attitude);
        if (!(altitude > lowest) || profile_[0].down <= 0) return bins_.all();  // the sonar is below the seabed
        gather_targets(p);
        trace_bottom(p);
        if (has_targets_) add_target_echoes();
        if constexpr (Labelled) bins_.label(has_targets_);
        return bins_.all();
    }

    /// Ground range up to which the bottom must be sampled, metres.
    static double reach(const range_bins& window, double cell) { return static_cast<double>(window.range) + 4 * cell; }

    /// Ground range from which the bottom must be sampled: nothing nearer is received in the window or occludes it.
    static double start(const range_bins& window, double cell, const seabed::height_range& relief, const ping_frame& p,
                        std::span<const sliced_target> targets) {
        const double altitude = p.position().z, first = static_cast<double>(window.first_range);
        if (!skips_foreground(relief, first, p)) return 0;
        const double deepest = altitude - relief.lowest, begin = first - 4 * window.bin;
        const double square = window.is_slant_range ? begin * begin - deepest * deepest : begin * begin;
        const double nearest = begin > 0 && square > 0 ? numeric::square_root(square) - 4 * cell : 0;
        // Targets that are nearer than the window's seabed, or all of whose echo comes through a gap.
        for (const sliced_target& t : targets)
            if (t.is_met_by(p, 1e9) && (t.nearest(p) < nearest || t.highest() < relief.lowest)) return 0;
        // The highest possible crest that occludes the lowest possible ground there.
        return (std::max)(0.0, nearest * (altitude - relief.highest) / deepest - 4 * cell);
    }

  private:
    static constexpr float max_half_length =
        2;  ///< bins that an echo of the bottom covers on either side of its ray at most

    /// Whether a ping is so high above the bottom that the bottom in front of the window can be skipped.
    static bool skips_foreground(const seabed::height_range& relief, double first_range, const ping_frame& p) {
        const double altitude = p.position().z;
        return first_range > 0 && p.is_level() && !relief.empty() && relief.lowest > -altitude &&
               2 * relief.highest < altitude;
    }

    /// Builds the fan, and the power per metre of range of each ray.
    void build_fan(const fan_shape& shape, const std::array<double, 3>& attitude) {
        farthest_ = window_.slant_range(range_, shape.above_lowest);
        fan_ = ping_fan(shape, step_, window_.slant_range(axis_.first, shape.above_lowest), farthest_);
        ray_power_.resize(fan_.size());
        attitude_ = attitude;
        const auto [sine_roll, cosine_roll, cosine_pitch] = attitude;
        // A pitched fan is thinner than the spacing of pings along the track.
        const float thickness = window_.ping_spacing * static_cast<float>(cosine_pitch);
        for (std::size_t k = 0; k < fan_.size(); ++k) {
            const double across = fan_[k].sine * cosine_roll + fan_[k].cosine * sine_roll,
                         down = fan_[k].cosine * cosine_roll - fan_[k].sine * sine_roll;
            const double factor = equation_.over_direction(across, down);
            insonify::detail::require_range("over_direction() of the sonar equation", factor, 0, 1e20, "0 to 10^20");
            ray_power_[k] = thickness * static_cast<float>(fan_[k].width * factor);
        }
    }

    /// Whether a target may echo within the range.
    bool meets(const ping_frame& p, const sliced_target& t) const {
        return t.is_met_by(p, axis_.is_slant_range ? range_ : 1e30) && t.nearest(p) < range_;
    }

    void gather_targets(const ping_frame& p) {
        has_targets_ = false;
        for (std::size_t i = 0; i < targets_.size(); ++i) {
            if (!meets(p, targets_[i])) continue;
            if (!has_targets_) hits_.begin(fan_);
            has_targets_ = true;
            targets_[i].cut(p, [&](const cut_segment& segment) {
                hits_.add(segment, static_cast<std::uint16_t>(i + 1), scene_.targets[i].surface.reflectivity);
            });
        }
        if (has_targets_) hits_.resolve();
    }

    /// The bottom between two vertices of the profile.
    struct facet {
        const bottom_point &p, &q;
        double x, dx, ddown;  ///< metres: start across the track, width, increase in depth
        double begin, end;    ///< positions on the range axis, if labelled

        /// A point at a fraction of the way from p to q: across and down.
        glm::dvec2 at(double f) const { return {x + f * dx, p.down + f * ddown}; }
    };

    /// Walks the profile outwards; rays meet it in order. Bottom below the line of sight over the outermost lit vertex
    /// (the horizon) is in shadow.
    void trace_bottom(const ping_frame& ping) {
        double horizon_x = 0, horizon_down = 1;
        // Rays that meet the bottom in front of the profile's first vertex end there.
        std::size_t k = profile_.starts_at_nadir() ? 0 : fan_.first_over(profile_.x(0), profile_[0].down);
        if (has_targets_)
            for (std::size_t j = 0; j < k; ++j) hits_.cut_off(j, 0);
        const std::size_t rays = fan_.size();
        const auto position = [&](std::size_t i) {
            return Labelled ? axis_.position(profile_.x(i), profile_[i].down) : 0;
        };
        double next_begin = position(0);
        for (std::size_t i = 0; i + 1 < profile_.size(); ++i) {
            const double px = profile_.x(i), qx = profile_.x(i + 1);
            const bottom_point &p = profile_[i], &q = profile_[i + 1];
            const facet part{p, q, px, qx - px, q.down - p.down, next_begin, position(i + 1)};
            next_begin = part.end;
            const bool is_gap = part.ddown != part.ddown;  // rays pass through, and nothing is labelled
            const double above = qx * horizon_down - q.down * horizon_x;
            if (!(above > 0)) {
                if (Labelled && !is_gap) label(part, 0, 1, caster_below_horizon({qx, q.down}));
                continue;
            }
            // The part above the horizon. Labels divide it halfway between rays, as the rays' power does.
            const double below = px * horizon_down - p.down * horizon_x;
            // below > 0 only at the first facet of a profile that does not start at nadir.
            double from = below > 0 ? 0 : below / (below - above);
            if (Labelled && from > 0) label(part, 0, from, caster_below_horizon(part.at(from)));
            double last_met = from;
            const std::size_t first = k;
            for (; k < rays && ping_fan::beyond(fan_[k], qx, q.down) >= 0; ++k) {
                const ping_fan::ray& ray = fan_[k];
                const double before = ping_fan::beyond(ray, px, p.down);
                const double f = before / (before - ping_fan::beyond(ray, qx, q.down));
                const glm::dvec2 met = part.at(f);
                const double range = met.x * ray.sine + met.y * ray.cosine;
                if (Labelled && has_targets_ && !is_gap && k > first) {
                    const double between = 0.5 * (last_met + f);
                    label(part, from, between, occluder(k - 1, part.at(last_met)));
                    from = between;
                }
                last_met = f;
                if (range <= farthest_ + axis_.bin) add_bottom_echo(ping, k, range, part, static_cast<float>(f));
            }
            if (Labelled && !is_gap)
                label(part, from, 1,
                      has_targets_ ? occluder(k > first ? k - 1 : k, part.at(last_met)) : labels::no_shadow);
            horizon_x = qx, horizon_down = q.down;
        }
    }

    /// @param f  fraction of the way along the facet at which the ray meets it
    INSONIFY_INLINE void add_bottom_echo(const ping_frame& ping, std::size_t k, double range, const facet& part,
                                         float f) {
        // Removes targets that are buried or behind a rise.
        const double covered = has_targets_ ? hits_.cut_off(k, range) : 0;
        if (covered >= 1) return;
        const ping_fan::ray& ray = fan_[k];
        const bottom_point &p = part.p, &q = part.q;
        const float at = axis_.position(ray, range),
                    half = (std::min)(axis_.half_length(ray, range, part.dx, part.ddown), max_half_length);
        const auto sine = static_cast<float>(ray.sine), cosine = static_cast<float>(ray.cosine);
        const float slope = p.slope + f * (q.slope - p.slope);
        const float slope_along = p.slope_along + f * (q.slope_along - p.slope_along);
        const auto upright = static_cast<float>(ping.cosine_pitch()), ahead = static_cast<float>(ping.sine_pitch());
        const float grazing_sine = (slope * sine + cosine * (upright + slope_along * ahead)) /
                                   numeric::square_root(1 + slope * slope + slope_along * slope_along);
        const float power = static_cast<float>(1 - covered) * power_of(k, range, grazing_sine) *
                            materials_[static_cast<std::size_t>(f < 0.5f ? p.type : q.type)].reflectivity;
        extent echo{at - half, at + half};
        // Range changes by less than a bin per radian: the ray is close to the facet's normal.
        if (2 * half < static_cast<float>(ray.width)) echo = perpendicular_echo(k, at, part);
        distribute(bins_.size(), echo.low, echo.high,
                   [&](std::size_t bin, float fraction, float) { bins_[bin].bottom += power * fraction; });
    }

    struct extent {
        float low, high;  ///< positions on the range axis
    };
    /// The echo of a ray at right angles to a facet, whose edges may lie on either side of the facet's nearest point.
    /// `half_length`, of first order in the ray's width, does not hold there.
    INSONIFY_RARE extent perpendicular_echo(std::size_t k, float middle, const facet& part) const {
        const auto at_edge = [&](std::size_t edge) {
            const numeric::sine_cosine d = fan_.at(static_cast<double>(fan_.first() + edge));
            const glm::dvec2 met =
                part.at((part.x * d.cosine - part.p.down * d.sine) / (part.ddown * d.sine - part.dx * d.cosine));
            return static_cast<float>(axis_.position(met.x, met.y));
        };
        const float a = at_edge(k), b = at_edge(k + 1);
        return {(std::min)({middle, a, b}), (std::max)({middle, a, b})};
    }

    void add_target_echoes() {
        hits_.for_each([&](std::size_t k, const target_hit& hit) {
            const double range = numeric::square_root(hit.square_range());
            const float power =
                static_cast<float>(hit.fraction) * power_of(k, range, hit.grazing_sine) * hit.reflectivity;
            const double a = axis_.position(hit.x0, hit.down0), b = axis_.position(hit.x1, hit.down1);
            distribute(bins_.size(), static_cast<float>((std::min)(a, b)), static_cast<float>((std::max)(a, b)),
                       [&](std::size_t bin, float fraction, float) {
                           bins_[bin].target += power * fraction;
                           if constexpr (Labelled) bins_.add_instance(bin, hit.instance, power * fraction);
                       });
        });
    }

    /// The target between the sonar and a point of ray k, or no_shadow.
    std::uint16_t occluder(std::size_t k, const glm::dvec2& p) const { return hits_.occluder(k, numeric::length(p)); }
    /// The caster of a shadow below the horizon: a target, if one occludes the point, or the seabed.
    std::uint16_t caster_below_horizon(const glm::dvec2& p) const {
        const std::uint16_t target = has_targets_ ? occluder(fan_.first_over(p.x, p.y), p) : labels::no_shadow;
        return target == labels::no_shadow ? labels::by_seabed : target;
    }

    /// Adds a piece of bottom to the labels: between two fractions of the way along a facet, with the caster of its
    /// shadow or no_shadow. Each half of a facet has the type of its vertex.
    void label(const facet& part, double from, double to, std::uint16_t caster) {
        if (part.p.type == part.q.type) return label(part, from, to, caster, part.p.type);
        if (from < 0.5) label(part, from, (std::min)(to, 0.5), caster, part.p.type);
        if (to > 0.5) label(part, (std::max)(from, 0.5), to, caster, part.q.type);
    }
    void label(const facet& part, double from, double to, std::uint16_t caster, std::uint8_t type) {
        const auto position = [&](double f) {
            const glm::dvec2 at = part.at(f);
            return axis_.position(at.x, at.y);
        };
        const double a = from > 0 ? position(from) : part.begin, b = to < 1 ? position(to) : part.end;
        distribute(bins_.size(), static_cast<float>((std::min)(a, b)), static_cast<float>((std::max)(a, b)),
                   [&](std::size_t bin, float, float length) { bins_.add_seabed(bin, type, caster, length); });
    }

    /// Power that a surface of reflectivity 1 returns from a ray: the ray's cross-section over the sine of the grazing
    /// angle, times the law.
    float power_of(std::size_t k, double range, float grazing_sine) const {
        const float sine = (std::min)((std::max)(grazing_sine, min_grazing_sine), 1.0f);
        return static_cast<float>(range) * ray_power_[k] * static_cast<float>(law_(sine)) / sine;
    }

    const scene& scene_;
    const bottom_materials& materials_;
    std::span<const sliced_target> targets_;
    Law law_;
    const equation_interface& equation_;
    seabed::height_range relief_;
    range_bins window_;
    double cell_;
    double range_, farthest_ = 0;  ///< end of the last bin: on the range axis, and as a slant range; metres
    range_axis axis_;
    double step_;
    bottom_profile profile_;
    double highest_target_ = -1e30;            ///< of all targets
    std::array<double, 3> attitude_{0, 1, 1};  ///< sine and cosine of the roll, cosine of the pitch
    ping_fan fan_;
    dynamic_array<float> ray_power_;
    target_hits hits_;
    bool has_targets_ = false;
    echo_bins bins_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
