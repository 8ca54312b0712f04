// The targets as solids, which lines intersect in closed form, without meshes.
#pragma once

#include <limits>
#include <string>
#include <variant>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "dice.hpp"

namespace pings {

/// The part of a line p + t d that lies in a convex solid.
struct interval {
    double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity();

    bool empty() const { return !(from < to); }
    friend interval operator&(const interval& a, const interval& b) {
        return {a.from > b.from ? a.from : b.from, a.to < b.to ? a.to : b.to};
    }
};
inline constexpr interval empty_interval{1, 0};

/// Between two planes at a coordinate of -half and half.
inline interval in_slab(double p, double d, double half) {
    if (d == 0) return p > -half && p < half ? interval{} : empty_interval;
    const double a = (-half - p) / d, b = (half - p) / d;
    return a < b ? interval{a, b} : interval{b, a};
}

/// Within a distance of the origin, in the vectors' dimensions.
template <class Vector>
interval in_ball(const Vector& p, const Vector& d, double radius) {
    const double a = glm::dot(d, d), b = glm::dot(p, d), c = glm::dot(p, p) - radius * radius;
    const double inside = b * b - a * c;
    if (!(inside > 0)) return empty_interval;
    if (a == 0) return c < 0 ? interval{} : empty_interval;
    const double root = std::sqrt(inside);
    return {(-b - root) / a, (-b + root) / a};
}

struct surface_point {
    glm::dvec3 position, normal;
};

struct sphere {
    double radius;

    double area() const { return 4 * std::numbers::pi * radius * radius; }
    glm::dvec3 half() const { return glm::dvec3(radius); }
    interval inside(const glm::dvec3& p, const glm::dvec3& d) const { return in_ball(p, d, radius); }
    surface_point sample_surface(dice& random) const {
        const double z = random.uniform(-1, 1), r = std::sqrt(1 - z * z),
                     turn = random.uniform(0, 2 * std::numbers::pi);
        const glm::dvec3 n{r * std::cos(turn), r * std::sin(turn), z};
        return {radius * n, n};
    }
};

struct box {
    glm::dvec3 sides;

    double area() const { return 2 * (sides.x * sides.y + sides.y * sides.z + sides.z * sides.x); }
    glm::dvec3 half() const { return 0.5 * sides; }
    interval inside(const glm::dvec3& p, const glm::dvec3& d) const {
        const glm::dvec3 h = half();
        return in_slab(p.x, d.x, h.x) & in_slab(p.y, d.y, h.y) & in_slab(p.z, d.z, h.z);
    }
    surface_point sample_surface(dice& random) const {
        const double yz = sides.y * sides.z, zx = sides.z * sides.x;
        const double which = random.uniform(0, 0.5 * area());
        const int axis = which < yz ? 0 : which < yz + zx ? 1 : 2;
        const glm::dvec3 h = half();
        surface_point s{{random.uniform(-h.x, h.x), random.uniform(-h.y, h.y), random.uniform(-h.z, h.z)}, {}};
        s.normal[axis] = random.uniform() < 0.5 ? -1 : 1;
        s.position[axis] = s.normal[axis] * h[axis];
        return s;
    }
};

/// Lies along x, with flat ends.
struct cylinder {
    double radius, length;

    double area() const { return 2 * std::numbers::pi * radius * (length + radius); }
    glm::dvec3 half() const { return {0.5 * length, radius, radius}; }
    interval inside(const glm::dvec3& p, const glm::dvec3& d) const {
        return in_slab(p.x, d.x, 0.5 * length) & in_ball(glm::dvec2(p.y, p.z), glm::dvec2(d.y, d.z), radius);
    }
    surface_point sample_surface(dice& random) const {
        const double turn = random.uniform(0, 2 * std::numbers::pi), end = random.uniform() < 0.5 ? -1 : 1;
        const double c = std::cos(turn), s = std::sin(turn);
        if (random.uniform() * (length + radius) < length)
            return {{random.uniform(-0.5, 0.5) * length, radius * c, radius * s}, {0, c, s}};
        const double r = radius * std::sqrt(random.uniform());
        return {{0.5 * end * length, r * c, r * s}, {end, 0, 0}};
    }
};

using solid = std::variant<cylinder, box, sphere>;

/// A solid with its position and rotation.
class body {
  public:
    /// @param turn  from its own frame to the world's, a rotation
    body(const solid& shape, const glm::dmat3& turn, const glm::dvec3& centre)
        : shape_(shape), turn_(turn), back_(glm::transpose(turn)), centre_(centre) {}

    double area() const {
        return std::visit([](const auto& s) { return s.area(); }, shape_);
    }
    double radius() const {
        return std::visit([](const auto& s) { return glm::length(s.half()); }, shape_);
    }
    const glm::dvec3& centre() const { return centre_; }

    /// Whether it hides a point from the sonar; what lies inside is hidden.
    bool hides(const glm::dvec3& point, const glm::dvec3& sonar) const {
        const glm::dvec3 p = back_ * (sonar - centre_), d = back_ * (point - sonar);
        const interval s = std::visit([&](const auto& shape) { return shape.inside(p, d); }, shape_);
        return !s.empty() && s.to > 0 && s.from < 1;
    }
    surface_point sample_surface(dice& random) const {
        const surface_point s = std::visit([&](const auto& shape) { return shape.sample_surface(random); }, shape_);
        return {centre_ + turn_ * s.position, turn_ * s.normal};
    }

  private:
    solid shape_;
    glm::dmat3 turn_, back_;
    glm::dvec3 centre_;
};

}  // namespace pings
