// The reference workload W: a cylinder on a rippled seabed of 40 m x 40 m under a camera 10 m up, lit at 6 degrees.
#pragma once

#include <insonify/core/numeric.hpp>
#include <insonify/geometry/cylinder.hpp>
#include <insonify/geometry/normals.hpp>
#include <insonify/geometry/transform.hpp>

#include <array>
#include <cstdint>

#include "task.hpp"

namespace workload {

namespace in = insonify;

/// How fine; the scene is the same.
struct size {
    char name;
    int cells;   ///< of the seabed, each way
    int pixels;  ///< of the picture, each way
};
inline constexpr std::array<size, 3> sizes{{{'S', 256, 512}, {'M', 512, 1024}, {'L', 1024, 2048}}};

inline constexpr double half_side = 20, altitude = 10;                                  // metres
inline constexpr double ripple_height = 0.15, ripple_length = 1.5;                      // metres
inline constexpr double noise_height = 0.02, noise_cell = 0.5;                          // metres
inline constexpr double light_azimuth = 160, light_elevation = 6, field_of_view = 120;  // degrees
inline constexpr in::cylinder target{.radius = 0.5f, .length = 2, .segments = 64};
inline constexpr double target_height = 0.5, target_yaw = 30;  // metres, degrees

/// Smooth value noise in [-1, 1] on a lattice of one.
inline double value_noise(double x, double y) {
    const auto at = [](std::int64_t column, std::int64_t row) {
        auto h = static_cast<std::uint32_t>(column) * 0x9E3779B1u ^ static_cast<std::uint32_t>(row) * 0x85EBCA77u;
        h = (h ^ (h >> 16)) * 0x7FEB352Du;
        h = (h ^ (h >> 15)) * 0x846CA68Bu;
        return static_cast<double>(h ^ (h >> 16)) / 2147483647.5 - 1;
    };
    const auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
    const auto mix = [](double a, double b, double t) { return a + t * (b - a); };
    const std::int64_t i = in::numeric::floor_to_int(x), j = in::numeric::floor_to_int(y);
    const double u = fade(x - static_cast<double>(i)), v = fade(y - static_cast<double>(j));
    return mix(mix(at(i, j), at(i + 1, j), u), mix(at(i, j + 1), at(i + 1, j + 1), u), v);
}

/// Height of the seabed, metres.
inline double height(double x, double y) {
    return ripple_height * in::numeric::sin_cos_turns(x / ripple_length).sine +
           noise_height * value_noise(x / noise_cell, y / noise_cell);
}

/// Two triangles a cell, cut from vertex (i, j) to (i + 1, j + 1), rows from -y and each row from -x.
inline in::mesh seabed(int cells) {
    in::mesh m;
    const auto side = static_cast<std::uint32_t>(cells + 1);
    for (std::uint32_t j = 0; j < side; ++j)
        for (std::uint32_t i = 0; i < side; ++i) {
            const double x = half_side * (2.0 * i / cells - 1), y = half_side * (2.0 * j / cells - 1);
            m.positions.emplace_back(x, y, height(x, y));
            if (i + 1 == side || j + 1 == side) continue;
            const std::uint32_t corner = j * side + i, opposite = corner + side + 1;
            m.triangles.emplace_back(corner, corner + 1, opposite);
            m.triangles.emplace_back(corner, opposite, opposite - 1);
        }
    m.normals = in::smooth_normals(m);
    return m;
}

/// W in one size: the meshes, in the world's frame, and where the light stands.
struct scene {
    workload::size size;
    in::mesh seabed, cylinder;
    glm::dvec3 to_light;

    explicit scene(const workload::size& s)
        : size(s),
          seabed(workload::seabed(s.cells)),
          cylinder(in::transformed(in::to_mesh(target),
                                   in::to_world({.position = {0, 0, target_height},
                                                 .yaw = static_cast<float>(in::numeric::to_radians(target_yaw))}))) {
        const auto [sin_azimuth, cos_azimuth] = in::numeric::sin_cos(in::numeric::to_radians(light_azimuth));
        const auto [sin_elevation, cos_elevation] = in::numeric::sin_cos(in::numeric::to_radians(light_elevation));
        to_light = {-cos_azimuth * cos_elevation, -sin_azimuth * cos_elevation, sin_elevation};
    }

    /// The same as plain data, which stays the scene's.
    workload::task task() const {
        const auto plain = [](const in::mesh& m) { return surface{m.positions, m.normals, m.triangles}; };
        return {size.pixels,
                size.cells,
                altitude,
                altitude * in::numeric::tan(in::numeric::to_radians(field_of_view / 2)),
                glm::vec3(to_light),
                plain(seabed),
                plain(cylinder)};
    }
};

}  // namespace workload
