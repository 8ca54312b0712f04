// The vehicle: steers from waypoint to waypoint, heaves and sends pings.
#pragma once

#include <insonify/sonar/side_scan/side_scan.hpp>

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "../common/input_file.hpp"
#include "../common/parse.hpp"

namespace survey {

namespace in = insonify;

/// The vehicle's motion. Lengths are metres, times seconds.
struct handling {
    double speed = 1.5, ping_rate = 15;
    double turn_rate = 6;          ///< degrees per second at most
    double altitude = 6;           ///< above the datum, on average
    double altitude_change = 1.5;  ///< amplitude of its slow rise and descent
    double heave = 0.15;           ///< amplitude of its motion with the swell
    double heave_period = 7;
    double arrival = 2;  ///< distance at which a waypoint counts as reached
};

/// One ping and when it was sent.
struct fix {
    std::int64_t number;
    double time;
    in::ping at;
};

/// Parallel legs in alternating directions that cover length x width metres from the origin.
inline std::vector<glm::dvec2> lawnmower(double length, double width, double between) {
    std::vector<glm::dvec2> points;
    bool forwards = true;
    for (double x = 0; x <= width + 1e-9; x += between, forwards = !forwards)
        for (const double y : {forwards ? 0.0 : length, forwards ? length : 0.0}) points.emplace_back(x, y);
    return points;
}

/// Waypoints from lines "x,y" in metres; empty lines and lines that begin with # are skipped.
/// @throws io_error that names the line that isn't two numbers
inline std::vector<glm::dvec2> parse_waypoints(std::string_view text, const std::string& name) {
    std::vector<glm::dvec2> points;
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // the mark of UTF-8
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = (std::min)(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix((std::min)(end + 1, text.size()));
        const auto skip_blanks = [&] { line.remove_prefix((std::min)(line.find_first_not_of(" \t\r"), line.size())); };
        skip_blanks();
        if (line.empty() || line[0] == '#') continue;
        const auto refuse = [&] {
            throw in::io_error(name + ": line " + std::to_string(number) + " is not x,y: two numbers of at most 1e7 m");
        };
        const auto coordinate = [&] {
            double value = 0;
            const std::string_view token = line.substr(0, line.find_first_of(", \t\r"));
            if (!examples::parse(token, value) || !(value >= -1e7 && value <= 1e7)) refuse();
            line.remove_prefix(token.size());
            skip_blanks();
            return value;
        };
        const double x = coordinate();
        if (!line.starts_with(',')) refuse();
        line.remove_prefix(1);
        skip_blanks();
        const double y = coordinate();
        if (!line.empty()) refuse();
        points.emplace_back(x, y);
    }
    if (points.size() < 2) throw in::io_error(name + ": has fewer than two waypoints");
    return points;
}

/// @throws io_error for a file that can't be read or a line that isn't two numbers
inline std::vector<glm::dvec2> read_waypoints(const std::string& path) {
    return parse_waypoints(examples::read_input(path), path);
}

/// Follows a list of waypoints, one ping at a time.
class vehicle {
  public:
    vehicle(const handling& h, std::span<const glm::dvec2> points) : handling_(h), points_(points), place_(points[0]) {
        yaw_ = course();
    }

    /// Moves on to the next ping. @returns false at the last waypoint
    bool ping(fix& f) {
        while (next_ < points_.size() && (is_at_next() || has_passed_next())) {
            if (distance_to_next() >= (std::max)(handling_.arrival, spacing())) ++missed_;
            ++next_;
        }
        if (next_ >= points_.size()) return false;
        const double step = 1 / handling_.ping_rate, time = static_cast<double>(number_) * step;
        // Turns the shorter way, limited by the turn rate.
        const double turn = 2 * in::numeric::pi, max_step = in::numeric::to_radians(handling_.turn_rate) * step;
        double off = course() - yaw_;
        off -= turn * static_cast<double>(in::numeric::floor_to_int(off / turn + 0.5));
        yaw_ += (std::min)((std::max)(off, -max_step), max_step);
        const auto [sine, cosine] = in::numeric::sin_cos(yaw_);
        place_ += handling_.speed * step * glm::dvec2(-sine, cosine);

        const auto wave = [&](double period) { return in::numeric::sin_cos_turns(time / period).sine; };
        const double z = handling_.altitude + handling_.altitude_change * wave(11 * handling_.heave_period) +
                         handling_.heave * wave(handling_.heave_period);
        f = {number_++, time, {{place_.x, place_.y, z}, yaw_}};
        return true;
    }

    double spacing() const { return handling_.speed / handling_.ping_rate; }
    /// Waypoints so far that it passed at a distance.
    int missed() const { return missed_; }

  private:
    /// Yaw towards the next waypoint.
    double course() const {
        const glm::dvec2 to = points_[(std::min)(next_, points_.size() - 1)] - place_;
        return in::numeric::atan2(-to.x, to.y);
    }
    glm::dvec2 to_next() const { return points_[next_] - place_; }
    double distance_to_next() const {
        const glm::dvec2 to = to_next();
        return in::numeric::square_root(to.x * to.x + to.y * to.y);
    }
    bool is_at_next() const { return distance_to_next() < handling_.arrival; }
    /// Whether the next waypoint lies behind: one within the turning circle can't be reached.
    bool has_passed_next() const {
        const auto [sine, cosine] = in::numeric::sin_cos(yaw_);
        // A step from ping to ping may be longer than the turning circle.
        const double circle = (std::max)(2 * handling_.speed / in::numeric::to_radians(handling_.turn_rate), spacing());
        return distance_to_next() < circle && -to_next().x * sine + to_next().y * cosine < 0;
    }

    handling handling_;
    std::span<const glm::dvec2> points_;
    glm::dvec2 place_;
    double yaw_ = 0;
    std::size_t next_ = 1;
    int missed_ = 0;
    std::int64_t number_ = 0;
};

}  // namespace survey
