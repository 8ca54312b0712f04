// Exact shadows in whole pictures, against an oracle that shares nothing with them: for every pixel the nearest
// triangle along its ray, and then every triangle that its ray towards the light could meet, in doubles, one by one.
#include <insonify/core/thread_pool.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "../../catch.hpp"
#include "../../shadow_scenes.hpp"

namespace in = insonify;
namespace scenes = shadow_scenes;

namespace {

using exact_options = in::render_options<in::shadow::exact>;

constexpr double nowhere = std::numeric_limits<double>::infinity();

/// Distance along a ray to a triangle, in lengths of its direction.
double distance(const scenes::triangle& t, const glm::dvec3& from, const glm::dvec3& along) {
    const glm::dvec3 ab = t.b - t.a, ac = t.c - t.a, p = glm::cross(along, ac), s = from - t.a, q = glm::cross(s, ab);
    const double determinant = glm::dot(ab, p);
    if (determinant == 0) return nowhere;
    const double u = glm::dot(s, p) / determinant, v = glm::dot(along, q) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 ? glm::dot(ac, q) / determinant : nowhere;
}

class oracle {
  public:
    oracle(const in::scene& s, int pixels) : triangles_(scenes::triangles(s)), pixels_(pixels) {
        // What each pixel shows, as the camera 4 m up sees it at 90 degrees.
        depth_.assign(static_cast<std::size_t>(pixels * pixels), nowhere);
        shown_.assign(depth_.size(), -1);
        for (std::size_t i = 0; i < triangles_.size(); ++i) {
            const scenes::triangle& t = triangles_[i];
            double low[2] = {nowhere, nowhere}, high[2] = {-nowhere, -nowhere};
            for (const glm::dvec3& p : {t.a, t.b, t.c})
                for (int axis = 0; axis < 2; ++axis) {
                    const double at = (axis == 0 ? p.x : -p.y) / (4 - p.z) * 0.5 * pixels + 0.5 * pixels;
                    low[axis] = std::min(low[axis], at);
                    high[axis] = std::max(high[axis], at);
                }
            const auto held = [&](double v) { return std::clamp(static_cast<int>(std::floor(v)), 0, pixels - 1); };
            for (int y = held(low[1] - 1); y <= held(high[1] + 1); ++y)
                for (int x = held(low[0] - 1); x <= held(high[0] + 1); ++x) {
                    const double d = distance(t, {0, 0, 4}, ray(x, y));
                    const auto at = static_cast<std::size_t>(y * pixels + x);
                    if (d > 0 && d < depth_[at]) {
                        depth_[at] = d;
                        shown_[at] = static_cast<long>(i);
                    }
                }
        }
    }

    /// Compares a picture's mask with rays towards a light, parallel from `light` or, if it is near, starting there.
    scenes::difference compare(const in::labels& labels, const glm::dvec3& light, bool is_near = false) const {
        // Slabs along the light, so that not all pixels ask all triangles. They are wide and overlap.
        const glm::dvec3 side = std::abs(light.x) + std::abs(light.y) > 0
                                    ? glm::normalize(glm::dvec3(-light.y, light.x, 0))
                                    : glm::dvec3(1, 0, 0);
        constexpr double slab = 0.25;
        constexpr int slabs = 64;
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
                const glm::dvec3 p = glm::dvec3(0, 0, 4) + depth_[at] * ray(x, y);
                const glm::dvec3 along = is_near ? light - p : light;
                const glm::dvec3 n = glm::cross(t.b - t.a, t.c - t.a);
                bool lit = glm::dot(n, along) * -glm::dot(n, ray(x, y)) > 0;
                const auto& asked = is_near ? all : within[static_cast<std::size_t>(slab_of(p))];
                for (std::size_t i = 0; lit && i < asked.size(); ++i) {
                    if (asked[i] == own) continue;
                    const double hit = distance(triangles_[asked[i]], p, along);
                    lit = !(hit > 1e-9 && hit < (is_near ? 1 : nowhere));
                }
                d.add(labels.shadow(x, y) == in::labels::is_lit, lit);
            }
        return d;
    }

  private:
    glm::dvec3 ray(int x, int y) const { return {2 * (x + 0.5) / pixels_ - 1, 1 - 2 * (y + 0.5) / pixels_, -1}; }

    std::vector<scenes::triangle> triangles_;
    int pixels_;
    std::vector<double> depth_;
    std::vector<long> shown_;
};

/// All seabeds and directions; prints what it finds for each seabed and elevation if asked to.
scenes::difference compare_all(double spacing, int pixels, bool print) {
    scenes::difference total;
    for (int kind = 0; kind < 3; ++kind) {
        const in::scene s = scenes::make(kind, spacing);
        const oracle truth(s, pixels);
        for (const double elevation : scenes::elevations) {
            scenes::difference here;
            for (const double azimuth : scenes::azimuths) {
                const in::overhead rig = scenes::rig(azimuth, elevation, pixels);
                const auto frame = in::render(s, rig, exact_options{});
                here += truth.compare(frame.labels, in::overhead_geometry(rig).light().to_light());
            }
            if (print)
                WARN(scenes::seabed_names[kind] << " at " << elevation << " degrees: " << here.wrong << " of "
                                                << here.pixels << " wrong, IoU " << here.iou());
            INFO(scenes::seabed_names[kind] << " at " << elevation);
            CHECK(here.iou() >= 0.9999);
            total += here;
        }
    }
    return total;
}

}  // namespace

TEST_CASE("Pictures have the shadows that rays have: three seabeds, four targets, an imported mesh, an open sheet") {
    const scenes::difference d = compare_all(0.2, 64, false);
    CHECK(d.pixels > 600000);
    CHECK(d.share() <= 1e-5);
}

TEST_CASE("The same in finer pictures of finer seabeds", "[.slow]") {
    const scenes::difference d = compare_all(0.06, 400, true);
    WARN(d.wrong << " of " << d.pixels << " wrong");
    CHECK(d.share() <= 1e-5);
}
