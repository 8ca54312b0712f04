// What a chip shows, drawn from (seed, index) alone: the sonar, the sea floor, and the target that lies on it.
#pragma once

#include <algorithm>
#include <array>

#include <glm/trigonometric.hpp>

#include "bottom.hpp"
#include "shapes.hpp"

namespace pings {

inline constexpr std::array<const char*, 3> class_names{"cylinder", "cube", "sphere"};

/// Lengths are metres, angles radians.
struct sonar {
    double altitude;
    double wavelength = 1500.0 / 450e3;
    double beam;          ///< between the -3 dB points of one way
    double resolution;    ///< of the pulse, in range, at -6 dB
    double noise;         ///< power, over that of level bottom in the middle of the chip
    double white, gamma;  ///< of the display: what is white, in mean amplitudes of the bottom; and its power
};

struct scene {
    std::string class_name, seabed;
    sonar rig;
    double size, length, yaw, burial;  ///< of the target; burial as a fraction of its height
    double ground_range, along;        ///< of its middle, from the track and from the chip's lower edge
    double left_edge;                  ///< slant range where the chip begins
    double strength, glint;  ///< of the target's surface, power over the bottom's; of facets towards the sonar
    bottom ground;
    std::variant<std::monostate, body> target;
    dice random;  ///< for what is drawn later: scatterers and noise

    const body& target_body() const { return std::get<body>(target); }
};

/// Everything about chip `index` of a run.
/// @param chip  metres a side
inline scene make_scene(std::uint64_t seed, std::uint64_t index, std::size_t kind, const std::string& seabed,
                        double chip) {
    dice random(seed, index);
    const auto power = [](double decibels) { return std::pow(10.0, 0.1 * decibels); };
    const auto choose = [&](auto... values) { return std::array{values...}[random.below(sizeof...(values))]; };
    const double full_turn = 2 * std::numbers::pi;
    scene s{class_names[kind], seabed, {}, 0, 0, 0, 0, 0, 0, 0, 0, 0, {}, {}, random};

    sonar& rig = s.rig;
    rig.altitude = random.uniform(3, 10);
    rig.beam = glm::radians(random.uniform(0.3, 0.6));
    rig.resolution = random.uniform(0.03, 0.05);
    rig.noise = power(random.uniform(-25, -12));
    rig.white = random.uniform(3, 6);
    rig.gamma = random.uniform(0.6, 1);
    s.ground_range = rig.altitude * random.uniform(2, 9);
    s.along = chip * random.uniform(0.42, 0.58);
    s.left_edge = std::max(0.0, std::hypot(s.ground_range, rig.altitude) - chip * random.uniform(0.28, 0.38));

    if (seabed == "ripples") {
        const double wavelength = random.uniform(0.3, 1);
        const double direction = random.uniform(0, full_turn), height = wavelength * random.uniform(0.05, 0.12);
        s.ground.ripple(wavelength, height, direction, random);
    }
    s.ground.undulate(random.uniform(0.002, 0.006), random);

    solid shape = sphere{};
    s.yaw = random.uniform(0, full_turn);
    s.burial = choose(0.0, 0.15, 0.3);
    s.strength = power(random.uniform(3, 9));
    s.glint = power(random.uniform(10, 20));
    if (kind == 0) {
        s.size = random.uniform(0.4, 0.6), s.length = random.uniform(1.2, 2);
        shape = cylinder{0.5 * s.size, s.length};
    } else if (kind == 1) {
        s.size = s.length = random.uniform(0.4, 0.8);
        shape = box{glm::dvec3(s.size)};
    } else {
        s.size = s.length = random.uniform(0.5, 0.9);
        shape = sphere{0.5 * s.size};
    }

    // At the mean height of the bottom along its axis, pitched by up to 3 degrees at random.
    const double half = 0.5 * s.length, c = std::cos(s.yaw), sn = std::sin(s.yaw);
    double height = 0;
    constexpr int steps = 9;
    for (int i = 0; i < steps; ++i) {
        const double t = half * (2.0 * i / (steps - 1) - 1);
        height += s.ground({s.ground_range + t * c, s.along + t * sn}).height / steps;
    }
    const double pitch = glm::radians(random.uniform(-3, 3)), cp = std::cos(pitch), sp = std::sin(pitch);
    const glm::dmat3 turn(c * cp, sn * cp, sp, -sn, c, 0, -c * sp, -sn * sp, cp);
    s.target.emplace<body>(shape, turn, glm::dvec3(s.ground_range, s.along, height + s.size * (0.5 - s.burial)));
    s.random = random;
    return s;
}

}  // namespace pings
