// Contacts: the position of each target and its shadow in the waterfall, compared with the expected one.
#pragma once

#include "../common/longest_shadow.hpp"
#include "sonar.hpp"
#include "streams.hpp"

namespace survey {

/// Bounds of a target and its shadow in the waterfall; they grow until the target is out of sight.
struct contact {
    in::target target;
    in::side side;
    std::int64_t first_ping = 0, last_ping = -1;
    int first_bin = 1 << 30, last_bin = -1, shadow_end = -1;
    std::int64_t area = 0, shadow_area = 0;
    fix closest{};                ///< the ping from which it is abeam
    double along_squared = 1e30;  ///< square of its distance ahead or behind at that ping, m^2
};

/// All contacts in sight, and the table of earlier ones.
class contact_list {
  public:
    explicit contact_list(const std::string& path)
        : table_(path,
                 "target,class,side,first_ping,last_ping,first_bin,last_bin,shadow_end_bin,target_px,shadow_px,x_m,y_m,"
                 "height_m,range_m,altitude_m,grazing_deg,aspect_deg,shadow_theory_m,shadow_measured_m,shadow_is_cut,"
                 "target_is_cut") {}

    /// Updates the contacts with the targets and shadows of a block.
    void add(const block& b, const sight& in_sight) {
        const int bins = b.gray.width() / 2;
        for (int row = 0; row < b.gray.height(); ++row)
            for (int x = 0; x < 2 * bins; ++x) {
                const std::uint16_t instance = b.labels.instance(x, row), shadow = b.labels.shadow(x, row);
                const auto side = x < bins ? in::side::port : in::side::starboard;
                const int bin = x < bins ? bins - 1 - x : x - bins;
                const fix& at = b.pings[static_cast<std::size_t>(row)];
                if (instance != in::labels::no_instance) {
                    contact& c = seen(instance, side, at, in_sight);
                    c.area += 1;
                    c.first_bin = (std::min)(c.first_bin, bin);
                    c.last_bin = (std::max)(c.last_bin, bin);
                } else if (shadow != in::labels::no_shadow && shadow != in::labels::by_seabed) {
                    contact& c = seen(shadow, side, at, in_sight);
                    c.shadow_area += 1;
                    c.shadow_end = (std::max)(c.shadow_end, bin);
                }
            }
    }

    /// Writes and removes the contacts last seen before a ping.
    /// @param is_end  whether the survey ends at that ping
    void close(std::int64_t before, const in::side_scan& rig, bool is_end = false) {
        for (auto at = open_.begin(); at != open_.end();) {
            if (at->second.last_ping >= before) {
                ++at;
                continue;
            }
            write(at->first.first, at->second, rig, is_end && at->second.last_ping + 1 == before);
            at = open_.erase(at);
        }
    }

    /// Writes all contacts and closes the table.
    /// @param total  number of pings of the survey
    void finish(std::int64_t total, const in::side_scan& rig) {
        close(total, rig, true);
        table_.close();
    }

  private:
    contact& seen(std::uint16_t number, in::side side, const fix& at, const sight& in_sight) {
        const auto [entry, is_new] = open_.try_emplace({number, side});
        contact& c = entry->second;
        if (is_new) {
            const auto instance = std::find(in_sight.numbers.begin() + 1, in_sight.numbers.end(), number);
            c = {in_sight.scene.targets[static_cast<std::size_t>(instance - in_sight.numbers.begin()) - 1], side,
                 at.number};
        }
        c.last_ping = at.number;
        const double along = in::ping_frame(at.at, side)(c.target.placement.position).y;
        if (along * along < c.along_squared) c.along_squared = along * along, c.closest = at;
        return c;
    }

    void write(std::uint16_t target, const contact& c, const in::side_scan& rig, bool at_the_end) {
        if (c.area + c.shadow_area == 0) return;
        namespace geometry = in::range_geometry;
        const double altitude = c.closest.at.position.z;
        const in::ping_frame frame(c.closest.at, c.side);
        const glm::dvec3& position = c.target.placement.position;
        const double ground = frame(position).x;
        const double turn = 2 * in::numeric::pi;
        const double off = (static_cast<double>(c.target.placement.yaw) - c.closest.at.yaw) / turn;
        const double aspect = turn * (off - static_cast<double>(in::numeric::floor_to_int(off)));
        double farthest = 0;  // slant range of any vertex
        const examples::longest_shadow shadow = examples::shadow_of(
            c.target, frame, altitude,
            [&](const glm::dvec3& v) { farthest = (std::max)(farthest, geometry::slant_range(v.x, altitude, v.z)); });
        // From the echo of the vertex that casts the tip to the tip. Recordings may end before that echo.
        const double measured = c.shadow_end < 0 || shadow.tip == 0
                                    ? 0
                                    : (std::max)((c.shadow_end + 1) * rig.bin() - shadow.slant_range, 0.0);
        const bool at_an_end = at_the_end || c.first_ping == 0;
        table_.line(std::to_string(target) + "," + c.target.class_name +
                    (c.side == in::side::port ? ",port" : ",starboard") + "," + std::to_string(c.first_ping) + "," +
                    std::to_string(c.last_ping) + format(",%d,%d,%d", c.first_bin, c.last_bin, c.shadow_end) + "," +
                    std::to_string(c.area) + "," + std::to_string(c.shadow_area) +
                    format(",%.3f,%.3f,%.3f,%.3f,%.3f,%.2f,%.1f,%.3f,%.3f", position.x, position.y, shadow.height,
                           geometry::slant_range(ground, altitude), altitude,
                           in::numeric::to_degrees(geometry::grazing_angle(ground, altitude)),
                           in::numeric::to_degrees(aspect), shadow.slant_length, measured) +
                    (c.shadow_end + 1 >= rig.bins || at_an_end ? ",true" : ",false") +
                    (farthest > static_cast<double>(rig.range) || at_an_end ? ",true" : ",false"));
    }

    std::map<std::pair<std::uint16_t, in::side>, contact> open_;
    csv_stream table_;
};

}  // namespace survey
