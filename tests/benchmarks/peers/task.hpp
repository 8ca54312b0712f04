// Input of every renderer: plain data without the library's types, because peers are compiled with the flags that suit
// them best, and the library's types differ with flags.
#pragma once

#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

namespace workload {

/// Triangles of one object in the world's frame: metres, counter-clockwise from outside, unit normals.
struct surface {
    std::span<const glm::vec3> positions;
    std::span<const glm::vec3> normals;
    std::span<const glm::uvec3> triangles;
};

/// A picture is `pixels` x `pixels` bytes, rows from the top (+y), each row from the left (-x):
/// round(255 clamp(ambient + max(0, N . to_light) lit, 0, 1)), N the interpolated vertex normal brought to length 1,
/// lit 0 where a ray towards the light meets anything and 1 elsewhere; `background` where there is no surface.
struct task {
    int pixels = 0;
    int cells = 0;          ///< of the seabed, each way; vertex (i, j) of the grid is number j (cells + 1) + i
    double altitude = 0;    ///< of the camera over (0, 0), looking straight down
    double half_width = 0;  ///< of what the picture shows of z = 0, metres
    glm::vec3 to_light{};   ///< unit
    surface seabed, target;

    static constexpr float ambient = 0.1f;
    static constexpr std::uint8_t background = 0;
};

}  // namespace workload
