// Scenes whose shadows are compared with other renderers': three seabeds, each with the four targets, an imported mesh
// and an open sheet on it, all of them meshes, so that every renderer gets the same triangles.
#pragma once

#include <insonify/all.hpp>

#include <sstream>
#include <string>
#include <vector>

namespace shadow_scenes {

namespace in = insonify;

/// A ring of square section as a modelling program would write it.
inline std::string ring_as_obj(int segments) {
    std::ostringstream text;
    for (int i = 0; i < segments; ++i) {
        const auto [sine, cosine] = in::numeric::sin_cos_turns(static_cast<double>(i) / segments);
        for (const double radius : {0.6, 0.4})
            for (const double height : {0.0, 0.25})
                text << "v " << radius * cosine << ' ' << radius * sine << ' ' << height << '\n';
    }
    const auto corner = [&](int segment, int k) { return 4 * (segment % segments) + k + 1; };
    for (int i = 0; i < segments; ++i)
        for (const auto& [a, b] : {std::pair{0, 1}, {1, 3}, {3, 2}, {2, 0}})
            text << "f " << corner(i, a) << ' ' << corner(i + 1, a) << ' ' << corner(i + 1, b) << ' ' << corner(i, b)
                 << '\n';
    return text.str();
}

inline in::seabed::any seabed(int kind) {
    if (kind == 0) return in::seabed::ripples{.wavelength = 0.8f, .steepness = 0.11f, .direction = 0.3f};
    if (kind == 1) return in::seabed::mud{};
    return in::seabed::rock{};
}
inline constexpr const char* seabed_names[] = {"ripples", "mud", "rock"};

/// @param spacing  of the seabed's vertices, metres
inline in::scene make(int kind, double spacing) {
    using namespace in::literals;
    in::scene s;
    s.seabed = in::seabed::none{};
    const auto bottom = seabed(kind);
    // No edge of the grid may go through a pixel's centre: fill rules differ there.
    const glm::dvec2 corner(-5.0123, -4.9871);
    const int vertices = static_cast<int>(10 / spacing) + 1;
    const auto field = in::seabed::sample(bottom, {corner, spacing, vertices, vertices});
    s.add(in::seabed::tessellate(field), {.position = {corner, 0}}, "seabed");
    const auto put = [&](const auto& shape, in::pose placement) {
        const in::shared_mesh m = in::scene::mesh_of(shape);
        s.add(m, in::rest_on(bottom, *m, placement), "target");
    };
    put(in::cylinder{.radius = 0.25f, .length = 1.2f, .segments = 24}, {.position = {-1.5, 0.7, 0}, .yaw = 25_deg});
    put(in::cone{.radius = 0.4f, .height = 0.5f, .segments = 24}, {.position = {1.2, 1.4, 0}, .burial = 0.05f});
    put(in::sphere{.radius = 0.4f}, {.position = {1.7, -1.6, 0}, .burial = 0.1f});
    put(in::cube{.size = {0.6f, 0.8f, 0.4f}},
        {.position = {-1.3, -1.7, 0}, .yaw = 0.4f, .roll = 0.1f, .burial = 0.05f});
    put(in::read_obj(ring_as_obj(24)), {.position = {0.1, 0.1, 0}, .pitch = 0.15f, .burial = 0.02f});
    in::mesh sheet{
        {{-0.4f, -0.3f, 0}, {0.4f, -0.3f, 0.1f}, {0.4f, 0.3f, 0}, {-0.4f, 0.3f, 0.2f}}, {}, {{0, 1, 2}, {0, 2, 3}}};
    put(sheet, {.position = {0.3, -2.4, 0}, .burial = -0.3f});
    return s;
}

/// Azimuths: the grid's axes, its diagonals, and some that are aligned with neither.
inline constexpr double azimuths[] = {0, 45, 90, 135, 23.7, 160, 251.3, 328.9};
inline constexpr double elevations[] = {0.5, 1, 2, 6, 20, 45, 89};

inline in::overhead rig(double azimuth, double elevation, int pixels) {
    const auto radians = [](double degrees) { return static_cast<float>(in::numeric::to_radians(degrees)); };
    return {.altitude = 4,
            .field_of_view = radians(90),
            .size = {pixels, pixels},
            .grazing = radians(elevation),
            .light_azimuth = radians(azimuth)};
}

/// All triangles of a scene in the rig's frame, which here is the world's.
struct triangle {
    glm::dvec3 a, b, c;
};
inline std::vector<triangle> triangles(const in::scene& s) {
    std::vector<triangle> all;
    for (const in::target& t : s.targets) {
        const in::affine place = in::to_world(t.placement);
        const auto at = [&](std::uint32_t i) { return in::transform_point(place, t.shape->positions[i]); };
        for (const glm::uvec3& i : t.shape->triangles) all.push_back({at(i.x), at(i.y), at(i.z)});
    }
    return all;
}

/// Difference between two masks of lit pixels.
struct difference {
    long pixels = 0, wrong = 0, both = 0, either = 0;

    void add(bool ours, bool theirs) {
        ++pixels;
        wrong += ours != theirs;
        both += ours && theirs;
        either += ours || theirs;
    }
    difference& operator+=(const difference& d) {
        pixels += d.pixels;
        wrong += d.wrong;
        both += d.both;
        either += d.either;
        return *this;
    }
    // NaN of no pixels, so that an empty picture is not a right one.
    double share() const { return static_cast<double>(wrong) / static_cast<double>(pixels); }
    double iou() const { return static_cast<double>(both) / static_cast<double>(either); }
};

}  // namespace shadow_scenes
