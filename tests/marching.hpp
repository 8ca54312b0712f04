// An oracle for pictures of a seabed: a ray for each pixel down to it, and one from there to the light, marched in
// double over heights sampled several times as finely as the picture. Shares the heightfield and the size of a pixel
// with the renderer.
#pragma once

#include <insonify/sonar/overhead/render.hpp>

#include <cmath>

namespace marching {

namespace in = insonify;

/// The dark pixels of a rig's picture of a seabed: those that face away from the light or are occluded.
/// @param finest  vertices per pixel
template <class E>
in::image<std::uint8_t> dark_pixels(const in::seabed::any& bottom, const in::overhead& rig, double finest, E&& ex) {
    const double pixel = in::overhead_geometry(rig).ground_sampling(), altitude = static_cast<double>(rig.altitude);
    const double tangent = std::tan(static_cast<double>(rig.grazing));
    const double azimuth = static_cast<double>(rig.yaw) + static_cast<double>(rig.light_azimuth);
    const double cosine = std::cos(static_cast<double>(rig.yaw)), sine = std::sin(static_cast<double>(rig.yaw));
    const glm::dvec2 travel(std::cos(azimuth), std::sin(azimuth));
    const double half = 0.5 * pixel * std::max(rig.size.x, rig.size.y);

    // The range of heights, then the ground in view and what can cast a shadow there.
    double low = 1e30, top = -1e30;
    const auto look = [&](double around, double spacing) {
        const glm::dvec2 corner = rig.position - around;
        const auto field = in::seabed::sample(bottom, in::seabed::grid_over(corner, corner + 2 * around, spacing), ex);
        for (const float h : field.heights.pixels()) {
            low = std::min(low, static_cast<double>(h));
            top = std::max(top, static_cast<double>(h));
        }
        return field;
    };
    look(3 * half, pixel);
    const double room = 0.1 * (top - low);
    low -= room, top += room;
    const double seen = 1.5 * half * (1 - low / altitude), reach = (top - low) / tangent;
    const auto field = look(seen + std::min(reach, 3 * half), pixel / finest);
    const auto height = [&](double x, double y) { return static_cast<double>(field.height_at(x, y)); };

    in::image<std::uint8_t> dark(rig.size.x, rig.size.y);
    ex.bulk(static_cast<std::size_t>(rig.size.y), [&](std::size_t row) {
        const int j = static_cast<int>(row);
        for (int i = 0; i < rig.size.x; ++i) {
            const double right = (i + 0.5 - 0.5 * rig.size.x) * pixel, up = (0.5 * rig.size.y - j - 0.5) * pixel;
            const glm::dvec2 datum(right * cosine - up * sine, right * sine + up * cosine);
            const auto at = [&](double z) { return rig.position + datum * (1 - z / altitude); };
            const auto above = [&](double z) { return z - height(at(z).x, at(z).y); };
            // Down the camera's ray: in steps of half a cell over the ground, then by halving.
            const double sideways = std::hypot(datum.x, datum.y) / altitude;
            const double step = std::min(top - low, 0.5 * field.spacing / std::max(sideways, 1e-9));
            double z = top;
            while (z > low && above(z - step) > 0) z -= step;
            double under = z - step;
            for (int k = 0; k < 40; ++k) {
                const double middle = 0.5 * (z + under);
                (above(middle) > 0 ? z : under) = middle;
            }
            const glm::dvec2 p = at(z);
            const auto facet = field.facet_at(p.x, p.y);
            if (field.spacing * tangent + facet.rise_x * travel.x + facet.rise_y * travel.y <= 0) {
                dark(i, j) = 1;
                continue;
            }
            for (double away = 0.01 * field.spacing;; away += 0.5 * field.spacing) {
                const double ray = facet.height + away * tangent;
                if (ray > top) break;
                if (height(p.x - away * travel.x, p.y - away * travel.y) > ray + 1e-7) {
                    dark(i, j) = 1;
                    break;
                }
            }
        }
    });
    return dark;
}

}  // namespace marching
