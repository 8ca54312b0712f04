// Coverage against an exact oracle: triangles of every kind, near and far from the picture.
#include <insonify/core/random.hpp>

#include <array>
#include <cstdint>

#include "../../catch.hpp"
#include "pixel_space.hpp"

namespace in = insonify;
using namespace testing_raster;

namespace {

constexpr int screen_side = 32;  // pixels a side

/// Two numbers at random.
template <class At>
glm::dvec2 pair_of(const At& at) {
    const double x = at();
    return {x, at()};
}

/// Random triangles of the kinds that rasterizers get wrong.
struct any_triangle {
    in::random_sequence random;

    std::array<glm::dvec2, 3> operator()(int kind) {
        const auto uniform_in = [&](double low, double high) {
            return std::array{pair_of([&] { return random.uniform(low, high); }),
                              pair_of([&] { return random.uniform(low, high); }),
                              pair_of([&] { return random.uniform(low, high); })};
        };
        const auto on_grid = [&](double step) {
            const auto at = [&] {
                return step * static_cast<double>(random.below(static_cast<std::uint32_t>(screen_side / step)));
            };
            return std::array{pair_of(at), pair_of(at), pair_of(at)};
        };
        switch (kind) {
            case 0: return uniform_in(-8, screen_side + 8);
            case 1: return around_a_point(uniform_in(-0.7, 0.7));  // about as large as a pixel
            case 2: return around_a_point(uniform_in(-8, 8));
            case 3: return sliver(2 * screen_side);
            case 4: return on_grid(0.5);       // on the centres and corners of pixels
            case 5: return on_grid(1.0 / 16);  // on edges of each other
            case 6: return uniform_in(-2000, 2000);
            case 7: return through_centres();
            default: return past_the_picture(kind == 8 ? 1e5 : kind == 9 ? 1e7 : 3e9);
        }
    }
    static constexpr int kinds = 11;

  private:
    std::array<glm::dvec2, 3> around_a_point(std::array<glm::dvec2, 3> corners) {
        const glm::dvec2 point = pair_of([&] { return random.uniform(0, screen_side); });
        for (glm::dvec2& corner : corners) corner += point;
        return corners;
    }
    std::array<glm::dvec2, 3> sliver(double length) {
        const glm::dvec2 direction = pair_of([&] { return random.uniform(-1, 1); });
        std::array<glm::dvec2, 3> corners;
        for (glm::dvec2& corner : corners)
            corner = random.uniform(-length, length) * direction + pair_of([&] { return random.uniform(-0.2, 0.2); });
        return around_a_point(corners);
    }
    /// An edge exactly through the centres of pixels, its ends up to half a million pixels away.
    std::array<glm::dvec2, 3> through_centres() {
        const auto whole = [&](int low, int high) {
            return static_cast<double>(low +
                                       static_cast<int>(random.below(static_cast<std::uint32_t>(high - low + 1))));
        };
        const glm::dvec2 centre = 0.5 + pair_of([&] { return whole(0, screen_side - 1); });
        const glm::dvec2 step = pair_of([&] { return whole(-5, 5); });
        const double away = random.below(2) == 0 ? 100 : 100000;
        const glm::dvec2 third = 0.5 + pair_of([&] { return whole(-static_cast<int>(away), static_cast<int>(away)); });
        return {centre + std::floor(random.uniform(0, away)) * step,
                centre - std::floor(random.uniform(0, away)) * step, third};
    }
    /// Corners up to `distance` away, with an edge or two through the picture.
    std::array<glm::dvec2, 3> past_the_picture(double distance) {
        const glm::dvec2 direction = pair_of([&] { return random.uniform(-distance, distance); });
        const glm::dvec2 inside = pair_of([&] { return random.uniform(0, screen_side); });
        const glm::dvec2 third = random.below(2) == 0 ? pair_of([&] { return random.uniform(0, screen_side); })
                                                      : pair_of([&] { return random.uniform(-distance, distance); });
        return {inside + direction, inside - random.uniform() * direction, third};
    }
};

/// Draws one triangle after the other and counts the pixels on which the oracle disagrees.
class comparison {
  public:
    std::uint64_t wrong = 0, covered = 0;

    void check(const std::array<glm::dvec2, 3>& corners, in::draw_options<> options) {
        glm::dvec2 seen[3];
        for (std::size_t i = 0; i < 3; ++i) {
            mesh_.positions[i] = glm::vec3(corners[i], 0.5);
            seen[i] = on_screen(space_({mesh_.positions[i], {}, 0}), screen_side, screen_side);
        }
        options.load = in::depth_load::clear;
        std::fill(hit_.pixels().begin(), hit_.pixels().end(), 0);
        in::draw(
            mesh_, space_, [&](const auto& f) { ++hit_(f.x, f.y); }, in::framebuffer<void>{depth_}, options);
        const oracle judge(seen, options.subpixel_bits);
        for (int y = 0; y < screen_side; ++y)
            for (int x = 0; x < screen_side; ++x) {
                wrong += hit_(x, y) != (judge.covers(x, y) ? 1 : 0);
                covered += hit_(x, y);
            }
    }

  private:
    pixel_space space_{screen_side, screen_side};
    in::mesh mesh_{std::vector<glm::vec3>(3), {}, {{0, 1, 2}}};
    in::image<float> depth_{screen_side, screen_side};
    in::image<std::uint8_t> hit_{screen_side, screen_side};
};

/// Checks `count` triangles of each kind, over all sub-pixel grids, tile sizes and instruction sets.
void compare(std::uint64_t seed, int count) {
    any_triangle triangle{in::random_sequence(seed)};
    in::random_sequence choice(seed, 1);
    for (int kind = 0; kind < any_triangle::kinds; ++kind) {
        comparison result;
        for (int i = 0; i < count; ++i) {
            in::draw_options<> options;
            options.subpixel_bits = i % 2 == 0 ? 8 : i % 4 == 1 ? 16 : 4 + static_cast<int>(choice.below(13));
            options.tile = 8 << choice.below(3);
            options.level = choice.below(8) == 0   ? in::isa::scalar
                            : choice.below(4) == 0 ? in::isa::baseline
                                                   : in::best_isa();
            result.check(triangle(kind), options);
        }
        INFO("seed " << seed << ", kind " << kind);
        CHECK(result.wrong == 0);
        CHECK(result.covered > static_cast<std::uint64_t>(count) / 16);
    }
}

}  // namespace

TEST_CASE("Coverage equals the 128-bit oracle on random triangles of every kind") {
    const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u);
    compare(seed, 1500);
}

TEST_CASE("Coverage equals the 128-bit oracle on ten million random triangles", "[.slow]") {
    for (std::uint64_t seed = 100; seed < 200; ++seed) compare(seed, 10000);
}

TEST_CASE("Moving a triangle by whole pixels moves its pixels") {
    const in::mesh m{{{3.3f, 2.1f, 0}, {17.8f, 5.6f, 0}, {8.4f, 19.9f, 0}}, {}, {{0, 1, 2}}};
    in::mesh moved = m;
    for (auto& p : moved.positions) p += glm::vec3(32, 16, 0);
    const auto a = hits(m, 64, 64), b = hits(moved, 64, 64);
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 30; ++x) CHECK(a(x, y) == b(x + 32, y + 16));
}
