// Heightfields over a lattice are recognized in any order of their vertices and triangles; other meshes are not.
#include <insonify/core/random.hpp>
#include <insonify/geometry/shared_mesh.hpp>

#include <algorithm>
#include <numeric>

#include "../../catch.hpp"

namespace in = insonify;

namespace {

/// Columns x rows vertices in the order of the lattice, with steps (right, up) in x and y.
in::mesh lattice(int columns, int rows, bool is_rising, glm::dvec2 right = {0.375, 0}, glm::dvec2 up = {0, 0.5}) {
    in::mesh m;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const glm::dvec2 p = glm::dvec2(-3.25, 12.5) + static_cast<double>(i) * right + static_cast<double>(j) * up;
            m.positions.emplace_back(p.x, p.y, 0.1 * ((7 * i + 3 * j) % 5));
        }
    for (int j = 0; j + 1 < rows; ++j)
        for (int i = 0; i + 1 < columns; ++i) {
            const auto a = static_cast<std::uint32_t>(j * columns + i), b = a + 1,
                       c = a + static_cast<std::uint32_t>(columns), d = c + 1;
            m.triangles.emplace_back(a, b, is_rising ? d : c);
            m.triangles.emplace_back(is_rising ? a : b, d, c);
        }
    return m;
}

/// Another order of vertices, of triangles and of their corners.
in::mesh shuffled(const in::mesh& m, std::uint64_t seed) {
    in::random_sequence draw(seed, 1);
    const auto shuffle = [&](auto& list) {
        for (std::size_t i = list.size(); i > 1; --i)
            std::swap(list[i - 1], list[static_cast<std::size_t>(draw.uniform() * static_cast<double>(i))]);
    };
    std::vector<std::uint32_t> number(m.positions.size());
    std::iota(number.begin(), number.end(), 0u);
    shuffle(number);
    in::mesh out;
    out.positions.resize(m.positions.size());
    for (std::size_t v = 0; v < number.size(); ++v) out.positions[number[v]] = m.positions[v];
    for (glm::uvec3 t : m.triangles) {
        t = {number[t.x], number[t.y], number[t.z]};
        for (int turns = static_cast<int>(3 * draw.uniform()); turns > 0; --turns) t = {t.y, t.z, t.x};
        out.triangles.push_back(t);
    }
    shuffle(out.triangles);
    return out;
}

}  // namespace

TEST_CASE("A lattice in any order is put in the order of its rows") {
    for (const bool is_rising : {true, false})
        for (const auto& [columns, rows] : {std::pair{2, 2}, {3, 9}, {13, 3}, {17, 11}, {40, 60}}) {
            CAPTURE(is_rising, columns, rows);
            const in::mesh whole = lattice(columns, rows, is_rising);
            const in::shared_mesh in_order(whole), out_of_order(shuffled(whole, 5));
            REQUIRE(in_order.grid() != nullptr);
            REQUIRE(out_of_order.grid() != nullptr);
            CHECK(out_of_order.grid()->columns == columns);
            CHECK(out_of_order.grid()->rows == rows);
            CHECK(out_of_order.grid()->is_rising == is_rising);
            CHECK(out_of_order->positions == whole.positions);
            CHECK(out_of_order->triangles == whole.triangles);
            CHECK(out_of_order->normals == in_order->normals);
        }
}

TEST_CASE("A clockwise lattice with normals that point up is a grid, in any order") {
    const in::mesh whole = lattice(13, 21, true);
    in::mesh clockwise = whole;
    clockwise.normals.assign(whole.positions.size(), glm::vec3(0, 0, 1));
    for (glm::uvec3& t : clockwise.triangles) std::swap(t.y, t.z);
    in::mesh out_of_order = shuffled(clockwise, 5);
    out_of_order.normals = clockwise.normals;
    for (const in::mesh& m : {clockwise, out_of_order}) {
        const in::shared_mesh found(m);
        CHECK(found.kind() == in::surface_kind::heightfield);
        REQUIRE(found.grid() != nullptr);
        CHECK(found.grid()->columns == 13);
        CHECK(found->triangles == whole.triangles);
    }
}

TEST_CASE("A lattice may be turned and sheared") {
    const in::mesh whole = lattice(23, 31, false, {0.37, 0.02}, {-0.05, 0.41});
    in::mesh m = shuffled(whole, 9);
    CHECK(in::detail::order_by_lattice(m));
    CHECK(m.positions == whole.positions);
    CHECK(m.triangles == whole.triangles);
}

TEST_CASE("A lattice's normals follow its vertices") {
    in::mesh m = lattice(9, 7, true);
    for (std::size_t v = 0; v < m.positions.size(); ++v) m.normals.emplace_back(0.001f * static_cast<float>(v), 0, 1);
    in::mesh turned = m;
    std::reverse(turned.positions.begin(), turned.positions.end());
    std::reverse(turned.normals.begin(), turned.normals.end());
    const auto last = static_cast<std::uint32_t>(m.positions.size()) - 1;
    for (glm::uvec3& t : turned.triangles) t = {last - t.x, last - t.y, last - t.z};
    const in::shared_mesh found(turned);
    CHECK(found->positions == m.positions);
    CHECK(found->normals == m.normals);
}

TEST_CASE("A mesh that is almost a lattice keeps its vertex order and has no grid") {
    const auto is_left_alone = [](const in::mesh& m) {
        in::mesh ordered = m;
        const bool is_lattice = in::detail::order_by_lattice(ordered);
        return !is_lattice && ordered.positions == m.positions && ordered.triangles == m.triangles;
    };
    const in::mesh whole = lattice(8, 6, true);
    in::mesh m = whole;
    m.triangles.pop_back();
    CHECK(is_left_alone(m));
    m = whole;
    m.triangles[20] = m.triangles[22];  // one twice, one missing
    CHECK(is_left_alone(m));
    m = whole;
    std::swap(m.triangles[20].x, m.triangles[20].y);  // seen from below
    CHECK(is_left_alone(m));
    m = whole;
    m.triangles[20] = {21, 22, 29};  // a cell cut the other way
    CHECK(is_left_alone(m));
    m = whole;
    m.positions[30].x += 0.2f;  // off the lattice
    CHECK(is_left_alone(m));
    m = whole;
    m.positions[30] = m.positions[31];  // two in one place
    CHECK(is_left_alone(m));
    m = whole;
    m.positions[30].x = std::numeric_limits<float>::quiet_NaN();
    CHECK_FALSE(in::detail::order_by_lattice(m));
    m = whole;
    m.positions[30].x = 1e30f;
    CHECK(is_left_alone(m));
    CHECK(is_left_alone({}));
    CHECK(is_left_alone({{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}, {}, {{0, 1, 2}, {0, 1, 2}}}));
}
