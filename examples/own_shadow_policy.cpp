// A shadow policy of your own: tests every triangle along every ray to a directional light.
#include <insonify/insonify.hpp>
#include <insonify/sonar/overhead/render.hpp>

#include <cstdio>

namespace shadow = insonify::shadow;

struct every_triangle {
    std::vector<shadow::caster> casters;  // of a light, once it is built
    glm::dvec3 to_light{0};

    every_triangle build(std::span<const shadow::caster> all, const auto& light, const auto&, auto&) const {
        return {{all.begin(), all.end()}, shadow::light_frame(std::get<shadow::directional_light>(light)).to_light()};
    }
    void test(const shadow::points& at, const shadow::results& into) const {
        for (std::size_t i = 0; i < at.size(); ++i) {
            into.caster[i] = shadow::invalid_id;
            for (std::uint32_t c = 0; c < casters.size() && into.caster[i] == shadow::invalid_id; ++c)
                for (const glm::uvec3& t : casters[c].mesh.triangles)
                    if (blocks(casters[c], t, at[i])) into.caster[i] = c;
            into.lit[i] = into.caster[i] == shadow::invalid_id ? 1.0f : 0.0f;
        }
    }
    bool blocks(const shadow::caster& c, const glm::uvec3& t, const glm::dvec3& p) const {
        const auto corner = [&](int k) { return insonify::transform_point(c.placement, c.mesh.positions[t[k]]) - p; };
        const glm::dvec3 u = corner(0), v = corner(1), w = corner(2);
        const auto side = [&](const auto& a, const auto& b) { return glm::dot(to_light, glm::cross(a, b)); };
        const double volume = glm::dot(u, glm::cross(v, w)), sign = volume < 0 ? -1 : 1;  // 0 on its own triangle
        return sign * volume > 1e-12 && sign * side(u, v) >= 0 && sign * side(v, w) >= 0 && sign * side(w, u) >= 0;
    }
};

int main() {
    insonify::scene scene;
    scene.seabed = insonify::seabed::ripples{.wavelength = 0.8f, .steepness = 0.1f};
    scene.add(insonify::cube{}, {.position = {0, 0, 0.5}, .yaw = 0.4f}, "cube");
    const auto frame = insonify::render<every_triangle>(scene, {.altitude = 3, .size = {96, 96}, .grazing = 0.3f});
    std::printf("%.0f pixels in the cube's shadow\n", static_cast<double>(frame.labels.targets[0].shadow_area));
}
