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

/// A scene of a mesh alone, turned so that nothing runs along pixels' rows.
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

/// A mesh that somebody modelled with y up, 2 m wide or long, its lowest point just below the ground.
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
    if (!dense) return scenes;
    const in::mesh fine = shapes::relief(400);
    add("statue 72k", on_ground(shapes::statue(), raised(0.7)));
    add("statue 300k", on_ground(shapes::statue(500, 301), raised(0.7)));
    add("fine grid", bare(fine));
    add("fine grid, cache order", bare(shapes::in_cache_order(fine, 400)));
    add("fine grid, shuffled", bare(shapes::shuffled(fine)));
    return scenes;
}

}  // namespace foreign_scenes
