// Selects the vertices of a heightfield that a mesh needs for a given tolerance.
//
// The hierarchy bisects right triangles at the midpoint of their longest side. The midpoint is a vertex of the grid,
// and the two triangles that share the side are bisected together: the mesh has no T-junctions. Whether a triangle may
// stay whole is tested against every height within it, from small triangles to large ones; a bisected triangle forces
// the bisection of all that contain it.
//
// Based on: William Evans, David Kirkpatrick, Gregg Townsend. Right-Triangulated Irregular Networks. Algorithmica 30,
// 2001.
#pragma once

#include <insonify/core/simd/lanes.hpp>
#include <insonify/seabed/tessellate.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// Largest deviations of a mesh from its heightfield.
struct tolerance {
    double height = 0;  ///< metres, anywhere, >= 0
    /// Of the rises per metre along x and y that normals are made of, >= 0.
    double slope = (std::numeric_limits<double>::infinity)();
    /// Square metres: at a distance r from `nadir`, heights may be off by at most lean / r. A camera above `nadir`
    /// shows a height error h as a displacement of h r / altitude, so lean = altitude x the tolerated displacement on
    /// the ground.
    double lean = (std::numeric_limits<double>::infinity)();
    glm::dvec2 nadir{0.0, 0.0};  ///< below the camera, metres from the heightfield's vertex (0, 0)
};

namespace detail::inline INSONIFY_FLAGS {

/// Flags the vertices of a heightfield that a mesh needs. Vertices of the hierarchy are midpoints of longest sides. At
/// step s, the lowest set bit of one coordinate is s ("edges": the side lies along an axis) or that of both is
/// ("centres": the side is a diagonal).
class needed_vertices {
  public:
    template <executor E>
    needed_vertices(const heightfield& field, const tolerance& allowed, E& ex)
        : field_(field),
          allowed_(allowed),
          columns_(field.heights.width() - 1),
          rows_(field.heights.height() - 1),
          needed_(field.heights.width(), field.heights.height(), 0) {
        if (allowed.slope < (std::numeric_limits<double>::infinity)()) find_slopes(ex);
        while (size_ < (std::max)(columns_, rows_)) size_ *= 2;
        for (int step = 1; step < size_; step *= 2) {
            visit(step, false, ex);
            if (step == 1) pair_up_cells();
            visit(step, true, ex);
        }
    }

    bool operator()(int x, int y) const { return inside(x, y) && needed_(x, y) != 0; }
    bool inside(int x, int y) const { return x >= 0 && y >= 0 && x <= columns_ && y <= rows_; }
    /// Cells along a side of the hierarchy's square.
    int size() const { return size_; }

    /// Whether the hierarchy's diagonal of the square around a centre (x, y) of this step rises from its lower left
    /// corner. It points to the centre of the parent square.
    static bool rises(int x, int y, int step) { return ((x ^ y) & (2 * step)) == 0; }

    /// The step of the hierarchy's vertices, 0 at its corners.
    static int step_of(int x, int y) { return (x | y) & -(x | y); }

  private:
    struct point {
        int x, y;
    };

    template <executor E>
    void find_slopes(E& ex) {
        slope_x_ = image<float>(columns_ + 1, rows_ + 1);
        slope_y_ = image<float>(columns_ + 1, rows_ + 1);
        ex.bulk(static_cast<std::size_t>(rows_) + 1, [&](std::size_t j) {
            const row_rises rises(field_.heights, static_cast<int>(j));
            const auto x = slope_x_.row(static_cast<int>(j)), y = slope_y_.row(static_cast<int>(j));
            for (std::size_t i = 0; i < x.size(); ++i) {
                x[i] = 0.5f * rises.x(i);
                y[i] = 0.5f * rises.y(i);
            }
        });
    }

    /// All edges or all centres of one step.
    template <executor E>
    void visit(int step, bool centres, E& ex) {
        const int stride = centres ? 2 * step : step;  // from row to row
        const int first = centres ? step : 0;
        if (first > rows_) return;
        ex.bulk(static_cast<std::size_t>((rows_ - first) / stride + 1), [&](std::size_t row) {
            const int y = first + static_cast<int>(row) * stride;
            const int from = centres || (y & step) == 0 ? step : 0;
            for (int x = from; x <= columns_; x += 2 * step)
                needed_(x, y) = centres ? is_centre_needed(x, y, step) : is_edge_needed(x, y, step);
        });
    }

    bool is_centre_needed(int x, int y, int s) const {
        if (needed(x - s, y) || needed(x + s, y) || needed(x, y - s) || needed(x, y + s)) return true;
        if (x + s > columns_ || y + s > rows_) return true;  // partly outside of the field
        const double height = height_allowed({x - s, y - s}, {x + s, y + s});
        const bool up = rises(x, y, s);
        const point a{x - s, up ? y - s : y + s}, b{x + s, up ? y + s : y - s};
        return !fits(a, b, {b.x, a.y}, height) || !fits(a, b, {a.x, b.y}, height);
    }

    bool is_edge_needed(int x, int y, int s) const {
        if (s > 1) {
            const int h = s / 2;
            if (needed(x - h, y - h) || needed(x + h, y - h) || needed(x - h, y + h) || needed(x + h, y + h))
                return true;
        }
        // The longest side lies along x or y, with a triangle on either side.
        const bool along_x = (x & s) != 0;
        const point reach = along_x ? point{s, 0} : point{0, s};
        const point a{x - reach.x, y - reach.y}, b{x + reach.x, y + reach.y};
        const double height = height_allowed({x - s, y - s}, {x + s, y + s});
        for (const int side : {-s, s}) {
            const point tip = along_x ? point{x, y + side} : point{x + side, y};
            if (tip.x < 0 || tip.y < 0 || (along_x ? (side > 0 && y == rows_) : (side > 0 && x == columns_))) continue;
            if (!inside(b.x, b.y) || !inside(tip.x, tip.y)) return true;  // partly outside of the field
            if (!fits(a, b, tip, height)) return true;
        }
        return false;
    }

    /// Cells with a falling diagonal, of which one half belongs to a larger triangle: where the choice of the diagonal
    /// exceeds the tolerance, both halves become small triangles, with the heightfield's own diagonal.
    void pair_up_cells() {
        for (bool changed = true; changed;) {
            changed = false;
            for (int y = 0; y < rows_; ++y)
                for (int x = (y & 1) ^ 1; x < columns_; x += 2) {
                    std::uint8_t &low = needed_(x, y), &high = needed_(x + 1, y + 1);
                    if (low == high) continue;
                    const auto& h = field_.heights;
                    const float twist = 0.5f * (h(x, y) + h(x + 1, y + 1) - h(x + 1, y) - h(x, y + 1));
                    if (within(twist, height_allowed({x, y}, {x + 1, y + 1}))) continue;
                    low = high = 1;
                    changed = true;
                }
        }
    }

    bool needed(int x, int y) const { return (*this)(x, y); }

    /// False for NaN.
    static bool within(float off, double allowed) {
        return static_cast<double>(off) <= allowed && static_cast<double>(-off) <= allowed;
    }

    /// Height tolerance of triangles in a box: the least over its corners.
    double height_allowed(const point& low, const point& high) const {
        if (!(allowed_.lean < (std::numeric_limits<double>::infinity)())) return allowed_.height;
        const auto farthest = [](double a, double b) { return (std::max)(a * a, b * b); };
        const glm::dvec2 to_nadir = allowed_.nadir / field_.spacing;
        const double square =
            farthest(low.x - to_nadir.x, high.x - to_nadir.x) + farthest(low.y - to_nadir.y, high.y - to_nadir.y);
        const double distance = field_.spacing * numeric::square_root(square);
        return allowed_.height * distance > allowed_.lean ? allowed_.lean / distance : allowed_.height;
    }

    /// Whether the triangle (a, b, tip), with its longest side from a to b, is within tolerance of all samples in it.
    bool fits(const point& a, const point& b, const point& tip, double height) const {
        const double slope = allowed_.slope * field_.spacing;
        const bool check_slopes = !slope_x_.empty();
        // Most rejections are at the midpoint of a side, and the smallest triangles have no other vertices.
        const auto middles_fit = [&](const image<float>& values, double allowed) {
            return fits_middle(values, a, b, allowed) && fits_middle(values, b, tip, allowed) &&
                   fits_middle(values, tip, a, allowed);
        };
        if (!middles_fit(field_.heights, height)) return false;
        if (check_slopes && !(middles_fit(slope_x_, slope) && middles_fit(slope_y_, slope))) return false;
        if (!fits_falling(a, b, height) || !fits_falling(b, tip, height) || !fits_falling(tip, a, height)) return false;
        const bool has_more = (std::max)(a.x > b.x ? a.x - b.x : b.x - a.x, a.y > b.y ? a.y - b.y : b.y - a.y) > 2;
        if (has_more) {
            const plane planes[] = {
                {field_.heights, height, a, b, tip}, {slope_x_, slope, a, b, tip}, {slope_y_, slope, a, b, tip}};
            const int count = check_slopes ? 3 : 1;
            const bool all = each_row(a, b, tip, [&](int y, int first, int last) {
                for (int i = 0; i < count; ++i)
                    if (!planes[i].fits_row(y, first, last)) return false;
                return true;
            });
            if (!all) return false;
        }
        return field_.types.empty() || has_one_type(a, b, tip);
    }

    static bool fits_middle(const image<float>& values, const point& p, const point& q, double allowed) {
        const int x = p.x + q.x, y = p.y + q.y;
        return ((x | y) & 1) != 0 ||
               within(0.5f * (values(p.x, p.y) + values(q.x, q.y)) - values(x / 2, y / 2), allowed);
    }

    /// Calls `visit(y, first, last)` for each row of a triangle's vertices until it returns false.
    template <class Visit>
    static bool each_row(const point& a, const point& b, const point& c, const Visit& visit) {
        struct side {
            point low;
            int top, lean;  // lean: columns to the right per row
            side(const point& p, const point& q) : low(p.y < q.y ? p : q), top((std::max)(p.y, q.y)) {
                const int across = (p.y < q.y ? q.x : p.x) - low.x;
                lean = across > 0 ? 1 : across < 0 ? -1 : 0;  // sides are level, upright or diagonal
            }
        };
        const side sides[] = {{a, b}, {b, c}, {c, a}};
        const int y0 = (std::min)((std::min)(a.y, b.y), c.y), y1 = (std::max)((std::max)(a.y, b.y), c.y);
        for (int y = y0; y <= y1; ++y) {
            int first = (std::numeric_limits<int>::max)(), last = -1;
            for (const side& s : sides) {
                if (s.low.y == s.top || y < s.low.y || y > s.top) continue;
                const int x = s.low.x + s.lean * (y - s.low.y);
                first = (std::min)(first, x);
                last = (std::max)(last, x);
            }
            if (!visit(y, first, last)) return false;
        }
        return true;
    }

    /// The plane through the values at three vertices, with the tolerance of others.
    class plane {
      public:
        plane(const image<float>& values, double allowed, const point& a, const point& b, const point& c)
            : values_(values), from_(a), tolerance_(static_cast<float>(allowed)) {
            if (values.empty()) return;
            const auto abx = static_cast<float>(b.x - a.x), aby = static_cast<float>(b.y - a.y);
            const auto acx = static_cast<float>(c.x - a.x), acy = static_cast<float>(c.y - a.y);
            at_ = values(a.x, a.y);
            const float ab = values(b.x, b.y) - at_, ac = values(c.x, c.y) - at_;
            const float inverse = 1 / (abx * acy - acx * aby);
            dx_ = (ab * acy - ac * aby) * inverse;
            dy_ = (ac * abx - ab * acx) * inverse;
        }

        bool fits_row(int y, int first, int last) const {
            using namespace insonify::detail;
            constexpr int N = INSONIFY_SIMD ? 4 : 1;
            using floats = lanes<float, N>;
            using ints = lanes<std::int32_t, N>;
            const float* const row = values_.row(y).data();
            const float start = at_ + dy_ * static_cast<float>(y - from_.y);
            floats across;
            iota<float, N>(across);
            int x = first;
            for (; x + N <= last + 1; x += N) {
                floats value;
                load(value, row + x);
                const floats off = value - (start + dx_ * (across + static_cast<float>(x - from_.x)));
                const ints fit = (off <= tolerance_) & (-off <= tolerance_);
                const ints missed = fit == 0;
                if (insonify::detail::any(missed)) return false;
            }
            for (; x <= last; ++x) {
                const float off = row[x] - (start + dx_ * static_cast<float>(x - from_.x));
                if (!(off <= tolerance_ && -off <= tolerance_)) return false;
            }
            return true;
        }

      private:
        const image<float>& values_;
        point from_;
        float tolerance_, at_ = 0, dx_ = 0, dy_ = 0;
    };

    /// A falling side crosses the rising diagonals of the heightfield's cells at their midpoints.
    bool fits_falling(const point& p, const point& q, double allowed) const {
        const int length = q.x - p.x;
        if (length != p.y - q.y || length == 0) return true;
        const auto& h = field_.heights;
        const point &left = length > 0 ? p : q, &right = length > 0 ? q : p;
        const int cells = right.x - left.x;
        const float start = h(left.x, left.y);
        const float rise = (h(right.x, right.y) - start) / static_cast<float>(cells);
        for (int i = 0; i < cells; ++i) {
            const int x = left.x + i, y = left.y - i;  // the cell's upper left corner
            const float here = 0.5f * (h(x, y - 1) + h(x + 1, y));
            if (!within(here - (start + rise * (static_cast<float>(i) + 0.5f)), allowed)) return false;
        }
        return true;
    }

    bool has_one_type(const point& a, const point& b, const point& tip) const {
        const type kind = field_.types(a.x, a.y);
        return each_row(a, b, tip, [&](int y, int first, int last) {
            const auto row = field_.types.row(y).subspan(static_cast<std::size_t>(first),
                                                         static_cast<std::size_t>(last - first + 1));
            return std::all_of(row.begin(), row.end(), [=](type t) { return t == kind; });
        });
    }

    const heightfield& field_;
    tolerance allowed_;
    int columns_, rows_, size_ = 1;
    image<std::uint8_t> needed_;
    image<float> slope_x_, slope_y_;  // rises per cell, or empty where slopes may be anything
};

}  // namespace detail::inline INSONIFY_FLAGS

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
