// Points that shadows are asked about: on the lit sides of a mesh, several at a time, and what rays say of them that
// are tried on every triangle.
#pragma once

#include <insonify/core/dispatch.hpp>
#include <insonify/core/lanes.hpp>
#include <insonify/core/linear.hpp>
#include <insonify/core/random.hpp>
#include <insonify/geometry/mesh.hpp>
#include <insonify/shadow/light.hpp>

#include <algorithm>
#include <vector>

namespace points {

namespace in = insonify;

inline double radians(double degrees) {
    return in::numeric::to_radians(degrees);
}

/// Asks a caster about points, as many at a time as the instruction set has lanes.
template <class Caster>
struct question {
    const Caster& caster;
    const std::vector<glm::vec3>& points;
    std::vector<bool>& dark;

    template <int N>
    INSONIFY_INLINE void run() const {
        using namespace in::detail;
        for (std::size_t first = 0; first < points.size(); first += N) {
            const auto point = [&](int k) {
                return points[(std::min)(first + static_cast<std::size_t>(k), points.size() - 1)];
            };
            lanes<float, N> position[3];
            for (int axis = 0; axis < 3; ++axis) gather<N>(position[axis], [&](int k) { return point(k)[axis]; });
            lanes<std::int32_t, N> answer;
            caster.template darken<N>(answer, lanes<std::int32_t, N>{} - 1, position);
            for (std::size_t k = 0; k < std::size_t{N} && first + k < points.size(); ++k)
                dark[first + k] = lane(answer, static_cast<int>(k)) != 0;
        }
    }
};

template <class Caster>
std::vector<bool> ask(const Caster& caster, const std::vector<glm::vec3>& points, in::isa level = in::best_isa()) {
    std::vector<bool> dark(points.size());
    in::detail::dispatch(question<Caster>{caster, points, dark}, level);
    return dark;
}

/// Points of a mesh's triangles, but of those that face away from the light, which is dark without asking.
inline std::vector<glm::vec3> facing(const in::mesh& m, const glm::dvec3& to_light, std::size_t count,
                                     in::random_sequence& random) {
    std::vector<glm::vec3> found;
    while (found.size() < count) {
        const glm::uvec3& t = m.triangles[random.below(static_cast<std::uint32_t>(m.triangles.size()))];
        const glm::vec3 a = m.positions[t.x], ab = m.positions[t.y] - a, ac = m.positions[t.z] - a;
        if (in::numeric::dot(glm::dvec3(in::numeric::cross(ab, ac)), to_light) <= 0) continue;
        const auto u = static_cast<float>(random.uniform(0, 0.5)), v = static_cast<float>(random.uniform(0, 0.5));
        found.push_back(a + u * ab + v * ac);
    }
    return found;
}

/// Whether the ray from a point towards the light meets any triangle beyond a tenth of a millimetre.
inline bool is_blocked(const in::mesh& m, const glm::dvec3& from, const glm::dvec3& along) {
    for (const glm::uvec3& t : m.triangles) {
        const glm::dvec3 a(m.positions[t.x]), ab = glm::dvec3(m.positions[t.y]) - a,
                                              ac = glm::dvec3(m.positions[t.z]) - a;
        const glm::dvec3 p = in::numeric::cross(along, ac);
        const double determinant = in::numeric::dot(ab, p);
        if (determinant == 0) continue;
        const glm::dvec3 s = from - a, q = in::numeric::cross(s, ab);
        const double u = in::numeric::dot(s, p) / determinant, v = in::numeric::dot(along, q) / determinant;
        if (u >= 0 && v >= 0 && u + v <= 1 && in::numeric::dot(ac, q) / determinant > 1e-4) return true;
    }
    return false;
}

/// How many of some points a caster gets wrong.
template <class Caster>
int wrong(const Caster& caster, const std::vector<glm::vec3>& points, const in::mesh& m, const glm::dvec3& to_light) {
    const std::vector<bool> dark = ask(caster, points);
    int count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) count += dark[i] != is_blocked(m, glm::dvec3(points[i]), to_light);
    return count;
}

}  // namespace points
