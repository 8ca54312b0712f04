// A user's unbounded seabed, with its label, brightness and speckle, in both kinds of picture: own_seabed.
#include <insonify/insonify.hpp>
#include <insonify/io/png.hpp>
#include <insonify/seabed/blend.hpp>
#include <insonify/sonar/side_scan/recording.hpp>
#include <insonify/sonar/speckle.hpp>

#include <cstdio>

namespace in = insonify;

/// Long sand waves without end.
struct sand_waves {
    static constexpr in::seabed::type_properties kind{in::seabed::user_type(0), "sand waves", 0.55f, {.texture = 12}};
    double height = 0.3, length = 6;  ///< metres

    /// Heights along a row; waves too short for the grid fade out.
    void row(const in::seabed::scanline& line, std::span<float> heights) const {
        const float gain = in::seabed::band_limit_gain(length, line.grid_spacing);
        for (std::size_t i = 0; i < heights.size(); ++i) {
            const double turns = (line.x(i) + 0.3 * in::numeric::sin_cos(0.4 * line.y).sine) / length;
            heights[i] = gain * static_cast<float>(0.5 * height * in::numeric::sin_cos_turns(turns).sine);
        }
    }
    in::seabed::height_range range() const { return {-0.5 * height, 0.5 * height}; }
};

int main() {
    in::scene scene;  // 1000 km from the origin, at full precision; patches of ripples lie between the waves
    scene.seabed = in::seabed::blend{.first = sand_waves{}, .second = in::seabed::ripples{.seed = 2}, .patch = 15};
    scene.add(in::cube{.size = glm::vec3(0.5f)}, {.position = {1e6 + 9, 5, 0.4}}, "cube");

    const auto above = in::render(scene, in::overhead{.position = {1e6, 0}, .size = {512, 512}});
    in::write_png("waves.png", above.image | in::equalize{} | in::colormap::copper);
    const in::side_scan sonar{.position = {1e6, 0}, .pings = 300, .range = 25, .bins = 500};
    in::write_png("waves_swath.png", in::with_speckle(in::render(scene, sonar)).image | in::display{});
    for (const auto& t : above.labels.legend)
        std::printf("label %d: %s\n", static_cast<int>(t.label), std::string(t.name).c_str());
    return above.labels.legend.size() == 2 ? 0 : 1;
}
