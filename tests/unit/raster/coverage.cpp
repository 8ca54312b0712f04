// Which pixels a triangle covers: against an exact oracle, and against cases that others wrote down.
#include <insonify/core/random.hpp>

#include "../../catch.hpp"
#include "pixel_space.hpp"

namespace in = insonify;
using namespace testing_raster;

namespace {

/// Two triangles that share the diagonal q0 q2, or with `reverse` wound the other way in the second.
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

TEST_CASE("Coverage equals the 128-bit oracle on random triangles of every kind") {
    const int size = 64;
    const int bits = GENERATE(8, 16, 4);
    const std::uint64_t seed = GENERATE(1u, 2u, 3u);
    INFO("seed " << seed << ", " << bits << " sub-pixel bits");
    in::random_sequence random(seed);
    std::size_t wrong = 0;
    for (int n = 0; n < 1500; ++n) {
        const int kind = n % 5;  // free, small, sliver, on centres and corners of pixels, far outside
        in::mesh m{{}, {}, {{0, 1, 2}}};
        glm::dvec2 corner[3];
        const glm::dvec2 base{random.uniform(0, size), random.uniform(0, size)};
        for (int i = 0; i < 3; ++i) {
            const auto at = [&] {
                switch (kind) {
                    case 0: return random.uniform(-20, size + 20);
                    case 1: return random.uniform(-2, 2);
                    case 2: return random.uniform(-size, size);
                    case 3: return 0.5 * random.below(2 * size);
                    default: return random.uniform(-4000, 4000);
                }
            };
            glm::dvec2 p{at(), at()};
            if (kind == 1) p += base;
            if (kind == 2) p = base + glm::dvec2(p.x, p.x * 0.7) + glm::dvec2(random.uniform(-0.3, 0.3));
            m.positions.push_back(glm::vec3(p, 0.5));
            corner[i] = glm::dvec2(m.positions.back());
            // The oracle sees what is left of a position after the trip through clip space.
            const glm::vec4 clip = pixel_space{size, size}({m.positions.back(), {}, 0});
            corner[i] = {static_cast<double>(clip.x) * size / 2 + size / 2,
                         -static_cast<double>(clip.y) * size / 2 + size / 2};
        }
        const auto count = hits(m, size, size, {.subpixel_bits = bits, .tile = 16});
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) wrong += count(x, y) != (oracle_covers(corner, x, y, bits) ? 1 : 0);
    }
    CHECK(wrong == 0);
}

TEST_CASE("Two triangles share a diagonal as Direct3D's rasterization rules draw them") {
    // learn.microsoft.com, "Rasterization rules"; its pixel centres are integers, ours lie half a pixel further.
    const in::mesh upper{{{.5f, .5f, 0}, {5.5f, .5f, 0}, {5.5f, 5.5f, 0}}, {}, {{0, 1, 2}}};
    const in::mesh lower{{{.5f, 5.5f, 0}, {.5f, .5f, 0}, {5.5f, 5.5f, 0}}, {}, {{0, 1, 2}}};
    const auto a = hits(upper, 8, 8), b = hits(lower, 8, 8);
    CHECK(total(a) == 15);
    CHECK(total(b) == 10);
    for (std::size_t i = 0; i < a.size(); ++i) CHECK(a.pixels()[i] + b.pixels()[i] <= 1);
}

TEST_CASE("Turned squares cover what the Khronos conformance tests make them cover") {
    // VK-GL-CTS, es3fRasterizationTests, fill_rules.basic_quad and basic_quad_reverse.
    const bool reverse = GENERATE(false, true);
    const int expected[2] = {23528, 23596};
    for (int round = 0; round < 2; ++round) {
        const auto count = turned_squares(round, reverse, pixel_space{256, 256});
        CHECK(total(count) == expected[round]);
        CHECK(most(count) == 1);
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
        CHECK(most(count) == 1);
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
        CHECK(most(count) == 1);
    }
}

TEST_CASE("Triangles smaller than a pixel follow the same rule") {
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
    CHECK(most(count) == 1);
}

TEST_CASE("Random grids are watertight: inside, every pixel is hit exactly once") {
    const std::uint64_t seed = GENERATE(11u, 12u, 13u, 14u);
    INFO("seed " << seed);
    in::random_sequence random(seed);
    const int n = 9, size = 64;
    in::mesh m;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            m.positions.emplace_back(i * 10 - 8 + random.uniform(-2.4, 2.4), j * 10 - 8 + random.uniform(-2.4, 2.4),
                                     0.5);
    for (auto& p : m.positions) {  // the outline encloses the picture
        if (&p - m.positions.data() < n) p.y = -20;
        if (&p - m.positions.data() >= n * (n - 1)) p.y = 90;
        if ((&p - m.positions.data()) % n == 0) p.x = -20;
        if ((&p - m.positions.data()) % n == n - 1) p.x = 90;
    }
    for (std::uint32_t j = 0; j + 1 < n; ++j)
        for (std::uint32_t i = 0; i + 1 < n; ++i) {
            const std::uint32_t a = j * n + i;
            m.triangles.push_back({a, a + 1, a + n});
            m.triangles.push_back({a + 1, a + n + 1, a + n});
        }
    const auto count = hits(m, size, size);
    CHECK(most(count) == 1);
    CHECK(total(count) == size * size);
}

TEST_CASE("Moving a triangle by whole pixels moves its pixels") {
    const in::mesh m{{{3.3f, 2.1f, 0}, {17.8f, 5.6f, 0}, {8.4f, 19.9f, 0}}, {}, {{0, 1, 2}}};
    in::mesh moved = m;
    for (auto& p : moved.positions) p += glm::vec3(32, 16, 0);
    const auto a = hits(m, 64, 64), b = hits(moved, 64, 64);
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 30; ++x) CHECK(a(x, y) == b(x + 32, y + 16));
}
