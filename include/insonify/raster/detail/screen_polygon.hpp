// Clipped triangles on the pixel grid, divided into triangles or spans of pixels.
//
// Snapping can fold a thin polygon over itself: a vertex that lands on the wrong side of an edge flips one of the
// triangles that the polygon is divided into, and pixels beside the polygon would be hit. The winding number then
// decides pixel by pixel, by the same top-left rule.
#pragma once

#include <insonify/core/detail/int128.hpp>
#include <insonify/core/rect.hpp>
#include <insonify/raster/detail/clip.hpp>
#include <insonify/raster/detail/setup.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A clipped triangle with snapped corners.
class screen_polygon {
  public:
    screen_polygon(const clip_polygon& polygon, const projection& p) : count_(polygon.count) {
        for (int i = 0; i < count_; ++i)
            corners_[static_cast<std::size_t>(i)] = p.to_screen(polygon.corners[static_cast<std::size_t>(i)].position);
        int128 area;
        for (int i = 1; i + 1 < count_; ++i) {
            const int128 part = wide_area(at(0), at(i), at(i + 1));
            area = area + part;
            has_orientation_[part.sign() + 1] = true;
        }
        area_sign_ = area.sign();
        // The largest part that is oriented like the whole polygon.
        int128 largest{};
        for (int i = 1; i + 1 < count_; ++i) {
            const int128 part = wide_area(at(0), at(i), at(i + 1)), size = area_sign_ < 0 ? -part : part;
            if ((size - largest).sign() > 0) {
                largest = size;
                largest_part_ = i;
            }
        }
    }

    const screen_vertex& at(int corner) const { return corners_[static_cast<std::size_t>(corner)]; }
    /// 1 for clockwise on the screen, -1 for counter-clockwise, 0 for no area.
    int area_sign() const { return area_sign_; }

    /// The pixels of an image whose centres lie in the polygon's bounding box.
    rect pixels(const pixel_grid& grid) const {
        screen_vertex low = at(0), high = at(0);
        for (int i = 1; i < count_; ++i) {
            low.x = (std::min)(low.x, at(i).x), low.y = (std::min)(low.y, at(i).y);
            high.x = (std::max)(high.x, at(i).x), high.y = (std::max)(high.y, at(i).y);
        }
        return centre_rect(low, high, high, grid);
    }

    /// Calls `part(corners, pixels, is_span)` for disjoint parts of the polygon: triangles of three of its corners; or,
    /// if it is folded, spans of covered pixels in the plane of three of its corners.
    template <class Part>
    void for_each_part(const pixel_grid& grid, const Part& part) const {
        if (has_orientation_[0] && has_orientation_[2]) return for_each_span(grid, part);
        for (int i = 1; i + 1 < count_; ++i) {
            const rect pixels = centre_rect(at(0), at(i), at(i + 1), grid);
            if (!pixels.empty() && wide_area(at(0), at(i), at(i + 1)).sign() != 0)
                part(std::array<int, 3>{0, i, i + 1}, pixels, false);
        }
    }

  private:
    template <class Part>
    void for_each_span(const pixel_grid& grid, const Part& part) const {
        const std::array<int, 3> plane{0, largest_part_, largest_part_ + 1};
        const rect all = pixels(grid);
        for (int y = all.y0; y < all.y1; ++y) {
            const auto [begin, end] = crossed(y, all.x0, all.x1, grid);
            for (int x = begin; x < end; ++x) {
                if (winding(x, y, grid) * area_sign_ <= 0) continue;
                const int first = x;
                while (x < end && winding(x, y, grid) * area_sign_ > 0) ++x;
                part(plane, rect{first, y, x, y + 1}, true);
            }
        }
    }

    /// Of the pixels [begin, end) of a row, those between its outermost crossings of the outline, two more on either
    /// side for rounding. The winding number of all others is 0.
    std::pair<int, int> crossed(int py, int begin, int end, const pixel_grid& grid) const {
        const std::int64_t y = grid.centre(py);
        double left = end, right = begin;
        for (int i = 0; i < count_; ++i) {
            const screen_vertex &from = at(i), &to = at((i + 1) % count_);
            if ((from.y <= y) == (to.y <= y)) continue;
            const double share = static_cast<double>(y - from.y) / static_cast<double>(to.y - from.y);
            const double x = (static_cast<double>(from.x) + share * static_cast<double>(to.x - from.x)) /
                             static_cast<double>(grid.unit());
            left = (std::min)(left, x - 2), right = (std::max)(right, x + 2);
        }
        return {static_cast<int>((std::max)(left, static_cast<double>(begin))),
                static_cast<int>((std::min)(right, static_cast<double>(end)))};
    }

    /// The winding number of the outline around a pixel's centre, clockwise. The fill rule shifts the centre to the
    /// right by an infinitesimal amount, and downwards by one of second order.
    int winding(int px, int py, const pixel_grid& grid) const {
        const std::int64_t x = grid.centre(px), y = grid.centre(py);
        int sum = 0;
        for (int i = 0; i < count_; ++i) {
            const screen_vertex &from = at(i), &to = at((i + 1) % count_);
            const bool up = to.y <= y && y < from.y, down = from.y <= y && y < to.y;
            if (!up && !down) continue;
            const int side = wide_side(to.x - from.x, to.y - from.y, x - from.x, y - from.y).sign();
            if (up && side >= 0) ++sum;
            if (down && side <= 0) --sum;
        }
        return sum;
    }

    std::array<screen_vertex, 3 + clip_polygon::planes> corners_;
    int count_;
    bool has_orientation_[3] = {};  ///< whether a part runs counter-clockwise, is degenerate, runs clockwise
    int largest_part_ = 1;
    int area_sign_ = 0;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
