// Exact shadows in whole pictures against an independent oracle: for every pixel the nearest triangle along its ray,
// then every triangle that its ray to the light could meet, in double precision.
#include <insonify/core/thread_pool.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "../../catch.hpp"
#include "../../shadow_meshes.hpp"
#include "../../shadow_scenes.hpp"

namespace in = insonify;
namespace scenes = shadow_scenes;

namespace {

using namespace in::literals;
using exact_options = in::render_options<in::shadow::exact>;

/// Visibility is tested elsewhere: with vertices rounded to 1/65536 pixel, each pixel shows the oracle's triangle.
exact_options finely_drawn() {
    exact_options options;
    options.subpixel_bits = 16;
    return options;
}

constexpr double no_hit = std::numeric_limits<double>::infinity();

/// Distance along a ray to a triangle, in lengths of its direction.
double distance(const scenes::triangle& t, const glm::dvec3& from, const glm::dvec3& along) {
    const glm::dvec3 ab = t.b - t.a, ac = t.c - t.a, p = glm::cross(along, ac), s = from - t.a, q = glm::cross(s, ab);
    const double determinant = glm::dot(ab, p);
    if (determinant == 0) return no_hit;
    const double u = glm::dot(s, p) / determinant, v = glm::dot(along, q) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 ? glm::dot(ac, q) / determinant : no_hit;
}

class ray_oracle {
  public:
    /// @param altitude  of a camera over the origin, or over `offset`, that sees 90 degrees
    ray_oracle(const in::scene& s, int pixels, double altitude = 4, const glm::dvec3& offset = {0, 0, 0})
        : triangles_(scenes::triangles(s)), pixels_(pixels), altitude_(altitude) {
        for (scenes::triangle& t : triangles_) {
            t.a -= offset;
            t.b -= offset;
            t.c -= offset;
        }
        depth_.assign(static_cast<std::size_t>(pixels * pixels), no_hit);
        shown_.assign(depth_.size(), -1);
        for (std::size_t i = 0; i < triangles_.size(); ++i) {
            const scenes::triangle& t = triangles_[i];
            double low[2] = {no_hit, no_hit}, high[2] = {-no_hit, -no_hit};
            for (const glm::dvec3& p : {t.a, t.b, t.c})
                for (int axis = 0; axis < 2; ++axis) {
                    const double at = (axis == 0 ? p.x : -p.y) / (altitude - p.z) * 0.5 * pixels + 0.5 * pixels;
                    low[axis] = std::min(low[axis], at);
                    high[axis] = std::max(high[axis], at);
                }
            const auto held = [&](double v) { return std::clamp(static_cast<int>(std::floor(v)), 0, pixels - 1); };
            for (int y = held(low[1] - 1); y <= held(high[1] + 1); ++y)
                for (int x = held(low[0] - 1); x <= held(high[0] + 1); ++x) {
                    const double d = distance(t, {0, 0, altitude_}, ray(x, y));
                    const auto at = static_cast<std::size_t>(y * pixels + x);
                    if (d > 0 && d < depth_[at]) {
                        depth_[at] = d;
                        shown_[at] = static_cast<long>(i);
                    }
                }
        }
    }

    /// Compares a picture's mask with rays towards a light, parallel from `light` or, for a point light, starting
    /// there.
    scenes::difference compare(const in::labels& labels, const glm::dvec3& light, bool is_point_light = false) const {
        // Slabs along the light, so that each pixel tests few triangles. They overlap by their width.
        const glm::dvec3 side = std::abs(light.x) + std::abs(light.y) > 0
                                    ? glm::normalize(glm::dvec3(-light.y, light.x, 0))
                                    : glm::dvec3(1, 0, 0);
        const double slab = altitude_ / 64;
        constexpr int slabs = 256;
        const auto slab_of = [&](const glm::dvec3& p) {
            return std::clamp(static_cast<int>(std::floor(glm::dot(p, side) / slab)) + slabs / 2, 0, slabs - 1);
        };
        std::vector<std::vector<std::size_t>> within(slabs);
        for (std::size_t i = 0; i < triangles_.size(); ++i) {
            const scenes::triangle& t = triangles_[i];
            const int s[] = {slab_of(t.a), slab_of(t.b), slab_of(t.c)};
            const int first = std::max(*std::min_element(s, s + 3) - 1, 0);
            const int last = std::min(*std::max_element(s, s + 3) + 1, slabs - 1);
            for (int k = first; k <= last; ++k) within[static_cast<std::size_t>(k)].push_back(i);
        }
        std::vector<std::size_t> all(triangles_.size());
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;

        scenes::difference d;
        for (int y = 0; y < pixels_; ++y)
            for (int x = 0; x < pixels_; ++x) {
                const auto at = static_cast<std::size_t>(y * pixels_ + x);
                if (shown_[at] < 0) continue;
                const auto own = static_cast<std::size_t>(shown_[at]);
                const scenes::triangle& t = triangles_[own];
                const glm::dvec3 p = glm::dvec3(0, 0, altitude_) + depth_[at] * ray(x, y);
                const glm::dvec3 along = is_point_light ? light - p : light;
                const glm::dvec3 n = glm::cross(t.b - t.a, t.c - t.a);
                bool lit = glm::dot(n, along) * -glm::dot(n, ray(x, y)) > 0;
                const auto& candidates = is_point_light ? all : within[static_cast<std::size_t>(slab_of(p))];
                for (std::size_t i = 0; lit && i < candidates.size(); ++i) {
                    if (candidates[i] == own) continue;
                    const double hit = distance(triangles_[candidates[i]], p, along);
                    lit = !(hit > (is_point_light ? 1e-12 : 1e-9 * altitude_) &&
                            hit < (is_point_light ? 1 - 1e-9 : no_hit));
                }
                d.add(labels.shadow(x, y) == in::labels::no_shadow, lit);
            }
        return d;
    }

  private:
    glm::dvec3 ray(int x, int y) const { return {2 * (x + 0.5) / pixels_ - 1, 1 - 2 * (y + 0.5) / pixels_, -1}; }

    std::vector<scenes::triangle> triangles_;
    int pixels_;
    double altitude_;
    std::vector<double> depth_;
    std::vector<long> shown_;
};

/// All seabeds and directions; with `print`, prints the result for each seabed and elevation.
scenes::difference compare_all(double spacing, int pixels, bool print) {
    scenes::difference total;
    for (int kind = 0; kind < 3; ++kind) {
        const in::scene s = scenes::make(kind, spacing);
        const ray_oracle truth(s, pixels);
        scenes::difference all;
        for (const double elevation : scenes::elevations) {
            scenes::difference here;
            for (const double azimuth : scenes::azimuths) {
                const in::overhead rig = scenes::rig(azimuth, elevation, pixels);
                const auto frame = in::render(s, rig, finely_drawn());
                here += truth.compare(frame.labels, in::overhead_geometry(rig).light().to_light());
            }
            if (print)
                WARN(scenes::seabed_names[kind] << " at " << elevation << " degrees: " << here.wrong << " of "
                                                << here.pixels << " wrong, IoU " << here.iou());
            all += here;
        }
        INFO(scenes::seabed_names[kind]);
        CHECK(all.iou() >= 0.9999);
        total += all;
    }
    return total;
}

}  // namespace

TEST_CASE("Exact shadows equal those of rays: three seabeds, four targets, an imported mesh, an open sheet") {
    const scenes::difference d = compare_all(0.25, 50, false);
    CHECK(d.pixels > 400000);
    CHECK(d.share() <= 1e-5);
}

TEST_CASE("Exact shadows equal those of rays in finer pictures of finer seabeds", "[.slow]") {
    const scenes::difference d = compare_all(0.06, 400, true);
    WARN(d.wrong << " of " << d.pixels << " wrong");
    CHECK(d.share() <= 1e-5);
}

namespace {

/// The scene, scaled and translated.
in::scene moved(in::scene s, double scale, const glm::dvec3& offset) {
    for (in::target& t : s.targets) {
        t.placement.position = scale * t.placement.position + offset;
        t.placement.scale *= static_cast<float>(scale);
        t.placement.burial *= static_cast<float>(scale);
    }
    return s;
}

/// A mesh of level ground around the origin, a little off so that no edge goes through a pixel's centre.
void add_ground(in::scene& s, float half) {
    const in::mesh ground{
        {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}}, {}, {{0, 1, 2}, {0, 2, 3}}};
    s.seabed = in::seabed::none{};
    s.add(ground, {.position = {0.0123, 0.0457, 0}}, "ground", {.reflectivity = 1});
}

bool all_in_range(const in::image<float>& image) {
    return std::all_of(image.pixels().begin(), image.pixels().end(), [](float v) { return v >= 0 && v <= 1; });
}

}  // namespace

TEST_CASE("Extreme rigs and scenes have correct shadows, pixel by pixel") {
    struct extreme {
        const char* name;
        double scale, away, elevation, azimuth;
    };
    const extreme extremes[] = {{"light at 0.01 degrees", 1, 0, 0.01, 23.7},
                                {"light at 0.01 degrees, along the grid", 1, 0, 0.01, 0},
                                {"light at 89.99 degrees", 1, 0, 89.99, 23.7},
                                {"altitude 1 mm, targets of 0.2 mm", 1.0 / 4000, 0, 6, 160},
                                {"altitude 10 km, targets of 2 km", 2500, 0, 6, 160},
                                {"10^7 m from the world's origin", 1, 1e7, 6, 160}};
    constexpr int pixels = 90;
    for (const extreme& e : extremes)
        for (int kind = 0; kind < 3; ++kind) {
            const glm::dvec3 offset(e.away, -0.75 * e.away, 0);
            const in::scene s = moved(scenes::make(kind, 0.2), e.scale, offset);
            in::overhead rig = scenes::rig(e.azimuth, e.elevation, pixels);
            rig.altitude *= static_cast<float>(e.scale);
            rig.position = glm::dvec2(offset);
            const auto frame = in::render(s, rig, finely_drawn());
            const ray_oracle truth(s, pixels, static_cast<double>(rig.altitude), offset);
            const scenes::difference d = truth.compare(frame.labels, in::overhead_geometry(rig).light().to_light());
            INFO(e.name << " over " << scenes::seabed_names[kind] << ": " << d.wrong << " of " << d.pixels);
            CHECK(all_in_range(frame.image));
            CHECK(d.wrong <= 1);
        }
}

TEST_CASE("Light along the faces and edges of a cube and down a slope gives the oracle's shadows") {
    for (const double azimuth : {0.0, 45.0, 90.0, 180.0, 270.0})
        for (const double elevation : {6.0, 45.0}) {
            in::scene s;
            add_ground(s, 5);
            s.add(in::cube{}, {.position = {0.3, 0.2, 0.5}}, "cube");
            s.add(in::cube{}, {.position = {-1.5, -1.1, 0}, .pitch = static_cast<float>(in::numeric::pi / 4)}, "roof");
            const in::overhead rig = scenes::rig(azimuth, elevation, 150);
            const auto frame = in::render(s, rig, finely_drawn());
            const auto d = ray_oracle(s, 150).compare(frame.labels, in::overhead_geometry(rig).light().to_light());
            CAPTURE(azimuth, elevation, d.wrong, d.pixels);
            // Faces parallel to the light up to rounding are dark in the picture; in the oracle rounding decides.
            long grazed = 0;
            for (std::size_t i = 0; i < frame.image.size(); ++i)
                grazed += frame.labels.instance.pixels()[i] >= 2 &&
                          frame.labels.shadow.pixels()[i] == frame.labels.instance.pixels()[i];
            CHECK(d.wrong <= grazed);
            CHECK(all_in_range(frame.image));
        }
}

TEST_CASE("A relief on a lattice has the same pictures when one of its cells is cut the other way") {
    // On a lattice it is swept; with another cut, here at a corner out of view, it is a list of triangles.
    constexpr unsigned cells = 150;
    const in::mesh lattice = shadow_meshes::relief(cells);
    in::mesh list = lattice;
    list.triangles[0] = {0, 1, cells + 1};
    list.triangles[1] = {1, cells + 2, cells + 1};
    REQUIRE(in::shared_mesh(lattice).grid() != nullptr);
    REQUIRE(in::shared_mesh(list).grid() == nullptr);
    const auto drawn = [](const in::mesh& relief, const in::overhead& rig) {
        in::scene s;
        s.seabed = in::seabed::none{};
        s.add(relief, {}, "relief");
        s.add(in::sphere{.radius = 0.3f}, {.position = {0.4, -0.3, 1.0}}, "ball");
        return in::render(s, rig);
    };
    for (const float azimuth : {0.1f, 0.9f, 1.5708f, 2.6f, 4.0f})
        for (const float grazing : {0.05f, 0.2f, 0.7f}) {
            CAPTURE(azimuth, grazing);
            const in::overhead rig{
                .altitude = 4, .field_of_view = 1, .size = {300, 300}, .grazing = grazing, .light_azimuth = azimuth};
            const auto swept = drawn(lattice, rig), tested = drawn(list, rig);
            CHECK(swept.image == tested.image);
            CHECK(swept.labels.shadow == tested.labels.shadow);
        }
}

TEST_CASE("Point lights have correct shadows: above the seabed, on it, inside of a target") {
    constexpr int pixels = 40;
    for (int kind = 0; kind < 3; ++kind) {
        const in::scene s = scenes::make(kind, 0.3);
        const ray_oracle truth(s, pixels);
        struct lamp {
            double azimuth, elevation, distance;
        };
        // Over the middle; from the side; a hand above the bottom; under it, in the cylinder at (-1.5, 0.7).
        for (const lamp& l :
             {lamp{30, 89.9, 3}, {160, 20, 9}, {200, 5, 3}, {251, 1, 2}, {-25.016931, 8.6, 1.674}, {160, 6, 1e6}}) {
            in::overhead rig = scenes::rig(l.azimuth, l.elevation, pixels);
            rig.light_distance = static_cast<float>(l.distance);
            const auto frame = in::render(s, rig, finely_drawn());
            const auto d = truth.compare(frame.labels, in::overhead_geometry(rig).light_position(), true);
            CAPTURE(scenes::seabed_names[kind], l.azimuth, l.elevation, l.distance, d.wrong, d.pixels);
            CHECK(d.wrong == 0);
            CHECK(all_in_range(frame.image));
        }
    }
    in::overhead rig = scenes::rig(0, 6, 16);
    rig.light_distance = 3;
    CHECK_THROWS_AS(in::render(scenes::make(0, 1), rig, in::render_options<in::shadow::map>{}), in::invalid_input);
    rig.light_distance = -1;
    CHECK_THROWS_AS(in::render(scenes::make(0, 1), rig, exact_options{}), in::invalid_input);
}

TEST_CASE("The penumbra of a round light has the profile of a disc behind an edge") {
    constexpr int pixels = 200;
    const double height = 0.25, degrees = 20, diameter = 5;
    in::scene s;
    add_ground(s, 50);
    s.add(in::cube{.size = {0.1f, 60, 0.25f}}, {.position = {-1.55, 0, 0.125}}, "wall");
    in::overhead rig = scenes::rig(0, degrees, pixels);
    rig.intensity = 1;
    rig.sky = 0;
    in::render_options<in::shadow::penumbra> options;
    options.shadow = {.diameter = static_cast<float>(in::numeric::to_radians(diameter)), .samples = 400};
    const auto frame = in::render(s, rig, options);
    const double elevation = in::numeric::to_radians(degrees);
    const double radius = std::tan(in::numeric::to_radians(diameter / 2));
    int between = 0, expected = 0;
    for (int x = 0; x < pixels; ++x) {
        const double behind = 8 * (x + 0.5) / pixels - 4 + 1.5;  // the wall's far side is at -1.5
        if (behind < 0.02) continue;
        // Where the wall's top cuts the disc, as seen from here: 1 at its upper rim.
        const double cut = std::tan(std::atan(height / behind) - elevation) / radius;
        const double share = cut >= 1    ? 0
                             : cut <= -1 ? 1
                                         : (std::acos(cut) - cut * std::sqrt(1 - cut * cut)) / in::numeric::pi;
        const double seen = static_cast<double>(frame.image(x, pixels / 2)) / std::sin(elevation);
        CAPTURE(behind, cut);
        CHECK(seen == Approx(share).margin(0.01));
        if (cut > 1.0001) CHECK(seen == 0);
        if (cut < -1.0001) CHECK(seen == Approx(1));
        between += seen > 0 && seen < 0.9999;
        expected += share > 0 && share < 1;
        CHECK((frame.labels.shadow(x, pixels / 2) == in::labels::no_shadow) == (cut < 0));
    }
    CHECK(std::abs(between - expected) <= 1);
    CHECK(expected >= 4);
}

TEST_CASE("A penumbra of one sample is a hard shadow; a light half below the horizon gives half of the light") {
    const in::scene s = scenes::make(0, 0.2);
    const in::overhead rig = scenes::rig(160, 6, 64);
    const auto hard = in::render(s, rig, exact_options{});
    in::render_options<in::shadow::penumbra> options;
    options.shadow.samples = 1;
    const auto one = in::render(s, rig, options);
    CHECK(one.image == hard.image);
    CHECK(one.labels.shadow == hard.labels.shadow);

    in::scene level;
    add_ground(level, 50);
    in::overhead low = scenes::rig(30, 0.001, 16);
    low.intensity = 1000;
    low.sky = 0;
    options.shadow = {.diameter = 0.02f, .samples = 200};
    const auto half = in::render(level, low, options);
    const double full = 1000 * std::sin(static_cast<double>(low.grazing));
    CHECK(static_cast<double>(half.image(8, 8)) == Approx(full / 2).epsilon(0.05));
}

TEST_CASE("Exact pictures are the same at every instruction set, for any executor and tile") {
    const in::scene s = scenes::make(2, 0.1);
    in::thread_pool pool(3);
    for (const float distance : {std::numeric_limits<float>::infinity(), 6.0f}) {
        in::overhead rig = scenes::rig(160, 12, 150);
        rig.light_distance = distance;
        exact_options options;
        options.level = in::isa::scalar;
        const auto expected = in::render(s, rig, options);
        for (const in::isa level : {in::isa::baseline, in::isa::avx2})
            for (const int tile : {16, 64}) {
                options.level = level;
                options.tile = tile;
                const auto frame = in::render(s, rig, options, pool);
                CHECK(frame.image == expected.image);
                CHECK(frame.labels.shadow == expected.labels.shadow);
            }
        in::render_options<in::shadow::exact, in::no_labels> bare;
        CHECK(in::render(s, rig, bare).image == expected.image);
    }
}

namespace {

/// Rubble of 40 m x 40 m, of which the camera sees 8 m in the middle.
in::scene wide_rubble() {
    in::scene s;
    s.seabed = in::seabed::sample(in::seabed::rock{}, {{-20, -20}, 0.0625, 641, 641});
    return s;
}

}  // namespace

TEST_CASE("Seabed that cannot cast a shadow into the picture changes no pixel") {
    for (const double azimuth : {0.0, 45.0, 200.0}) {
        // Turned, so that no edge of the grid runs along pixels' centres.
        in::overhead rig = scenes::rig(azimuth, 4, 200);
        rig.yaw = 0.3f;
        in::scene s = wide_rubble();
        exact_options options{.cell = in::overhead_geometry(rig).half_extent(0).x / 64};
        const auto as_it_is = in::render(s, rig, options);
        // One high stone at the far end widens the range of heights, so that more seabed has to be sampled.
        in::seabed::heightfield field = *s.seabed.get_if<in::seabed::heightfield>();
        field.heights(azimuth == 200 ? 2 : 638, 320) = 3;
        s.seabed = field;
        const auto more = in::render(s, rig, options);
        CHECK(more.stats.seabed_columns * more.stats.seabed_rows >
              as_it_is.stats.seabed_columns * as_it_is.stats.seabed_rows * 3 / 2);
        long different = 0;
        for (std::size_t i = 0; i < more.image.size(); ++i)
            different += more.labels.shadow.pixels()[i] != as_it_is.labels.shadow.pixels()[i] ||
                         more.image.pixels()[i] != as_it_is.image.pixels()[i];
        CAPTURE(azimuth);
        CHECK(different == 0);
        // Seabed that can cast a shadow does: without it some pixels are lit.
        options.reach = 0;
        const auto less = in::render(s, rig, options);
        long lit = 0;
        for (std::size_t i = 0; i < less.image.size(); ++i)
            lit += less.labels.shadow.pixels()[i] != as_it_is.labels.shadow.pixels()[i];
        CHECK(lit > 20);
    }
}

TEST_CASE("Targets below a gap in the seabed have the shadows that they have without seabed") {
    // The gap is a trench along the light, whose rims shade nothing.
    in::seabed::heightfield rim{.heights = in::image<float>(121, 121, 0.0f), .origin = {-15, -15}, .spacing = 0.25};
    for (int j = 0; j < 121; ++j)
        if (std::abs(0.25 * j - 15) < 8)
            for (int i = 0; i < 121; ++i) rim.heights(i, j) = std::nanf("");
    for (const double depth : {3.0, 6.0})
        for (const float distance : {std::numeric_limits<float>::infinity(), 30.0f}) {
            in::overhead rig{.altitude = 4, .field_of_view = 1.2f, .size = {96, 96}, .grazing = 0.5f};
            rig.light_distance = distance;
            in::scene s;
            s.add(in::cube{.size = {30, 30, 0.1f}}, {.position = {0, 0, -depth - 0.05}}, "floor");
            s.add(in::cube{}, {.position = {0.3, 0.2, 0.5 - depth}}, "cube");
            s.seabed = in::seabed::none{};
            const auto bare = in::render(s, rig);
            s.seabed = rim;
            CAPTURE(depth, distance);
            CHECK(in::render(s, rig).labels.shadow == bare.labels.shadow);
            CHECK(bare.labels.targets[1].box.width() > 5);
        }
}

namespace {
/// With this triangle far below, a heightfield is an open mesh.
const in::mesh far_below{{{0, 0, -30}, {0.01f, 0, -30}, {0.01f, 0, -30.01f}}, {}, {{0, 1, 2}}};
}  // namespace

TEST_CASE("A camera that looks under the border of a heightfield sees its lower side in the light") {
    for (const bool is_open : {false, true}) {
        in::mesh ramp = shadow_meshes::sheet(2, 2, [](double u, double v) { return glm::dvec3(u, v, 2 * v); });
        if (is_open) ramp = shadow_meshes::joined(ramp, far_below);
        REQUIRE((in::shared_mesh(ramp).kind() == in::surface_kind::heightfield) == !is_open);
        in::scene s;
        s.seabed = in::seabed::none{};
        s.add(ramp, {.position = {-0.5, -3, 0}}, "ramp");
        // Over (0, 0), 2.2 m up, with light that comes from +y.
        in::overhead rig{.altitude = 2.2f, .field_of_view = 150_deg, .size = {128, 128}, .grazing = 6_deg};
        rig.light_azimuth = -90_deg;
        const auto frame = in::render(s, rig);
        REQUIRE(frame.labels.targets[0].area > 500);
        int dark = 0;
        for (std::size_t i = 0; i < frame.image.size(); ++i)
            dark += frame.labels.instance.pixels()[i] != 0 && frame.labels.shadow.pixels()[i] != in::labels::no_shadow;
        CHECK(dark == 0);
    }
}

namespace {

/// The same triangles wound clockwise: an open mesh.
in::mesh wound_clockwise(in::mesh m) {
    for (glm::uvec3& t : m.triangles) std::swap(t.y, t.z);
    return m;
}
in::frame<> picture_of_one(const in::mesh& m, const in::pose& where, const in::overhead& rig) {
    in::scene s;
    s.seabed = in::seabed::none{};
    s.add(m, where, "mesh");
    return in::render(s, rig);
}

}  // namespace

TEST_CASE("A camera within the box of a heightfield, but beside its outline, sees its lower side as of any mesh") {
    const float height[] = {0, 0.2f, 4};
    const in::mesh diagonal = shadow_meshes::sheet(4, 2, [&](double u, double v) {
        const double along = 2 * v, across = 4 * u - 2;
        return glm::dvec3(along + across, along - across, static_cast<double>(height[static_cast<int>(along)]));
    });
    in::overhead rig{.position = {3, 3}, .altitude = 4.5f, .size = {64, 64}, .grazing = 0.7f};
    rig.light_azimuth = -135_deg;
    CHECK(in::shared_mesh(diagonal).grid() != nullptr);
    const auto seen = picture_of_one(diagonal, {}, rig);
    CHECK(seen.labels.targets[0].area > 500);
    CHECK(seen.labels.shadow == picture_of_one(wound_clockwise(diagonal), {}, rig).labels.shadow);

    // A vertex that no triangle uses extends the box.
    in::mesh steps{{{0, -1, 0}, {0, 1.5f, 0}, {1, -1, 3}, {1, 1.5f, 3}, {2, -1, 4}, {2, 1.5f, 4}, {5, 0, 0}},
                   {},
                   {{0, 2, 3}, {0, 3, 1}, {2, 4, 5}, {2, 5, 3}}};
    CHECK(in::shared_mesh(steps).kind() == in::surface_kind::open);
    rig.position = {3, 0};
    rig.grazing = 61_deg;
    rig.light_azimuth = 180_deg;
    CHECK(picture_of_one(steps, {}, rig).labels.shadow ==
          picture_of_one(wound_clockwise(steps), {}, rig).labels.shadow);
    steps.positions.pop_back();
    CHECK(in::shared_mesh(steps).kind() == in::surface_kind::heightfield);
}

TEST_CASE("A closed mesh that the near plane cuts open is dark inside") {
    in::mesh box = in::to_mesh(in::cube{.size = glm::vec3(8)});
    box.normals.clear();
    const in::overhead rig{.altitude = 10, .field_of_view = 120_deg, .size = {128, 16}, .grazing = 0.6f};
    for (const double gap : {0.001, 0.01, 0.1}) {
        const in::pose beside{.position = {4 + gap, 0, 10}};
        CAPTURE(gap);
        const in::labels closed = picture_of_one(box, beside, rig).labels;
        CHECK(closed.shadow == picture_of_one(shadow_meshes::joined(box, far_below), beside, rig).labels.shadow);
        if (gap == 0.001)
            CHECK((closed.instance(120, 8) == 1 && closed.shadow(120, 8) == 1));  // the floor, from inside
    }
}

TEST_CASE("A target below a gap is shaded by seabed that is farther away than any that shades the datum") {
    in::seabed::heightfield rim{.heights = in::image<float>(201, 201, 0.0f), .origin = {-25, -25}, .spacing = 0.25};
    for (int j = 0; j < 201; ++j)
        for (int i = 52; i <= 148; ++i) rim.heights(i, j) = std::nanf("");  // from x = -12 to 12
    in::scene s;
    s.seabed = rim;
    s.add(in::cube{.size = {60, 60, 1}}, {.position = {0, 0, -3.5}}, "floor");
    const in::overhead rig{.altitude = 10, .field_of_view = 1.2f, .size = {64, 64}, .grazing = 0.2f};
    const auto frame = in::render(s, rig);
    for (int x = 0; x < 64; ++x) {
        const double at = in::overhead_geometry(rig).ray(x, 32).x * 13, crossing = at - 3 / std::tan(0.2);
        CAPTURE(at, crossing);
        if (frame.labels.instance(x, 32) == 1 && std::abs(crossing + 12) > 0.5)
            CHECK((frame.labels.shadow(x, 32) == in::labels::by_seabed) == (crossing < -12));
    }
    CHECK(frame.labels.targets[0].area > 3000);
}

TEST_CASE("A mesh far from its own origin is drawn where the same mesh around it is") {
    const in::overhead rig{.altitude = 10, .field_of_view = 0.5f, .size = {512, 512}, .grazing = 0.3f};
    const in::mesh box = in::to_mesh(in::cube{.size = glm::vec3(2)});
    const auto at_origin = picture_of_one(box, {.position = {0, 0, 1}, .yaw = 0.5f}, rig);
    for (const float away : {1000.0f, 100000.0f}) {  // metres, of which float holds the vertices exactly
        in::mesh moved = box;
        for (glm::vec3& p : moved.positions) p.x += away;
        const glm::dvec3 back{-std::cos(0.5) * static_cast<double>(away), -std::sin(0.5) * static_cast<double>(away),
                              1};
        CAPTURE(away);
        CHECK(picture_of_one(moved, {.position = back, .yaw = 0.5f}, rig).labels.instance == at_origin.labels.instance);
    }
}

TEST_CASE("A wide light that reaches below the plane of a tilted grid casts the shadows of any mesh") {
    in::mesh sheet = shadow_meshes::sheet(23, 23, [](double u, double v) {
        return glm::dvec3(2.3 * u, 2.3 * v, 0.05 * std::sin(30 * u) * std::cos(20 * v));
    });
    const double tilt = 28 * in::numeric::pi / 180;  // light comes in 2 degrees above the sheet's plane
    in::image<float> pictures[2];
    for (const int is_open : {0, 1}) {
        if (is_open != 0) sheet = shadow_meshes::joined(sheet, far_below);
        REQUIRE((in::shared_mesh(sheet).grid() != nullptr) == (is_open == 0));
        in::scene s;
        s.seabed = in::seabed::none{};
        s.add(sheet, {.position = {-1.2 * std::cos(tilt), -1.2, 2}, .pitch = static_cast<float>(tilt)}, "sheet");
        const in::overhead rig{.altitude = 8, .field_of_view = 25_deg, .size = {100, 100}, .grazing = 30_deg};
        pictures[is_open] =
            in::render(s, rig, in::render_options<>{}.with(in::shadow::penumbra{.diameter = 0.3f, .samples = 16}))
                .image;
    }
    CHECK(pictures[0] == pictures[1]);
}

TEST_CASE("A wall outside of the picture casts its shadow into it, over height / tan(elevation)") {
    in::seabed::heightfield field{.heights = in::image<float>(641, 641), .origin = {-20, -20}, .spacing = 0.0625};
    for (int j = 0; j < 641; ++j) field.heights(160, j) = 0.9f;  // at x = -10, 6 m before the picture
    in::scene s;
    s.seabed = field;
    for (const double elevation : {4.0, 5.0, 6.5}) {
        const in::overhead rig = scenes::rig(0, elevation, 200);
        const exact_options options{.cell = in::overhead_geometry(rig).half_extent(0).x / 64};
        const auto frame = in::render(s, rig, options);
        const double tip = -10 + 0.9 / std::tan(in::numeric::to_radians(elevation));
        for (int x = 0; x < 200; ++x) {
            const double at = 8 * (x + 0.5) / 200 - 4;
            CAPTURE(elevation, at, tip);
            if (std::abs(at - tip) > 0.25) CHECK((frame.labels.shadow(x, 100) == in::labels::by_seabed) == (at < tip));
        }
    }
}
