// Adaptive meshes: within the tolerance everywhere, without cracks, and without triangles that could be merged.
#include <insonify/core/random.hpp>
#include <insonify/core/thread_pool.hpp>
#include <insonify/geometry/topology.hpp>
#include <insonify/seabed/adaptive.hpp>
#include <insonify/seabed/models.hpp>
#include <insonify/seabed/sample.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "../../catch.hpp"

namespace in = insonify;
namespace sb = insonify::seabed;

namespace {

sb::heightfield field_of(const sb::any& source, int width, int height, double spacing = 0.05) {
    return sb::sample(source, {.origin = {1.5, -2.25}, .spacing = spacing, .width = width, .height = height});
}

/// Calls visit(x, y, mesh height, triangle) on a net of points four times as fine as the grid, corners, sides and
/// diagonals among them.
template <class Visit>
void each_point(const sb::heightfield& field, const in::mesh& m, const Visit& visit) {
    const double step = field.spacing / 4;
    for (const glm::uvec3& t : m.triangles) {
        const glm::dvec3 a(m.positions[t.x]), b(m.positions[t.y]), c(m.positions[t.z]);
        const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        const double x0 = std::min({a.x, b.x, c.x}), x1 = std::max({a.x, b.x, c.x});
        const double y0 = std::min({a.y, b.y, c.y}), y1 = std::max({a.y, b.y, c.y});
        for (double y = y0; y <= y1 + step / 2; y += step)
            for (double x = x0; x <= x1 + step / 2; x += step) {
                const double v = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / area;
                const double w = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
                if (v < -1e-9 || w < -1e-9 || v + w > 1 + 1e-9) continue;
                visit(x, y, a.z + v * (b.z - a.z) + w * (c.z - a.z), t);
            }
    }
}

double farthest_off(const sb::heightfield& field, const in::mesh& m) {
    double worst = 0;
    each_point(field, m, [&](double x, double y, double z, const glm::uvec3&) {
        worst = std::max(worst, std::abs(z - field.facet_at(field.origin.x + x, field.origin.y + y).height));
    });
    return worst;
}

double area_of(const in::mesh& m) {
    double sum = 0;
    for (const glm::uvec3& t : m.triangles) {
        const glm::dvec2 a(m.positions[t.x]), b(m.positions[t.y]), c(m.positions[t.z]);
        const double area = ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
        CHECK(area > 0);
        sum += area;
    }
    return sum;
}

/// Sides that belong to one triangle alone and don't lie on the field's border: where a mesh has cracks.
int cracks(const sb::heightfield& field, const in::mesh& m) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
    for (const glm::uvec3& t : m.triangles)
        for (const auto& [a, b] : {std::pair{t.x, t.y}, std::pair{t.y, t.z}, std::pair{t.z, t.x}})
            ++sides[{std::min(a, b), std::max(a, b)}];
    const auto width = static_cast<float>(field.spacing * (field.heights.width() - 1));
    const auto height = static_cast<float>(field.spacing * (field.heights.height() - 1));
    int count = 0;
    for (const auto& [ends, uses] : sides) {
        const glm::vec3 &a = m.positions[ends.first], &b = m.positions[ends.second];
        const bool border = (a.x == b.x && (a.x == 0 || a.x == width)) || (a.y == b.y && (a.y == 0 || a.y == height));
        count += uses != (border ? 1 : 2);
    }
    return count;
}

/// The triangles by their corners' positions, whatever the order.
std::set<std::vector<std::tuple<float, float, float>>> shapes(const in::mesh& m) {
    std::set<std::vector<std::tuple<float, float, float>>> all;
    for (const glm::uvec3& t : m.triangles) {
        std::vector<std::tuple<float, float, float>> corners;
        for (const std::uint32_t i : {t.x, t.y, t.z})
            corners.emplace_back(m.positions[i].x, m.positions[i].y, m.positions[i].z);
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        all.insert(corners);
    }
    return all;
}

const sb::any seabeds[] = {sb::flat{}, sb::ripples{}, sb::mud{}, sb::rock{}};

}  // namespace

TEST_CASE("A plane takes two triangles where the field is a square of a power of two cells, and few elsewhere") {
    sb::heightfield tilted = field_of(sb::none{}, 65, 65);
    const auto tilt = [](sb::heightfield& field) {
        for (int j = 0; j < field.heights.height(); ++j)
            for (int i = 0; i < field.heights.width(); ++i)
                field.heights(i, j) = 0.125f * static_cast<float>(i) - 0.25f * static_cast<float>(j);
    };
    tilt(tilted);
    const auto two = sb::tessellate(tilted, sb::tolerance{});
    CHECK(two.shape.triangles.size() == 2);
    CHECK(two.shape.positions.size() == 4);
    CHECK(farthest_off(tilted, two.shape) < 1e-6);
    for (const auto& [width, height] : {std::pair{2, 2}, {3, 2}, {2, 9}, {100, 37}, {66, 65}, {33, 65}}) {
        CAPTURE(width, height);
        sb::heightfield other = field_of(sb::none{}, width, height);
        tilt(other);
        const auto few = sb::tessellate(other, sb::tolerance{});
        CHECK(cracks(other, few.shape) == 0);
        CHECK(area_of(few.shape) == Approx(other.spacing * other.spacing * (width - 1) * (height - 1)));
        CHECK(few.shape.triangles.size() <= 2u * static_cast<unsigned>(width - 1) * static_cast<unsigned>(height - 1));
        CHECK(few.shape.triangles.size() <= 12u * static_cast<unsigned>(width + height));
    }
}

TEST_CASE("The mesh is within the tolerance everywhere and has no cracks, on any seabed") {
    for (const sb::any& seabed : seabeds)
        for (const auto& [width, height] : {std::pair{65, 65}, {50, 71}})
            for (const double allowed : {0.0, 0.0005, 0.004, 0.03}) {
                CAPTURE(seabed.legend().front().name, width, height, allowed);
                const sb::heightfield field = field_of(seabed, width, height);
                const auto coarse = sb::tessellate(field, {.height = allowed});
                CHECK(farthest_off(field, coarse.shape) <= allowed + 1e-6);
                CHECK(cracks(field, coarse.shape) == 0);
                CHECK(area_of(coarse.shape) ==
                      Approx(field.spacing * field.spacing * (width - 1) * (height - 1)).epsilon(1e-5));
                REQUIRE(coarse.vertices.size() == coarse.shape.positions.size());
                for (std::size_t i = 0; i < coarse.vertices.size(); ++i)
                    CHECK(coarse.shape.positions[i].z == field.heights.pixels()[coarse.vertices[i]]);
            }
}

TEST_CASE("Where nothing may be left out, the triangles are those of the whole grid") {
    const sb::heightfield field = field_of(sb::rock{}, 40, 57);
    const in::mesh whole = sb::tessellate(field);
    const auto same = sb::tessellate(field, sb::tolerance{});
    CHECK((shapes(same.shape) == shapes(whole)));
    CHECK((same.shape.normals == whole.normals));
}

TEST_CASE("No two halves could be replaced by their whole triangle within the tolerance") {
    const double allowed = 0.004;
    for (const sb::any& seabed : seabeds) {
        CAPTURE(seabed.legend().front().name);
        const sb::heightfield field = field_of(seabed, 65, 65);
        const auto coarse = sb::tessellate(field, {.height = allowed});
        CHECK(coarse.shape.triangles.size() < std::size_t{2} * 64 * 64);
        std::map<std::uint32_t, std::vector<glm::uvec3>> around;
        for (const glm::uvec3& t : coarse.shape.triangles)
            for (const std::uint32_t i : {t.x, t.y, t.z}) around[i].push_back(t);
        int tried = 0, paired = 0;
        for (const auto& [vertex, triangles] : around) {
            // A vertex at which all angles are right ones halves one triangle or two, and nothing else needs it.
            const glm::dvec3 at(coarse.shape.positions[vertex]);
            std::set<std::uint32_t> rim;
            bool halves = triangles.size() != 1;
            for (const glm::uvec3& t : triangles) {
                std::vector<glm::dvec3> arms;
                for (const std::uint32_t i : {t.x, t.y, t.z})
                    if (i != vertex) {
                        rim.insert(i);
                        arms.push_back(glm::dvec3(coarse.shape.positions[i]) - at);
                    }
                halves &= std::abs(arms[0].x * arms[1].x + arms[0].y * arms[1].y) < 1e-6;
            }
            if (!halves) continue;
            // The longest side that it is the middle of: along the axis in which it is odd; or the diagonal that leads
            // to the middle of the square around.
            const auto x = static_cast<int>(coarse.vertices[vertex] % 65),
                       y = static_cast<int>(coarse.vertices[vertex] / 65);
            const int step = (x | y) & -(x | y);
            const bool centre = (x & step) != 0 && (y & step) != 0;
            const glm::ivec2 along = centre ? glm::ivec2(1, ((x ^ y) & (2 * step)) == 0 ? 1 : -1)
                                            : glm::ivec2((x & step) != 0, (y & step) != 0);
            double worst = 0;
            const auto on_side = [&](std::uint32_t i) {
                const glm::dvec3 arm = glm::dvec3(coarse.shape.positions[i]) - at;
                return std::abs(arm.x * along.y - arm.y * along.x) < 1e-6;
            };
            std::vector<std::uint32_t> ends;
            for (const std::uint32_t i : rim)
                if (on_side(i)) ends.push_back(i);
            if (ends.size() != 2) continue;  // a cell that is cut as the heightfield's are
            for (const std::uint32_t tip : rim) {
                if (on_side(tip)) continue;
                const auto& p = coarse.shape.positions;
                const in::mesh merged{{p[ends[0]], p[ends[1]], p[tip]}, {}, {{0, 1, 2}}};
                worst = std::max(worst, farthest_off(field, merged));
            }
            ++tried;
            // The smallest ones may be there to cut a twisted cell along the heightfield's diagonal.
            const bool may_pair = step == 1 && !centre && worst <= allowed - 1e-6;
            paired += may_pair;
            if (!may_pair) CHECK(worst > allowed - 1e-6);
        }
        CHECK(tried > 20);
        CHECK(paired * 20 < tried);
    }
}

TEST_CASE("Below the camera more may be left out than at the picture's edge, as it leans") {
    const sb::heightfield field = field_of(sb::mud{}, 129, 129);
    const glm::dvec2 middle = field.origin + 64 * field.spacing;
    const double lean = 0.004;
    const auto coarse = sb::tessellate(field, {.height = 0.02, .lean = lean, .nadir = middle - field.origin});
    int inner = 0, outer = 0;
    each_point(field, coarse.shape, [&](double x, double y, double z, const glm::uvec3&) {
        const glm::dvec2 at(field.origin.x + x, field.origin.y + y);
        const double distance =
            std::sqrt((at.x - middle.x) * (at.x - middle.x) + (at.y - middle.y) * (at.y - middle.y));
        const double off = std::abs(z - field.facet_at(at.x, at.y).height);
        if (off > std::min(0.02, lean / std::max(distance, 1e-9)) + 1e-6)
            FAIL_CHECK("off by " << off << " at " << distance);
    });
    for (const std::uint32_t v : coarse.vertices) {
        const int i = static_cast<int>(v % 129) - 64, j = static_cast<int>(v / 129) - 64;
        (std::max(std::abs(i), std::abs(j)) < 32 ? inner : outer) += 1;
    }
    CHECK(inner * 3 < outer * 0.8);  // the outer ring has three times the area
}

TEST_CASE("Slopes stay within their tolerance at every vertex, and types keep their borders") {
    const sb::heightfield field = field_of(sb::blend{.patch = 1.5f, .border = 0.3f}, 97, 97);
    REQUIRE(!field.types.empty());
    const double slope = 0.05;
    const auto coarse = sb::tessellate(field, {.height = 1, .slope = slope});
    CHECK(coarse.shape.triangles.size() < std::size_t{17} * 96 * 96 / 10);
    const in::mesh whole = sb::tessellate(field);
    const auto slopes_of = [](const glm::vec3& n) { return glm::dvec2(-n.x / n.z, -n.y / n.z); };
    for (const glm::uvec3& t : coarse.shape.triangles) {
        const sb::type kind = field.types.pixels()[coarse.vertices[t.x]];
        const bool is_half_a_cell = std::abs((coarse.shape.positions[t.y] - coarse.shape.positions[t.x]).x) +
                                        std::abs((coarse.shape.positions[t.y] - coarse.shape.positions[t.x]).y) <
                                    2.1f * static_cast<float>(field.spacing);
        if (is_half_a_cell) continue;
        in::mesh one;
        one.positions = {coarse.shape.positions[t.x], coarse.shape.positions[t.y], coarse.shape.positions[t.z]};
        one.triangles = {{0, 1, 2}};
        const glm::dvec2 sa = slopes_of(coarse.shape.normals[t.x]), sb_ = slopes_of(coarse.shape.normals[t.y]),
                         sc = slopes_of(coarse.shape.normals[t.z]);
        const glm::dvec3 a(one.positions[0]), b(one.positions[1]), c(one.positions[2]);
        const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        for (int j = 0; j <= 96; ++j)
            for (int i = 0; i <= 96; ++i) {
                const double x = i * field.spacing, y = j * field.spacing;
                const double v = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / area;
                const double w = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
                if (v < -1e-6 || w < -1e-6 || v + w > 1 + 1e-6) continue;
                const glm::dvec2 here = sa + v * (sb_ - sa) + w * (sc - sa);
                const glm::dvec2 truth = slopes_of(whole.normals[static_cast<std::size_t>(j * 97 + i)]);
                if (std::abs(here.x - truth.x) > slope + 1e-4 || std::abs(here.y - truth.y) > slope + 1e-4)
                    FAIL_CHECK("slope at " << i << ", " << j);
                if (field.types(i, j) != kind) FAIL_CHECK("type at " << i << ", " << j);
            }
    }
}

TEST_CASE("Missing heights are left out as they are by the whole grid") {
    sb::heightfield field = field_of(sb::mud{}, 65, 50);
    for (int i = 20; i < 30; ++i) field.heights(i, 2 * i - 30) = std::nanf("");
    const auto coarse = sb::tessellate(field, {.height = 0.01});
    const in::mesh whole = sb::tessellate(field);
    CHECK(area_of(coarse.shape) == Approx(area_of(whole)));
    CHECK(coarse.shape.triangles.size() < whole.triangles.size() / 2);
    CHECK(sb::tessellate(field_of(sb::none{}, 33, 20), {.height = 1}).shape.triangles.empty());
}

TEST_CASE("The mesh is the same for any executor, and a tolerance below zero is refused") {
    const sb::heightfield field = field_of(sb::rock{}, 200, 150);
    in::thread_pool pool(3);
    const auto serial = sb::tessellate(field, {.height = 0.01, .slope = 0.3}),
               parallel = sb::tessellate(field, {.height = 0.01, .slope = 0.3}, pool);
    CHECK((serial.shape.positions == parallel.shape.positions));
    CHECK((serial.shape.triangles == parallel.shape.triangles));
    CHECK(serial.vertices == parallel.vertices);
    CHECK_THROWS_AS(sb::tessellate(field, {.height = -1}), in::invalid_input);
    CHECK_THROWS_AS(sb::tessellate(field, {.slope = -1}), in::invalid_input);
    CHECK_THROWS_AS(sb::tessellate(field, {.lean = std::nan("")}), in::invalid_input);
}
