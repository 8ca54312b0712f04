// A mesh under a light, points to test, and a brute-force oracle: every triangle along every ray.
#pragma once

#include <insonify/core/random.hpp>
#include <insonify/shadow/exact.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>

namespace lit {

namespace in = insonify;
namespace shadow = insonify::shadow;

inline double radians(double degrees) {
    return in::numeric::to_radians(degrees);
}
/// Degrees.
inline shadow::directional_light parallel(double azimuth, double elevation) {
    return {radians(azimuth), radians(elevation)};
}

/// Points, each on a triangle of a caster or on none.
class point_list {
  public:
    point_list() = default;
    point_list(const std::vector<glm::dvec3>& free) {
        for (const glm::dvec3& p : free) add(p);
    }
    void add(const glm::dvec3& p, std::uint32_t mesh = shadow::invalid_id,
             std::uint32_t triangle = shadow::invalid_id) {
        x_.push_back(p.x), y_.push_back(p.y), z_.push_back(p.z);
        mesh_.push_back(mesh), triangle_.push_back(triangle);
    }
    std::size_t size() const { return x_.size(); }
    glm::dvec3 operator[](std::size_t i) const { return {x_[i], y_[i], z_[i]}; }
    std::uint32_t triangle(std::size_t i) const { return triangle_[i]; }
    operator shadow::points() const { return {x_, y_, z_, mesh_, triangle_}; }
    /// The same points, on no mesh.
    point_list detached() const {
        point_list free;
        for (std::size_t i = 0; i < size(); ++i) free.add((*this)[i]);
        return free;
    }
    in::bounding_box box() const {
        in::bounding_box all;
        for (std::size_t i = 0; i < size(); ++i) all = in::include(all, (*this)[i]);
        return all;
    }

  private:
    std::vector<double> x_, y_, z_;
    std::vector<std::uint32_t> mesh_, triangle_;
};

/// A policy's results for some points.
struct answers {
    std::vector<float> lit;
    std::vector<std::uint32_t> caster;

    explicit answers(std::size_t count) : lit(count, -1.0f), caster(count, 7) {}
    operator shadow::results() { return {lit, caster}; }
    std::vector<bool> dark() const {
        std::vector<bool> all;
        for (const float fraction : lit) all.push_back(fraction == 0);
        return all;
    }
};

template <class Occlusion>
answers test(const Occlusion& structure, const shadow::points& at) {
    answers all(at.size());
    structure.test(at, all);
    return all;
}

inline shadow::caster caster_of(const in::mesh& m, const in::affine& place = {}) {
    return {m, place, in::bounds(m)};
}

/// A mesh that casts exact shadows, tested at any points.
class mesh {
  public:
    mesh(in::mesh m, const shadow::any_light& light, const in::affine& place = {})
        : mesh_(std::move(m)), light_(light), place_(place) {}

    const in::mesh& operator*() const { return mesh_; }
    const in::mesh* operator->() const { return &mesh_; }

    template <in::executor_argument E = in::serial_executor>
    std::vector<bool> dark(const point_list& points, const in::bounding_box& within, E&& ex = {}) const {
        const shadow::caster casters[] = {caster_of(mesh_, place_)};
        return test(shadow::exact{}.build(casters, light_, {within}, ex), points).dark();
    }
    template <in::executor_argument E = in::serial_executor>
    std::vector<bool> dark(const point_list& points, E&& ex = {}) const {
        return dark(points, points.box(), ex);
    }
    bool is_dark(const glm::dvec3& p) const {
        point_list one;
        one.add(p);
        return dark(one)[0];
    }

    glm::dvec3 toward(const glm::dvec3& p) const {
        if (const auto* parallel = std::get_if<shadow::directional_light>(&light_))
            return shadow::light_frame(*parallel).to_light();
        return std::get<shadow::point_light>(light_).position - p;
    }
    glm::dvec3 corner(std::uint32_t triangle, int i) const {
        return in::transform_point(place_, glm::dvec3(mesh_.positions[mesh_.triangles[triangle][i]]));
    }
    glm::dvec3 normal(std::uint32_t triangle) const {
        return glm::cross(corner(triangle, 1) - corner(triangle, 0), corner(triangle, 2) - corner(triangle, 0));
    }

    /// Points on facets whose front faces the light.
    point_list facing(std::size_t count, std::uint64_t seed) const { return sampled(count, seed, 1); }
    /// Points on facets whose front faces away from it.
    point_list facing_away(std::size_t count, std::uint64_t seed) const { return sampled(count, seed, -1); }

    /// Number of points whose result differs from the oracle's.
    int wrong(const point_list& points) const { return wrong(points, dark(points)); }
    int wrong(const point_list& points, const std::vector<bool>& dark) const {
        int count = 0;
        for (std::size_t i = 0; i < points.size(); ++i)
            count += dark[i] != is_blocked(points[i], points.triangle(i)) ? 1 : 0;
        return count;
    }
    /// Whether a triangle other than its own is on the way from a point to the light.
    bool is_blocked(const glm::dvec3& from, std::uint32_t own = shadow::invalid_id) const {
        const glm::dvec3 along = toward(from);
        const double end =
            std::holds_alternative<shadow::point_light>(light_) ? 1 - 1e-9 : std::numeric_limits<double>::infinity();
        for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
            if (i == own) continue;
            const glm::dvec3 a = corner(i, 0), ab = corner(i, 1) - a, ac = corner(i, 2) - a;
            const glm::dvec3 p = glm::cross(along, ac), s = from - a, q = glm::cross(s, ab);
            const double determinant = glm::dot(ab, p);
            if (determinant == 0) continue;
            const double u = glm::dot(s, p) / determinant, v = glm::dot(along, q) / determinant;
            const double hit = glm::dot(ac, q) / determinant;
            if (u >= 0 && v >= 0 && u + v <= 1 && hit > 1e-9 && hit < end) return true;
        }
        return false;
    }

  private:
    point_list sampled(std::size_t count, std::uint64_t seed, double side) const {
        in::random_sequence random(seed);
        point_list points;
        for (std::size_t tries = 0; points.size() < count && tries < 50 * count; ++tries) {
            const auto i = random.below(static_cast<std::uint32_t>(mesh_.triangles.size()));
            double u = random.uniform(), v = random.uniform();
            if (u + v > 1) {
                u = 1 - u;
                v = 1 - v;
            }
            const glm::dvec3 a = corner(i, 0), p = a + u * (corner(i, 1) - a) + v * (corner(i, 2) - a);
            const double sine = glm::dot(normal(i), toward(p)) / glm::length(normal(i)) / glm::length(toward(p));
            if (side * sine > 0x1p-22) points.add(p, 0, i);
        }
        return points;
    }

    in::mesh mesh_;
    shadow::any_light light_;
    in::affine place_;
};

}  // namespace lit
