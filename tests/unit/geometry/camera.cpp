// The camera: projected positions, clipping, and conversion from OpenGL's clip space.
#include <insonify/geometry/camera.hpp>

#include <cmath>

#include "../../catch.hpp"

namespace in = insonify;

TEST_CASE("A camera shows its target in the middle and `up` at the top; depth grows towards the eye") {
    const in::camera c{.eye = {1e6, -4, 3}, .target = {1e6, 0, 0}, .field_of_view = 1, .aspect = 2};
    const in::camera_view view(c, in::to_world({.position = {1e6, 0, 0}}));
    const glm::vec4 middle = view({0, 0, 0});
    CHECK(middle.w == Approx(5));
    CHECK(middle.x / middle.w == Approx(0).margin(1e-6));
    CHECK(middle.y / middle.w == Approx(0).margin(1e-6));
    const glm::vec4 above = view({0, 0, 0.1f}), right = view({0.1f, 0, 0}), behind = view({0, 1, 0});
    CHECK(above.y / above.w > 0);
    CHECK(right.x / right.w == Approx(0.1 / 5 / std::tan(0.5) / 2));
    CHECK(behind.z / behind.w < middle.z / middle.w);
    CHECK(view({0, -4, 3}).w == Approx(0).margin(1e-5));  // in the eye
    // The edge of the picture at half of the field of view.
    const double half = 5 * std::tan(0.5);
    const glm::vec4 edge = view({0, static_cast<float>(half * 0.6), static_cast<float>(half * 0.8)});
    CHECK(edge.y / edge.w == Approx(1));
}

TEST_CASE(
    "Visible depths lie between 0 and w from the near plane to infinity; from_gl_clip() maps OpenGL's range to them") {
    const in::camera_view view({.eye = {0, 0, 10}, .target = {0, 0, 0}, .up = {0, 1, 0}, .z_near = 2});
    const glm::vec4 on_plane = view({0, 0, 8}), nearer = view({0, 0, 8.5f}), away = view({0, 0, -1e6f});
    CHECK(on_plane.z == on_plane.w);
    CHECK(nearer.z > nearer.w);
    CHECK((away.z > 0 && away.z < away.w));
    for (const float z : {-3.0f, -1.0f, 0.0f, 2.5f, 3.0f}) {
        const glm::vec4 p = in::from_gl_clip({1, 2, z, 3});
        CHECK((p.z >= 0 && p.z <= p.w && p.x == 1 && p.y == 2));
    }
}

TEST_CASE("A degenerate camera is refused by name") {
    CHECK_THROWS_WITH(in::camera_view({.eye = {1, 2, 3}, .target = {1, 2, 3}}),
                      ContainsSubstring("camera.eye to camera.target is 0"));
    CHECK_THROWS_WITH(in::camera_view({.eye = {1e200, 0, 0}}), ContainsSubstring("camera.eye to camera.target is inf"));
    CHECK_THROWS_WITH(in::camera_view({.up = {0, 0, 0}}), ContainsSubstring("length of camera.up is 0"));
    CHECK_THROWS_WITH(in::camera_view({.eye = {0, 0, 3}, .target = {0, 0, 0}}),
                      ContainsSubstring("camera.up to the line of sight is 0"));
    // Also where rounding makes the two differ in their last bits.
    for (const double distance : {0.1, 0.3, 0.7, 1.1})
        for (const glm::dvec3& up : {glm::dvec3(0.3, 0.1, 0.7), glm::dvec3(-1, 0.2, 5)})
            CHECK_THROWS_WITH(in::camera_view({.eye = distance * up, .target = {0, 0, 0}, .up = up}),
                              ContainsSubstring("camera.up to the line of sight is"));
    CHECK_NOTHROW(in::camera_view({.eye = {1e-6, 0, 3}, .target = {0, 0, 0}}));
    CHECK_THROWS_WITH(in::camera_view({.field_of_view = 4}), ContainsSubstring("camera.field_of_view is 4"));
    CHECK_THROWS_WITH(in::camera_view({.z_near = 0}), ContainsSubstring("camera.z_near is 0"));
    CHECK_THROWS_WITH(in::camera_view({.aspect = -1}), ContainsSubstring("camera.aspect is -1"));
    CHECK_THROWS_WITH(in::camera_view({.field_of_view = 1e-39f}), ContainsSubstring("camera.field_of_view"));
    CHECK_THROWS_WITH(in::camera_view({.aspect = 1e-40f}), ContainsSubstring("camera.aspect"));
}
