// Extreme input of draw(): drawn correctly, skipped and counted without changing other pixels, or refused.
#include <insonify/core/random.hpp>
#include <insonify/geometry/transform.hpp>

#include <limits>

#include "../../catch.hpp"
#include "pixel_space.hpp"

namespace in = insonify;
using namespace testing_raster;

namespace {

using limits = std::numeric_limits<float>;

/// A triangle over the whole picture, and one whose vertices a test overwrites.
struct overwritten_triangle {
    glm::vec4 clip[6] = {{-3, -3, 0.5f, 1},  {3, -3, 0.5f, 1},  {0, 5, 0.5f, 1},
                         {-1, -1, 0.25f, 1}, {1, -1, 0.25f, 1}, {0, 1, 0.25f, 1}};
    in::mesh mesh{std::vector<glm::vec3>(6), {}, {{0, 1, 2}, {3, 4, 5}}};

    /// The picture of triangle indices, and the statistics.
    std::pair<in::image<int>, in::draw_stats> draw() const {
        in::image<int> seen(16, 16);
        in::image<float> depth(16, 16);
        const auto stats = in::draw(
            mesh, [&](const in::vertex& v) { return clip[v.index]; },
            [&](const auto& f) {
                CHECK((in::numeric::is_finite(f.depth) && f.depth >= 0 && f.depth <= 1));
                for (int i = 0; i < 3; ++i) CHECK(in::numeric::is_finite(f.weights[i]));
                return static_cast<int>(f.triangle) + 1;
            },
            in::framebuffer<int>{seen, depth}, {.load = in::depth_load::clear});
        return {std::move(seen), stats};
    }
};

}  // namespace

TEST_CASE("Special values in any component of any vertex are skipped or drawn correctly") {
    const overwritten_triangle whole;
    const in::image<int> background = [&] {
        overwritten_triangle first = whole;
        first.mesh.triangles.pop_back();
        return first.draw().first;
    }();
    const auto pixels_of_second = total([&] {
        in::image<int> count(16, 16);
        const auto seen = whole.draw().first;
        for (std::size_t i = 0; i < count.size(); ++i) count.pixels()[i] = seen.pixels()[i] == 2;
        return count;
    }());
    REQUIRE(pixels_of_second > 50);
    const float values[] = {limits::quiet_NaN(),
                            -limits::quiet_NaN(),
                            limits::signaling_NaN(),
                            limits::infinity(),
                            -limits::infinity(),
                            limits::denorm_min(),
                            -limits::denorm_min(),
                            limits::min(),
                            0.0f,
                            -0.0f,
                            (limits::max)(),
                            limits::lowest()};
    for (const float value : values)
        for (int component = 0; component < 4; ++component)
            for (int vertices = 1; vertices < 8; ++vertices) {  // any of the three, any two, all
                overwritten_triangle bad;
                for (int i = 0; i < 3; ++i)
                    if (vertices >> i & 1) bad.clip[3 + i][component] = value;
                INFO("value " << value << " in component " << component << " of vertices " << vertices);
                const auto [seen, stats] = bad.draw();
                CHECK(stats.drawn + stats.culled + stats.missed + stats.degenerate + stats.not_finite == 2);
                CHECK(stats.not_finite == (in::numeric::is_finite(value) ? 0u : 1u));
                for (std::size_t i = 0; i < seen.size(); ++i) {
                    const bool is_unchanged = seen.pixels()[i] == background.pixels()[i] || seen.pixels()[i] == 2;
                    CHECK(is_unchanged);
                }
                if (!in::numeric::is_finite(value)) CHECK(seen == background);
            }
}

TEST_CASE("Denormal positions are not flushed to zero") {
    // x and y of 1e-42 beside w of 1e-42: an ordinary triangle.
    overwritten_triangle tiny;
    const overwritten_triangle ordinary;
    for (int i = 3; i < 6; ++i) tiny.clip[i] = ordinary.clip[i] * 0x1p-20f;
    CHECK(tiny.draw().first == ordinary.draw().first);
    for (int i = 3; i < 6; ++i) tiny.clip[i] = ordinary.clip[i] * 0x1p100f;
    CHECK(tiny.draw().first == ordinary.draw().first);
}

TEST_CASE("draw() accepts no triangle, one triangle and ten million triangles") {
    const int size = 64;
    in::image<float> depth(size, size);
    CHECK(in::draw({}, pixel_space{size, size}, in::depth_target{depth}).triangles == 0);
    in::mesh m{{{0, 0, 0.5f}, {64, 0, 0.5f}, {0, 64, 0.5f}}, {}, {{0, 1, 2}}};
    CHECK(in::draw(m, pixel_space{size, size}, in::depth_target{depth}).drawn == 1);

    // The same three corners over and over, each time a little nearer; the last one is visible.
    m = {{}, {}, {}};
    const std::uint32_t count = 10000000;
    for (std::uint32_t i = 0; i < 1000; ++i)
        for (const glm::vec2 corner : {glm::vec2(30, 30), glm::vec2(33, 30), glm::vec2(30, 33)})
            m.positions.emplace_back(corner, 1 - static_cast<float>(i) / 1024);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t first = 3 * (i % 1000);
        m.triangles.emplace_back(first, first + 1, first + 2);
    }
    in::image<std::uint32_t> triangle_ids(size, size);
    const auto stats = in::draw(m, pixel_space{size, size}, [](const auto& f) { return f.triangle; },
                                in::framebuffer<std::uint32_t>{triangle_ids, depth}, {.load = in::depth_load::clear});
    CHECK(stats.drawn == count);
    CHECK(triangle_ids(30, 30) == 999);
}

TEST_CASE("A quad covers pictures of one pixel, one row, one column and odd shapes") {
    const auto [width, height] =
        GENERATE(std::pair{1, 1}, std::pair{1, 777}, std::pair{777, 1}, std::pair{2047, 3}, std::pair{3, 2047});
    const auto w = static_cast<float>(width), h = static_cast<float>(height);
    const in::mesh m{{{0, 0, 0.5f}, {w, 0, 0.5f}, {0, h, 0.5f}, {w, h, 0.5f}}, {}, {{0, 1, 2}, {1, 3, 2}}};
    const auto count = hits(m, width, height);
    CHECK(total(count) == width * height);
    CHECK(max_count(count) == 1);
}

TEST_CASE("draw() accepts a picture of 16384 x 16384 pixels", "[.slow]") {
    // 1 GiB of depth; the draw itself takes a few tiles and bins.
    const int size = 16384;
    in::image<float> depth(size, size);
    const in::mesh m{
        {{0, 0, 0.5f}, {16384, 0, 0.25f}, {0, 16384, 0.75f}, {16384, 16384, 0.5f}}, {}, {{0, 1, 2}, {1, 3, 2}}};
    const int bits = GENERATE(8, 16);
    CHECK(in::draw(m, pixel_space{size, size}, in::depth_target{depth},
                   {.load = in::depth_load::clear, .subpixel_bits = bits})
              .drawn == 2);
    for (const int x : {0, 1, 8191, 16383})
        for (const int y : {0, 5000, 16383})
            CHECK(static_cast<double>(depth(x, y)) == Approx(0.5 + 0.25 * (y - x) / size).epsilon(1e-7));
}

TEST_CASE("Triangles without area on the grid are counted, not drawn") {
    const in::mesh m{{{1, 1, 0}, {1, 1, 0}, {9, 9, 0}, {5, 5, 0}, {5.001f, 5, 0}, {5, 5.001f, 0}},
                     {},
                     {{0, 1, 2}, {0, 3, 2}, {3, 4, 5}, {2, 2, 2}}};
    in::image<float> depth(16, 16);
    const auto stats = in::draw(m, pixel_space{16, 16}, in::depth_target{depth}, {.load = in::depth_load::clear});
    CHECK(stats.degenerate == 4);
    for (const float d : depth.pixels()) CHECK(d == in::empty_depth(in::depth_compare::less));
}

TEST_CASE("Indices out of range are refused at any position, and nothing is drawn") {
    in::mesh m{{{0, 0, 0}, {8, 0, 0}, {0, 8, 0}}, {}, std::vector<glm::uvec3>(100000, glm::uvec3(0, 1, 2))};
    const std::size_t where = GENERATE(0u, 50000u, 99999u);
    const int corner = GENERATE(0, 1, 2);
    m.triangles[where][corner] = GENERATE(3u, 0x7FFFFFFFu, 0xFFFFFFFFu);
    in::image<float> depth(8, 8, 7.0f);
    CHECK_THROWS_AS(in::draw(m, pixel_space{8, 8}, in::depth_target{depth}, {.load = in::depth_load::clear}),
                    in::invalid_input);
    const in::mesh no_positions{{}, {}, {{0, 0, 0}}};
    CHECK_THROWS_AS(in::draw(no_positions, pixel_space{8, 8}, in::depth_target{depth}), in::invalid_input);
    for (const float d : depth.pixels()) CHECK(d == 7.0f);
}

TEST_CASE("A pose of scale zero is refused; a mirroring map draws the mirror image") {
    in::mesh m{{{2.03f, 2.07f, 0.5f}, {12.11f, 3.17f, 0.5f}, {4.19f, 11.13f, 0.5f}}, {}, {{0, 1, 2}}};
    CHECK_THROWS_AS(in::to_world({.scale = 0}), in::invalid_input);
    CHECK_THROWS_AS(in::to_world({.scale = -1}), in::invalid_input);
    const in::affine mirror{glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, 1), glm::dvec3(16, 0, 0)};
    const auto straight = hits(m, 16, 16, {.cull = in::cull_mode::front});
    const auto mirrored = hits(in::transformed(m, mirror), 16, 16, {.cull = in::cull_mode::front});
    REQUIRE(total(straight) > 20);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) CHECK(straight(x, y) == mirrored(15 - x, y));
    const in::affine flat{glm::dmat3(0.0), glm::dvec3(8, 8, 0.5)};
    in::image<float> depth(16, 16);
    CHECK(in::draw(in::transformed(m, flat), pixel_space{16, 16}, in::depth_target{depth}).degenerate == 1);
}
