// The echo of one ping, bin by bin.
//
// Source and receiver coincide, so the first surface along a ray is both insonified and received. A ray's power is
// distributed evenly over the bins between the ranges at which its edges meet the surface: level ground has no gaps and
// no beats, whatever the ratio of rays to bins. Seabed that no ray meets is in shadow; its caster is what the rays met
// in front of it.
#pragma once

#include <insonify/seabed/any.hpp>
#include <insonify/sonar/labels.hpp>
#include <insonify/sonar/side_scan/detail/bottom_tiles.hpp>
#include <insonify/sonar/side_scan/detail/label_tally.hpp>
#include <insonify/sonar/side_scan/detail/ping_fan.hpp>
#include <insonify/sonar/side_scan/detail/target_hits.hpp>
#include <insonify/sonar/side_scan/recording.hpp>

#include <array>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Power and contents of a range bin; lengths are in bins.
struct echo_bin {
    float bottom = 0, target = 0;  ///< power
    float lit = 0;                 ///< length of seabed
    float dark_by_seabed = 0, dark_by_target = 0;
    float of_seabed = 0;  ///< length of the first type in the bin; a label_tally has the others
    // The labels that have most of the bin.
    std::uint16_t instance = labels::no_instance, caster = labels::by_seabed;
    std::uint8_t seabed = labels::no_seabed;
};

/// Traces pings one after the other, reusing memory and, where possible, the fan.
template <class Law, bool Labelled>
class ping_tracer {
  public:
    ping_tracer(const scene& s, const bottom_materials& materials, std::span<const sliced_target> targets,
                const bottom_tiles& bottom, const range_bins& window, const Law& law,
                const equation_interface& equation, double cell, const seabed::height_range& relief, double start)
        : scene_(s),
          materials_(materials),
          targets_(targets),
          tiles_(bottom),
          law_(law),
          equation_(equation),
          relief_(relief),
          range_(static_cast<double>(window.range)),
          first_range_(static_cast<double>(window.first_range)),
          bin_(window.bin()),
          step_((std::min)(bin_, cell)),
          profile_step_((std::max)(step_, 0.5 * cell)),
          first_point_(static_cast<std::size_t>(-numeric::floor_to_int(-start / profile_step_))),
          spacing_(window.ping_spacing),
          counts_time_(window.counts_time),
          bins_(static_cast<std::size_t>(window.bins)),
          echoing_(bins_.size()),
          casting_(bins_.size()),
          types_(bins_.size()) {
        for (const sliced_target& t : targets) {
            top_ = (std::max)(top_, t.top());
            foot_ = (std::min)(foot_, t.foot());
        }
    }

    /// @returns one per bin, valid until the next call
    std::span<const echo_bin> trace(const ping_frame& p) {
        std::fill(bins_.begin(), bins_.end(), echo_bin{});
        sample_bottom(p);
        const double altitude = p.position().z;
        if (skips_foreground(relief_, first_range_, p)) lowest_ = relief_.lowest, highest_ = relief_.highest;
        if (!(lowest_ <= highest_))  // no seabed here: rays for the targets alone
            lowest_ = highest_ = (std::min)(foot_, altitude - range_ / 16);
        // In a pitched fan depths are longer; level ones bound the heights above.
        const double stretch = 1 / p.cosine_pitch();
        const fan_shape shape = fan_shape::around((altitude - lowest_) * stretch, altitude - highest_,
                                                  altitude - (std::max)(top_, highest_));
        const std::array<double, 3> attitude{p.sine_roll(), p.cosine_roll(), p.cosine_pitch()};
        if (!(shape == fan_.shape()) || attitude != attitude_) build_fan(shape, attitude);
        if (!(altitude > lowest_) || profile_[0].down <= 0) return bins_;  // the sonar is below the seabed
        gather_targets(p);
        trace_bottom(p);
        if (has_targets_) add_target_echoes();
        if constexpr (Labelled) label_bins();
        return bins_;
    }

    /// Ground range up to which the bottom has to be sampled, metres.
    static double reach(const range_bins& window, double cell) { return static_cast<double>(window.range) + 4 * cell; }

    /// Ground range from which the bottom has to be sampled: nothing nearer is received in the window or occludes it.
    static double start(const range_bins& window, double cell, const seabed::height_range& relief, const ping_frame& p,
                        std::span<const sliced_target> targets) {
        const double altitude = p.position().z, first = static_cast<double>(window.first_range);
        if (!skips_foreground(relief, first, p)) return 0;
        const double lowest = altitude - relief.lowest, begin = first - 4 * window.bin();
        const double square = window.counts_time ? begin * begin - lowest * lowest : begin * begin;
        const double place = begin > 0 && square > 0 ? numeric::square_root(square) - 4 * cell : 0;
        for (const sliced_target& t : targets)
            if (t.is_met_by(p, 1e9) && t.nearest(p) < place) return 0;
        // The highest possible crest that occludes the lowest possible ground there.
        return (std::max)(0.0, place * (altitude - relief.highest) / lowest - 4 * cell);
    }

  private:
    static constexpr float widest = 2;  ///< bins to either side of its ray that an echo may cover, at any slope

    /// Whether a ping is so high above the bottom that the bottom in front of the window can be skipped.
    static bool skips_foreground(const seabed::height_range& relief, double first_range, const ping_frame& p) {
        const double altitude = p.position().z;
        return first_range > 0 && p.is_level() && !relief.empty() && relief.lowest > -altitude &&
               2 * relief.highest < altitude;
    }

    struct bottom_point {
        double down;  ///< below the sonar
        float slope, slope_along;
        std::uint8_t type;
    };
    /// Builds the fan, and the power per metre of range of each ray.
    void build_fan(const fan_shape& shape, const std::array<double, 3>& attitude) {
        const auto slant = [&](double r) {
            return counts_time_ ? r : numeric::square_root(r * r + shape.above_lowest * shape.above_lowest);
        };
        farthest_ = slant(range_);
        fan_ = ping_fan(shape, step_, slant(first_range_), farthest_);
        ray_power_.resize(fan_.size());
        attitude_ = attitude;
        const auto [sine_roll, cosine_roll, cosine_pitch] = attitude;
        // A pitched fan is thinner than the spacing of pings along the track.
        const float thickness = spacing_ * static_cast<float>(cosine_pitch);
        for (std::size_t k = 0; k < fan_.size(); ++k) {
            const double across = fan_[k].sine * cosine_roll + fan_[k].cosine * sine_roll,
                         down = fan_[k].cosine * cosine_roll - fan_[k].sine * sine_roll;
            ray_power_[k] = thickness * static_cast<float>(fan_[k].width * equation_.over_direction(across, down));
        }
    }

    /// Samples the profile below the ping, from first_point_ outwards.
    void sample_bottom(const ping_frame& p) {
        const auto end = static_cast<std::size_t>(numeric::floor_to_int(range_ / profile_step_)) + 2;
        profile_.resize(end - first_point_);
        lowest_ = 1e30, highest_ = -1e30;
        const glm::vec2 across(p.across()), along(p.along());
        const double altitude = p.position().z;
        for (std::size_t i = 0; i < profile_.size(); ++i) {
            bottom_vertex v;
            double depth;
            if (p.is_level()) {
                const glm::dvec2 at = p.world(x_of(i), 0);
                v = tiles_.at(at.x, at.y);
                depth = altitude - static_cast<double>(v.height);
            } else {
                // The position depends on the depth: a fixed-point iteration, which slopes below 1 / tan(pitch) let
                // converge.
                depth = i > 0 ? profile_[i - 1].down : 0;
                for (int step = 0; step < 5; ++step) {
                    const glm::dvec2 at = p.below(x_of(i), tiles_.clamped(p, depth));
                    v = tiles_.at(at.x, at.y);
                    depth = (altitude - static_cast<double>(v.height)) / p.cosine_pitch();
                }
            }
            const auto height = static_cast<double>(v.height);
            profile_[i] = {depth, v.slope_x * across.x + v.slope_y * across.y,
                           v.slope_x * along.x + v.slope_y * along.y, static_cast<std::uint8_t>(v.type)};
            lowest_ = (std::min)(height, lowest_);  // ignores NaN
            highest_ = (std::max)(height, highest_);
        }
    }

    /// Distance across the track of a point of the profile.
    double x_of(std::size_t i) const { return profile_step_ * static_cast<double>(first_point_ + i); }

    void gather_targets(const ping_frame& p) {
        has_targets_ = false;
        for (std::size_t i = 0; i < targets_.size(); ++i) {
            if (!targets_[i].is_met_by(p, farthest_)) continue;
            if (!has_targets_) hits_.begin(fan_);
            has_targets_ = true;
            targets_[i].cut(p, [&](const cut_segment& segment) {
                hits_.add(segment, static_cast<std::uint16_t>(i + 1), scene_.targets[i].surface.reflectivity);
            });
        }
        if (has_targets_) hits_.resolve();
    }

    /// Walks outwards along the profile. Rays meet it in order; bottom below the last ray that met it is in shadow.
    void trace_bottom(const ping_frame& ping) {
        double horizon_x = 0, horizon_down = 1;
        // Rays that meet the bottom in front of the profile go no further.
        std::size_t k = first_point_ > 0 ? fan_.first_over(x_of(0), profile_[0].down) : 0;
        if (has_targets_)
            for (std::size_t j = 0; j < k; ++j) hits_.cut_off(j, 0);
        const std::size_t rays = fan_.size();
        for (std::size_t i = 0; i + 1 < profile_.size(); ++i) {
            const double px = x_of(i), qx = x_of(i + 1);
            const bottom_point &p = profile_[i], &q = profile_[i + 1];
            const double dx = qx - px, ddown = q.down - p.down;
            const double above = qx * horizon_down - q.down * horizon_x;
            if (!(above > 0)) {
                if (Labelled && ddown == ddown) label(p, q, px, dx, 0, 1, caster_below_horizon(qx, q.down));
                continue;
            }
            // The part above the horizon. Labels divide it halfway between rays, as the rays' power does.
            const double below = px * horizon_down - p.down * horizon_x;
            double from = below / (below - above);
            if (Labelled && from > 0)
                label(p, q, px, dx, 0, from, caster_below_horizon(px + from * dx, p.down + from * ddown));
            double last_met = from;
            const std::size_t first = k;
            for (; k < rays && ping_fan::beyond(fan_[k], qx, q.down) >= 0; ++k) {
                const ping_fan::ray& ray = fan_[k];
                const double before = ping_fan::beyond(ray, px, p.down);
                const double f = before / (before - ping_fan::beyond(ray, qx, q.down));
                const double range = (px + f * dx) * ray.sine + (p.down + f * ddown) * ray.cosine;
                if (Labelled && has_targets_ && k > first) {
                    const double between = 0.5 * (last_met + f);
                    label(p, q, px, dx, from, between, occluder(k - 1, px + last_met * dx, p.down + last_met * ddown));
                    from = between;
                }
                last_met = f;
                if (range <= farthest_ + bin_)
                    add_bottom_echo(ping, ray, k, range, dx, ddown, p, q, static_cast<float>(f));
            }
            if constexpr (Labelled)
                label(p, q, px, dx, from, 1,
                      has_targets_ ? occluder(k > first ? k - 1 : k, px + last_met * dx, p.down + last_met * ddown)
                                   : labels::is_lit);
            horizon_x = qx, horizon_down = q.down;
        }
    }

    void add_bottom_echo(const ping_frame& ping, const ping_fan::ray& ray, std::size_t k, double range, double dx,
                         double ddown, const bottom_point& p, const bottom_point& q, float f) {
        // Removes targets that are buried or behind a rise.
        const double covered = has_targets_ ? hits_.cut_off(k, range) : 0;
        if (covered >= 1) return;
        const float at = column(ray, range), half = (std::min)(half_length(ray, range, dx, ddown), widest);
        const auto sine = static_cast<float>(ray.sine), cosine = static_cast<float>(ray.cosine);
        const float slope = p.slope + f * (q.slope - p.slope);
        const float slope_along = p.slope_along + f * (q.slope_along - p.slope_along);
        const auto upright = static_cast<float>(ping.cosine_pitch()), ahead = static_cast<float>(ping.sine_pitch());
        const float grazing_sine = (slope * sine + cosine * (upright + slope_along * ahead)) /
                                   numeric::square_root(1 + slope * slope + slope_along * slope_along);
        const float power = static_cast<float>(1 - covered) * power_of(k, range, grazing_sine) *
                            materials_[static_cast<std::size_t>(f < 0.5f ? p.type : q.type)].reflectivity;
        distribute(at - half, at + half,
                   [&](std::size_t bin, float fraction, float) { bins_[bin].bottom += power * fraction; });
    }

    void add_target_echoes() {
        hits_.for_each([&](std::size_t k, const target_hit& hit) {
            const double range = numeric::square_root(hit.square_range());
            const float power =
                static_cast<float>(hit.fraction) * power_of(k, range, hit.grazing_sine) * hit.reflectivity;
            const double a = column(hit.x0, hit.down0), b = column(hit.x1, hit.down1);
            distribute(static_cast<float>((std::min)(a, b)), static_cast<float>((std::max)(a, b)),
                       [&](std::size_t bin, float fraction, float) {
                           bins_[bin].target += power * fraction;
                           if constexpr (Labelled) echoing_.add(bin, hit.instance, power * fraction);
                       });
        });
    }

    /// Sets the labels that have most of each bin.
    void label_bins() {
        if (!types_.empty())
            for (std::size_t b = 0; b < bins_.size(); ++b) {
                const auto [type, length] = types_.largest(b, labels::no_seabed);
                if (length > bins_[b].of_seabed) bins_[b].seabed = static_cast<std::uint8_t>(type);
            }
        if (has_targets_)
            for (std::size_t b = 0; b < bins_.size(); ++b) {
                echo_bin& bin = bins_[b];
                bin.instance = echoing_.largest(b, labels::no_instance).label;
                const auto [caster, length] = casting_.largest(b, labels::by_seabed);
                bin.caster = length >= bin.dark_by_seabed ? caster : labels::by_seabed;
            }
        echoing_.clear(), casting_.clear(), types_.clear();
    }

    /// The target between the sonar and a point of ray k, or is_lit.
    std::uint16_t occluder(std::size_t k, double x, double down) const {
        return hits_.occluder(k, numeric::square_root(x * x + down * down));
    }
    /// The caster of a shadow below the horizon: a target, if one occludes the point, or the seabed.
    std::uint16_t caster_below_horizon(double x, double down) const {
        const std::uint16_t target = has_targets_ ? occluder(fan_.first_over(x, down), x, down) : labels::is_lit;
        return target == labels::is_lit ? labels::by_seabed : target;
    }

    /// Adds a piece of bottom to the labels: between two fractions of the way from p to q, with the caster of its
    /// shadow or is_lit.
    void label(const bottom_point& p, const bottom_point& q, double px, double dx, double from, double to,
               std::uint16_t caster) {
        const double down = q.down - p.down;
        const double a = column(px + from * dx, p.down + from * down), b = column(px + to * dx, p.down + to * down);
        const std::uint8_t type = from + to < 1 ? p.type : q.type;
        distribute(static_cast<float>((std::min)(a, b)), static_cast<float>((std::max)(a, b)),
                   [&](std::size_t number, float, float length) {
                       echo_bin& bin = bins_[number];
                       if (caster == labels::is_lit)
                           bin.lit += length;
                       else if (caster == labels::by_seabed)
                           bin.dark_by_seabed += length;
                       else
                           bin.dark_by_target += length, casting_.add(number, caster, length);
                       if (bin.seabed == labels::no_seabed) bin.seabed = type;
                       if (bin.seabed == type)
                           bin.of_seabed += length;
                       else
                           types_.add(number, type, length);
                   });
    }

    /// Calls `visit(bin, fraction, length)` for the bins between two positions.
    template <class Visit>
    void distribute(float low, float high, const Visit& visit) {
        const auto count = static_cast<float>(bins_.size());
        if (!(high > 0 && low < count)) return;
        const auto first = static_cast<std::int64_t>(low > 0 ? low : 0.0f);
        const auto last =
            (std::min)(static_cast<std::int64_t>((std::min)(high, count)), static_cast<std::int64_t>(bins_.size()) - 1);
        if (first == last && low >= static_cast<float>(first) && high <= static_cast<float>(first + 1)) {
            visit(static_cast<std::size_t>(first), 1.0f, high - low);
            return;
        }
        const float scale = 1 / (high - low);
        for (std::int64_t b = first; b <= last; ++b) {
            const float from = (std::max)(low, static_cast<float>(b)), to = (std::min)(high, static_cast<float>(b + 1));
            if (to > from) visit(static_cast<std::size_t>(b), (to - from) * scale, to - from);
        }
    }

    /// Position of an echo, in bins.
    float column(const ping_fan::ray& ray, double range) const {
        const double r = counts_time_ ? range : range * ray.sine;
        return static_cast<float>((r - first_range_) / bin_);
    }
    double column(double x, double down) const {
        const double r = counts_time_ ? numeric::square_root(x * x + down * down) : x;
        return (r - first_range_) / bin_;
    }

    /// Half the number of bins between the edges of a ray on a surface along (dx, ddown).
    float half_length(const ping_fan::ray& ray, double range, double dx, double ddown) const {
        const double outwards = counts_time_ ? dx * ray.sine + ddown * ray.cosine : dx;
        const double turning = dx * ray.cosine - ddown * ray.sine;
        const double half = 0.5 * range * ray.width * outwards / (turning * bin_);
        return static_cast<float>(numeric::abs(half));
    }

    /// Power that a surface of reflectivity 1 returns from a ray: the ray's cross-section over the sine of the grazing
    /// angle, times the law.
    float power_of(std::size_t k, double range, float grazing_sine) const {
        const float sine = (std::min)((std::max)(grazing_sine, 1e-3f), 1.0f);
        return static_cast<float>(range) * ray_power_[k] * law_(sine) / sine;
    }

    const scene& scene_;
    const bottom_materials& materials_;
    std::span<const sliced_target> targets_;
    const bottom_tiles& tiles_;
    Law law_;
    const equation_interface& equation_;
    seabed::height_range relief_;
    double range_, first_range_, bin_, step_, profile_step_, farthest_ = 0;
    std::size_t first_point_;
    float spacing_;
    bool counts_time_;
    double top_ = -1e30, foot_ = 1e30;         ///< of all targets
    double lowest_ = 0, highest_ = 0;          ///< of the bottom below the current ping
    std::array<double, 3> attitude_{0, 1, 1};  ///< sine and cosine of the roll, cosine of the pitch
    ping_fan fan_;
    std::vector<float> ray_power_;
    std::vector<bottom_point> profile_;
    target_hits hits_;
    bool has_targets_ = false;
    std::vector<echo_bin> bins_;
    label_tally echoing_, casting_, types_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
