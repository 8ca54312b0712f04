// The shadow oracle against closed forms and brute-force rays, and pictures of imported meshes against the oracle.
#include "../../shadow_oracle.hpp"

#include <insonify/core/thread_pool.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "../../catch.hpp"
#include "../../foreign_scenes.hpp"

namespace in = insonify;
namespace foreign = foreign_scenes;
namespace shapes = shadow_meshes;
using shadow_oracle::oracle, shadow_oracle::verdict;

namespace {

using exact_options = in::render_options<in::shadow::exact>;

/// A scene's picture, and the oracle's verdicts on its pixels.
struct case_at {
    in::overhead rig;
    in::visibility shown;
    in::image<shadow_oracle::judged_pixel> truth;

    case_at(const in::scene& s, const in::overhead& from)
        : rig(from), shown(in::visible_triangles(s, rig, exact_options{})), truth(oracle(s, rig).judge(rig, shown)) {}

    std::size_t pixels() const { return truth.size(); }
    verdict answer(std::size_t i) const { return truth.pixels()[i].answer; }
    long count(verdict v) const {
        return std::count_if(truth.pixels().begin(), truth.pixels().end(), [&](auto& p) { return p.answer == v; });
    }
    glm::dvec3 to_light() const {
        const auto azimuth = static_cast<double>(rig.light_azimuth), elevation = static_cast<double>(rig.grazing);
        return {-std::cos(azimuth) * std::cos(elevation), -std::sin(azimuth) * std::cos(elevation),
                std::sin(elevation)};
    }
    /// Where the ray through a pixel's centre comes to a height.
    glm::dvec3 point(std::size_t i, double height) const {
        const auto width = static_cast<std::size_t>(rig.size.x);
        const double half = std::tan(0.5 * static_cast<double>(rig.field_of_view)), pixels = rig.size.x;
        const double x = 2 * (static_cast<double>(i % width) + 0.5) / pixels - 1;
        const double y = 1 - 2 * (static_cast<double>(i / width) + 0.5) / pixels;
        const double down = static_cast<double>(rig.altitude) - height;
        return {x * half * down, y * half * down, height};
    }
};

/// Compares the oracle with a closed form on the pixels that show the first target, level ground at the datum.
/// @param closed_form  of a point: whether it is dark, or undecided next to an edge
template <class ClosedForm>
void check_ground(const case_at& c, const ClosedForm& closed_form) {
    long dark = 0, lit = 0, wrong = 0;
    for (std::size_t i = 0; i < c.pixels(); ++i) {
        if (c.shown.instance.pixels()[i] != 1) continue;
        const verdict expected = closed_form(c.point(i, 0));
        if (expected == verdict::undecided) continue;
        wrong += c.answer(i) != expected;
        ++(expected == verdict::dark ? dark : lit);
    }
    CHECK(wrong == 0);
    CHECK(dark > 30);
    CHECK(lit > 1000);
}

verdict dark_if(bool dark) {
    return dark ? verdict::dark : verdict::lit;
}

/// Distance along a ray to a triangle, in lengths of its direction; infinite for none.
double distance(const shadow_oracle::triangle& t, const glm::dvec3& from, const glm::dvec3& along) {
    const glm::dvec3 ab = t.b - t.a, ac = t.c - t.a, p = glm::cross(along, ac), s = from - t.a, q = glm::cross(s, ab);
    const double determinant = glm::dot(ab, p);
    const double u = glm::dot(s, p) / determinant, v = glm::dot(along, q) / determinant;
    return determinant != 0 && u >= 0 && v >= 0 && u + v <= 1 ? glm::dot(ac, q) / determinant
                                                              : std::numeric_limits<double>::infinity();
}

in::mesh box(const glm::dvec3& half) {
    in::mesh m;
    for (unsigned i = 0; i < 8; ++i)
        m.positions.emplace_back((i & 1 ? 1 : -1) * half.x, (i & 2 ? 1 : -1) * half.y, (i & 4 ? 2 : 0) * half.z);
    m.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return m;
}

}  // namespace

TEST_CASE("Oracle: a box darkens the ground where the light's ray enters it, and its own sides that face away") {
    const glm::dvec3 half(0.4, 0.25, 0.3), centre(0.0123, 0.0457, 0);
    for (const double elevation : {5.0, 33.0, 60.0})
        for (const double azimuth : {23.7, 160.0, 251.3}) {
            CAPTURE(elevation, azimuth);
            const in::scene s = foreign::on_ground(box(half), {.position = centre});
            const case_at c(s, foreign::rig(azimuth, elevation, 96));
            const glm::dvec3 to_light = c.to_light();
            check_ground(c, [&](const glm::dvec3& p) {
                double first = 0, last = std::numeric_limits<double>::infinity();
                for (int k = 0; k < 3; ++k) {
                    const double low = centre[k] + (k == 2 ? 0 : -half[k]),
                                 high = centre[k] + (k == 2 ? 2 : 1) * half[k];
                    const double a = (low - p[k]) / to_light[k], b = (high - p[k]) / to_light[k];
                    first = std::max(first, std::min(a, b));
                    last = std::min(last, std::max(a, b));
                }
                // Half sizes are rounded to float: points that close to an edge are not judged.
                return std::abs(last - first) < 1e-6 ? verdict::undecided : dark_if(first < last);
            });
            const glm::dvec3 normals[] = {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}};
            long wrong = 0, seen = 0;
            for (std::size_t i = 0; i < c.pixels(); ++i) {
                if (c.shown.instance.pixels()[i] != 2 || c.truth.pixels()[i].beside) continue;
                ++seen;
                wrong += c.answer(i) != dark_if(glm::dot(normals[c.shown.triangle.pixels()[i] / 2], to_light) < 0);
            }
            CHECK(wrong == 0);
            CHECK(seen > 100);
        }
}

TEST_CASE("Oracle: a ball's shadow is an ellipse, of parallel light and of a point light") {
    const double radius = 0.5;
    const in::mesh ball = shapes::blob(192, 97, [&](const glm::dvec3&) { return radius; });
    const glm::dvec3 centre(0.0123, 0.0457, 0.7);
    const in::scene s = foreign::on_ground(ball, {.position = centre});
    for (const float away : {std::numeric_limits<float>::infinity(), 3.0f, 1.4f})
        for (const double elevation : {20.0, 45.0, 70.0}) {
            CAPTURE(away, elevation);
            in::overhead rig = foreign::rig(160, elevation, 96);
            rig.light_distance = away;
            const case_at c(s, rig);
            check_ground(c, [&](const glm::dvec3& p) {
                const glm::dvec3 toward =
                    std::isfinite(away) ? static_cast<double>(away) * c.to_light() - p : c.to_light();
                const double nearest = glm::dot(centre - p, toward) / glm::dot(toward, toward);
                const glm::dvec3 across =
                    p + (std::isfinite(away) ? std::min(nearest, 1.0) : nearest) * toward - centre;
                const double off = std::sqrt(glm::dot(across, across));
                const double held = std::cos(std::acos(-1.0) / 96) * std::cos(std::acos(-1.0) / 192);  // of the facets
                return off < radius * held ? verdict::dark : off > radius ? verdict::lit : verdict::undecided;
            });
        }
}

TEST_CASE("Oracle: under a point light, the shadow of a square is a larger square") {
    const double height = 0.5, half = 0.25, light = 0.8;
    const in::mesh square = shapes::sheet(
        1, 1, [&](double u, double v) { return glm::dvec3(half * (2 * u - 1), half * (2 * v - 1), height); });
    in::overhead rig = foreign::rig(0, 90, 96);
    rig.light_distance = static_cast<float>(light);
    rig.field_of_view = 1.4f;
    const in::scene s = foreign::on_ground(square, {});
    const case_at c(s, rig);
    const double shadow = half * light / (light - height);
    check_ground(c, [&](const glm::dvec3& p) { return dark_if(std::max(std::abs(p.x), std::abs(p.y)) < shadow); });
    // The square's own upper side is lit.
    for (std::size_t i = 0; i < c.pixels(); ++i)
        if (c.shown.instance.pixels()[i] == 2) REQUIRE(c.answer(i) == verdict::lit);
}

TEST_CASE(
    "Oracle: open sheets are dark on the side that faces away, and lit on the other, whichever way they are wound") {
    // Tilted by 30 degrees, low side to the left, towards light of azimuth 0: at 45 degrees light from either side
    // falls on it, at 20 degrees from there only.
    for (const bool turned : {false, true}) {
        const in::mesh quad = shapes::tilted_quad();
        const in::scene s = foreign::bare(turned ? shapes::turned_around(quad) : quad, {});
        for (const double azimuth : {0.0, 77.0, 180.0}) {
            const case_at above(s, foreign::rig(azimuth, 45, 64));
            CHECK(above.count(verdict::dark) == 0);
            CHECK(above.count(verdict::lit) > 200);
        }
        const case_at front(s, foreign::rig(0, 20, 64)), back(s, foreign::rig(180, 20, 64));
        CHECK((front.count(verdict::dark) == 0 && front.count(verdict::lit) > 200));
        CHECK((back.count(verdict::lit) == 0 && back.count(verdict::dark) > 200));
    }
}

TEST_CASE("Oracle: its tree gives the results of testing every triangle") {
    for (const auto& s : {foreign::on_ground(shapes::crossed_tori()), foreign::bare(shapes::soup(shapes::relief(24)))})
        for (const double elevation : {1.0, 6.0}) {
            const case_at c(s, foreign::rig(251.3, elevation, 32));
            std::vector<shadow_oracle::triangle> all;
            std::vector<std::size_t> first{0};
            for (const in::target& t : s.targets) {
                first.push_back(all.size());
                const auto at = [&](std::uint32_t i) {
                    return in::transform_point(in::to_world(t.placement), t.shape->positions[i]);
                };
                for (const glm::uvec3& i : t.shape->triangles) all.push_back({at(i.x), at(i.y), at(i.z)});
            }
            long wrong = 0, dark = 0;
            for (std::size_t i = 0; i < c.pixels(); ++i) {
                if (c.answer(i) == verdict::empty || c.answer(i) == verdict::undecided || c.truth.pixels()[i].beside)
                    continue;
                const std::size_t own = first[c.shown.instance.pixels()[i]] + c.shown.triangle.pixels()[i];
                const glm::dvec3 eye(0, 0, c.rig.altitude), ray = c.point(i, 0) - eye;
                const glm::dvec3 p = eye + distance(all[own], eye, ray) * ray;
                const glm::dvec3 n = glm::cross(all[own].b - all[own].a, all[own].c - all[own].a);
                bool expected = glm::dot(n, c.to_light()) * glm::dot(n, ray) > 0;
                for (std::size_t k = 0; k < all.size() && !expected; ++k) {
                    const double hit = k == own ? -1 : distance(all[k], p, c.to_light());
                    expected = hit > 1e-9 && std::isfinite(hit);
                }
                wrong += (c.answer(i) == verdict::dark) != expected;
                dark += expected;
            }
            CHECK(wrong == 0);
            CHECK(dark > 30);
        }
}

TEST_CASE("Oracle: one triangle more or less changes the answer exactly where its shadow falls") {
    const in::mesh sheet = shapes::sheet(4, 4, [](double u, double v) { return glm::dvec3(u - 0.5, v - 0.5, 0.6); });
    const in::scene whole = foreign::on_ground(sheet, {.yaw = 0.3f});
    const case_at before(whole, foreign::rig(23.7, 33, 96));
    for (const std::size_t gone : {std::size_t{5}, std::size_t{18}, std::size_t{31}}) {
        in::scene s = whole;
        in::mesh m = *s.targets[1].shape;
        const auto at = [&](std::uint32_t i) {
            return in::transform_point(in::to_world(s.targets[1].placement), m.positions[i]);
        };
        const glm::uvec3 i = m.triangles[gone];
        const shadow_oracle::triangle removed{at(i.x), at(i.y), at(i.z)};
        m.triangles.erase(m.triangles.begin() + static_cast<std::ptrdiff_t>(gone));
        s.targets[1].shape = m;
        const case_at after(s, before.rig);
        long changed = 0, wrong = 0;
        for (std::size_t k = 0; k < before.pixels(); ++k) {
            if (before.shown.instance.pixels()[k] != 1 || after.shown.instance.pixels()[k] != 1) continue;
            const bool covered = std::isfinite(distance(removed, before.point(k, 0), before.to_light()));
            const bool differs = before.answer(k) != after.answer(k);
            changed += differs;
            wrong += covered != differs || (differs && after.answer(k) != verdict::lit);
        }
        CHECK(wrong == 0);
        CHECK(changed > 5);
    }
}

TEST_CASE("Oracle: coplanar duplicates, triangles without area and NaN ones change nothing") {
    const in::mesh figure = shapes::statue(32, 24);
    const in::pose raised{.position = {0.01, 0.02, 0.7}};
    const case_at plain(foreign::on_ground(figure, raised), foreign::rig(23.7, 33, 64));
    in::mesh broken = figure;
    broken.positions.push_back(glm::vec3(std::numeric_limits<float>::quiet_NaN()));
    broken.triangles.emplace_back(0, 1, static_cast<std::uint32_t>(figure.positions.size()));
    for (const in::mesh& m : {shapes::with_duplicates(figure), shapes::with_degenerates(figure), broken}) {
        const case_at other(foreign::on_ground(m, raised), plain.rig);
        long different = 0;
        for (std::size_t i = 0; i < plain.pixels(); ++i) different += plain.answer(i) != other.answer(i);
        CHECK(different == 0);
        CHECK(other.count(verdict::undecided) == 0);
    }
}

TEST_CASE("Oracle: a centre beside the triangle shown stands for the nearest point of its outline") {
    const in::mesh m{{{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {-0.5f, 0.5f, 0}}, {}, {{0, 1, 2}}};
    const in::mesh wall{{{0.05f, -2, 0}, {0.05f, 2, 0}, {0.05f, 0, 1}}, {}, {{0, 1, 2}}};
    in::scene s = foreign::bare(m, {});
    s.add(wall, {}, "wall");
    const in::overhead rig = foreign::rig(180, 45, 64);  // from the right
    in::visibility shown{in::image<std::uint16_t>(64, 64, 1), in::image<std::uint32_t>(64, 64, 0)};
    const auto truth = oracle(s, rig).judge(rig, shown);
    const case_at geometry(s, rig);
    long wrong = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const glm::dvec3 p = geometry.point(i, 0);
        const bool inside = p.x >= -0.5 && p.y >= -0.5 && p.x + p.y <= 0;
        // The outline's nearest point: on the slanted side, or an end of one of the others.
        glm::dvec2 nearest(p);
        if (!inside) {
            double best = 1e9;
            const glm::dvec2 corners[] = {{-0.5, -0.5}, {0.5, -0.5}, {-0.5, 0.5}, {-0.5, -0.5}};
            for (int k = 0; k < 3; ++k) {
                const glm::dvec2 along = corners[k + 1] - corners[k], from = glm::dvec2(p) - corners[k];
                const double t = std::clamp(glm::dot(from, along) / glm::dot(along, along), 0.0, 1.0);
                const glm::dvec2 q = corners[k] + t * along;
                if (glm::dot(q - glm::dvec2(p), q - glm::dvec2(p)) < best) {
                    best = glm::dot(q - glm::dvec2(p), q - glm::dvec2(p));
                    nearest = q;
                }
            }
        }
        const double away = static_cast<double>(0.05f) - nearest.x;  // to the wall, which is as high above there
        const bool dark = away > 0 && away < 1 - std::abs(nearest.y) / 2;
        wrong += truth.pixels()[i].beside == inside || (truth.pixels()[i].answer == verdict::dark) != dark;
    }
    CHECK(wrong == 0);
}

TEST_CASE("Oracle: a picture's wrong pixels are counted, by kind") {
    const in::scene s = foreign::on_ground(shapes::crossed_tori());
    const case_at c(s, foreign::rig(23.7, 33, 64));
    const auto frame = in::render(s, c.rig, exact_options{});
    REQUIRE(shadow_oracle::compare(c.truth, frame.labels).wrong() == 0);
    in::labels altered = frame.labels;
    long flipped[2] = {0, 0};
    for (std::size_t i = 0; i < c.pixels(); i += 97) {
        if (c.truth.pixels()[i].beside) continue;
        std::uint16_t& shadow = altered.shadow.pixels()[i];
        ++flipped[shadow == in::labels::no_shadow];
        shadow = shadow == in::labels::no_shadow ? 1 : in::labels::no_shadow;
    }
    const auto t = shadow_oracle::compare(c.truth, altered);
    CHECK(t.false_dark == flipped[1]);
    CHECK(t.false_lit == flipped[0]);
    CHECK(t.shown == 64 * 64);
    CHECK_THROWS_AS(oracle(in::scene{}, c.rig), in::invalid_input);
}
