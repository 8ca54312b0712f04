// The last steps of a sonar picture: from intensities to the gray values of a screen, enlarged and turned.
#pragma once

#include "sonar_recipe.hpp"

namespace generator::detail {

/// A square picture or its labels after `turn` counter-clockwise quarter turns; from 4 on, of the mirrored picture.
template <class T>
in::image<T> turned(const in::image<T>& from, int turn) {
    const int n = from.width();
    in::image<T> to(n, n);
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            int u = turn >= 4 ? n - 1 - x : x, v = y;
            for (int i = 0; i < turn % 4; ++i) {
                const int w = u;
                u = v, v = n - 1 - w;
            }
            to(u, v) = from(x, y);
        }
    return to;
}

/// The picture as it looks when it was stored with `factor` times fewer pixels a side and enlarged to its size again:
/// means of `factor` x `factor` pixels, interpolated linearly.
inline in::image<float> enlarged(const in::image<float>& from, double factor) {
    const int n = from.width(), coarse = (std::max)(static_cast<int>(in::numeric::floor_to_int(n / factor + 0.5)), 2);
    const double step = static_cast<double>(n) / coarse;
    // Separable: one axis a pass. Each pass transposes, so that both run the same loop.
    in::image<float> now = from;
    for (int pass = 0; pass < 2; ++pass) {
        in::image<float> to(n, n);
        std::vector<double> cell(static_cast<std::size_t>(coarse));
        for (int y = 0; y < n; ++y) {
            for (int i = 0; i < coarse; ++i) {
                double sum = 0;
                const double low = i * step, high = low + step;
                for (int x = static_cast<int>(low); x < n && x < high; ++x)
                    sum += static_cast<double>(now(x, y)) * ((std::min)(x + 1.0, high) - (std::max)(double(x), low));
                cell[static_cast<std::size_t>(i)] = sum / step;
            }
            for (int x = 0; x < n; ++x) {
                const double at = (std::min)((std::max)((x + 0.5) / step - 0.5, 0.0), coarse - 1.0);
                const auto i = (std::min)(static_cast<std::size_t>(at), static_cast<std::size_t>(coarse - 2));
                to(y, x) = static_cast<float>(cell[i] + (at - static_cast<double>(i)) * (cell[i + 1] - cell[i]));
            }
        }
        now = std::move(to);
    }
    return now;
}

/// Gray values as the plan's display shows them.
inline in::image<float> on_screen(in::image<float> intensity, const sonar_plan& p, auto& ex) {
    const auto show = [&](const auto& display) {
        in::image<float> gray = in::apply(std::move(intensity), display, ex);
        return p.enlarged > 1 ? enlarged(gray, p.enlarged) : gray;
    };
    const auto white = static_cast<float>(p.white);
    if (p.display == "decibels")
        return show(in::decibel_display{.white = white, .range = static_cast<float>(p.dynamic_range)});
    // Automatic displays have no exponent; the plan's decides their scale: a quarter of them are in decibels.
    if (p.display == "automatic")
        return show(in::automatic_display{
            .scale = p.exponent < 0.4 ? in::display_scale::decibels : in::display_scale::amplitude,
            .black_fraction = static_cast<float>(p.black_share),
            .white_fraction = static_cast<float>(p.white_share)});
    return show(in::display{.white = white, .exponent = p.display == "power" ? 1.0f : static_cast<float>(p.exponent)});
}

}  // namespace generator::detail
