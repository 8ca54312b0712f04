// Range modes against an oracle that shares no code with the library: a dense fan of rays in double precision, each
// tested against every triangle's cross-section. Energies, instances and shadows by bin have to agree.
#include <insonify/all.hpp>
#include <insonify/geometry/objects/boulder.hpp>
#include <insonify/geometry/objects/lobster_pot.hpp>
#include <insonify/sonar/side_scan/recording.hpp>

#include <cmath>
#include <numbers>

#include "../../catch.hpp"

namespace in = insonify;

namespace {

/// A piece of the targets' outline in the ping's plane.
struct segment {
    glm::dvec2 a, b;  // x outwards, z up from the datum
    glm::dvec3 normal;
    std::uint16_t instance;
};

std::vector<segment> outline_of(const in::scene& s) {
    std::vector<segment> all;
    for (std::size_t i = 0; i < s.targets.size(); ++i) {
        const in::affine map = in::to_world(s.targets[i].placement);
        const in::mesh& m = *s.targets[i].shape;
        for (const glm::uvec3& t : m.triangles) {
            glm::dvec3 v[3];
            for (int k = 0; k < 3; ++k) v[k] = in::transform_point(map, glm::dvec3(m.positions[t[k]]));
            std::vector<glm::dvec2> ends;
            for (int k = 0; k < 3; ++k) {
                const glm::dvec3 &p = v[k], &q = v[(k + 1) % 3];
                if ((p.y < 0) == (q.y < 0)) continue;
                const double f = p.y / (p.y - q.y);
                ends.emplace_back(p.x + f * (q.x - p.x), p.z + f * (q.z - p.z));
            }
            const glm::dvec3 normal = glm::cross(v[1] - v[0], v[2] - v[0]);
            if (ends.size() == 2 && glm::length(normal) > 0)
                all.push_back({ends[0], ends[1], glm::normalize(normal), static_cast<std::uint16_t>(i + 1)});
        }
    }
    return all;
}

struct ping_truth {
    std::vector<double> energy, dark;              ///< by bin; of the bottom's length the part in shadow
    std::vector<std::vector<double>> of_instance;  ///< energy
};

/// Level bottom at 0 of reflectivity one, targets of reflectivity one, Lambert's law, a metre of track.
ping_truth trace_ping(const in::scene& s, double altitude, double range, int bins) {
    constexpr int rays = 60000;
    const auto outline = outline_of(s);
    ping_truth h{
        std::vector<double>(static_cast<std::size_t>(bins)), std::vector<double>(static_cast<std::size_t>(bins)),
        std::vector<std::vector<double>>(s.targets.size() + 1, std::vector<double>(static_cast<std::size_t>(bins)))};
    const double step = std::numbers::pi / rays;
    for (int i = 0; i < rays; ++i) {
        const double angle = (i + 0.5) * step, sine = std::sin(angle), cosine = std::cos(angle);  // from straight down
        const double bottom = cosine > 0 ? altitude / cosine : 1e30;
        double nearest = bottom, facing = cosine;
        std::uint16_t instance = 0;
        for (const segment& o : outline) {
            const double xa = o.a.x, da = altitude - o.a.y, xb = o.b.x, db = altitude - o.b.y;
            const double before = xa * cosine - da * sine, after = xb * cosine - db * sine;
            if ((before < 0) == (after < 0)) continue;
            const double f = before / (before - after);
            const double r = (xa + f * (xb - xa)) * sine + (da + f * (db - da)) * cosine;
            if (!(r > 0 && r < nearest)) continue;
            nearest = r, instance = o.instance;
            facing = std::abs(o.normal.z * cosine - o.normal.x * sine);
        }
        const auto bin_of = [&](double r) { return static_cast<std::size_t>(r / range * bins); };
        if (nearest < range) {
            const double power = nearest * step * facing;  // area x sine^2 = R dtheta / sine x sine^2
            h.energy[bin_of(nearest)] += power;
            h.of_instance[instance][bin_of(nearest)] += power;
        }
        if (bottom < range && instance != 0 && nearest < bottom)
            h.dark[bin_of(bottom)] += step / (cosine * cosine) * altitude;
    }
    return h;
}

}  // namespace

TEST_CASE("Energies, instances and shadows of range modes equal those of an oracle of rays, thin parts included") {
    double worst_total = 0;
    int clear_bins = 0, wrong_instances = 0, shadow_bins = 0, wrong_shadows = 0;
    for (int turn = 0; turn < 12; ++turn) {
        in::random_sequence random(5, 0, static_cast<std::uint64_t>(turn));
        in::scene s;
        s.seabed = in::seabed::flat{.surface = {.rms = 0}};
        s.bottom.fill({1});
        const auto add = [&](const auto& shape, const char* name) {
            const in::mesh flat = in::with_creases(to_mesh(shape), 0);
            s.add(flat,
                  {.position = {random.uniform(4, 16), random.uniform(-0.2, 0.2), random.uniform(0.1, 1)},
                   .yaw = static_cast<float>(random.uniform(0, 6)),
                   .pitch = static_cast<float>(random.uniform(-0.5, 0.5))},
                  name, {1});
        };
        add(in::lobster_pot{}, "pot");
        add(in::boulder{.seed = random.word()}, "boulder");
        add(in::sphere{.radius = 0.5f}, "sphere");
        add(in::cube{.size = {0.02f, 2.0f, 1.5f}}, "board");
        constexpr int bins = 500;
        constexpr double range = 20, altitude = 4;
        const auto truth = trace_ping(s, altitude, range, bins);
        const in::side_scan rig{.altitude = 4, .ping_spacing = 1, .pings = 1, .range = 20, .bins = bins};
        const auto found = in::render(s, rig, in::record_options<>{}.with(in::sonar_equation<>{}));
        double total = 0, expected = 0, shifted = 0;
        for (int b = 0; b < bins; ++b) {
            const auto k = static_cast<std::size_t>(b);
            total += static_cast<double>(found.image(b, 0)), expected += truth.energy[k];
            shifted = (std::max)(shifted, std::abs(total - expected));  // of the energy up to here
            double targets = 0;
            for (std::size_t i = 1; i < truth.of_instance.size(); ++i) targets += truth.of_instance[i][k];
            const bool is_clear = std::abs(targets - truth.of_instance[0][k]) > 0.2 * truth.energy[k];
            if (is_clear && truth.energy[k] > 0) {
                ++clear_bins;
                const std::uint16_t labelled = found.labels.instance(b, 0);
                wrong_instances += (labelled != 0) != (targets > truth.of_instance[0][k]) ||
                                   truth.of_instance[labelled][k] < 0.2 * truth.energy[k];
            }
            const double length =
                range / bins * (b + 0.5) /
                std::sqrt((std::max)(0.01, std::pow(range / bins * (b + 0.5), 2) - altitude * altitude)) * range / bins;
            const double shadow_fraction = truth.dark[k] / length;
            if ((shadow_fraction > 0.9 || shadow_fraction < 0.1) && range / bins * b > altitude + 0.2 &&
                found.labels.instance(b, 0) == 0) {
                ++shadow_bins;
                wrong_shadows += (found.labels.shadow(b, 0) != 0) != (shadow_fraction > 0.5);
            }
        }
        CAPTURE(turn, total, expected, shifted);
        CHECK(std::abs(total - expected) < 0.001 * expected);
        CHECK(shifted < 0.005 * expected);
        worst_total = (std::max)(worst_total, std::abs(total / expected - 1));
    }
    CAPTURE(worst_total, clear_bins, wrong_instances, shadow_bins, wrong_shadows);
    CHECK(wrong_instances <= clear_bins / 200);
    CHECK(wrong_shadows <= shadow_bins / 200);
}
