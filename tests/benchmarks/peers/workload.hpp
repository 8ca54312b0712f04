// The workloads. The reference workload W: a cylinder on a rippled seabed of 40 m x 40 m under a camera 10 m up, lit at
// 6 degrees; and two of other kinds: a close-up from 1 m, and a mesh of millions of triangles over rock.
// In a namespace for each build, like the library's types: a program may hold several builds (insonify_builds.hpp).
#pragma once

#include <insonify/core/numeric.hpp>
#include <insonify/geometry/cylinder.hpp>
#include <insonify/geometry/normals.hpp>
#include <insonify/geometry/transform.hpp>
#include <insonify/seabed/rock.hpp>
#include <insonify/seabed/sample.hpp>
#include <insonify/seabed/tessellate.hpp>

#include <array>
#include <cstdint>

#include "task.hpp"

namespace workload::inline INSONIFY_FLAGS {

namespace in = insonify;

/// Resolution of a scene.
struct size {
    char name;
    int cells;   ///< of the seabed, each way
    int pixels;  ///< of the picture, each way
};
inline constexpr std::array<size, 3> sizes{{{'S', 256, 512}, {'M', 512, 1024}, {'L', 1024, 2048}}};

inline constexpr double half_side = 20;                                                 // metres
inline constexpr double ripple_height = 0.15, ripple_length = 1.5;                      // metres
inline constexpr double noise_height = 0.02, noise_cell = 0.5;                          // metres
inline constexpr double light_azimuth = 160, light_elevation = 6, field_of_view = 120;  // degrees
inline constexpr double target_yaw = 30;                                                // degrees

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

/// Height of the rippled seabed, metres.
inline double rippled_height(double x, double y) {
    return ripple_height * in::numeric::sin_cos_turns(x / ripple_length).sine +
           noise_height * value_noise(x / noise_cell, y / noise_cell);
}

/// Two triangles a cell, cut from vertex (i, j) to (i + 1, j + 1), rows from -y and each row from -x.
inline in::mesh rippled(int cells) {
    in::mesh m;
    const auto side = static_cast<std::uint32_t>(cells + 1);
    for (std::uint32_t j = 0; j < side; ++j)
        for (std::uint32_t i = 0; i < side; ++i) {
            const double x = half_side * (2.0 * i / cells - 1), y = half_side * (2.0 * j / cells - 1);
            m.positions.emplace_back(x, y, rippled_height(x, y));
            if (i + 1 == side || j + 1 == side) continue;
            const std::uint32_t corner = j * side + i, opposite = corner + side + 1;
            m.triangles.emplace_back(corner, corner + 1, opposite);
            m.triangles.emplace_back(corner, opposite, opposite - 1);
        }
    m.normals = in::smooth_normals(m);
    return m;
}

/// The same for outcrops and blocks of rock.
inline in::mesh rocky(int cells) {
    in::seabed::grid grid{.spacing = 2 * half_side / cells, .width = cells + 1, .height = cells + 1};
    grid.first = {-cells / 2, -cells / 2};
    return in::seabed::tessellate(in::seabed::sample(in::seabed::rock{}, grid), {}, grid.first);
}

/// A target that lies at the origin, turned.
inline in::mesh placed(const in::mesh& m, double height) {
    return in::transformed(
        m, in::to_world({.position = {0, 0, height}, .yaw = static_cast<float>(in::numeric::to_radians(target_yaw))}));
}
inline in::mesh cylinder(int) {
    return placed(in::to_mesh(in::cylinder{.radius = 0.5f, .length = 2, .segments = 64}), 0.5);
}
inline in::mesh thin_cylinder(int) {
    return placed(in::to_mesh(in::cylinder{.radius = 0.1f, .length = 0.8f, .segments = 64}), 0.1);
}

/// Like a scan of a round object: twice as many triangles as the seabed has, most of them smaller than a pixel.
inline in::mesh scanned(int cells) {
    in::mesh m;
    const auto steps = static_cast<std::uint32_t>(in::numeric::square_root(2.0) * cells), side = steps + 1;
    for (std::uint32_t j = 0; j < side; ++j)
        for (std::uint32_t i = 0; i < side; ++i) {
            const double down = 0.5 * j / steps, around = 1.0 * i / steps;  // turns
            const auto [sin_down, cos_down] = in::numeric::sin_cos_turns(down);
            const auto [sin_around, cos_around] = in::numeric::sin_cos_turns(around);
            const double radius =
                1.5 + 0.03 * in::numeric::sin_cos_turns(12 * down).sine * in::numeric::sin_cos_turns(5 * around).sine;
            m.positions.emplace_back(radius * sin_down * cos_around, radius * sin_down * sin_around, radius * cos_down);
            if (i + 1 == side || j + 1 == side) continue;
            const std::uint32_t corner = j * side + i, opposite = corner + side + 1;
            m.triangles.emplace_back(corner, opposite - 1, opposite);
            m.triangles.emplace_back(corner, opposite, corner + 1);
        }
    m.normals = in::smooth_normals(m);
    return placed(m, 0.5);
}

/// A seabed and a target, and the camera's altitude.
struct setting {
    const char* name;
    double altitude;  ///< metres
    in::mesh (*seabed)(int cells);
    in::mesh (*target)(int cells);
};
inline constexpr setting reference{"W", 10, rippled, cylinder};
inline constexpr std::array<setting, 3> settings{
    {reference, {"close", 1, rippled, thin_cylinder}, {"mesh", 10, rocky, scanned}}};

/// A setting in one size: the meshes, in the world's frame, and the direction to the light.
struct scene {
    workload::size size;
    workload::setting setting;
    in::mesh seabed, target;
    glm::dvec3 to_light;

    explicit scene(const workload::size& s, const workload::setting& what = reference)
        : size(s), setting(what), seabed(what.seabed(s.cells)), target(what.target(s.cells)) {
        const auto [sin_azimuth, cos_azimuth] = in::numeric::sin_cos(in::numeric::to_radians(light_azimuth));
        const auto [sin_elevation, cos_elevation] = in::numeric::sin_cos(in::numeric::to_radians(light_elevation));
        to_light = {-cos_azimuth * cos_elevation, -sin_azimuth * cos_elevation, sin_elevation};
    }

    /// The same as plain data, which refers to the scene.
    workload::task task() const {
        const auto plain = [](const in::mesh& m) { return surface{m.positions, m.normals, m.triangles}; };
        const double altitude = setting.altitude;
        return {size.pixels,
                size.cells,
                altitude,
                altitude * in::numeric::tan(in::numeric::to_radians(field_of_view / 2)),
                glm::vec3(to_light),
                plain(seabed),
                plain(target)};
    }
};

}  // namespace workload::inline INSONIFY_FLAGS
