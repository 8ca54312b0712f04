// Clipped polygons that snapping folds over themselves, against a sum of triangles judged by an exact oracle.
#include <insonify/core/random.hpp>
#include <insonify/raster/detail/screen_polygon.hpp>
#include <insonify/raster/draw.hpp>

#include <algorithm>

#include "../../catch.hpp"
#include "pixel_space.hpp"

namespace in = insonify;
using namespace testing_raster;

namespace {

constexpr int screen_size = 24, screen_bits = 4;  // a coarse grid folds often

in::detail::clip_polygon polygon_of(const std::vector<glm::dvec2>& pixels) {
    in::detail::clip_polygon polygon;
    for (const glm::dvec2& p : pixels)
        polygon.corners[static_cast<std::size_t>(polygon.count++)].position = {p.x / screen_size * 2 - 1,
                                                                               1 - p.y / screen_size * 2, 0.5, 1};
    return polygon;
}

/// A thin convex polygon: points in order around a flat ellipse.
std::vector<glm::dvec2> thin_polygon(in::random_sequence& random) {
    const int n = 4 + static_cast<int>(random.below(4));
    const auto [sine, cosine] = in::numeric::sin_cos_turns(random.uniform());
    const glm::dvec2 middle{random.uniform(4, 20), random.uniform(4, 20)},
        along = random.uniform(2, 20) * glm::dvec2(cosine, sine),
        across = random.uniform(0, 0.3) * glm::dvec2(-sine, cosine);
    std::vector<glm::dvec2> points;
    for (int i = 0; i < n; ++i) {
        const auto [s, c] = in::numeric::sin_cos_turns((i + random.uniform()) / n);
        points.push_back(middle + c * along + s * across);
    }
    return points;
}

}  // namespace

TEST_CASE("The parts of a polygon cover the pixels of non-zero winding number in its direction") {
    in::random_sequence random(6);
    const in::detail::pixel_grid grid{screen_bits, screen_size, screen_size};
    const in::detail::projection to_screen(grid, in::depth_compare::less, true);
    int folded = 0, covered = 0;
    for (int n = 0; n < 4000; ++n) {
        const auto points = thin_polygon(random);
        const in::detail::screen_polygon polygon(polygon_of(points), to_screen);
        in::image<int> count(screen_size, screen_size), winding(screen_size, screen_size);
        bool has_spans = false;
        polygon.for_each_part(grid, [&](std::array<int, 3> corners, const in::rect& pixels, bool is_span) {
            has_spans |= is_span;
            glm::dvec2 corner[3];
            for (std::size_t k = 0; k < 3; ++k) corner[k] = points[static_cast<std::size_t>(corners[k])];
            const oracle part(corner, screen_bits);
            for (int y = pixels.y0; y < pixels.y1; ++y)
                for (int x = pixels.x0; x < pixels.x1; ++x) count(x, y) += is_span || part.covers(x, y) ? 1 : 0;
        });
        for (std::size_t i = 1; i + 1 < points.size(); ++i) {
            const oracle part({points[0], points[i], points[i + 1]}, screen_bits);
            for (int y = 0; y < screen_size; ++y)
                for (int x = 0; x < screen_size; ++x)
                    if (part.covers(x, y)) winding(x, y) += part.is_clockwise() ? 1 : -1;
        }
        folded += has_spans;
        covered += total(count);
        for (std::size_t i = 0; i < count.size(); ++i)
            if (count.pixels()[i] != (winding.pixels()[i] * polygon.area_sign() > 0 ? 1 : 0)) FAIL("polygon " << n);
    }
    CHECK(folded > 200);
    CHECK(covered > 1000);
}

TEST_CASE("A span of a folded polygon is drawn to its ends and no further") {
    // Runs as tiles draw them: a needle cut by two planes, on a grid coarse enough to fold it, in tiles of two sizes.
    in::random_sequence random(7);
    int folded = 0;
    for (int n = 0; n < 3000; ++n) {
        const auto points = thin_polygon(random);
        // The same outline as a triangle that reaches behind the camera, where it is cut off.
        in::mesh m{{}, {}, {{0, 1, 2}}};
        for (const std::size_t i : {0u, 1u, 3u})
            m.positions.emplace_back(points[i], i == 3 ? -0.4 : 0.5 + 0.3 * static_cast<double>(i));
        const auto place = [](const in::vertex& v) {
            const glm::vec4 p = pixel_space{screen_size, screen_size}({{v.position.x, v.position.y, 0}, {}, 0});
            return glm::vec4(p.x * v.position.z, p.y * v.position.z, v.position.z * 0.9f - 0.05f, v.position.z);
        };
        const in::detail::pixel_grid grid{screen_bits, screen_size, screen_size};
        const in::detail::projection to_screen(grid, in::depth_compare::less, true);
        std::array<glm::dvec4, 3> clip;
        for (std::uint32_t i = 0; i < 3; ++i) clip[i] = glm::dvec4(place({m.positions[i], {}, i}));
        const auto cut = to_screen.clip(clip);
        in::image<int> expected(screen_size, screen_size);
        if (cut.count >= 3) {
            std::vector<glm::dvec2> corners;
            for (int i = 0; i < cut.count; ++i)
                corners.push_back(
                    on_screen(cut.corners[static_cast<std::size_t>(i)].position, screen_size, screen_size));
            for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
                const oracle part({corners[0], corners[i], corners[i + 1]}, screen_bits);
                for (int y = 0; y < screen_size; ++y)
                    for (int x = 0; x < screen_size; ++x)
                        if (part.covers(x, y)) expected(x, y) += part.is_clockwise() ? 1 : -1;
            }
            const in::detail::screen_polygon polygon(cut, to_screen);
            polygon.for_each_part(grid, [&](const auto&, const auto&, bool is_span) { folded += is_span; });
            for (int& winding : expected.pixels()) winding = winding * polygon.area_sign() > 0 ? 1 : 0;
        }
        for (const int tile : {8, 32}) {
            // A pixel has a fragment and a depth where the needle is, and neither elsewhere.
            in::image<int> count(screen_size, screen_size), deep(screen_size, screen_size);
            in::image<float> depth(screen_size, screen_size);
            in::draw(m, place, [&](const auto& f) { ++count(f.x, f.y); }, in::framebuffer<void>{depth},
                     {.load = in::depth_load::clear, .subpixel_bits = screen_bits, .tile = tile});
            for (std::size_t i = 0; i < deep.size(); ++i) deep.pixels()[i] = depth.pixels()[i] <= 1;
            if (count != expected || deep != expected) FAIL("needle " << n);
        }
    }
    CHECK(folded > 5);
}

TEST_CASE("Fragments of a folded polygon show the side that culling goes by") {
    in::mesh m{std::vector<glm::vec3>(3), {}, {{0, 1, 2}}};
    const glm::vec4 clip[] = {{0.852287352f, 0.104839139f, 1.15889204f, 0.92725271f},
                              {-0.300366759f, 0.33705771f, -0.33109355f, 0.821128845f},
                              {-0.748941541f, 0.749838054f, 1.50292158f, 1.76830506f}};
    for (const bool is_mirrored : {false, true}) {
        in::image<float> depth(32, 32, in::empty_depth(in::depth_compare::less));
        in::image<int> front(32, 32, -1);
        const auto place = [&](const in::vertex& v) {
            const glm::vec4 p = clip[v.index];
            return is_mirrored ? glm::vec4(-p.x, p.y, p.z, p.w) : p;
        };
        in::draw(m, place, [](const auto& f) { return f.front ? 1 : 0; }, in::framebuffer<int>{front, depth},
                 {.cull = is_mirrored ? in::cull_mode::back : in::cull_mode::front, .subpixel_bits = 4});
        CHECK(std::count(front.pixels().begin(), front.pixels().end(), is_mirrored ? 0 : 1) == 0);
        CHECK(std::count(front.pixels().begin(), front.pixels().end(), is_mirrored ? 1 : 0) > 0);
    }
}
