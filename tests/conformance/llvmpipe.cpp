// The same triangles drawn here and by Mesa's llvmpipe: which pixels differ, and whether its coarser arithmetic
// explains each. It rounds window coordinates to float before it snaps them to 1/256 pixel, and its depth planes are in
// float.
#include "llvmpipe.hpp"

#include <insonify/all.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "../catch.hpp"
#include "../larger.hpp"
#include "../unit/raster/pixel_space.hpp"

using namespace conformance;
using namespace in::literals;

namespace {

const llvmpipe& peer() {
    static const llvmpipe context;
    return context;
}

/// Skips a test with a warning where llvmpipe is missing.
#define REQUIRE_PEER()                                                   \
    if (peer().renderer().empty()) {                                     \
        WARN("skipped: no llvmpipe through EGL's surfaceless platform"); \
        return;                                                          \
    }

using triangles = std::vector<glm::vec4>;  // three corners each, in clip space

picture drawn_here(const triangles& corners, int width, int height) {
    picture result{in::image<std::uint32_t>(width, height), in::image<float>(width, height)};
    in::mesh m{std::vector<glm::vec3>(corners.size()), {}, {}};
    for (std::uint32_t i = 0; i + 2 < corners.size(); i += 3) m.triangles.emplace_back(i, i + 1, i + 2);
    in::draw(
        m, [&](const in::vertex& v) { return corners[v.index]; }, [](const auto& f) { return f.triangle + 1; },
        in::framebuffer<std::uint32_t>{result.triangle_id, result.depth}, {.load = in::depth_load::clear});
    return result;
}

/// The visible part of a triangle, in pixels, and its plane of depth.
class outline {
  public:
    outline(const glm::vec4* corners, int width, int height) {
        const in::detail::projection to_screen(in::detail::pixel_grid{8, width, height}, in::depth_compare::less, true);
        const auto polygon = to_screen.clip({glm::dvec4(corners[0]), glm::dvec4(corners[1]), glm::dvec4(corners[2])});
        for (int i = 0; i < polygon.count; ++i) {
            const glm::dvec4& p = polygon.corners[static_cast<std::size_t>(i)].position;
            points_.push_back(testing_raster::on_screen(p, width, height));
            depths_.push_back(p.z / p.w);
        }
    }

    /// How far a point is from the nearest edge, pixels.
    double edge_distance(glm::dvec2 p) const {
        double nearest = 1e30;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const glm::dvec2 a = points_[i], ab = points_[(i + 1) % points_.size()] - a, ap = p - a;
            const double square = ab.x * ab.x + ab.y * ab.y;
            const double t = square > 0 ? std::clamp((ap.x * ab.x + ap.y * ab.y) / square, 0.0, 1.0) : 0.0;
            nearest = (std::min)(nearest, std::hypot(ap.x - t * ab.x, ap.y - t * ab.y));
        }
        return nearest;
    }
    /// The largest coordinate, pixels: what rounding to float is relative to.
    double extent() const {
        double largest = 1;
        for (const glm::dvec2& p : points_) largest = (std::max)({largest, std::abs(p.x), std::abs(p.y)});
        return largest;
    }
    /// Depth at a point, and how much that changes over a pixel.
    std::pair<double, double> depth(glm::dvec2 p) const {
        const glm::dvec2 u = points_[1] - points_[0], v = points_[2] - points_[0], q = p - points_[0];
        const double area = u.x * v.y - u.y * v.x, du = depths_[1] - depths_[0], dv = depths_[2] - depths_[0];
        const glm::dvec2 rise((du * v.y - dv * u.y) / area, (dv * u.x - du * v.x) / area);
        return {depths_[0] + rise.x * q.x + rise.y * q.y, std::hypot(rise.x, rise.y)};
    }

  private:
    std::vector<glm::dvec2> points_;
    std::vector<double> depths_;
};

/// Whether a triangle crosses the border of the screen, or the near or far plane.
bool is_clipped(const glm::vec4* corners) {
    return std::any_of(corners, corners + 3, [](const glm::vec4& p) {
        return std::abs(p.x) > p.w || std::abs(p.y) > p.w || p.z < 0 || p.z > p.w;
    });
}

/// How two pictures differ.
struct comparison {
    int covered = 0, different = 0, at_edges = 0, in_depth = 0, unexplained = 0;
    int coverage_differs = 0, depth_differs = 0;
    double depth_error = 0;

    /// @param snap  pixels within which llvmpipe may have moved a corner
    comparison(const triangles& corners, int width, int height, double snap) {
        const picture ours = drawn_here(corners, width, height), theirs = peer().draw(corners, width, height);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const glm::dvec2 centre(x + 0.5, y + 0.5);
                const std::uint32_t a = ours.triangle_id(x, y), b = theirs.triangle_id(x, y);
                covered += a != 0;
                coverage_differs += (a != 0) != (b != 0);
                if (a == b) {
                    if (a == 0) continue;
                    const double error =
                        std::abs(static_cast<double>(ours.depth(x, y)) - static_cast<double>(theirs.depth(x, y)));
                    depth_error = larger(depth_error, error);
                    // Snapping a corner moves the depth plane by its rise, and depths are floats. llvmpipe cuts clipped
                    // triangles into parts: the planes of thin ones, in float, have up to 2.3 times that error here.
                    const glm::vec4* const triangle = &corners[3 * (a - 1)];
                    const double rise = outline(triangle, width, height).depth(centre).second;
                    depth_differs += !(error <= (is_clipped(triangle) ? 4 : 1) * snap * rise + 0x1p-23);
                    continue;
                }
                ++different;
                bool at_edge = false;
                double between = 0, moved = 0, sign = 1;
                for (const std::uint32_t number : {a, b}) {
                    if (number == 0) continue;
                    const outline shape(&corners[3 * (number - 1)], width, height);
                    at_edge |= shape.edge_distance(centre) <= snap + shape.extent() * 0x1p-23;
                    const auto [depth, rise] = shape.depth(centre);
                    between += sign * depth;
                    moved += snap * rise;
                    sign = -1;
                }
                // Snapping a triangle's corners moves its depth plane, on slivers far.
                const bool contested = a != 0 && b != 0 && std::abs(between) <= moved + 1e-5;
                if (at_edge)
                    ++at_edges;
                else if (contested)
                    ++in_depth;
                else
                    ++unexplained;
            }
    }

    void print(const char* scene) const {
        std::printf(
            "%-34s %8d covered, %6d differ (%.4f %%): %d at edges, %d in depth, %d unexplained; depth within %.1e\n",
            scene, covered, different, 100.0 * different / (std::max)(covered, 1), at_edges, in_depth, unexplained,
            depth_error);
    }
};

/// Corners given in pixels, on the screen of that size.
triangles on_screen(const std::vector<glm::vec3>& pixels, int width, int height) {
    const testing_raster::pixel_space space{width, height};
    triangles corners;
    for (const glm::vec3& p : pixels) corners.push_back(space({p, {}, 0}));
    return corners;
}

triangles seen_by(const in::mesh& m, auto&& vertex_shader) {
    triangles corners;
    for (const glm::uvec3& t : m.triangles)
        for (int i = 0; i < 3; ++i) corners.push_back(vertex_shader(m.positions[t[i]]));
    return corners;
}

/// Half of 1/256 pixel along the diagonal, in either renderer.
constexpr double snapping = 2 * 0.71 / 256;

}  // namespace

TEST_CASE("Corners on the sub-pixel grid give llvmpipe's pixels") {
    REQUIRE_PEER();
    const int size = 256;
    const double step = GENERATE(1.0 / 256, 1.0 / 16, 0.5, 1.0);
    const bool inside = GENERATE(true, false);
    in::random_sequence random(1);
    std::vector<glm::vec3> pixels;
    for (int n = 0; n < 4000; ++n) {
        const double spread = n % 9 == 0 ? 256 : n % 3 == 0 ? 60 : n % 3 == 1 ? 12 : 2;
        const glm::dvec2 middle{random.uniform(0, size), random.uniform(0, size)};
        for (int i = 0; i < 3; ++i) {
            glm::dvec2 p = middle + spread * glm::dvec2{random.uniform(-1, 1), random.uniform(-1, 1)};
            if (inside) p = glm::dvec2(std::clamp(p.x, 0.0, 1.0 * size), std::clamp(p.y, 0.0, 1.0 * size));
            pixels.emplace_back(std::nearbyint(p.x / step) * step, std::nearbyint(p.y / step) * step, (n + 1) / 8192.0);
        }
    }
    const comparison result(on_screen(pixels, size, size), size, size, inside ? 0 : snapping);
    result.print(
        ("grid of 1/" + std::to_string(static_cast<int>(1 / step)) + (inside ? "" : ", across the border")).c_str());
    CHECK(result.covered > size * size / 2);
    CHECK(result.unexplained == 0);
    CHECK(result.depth_differs == 0);
    // llvmpipe cuts what crosses the border, in float: that moves an edge by less than its snapping does.
    CHECK(result.different <= (inside ? 0 : result.covered / 2000));
}

TEST_CASE("Published cases give llvmpipe's pixels") {
    REQUIRE_PEER();
    // Direct3D's pair, DRTK issue 9, and Khronos' clipped_full: fifteen turned squares that cover the screen.
    const auto same = [&](const char* name, const std::vector<glm::vec3>& pixels, int size) {
        const comparison result(on_screen(pixels, size, size), size, size, snapping);
        result.print(name);
        CHECK(result.covered > 0);
        CHECK(result.unexplained == 0);
        CHECK(result.depth_differs == 0);
        return result;
    };
    CHECK(same("Direct3D's pair",
               {{.5f, .5f, 0}, {5.5f, .5f, 0}, {5.5f, 5.5f, 0}, {.5f, 5.5f, 0}, {.5f, .5f, 0}, {5.5f, 5.5f, 0}}, 8)
              .different == 0);
    const glm::vec3 d[4] = {{.5f, .49993896484375f, 0},
                            {.5f, 6.5f, 0},
                            {6.50006103515625f, .49993896484375f, 0},
                            {6.50006103515625f, 6.5f, 0}};
    CHECK(same("DRTK issue 9", {d[0], d[1], d[2], d[3], d[2], d[1]}, 8).different == 0);
    for (int turn = 0; turn < 15; ++turn) {
        const auto [sine, cosine] = in::numeric::sin_cos_turns(turn / 56.0);
        const glm::vec3 h(64 * cosine, 64 * sine, 0), v(h.y, -h.x, 0), c(32, 32, 0.5);
        const glm::vec3 q[4] = {c + h + v, c + h - v, c - h - v, c - h + v};
        CHECK(same("a turned square over the screen", {q[0], q[1], q[2], q[2], q[0], q[3]}, 64).coverage_differs == 0);
    }
}

TEST_CASE("Random triangles differ from llvmpipe's only within its snapping") {
    REQUIRE_PEER();
    const std::uint64_t seed = GENERATE(1u, 2u, 3u);
    const double reach = GENERATE(1.0, 10000.0);
    in::random_sequence random(seed);
    const int width = 1000, height = 700;
    std::vector<glm::vec3> pixels;
    for (int n = 0; n < 6000; ++n) {
        const glm::dvec2 middle{random.uniform(0, width), random.uniform(0, height)};
        const double spread = reach > 1 && n % 50 == 0 ? reach : n % 3 == 0 ? 1.0 : n % 3 == 1 ? 10.0 : 150.0;
        const glm::dvec2 along{random.uniform(-1, 1), random.uniform(-1, 1)};
        for (int i = 0; i < 3; ++i) {
            glm::dvec2 p = middle + spread * glm::dvec2{random.uniform(-1, 1), random.uniform(-1, 1)};
            if (n % 7 == 0) p = middle + 200 * random.uniform(-1, 1) * along + glm::dvec2(random.uniform(-1, 1));
            pixels.emplace_back(p, random.uniform(0.01, 0.99));
        }
    }
    const comparison result(on_screen(pixels, width, height), width, height, snapping);
    result.print(reach > 1 ? "random, corners up to 1e4 pixels" : "random triangles");
    CHECK(result.unexplained == 0);
    CHECK(result.depth_differs == 0);
    CHECK(result.different < result.covered / 200);
}

TEST_CASE("A seabed seen along the ground, across the near plane, differs from llvmpipe's only within its snapping") {
    REQUIRE_PEER();
    in::mesh scene = in::seabed::tessellate(
        in::seabed::sample(in::seabed::ripples{.wavelength = 1.5f, .steepness = 0.13f}, {{-20, -20}, 0.25, 161, 161}));
    for (glm::vec3& p : scene.positions) p += glm::vec3(-20, -20, 0);
    const auto add = [&](const in::mesh& m, const in::pose& where) {
        const auto first = static_cast<std::uint32_t>(scene.positions.size());
        for (const glm::vec3& p : in::transformed(m, in::to_world(where)).positions) scene.positions.push_back(p);
        for (const glm::uvec3& t : m.triangles) scene.triangles.push_back(t + first);
    };
    add(to_mesh(in::sphere{.radius = 0.7f}), {.position = {1, 4, 0.5}});
    add(to_mesh(in::cylinder{.radius = 0.4f, .length = 2}), {.position = {-2, 6, 0.4}, .yaw = 30_deg});
    add(to_mesh(in::cone{.radius = 0.6f, .height = 1}), {.position = {3, 9, 0}});
    const auto camera = [](const glm::vec3& p) {
        // At (0, 0, 1.2), looking forward and a little down; from 0.3 m to 40 m.
        const float forward = p.y * 0.96f - (p.z - 1.2f) * 0.28f, up = (p.z - 1.2f) * 0.96f + p.y * 0.28f;
        return glm::vec4(p.x, up * 1.4f, (forward - 0.3f) * 40 / 39.7f, forward);
    };
    const comparison result(seen_by(scene, camera), 700, 500, snapping);
    result.print("seabed along the ground");
    CHECK(result.unexplained == 0);
    CHECK(result.depth_differs == 0);
    CHECK(result.different < result.covered / 100);
    CHECK(!peer().failed());
}
