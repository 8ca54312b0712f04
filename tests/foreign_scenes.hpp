// The meshes of shadow_meshes.hpp as scenes: each on level ground or as the ground, below a camera that sees all of it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "shadow_meshes.hpp"

namespace foreign_scenes {

namespace in = insonify;

struct foreign_scene {
    std::string name;
    in::scene scene;
};

/// Camera and light: 5 m of ground from 4 m up.
inline in::overhead rig(double azimuth, double elevation, int pixels) {
    const auto radians = [](double degrees) { return static_cast<float>(in::numeric::to_radians(degrees)); };
    return {.altitude = 4,
            .field_of_view = radians(64),
            .size = {pixels, pixels},
            .grazing = radians(elevation),
            .light_azimuth = radians(azimuth)};
}

/// A scene of a mesh alone, rotated so that no edge is parallel to a row of pixels.
inline in::scene bare(const in::mesh& m, in::pose placement = {.position = {0.0123, 0.0457, 0}, .yaw = 0.3f}) {
    in::scene s;
    s.seabed = in::seabed::none{};
    s.add(m, placement, "mesh");
    return s;
}

/// @param level  of the ground, metres above the datum
inline in::scene on_ground(const in::mesh& m, in::pose placement = {.position = {0.0123, 0.0457, 0}, .yaw = 0.3f},
                           double level = 0) {
    const in::mesh ground{{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}, {}, {{0, 1, 2}, {0, 2, 3}}};
    in::scene s = bare(ground, {.position = {0.0311, -0.0173, level}, .yaw = 0.1f});
    s.add(m, placement, "mesh");
    return s;
}

/// A mesh with y up, scaled to 2 m and placed with its lowest point just below the ground.
inline in::scene standing(in::mesh m) {
    m.normals.clear();
    in::bounding_box box = in::bounds(m);
    if (box.empty()) return on_ground(m);
    const glm::dvec3 size = box.size(), middle = box.centre();
    const double scale = 2 / std::max({size.x, size.y, size.z});
    for (glm::vec3& p : m.positions) {
        const glm::dvec3 q = scale * (glm::dvec3(p) - middle);
        p = glm::vec3(q.x, -q.z, q.y + 0.5 * scale * size.y - 0.02);
    }
    return on_ground(m);
}

/// One mesh many times: scaled, turned upside down, half buried, one in another, some outside of the picture.
inline in::scene crowd(const in::mesh& m) {
    in::scene s = on_ground(m, {.position = {0.4, 0.3, 0.5}, .yaw = 0.4f, .scale = 0.6f});
    const auto put = [&](const in::pose& placement) { s.add(m, placement, "mesh"); };
    put({.position = {-0.9, 0.8, 0.2}, .yaw = 2, .roll = 0.5f, .scale = 0.5f});
    put({.position = {-0.7, 0.7, 0.4}, .pitch = 3.1f, .scale = 0.4f});
    put({.position = {0.9, -1, 0}, .yaw = 1, .scale = 0.7f, .burial = 0.1f});
    put({.position = {-1.1, -0.9, 0.02}, .roll = 1.2f, .scale = 0.05f});
    put({.position = {-4.5, -1.5, 0.7}, .yaw = 5});
    put({.position = {3.5, 3, 1.5}, .pitch = 1});
    return s;
}

/// Walls around the picture that rise past the camera, and a roof with holes above it.
inline in::scene hall() {
    in::scene s = on_ground(shadow_meshes::fins());
    const in::mesh wall = shadow_meshes::sheet(9, 6, [](double u, double v) {
        return glm::dvec3(8 * u - 4, 0.3 * shadow_meshes::bumps({u, v, 1}, 9), 7 * v);
    });
    for (const double x : {-3.5, 3.7}) s.add(wall, {.position = {x, 0.2, -0.1}, .yaw = 1.6f}, "wall");
    s.add(shadow_meshes::with_holes(shadow_meshes::relief(30)), {.position = {0.3, 0.1, 5.5}, .yaw = 0.7f}, "roof");
    return s;
}

/// A seabed of the library as a plain mesh.
inline in::scene bottom_of(const in::seabed::any& seabed, double spacing) {
    const int vertices = static_cast<int>(6 / spacing) + 1;
    return bare(in::seabed::tessellate(in::seabed::sample(seabed, {{-3.0123, -2.9871}, spacing, vertices, vertices})),
                {.position = {-3.0123, -2.9871, 0}});
}

/// @param dense  also those of more than 20 000 triangles
inline std::vector<foreign_scene> all(bool dense = true) {
    namespace shapes = shadow_meshes;
    std::vector<foreign_scene> scenes;
    const auto add = [&](const char* name, in::scene s) { scenes.push_back({name, std::move(s)}); };
    const auto raised = [](double height) { return in::pose{.position = {0.0123, 0.0457, height}, .yaw = 0.3f}; };
    const in::mesh figure = shapes::statue(56, 40), relief = shapes::relief();
    add("tilted quad", bare(shapes::tilted_quad()));
    add("tilted sheet", on_ground(shapes::tilted_quad(24)));
    add("sunken ground", on_ground(shapes::tilted_quad(24), raised(0), -0.01));
    add("bowl", on_ground(shapes::bowl()));
    add("scroll", on_ground(shapes::scroll()));
    add("moebius strip", on_ground(shapes::moebius_strip()));
    add("crossed tori", on_ground(shapes::crossed_tori()));
    add("horn torus", on_ground(shapes::horn_torus()));
    add("inverted lobe", on_ground(shapes::inverted_lobe()));
    add("inside-out ball", on_ground(shapes::inside_out_ball(), raised(0.6)));
    add("fins", on_ground(shapes::fins()));
    add("soup", on_ground(shapes::soup(figure), raised(0.7)));
    add("cow", on_ground(shapes::cow(), raised(0.75)));
    add("degenerates", on_ground(shapes::with_degenerates(figure), raised(0.7)));
    add("duplicates", on_ground(shapes::with_duplicates(figure), raised(0.7)));
    add("huge vertex", on_ground(shapes::with_huge_vertex(figure), raised(0.7)));
    add("slivers", on_ground(shapes::slivers()));
    add("grid", bare(relief));
    add("grid, cache order", bare(shapes::in_cache_order(relief, 96)));
    add("grid, shuffled", bare(shapes::shuffled(relief)));
    add("grid, NaN", bare(shapes::with_nodata(relief)));
    add("grid, holes", bare(shapes::with_holes(relief)));
    add("crowd", crowd(shapes::cow()));
    add("hall", hall());
    add("rubble", bottom_of(in::seabed::rock{}, 0.05));
    if (!dense) return scenes;
    add("fine rubble", bottom_of(in::seabed::rock{}, 0.013));
    add("fine ripples", bottom_of(in::seabed::ripples{.wavelength = 0.4f, .direction = 0.3f}, 0.013));
    const in::mesh fine = shapes::relief(400);
    add("statue 72k", on_ground(shapes::statue(), raised(0.7)));
    add("statue 300k", on_ground(shapes::statue(500, 301), raised(0.7)));
    add("fine grid", bare(fine));
    add("fine grid, cache order", bare(shapes::in_cache_order(fine, 400)));
    add("fine grid, shuffled", bare(shapes::shuffled(fine)));
    return scenes;
}

}  // namespace foreign_scenes
