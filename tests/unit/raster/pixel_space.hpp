// Drawing in pixel coordinates, and an independent, slow oracle of coverage: what the raster tests share.
#pragma once

#include <insonify/core/image.hpp>
#include <insonify/raster/draw.hpp>

#include <cmath>
#include <vector>

#include <glm/vec2.hpp>

namespace testing_raster {

namespace in = insonify;

/// Vertices are (x, y, z): pixels from the top left corner, and depth. Exact where the size is a power of two.
struct pixel_space {
    int width, height;
    glm::vec4 operator()(const in::vertex& v) const {
        const auto w = static_cast<float>(width), h = static_cast<float>(height);
        return {v.position.x / w * 2 - 1, 1 - v.position.y / h * 2, v.position.z, 1.0f};
    }
};

/// How often each pixel is covered, every triangle drawn by itself.
inline in::image<int> hits(const in::mesh& m, int width, int height, auto&& place, in::draw_options options = {}) {
    in::image<int> count(width, height);
    in::image<float> depth(width, height);
    options.load = in::depth_load::clear;
    in::mesh one{m.positions, m.normals, {}};
    for (const glm::uvec3& t : m.triangles) {
        one.triangles = {t};
        in::draw(
            one, place, [&](const auto& f) { ++count(f.x, f.y); }, in::framebuffer<void>{depth}, options);
    }
    return count;
}
inline in::image<int> hits(const in::mesh& m, int width, int height, in::draw_options options = {}) {
    return hits(m, width, height, pixel_space{width, height}, options);
}

inline int total(const in::image<int>& count) {
    int sum = 0;
    for (const int c : count.pixels()) sum += c;
    return sum;
}
inline int most(const in::image<int>& count) {
    int largest = 0;
    for (const int c : count.pixels()) largest = (std::max)(largest, c);
    return largest;
}

/// Whether a pixel's centre belongs to a triangle by the top-left rule: 128-bit integers on positions rounded to
/// 2^-bits pixels (ties to even), every pixel tested by itself. Shares no code with the rasterizer.
inline bool oracle_covers(const glm::dvec2 (&corner)[3], int px, int py, int bits) {
    __extension__ using wide = __int128;
    const double unit = std::ldexp(1.0, bits);
    wide x[3], y[3];
    for (int i = 0; i < 3; ++i) {
        x[i] = static_cast<wide>(std::nearbyint(corner[i].x * unit));
        y[i] = static_cast<wide>(std::nearbyint(corner[i].y * unit));
    }
    const wide cx = (static_cast<wide>(2 * px + 1)) << (bits - 1), cy = (static_cast<wide>(2 * py + 1)) << (bits - 1);
    const wide area = (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]);
    if (area == 0) return false;
    for (int i = 0; i < 3; ++i) {
        const int j = area > 0 ? (i + 1) % 3 : (i + 2) % 3;  // walk clockwise on the screen
        const wide dx = x[j] - x[i], dy = y[j] - y[i];
        const wide side = dx * (cy - y[i]) - dy * (cx - x[i]);
        const bool top = dy == 0 && dx > 0, left = dy < 0;
        if (side < 0 || (side == 0 && !top && !left)) return false;
    }
    return true;
}

}  // namespace testing_raster
