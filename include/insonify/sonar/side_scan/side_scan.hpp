// The side-scan rig: pings along a track, and the ranges that are recorded.
#pragma once

#include <insonify/core/numeric.hpp>
#include <insonify/fwd.hpp>
#include <insonify/geometry/transform.hpp>

#include <concepts>
#include <cstdint>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// The side of the track that a channel faces: left or right.
enum class side : std::uint8_t { port, starboard };

/// What the columns of a picture measure.
enum class across_track {
    slant_range,   ///< travel time: water column, layover
    ground_range,  ///< position across the track: a map, with the same shadows
};

/// Position and attitude of the sonar at one ping. Rotations apply as for ships: yaw first, then pitch, then roll.
struct ping {
    glm::dvec3 position{0, 0, 5};  ///< of the sonar in the world, metres; z above the datum, heave included
    double yaw = 0;                ///< radians: 0 travels towards +y, with starboard at +x; counter-clockwise
    double pitch = 0;              ///< radians, positive with the bow up: tilts the fan forward, within +-80 degrees
    double roll = 0;               ///< radians, positive with starboard down: turns the beams within the fan
};

inline namespace INSONIFY_FLAGS {

/// @param name  of the ping in an error
/// @throws invalid_input for a value out of range
inline void validate(const ping& p, std::string_view name = "ping") {
    detail::require_finite(name, p.position, ".position");
    detail::require_angle(name, p.yaw, ".yaw");
    detail::require_member(numeric::abs(p.pitch) <= numeric::to_radians(80), name, ".pitch", p.pitch,
                           "at most 80 degrees, in radians");
    detail::require_angle(name, p.roll, ".roll");
}

}  // namespace INSONIFY_FLAGS

/// One channel of a side-scan sonar on a straight, level track: `side_scan` for slant range, `ground_range` for ground
/// range.
///
/// A picture has a row per ping and a column per bin. Row i is ping i, the first on top (`flipped_vertically` flips it
/// so that up is forward). The left column is the first bin on either side, so that range grows and shadows fall to the
/// right.
template <across_track Axis>
struct side_scan_rig {
    static constexpr across_track axis = Axis;

    glm::dvec2 position{0, 0};   ///< of the first ping over the datum, metres
    float altitude = 5;          ///< above the datum, metres; default gains take the seabed to be there
    float yaw = 0;               ///< radians, as of a ping
    float ping_spacing = 0.04f;  ///< metres of track from one ping to the next, > 0
    int pings = 1024;            ///< 1 to 2^20
    float first_range = 0;       ///< start of the first bin, metres, >= 0
    float range = 40;            ///< end of the last bin, metres, > first_range, at most 10^5
    int bins = 2048;             ///< 1 to 2^20
    insonify::side side = insonify::side::starboard;

    /// Metres per bin.
    INSONIFY_MEMBER double bin() const {
        return (static_cast<double>(range) - static_cast<double>(first_range)) / bins;
    }
};
/// A rig whose columns are slant ranges.
using side_scan = side_scan_rig<across_track::slant_range>;
/// A rig whose columns are ranges along the bottom.
using ground_range = side_scan_rig<across_track::ground_range>;

inline namespace INSONIFY_FLAGS {

/// @throws invalid_input for a value out of range
template <across_track Axis>
void validate(const side_scan_rig<Axis>& rig) {
    constexpr std::string_view name = Axis == across_track::slant_range ? "side_scan" : "ground_range";
    const auto require = [=](bool holds, std::string_view member, auto value, std::string_view expected) {
        detail::require_member(holds, name, member, value, expected);
    };
    require(numeric::is_finite(rig.position.x), ".position.x", rig.position.x, "finite");
    require(numeric::is_finite(rig.position.y), ".position.y", rig.position.y, "finite");
    require(numeric::is_finite(rig.altitude), ".altitude", rig.altitude, "finite");
    detail::require_angle(name, rig.yaw, ".yaw");
    require(numeric::is_finite(rig.ping_spacing) && rig.ping_spacing > 0, ".ping_spacing", rig.ping_spacing,
            "finite and positive");
    require(rig.pings >= 1 && rig.pings <= 1 << 20, ".pings", rig.pings, "1 to 2^20");
    require(rig.first_range >= 0 && numeric::is_finite(rig.first_range), ".first_range", rig.first_range,
            "0 or more, finite");
    require(rig.range > rig.first_range && rig.range <= 1e5f, ".range", rig.range,
            "above first_range and at most 10^5 metres");
    require(rig.bins >= 1 && rig.bins <= 1 << 20, ".bins", rig.bins, "1 to 2^20");
    require(rig.side == side::port || rig.side == side::starboard, ".side", static_cast<int>(rig.side),
            "port or starboard");
}

/// A ping of the rig's track. Numbers below 0 and beyond the last continue the line.
template <across_track Axis>
ping ping_of(const side_scan_rig<Axis>& rig, int number) {
    const double yaw = numeric::widened(rig.yaw), along = numeric::widened(rig.ping_spacing) * number;
    const auto [sine, cosine] = numeric::sin_cos(yaw);
    return {{rig.position.x - along * sine, rig.position.y + along * cosine, numeric::widened(rig.altitude)}, yaw};
}

/// All pings of the rig's track, in order.
/// @throws invalid_input for a value of the rig out of range
template <across_track Axis>
std::vector<ping> track_of(const side_scan_rig<Axis>& rig) {
    validate(rig);
    std::vector<ping> track;
    track.reserve(static_cast<std::size_t>(rig.pings));
    for (int i = 0; i < rig.pings; ++i) track.push_back(ping_of(rig, i));
    return track;
}

/// Fails to compile, with a message that names recording.hpp, where that header is not included.
template <std::same_as<scene> Scene, across_track Axis>
void render(const Scene&, const side_scan_rig<Axis>&) {
    static_assert(sizeof(Scene) == 0, "a recording needs #include <insonify/sonar/side_scan/recording.hpp>");
}

/// The frame of a ping: x level and across the track, on the side that it faces; u along the sonar's axis; z up, from
/// the sonar. The fan is the plane u = 0, which pitch tilts from the vertical.
class ping_frame {
  public:
    ping_frame(const ping& p, side facing) : position_(p.position) {
        const auto [sine, cosine] = numeric::sin_cos(p.yaw);
        const double sign = facing == side::starboard ? 1 : -1;
        across_ = {sign * cosine, sign * sine};
        along_ = {-sine, cosine};
        const numeric::sine_cosine pitch = numeric::sin_cos(p.pitch), roll = numeric::sin_cos(p.roll);
        sine_pitch_ = pitch.sine, cosine_pitch_ = pitch.cosine;
        sine_roll_ = sign * roll.sine, cosine_roll_ = roll.cosine;
    }
    const glm::dvec3& position() const { return position_; }
    /// Horizontal unit vectors.
    const glm::dvec2& across() const { return across_; }
    const glm::dvec2& along() const { return along_; }
    bool is_level() const { return sine_pitch_ == 0; }
    double sine_pitch() const { return sine_pitch_; }
    double cosine_pitch() const { return cosine_pitch_; }
    /// Of the roll, positive with the side that it faces down.
    double sine_roll() const { return sine_roll_; }
    double cosine_roll() const { return cosine_roll_; }

    /// Horizontal world coordinates of (x, u), with u along the heading.
    glm::dvec2 world(double x, double u) const {
        return {position_.x + x * across_.x + u * along_.x, position_.y + x * across_.y + u * along_.y};
    }
    /// Horizontal world coordinates of the fan's point (x, down).
    glm::dvec2 below(double x, double down) const { return world(x, down * sine_pitch_); }
    /// (x, u, z) of a world vector.
    glm::dvec3 direction(const glm::dvec3& v) const {
        const double ahead = v.x * along_.x + v.y * along_.y;
        return {v.x * across_.x + v.y * across_.y, ahead * cosine_pitch_ + v.z * sine_pitch_,
                v.z * cosine_pitch_ - ahead * sine_pitch_};
    }
    /// (x, u, z) of a world position.
    glm::dvec3 operator()(const glm::dvec3& world) const { return direction(world - position_); }

  private:
    glm::dvec3 position_;
    glm::dvec2 across_, along_;
    double sine_pitch_, cosine_pitch_, sine_roll_, cosine_roll_;
};

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
