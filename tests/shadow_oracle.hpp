// Independent oracle of hard shadows: decides for each pixel of an overhead picture whether what it shows is lit, from
// the triangle shown and from the meshes as drawn. Shares no code with the library's raster and shadows.
//
// The rule. A pixel's point is where the ray through its centre meets the triangle shown. It is dark if the triangle's
// side towards the camera faces away from the light or is parallel to it, or if any other triangle, seen from either
// side, lies strictly between the point and the light. Nothing is culled.
//
// A picture's corners are rounded to sub-pixels, so a centre may miss the triangle shown. The point is then the one of
// the triangle's outline that is nearest on the screen, and triangles that touch it there don't block. Such pixels are
// `beside` and counted separately: visibility decides the triangle that they show, not shadows.
//
// Signs are computed in long double, of vectors from the point. What depends on less than 1e-12 of the lengths that are
// compared, or on whether another triangle passes within 1e-10 altitudes of the point, is undecided. Triangles in the
// plane of the one shown touch it and don't block, so coplanar duplicates are decided.
#pragma once

#include <insonify/all.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "ray_tree.hpp"

namespace shadow_oracle {

namespace in = insonify;

/// Vectors in long double.
using real = long double;
struct vector {
    real x = 0, y = 0, z = 0;

    vector() = default;
    vector(real right, real forward, real up) : x(right), y(forward), z(up) {}
    explicit vector(const glm::dvec3& p)
        : x(static_cast<real>(p.x)), y(static_cast<real>(p.y)), z(static_cast<real>(p.z)) {}

    friend vector operator+(const vector& a, const vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend vector operator-(const vector& a, const vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend vector operator*(real s, const vector& a) { return {s * a.x, s * a.y, s * a.z}; }
    glm::dvec3 rounded() const { return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}; }
};
inline real dot(const vector& a, const vector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline vector cross(const vector& a, const vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline real size(const vector& a) {
    return std::abs(a.x) + std::abs(a.y) + std::abs(a.z);
}

enum class verdict : std::uint8_t {
    empty,  ///< the pixel shows nothing
    lit,
    dark,
    undecided,
};

struct judged_pixel {
    verdict answer = verdict::empty;
    bool beside = false;  ///< its centre misses the triangle shown
};

/// Pixels in which a picture and the oracle differ.
struct tally {
    std::int64_t shown = 0, undecided = 0;
    std::int64_t false_dark = 0, false_lit = 0;
    std::int64_t beside = 0, beside_wrong = 0;  ///< counted here alone

    std::int64_t wrong() const { return false_dark + false_lit; }
    double share() const { return share_of(wrong()); }
    double share_with_beside() const { return share_of(wrong() + beside_wrong); }
    tally& operator+=(const tally& t) {
        shown += t.shown, undecided += t.undecided;
        false_dark += t.false_dark, false_lit += t.false_lit;
        beside += t.beside, beside_wrong += t.beside_wrong;
        return *this;
    }

  private:
    double share_of(std::int64_t pixels) const {
        // Of no pixels it is NaN, so that an empty picture is not a right one.
        return static_cast<double>(pixels) / static_cast<double>(shown);
    }
};

/// The triangles of a scene in a rig's frame, prepared for rays.
class oracle {
  public:
    /// @param s  without a library seabed: its bottom is one of the targets
    oracle(const in::scene& s, const in::overhead& rig) : unit_(static_cast<double>(rig.altitude)) {
        in::detail::require(s.seabed.empty(), "scene.seabed.empty()", s.seabed.empty(), "true");
        const in::overhead_geometry view(rig);
        first_.push_back(0);
        for (const in::target& t : s.targets) {
            first_.push_back(triangles_.size());
            const in::affine place = view.rig_from(in::to_world(t.placement));
            const auto at = [&](std::uint32_t i) { return in::transform_point(place, t.shape->positions.at(i)); };
            for (const glm::uvec3& i : t.shape->triangles) triangles_.push_back({at(i.x), at(i.y), at(i.z)});
        }
        tree_ = ray_tree(triangles_, unit_);
    }

    std::size_t triangles() const { return triangles_.size(); }

    /// @param rig    of the same position, yaw and altitude as the oracle's; size, field of view and light are free
    /// @param shown  the triangle that each pixel of its picture shows
    template <in::executor_argument E = in::serial_executor>
    in::image<judged_pixel> judge(const in::overhead& rig, const in::visibility& shown, E&& ex = {}) const {
        const source light = light_of(rig);
        const double step = 2 * std::tan(0.5 * static_cast<double>(rig.field_of_view)) / rig.size.x;
        in::image<judged_pixel> all(rig.size.x, rig.size.y);
        ex.bulk(static_cast<std::size_t>(rig.size.y), [&](std::size_t row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < rig.size.x; ++x) {
                const std::uint32_t triangle = shown.triangle(x, y);
                if (triangle == in::visibility::no_triangle) continue;
                const vector ray(
                    glm::dvec3(step * (x + 0.5 - 0.5 * rig.size.x), step * (0.5 * rig.size.y - y - 0.5), -1));
                all(x, y) = judge_one(light, ray, first_[shown.instance(x, y)] + triangle);
            }
        });
        return all;
    }

  private:
    /// Light in the rig's frame: the direction to it, or its position.
    struct source {
        bool is_near;
        vector at;
    };
    static source light_of(const in::overhead& rig) {
        const auto azimuth = static_cast<real>(rig.light_azimuth), elevation = static_cast<real>(rig.grazing);
        const vector toward(-std::cos(azimuth) * std::cos(elevation), -std::sin(azimuth) * std::cos(elevation),
                            std::sin(elevation));
        if (!std::isfinite(rig.light_distance)) return {false, toward};
        return {true, static_cast<real>(rig.light_distance) * toward};
    }

    vector eye() const { return {0, 0, static_cast<real>(unit_)}; }

    static constexpr real tiny = 1e-12L;

    /// d . (b x c) of an edge from b to c, seen from the origin: on which side of it a ray along d passes. Its sign is
    /// 0 where the ray passes closer than `tiny` of the distance.
    struct edge_side {
        real value;
        int sign;

        edge_side(const vector& d, const vector& b, const vector& c, real error) {
            const vector &nearer = size(b) < size(c) ? b : c, edge = c - b;
            value = dot(d, cross(nearer, edge));
            const real bound = (tiny * size(nearer) + error) * size(edge) * size(d);
            sign = value > bound ? 1 : value < -bound ? -1 : 0;
        }
    };

    /// A triangle's plane: normal . p = offset, for points seen from the origin.
    struct plane {
        vector normal;
        real offset;

        /// Anchored at the nearest corner: with a corner at 1e38 m, cancellation would leave no digits.
        plane(const vector& a, const vector& b, const vector& c) {
            const bool a_first = size(a) <= size(b) && size(a) <= size(c), b_first = size(b) <= size(c);
            const vector &p = a_first   ? a
                              : b_first ? b
                                        : c,
                         &q = a_first   ? b
                              : b_first ? c
                                        : a,
                         &r = a_first   ? c
                              : b_first ? a
                                        : b;
            normal = cross(q - p, r - p);
            offset = dot(normal, p);
        }
    };

    struct receiver {
        vector point;
        vector normal;  ///< on the side of the camera
        std::size_t triangle;
        bool beside, is_edge_on;
    };

    judged_pixel judge_one(const source& light, const vector& ray, std::size_t triangle) const {
        const receiver at = receiver_at(ray, triangle);
        return {decide(light, at), at.beside};
    }

    receiver receiver_at(const vector& ray, std::size_t id) const {
        const triangle& t = triangles_[id];
        const vector a = vector(t.a) - eye(), b = vector(t.b) - eye(), c = vector(t.c) - eye();
        const plane p(a, b, c);
        const real along = dot(p.normal, ray), limit = 1e-15L;
        const auto side = [&](const vector& from, const vector& to) {
            const edge_side e(ray, from, to, 0);
            return std::abs(e.value) <= limit * size(ray) * size(from) * size(to - from) ? 0 : e.value > 0 ? 1 : -1;
        };
        const int sides[] = {side(b, c), side(c, a), side(a, b)};
        const auto [lowest, highest] = std::minmax({sides[0], sides[1], sides[2]});
        receiver at{{}, p.normal, id, lowest * highest < 0 || along == 0 || p.offset / along <= 0, false};
        const vector from_eye = at.beside ? nearest_on_outline(ray, {a, b, c}) : p.offset / along * ray;
        at.point = eye() + from_eye;
        const real facing = -dot(p.normal, ray);
        at.is_edge_on = std::abs(facing) <= tiny * size(p.normal) * size(ray);
        if (facing < 0) at.normal = -1 * p.normal;
        return at;
    }

    /// The point on a triangle's edges that appears nearest to a ray. Vectors start at the eye; parts above it are
    /// skipped.
    vector nearest_on_outline(const vector& ray, const std::array<vector, 3>& corners) const {
        const real z_near = -1e-6L * static_cast<real>(unit_);
        real closest = std::numeric_limits<real>::infinity();
        vector nearest = corners[0];
        for (std::size_t i = 0; i < 3; ++i) {
            vector p = corners[i], q = corners[(i + 1) % 3];
            if (p.z > z_near && q.z > z_near) continue;
            const vector cut = p + (z_near - p.z) / (q.z - p.z) * (q - p);
            if (p.z > z_near) p = cut;
            if (q.z > z_near) q = cut;
            const real px = -p.x / p.z, py = -p.y / p.z, dx = -q.x / q.z - px, dy = -q.y / q.z - py;
            const real square = dx * dx + dy * dy;
            const real way = square > 0 ? ((ray.x - px) * dx + (ray.y - py) * dy) / square : 0;
            const real clamped = std::clamp<real>(way, 0, 1);
            const real off = std::hypot(px + clamped * dx - ray.x, py + clamped * dy - ray.y);
            if (off >= closest) continue;
            closest = off;
            const real weight_p = (1 - clamped) / p.z, weight_q = clamped / q.z;  // perspective-correct
            nearest = p + weight_q / (weight_p + weight_q) * (q - p);
        }
        return nearest;
    }

    verdict decide(const source& light, const receiver& at) const {
        const vector toward = light.is_near ? light.at - at.point : light.at;
        const real facing = dot(at.normal, toward);
        bool unsure = at.is_edge_on || std::abs(facing) <= tiny * size(at.normal) * size(toward);
        if (!unsure && facing < 0) return verdict::dark;
        bool dark = false;
        const double end = light.is_near ? 1 : std::numeric_limits<double>::infinity();
        const glm::dvec3 from = at.point.rounded(), direction = toward.rounded();
        tree_.along(from, direction, end, [&](std::uint32_t id) {
            if (id == at.triangle || is_missed(triangles_[id], from, direction)) return false;
            switch (test_triangle(light, at, toward, id)) {
                case verdict::dark: dark = true; break;
                case verdict::undecided: unsure = true; break;
                default: break;
            }
            return dark;
        });
        return dark ? verdict::dark : unsure ? verdict::undecided : verdict::lit;
    }

    /// Whether a ray clearly misses a triangle. Computed in double, so that few triangles need long double.
    bool is_missed(const triangle& t, const glm::dvec3& from, const glm::dvec3& d) const {
        const glm::dvec3 a = t.a - from, b = t.b - from, c = t.c - from;
        const auto size = [](const glm::dvec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); };
        bool left = false, right = false;
        const auto pass = [&](const glm::dvec3& p, const glm::dvec3& q) {
            const glm::dvec3 &nearer = size(p) < size(q) ? p : q, edge = q - p;
            const double value = d.x * (nearer.y * edge.z - nearer.z * edge.y) +
                                 d.y * (nearer.z * edge.x - nearer.x * edge.z) +
                                 d.z * (nearer.x * edge.y - nearer.y * edge.x);
            const double bound = 1e-10 * (size(nearer) + unit_) * size(edge) * size(d);
            left |= value > bound;
            right |= value < -bound;
        };
        pass(a, b), pass(b, c), pass(c, a);
        return left && right;
    }

    /// Whether one triangle blocks the light (dark), does not (lit), or is too close to tell (undecided).
    verdict test_triangle(const source& light, const receiver& at, const vector& toward, std::uint32_t id) const {
        const triangle& t = triangles_[id];
        const vector a = vector(t.a) - at.point, b = vector(t.b) - at.point, c = vector(t.c) - at.point;
        const plane p(a, b, c);
        if (size(p.normal) == 0) return verdict::lit;  // no area
        const real error = 1e-16L * static_cast<real>(unit_);
        const int sides[] = {edge_side(toward, b, c, error).sign, edge_side(toward, c, a, error).sign,
                             edge_side(toward, a, b, error).sign};
        const auto [lowest, highest] = std::minmax({sides[0], sides[1], sides[2]});
        if (lowest < 0 && highest > 0) return verdict::lit;
        const bool is_hit = lowest == highest && lowest != 0;
        const real along = dot(p.normal, toward);
        if (std::abs(along) <= tiny * size(p.normal) * size(toward)) return verdict::undecided;
        const real way = p.offset / along, touch = 1e-10L * static_cast<real>(unit_) / size(toward);
        if (way < -touch) return verdict::lit;
        if (way <= touch) return at.beside || is_coplanar(at, a, b, c) ? verdict::lit : verdict::undecided;
        if (light.is_near && way > 1 + tiny) return verdict::lit;
        if (light.is_near && way > 1 - tiny) return verdict::undecided;
        return is_hit ? verdict::dark : verdict::undecided;
    }

    /// Whether a triangle lies in the plane of the one shown; corners are seen from the point.
    bool is_coplanar(const receiver& at, const vector& a, const vector& b, const vector& c) const {
        const auto is_in_plane = [&](const vector& p) {
            return std::abs(dot(at.normal, p)) <= tiny * size(at.normal) * (size(p) + static_cast<real>(unit_));
        };
        return is_in_plane(a) && is_in_plane(b) && is_in_plane(c);
    }

    double unit_;  ///< the altitude, metres
    std::vector<triangle> triangles_;
    std::vector<std::size_t> first_;  ///< triangle of an instance
    ray_tree tree_;
};

/// @param is_dark  of (x, y): whether the picture shows shadow there
template <class Dark>
tally compare(const in::image<judged_pixel>& truth, const Dark& is_dark) {
    tally t;
    for (int y = 0; y < truth.height(); ++y)
        for (int x = 0; x < truth.width(); ++x) {
            const judged_pixel& p = truth(x, y);
            if (p.answer == verdict::empty) continue;
            ++t.shown;
            t.beside += p.beside;
            t.undecided += p.answer == verdict::undecided;
            if (p.answer == verdict::undecided || is_dark(x, y) == (p.answer == verdict::dark)) continue;
            if (p.beside)
                ++t.beside_wrong;
            else
                ++(p.answer == verdict::lit ? t.false_dark : t.false_lit);
        }
    return t;
}
inline tally compare(const in::image<judged_pixel>& truth, const in::labels& labels) {
    return compare(truth, [&](int x, int y) { return labels.shadow(x, y) != in::labels::no_shadow; });
}

}  // namespace shadow_oracle
