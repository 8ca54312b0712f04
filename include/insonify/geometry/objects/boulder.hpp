// Boulders: rounded by water, or angular where they broke.
#pragma once

#include <insonify/geometry/bounds.hpp>
#include <insonify/geometry/creases.hpp>
#include <insonify/geometry/objects/detail/lattice_noise.hpp>
#include <insonify/geometry/objects/detail/solids.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// A rock that stands on z = 0 and fills its box exactly. A boulder is larger than 0.256 m (C. K. Wentworth. A Scale of
/// Grade and Class Terms for Clastic Sediments. Journal of Geology 30, 1922); the default proportions are close to
/// those usual for glacial boulders, 1 : 0.8 : 0.6 (Th. Zingg. Beitrag zur Schotteranalyse. 1935: the borders between
/// disc, rod, sphere and blade are at 2 : 3).
struct boulder {
    glm::vec3 size{1.2f, 1.0f, 0.75f};  ///< metres; the largest at most 100 times the least
    float angularity = 0.6f;            ///< 0: round, 1: bounded by plane fractures
    float roughness = 0.5f;             ///< 0: smooth, 1: relief of a tenth of the size
    int segments = 20;                  ///< along each of the 12 edges of the octahedron it is made from, 2 to 256
    std::uint64_t seed = 1;
};

namespace detail::inline INSONIFY_FLAGS {

/// A unit octahedron with every face cut into n * n triangles, projected onto the sphere; 4 n^2 + 2 vertices.
inline mesh geodesic_sphere(int n) {
    mesh out;
    // Rows of latitude: row i has 4 i vertices in the upper half, 4 (2 n - i) in the lower.
    const auto width = [&](int row) { return row <= n ? row : 2 * n - row; };
    std::vector<std::uint32_t> first;
    for (int row = 0; row <= 2 * n; ++row) {
        first.push_back(static_cast<std::uint32_t>(out.positions.size()));
        const int w = width(row);
        const double z = 1 - static_cast<double>(row) / n;
        for (int i = 0; i < (std::max)(4 * w, 1); ++i) {
            const int quarter = w > 0 ? i / w : 0;
            const double t = w > 0 ? static_cast<double>(i - quarter * w) / n : 0.0, s = static_cast<double>(w) / n - t;
            const glm::dvec3 p = quarter == 0   ? glm::dvec3(s, t, z)
                                 : quarter == 1 ? glm::dvec3(-t, s, z)
                                 : quarter == 2 ? glm::dvec3(-s, -t, z)
                                                : glm::dvec3(t, -s, z);
            out.positions.emplace_back(unit(p));
        }
    }
    const auto vertex = [&](int row, int quarter, int step) {
        const int w = width(row);
        return first[static_cast<std::size_t>(row)] +
               (w > 0 ? static_cast<std::uint32_t>((quarter * w + step) % (4 * w)) : 0u);
    };
    for (int row = 0; row < 2 * n; ++row)
        for (int quarter = 0; quarter < 4; ++quarter) {
            const bool opens = row < n;
            const int wide = opens ? row + 1 : row;  // the row with more vertices
            const int other = opens ? row : row + 1;
            const int steps = width(wide);
            for (int i = 0; i < steps; ++i) {
                const std::uint32_t a = vertex(wide, quarter, i), b = vertex(wide, quarter, i + 1);
                const std::uint32_t c = vertex(other, quarter, i);
                out.triangles.push_back(opens ? glm::uvec3(a, b, c) : glm::uvec3(b, a, c));
                if (i + 1 < steps) {
                    const std::uint32_t d = vertex(other, quarter, i + 1);
                    out.triangles.push_back(opens ? glm::uvec3(b, d, c) : glm::uvec3(d, b, c));
                }
            }
        }
    return out;
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// @throws invalid_input for a value outside its range
inline void validate(const boulder& b) {
    for (int i = 0; i < 3; ++i) detail::require_size("boulder.size", b.size[i]);
    const float largest = (std::max)((std::max)(b.size.x, b.size.y), b.size.z);
    for (int i = 0; i < 3; ++i)
        detail::require(100 * b.size[i] >= largest, "boulder.size", b.size[i], "at least 1/100 of the largest");
    detail::require_fraction("boulder.angularity", b.angularity);
    detail::require_fraction("boulder.roughness", b.roughness);
    detail::require_segments("boulder.segments", b.segments, 2, 256);
}

/// 8 segments^2 triangles. Deterministic in the seed.
/// @throws invalid_input as `validate` does
inline mesh to_mesh(const boulder& b) {
    validate(b);
    random_sequence random(b.seed, 0x726F636B);
    struct fracture {
        glm::dvec3 normal;
        double distance;
    };
    std::vector<fracture> fractures;
    for (int i = 0; i < 16; ++i) {
        const double z = random.uniform(-1, 1), turns = random.uniform(), r = numeric::square_root(1 - z * z);
        const auto [sine, cosine] = numeric::sin_cos_turns(turns);
        fractures.push_back({{r * cosine, r * sine, z}, random.uniform(0.55, 0.9)});
    }
    const philox_key key = stream_key(b.seed, 0x726F636C);

    mesh body = detail::geodesic_sphere(b.segments);
    bounding_box box;
    std::vector<glm::dvec3> points;
    for (const glm::vec3& position : body.positions) {
        const glm::dvec3 direction(position);
        double cut = 1;
        for (const fracture& f : fractures) {
            const double facing = numeric::dot(f.normal, direction);
            if (facing > 0) cut = (std::min)(cut, f.distance / facing);
        }
        double radius = 1 + static_cast<double>(b.angularity) * (cut - 1);
        double octave = 0.1 * static_cast<double>(b.roughness), frequency = 2;
        for (int i = 0; i < 5; ++i, octave *= 0.55, frequency *= 2.1)
            radius += octave * detail::lattice_noise(frequency * direction + glm::dvec3(7.0 * i), key);
        points.push_back(radius * direction);
        box = include(box, points.back());
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 share = (points[i] - box.lower) / box.size();
        body.positions[i] = glm::vec3((share - glm::dvec3(0.5, 0.5, 0)) * glm::dvec3(b.size));
    }
    return with_creases(body, 0.5f);
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
