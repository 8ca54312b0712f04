// What comes back of one ping, bin by bin.
//
// The source is where the receiver is: what a ray meets first is what it insonifies and what it hears. Each ray's
// power is spread evenly over the bins between the ranges at which its upper and its lower edge meet the surface; so
// level ground has no gaps and no beats, whatever the ratio of rays to bins. Bottom that is met by no ray is in shadow,
// and belongs to whatever stands in front of it.
#pragma once

#include <insonify/seabed/any.hpp>
#include <insonify/sonar/bottom_tiles.hpp>
#include <insonify/sonar/labels.hpp>
#include <insonify/sonar/ping_fan.hpp>
#include <insonify/sonar/target_slices.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI::detail {

/// What a bin hears, and what lies in it; lengths are in bins.
struct echo_bin {
    float bottom = 0, target = 0;  ///< power
    float lit = 0;                 ///< of the bottom
    float dark_by_seabed = 0, dark_by_target = 0;
    float most_bottom = 0, most_target = 0;  ///< the largest single contributions: what named the bin
    std::uint16_t instance = labels::no_instance, caster = labels::is_lit;
    std::uint8_t seabed = labels::no_seabed;
};

/// Hears pings, one after the other. Rig is a side_scan or a ground_range; what labels need is left out if !Labelled.
template <class Rig, class Law, class Equation, bool Labelled>
class ping_listener {
  public:
    ping_listener(const scene& s, const bottom_materials& materials, std::span<const sliced_target> targets,
                  const bottom_tiles& bottom, const Rig& rig, const Law& law, const Equation& equation, double cell,
                  const seabed::height_range& relief, double start)
        : scene_(s),
          materials_(materials),
          targets_(targets),
          tiles_(bottom),
          law_(law),
          equation_(equation),
          relief_(relief),
          range_(static_cast<double>(rig.range)),
          first_range_(static_cast<double>(rig.first_range)),
          bin_(rig.bin()),
          step_((std::min)(bin_, cell)),
          profile_step_((std::max)(step_, 0.5 * cell)),
          first_point_(static_cast<std::size_t>(-numeric::floor_to_int(-start / profile_step_))),
          spacing_(rig.ping_spacing),
          bins_(static_cast<std::size_t>(rig.bins)) {
        top_ = -1e30;
        for (const sliced_target& t : targets) top_ = (std::max)(top_, t.top());
    }

    /// @returns one per bin, until the next ping
    std::span<const echo_bin> hear(const ping_frame& p) {
        std::fill(bins_.begin(), bins_.end(), echo_bin{});
        sample_bottom(p);
        const double altitude = p.position().z;
        if (looks_beyond(relief_, first_range_, altitude)) lowest_ = relief_.lowest, highest_ = relief_.highest;
        const fan_shape shape =
            fan_shape::around(altitude - lowest_, altitude - highest_, altitude - (std::max)(top_, highest_));
        if (!(shape == fan_.shape())) spread_out(shape);
        if (!(altitude > lowest_) || profile_[0].down <= 0) return bins_;  // it lies in the ground
        gather_targets(p);
        hear_bottom();
        if (some_target_) hear_targets();
        return bins_;
    }

    /// How far from the track pings look, metres on the ground: what has to be covered.
    static double reach(const Rig& rig, double cell) { return static_cast<double>(rig.range) + 4 * cell; }

    /// From where on they have to look: nothing nearer is heard in the first bin or later, nor hides what is.
    /// @param relief  of the bottom
    static double start(const Rig& rig, double cell, const seabed::height_range& relief, const ping_frame& p,
                        std::span<const sliced_target> targets) {
        const double altitude = p.position().z, first = static_cast<double>(rig.first_range);
        if (!looks_beyond(relief, first, altitude)) return 0;
        const double lowest = altitude - relief.lowest, heard = first - 4 * rig.bin();
        const double square = counts_time ? heard * heard - lowest * lowest : heard * heard;
        const double place = heard > 0 && square > 0 ? numeric::square_root(square) - 4 * cell : 0;
        for (const sliced_target& t : targets)
            if (t.is_met_by(p, 1e9) && t.nearest(p) < place) return 0;
        // A crest, the highest there can be, and the lowest place that it hides.
        return (std::max)(0.0, place * (altitude - relief.highest) / lowest - 4 * cell);
    }

  private:
    static constexpr float most = 2;  // bins that an echo may spread to either side of its ray, whatever the slope
    static constexpr bool counts_time = Rig::axis == across_track::slant_range;

    /// Whether pings look past a bottom that they are well above.
    static bool looks_beyond(const seabed::height_range& relief, double first_range, double altitude) {
        return first_range > 0 && !relief.empty() && relief.lowest > -altitude && 2 * relief.highest < altitude;
    }

    struct bottom_point {
        double down;  ///< below the sonar
        float slope, slope_along;
        std::uint8_t type;
    };
    struct target_hit {
        float range = std::numeric_limits<float>::infinity();
        float low = 0, high = 0;  ///< where it is heard, in bins
        float power = 0;
        std::uint16_t instance = 0;
    };

    /// A new fan, and what each of its rays carries for every metre of range.
    void spread_out(const fan_shape& shape) {
        const auto slant = [&](double r) {
            return counts_time ? r : numeric::square_root(r * r + shape.above_lowest * shape.above_lowest);
        };
        farthest_ = slant(range_);
        fan_ = ping_fan(shape, step_, slant(first_range_), farthest_);
        carried_.resize(fan_.size());
        for (std::size_t k = 0; k < fan_.size(); ++k)
            carried_[k] =
                spacing_ * static_cast<float>(fan_[k].width * equation_.over_direction(fan_[k].sine, fan_[k].cosine));
    }

    /// The profile below the ping, from where it matters outwards.
    void sample_bottom(const ping_frame& p) {
        const auto end = static_cast<std::size_t>(numeric::floor_to_int(range_ / profile_step_)) + 2;
        profile_.resize(end - first_point_);
        lowest_ = 1e30, highest_ = -1e30;
        const glm::vec2 across(p.across()), along(p.along());
        for (std::size_t i = 0; i < profile_.size(); ++i) {
            const glm::dvec2 at = p.world(place_of(i), 0);
            const bottom_vertex v = tiles_.at(at.x, at.y);
            const auto height = static_cast<double>(v.height);
            profile_[i] = {p.position().z - height, v.slope_x * across.x + v.slope_y * across.y,
                           v.slope_x * along.x + v.slope_y * along.y, static_cast<std::uint8_t>(v.type)};
            lowest_ = (std::min)(height, lowest_);  // NaN stays out
            highest_ = (std::max)(height, highest_);
        }
    }

    /// How far out a point of the profile is.
    double place_of(std::size_t i) const { return profile_step_ * static_cast<double>(first_point_ + i); }

    /// Which rays meet which target first.
    void gather_targets(const ping_frame& p) {
        some_target_ = false;
        for (std::size_t i = 0; i < targets_.size(); ++i) {
            if (!targets_[i].is_met_by(p, farthest_)) continue;
            if (!some_target_) hits_.assign(fan_.size(), target_hit{});
            some_target_ = true;
            targets_[i].cut(p, [&](const outline_piece& piece) {
                meet(piece, static_cast<std::uint16_t>(i + 1), scene_.targets[i].surface.reflectivity);
            });
        }
    }

    void meet(outline_piece o, std::uint16_t instance, float reflectivity) {
        if (o.a.x * o.b.down > o.a.down * o.b.x) std::swap(o.a, o.b);  // b is farther out
        if (!(o.a.x > 0 || o.b.x > 0)) return;
        const auto cut_at_nadir = [](outline_piece::corner& from, const outline_piece::corner& to) {
            if (from.x > 0) return;
            const double f = from.x / (from.x - to.x);
            from = {0, from.down + f * (to.down - from.down),
                    from.normal + static_cast<float>(f) * (to.normal - from.normal)};
        };
        cut_at_nadir(o.a, o.b);
        cut_at_nadir(o.b, o.a);
        // A ray's echo ends where the piece ends.
        const auto a = static_cast<float>(place(o.a.x, o.a.down)), b = static_cast<float>(place(o.b.x, o.b.down));
        const float nearest = (std::min)(a, b), farthest = (std::max)(a, b);
        const std::size_t last = fan_.first_over(o.b.x, o.b.down);
        for (std::size_t k = fan_.first_over(o.a.x, o.a.down); k < last; ++k) {
            const ping_fan::ray& ray = fan_[k];
            const double before = ping_fan::beyond(ray, o.a.x, o.a.down),
                         after = ping_fan::beyond(ray, o.b.x, o.b.down);
            const double f = before / (before - after);
            const double dx = o.b.x - o.a.x, ddown = o.b.down - o.a.down;
            const double range = (o.a.x + f * dx) * ray.sine + (o.a.down + f * ddown) * ray.cosine;
            target_hit& hit = hits_[k];
            if (!(range > 0 && range < static_cast<double>(hit.range))) continue;
            const glm::vec3 n = o.a.normal + static_cast<float>(f) * (o.b.normal - o.a.normal);
            const auto sine = static_cast<float>(ray.sine), cosine = static_cast<float>(ray.cosine);
            const bool outside = o.facet.z * cosine - o.facet.x * sine > 0;
            const float facing =
                (outside ? 1.0f : -1.0f) * (n.z * cosine - n.x * sine) / numeric::square_root(numeric::dot(n, n));
            const float at = column(ray, range), half = half_length(ray, range, dx, ddown);
            hit = {static_cast<float>(range), at - (std::min)(half, (std::max)(most, at - nearest)),
                   at + (std::min)(half, (std::max)(most, farthest - at)), power_of(k, range, facing) * reflectivity,
                   instance};
        }
    }

    /// Walks along the profile; rays meet it in order, and what lies below the last one met is hidden.
    void hear_bottom() {
        double horizon_x = 0, horizon_down = 1;
        // Rays that meet the bottom before the profile begins see nothing behind it.
        std::size_t k = first_point_ > 0 ? fan_.first_over(place_of(0), profile_[0].down) : 0;
        if (some_target_)
            for (std::size_t j = 0; j < k; ++j) hits_[j].range = std::numeric_limits<float>::infinity();
        const std::size_t rays = fan_.size();
        for (std::size_t i = 0; i + 1 < profile_.size(); ++i) {
            const double px = place_of(i), qx = place_of(i + 1);
            const bottom_point &p = profile_[i], &q = profile_[i + 1];
            const double dx = qx - px, ddown = q.down - p.down;
            const double above = qx * horizon_down - q.down * horizon_x;
            if (!(above > 0)) {
                if (Labelled && ddown == ddown) name(p, q, px, dx, 0, 1, hider(qx, q.down));
                continue;
            }
            // The part over the horizon begins here; labels cut it between rays, so that shadows end where rays say.
            const double below = px * horizon_down - p.down * horizon_x;
            double from = below / (below - above);
            if (Labelled && from > 0) name(p, q, px, dx, 0, from, hider(px + from * dx, p.down + from * ddown));
            double last_met = from;
            const std::size_t first = k;
            for (; k < rays && ping_fan::beyond(fan_[k], qx, q.down) >= 0; ++k) {
                const ping_fan::ray& ray = fan_[k];
                const double before = ping_fan::beyond(ray, px, p.down);
                const double f = before / (before - ping_fan::beyond(ray, qx, q.down));
                const double range = (px + f * dx) * ray.sine + (p.down + f * ddown) * ray.cosine;
                if (Labelled && some_target_ && k > first) {
                    const double between = 0.5 * (last_met + f);
                    name(p, q, px, dx, from, between, screen(k - 1, px + last_met * dx, p.down + last_met * ddown));
                    from = between;
                }
                last_met = f;
                if (range <= farthest_ + bin_) hear_bottom_at(ray, k, range, dx, ddown, p, q, static_cast<float>(f));
            }
            if constexpr (Labelled)
                name(p, q, px, dx, from, 1,
                     some_target_ ? screen(k > first ? k - 1 : k, px + last_met * dx, p.down + last_met * ddown)
                                  : labels::is_lit);
            horizon_x = qx, horizon_down = q.down;
        }
    }

    void hear_bottom_at(const ping_fan::ray& ray, std::size_t k, double range, double dx, double ddown,
                        const bottom_point& p, const bottom_point& q, float f) {
        if (some_target_) {
            if (static_cast<double>(hits_[k].range) < range) return;
            hits_[k].range = std::numeric_limits<float>::infinity();  // buried, or behind a rise
        }
        const float at = column(ray, range), half = (std::min)(half_length(ray, range, dx, ddown), most);
        const auto sine = static_cast<float>(ray.sine), cosine = static_cast<float>(ray.cosine);
        const float slope = p.slope + f * (q.slope - p.slope);
        const float slope_along = p.slope_along + f * (q.slope_along - p.slope_along);
        const float facing =
            (slope * sine + cosine) / numeric::square_root(1 + slope * slope + slope_along * slope_along);
        const float power =
            power_of(k, range, facing) * materials_[static_cast<std::size_t>(f < 0.5f ? p.type : q.type)].reflectivity;
        spread(at - half, at + half, [&](echo_bin& bin, float share, float) { bin.bottom += power * share; });
    }

    void hear_targets() {
        for (std::size_t k = 0; k < hits_.size(); ++k) {
            const target_hit& hit = hits_[k];
            if (!(static_cast<double>(hit.range) < 1e30)) continue;
            spread(hit.low, hit.high, [&](echo_bin& bin, float share, float) {
                const float power = hit.power * share;
                bin.target += power;
                if (power > bin.most_target) bin.most_target = power, bin.instance = hit.instance;
            });
        }
    }

    /// The target that stands between the sonar and a point of a ray, or is_lit.
    std::uint16_t screen(std::size_t k, double x, double down) const {
        const double range = numeric::square_root(x * x + down * down);
        return k < hits_.size() && static_cast<double>(hits_[k].range) < range ? hits_[k].instance : labels::is_lit;
    }
    /// Who hides bottom below the horizon; what a target keeps dark is the target's, even if the seabed would too.
    std::uint16_t hider(double x, double down) const {
        const std::uint16_t target = some_target_ ? screen(fan_.first_over(x, down), x, down) : labels::is_lit;
        return target == labels::is_lit ? labels::by_seabed : target;
    }

    /// Notes for the labels who keeps the bottom dark between two shares of the way from p to q.
    void name(const bottom_point& p, const bottom_point& q, double px, double dx, double from, double to,
              std::uint16_t caster) {
        const double down = q.down - p.down;
        const double a = place(px + from * dx, p.down + from * down), b = place(px + to * dx, p.down + to * down);
        const std::uint8_t type = from + to < 1 ? p.type : q.type;
        spread(static_cast<float>((std::min)(a, b)), static_cast<float>((std::max)(a, b)),
               [&](echo_bin& bin, float, float length) {
                   if (caster == labels::is_lit)
                       bin.lit += length;
                   else if (caster == labels::by_seabed)
                       bin.dark_by_seabed += length;
                   else
                       bin.dark_by_target += length, bin.caster = caster;
                   if (length > bin.most_bottom) bin.most_bottom = length, bin.seabed = type;
               });
    }

    /// Calls `visit(bin, share, length)` for the bins from `low` to `high`.
    template <class Visit>
    void spread(float low, float high, const Visit& visit) {
        if (!(high > 0 && low < static_cast<float>(bins_.size()))) return;
        const auto first = static_cast<std::int64_t>(low > 0 ? low : 0.0f);
        const auto last = (std::min)(static_cast<std::int64_t>(high), static_cast<std::int64_t>(bins_.size()) - 1);
        if (first == last && low >= static_cast<float>(first) && high <= static_cast<float>(first + 1)) {
            visit(bins_[static_cast<std::size_t>(first)], 1.0f, high - low);
            return;
        }
        const float scale = 1 / (high - low);
        for (std::int64_t b = first; b <= last; ++b) {
            const float from = (std::max)(low, static_cast<float>(b)), to = (std::min)(high, static_cast<float>(b + 1));
            if (to > from) visit(bins_[static_cast<std::size_t>(b)], (to - from) * scale, to - from);
        }
    }

    /// Where an echo is heard, in bins.
    float column(const ping_fan::ray& ray, double range) const {
        const double r = counts_time ? range : range * ray.sine;
        return static_cast<float>((r - first_range_) / bin_);
    }
    double place(double x, double down) const {
        const double r = counts_time ? numeric::square_root(x * x + down * down) : x;
        return (r - first_range_) / bin_;
    }

    /// Half of the bins between the two edges of a ray on a surface along (dx, ddown).
    float half_length(const ping_fan::ray& ray, double range, double dx, double ddown) const {
        const double outwards = counts_time ? dx * ray.sine + ddown * ray.cosine : dx;
        const double turning = dx * ray.cosine - ddown * ray.sine;
        const double half = 0.5 * range * ray.width * outwards / (turning * bin_);
        return static_cast<float>(numeric::magnitude(half));
    }

    /// What a surface of reflectivity one sends back of a ray: its area, seen from here, over the sine of grazing, by
    /// law.
    float power_of(std::size_t k, double range, float facing) const {
        const float sine = (std::min)((std::max)(facing, 1e-3f), 1.0f);
        return static_cast<float>(range) * carried_[k] * law_(sine) / sine;
    }

    const scene& scene_;
    const bottom_materials& materials_;
    std::span<const sliced_target> targets_;
    const bottom_tiles& tiles_;
    Law law_;
    const Equation& equation_;
    seabed::height_range relief_;
    double range_, first_range_, bin_, step_, profile_step_, farthest_ = 0;
    std::size_t first_point_;
    float spacing_;
    double top_, lowest_ = 0, highest_ = 0;
    ping_fan fan_;
    std::vector<float> carried_;
    std::vector<bottom_point> profile_;
    std::vector<target_hit> hits_;
    bool some_target_ = false;
    std::vector<echo_bin> bins_;
};

}  // namespace insonify::inline INSONIFY_ABI::detail

INSONIFY_ARITHMETIC_END
