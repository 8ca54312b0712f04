// Which pixels may show a target, and which its shadow may darken: elsewhere nobody asks for it.
#include <insonify/core/random.hpp>
#include <insonify/geometry/cube.hpp>
#include <insonify/sonar/overhead/detail/placed_mesh.hpp>
#include <insonify/sonar/overhead/render.hpp>

#include <algorithm>
#include <vector>

#include "../../catch.hpp"

namespace in = insonify;
using in::numeric::to_radians;

namespace {

in::overhead_geometry view_of(double grazing, double azimuth) {
    return in::overhead_geometry({.altitude = 10,
                                  .size = {301, 200},
                                  .grazing = static_cast<float>(to_radians(grazing)),
                                  .light_azimuth = static_cast<float>(to_radians(azimuth))});
}

bool holds(const in::detail::pixel_box& box, const glm::dvec2& pixel) {
    return box.x0 <= pixel.x && pixel.x < box.x1 + 1 && box.y0 <= pixel.y && pixel.y < box.y1 + 1;
}

}  // namespace

TEST_CASE("A target and its shadow, down to the lowest ground, lie within its pixels, and these end with it") {
    const in::mesh cube = in::to_mesh(in::cube{});
    const in::bounding_box box = in::bounds(cube);
    in::random_sequence random(5);
    const auto between = [&](double a, double b) { return random.uniform(a, b); };
    for (const double grazing : {0.1, 1.0, 6.0, 45.0, 89.9})
        for (int turn = 0; turn < 30; ++turn) {
            CAPTURE(grazing, turn);
            const in::overhead_geometry view = view_of(grazing, between(0, 360));
            const in::pose pose{.position = {between(-9, 9), between(-6, 6), between(-1, 2)},
                                .yaw = static_cast<float>(between(0, 6)),
                                .pitch = static_cast<float>(between(-1, 1)),
                                .scale = static_cast<float>(between(0.1, 3))};
            const in::detail::placed_mesh target{cube, box, view.rig_from(in::to_world(pose))};
            const double lowest = -1.5;
            const in::detail::pixel_box pixels = in::detail::shadowed_pixels(view, target, lowest);
            glm::dvec2 first(1e9), last(-1e9);
            bool reaches_below = false;
            for (int i = 0; i < 200; ++i) {
                const glm::dvec3 inside =
                    i < 16 ? box.corner(i % 8)
                           : box.lower + box.size() * glm::dvec3(between(0, 1), between(0, 1), between(0, 1));
                const glm::dvec3 from = in::transform_point(target.to_rig, inside);
                reaches_below |= from.z < lowest;
                if (from.z < lowest) continue;
                const double way = (from.z - lowest) / view.light().to_light().z;
                const double share = i < 8 ? 0.0 : i < 16 ? 1.0 : between(0, 1);
                const glm::dvec2 pixel = view.pixel(from - share * way * view.light().to_light());
                first = {std::min(first.x, pixel.x), std::min(first.y, pixel.y)};
                last = {std::max(last.x, pixel.x), std::max(last.y, pixel.y)};
                if (pixel.x >= 0 && pixel.x < 301 && pixel.y >= 0 && pixel.y < 200) CHECK(holds(pixels, pixel));
            }
            if (reaches_below) continue;
            if (first.x > 1) CHECK(pixels.x0 > std::min(first.x, 302.0) - 3);
            if (first.y > 1) CHECK(pixels.y0 > std::min(first.y, 201.0) - 3);
            if (last.x < 300) CHECK(pixels.x1 < std::max(last.x, -2.0) + 2);
            if (last.y < 199) CHECK(pixels.y1 < std::max(last.y, -2.0) + 2);
        }
}

TEST_CASE("What reaches up to the camera may darken every pixel, and nothing darkens none") {
    const in::overhead_geometry view = view_of(30, 70);
    const in::mesh cube = in::to_mesh(in::cube{});
    const auto placed = [&](double z) {
        return in::detail::placed_mesh{cube, in::bounds(cube), view.rig_from(in::to_world({.position = {3, 1, z}}))};
    };
    const in::detail::pixel_box all = in::detail::shadowed_pixels(view, placed(9.8), 0);
    CHECK((all.x0 == 0 && all.y0 == 0 && all.x1 == 300 && all.y1 == 199));
    const in::mesh nothing;
    CHECK(in::detail::shadowed_pixels(view, in::detail::placed_mesh{nothing, in::bounds(nothing), {}}, 0).empty());
}

TEST_CASE("Whatever a picture shows of a target lies within its pixels, however floats round its places") {
    in::random_sequence random(11);
    for (const double away : {0.0, 1e3, 1e6})
        for (const double top : {0.5, 9.0, 9.99, 9.99999})
            for (int turn = 0; turn < 12; ++turn) {
                CAPTURE(away, top, turn);
                // A shard that ends a little below the camera, its own origin far away.
                in::mesh shard;
                const glm::dvec3 origin(away, -away, away);
                for (int i = 0; i < 4; ++i)
                    shard.positions.emplace_back(origin + glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1),
                                                                     i == 3 ? top : random.uniform(-1, 0)));
                shard.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}};
                const in::overhead rig{.altitude = 10, .size = {301, 200}};
                in::scene scene;
                scene.seabed = in::seabed::none{};
                scene.add(shard, {.position = -origin}, "shard");
                const auto seen = in::render<in::shadow::none>(scene, rig);
                const in::overhead_geometry view(rig);
                const in::detail::placed_mesh target{shard, in::bounds(shard),
                                                     view.rig_from(in::to_world(scene.targets[0].placement))};
                const in::detail::pixel_box pixels = in::detail::shown_pixels(view, target);
                int outside = 0;
                for (int y = 0; y < rig.size.y; ++y)
                    for (int x = 0; x < rig.size.x; ++x)
                        outside += seen.labels.instance(x, y) != 0 && !holds(pixels, {x + 0.5, y + 0.5});
                CHECK(outside == 0);
            }
}

TEST_CASE("Targets before and behind each other are drawn alike, whatever comes first") {
    in::random_sequence random(17);
    const in::overhead rig{.altitude = 10, .size = {300, 220}, .grazing = static_cast<float>(to_radians(20))};
    in::scene one, other;
    std::vector<in::pose> poses;
    for (int i = 0; i < 20; ++i)
        poses.push_back({.position = {random.uniform(-6, 6), random.uniform(-5, 5), random.uniform(0, 5)},
                         .yaw = static_cast<float>(random.uniform(0, 6)),
                         .pitch = static_cast<float>(random.uniform(-1, 1))});
    for (const in::pose& p : poses) one.add(in::cube{}, p, "cube");
    for (auto p = poses.rbegin(); p != poses.rend(); ++p) other.add(in::cube{}, *p, "cube");
    const auto a = in::render(one, rig), b = in::render(other, rig);
    CHECK(a.image == b.image);
    int differ = 0;
    for (int y = 0; y < rig.size.y; ++y)
        for (int x = 0; x < rig.size.x; ++x) {
            const int first = a.labels.instance(x, y), last = b.labels.instance(x, y);
            differ += first == 0 ? last != 0 : last != 21 - first;
        }
    CHECK(differ == 0);
}
