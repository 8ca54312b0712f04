// Recognition of heightfields over a regular grid: their size, steps and diagonals.
#include <insonify/geometry/regular_grid.hpp>

#include <cmath>
#include <limits>

#include "../../catch.hpp"

namespace in = insonify;

namespace {

/// Vertices at (x, y) = (2 + 0.5 i - 0.1 j, -1 + 0.2 i + 0.4 j), any heights, each cell cut into two triangles.
/// @param sinks  rows go down, -1 + 0.2 i - 0.4 j, as those of pictures; triangles face up all the same
in::mesh grid_of(int columns, int rows, bool is_rising = true, int turned = 0, bool sinks = false) {
    in::mesh m;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            m.positions.emplace_back(2 + 0.5 * i - 0.1 * j, -1 + 0.2 * i + (sinks ? -0.4 : 0.4) * j, std::sin(i) * j);
            if (i + 1 == columns || j + 1 == rows) continue;
            const auto a = static_cast<std::uint32_t>(j * columns + i), d = a + static_cast<std::uint32_t>(columns);
            glm::uvec3 both[2] = {{a, a + 1, is_rising ? d + 1 : d}, {is_rising ? a : a + 1, d + 1, d}};
            for (glm::uvec3& t : both) {
                if (sinks) std::swap(t.y, t.z);
                for (int k = 0; k < turned; ++k) t = {t.y, t.z, t.x};
                m.triangles.push_back(t);
            }
        }
    return m;
}

}  // namespace

TEST_CASE("A regular grid is recognized by its size, its steps and the diagonals of its cells") {
    for (const auto& [is_rising, sinks] : {std::pair{true, false}, {false, false}, {true, true}, {false, true}})
        for (int turned = 0; turned < 3; ++turned)
            for (const auto& [columns, rows] : {std::pair{2, 2}, {2, 9}, {9, 2}, {3, 4}, {41, 67}}) {
                CAPTURE(is_rising, sinks, turned, columns, rows);
                const auto grid = in::regular_grid_of(grid_of(columns, rows, is_rising, turned, sinks));
                REQUIRE(grid);
                CHECK(grid->columns == columns);
                CHECK(grid->rows == rows);
                CHECK(grid->is_rising == is_rising);
                CHECK(grid->origin.x == Approx(2));
                CHECK(grid->origin.y == Approx(-1));
                CHECK(grid->right.x == Approx(0.5));
                CHECK(grid->right.y == Approx(0.2));
                CHECK(grid->up.x == Approx(-0.1));
                CHECK(grid->up.y == Approx(sinks ? -0.4 : 0.4));
            }
}

TEST_CASE("Meshes that are no regular grid are not taken for one") {
    const auto refused = [](const auto& change) {
        in::mesh m = grid_of(21, 30);
        change(m);
        return !in::regular_grid_of(m);
    };
    REQUIRE_FALSE(refused([](in::mesh&) {}));
    CHECK_FALSE(in::regular_grid_of({}));
    CHECK(refused([](in::mesh& m) { m.triangles.clear(); }));
    CHECK(refused([](in::mesh& m) { m.triangles.resize(1); }));
    CHECK(refused([](in::mesh& m) { m.triangles.pop_back(); }));
    CHECK(refused([](in::mesh& m) { m.triangles.push_back({0, 1, 2}); }));
    CHECK(refused([](in::mesh& m) { m.positions.pop_back(); }));
    CHECK(refused([](in::mesh& m) { m.positions.emplace_back(0, 0, 0); }));
    CHECK(refused([](in::mesh& m) { m.positions.clear(); }));
    CHECK(refused([](in::mesh& m) { m.positions.resize(20); }));
    // Any triangle of another shape, the first, one in the middle or the last.
    for (const std::size_t i : {0u, 1u, 2u, 500u, 777u, 1159u}) {
        CAPTURE(i);
        CHECK(refused([&](in::mesh& m) { ++m.triangles[i].x; }));
        CHECK(refused([&](in::mesh& m) { m.triangles[i].z = 0xFFFFFFFFu; }));
        CHECK(refused([&](in::mesh& m) { std::swap(m.triangles[i].x, m.triangles[i].y); }));
    }
    // The last triangle of a row, whatever its length.
    for (int columns = 2; columns < 20; ++columns) {
        CAPTURE(columns);
        in::mesh m = grid_of(columns, 3);
        ++m.triangles[static_cast<std::size_t>(2 * (columns - 1) - 1)].x;
        CHECK_FALSE(in::regular_grid_of(m));
    }
    // Any vertex off its place.
    for (const std::size_t i : {0u, 20u, 21u, 300u, 609u, 629u})
        for (const float by : {0.01f, -0.01f, std::nanf(""), std::numeric_limits<float>::infinity()}) {
            CAPTURE(i, by);
            CHECK(refused([&](in::mesh& m) { m.positions[i].x += by; }));
            CHECK(refused([&](in::mesh& m) { m.positions[i].y += by; }));
        }
    CHECK_FALSE(refused([](in::mesh& m) { m.positions[300].x += 0.001f; }));
    CHECK_FALSE(refused([](in::mesh& m) { m.positions[300].z += 1e6f; }));
    CHECK(refused([](in::mesh& m) { m.positions[300].z = std::nanf(""); }));
    CHECK(refused([](in::mesh& m) { m.positions[300].z = -std::numeric_limits<float>::infinity(); }));
    // Seen from below, or from its edge.
    CHECK(refused([](in::mesh& m) {
        for (glm::uvec3& t : m.triangles) std::swap(t.x, t.y);
    }));
    CHECK(refused([](in::mesh& m) {
        for (glm::vec3& p : m.positions) p.x = -p.x;
    }));
    CHECK(refused([](in::mesh& m) {
        for (glm::vec3& p : m.positions) p.y = 0;
    }));
    // The second triangle of every cell covers half of the first, or repeats it.
    for (const bool is_same : {false, true})
        CHECK(refused([&](in::mesh& m) {
            const in::mesh other = grid_of(21, 30, is_same);
            for (std::size_t i = 0; i < m.triangles.size(); i += 2) m.triangles[i + 1] = other.triangles[i];
        }));
    // Cut alternately.
    CHECK(refused([](in::mesh& m) {
        const in::mesh other = grid_of(21, 30, false);
        m.triangles[60] = other.triangles[60];
        m.triangles[61] = other.triangles[61];
    }));
}

TEST_CASE("regular_grid::lattice_error is the largest distance of a vertex from its lattice position, in grid steps") {
    // Exact in float: steps of (1, 0.5) and (-0.5, 0.25), whose parallelogram has an area of 0.5.
    in::mesh m = grid_of(9, 9);
    for (std::size_t i = 0; i < m.positions.size(); ++i) {
        const auto column = static_cast<float>(i % 9), row = static_cast<float>(i / 9);
        m.positions[i].x = column - 0.5f * row;
        m.positions[i].y = 0.5f * column + 0.25f * row;
    }
    CHECK(in::regular_grid_of(m).value().lattice_error == 0);
    // Straight across the longer step: by 0.75 of it and 2.5 of the shorter one, times 2^-11.
    m.positions[40] += 0x1p-11f * glm::vec3(-0.5f, 1, 0);
    CHECK(in::regular_grid_of(m).value().lattice_error == Approx(2.5 * 0x1p-11));
    // Decimal steps are rounded to float.
    CHECK(in::regular_grid_of(grid_of(9, 9)).value().lattice_error < 1e-6);
}
