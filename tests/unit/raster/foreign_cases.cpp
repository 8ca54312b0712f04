// Published failures of other rasterizers: geometry and expected pixels, with their sources.
#include <insonify/core/random.hpp>

#include <array>

#include "../../catch.hpp"
#include "pixel_space.hpp"

namespace in = insonify;
using namespace testing_raster;

namespace {

/// Two triangles that share the diagonal q0 q2: of opposite windings, or with `reverse` of the same.
in::mesh quad(const glm::vec3 (&q)[4], bool reverse = false) {
    return {{q[0], q[1], q[2], q[3]}, {}, {{0, 1, 2}, reverse ? glm::uvec3(0, 2, 3) : glm::uvec3(2, 0, 3)}};
}

/// Vertices of a square in the Khronos conformance tests' layout: centre, half side and turn in NDC, y down.
void square(glm::vec3 (&q)[4], glm::dvec2 centre, double half, double turn, int size) {
    const glm::dvec2 h{half * std::cos(turn), half * std::sin(turn)}, v{h.y, -h.x};
    const glm::dvec2 ndc[4] = {centre + h + v, centre + h - v, centre - h - v, centre - h + v};
    for (int i = 0; i < 4; ++i) q[i] = glm::vec3((ndc[i].x + 1) / 2 * size, (ndc[i].y + 1) / 2 * size, 0.5);
}

/// The 4 x 4 turned squares of `fill_rules.basic_quad`, drawn one over the other.
in::image<int> turned_squares(int round, bool reverse, auto&& place) {
    in::image<int> count(256, 256);
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) {
            glm::vec3 q[4];
            const double turn = (16 * round + 4 * column + row) / 32.0 * in::numeric::pi / 2;
            square(q, {(row + 0.5) / 2 - 1, (column + 0.5) / 2 - 1}, 0.15, turn, 256);
            const auto one = hits(quad(q, reverse), 256, 256, place);
            for (std::size_t i = 0; i < count.size(); ++i) count.pixels()[i] += one.pixels()[i];
        }
    return count;
}

}  // namespace

TEST_CASE("Two triangles share a diagonal as Direct3D's rasterization rules draw them") {
    // learn.microsoft.com, "Rasterization rules"; its pixel centres are integers, ours lie half a pixel further.
    const in::mesh upper{{{.5f, .5f, 0}, {5.5f, .5f, 0}, {5.5f, 5.5f, 0}}, {}, {{0, 1, 2}}};
    const in::mesh lower{{{.5f, 5.5f, 0}, {.5f, .5f, 0}, {5.5f, 5.5f, 0}}, {}, {{0, 1, 2}}};
    const auto a = hits(upper, 8, 8), b = hits(lower, 8, 8);
    CHECK(total(a) == 15);
    CHECK(total(b) == 10);
    for (std::size_t i = 0; i < a.size(); ++i) CHECK(a.pixels()[i] + b.pixels()[i] <= 1);
}

TEST_CASE("Rotated squares cover the pixels that the Khronos conformance tests expect") {
    // VK-GL-CTS, es3fRasterizationTests, fill_rules.basic_quad and basic_quad_reverse.
    const bool reverse = GENERATE(false, true);
    const int expected[2] = {23528, 23596};
    for (int round = 0; round < 2; ++round) {
        const auto count = turned_squares(round, reverse, pixel_space{256, 256});
        CHECK(total(count) == expected[round]);
        CHECK(max_count(count) == 1);
    }
}

TEST_CASE("Coverage does not depend on w") {
    // VK-GL-CTS, fill_rules.projected: every vertex scaled by a w of its own.
    const auto projected = [](const in::vertex& v) {
        const float w = 0.125f * static_cast<float>(1 << (v.index * 3 % 6));
        return pixel_space{256, 256}(v)*w;
    };
    CHECK(turned_squares(0, false, projected) == turned_squares(0, false, pixel_space{256, 256}));
}

TEST_CASE("A square larger than the picture covers each pixel once, however it is turned") {
    // VK-GL-CTS, fill_rules.clipped_full.
    for (int turn = 0; turn < 15; ++turn) {
        glm::vec3 q[4];
        square(q, {0, 0}, 2.0, turn / 14.0 * in::numeric::pi / 2, 64);
        const auto count = hits(quad(q), 64, 64);
        CHECK(total(count) == 4096);
        CHECK(max_count(count) == 1);
    }
}

TEST_CASE("A square across the border covers the part inside") {
    // VK-GL-CTS, fill_rules.clipped_partly.
    const int expected[15] = {2304, 2309, 2330, 2365, 2416, 2450, 2469, 2491, 2469, 2450, 2416, 2365, 2330, 2309, 2304};
    for (int turn = 0; turn < 15; ++turn) {
        glm::vec3 q[4];
        square(q, {0.5, 0.5}, 1.0, turn / 14.0 * in::numeric::pi / 2, 64);
        const auto count = hits(quad(q), 64, 64);
        CHECK(total(count) == expected[turn]);
        CHECK(max_count(count) == 1);
    }
}

TEST_CASE("A triangle smaller than a pixel covers it only if the centre is inside by the top-left rule") {
    // piglit, tests/general/triangle-rasterization: right triangles around a centre, shifted by sixteenths.
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const float cx = 2.5f + static_cast<float>(dx) / 16, cy = 2.5f + static_cast<float>(dy) / 16;
            for (const float h : {-0.1875f, 0.1875f})
                for (const float v : {-0.1875f, 0.1875f}) {
                    const in::mesh m{{{cx, cy, 0}, {cx + h, cy, 0}, {cx, cy + v, 0}}, {}, {{0, 1, 2}}};
                    const glm::dvec2 corner[3] = {glm::dvec2(m.positions[0]), glm::dvec2(m.positions[1]),
                                                  glm::dvec2(m.positions[2])};
                    CHECK(total(hits(m, 8, 8)) == (oracle_covers(corner, 2, 2, 8) ? 1 : 0));
                }
        }
}

TEST_CASE("A diagonal shared by two triangles has no hole and no double hit") {
    // facebookresearch/DRTK issue 9.
    const std::vector<glm::vec3> p{{.5f, .49993896484375f, 0},
                                   {.5f, 6.5f, 0},
                                   {6.50006103515625f, .49993896484375f, 0},
                                   {6.50006103515625f, 6.5f, 0}};
    const glm::uvec3 second = GENERATE(glm::uvec3(3, 2, 1), glm::uvec3(3, 1, 2));
    const auto count = hits({p, {}, {{0, 1, 2}, second}}, 8, 8);
    CHECK(total(count) == 36);
    CHECK(max_count(count) == 1);
}

namespace {

/// How many pixels of a small picture a triangle and the oracle disagree about; `corners` in pixels.
int differences(const std::array<glm::dvec2, 3>& corners, int bits, auto&& place, int size) {
    in::mesh m{{}, {}, {{0, 1, 2}}};
    for (const glm::dvec2& corner : corners) m.positions.push_back(glm::vec3(corner, 0.5));
    glm::dvec2 seen[3];
    for (std::uint32_t i = 0; i < 3; ++i) seen[i] = on_screen(glm::dvec4(place({m.positions[i], {}, i})), size, size);
    const oracle judge(seen, bits);
    const in::image<int> count = hits(m, size, size, place, {.subpixel_bits = bits});
    int wrong = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) wrong += count(x, y) != (judge.covers(x, y) ? 1 : 0);
    return wrong;
}
int differences(const std::array<glm::dvec2, 3>& corners, int bits, int size) {
    return differences(corners, bits, pixel_space{size, size}, size);
}

}  // namespace

TEST_CASE("Coverage is that of the projected corners for any w") {
    // VK-GL-CTS, fill_rules.projected, with weights from 0.1 to 4 that round.
    in::random_sequence random(4);
    for (int n = 0; n < 400; ++n) {
        const float w[3] = {static_cast<float>(random.uniform(0.1, 4)), static_cast<float>(random.uniform(0.1, 4)),
                            static_cast<float>(random.uniform(0.1, 4))};
        const auto projected = [&](const in::vertex& v) { return pixel_space{32, 32}(v)*w[v.index]; };
        const auto corner = [&] { return glm::dvec2{random.uniform(-8, 40), random.uniform(-8, 40)}; };
        CHECK(differences({corner(), corner(), corner()}, 8, projected, 32) == 0);
    }
}

TEST_CASE("Culling follows the sign of the snapped area") {
    // VK-GL-CTS, culling.*: both windings, each side culled or none.
    in::random_sequence random(5);
    for (int n = 0; n < 200; ++n) {
        in::mesh m{{}, {}, {{0, 1, 2}}};
        for (int i = 0; i < 3; ++i) m.positions.push_back(glm::vec3{random.uniform(2, 14), random.uniform(2, 14), 0.5});
        const auto snapped = [&](std::size_t i) {
            const glm::dvec2 p(m.positions[i]);
            return glm::dvec2(std::nearbyint(p.x * 256), std::nearbyint(p.y * 256));
        };
        const glm::dvec2 ab = snapped(1) - snapped(0), ac = snapped(2) - snapped(0);
        const bool front = ab.x * ac.y - ab.y * ac.x < 0;  // counter-clockwise as seen, y being down
        const auto drawn = [&](in::cull_mode cull) {
            in::image<float> depth(16, 16);
            return in::draw(m, pixel_space{16, 16}, in::depth_target{depth},
                            {.cull = cull, .load = in::depth_load::clear})
                       .culled == 0;
        };
        CHECK(drawn(in::cull_mode::none));
        CHECK(drawn(in::cull_mode::back) == front);
        CHECK(drawn(in::cull_mode::front) == !front);
        std::swap(m.triangles[0].y, m.triangles[0].z);
        CHECK(drawn(in::cull_mode::back) == !front);
        CHECK(drawn(in::cull_mode::front) == front);
    }
}

TEST_CASE("Triangles at sixteenths of a pixel, of sizes in powers of two, cover the oracle's pixels") {
    // piglit, tests/general/triangle-rasterization, its random part.
    in::random_sequence random(6);
    for (int n = 0; n < 2000; ++n) {
        const double extent = 1 << random.below(8);
        const auto corner = [&] {
            const auto at = [&] { return std::nearbyint(random.uniform(0, extent) * 16) / 16; };
            const double x = at();
            return glm::dvec2(x, at());
        };
        CHECK(differences({corner(), corner(), corner()}, 8, 64) == 0);
    }
}

TEST_CASE("Coordinates beyond the range of 16.16 numbers draw the right pixels") {
    // dkfans/keeperfx PR 4668 (beyond +-32767), nical/lyon 354 (overflow of a product).
    const int bits = GENERATE(8, 16);
    for (const double away : {32766.5, 32767.0, 32768.0, 32769.5, 40000.0, 65536.0, 131072.0}) {
        CHECK(differences({{{-away, 3}, {away, 5}, {7, away}}}, bits, 16) == 0);
        CHECK(differences({{{-away, -away}, {away, -away + 9}, {11, away}}}, bits, 16) == 0);
        CHECK(differences({{{-away, 2.5}, {away, 2.5}, {away, away}}}, bits, 16) == 0);
    }
}

TEST_CASE("Edge functions at the limits of 32 bits cover the right pixels") {
    // vindar/tgx PR 31: a loop over a row that never ended where an edge function was close to INT_MIN.
    for (const int bits : {8, 12, 16})
        for (const double value : {0x1p29, 0x1p30, 0x1p31 - 1, 0x1p31, 0x1p31 + 1, 0x1p32}) {
            const double away = value / (1 << bits);
            for (const double other : {-1.0, 0.0, 0.5, 15.5, 16.0, 31.0})
                for (const double sign : {-1.0, 1.0}) {
                    CHECK(differences({{{sign * away, other}, {16, 16}, {other, sign * away}}}, bits, 32) == 0);
                    CHECK(differences({{{sign * away, other}, {-sign * away, 31 - other}, {8, sign * away}}}, bits,
                                      32) == 0);
                }
        }
}

TEST_CASE("No pixel outside of the picture is written, and none at its border is dropped") {
    // Marzac/le3d 38 (clipping rounds to a pixel outside), h0MER247/swGL 4 (dropped fragments), hrydgard/ppsspp PR
    // 19748 (overflow where a side isn't clipped).
    const int size = 16;
    std::vector<float> guarded(3 * size * size, 7.0f);
    const in::image_view<float> middle(guarded.data() + size * size, size, size);
    for (const double over : {-1.0, -0.5, -1.0 / 256, 0.0, 1.0 / 256, 0.5, 1.0, 1e4, 1e8}) {
        in::mesh m{{}, {}, {{0, 1, 2}, {1, 3, 2}}};
        for (const double y : {-over, size + over})
            for (const double x : {-over, size + over}) m.positions.push_back(glm::vec3(x, y, 0.25));
        in::draw(m, pixel_space{size, size}, in::depth_target{middle}, {.load = in::depth_load::clear});
        for (std::size_t i = 0; i < guarded.size(); ++i) {
            const bool inside = i / size >= size && i / size < 2 * size;
            if (!inside) REQUIRE(guarded[i] == 7.0f);
        }
        CHECK(middle(8, 8) == 0.25f);
        CHECK((middle(0, 0) == 0.25f) == (over >= -0.5));  // a centre on a top or left edge is inside
        CHECK((middle(size - 1, size - 1) == 0.25f) == (over > -0.5));
    }
}

TEST_CASE("A quad of the size of the screen has no gap along its diagonal") {
    // skywind3000/RenderHelp 2: a row of pixels missing at 800 x 600.
    const in::mesh m{{{0, 0, 0}, {800, 0, 0}, {0, 600, 0}, {800, 600, 0}}, {}, {{0, 1, 3}, {0, 3, 2}}};
    const auto count = hits(m, 800, 600);
    CHECK(max_count(count) == 1);
    CHECK(total(count) == 800 * 600);
}

TEST_CASE("A ray through the diagonal of a quad hits it") {
    // Oblikovati 2146: the quad (+-5, +-5, 0) cut along y = x, seen from (0, 0, 10) towards (3.375, 3.375, 0).
    const in::mesh m{{{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}}, {}, {{0, 1, 2}, {0, 2, 3}}};
    const auto from_above = [](const in::vertex& v) {
        return glm::vec4(v.position.x, v.position.y, 0.01f, 10 - v.position.z);
    };
    const auto count = hits(m, 80, 80, from_above, {.compare = in::depth_compare::greater});
    CHECK(count(53, 80 - 1 - 53) == 1);  // its centre is (3.375, 3.375) on the quad
    CHECK(total(count) == 40 * 40);
    CHECK(max_count(count) == 1);
}
