// Converts the signal to a picture as sonars do: detection, levelling by range, averaging into pixels, display.
#pragma once

#include "echoes.hpp"

namespace pings {

/// Gray values by rows: the last ping on top, range growing to the right.
struct chip {
    std::size_t pixels;
    std::vector<std::uint8_t> gray;
};

/// @param metres  a side
inline chip draw_chip(scene& s, double metres, std::size_t pixels) {
    constexpr std::size_t samples_per_pixel = 2;
    const double pixel = metres / static_cast<double>(pixels);
    waterfall w(pixels, samples_per_pixel * pixels, pixel, s.left_edge, pixel / samples_per_pixel);
    receiver sonar(s, w);
    sonar.record();

    chip c{pixels, std::vector<std::uint8_t>(pixels * pixels)};
    for (std::size_t y = 0; y < pixels; ++y)
        for (std::size_t x = 0; x < pixels; ++x) {
            double power = 0;  // mean power relative to level bottom
            for (std::size_t i = samples_per_pixel * x; i < samples_per_pixel * (x + 1); ++i)
                power += std::norm(w.row(y)[i]) / (sonar.bottom_power(w.range(i)) * samples_per_pixel);
            const double shown = std::pow(std::min(1.0, std::sqrt(power) / s.rig.white), s.rig.gamma);
            c.gray[(pixels - 1 - y) * pixels + x] = static_cast<std::uint8_t>(255 * shown + 0.5);
        }
    return c;
}

}  // namespace pings
