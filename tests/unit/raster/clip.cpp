// Clipping: the visible part equals what rays hit, and adjacent triangles share the vertices on a clipped edge.
#include <insonify/core/random.hpp>

#include <algorithm>
#include <cmath>

#include "../../catch.hpp"
#include "../../larger.hpp"
#include "pixel_space.hpp"

namespace in = insonify;
using namespace testing_raster;

namespace {

using in::detail::clip_polygon;

const in::detail::projection to_small_screen(in::detail::pixel_grid{8, 64, 64}, in::depth_compare::less, true);

glm::dvec4 any_position(in::random_sequence& random) {
    const auto at = [&] { return random.uniform(-3, 3); };
    glm::dvec4 p{at(), at(), at(), at()};
    if (random.below(4) == 0) p *= 1e15;  // beyond the widest plane, too
    return p;
}

/// The new corners on the edge from vertex 0 to vertex 1 of a clipped triangle.
std::vector<glm::dvec4> cuts_of_first_edge(const clip_polygon& polygon) {
    std::vector<glm::dvec4> cuts;
    for (int i = 0; i < polygon.count; ++i) {
        const auto& corner = polygon.corners[static_cast<std::size_t>(i)];
        const bool is_new = corner.weights.x < 1 && corner.weights.y < 1;
        if (corner.weights.z == 0 && is_new) cuts.push_back(corner.position);
    }
    return cuts;
}

}  // namespace

TEST_CASE("Corners that rounding puts on alternate sides of a plane do not overflow the clipped polygon") {
    const std::array<glm::dvec4, 3> corners = {{{0x1.4ad70cp-66, -0x1.8bp-65, 0x1.b921a6p-99, 0x1.e4e0cp-98},
                                                {-0x1.26f77ap-64, -0x1.e8p-66, 0x1.4cc0acp-97, 0x1.2b85p-98},
                                                {0x1.cd4cc8p-66, 0x1.4p-70, -0x1.d4d4aap-99, -0x1.88dp-103}}};
    for (const bool exact : {false, true}) {
        const in::detail::projection screen(in::detail::pixel_grid{8, 1391, 1257}, in::depth_compare::less, exact);
        const clip_polygon polygon = screen.clip(corners);
        CHECK(polygon.count <= static_cast<int>(polygon.corners.size()));
    }
}

TEST_CASE("Triangles that share a clipped edge get the same new vertices, to the bit") {
    in::random_sequence random(3);
    int cut_once = 0, cut_twice = 0;
    for (int n = 0; n < 20000; ++n) {
        const glm::dvec4 a = any_position(random), b = any_position(random);
        const auto left = cuts_of_first_edge(to_small_screen.clip({a, b, any_position(random)}));
        const auto right = cuts_of_first_edge(to_small_screen.clip({b, a, any_position(random)}));
        if (left.size() != right.size()) continue;  // a plane cut off the edge together with one of the third corners
        cut_once += left.size() == 1;
        cut_twice += left.size() == 2;
        for (const glm::dvec4& cut : left) {
            bool found = false;
            for (const glm::dvec4& other : right) found |= cut == other;
            if (!found) FAIL("pair " << n);
        }
    }
    CHECK(cut_once > 1000);
    CHECK(cut_twice > 300);
}

TEST_CASE("Clipped triangles keep their varyings, weights and depths") {
    // Looking along y from the origin over a tilted plane z = 0.2 y - 1 that goes on behind the eye.
    const auto along = [](const in::vertex& v) {
        const glm::vec3& p = v.position;
        return in::vertex_output<glm::vec3>{{p.x, p.z, (p.y - 0.5f) * 1.25f, p.y}, p};
    };
    const in::mesh m{{{-40, -30, -7}, {45, -20, -5}, {3, 60, 11}}, {}, {{0, 1, 2}}};
    in::image<float> depth(64, 64);
    double worst = 0;
    const auto stats = in::draw(
        m, along,
        [&](const in::fragment<glm::vec3>& f) {
            const double right = (f.x + 0.5) / 32 - 1, up = 1 - (f.y + 0.5) / 32;
            const double y = 1 / (0.2 - up);  // where the ray (right, 1, up) y meets the plane
            const glm::dvec3 hit(right * y, y, up * y), off = glm::dvec3(f.varyings) - hit;
            glm::dvec3 mean(0);
            for (int i = 0; i < 3; ++i)
                mean += static_cast<double>(f.weights[i]) * glm::dvec3(m.positions[static_cast<std::size_t>(i)]);
            for (const double error :
                 {off.x / y, off.y / y, (mean.y - hit.y) / y, static_cast<double>(f.depth) - (y - 0.5) * 1.25 / y})
                worst = larger(worst, std::abs(error));
        },
        in::framebuffer<void>{depth}, {.load = in::depth_load::clear, .subpixel_bits = 16});
    CHECK(stats.clipped == 1);
    CHECK(stats.pixels > 500);
    CHECK(worst < 3e-5);
}

TEST_CASE("Depths of exactly 0 and 1 are visible, with near corners and with far ones") {
    const float z = GENERATE(0.0f, 1.0f);
    const float reach = GENERATE(1e2f, 1e8f);
    const in::mesh m{{{-reach, -reach, z}, {reach, -reach, z}, {0, reach, z}}, {}, {{0, 1, 2}}};
    const auto place = [](const in::vertex& v) { return glm::vec4(v.position, 1); };
    in::image<float> depth(8, 8);
    const auto stats = in::draw(m, place, in::depth_target{depth}, {.load = in::depth_load::clear});
    CHECK(stats.drawn == 1);
    CHECK(stats.clipped == 0);
    for (const float d : depth.pixels()) CHECK(d == z);
}

namespace {

/// Pixels that a triangle covers whose corners have z = depth * w in clip space.
in::image<int> covered(const glm::vec3 (&corners)[3], float depth) {
    const in::mesh m{{corners[0], corners[1], corners[2]}, {}, {{0, 1, 2}}};
    return hits(m, 24, 20, [=](const in::vertex& v) {
        const glm::vec3& p = v.position;
        return glm::vec4(p.x, p.y, depth * p.z, p.z);
    });
}

}  // namespace

TEST_CASE("A triangle across the camera's plane covers the same pixels at any depth, including 0 and 1") {
    const glm::vec3 known[] = {{-0x1.66cc54p-5f, 0x1.a1030ap-4f, 0x1.425f8ap-1f},
                               {0x1.a7418p-4f, 0x1.86626ep-1f, 0x1.1a9606p-3f},
                               {-0x1.543be6p+0f, -0x1.98572cp-2f, -0x1.ace2b2p-2f}};
    for (const float depth : {0.0f, 0.25f, 0.5f, 1.0f}) CHECK(total(covered(known, depth)) == 114);

    in::random_sequence random(8);
    int crossing = 0, different = 0;
    for (int n = 0; n < 3000; ++n) {
        glm::vec3 corners[3];
        for (glm::vec3& c : corners)
            for (int i = 0; i < 3; ++i) c[i] = static_cast<float>(random.uniform(-1, 1));
        const auto [least, most] = std::minmax({corners[0].z, corners[1].z, corners[2].z});
        if (least >= 0 || most <= 0) continue;
        const in::image<int> expected = covered(corners, 0.5f);
        crossing += total(expected) > 0;
        for (const float depth : {0.0f, 0.25f, 1.0f}) different += !(covered(corners, depth) == expected);
    }
    CHECK(crossing > 1000);
    CHECK(different == 0);
}

TEST_CASE("Corners are rounded to nearest up to 2^27 sub-pixels, and beyond to the rounding of doubles") {
    __extension__ using wide = __int128;
    in::random_sequence random(4);
    for (const int width : {64, 2047, 4194303}) {
        const in::detail::projection exact(in::detail::pixel_grid{8, width, 64}, in::depth_compare::less, true);
        int near_ties = 0;
        for (int n = 0; n < 200000; ++n) {
            // x / w in sub-pixels, as close to a tie between two of them as such floats come: the closest of several
            // candidates.
            const auto w = static_cast<std::int64_t>(random.below(1u << 23) + (1u << 23));
            const auto from = static_cast<std::int64_t>(random.below(1u << 23));
            const int scale = static_cast<int>(random.below(36));
            const std::int64_t unit = std::int64_t{width} << 7;  // half of the picture
            std::int64_t x = 0;
            wide closest = wide{1} << 120;
            for (std::int64_t candidate = from; candidate < from + 20; ++candidate) {
                const wide twice = 2 * ((wide{candidate} * unit) << scale);
                const wide off = twice % (2 * w) - w, size = off < 0 ? -off : off;
                if (size == 0 || size >= closest) continue;
                closest = size;
                x = candidate;
            }
            const wide units = (wide{x} * unit) << scale;
            if (closest == wide{1} << 120 || units / w >= wide{1} << 50) continue;
            const auto clip_x = std::ldexp(static_cast<double>(x), scale);
            const std::int64_t at = exact.to_screen({clip_x, 0, 0, static_cast<double>(w)}).x - unit;
            const wide off = units - wide{at} * w, size = off < 0 ? -off : off;  // in sub-pixels over w
            const wide allowed = units < (w * (wide{1} << 27)) ? 0 : (units >> 52) + 1;
            near_ties += 2 * closest < w / 4;
            if (2 * size > w + 2 * allowed) FAIL("corner " << x << " * 2^" << scale << " / " << w << " of " << width);
        }
        CHECK(near_ties > 1000);
    }
}
