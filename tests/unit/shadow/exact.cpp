// Exact shadows, point by point: closed forms to a nanometre, no bias in either direction, lights at the ends of what
// there is, and the same answer however it is computed.
#include <insonify/core/dispatch.hpp>
#include <insonify/core/random.hpp>
#include <insonify/core/thread_pool.hpp>
#include <insonify/geometry/cube.hpp>
#include <insonify/geometry/sphere.hpp>
#include <insonify/seabed/any.hpp>
#include <insonify/seabed/sample.hpp>
#include <insonify/seabed/tessellate.hpp>
#include <insonify/shadow/exact.hpp>

#include <cmath>

#include "../../catch.hpp"

namespace in = insonify;
namespace shadow = insonify::shadow;

namespace {

double radians(double degrees) {
    return in::numeric::to_radians(degrees);
}

/// Asks about points, as many at a time as the instruction set has lanes.
struct question {
    const shadow::light_blockers& blockers;
    const shadow::light_rays& rays;
    const std::vector<glm::dvec3>& points;
    std::vector<bool>& dark;

    template <int N>
    INSONIFY_INLINE void run() const {
        for (std::size_t first = 0; first < points.size(); first += N) {
            const std::size_t count = (std::min)(points.size() - first, std::size_t{N});
            const unsigned bits = blockers.stop<N>(rays, &points[first], (1u << count) - 1);
            for (std::size_t k = 0; k < count; ++k) dark[first + k] = (bits >> k & 1) != 0;
        }
    }
};

/// A mesh, a light, and what is dark.
class lit_mesh {
  public:
    template <class Light, class E = in::serial_executor>
    lit_mesh(in::mesh m, const Light& light, bool is_solid = true, double reach = 0, E&& ex = {})
        : mesh_(std::move(m)),
          corners_(shadow::placed_corners(mesh_, {})),
          rays_(light, (std::max)(reach, shadow::reach_of(corners_))),
          blockers_(rays_, mesh_, corners_, is_solid, false, ex) {}
    lit_mesh(const lit_mesh&) = delete;

    std::vector<bool> dark(const std::vector<glm::dvec3>& points, in::isa level = in::best_isa()) const {
        std::vector<bool> answers(points.size());
        in::detail::dispatch(question{blockers_, rays_, points, answers}, level);
        return answers;
    }
    bool is_dark(const glm::dvec3& p) const { return dark({p})[0]; }
    const in::mesh& mesh() const { return mesh_; }
    glm::dvec3 normal(std::size_t triangle) const {
        const glm::uvec3& t = mesh_.triangles[triangle];
        return in::numeric::cross(corners_[t.y] - corners_[t.x], corners_[t.z] - corners_[t.x]);
    }
    glm::dvec3 toward(const glm::dvec3& p) const { return rays_.toward(p); }

  private:
    in::mesh mesh_;
    std::vector<glm::dvec3> corners_;
    shadow::light_rays rays_;
    shadow::light_blockers blockers_;
};

shadow::light_frame parallel(double azimuth, double elevation) {
    return shadow::light_frame({radians(azimuth), radians(elevation)});
}

in::mesh box(const glm::dvec3& size, const glm::dvec3& centre) {
    return in::transformed(to_mesh(in::cube{.size = glm::vec3(size)}), {glm::dmat3(1), centre});
}

in::mesh rough(double spacing = 1.0 / 32) {
    const int side = static_cast<int>(2 / spacing) + 1;
    return in::seabed::tessellate(in::seabed::sample(in::seabed::rock{}, {{-1, -1}, spacing, side, side}));
}

/// Points on a mesh's facets that face the light, with nothing but rounding between them and the facet.
std::vector<glm::dvec3> points_on(const lit_mesh& lit, std::size_t count, std::uint64_t seed) {
    in::random_sequence random(seed);
    const in::mesh& m = lit.mesh();
    std::vector<glm::dvec3> points;
    for (std::size_t tries = 0; points.size() < count && tries < 50 * count; ++tries) {
        const auto i = random.below(static_cast<std::uint32_t>(m.triangles.size()));
        const glm::uvec3& t = m.triangles[i];
        const glm::dvec3 a(m.positions[t.x]), ab = glm::dvec3(m.positions[t.y]) - a,
                                              ac = glm::dvec3(m.positions[t.z]) - a;
        double u = random.uniform(), v = random.uniform();
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        const glm::dvec3 p = a + u * ab + v * ac;
        if (shadow::is_faced(lit.normal(i), lit.toward(p), lit.normal(i))) points.push_back(p);
    }
    return points;
}

/// Whether any triangle is on the way to the light, asked one by one.
bool is_blocked(const in::mesh& m, const glm::dvec3& from, const glm::dvec3& along, double end) {
    for (const glm::uvec3& t : m.triangles) {
        const glm::dvec3 a(m.positions[t.x]), ab = glm::dvec3(m.positions[t.y]) - a,
                                              ac = glm::dvec3(m.positions[t.z]) - a;
        const glm::dvec3 p = glm::cross(along, ac), s = from - a, q = glm::cross(s, ab);
        const double determinant = glm::dot(ab, p);
        if (determinant == 0) continue;
        const double u = glm::dot(s, p) / determinant, v = glm::dot(along, q) / determinant;
        const double hit = glm::dot(ac, q) / determinant;
        if (u >= 0 && v >= 0 && u + v <= 1 && hit > 1e-9 && hit < end) return true;
    }
    return false;
}

const double elevations[] = {0.01, 0.5, 1, 2, 6, 20, 45, 89, 89.99};
constexpr double endless = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("A shadow is as long as height over tangent, to a nanometre, from a millimetre's height to a kilometre's") {
    for (const double height : {1e-3, 1.0, 1e3})
        for (const double elevation : elevations)
            for (const double azimuth : {0.0, 45.0, 90.0, 160.0}) {
                CAPTURE(height, elevation, azimuth);
                const shadow::light_frame light = parallel(azimuth, elevation);
                const lit_mesh cube(box(glm::dvec3(height), {0, 0, height / 2}), light);
                // Behind the top's corner or edge that is farthest down the light.
                const glm::dvec2 travel = light.travel();
                const auto side = [&](double t) { return std::abs(t) < 1e-9 ? 0.0 : std::copysign(height / 2, t); };
                const glm::dvec2 tip = glm::dvec2(side(travel.x), side(travel.y)) +
                                       static_cast<double>(static_cast<float>(height)) * light.cot_elevation() * travel;
                const double little = height * (1e-7 + 1e-10 * light.cot_elevation());
                CHECK(cube.is_dark(glm::dvec3(tip - little * travel, 0)));
                CHECK_FALSE(cube.is_dark(glm::dvec3(tip + little * travel, 0)));
                // And it begins at the foot: no gap.
                if (elevation < 89.9) {
                    const glm::dvec2 foot(side(travel.x), side(travel.y));
                    CHECK(cube.is_dark(glm::dvec3(foot + 1e-6 * height * travel, 0)));
                }
            }
}

TEST_CASE("No surface that faces the light stands in its own, whether its lit side may cast or not") {
    for (const double elevation : elevations)
        for (const double tilt : {-89.0, -30.0, -0.6, 0.0, 5.0, 80.0, 89.9})
            for (const double azimuth : {0.0, 45.0, 23.7, 180.0})
                for (const bool is_solid : {true, false}) {
                    const double rise = std::tan(radians(tilt));
                    in::mesh plane;
                    for (int j = 0; j <= 6; ++j)
                        for (int i = 0; i <= 6; ++i) {
                            const double x = i / 3.0 - 1, y = j / 3.0 - 1;
                            plane.positions.emplace_back(x, y, rise * (0.8 * x + 0.6 * y));
                        }
                    for (unsigned j = 0; j < 6; ++j)
                        for (unsigned i = 0; i < 6; ++i) {
                            const unsigned c = 7 * j + i;
                            plane.triangles.emplace_back(c, c + 1, c + 8);
                            plane.triangles.emplace_back(c, c + 8, c + 7);
                        }
                    const lit_mesh lit(plane, parallel(azimuth, elevation), is_solid);
                    const std::vector<bool> dark = lit.dark(points_on(lit, 40, 5));
                    CAPTURE(elevation, tilt, azimuth, is_solid);
                    CHECK(std::count(dark.begin(), dark.end(), true) == 0);
                }
}

TEST_CASE("Points on rubble are dark where a ray meets a triangle, in every one of them") {
    for (const double elevation : elevations) {
        const lit_mesh lit(rough(1.0 / 16), parallel(25, elevation));
        const std::vector<glm::dvec3> points = points_on(lit, 400, 11);
        const std::vector<bool> dark = lit.dark(points);
        int wrong = 0;
        for (std::size_t i = 0; i < points.size(); ++i)
            wrong += dark[i] != is_blocked(lit.mesh(), points[i], lit.toward(points[i]), endless);
        CAPTURE(elevation);
        CHECK(wrong == 0);
    }
}

TEST_CASE("Of a closed shape it doesn't matter whether the sides in the light cast too") {
    const in::mesh ball = in::transformed(to_mesh(in::sphere{.radius = 0.5f}), {glm::dmat3(1), {0, 0, 0.5}});
    const lit_mesh sides(ball, parallel(60, 30), true), all(ball, parallel(60, 30), false);
    std::vector<glm::dvec3> ground;
    for (int j = -40; j <= 40; ++j)
        for (int i = -40; i <= 40; ++i) ground.push_back({0.0371 * i + 0.011, 0.0371 * j, 0});
    CHECK((sides.dark(ground) == all.dark(ground)));
    const std::vector<glm::dvec3> skin = points_on(sides, 2000, 3);
    CHECK((sides.dark(skin) == std::vector<bool>(skin.size(), false)));
    CHECK((all.dark(skin) == std::vector<bool>(skin.size(), false)));
}

TEST_CASE("Light from a point: shadows spread as similar triangles do") {
    // A square of side s at height h under a light at height H throws one of side s H / (H - h).
    const double light = 3, height = 1, side = 0.5;
    const in::mesh sheet{
        {{-0.25f, -0.25f, 1}, {0.25f, -0.25f, 1}, {0.25f, 0.25f, 1}, {-0.25f, 0.25f, 1}}, {}, {{0, 1, 2}, {0, 2, 3}}};
    for (const glm::dvec2 beside : {glm::dvec2(0, 0), glm::dvec2(-7, 2), glm::dvec2(0, 100)}) {
        const lit_mesh lit(sheet, shadow::point_light{{beside, light}}, false, 200);
        const double half = 0.5 * side * light / (light - height);
        const glm::dvec2 centre = -beside * (height / (light - height));
        for (const double sign : {-1.0, 1.0})
            for (int axis = 0; axis < 2; ++axis) {
                glm::dvec2 edge = centre;
                edge[axis] += sign * half;
                glm::dvec2 out(0);
                out[axis] = sign * 1e-7;
                CAPTURE(beside.x, beside.y, sign, axis);
                CHECK(lit.is_dark(glm::dvec3(edge - out, 0)));
                CHECK_FALSE(lit.is_dark(glm::dvec3(edge + out, 0)));
            }
        CHECK_FALSE(lit.is_dark(glm::dvec3(0, 0, 2)));  // above the sheet
    }
}

TEST_CASE("A point far away lights as its direction does") {
    const glm::dvec3 to_light = parallel(200, 6).to_light();
    const lit_mesh far_away(rough(), shadow::point_light{1e9 * to_light}, true),
        parallel_light(rough(), parallel(200, 6));
    const std::vector<glm::dvec3> points = points_on(parallel_light, 3000, 8);
    const std::vector<bool> one = far_away.dark(points), other = parallel_light.dark(points);
    int different = 0;
    for (std::size_t i = 0; i < points.size(); ++i) different += one[i] != other[i];
    CHECK(different <= 1);
    CHECK(std::count(one.begin(), one.end(), true) > 300);
}

TEST_CASE("Lights low over the bottom, on it, in it, beside and inside of a target: as rays tried one by one") {
    in::mesh bottom = rough(1.0 / 16);
    const glm::dvec3 on_vertex(bottom.positions[500]);
    const glm::dvec3 on_facet =
        (glm::dvec3(bottom.positions[bottom.triangles[700].x]) + glm::dvec3(bottom.positions[bottom.triangles[700].y]) +
         glm::dvec3(bottom.positions[bottom.triangles[700].z])) /
        3.0;
    const glm::dvec3 lights[] = {
        {0.3, 0.2, 0.35}, {0.3, 0.2, 5},     on_vertex,  on_facet, on_facet + glm::dvec3(0, 0, 0.01),
        {0.1, 0.1, -2},   {-30, 0.013, 0.2}, {0, 0, 1e4}};
    for (const glm::dvec3& position : lights) {
        const lit_mesh lit(bottom, shadow::point_light{position}, false);
        std::vector<glm::dvec3> points = points_on(lit, 250, 2);
        points.push_back(position);
        const std::vector<bool> dark = lit.dark(points);
        int wrong = 0;
        for (std::size_t i = 0; i < points.size(); ++i)
            wrong += dark[i] != is_blocked(bottom, points[i], position - points[i], 1 - 1e-9);
        CAPTURE(position.x, position.y, position.z);
        CHECK(wrong == 0);
    }
    // Inside of a closed box nothing gets out, and everything inside is lit.
    const lit_mesh closed(box({1, 1, 1}, {0, 0, 0.5}), shadow::point_light{{0.1, 0.2, 0.6}}, false);
    CHECK(closed.is_dark({2, 0, 0}));
    CHECK(closed.is_dark({0, 0, 3}));
    CHECK_FALSE(closed.is_dark({-0.4, 0.4, 0.1}));
}

TEST_CASE("Light exactly along a face or an edge: the face casts no more than its edges do") {
    // Straight from -x over a cube that is turned along it: sides parallel to the light cast the cube's own outline.
    const lit_mesh cube(box({1, 1, 1}, {0, 0, 0.5}), parallel(0, 45));
    CHECK(cube.is_dark({1.4999999, 0.4999999, 0}));
    CHECK_FALSE(cube.is_dark({1, 0.5000001, 0}));
    CHECK_FALSE(cube.is_dark({1.5000001, 0, 0}));
    // Steep enough to run down a tilted face: it is grazed, so dark, and what lies on it isn't behind it.
    in::mesh ramp{{{0, -1, 1}, {1, -1, 0}, {1, 1, 0}, {0, 1, 1}}, {}, {{0, 1, 2}, {0, 2, 3}}};
    const lit_mesh grazed(ramp, parallel(0, 45), false);
    CHECK_FALSE(shadow::is_faced(grazed.normal(0), grazed.toward({}), {0, 0, 1}));
    CHECK_FALSE(grazed.is_dark({0.5, 0, 0.5}));
    CHECK_FALSE(grazed.is_dark({1.2, 0, 0}));
    CHECK_FALSE(grazed.is_dark({1.2, 0, -0.1}));
}

TEST_CASE("One vertical wall of a seabed, and one flat as a table") {
    in::seabed::heightfield field{.heights = in::image<float>(65, 65), .origin = {-1, -1}, .spacing = 1.0 / 32};
    const lit_mesh flat(in::seabed::tessellate(field), parallel(30, 0.01));
    std::vector<bool> dark = flat.dark(points_on(flat, 500, 1));
    CHECK(std::count(dark.begin(), dark.end(), true) == 0);
    // A step of 1 km over a cell of 3 cm, as near to vertical as a heightfield comes.
    for (int j = 0; j < 65; ++j)
        for (int i = 0; i < 32; ++i) field.heights(i, j) = 1000;
    const in::mesh m = in::seabed::tessellate(field);
    for (const double elevation : {0.01, 6.0, 89.0, 89.99}) {
        const lit_mesh wall(m, parallel(0, elevation));
        const std::vector<glm::dvec3> points = points_on(wall, 300, 4);
        dark = wall.dark(points);
        int wrong = 0;
        for (std::size_t i = 0; i < points.size(); ++i)
            wrong += dark[i] != is_blocked(m, points[i], wall.toward(points[i]), endless);
        CAPTURE(elevation);
        CHECK(wrong == 0);
    }
}

TEST_CASE("Exact answers are the same at every instruction set and for any executor") {
    in::thread_pool pool(3);
    const auto same = [&](const auto& light) {
        const lit_mesh serial(rough(), light), threads(rough(), light, true, 0, pool);
        std::vector<glm::dvec3> points = points_on(serial, 3001, 9);
        const std::vector<bool> expected = serial.dark(points, in::isa::scalar);
        CHECK(std::count(expected.begin(), expected.end(), true) > 100);
        for (const in::isa level : {in::isa::scalar, in::isa::baseline, in::isa::avx2}) {
            CHECK((serial.dark(points, level) == expected));
            CHECK((threads.dark(points, level) == expected));
        }
    };
    same(parallel(23, 6));
    same(shadow::point_light{{-0.7, 0.3, 0.9}});
}

TEST_CASE("Nothing stands in the light where nothing is, nor what isn't finite") {
    CHECK_FALSE(lit_mesh({}, parallel(0, 45)).is_dark({0, 0, 0}));
    CHECK_FALSE(lit_mesh({}, shadow::point_light{{0, 0, 1}}).is_dark({0, 0, 0}));
    const double nan = std::nan("");
    const lit_mesh cube(box({1, 1, 1}, {0, 0, 0.5}), parallel(0, 45));
    CHECK_FALSE(cube.is_dark({nan, 0, 0}));
    CHECK_FALSE(cube.is_dark({0, 0, nan}));
    CHECK_FALSE(cube.is_dark({1e30, 0, 0}));
    CHECK_FALSE(cube.is_dark({0, -1e300, 0}));
    in::mesh broken = cube.mesh();
    broken.positions[0].x = std::nanf("");
    broken.positions[1].z = std::numeric_limits<float>::infinity();
    CHECK(lit_mesh(broken, parallel(0, 45), false).is_dark({1.2, 0.3, 0}) == true);
    CHECK_THROWS_AS(shadow::light_rays(shadow::point_light{{nan, 0, 0}}, 1), in::invalid_input);
}
