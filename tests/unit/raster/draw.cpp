// draw() beyond coverage: depth, interpolation, clipping, counts, and equal bytes for all settings.
#include <insonify/core/random.hpp>
#include <insonify/core/thread_pool.hpp>

#include <limits>

#include "../../catch.hpp"
#include "../../larger.hpp"
#include "pixel_space.hpp"

namespace in = insonify;
using namespace testing_raster;

namespace {

/// A bumpy ground of (n - 1)^2 cells around the origin, z up, 8 m wide.
in::mesh bumps(std::uint32_t n) {
    in::mesh m;
    in::random_sequence random(5);
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i)
            m.positions.emplace_back(8.0 * i / (n - 1) - 4, 8.0 * j / (n - 1) - 4, random.uniform(-0.4, 0.4));
    for (std::uint32_t j = 0; j + 1 < n; ++j)
        for (std::uint32_t i = 0; i + 1 < n; ++i) {
            const std::uint32_t a = j * n + i;
            m.triangles.push_back({a, a + 1, a + n + 1});
            m.triangles.push_back({a, a + n + 1, a + n});
        }
    return m;
}

/// A pinhole at (0, 0, 3) looking down, 90 degrees wide, reversed depth.
glm::vec4 pinhole(const glm::vec3& p) {
    return {p.x, p.y, 0.01f, 3 - p.z};
}
const auto place_with_position = [](const in::vertex& v) {
    return in::vertex_output<glm::vec3>{pinhole(v.position), v.position};
};
const auto place_only = [](const in::vertex& v) { return pinhole(v.position); };

struct picture {
    in::image<float> color, depth;
    explicit picture(int width, int height) : color(width, height), depth(width, height) {}
    friend bool operator==(const picture&, const picture&) = default;
};

picture draw_bumps(const in::mesh& m, in::draw_options<> options, auto&& ex) {
    picture p(200, 130);
    options.compare = in::depth_compare::greater;
    options.load = in::depth_load::clear;
    in::draw(
        m, place_with_position, [](const in::fragment<glm::vec3>& f) { return f.varyings.z; },
        in::framebuffer<float>{p.color, p.depth}, options, ex);
    return p;
}

template <class Target>
concept accepts_a_fragment = requires(const in::mesh& m, const Target& t) {
    in::draw(
        m, place_only, [](const auto&) { return 1.0f; }, t);
};

}  // namespace

TEST_CASE("draw() gives the same bytes for any executor, thread count, tile size and instruction set", "[threads]") {
    const in::mesh m = bumps(60);
    const picture expected = draw_bumps(m, {.tile = 64, .level = in::isa::scalar}, in::serial_executor{});
    for (const int threads : {1, 2, 3, 8}) {
        in::thread_pool pool(threads);
        for (const int tile : {8, 32, 128})
            for (const in::isa level : {in::isa::scalar, in::isa::baseline, in::isa::avx2})
                CHECK(draw_bumps(m, {.tile = tile, .level = level}, pool) == expected);
    }
}

TEST_CASE("A mesh_view of the caller's buffers is drawn like a mesh") {
    const in::mesh m = bumps(20);
    const std::vector<glm::vec3> positions = m.positions;
    const std::vector<glm::uvec3> triangles = m.triangles;
    const in::draw_options<> options{.compare = in::depth_compare::greater, .load = in::depth_load::clear};
    in::image<float> of_mesh(90, 70), of_buffers(90, 70);
    in::draw(m, place_only, in::depth_target{of_mesh}, options);
    in::draw({positions, {}, triangles}, place_only, in::depth_target{of_buffers}, options);
    CHECK(of_buffers == of_mesh);
}

TEST_CASE("A depth-only draw writes the depth of a shaded one and takes no fragment shader") {
    static_assert(!accepts_a_fragment<in::depth_target>);
    static_assert(accepts_a_fragment<in::framebuffer<float>>);
    const in::mesh m = bumps(30);
    const picture shaded = draw_bumps(m, {}, in::serial_executor{});
    in::image<float> depth(200, 130);
    const auto stats = in::draw(m, place_only, in::depth_target{depth},
                                {.compare = in::depth_compare::greater, .load = in::depth_load::clear});
    CHECK(depth == shaded.depth);
    CHECK(stats.pixels == 0);
}

TEMPLATE_TEST_CASE_SIG("Varyings equal the intersections of rays with the plane", "",
                       ((in::depth_precision Depth), Depth), in::depth_precision::exact, in::depth_precision::quick) {
    // One large tilted triangle, seen by the pinhole: the varying is the position itself.
    const in::mesh m{{{-9, -9, -1}, {9, -9, 1}, {0, 9, 0.5f}}, {}, {{0, 1, 2}}};
    const glm::dvec3 a(m.positions[0]), b(m.positions[1]), c(m.positions[2]);
    const glm::dvec3 u = b - a, v = c - a;
    const glm::dvec3 normal(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
    const auto dot = [](glm::dvec3 p, glm::dvec3 q) { return p.x * q.x + p.y * q.y + p.z * q.z; };
    in::image<float> depth(128, 128);
    double worst = 0, worst_depth = 0;
    const auto stats = in::draw(
        m, place_with_position,
        [&](const in::fragment<glm::vec3>& f) {
            const glm::dvec3 eye(0, 0, 3), ray((f.x + 0.5) / 64 - 1, 1 - (f.y + 0.5) / 64, -1);
            const glm::dvec3 hit = eye + ray * (dot(a - eye, normal) / dot(ray, normal));
            for (int i = 0; i < 3; ++i) worst = larger(worst, std::abs(hit[i] - static_cast<double>(f.varyings[i])));
            worst_depth = larger(worst_depth, std::abs(static_cast<double>(f.depth) * (3 - hit.z) / 0.01 - 1));
            CHECK(f.weights.x + f.weights.y + f.weights.z == Approx(1));
        },
        in::framebuffer<void>{depth},
        in::draw_options<Depth>{.compare = in::depth_compare::greater, .load = in::depth_load::clear});
    CHECK(stats.pixels > 5000);
    // Snapping moves a vertex by up to 2^-9 pixels of 2^-6 m x distance each.
    CHECK(worst < 3e-4);
    CHECK(worst_depth < 3e-4);
}

TEST_CASE("Depth stays between the depths of the corners, on slivers too") {
    // Slivers with a long edge through pixel centres, on which depth is at the end of its range.
    in::random_sequence random(8);
    in::image<float> depth(64, 64);
    int covered = 0, outside = 0;
    for (int n = 0; n < 2000; ++n) {
        const glm::dvec2 a{0.5 + random.below(16), 0.5 + random.below(16)};
        const glm::dvec2 b = a + 8.0 * glm::dvec2{random.below(6), 1 + random.below(5)};
        const double side = random.below(2) == 0 ? -1 : 1;
        const glm::dvec2 c = 0.5 * (a + b) + glm::dvec2(side * (1.0 + random.below(8)) / 256, 0);
        const double edge = random.uniform(), corner = random.uniform();
        const in::mesh m{{glm::vec3(a, edge), glm::vec3(b, edge), glm::vec3(c, corner)}, {}, {{0, 1, 2}, {2, 0, 1}}};
        const std::pair ends = std::minmax({static_cast<float>(edge), static_cast<float>(corner)});
        const auto look = [&](const auto& f) {
            ++covered;
            outside += f.depth < ends.first || f.depth > ends.second || f.depth != depth(f.x, f.y);
        };
        in::draw(m, pixel_space{64, 64}, look, in::framebuffer<void>{depth}, {.load = in::depth_load::clear});
    }
    CHECK(covered > 1000);
    CHECK(outside == 0);
}

TEST_CASE("Nothing is drawn in front of depth 0 or behind depth 1") {
    const in::mesh ramp{{{0, 0, -1}, {64, 0, 3}, {0, 200, -1}, {64, 200, 3}}, {}, {{0, 1, 2}, {1, 3, 2}}};
    const auto count = hits(ramp, 64, 64);
    for (int x = 0; x < 64; ++x) CHECK(count(x, 30) == (x >= 16 && x < 32 ? 1 : 0));
}

TEST_CASE("The nearer surface is visible in any order of drawing; a tie keeps the first") {
    const auto sheet = [](float z) { return in::mesh{{{-9, -9, z}, {9, -9, z}, {0, 9, z}}, {}, {{0, 1, 2}}}; };
    const bool near_first = GENERATE(true, false);
    picture p(32, 32);
    const auto paint = [&](float z, float color, in::depth_load load) {
        in::draw(sheet(z), place_only, [=](const auto&) { return color; }, in::framebuffer<float>{p.color, p.depth},
                 {.compare = in::depth_compare::greater, .load = load});
    };
    paint(near_first ? 1.0f : 0.0f, near_first ? 1.0f : 2.0f, in::depth_load::clear);
    paint(near_first ? 0.0f : 1.0f, near_first ? 2.0f : 1.0f, in::depth_load::keep);
    CHECK(p.color(16, 16) == 1.0f);
    paint(1.0f, 3.0f, in::depth_load::keep);
    CHECK(p.color(16, 16) == 1.0f);
}

TEST_CASE("Triangles that cross the camera plane show the part in front, without cracks") {
    // A floor that passes under and behind a camera which looks along y from 1 m above.
    const auto along = [](const in::vertex& v) {
        const glm::vec3& p = v.position;
        return glm::vec4(p.x, p.z - 1, 0.01f, p.y);
    };
    in::mesh floor;
    const std::uint32_t n = 8;
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) floor.positions.emplace_back(400.0 * i - 1400.0, 400.0 * j - 1390.0, 0.0);
    for (std::uint32_t j = 0; j + 1 < n; ++j)
        for (std::uint32_t i = 0; i + 1 < n; ++i) {
            const std::uint32_t a = j * n + i;
            floor.triangles.push_back({a, a + 1, a + n + 1});
            floor.triangles.push_back({a, a + n + 1, a + n});
        }
    const int bits = GENERATE(8, 12);
    const auto count = hits(floor, 64, 64, along, {.compare = in::depth_compare::greater, .subpixel_bits = bits});
    CHECK(max_count(count) == 1);
    for (int y = 34; y < 64; ++y)
        for (int x = 0; x < 64; ++x) CHECK(count(x, y) == 1);  // all below the horizon
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) CHECK(count(x, y) == 0);
}

TEST_CASE("Triangles with NaN or infinite vertices are skipped and counted, and change no pixel") {
    const in::mesh good = bumps(12);
    const float bad = GENERATE(std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                               -std::numeric_limits<float>::infinity());
    const int component = GENERATE(0, 1, 2);
    in::mesh broken = good;
    broken.positions[30][component] = bad;
    in::mesh without = good;
    std::erase_if(without.triangles, [](const glm::uvec3& t) { return t.x == 30 || t.y == 30 || t.z == 30; });
    CHECK(draw_bumps(broken, {}, in::serial_executor{}) == draw_bumps(without, {}, in::serial_executor{}));

    in::image<float> depth(64, 64);
    const auto stats = in::draw(broken, place_only, in::depth_target{depth}, {.load = in::depth_load::clear});
    CHECK(stats.not_finite == good.triangles.size() - without.triangles.size());
    CHECK(stats.triangles == good.triangles.size());
}

TEST_CASE("Every triangle is counted exactly once in the statistics") {
    in::mesh m{{{1, 1, 0}, {6, 1, 0}, {1, 6, 0}, {3, 3, 0}, {100, 100, 0}, {101, 100, 0}, {100, 101, 0}, {2, 6, 5}},
               {},
               {{0, 1, 2}, {0, 2, 1}, {3, 3, 3}, {4, 6, 5}, {0, 7, 1}}};
    in::image<float> depth(8, 8);
    const auto stats = in::draw(m, pixel_space{8, 8}, in::depth_target{depth},
                                {.cull = in::cull_mode::back, .load = in::depth_load::clear});
    CHECK(stats.triangles == 5);
    CHECK(stats.culled == 1);      // clockwise as seen: y is down, so {0, 1, 2}
    CHECK(stats.degenerate == 1);  // three times the same vertex
    CHECK(stats.missed == 1);      // outside
    CHECK(stats.clipped == 1);     // one vertex beyond the depth range
    CHECK(stats.drawn + stats.culled + stats.missed + stats.degenerate + stats.not_finite == stats.triangles);
    CHECK(stats.drawn >= 2);  // {0, 2, 1}, and what is left of the clipped one
}

TEST_CASE("Triangles outside of the picture count as missed; those that touch a pixel centre do not") {
    // On either side of 8 x 8 pixels: one that has no area, one that is culled, one that goes on for 4000 pixels. Each
    // is repeated, so that lanes are full of such triangles. Beyond 2 million pixels, triangles take 128 bits.
    const float beyond = GENERATE(-5000.0f, 7.5f, -1e7f, 1e7f);  // the last centre doesn't belong to what begins at 7.5
    const bool along_y = GENERATE(false, true);
    const auto at = [&](float past, float level) {
        return along_y ? glm::vec3(level, beyond + past, 0) : glm::vec3(beyond + past, level, 0);
    };
    const auto level = GENERATE(as<in::isa>(), in::isa::scalar, in::best_isa());
    for (const in::cull_mode cull : {in::cull_mode::none, in::cull_mode::back, in::cull_mode::front}) {
        in::mesh m{{at(0.01f, 4), at(1, 4), at(0.01f, 5), at(4000, 4)}, {}, {}};
        for (int i = 0; i < 37; ++i) m.triangles.insert(m.triangles.end(), {{0, 0, 0}, {0, 1, 2}, {0, 2, 3}});
        in::image<float> depth(8, 8);
        const in::draw_options<> options{.cull = cull, .load = in::depth_load::clear, .level = level};
        auto stats = in::draw(m, pixel_space{8, 8}, in::depth_target{depth}, options);
        CHECK(stats.missed == m.triangles.size());
        if (beyond != 7.5f) continue;
        // A quarter of a pixel nearer, they cover the last row or column of centres.
        for (glm::vec3& p : m.positions) p[along_y ? 1 : 0] -= 0.25f;
        stats = in::draw(m, pixel_space{8, 8}, in::depth_target{depth}, options);
        CHECK(stats.degenerate == m.triangles.size() / 3);
        CHECK(stats.missed + stats.drawn + stats.culled == m.triangles.size() / 3 * 2);
        CHECK((cull != in::cull_mode::none || stats.drawn > 0));
    }
}

TEST_CASE("Clipped triangles keep their indices") {
    // 20000 triangles in 200 x 100 cells of two pixels; every third one reaches behind the far plane, outside its cell.
    const int width = 400, height = 200;
    in::mesh m;
    for (int cell = 0; cell < 20000; ++cell) {
        const auto x = static_cast<float>(cell % 200 * 2), y = static_cast<float>(cell / 200 * 2);
        const auto first = static_cast<std::uint32_t>(m.positions.size());
        const float end = cell % 3 == 0 ? 3.0f : 0.5f;  // depth of the corner that may be cut off
        m.positions.insert(m.positions.end(), {{x, y, 0.5f}, {x + 2, y, 0.5f}, {x, y + 2 * (end + 0.5f), end}});
        m.triangles.emplace_back(first, first + 1, first + 2);
    }
    in::image<std::uint32_t> triangle_ids(width, height);
    in::image<float> depth(width, height);
    const auto stats = in::draw(m, pixel_space{width, height}, [](const auto& f) { return f.triangle; },
                                in::framebuffer<std::uint32_t>{triangle_ids, depth}, {.load = in::depth_load::clear});
    CHECK(stats.clipped == 6667);
    std::size_t wrong = 0;
    for (std::uint32_t cell = 0; cell < 20000; ++cell)
        wrong += triangle_ids(static_cast<int>(cell % 200 * 2), static_cast<int>(cell / 200 * 2)) != cell;
    CHECK(wrong == 0);

    // The same picture from slices of the mesh, one after the other.
    in::image<std::uint32_t> sliced(width, height);
    for (std::size_t first = 0; first < m.triangles.size(); first += 1000) {
        in::mesh slice{m.positions, {}, {}};
        for (std::size_t i = first; i < first + 1000; ++i) slice.triangles.push_back(m.triangles[i]);
        in::draw(slice, pixel_space{width, height},
                 [=](const auto& f) { return f.triangle + static_cast<std::uint32_t>(first); },
                 in::framebuffer<std::uint32_t>{sliced, depth},
                 {.load = first == 0 ? in::depth_load::clear : in::depth_load::keep});
    }
    CHECK(triangle_ids == sliced);
}

TEST_CASE("The front side follows the winding") {
    in::mesh front{{{1, 1, 0}, {1, 6, 0}, {6, 1, 0}}, {}, {}};  // counter-clockwise, y being down
    front.triangles.assign(19, {0, 1, 2});                      // some fill the lanes, some are left over
    in::mesh back = front;
    back.triangles.assign(19, {0, 2, 1});
    const in::isa level = GENERATE(in::isa::scalar, in::isa::baseline, in::isa::avx2);
    const auto drawn = [&](const in::mesh& m, in::cull_mode cull) {
        in::image<float> depth(8, 8);
        const in::draw_options<> options{.cull = cull, .load = in::depth_load::clear, .level = level};
        const in::draw_stats stats = in::draw(m, pixel_space{8, 8}, in::depth_target{depth}, options);
        CHECK(stats.drawn + stats.culled == 19);
        CHECK((depth(2, 2) == 0) == (stats.drawn > 0));
        return stats.drawn;
    };
    CHECK(drawn(front, in::cull_mode::none) == 19);
    CHECK(drawn(back, in::cull_mode::none) == 19);
    CHECK(drawn(front, in::cull_mode::back) == 19);
    CHECK(drawn(front, in::cull_mode::front) == 0);
    CHECK(drawn(back, in::cull_mode::back) == 0);
    CHECK(drawn(back, in::cull_mode::front) == 19);
}

TEST_CASE("Empty meshes and pictures of odd sizes are drawn") {
    const auto [width, height] = GENERATE(std::pair{1, 1}, std::pair{1, 500}, std::pair{2047, 3}, std::pair{0, 5});
    in::image<float> depth(width, height, 7.0f);
    CHECK(in::draw(in::mesh{}, place_only, in::depth_target{depth}) == in::draw_stats{});
    for (const float d : depth.pixels()) CHECK(d == 7.0f);

    const in::mesh cover{{{-9, -9, 0.5f}, {9, -9, 0.5f}, {0, 18, 0.5f}}, {}, {{0, 1, 2}}};
    in::draw(cover, [](const in::vertex& v) { return glm::vec4(v.position, 1); }, in::depth_target{depth},
             {.load = in::depth_load::clear});
    for (const float d : depth.pixels()) CHECK(d == 0.5f);
}

TEST_CASE("Input out of range is refused before any pixel changes") {
    const in::mesh m{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 3}}};
    in::image<float> depth(4, 4, 7.0f);
    REQUIRE_THROWS_WITH(in::draw(m, place_only, in::depth_target{depth}, {.load = in::depth_load::clear}),
                        ContainsSubstring("mesh.triangles is 3, expected an index below 3"));
    const in::mesh one_normal{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}}, {{0, 1, 2}}};
    REQUIRE_THROWS_WITH(in::draw(one_normal, place_only, in::depth_target{depth}),
                        ContainsSubstring("mesh.normals.size() is 1, expected 0 or 3"));
    const in::mesh fine{};
    REQUIRE_THROWS_WITH(in::draw(fine, place_only, in::depth_target{depth}, {.tile = 48}), ContainsSubstring("tile"));
    REQUIRE_THROWS_WITH(in::draw(fine, place_only, in::depth_target{depth}, {.subpixel_bits = 3}),
                        ContainsSubstring("subpixel_bits is 3"));
    // A view of that many pixels without memory behind them: the draw is refused before it reads one.
    const auto wide = [&](int width) {
        return in::depth_target{in::image_view<float>(depth.pixels().data(), width, 1)};
    };
    REQUIRE_THROWS_WITH(in::draw(fine, place_only, wide(16385), {.subpixel_bits = 16}),
                        ContainsSubstring("target width is 16385"));
    REQUIRE_THROWS_WITH(in::draw(fine, place_only, wide((1 << 22) + 1)), ContainsSubstring("target width is 4194305"));
    in::image<float> color(4, 5);
    REQUIRE_THROWS_WITH(in::draw(
                            fine, place_only, [](const auto&) { return 0.0f; }, in::framebuffer<float>{color, depth}),
                        ContainsSubstring("target.color.height() is 5, expected 4, that of the depth image"));
    for (const float d : depth.pixels()) CHECK(d == 7.0f);
}
