// Drawing in pixel coordinates, and an independent, slow oracle of coverage: shared by the raster tests.
#pragma once

#include <insonify/core/image.hpp>
#include <insonify/raster/draw.hpp>

#include <cmath>

#include <glm/vec2.hpp>

namespace testing_raster {

namespace in = insonify;

__extension__ using wide_float = __float128;

/// Vertices are (x, y, z): pixels from the top left corner, and depth. Exact where the size is a power of two.
struct pixel_space {
    int width, height;
    glm::vec4 operator()(const in::vertex& v) const {
        const auto w = static_cast<float>(width), h = static_cast<float>(height);
        return {v.position.x / w * 2 - 1, 1 - v.position.y / h * 2, v.position.z, 1.0f};
    }
};

/// How often each pixel is covered, every triangle drawn by itself.
inline in::image<int> hits(const in::mesh& m, int width, int height, auto&& place, in::draw_options<> options = {}) {
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
inline in::image<int> hits(const in::mesh& m, int width, int height, in::draw_options<> options = {}) {
    return hits(m, width, height, pixel_space{width, height}, options);
}

inline int total(const in::image<int>& count) {
    int sum = 0;
    for (const int c : count.pixels()) sum += c;
    return sum;
}
inline int max_count(const in::image<int>& count) {
    int largest = 0;
    for (const int c : count.pixels()) largest = (std::max)(largest, c);
    return largest;
}

/// Where a clip position lies, in pixels from the top left corner.
inline glm::dvec2 on_screen(const glm::dvec4& clip, int width, int height) {
    return {clip.x / clip.w * width / 2 + width / 2.0, -(clip.y / clip.w) * height / 2 + height / 2.0};
}

/// Whether a pixel's centre belongs to a triangle by the top-left rule: 128-bit integers on positions rounded to
/// 2^-bits pixels (ties to even), every pixel tested by itself. Shares no code with the rasterizer.
class oracle {
  public:
    oracle(const glm::dvec2 (&corner)[3], int bits) : bits_(bits) {
        for (int i = 0; i < 3; ++i) {
            x_[i] = static_cast<wide>(std::nearbyint(std::ldexp(corner[i].x, bits)));
            y_[i] = static_cast<wide>(std::nearbyint(std::ldexp(corner[i].y, bits)));
        }
        area_ = (x_[1] - x_[0]) * (y_[2] - y_[0]) - (y_[1] - y_[0]) * (x_[2] - x_[0]);
    }

    bool covers(int px, int py) const {
        if (area_ == 0) return false;
        const wide cx = static_cast<wide>(2 * px + 1) << (bits_ - 1), cy = static_cast<wide>(2 * py + 1) << (bits_ - 1);
        for (int i = 0; i < 3; ++i) {
            const int j = area_ > 0 ? (i + 1) % 3 : (i + 2) % 3;  // walk clockwise on the screen
            const wide dx = x_[j] - x_[i], dy = y_[j] - y_[i];
            const wide side = dx * (cy - y_[i]) - dy * (cx - x_[i]);
            const bool top = dy == 0 && dx > 0, left = dy < 0;
            if (side < 0 || (side == 0 && !top && !left)) return false;
        }
        return true;
    }

    bool is_clockwise() const { return area_ > 0; }

    /// z(px, py) of the plane through the corners, to 113 bits.
    wide_float depth(int px, int py, const double (&z)[3]) const {
        wide_float sum = 0;
        for (int i = 0; i < 3; ++i) sum += opposite_area(i, px, py) * static_cast<wide_float>(z[i]);
        return sum / static_cast<wide_float>(area_);
    }

    /// The same for a value that is linear in space: the mean with perspective-correct weights.
    template <class Values>
    wide_float varying(int px, int py, const Values& value, const wide_float (&inverse_w)[3]) const {
        wide_float sum = 0, weights = 0;
        for (int i = 0; i < 3; ++i) {
            const wide_float weight = opposite_area(i, px, py) * inverse_w[i];
            sum += weight * static_cast<wide_float>(value[static_cast<std::size_t>(i)]);
            weights += weight;
        }
        return sum / weights;
    }

  private:
    __extension__ using wide = __int128;

    /// Twice the area of the triangle opposite to a corner, relative to which weights are barycentric.
    wide_float opposite_area(int corner, int px, int py) const {
        const wide cx = static_cast<wide>(2 * px + 1) << (bits_ - 1), cy = static_cast<wide>(2 * py + 1) << (bits_ - 1);
        const int j = (corner + 1) % 3, k = (corner + 2) % 3;
        return static_cast<wide_float>((x_[k] - x_[j]) * (cy - y_[j]) - (y_[k] - y_[j]) * (cx - x_[j]));
    }

    int bits_;
    wide x_[3], y_[3], area_;
};

inline bool oracle_covers(const glm::dvec2 (&corner)[3], int px, int py, int bits) {
    return oracle(corner, bits).covers(px, py);
}

}  // namespace testing_raster
