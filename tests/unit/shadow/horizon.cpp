// Heightfields on a grid as casters: triangles known to be lit or dark, against single rays, and the number of points
// that need a test in doubles.
#include <insonify/geometry/cube.hpp>
#include <insonify/geometry/shared_mesh.hpp>
#include <insonify/seabed/models.hpp>
#include <insonify/seabed/sample.hpp>
#include <insonify/seabed/tessellate.hpp>

#include "../../catch.hpp"
#include "lit_mesh.hpp"

namespace in = insonify;
namespace shadow = insonify::shadow;
using lit::parallel;

namespace {

/// A seabed of 3 m x 3 m as a caster on its grid.
class swept_seabed {
  public:
    swept_seabed(const in::seabed::any& recipe, int side, const shadow::directional_light& light)
        : surface(in::seabed::tessellate(in::seabed::sample(recipe, {{-1.5, -1.5}, 3.0 / (side - 1), side, side})),
                  light),
          grid_(in::regular_grid_of(*surface, in::shared_mesh::grid_error)) {
        REQUIRE(grid_);
        caster_ = lit::caster_of(*surface);
        caster_.may_skip = shadow::skip::facing_self;
        caster_.grid = &*grid_;
    }
    const shadow::caster& caster() const { return caster_; }

    const lit::mesh surface;

  private:
    std::optional<in::regular_grid> grid_;
    shadow::caster caster_;
};

const in::seabed::any recipes[] = {in::seabed::ripples{.wavelength = 0.6f, .steepness = 0.1f}, in::seabed::rock{}};

}  // namespace

TEST_CASE("decide_triangles() calls a triangle lit or dark only if all of its points are") {
    in::serial_executor serial;
    std::size_t known = 0, all = 0;
    double azimuth = 20;
    for (const in::seabed::any& recipe : recipes)
        for (const double elevation : {6.0, 25.0})
            for (int turn = 0; turn < 4; ++turn) {
                azimuth += 88;
                const shadow::directional_light light = parallel(azimuth, elevation);
                const swept_seabed bottom(recipe, 33, light);
                const in::bounding_box within{{-1.5, -1.5, -1}, {1.5, 1.5, 1}};
                const auto built = shadow::exact{}.build(std::span(&bottom.caster(), 1), light, {within}, serial);
                const auto answers = built.decide_triangles(0, {0.3, -0.2, 5}, serial);
                REQUIRE(answers.size() == bottom.surface->triangles.size());
                CAPTURE(recipe.legend().front().name, elevation, azimuth);
                int wrong = 0;
                for (std::uint32_t i = 0; i < answers.size(); ++i) {
                    ++all;
                    if (answers[i] == shadow::decision::undecided) continue;
                    ++known;
                    const glm::dvec3 a = bottom.surface.corner(i, 0), b = bottom.surface.corner(i, 1),
                                     c = bottom.surface.corner(i, 2), centre = (a + b + c) / 3.0;
                    const bool faces = glm::dot(bottom.surface.normal(i), bottom.surface.toward(centre)) > 0;
                    for (const glm::dvec3& corner : {a, b, c}) {
                        const glm::dvec3 p = corner + 1e-3 * (centre - corner);
                        const bool is_dark = !faces || bottom.surface.is_blocked(p, i);
                        wrong += is_dark != (answers[i] == shadow::decision::dark) ? 1 : 0;
                    }
                }
                CHECK(wrong == 0);
            }
    CHECK(known > all / 2);
}

TEST_CASE("decide_triangles() leaves triangles undecided that another caster may shade") {
    in::serial_executor serial;
    std::size_t lit = 0, shaded = 0;
    double azimuth = 35;
    for (const double elevation : {6.0, 25.0, 60.0})
        for (int turn = 0; turn < 4; ++turn) {
            azimuth += 88;
            const shadow::directional_light light = parallel(azimuth, elevation);
            const swept_seabed bottom(recipes[0], 129, light);
            const in::affine place{glm::dmat3(1), {0.2, -0.1, 0.4}};
            const lit::mesh box(in::to_mesh(in::cube{.size = glm::vec3(0.3f)}), light, place);
            const shadow::caster casters[] = {lit::caster_of(*box, place), bottom.caster()};
            const auto built = shadow::exact{}.build(casters, light, {{{-1.5, -1.5, -1}, {1.5, 1.5, 1}}}, serial);
            const auto answers = built.decide_triangles(1, {0.3, -0.2, 5}, serial);
            CAPTURE(elevation, azimuth);
            int wrong = 0;
            for (std::uint32_t i = 0; i < answers.size(); ++i) {
                const glm::dvec3 a = bottom.surface.corner(i, 0), b = bottom.surface.corner(i, 1),
                                 c = bottom.surface.corner(i, 2), centre = (a + b + c) / 3.0;
                const bool is_shaded =
                    box.is_blocked(a) || box.is_blocked(b) || box.is_blocked(c) || box.is_blocked(centre);
                if (is_shaded) ++shaded;
                if (answers[i] == shadow::decision::undecided) continue;
                wrong += is_shaded ? 1 : 0;
                if (answers[i] == shadow::decision::lit) ++lit;
            }
            CHECK(wrong == 0);
        }
    CHECK(shaded > 500);
    CHECK(lit > 10 * shaded);  // few others are left to their points
}

TEST_CASE("Few points of a seabed need a triangle test, and all agree with rays") {
    in::serial_executor serial;
    double azimuth = 50;
    for (const in::seabed::any& recipe : recipes)
        for (const double elevation : {2.0, 12.0}) {
            azimuth += 77;
            const shadow::directional_light light = parallel(azimuth, elevation);
            const swept_seabed bottom(recipe, 65, light);
            const shadow::detail::grid_caster caster(bottom.caster(), shadow::light_frame(light), in::best_isa(),
                                                     serial);
            const lit::point_list own = bottom.surface.facing(400, 3);
            CAPTURE(recipe.legend().front().name, elevation, azimuth);
            int wrong = 0;
            std::size_t tested = 0;
            for (std::size_t i = 0; i < own.size(); ++i) {
                const auto decide_among = [&](const glm::dvec3& p, std::uint32_t own_triangle) {
                    return [&, p, own_triangle](std::uint32_t triangle) {
                        ++tested;
                        const glm::dvec3 away = bottom.surface.corner(triangle, 0) - p;
                        const shadow::detail::light_rays rays(light, 2);
                        return triangle != own_triangle && glm::dot(away, away) < 100 &&
                               rays.blocks(bottom.surface.corner(triangle, 0), bottom.surface.corner(triangle, 1),
                                           bottom.surface.corner(triangle, 2), p);
                    };
                };
                wrong += caster.blocks(own[i], true, decide_among(own[i], own.triangle(i))) !=
                                 bottom.surface.is_blocked(own[i], own.triangle(i))
                             ? 1
                             : 0;
                const glm::dvec3 above = own[i] + glm::dvec3(0, 0, 0.01 + 0.0002 * static_cast<double>(i));
                wrong += caster.blocks(above, false, decide_among(above, shadow::invalid_id)) !=
                                 bottom.surface.is_blocked(above)
                             ? 1
                             : 0;
            }
            CHECK(wrong == 0);
            INFO(tested);
            CHECK(tested < own.size() * 3 / 4);  // of twice as many points
        }
}

TEST_CASE("Points close to the edges of cells agree with rays where vertices lie a little beside the lattice") {
    in::serial_executor serial;
    const shadow::exact exact;
    std::size_t tested = 0;
    for (std::uint32_t number = 0; number < 6000; ++number) {
        in::random_sequence random(11, 1, number);
        const auto between = [&](double low, double high) { return random.uniform(low, high); };
        const int columns = 2 + static_cast<int>(random.below(5)), rows = 2 + static_cast<int>(random.below(5));
        const double beside = 0x1p-14, relief = random.below(2) == 0 ? 0.3 : 30.0;
        in::mesh ground;
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < columns; ++i)
                ground.positions.emplace_back(i + between(-beside, beside), j + between(-beside, beside),
                                              random.below(3) == 0 ? between(0, relief) : 0);
        for (int j = 0; j + 1 < rows; ++j)
            for (int i = 0; i + 1 < columns; ++i) {
                const auto a = static_cast<std::uint32_t>(j * columns + i);
                const std::uint32_t b = a + 1, c = b + static_cast<std::uint32_t>(columns), d = c - 1;
                ground.triangles.push_back({a, b, c});
                ground.triangles.push_back({a, c, d});
            }
        const auto grid = in::regular_grid_of(ground, in::shared_mesh::grid_error);
        if (!grid) continue;
        // Along an axis or a diagonal, so that rays follow the edges of cells.
        const auto light = parallel(45.0 * random.below(8) + between(-1e-3, 1e-3), between(3, 80));
        const lit::mesh surface(ground, light);
        lit::point_list points;
        for (int i = 0; i < 40; ++i) {
            const auto triangle = random.below(static_cast<std::uint32_t>(ground.triangles.size()));
            const double sine =
                glm::dot(surface.normal(triangle), surface.toward({})) / glm::length(surface.normal(triangle));
            if (!(sine > 1e-4)) continue;
            // Within a few millionths of a step of a corner or an edge.
            const double tiny = std::exp2(between(-19, -13)), v = i % 2 == 0 ? tiny : between(tiny, 1 - 2 * tiny);
            const int corner = static_cast<int>(random.below(3));
            const glm::dvec3 a = surface.corner(triangle, corner), b = surface.corner(triangle, (corner + 1) % 3),
                             c = surface.corner(triangle, (corner + 2) % 3);
            points.add(a + tiny * (b - a) + v * (c - a), 0, triangle);
            points.add(a + tiny * (b - a) + v * (c - a) + glm::dvec3(0, 0, 1e-3));
        }
        if (points.size() == 0) continue;
        shadow::caster caster = lit::caster_of(ground);
        caster.may_skip = shadow::skip::facing_self;
        caster.grid = &*grid;
        const auto built = exact.build(std::span(&caster, 1), light, {points.box()}, serial);
        CAPTURE(number);
        CHECK(surface.wrong(points, lit::test(built, points).dark()) == 0);
        tested += points.size();
    }
    CHECK(tested > 100000);
}
