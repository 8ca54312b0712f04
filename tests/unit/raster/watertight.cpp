// Meshes without T-junctions have no holes and no pixel covered twice, under any clipping and snapping.
#include <insonify/core/random.hpp>

#include "../../catch.hpp"
#include "pixel_space.hpp"

namespace in = insonify;
using namespace testing_raster;

namespace {

constexpr int screen = 16;  // pixels a side

/// Counts the hits of each pixel by a mesh's triangles, drawn one by one; front and back faces separately.
struct hit_counter {
    in::image<int> front{screen, screen}, back{screen, screen};
    in::mesh one{};
    in::image<float> depth{screen, screen};

    void draw(const in::mesh& m, auto&& place, in::draw_options<> options) {
        front = back = in::image<int>(screen, screen);
        options.load = in::depth_load::clear;
        one.positions = m.positions;
        for (const glm::uvec3& t : m.triangles) {
            one.triangles = {t};
            in::draw(
                one, place, [&](const auto& f) { ++(f.front ? front : back)(f.x, f.y); }, in::framebuffer<void>{depth},
                options);
        }
    }
    /// Pixels not hit exactly once.
    int faults() const {
        int sum = 0;
        for (std::size_t i = 0; i < front.size(); ++i) sum += front.pixels()[i] + back.pixels()[i] != 1;
        return sum;
    }
};

in::draw_options<> any_options(in::random_sequence& random) {
    return {.subpixel_bits = 4 + static_cast<int>(random.below(13)), .tile = 8 << random.below(2)};
}

/// Triangles around a point in the picture, whose outer ends lie outside of it.
in::mesh fan(in::random_sequence& random) {
    const std::uint32_t n = 4 + random.below(20);
    in::mesh m{{glm::vec3{random.uniform(0, screen), random.uniform(0, screen), 0.5}}, {}, {}};
    for (std::uint32_t i = 0; i < n; ++i) {
        const double turn = (i + random.uniform(0.1, 0.4)) / n, radius = screen * random.uniform(3, 9);
        const auto [sine, cosine] = in::numeric::sin_cos_turns(turn);
        m.positions.emplace_back(m.positions[0] + glm::vec3(radius * cosine, radius * sine, 0));
        m.triangles.push_back({0, 1 + i, 1 + (i + 1) % n});
    }
    return m;
}

/// A grid of vertices moved at random, whose outline lies outside of the picture; one row of cells makes a strip.
in::mesh grid(in::random_sequence& random, std::uint32_t columns, std::uint32_t rows) {
    in::mesh m;
    for (std::uint32_t j = 0; j <= rows; ++j)
        for (std::uint32_t i = 0; i <= columns; ++i) {
            const auto at = [&](std::uint32_t k, std::uint32_t n) {
                if (k == 0 || k == n) return k == 0 ? -4.0 : screen + 4.0;
                return screen * (k + random.uniform(-0.2, 0.2)) / n;
            };
            const double x = at(i, columns);
            m.positions.emplace_back(x, at(j, rows), 0.5);
        }
    for (std::uint32_t j = 0; j < rows; ++j)
        for (std::uint32_t i = 0; i < columns; ++i) {
            const std::uint32_t a = j * (columns + 1) + i, b = a + 1, c = a + columns + 1, d = c + 1;
            // Cells of a grid moved this much are convex; either diagonal will do.
            if (random.below(2) == 0)
                m.triangles.insert(m.triangles.end(), {{a, b, d}, {a, d, c}});
            else
                m.triangles.insert(m.triangles.end(), {{a, b, c}, {b, d, c}});
        }
    return m;
}

/// A double pyramid over a polygon: closed, and about as large as the picture.
in::mesh solid(in::random_sequence& random) {
    const std::uint32_t n = 3 + random.below(9);
    in::mesh m;
    const auto turn = in::numeric::sin_cos_turns(random.uniform());
    const auto add = [&](const glm::dvec3& p) {
        m.positions.emplace_back(screen / 2.0 + p.x, screen / 2.0 + p.y * turn.cosine - p.z * turn.sine,
                                 0.5 + (p.y * turn.sine + p.z * turn.cosine) / 99);
    };
    add({random.uniform(-2, 2), random.uniform(-2, 2), 12});
    add({random.uniform(-2, 2), random.uniform(-2, 2), -12});
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto [s, c] = in::numeric::sin_cos_turns((i + random.uniform(0, 0.8)) / n);
        add({10 * c, 10 * s, random.uniform(-2, 2)});
        const std::uint32_t here = 2 + i, next = 2 + (i + 1) % n;
        m.triangles.insert(m.triangles.end(), {{0, here, next}, {1, next, here}});
    }
    return m;
}

/// A plane seen by a random camera: (u, v) lies at w (x, y, 1) = turn (u, v, 1), cut off before `nearest` and behind
/// `farthest`. Its grid is a few vertices wide and reaches far to all sides.
struct plane_view {
    glm::dmat3 turn;
    double nearest, farthest;
    in::mesh mesh;

    explicit plane_view(in::random_sequence& random) {
        do {
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) turn[i][j] = random.uniform(-1, 1);
            turn[2][2] += 1.5;
        } while (std::abs(in::numeric::determinant(turn)) < 0.1);  // seen from its edge
        nearest = random.uniform(0.05, 0.8);
        farthest = nearest * random.uniform(2, 30);
        const std::uint32_t n = 1 + random.below(5);
        mesh = grid(random, n, n);
        const double reach = random.below(4) == 0 ? 1000 : random.below(2) == 0 ? 100 : 12;
        for (glm::vec3& p : mesh.positions)
            p = glm::vec3((p.x / screen - 0.5f) * static_cast<float>(reach),
                          (p.y / screen - 0.5f) * static_cast<float>(reach), 0);
    }
    glm::vec4 operator()(const in::vertex& v) const {
        const glm::dvec3 p = in::numeric::product(turn, glm::dvec3(v.position.x, v.position.y, 1));
        return {p.x, p.y, (p.z - nearest) * farthest / (farthest - nearest), p.z};
    }
    /// w where a pixel's ray meets the plane, and how far from the middle of the mesh that is.
    glm::dvec2 hit(int x, int y) const {
        const glm::dvec3 ray((x + 0.5) / screen * 2 - 1, 1 - (y + 0.5) / screen * 2, 1);
        const glm::dvec3 uv1 =
            in::numeric::product(glm::transpose(in::numeric::cofactors(turn)), ray) / in::numeric::determinant(turn);
        return {1 / uv1.z, (std::max)(std::abs(uv1.x), std::abs(uv1.y)) / std::abs(uv1.z)};
    }
};

/// Draws `count` meshes of each kind; the message of a failure states the seed.
void check_meshes(std::uint64_t first_seed, std::uint64_t count) {
    hit_counter hits;
    for (std::uint64_t seed = first_seed; seed < first_seed + count; ++seed) {
        in::random_sequence random(seed);
        INFO("seed " << seed);
        const glm::vec3 offset{random.uniform(), random.uniform(), 0};
        const auto draw = [&](in::mesh m) {
            for (glm::vec3& p : m.positions) p += offset;
            hits.draw(m, pixel_space{screen, screen}, any_options(random));
        };
        draw(fan(random));
        if (hits.faults() != 0) FAIL("a fan has " << hits.faults() << " pixels that are not hit once");
        draw(grid(random, 2 + random.below(9), 1));
        if (hits.faults() != 0) FAIL("a strip has " << hits.faults() << " pixels that are not hit once");
        const std::uint32_t columns = 1 + random.below(6), rows = 1 + random.below(6);
        draw(grid(random, columns, rows));
        if (hits.faults() != 0) FAIL("a grid has " << hits.faults() << " pixels that are not hit once");
        draw(solid(random));
        if (hits.front != hits.back) FAIL("a solid has a hole");

        const plane_view view(random);
        in::draw_options<> options = any_options(random);
        options.subpixel_bits = (std::max)(options.subpixel_bits, 8);
        hits.draw(view.mesh, view, options);
        for (int y = 0; y < screen; ++y)
            for (int x = 0; x < screen; ++x) {
                const int count_here = hits.front(x, y) + hits.back(x, y);
                if (count_here > 1) FAIL("a clipped plane has a pixel that is hit " << count_here << " times");
                // Well inside the mesh and the clipping planes.
                const glm::dvec2 hit = view.hit(x, y);
                const double extent = static_cast<double>(view.mesh.positions.back().x);
                const bool inside =
                    hit.x > view.nearest * 1.02 && hit.x < view.farthest * 0.98 && hit.y < extent * 0.98;
                if (inside && count_here == 0) FAIL("a clipped plane has a hole at " << x << ", " << y);
            }
    }
}

}  // namespace

TEST_CASE("Random fans, strips, grids, solids and clipped planes are watertight") {
    check_meshes(1, 2000);
}

TEST_CASE("A million random meshes are watertight", "[.slow]") {
    check_meshes(1000000, 200000);
}

TEST_CASE("Large triangles across several planes of the frustum share their edges") {
    // NVlabs/nvdiffrast 225: leaks where neighbours are clipped by several planes.
    in::random_sequence random(7);
    hit_counter hits;
    int seen = 0;
    for (int n = 0; n < 500; ++n) {
        // Two triangles that together pass the near and the far plane, the camera and all four sides. Their shared edge
        // passes through the picture.
        const double tilt = random.uniform(0.2, 1), w = random.uniform(0.5, 2);
        const auto place = [=](const in::vertex& v) {
            const double depth = tilt * static_cast<double>(v.position.y) + w;
            return glm::vec4(v.position.x, v.position.y + 0.3f * v.position.x, (depth - 0.1) * 1.05, depth);
        };
        const glm::dvec2 on_edge{random.uniform(-0.5, 0.5), random.uniform(-0.4, 0.4)};
        const double turn = random.uniform(0, 2 * in::numeric::pi);
        const glm::dvec2 along(std::cos(turn), std::sin(turn)), across(-along.y, along.x);
        const auto corner = [&](const glm::dvec2& to) {
            return glm::vec3(glm::vec2(on_edge + random.uniform(50, 5000) * to), 0);
        };
        const in::mesh m{{corner(-along), corner(-across), corner(across), corner(along)}, {}, {{0, 1, 3}, {0, 3, 2}}};
        in::draw_options<> options = any_options(random);
        options.subpixel_bits = (std::max)(options.subpixel_bits, 8);
        hits.draw(m, place, options);
        for (int y = 0; y < screen; ++y)
            for (int x = 0; x < screen; ++x) {
                // Where the plane is met: x / depth and (y + 0.3 x) / depth are the pixel's coordinates.
                const double right = (x + 0.5) / screen * 2 - 1, up = 1 - (y + 0.5) / screen * 2;
                const double depth = w / (1 - tilt * (up - 0.3 * right));
                const int count = hits.front(x, y) + hits.back(x, y);
                CHECK(count <= 1);
                if (!(depth > 0.11 && depth < 2.0)) continue;
                ++seen;
                CHECK(count == 1);
            }
        in::image<float> depth(screen, screen);
        in::draw(m, place, in::depth_target{depth}, {.load = in::depth_load::clear});
        CHECK(in::draw(m, place, in::depth_target{depth}).clipped == 2);
    }
    CHECK(seen > 10000);
}
