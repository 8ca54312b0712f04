// plane_tree, boxes around runs of triangles: it visits every triangle that a plane cuts and few others.
#include <insonify/core/random.hpp>
#include <insonify/geometry/detail/plane_tree.hpp>
#include <insonify/geometry/shared_mesh.hpp>

#include "../../catch.hpp"

namespace in = insonify;

namespace {

/// A rough sheet of 2 n^2 triangles, in a random order.
in::mesh shuffled_sheet(int n, in::random_sequence& random) {
    in::mesh m;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) m.positions.emplace_back(i, j, random.uniform(-1, 1));
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const auto a = static_cast<std::uint32_t>(j * (n + 1) + i), up = static_cast<std::uint32_t>(n + 1);
            m.triangles.emplace_back(a, a + 1, a + up);
            m.triangles.emplace_back(a + 1, a + up + 1, a + up);
        }
    for (std::size_t i = m.triangles.size(); i > 1; --i)
        std::swap(m.triangles[i - 1], m.triangles[random.below(static_cast<std::uint32_t>(i))]);
    return m;
}

}  // namespace

TEST_CASE("plane_tree visits every triangle that a plane cuts, in order, and of a shuffled sheet few others") {
    in::random_sequence random(3);
    const in::shared_mesh sheet(shuffled_sheet(200, random));
    const in::detail::plane_tree tree(sheet);
    std::size_t visited = 0, cut = 0;
    for (int trial = 0; trial < 50; ++trial) {
        const glm::dvec3 normal{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.2, 0.2)};
        const double offset = -in::numeric::dot(normal, glm::dvec3{random.uniform(0, 200), random.uniform(0, 200), 0});
        std::vector<bool> seen(sheet->triangles.size());
        std::size_t last = 0;
        tree.cut(normal, offset, [&](std::size_t first, std::size_t end) {
            REQUIRE(first >= last);
            last = end;
            for (std::size_t i = first; i < end; ++i) seen[i] = true, ++visited;
        });
        for (std::size_t i = 0; i < seen.size(); ++i) {
            bool below = false, above = false;
            for (int k = 0; k < 3; ++k) {
                const double at =
                    offset + in::numeric::dot(normal, glm::dvec3(sheet->positions[sheet->triangles[i][k]]));
                below = below || at <= 0, above = above || at >= 0;
            }
            if (!below || !above) continue;
            ++cut;
            REQUIRE(seen[i]);
        }
    }
    CHECK(visited < 20 * cut);  // of 50 x 80000
}

TEST_CASE("plane_tree accepts meshes of no triangle and of one, and skips triangles that are not finite") {
    int runs = 0;
    const auto count = [&](std::size_t, std::size_t) { ++runs; };
    in::detail::plane_tree().cut({1, 0, 0}, 0, count);
    in::detail::plane_tree(in::mesh{}).cut({1, 0, 0}, 0, count);
    in::mesh m{.positions = {{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}};
    CHECK(runs == 0);
    in::detail::plane_tree(m).cut({1, 0, 0}, 0, count);
    CHECK(runs == 1);
    in::detail::plane_tree(m).cut({1, 0, 0}, 2, count);
    CHECK(runs == 1);
    m.positions[0].x = std::numeric_limits<float>::quiet_NaN();
    for (const glm::dvec3& normal : {glm::dvec3(1, 0, 0), glm::dvec3(1, 1, 1)})
        in::detail::plane_tree(m).cut(normal, 0, count);
    CHECK(runs == 1);
}

TEST_CASE("plane_tree visits triangles beside runs of triangles that are not finite") {
    const float infinity = std::numeric_limits<float>::infinity();
    in::mesh m{.positions = {{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {infinity, 0, 0}}};
    m.triangles.assign(64, {0, 1, 3});
    m.triangles.insert(m.triangles.end(), 8, {0, 1, 2});
    m.triangles.insert(m.triangles.end(), 64, {0, 1, 3});
    for (const glm::dvec3& normal : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(1, 1, 1)}) {
        std::size_t first = 0, end = 0;
        in::detail::plane_tree(m).cut(normal, 0, [&](std::size_t from, std::size_t to) { first = from, end = to; });
        CHECK(first == 64);
        CHECK(end == 72);
    }
}

TEST_CASE("plane_tree visits triangles whose coordinates add up to more than the largest float") {
    const float huge = 2e38f;
    const in::mesh m{.positions = {{-huge, 0, huge}, {huge, 0, huge}, {0, huge, huge}}, .triangles = {{0, 1, 2}}};
    int runs = 0;
    in::detail::plane_tree(m).cut({1, 0, 0}, 0, [&](std::size_t, std::size_t) { ++runs; });
    CHECK(runs == 1);
}
