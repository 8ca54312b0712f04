// Compiled several times under different flags, as the function PROBE: draws a turned cube with speckle on it.
#include "probe.hpp"

#include <insonify/all.hpp>

#include <bit>

namespace in = insonify;

#define TEXT_OF_RAW(x) #x
#define TEXT_OF(x) TEXT_OF_RAW(x)

probe_result PROBE() {
    const auto vertex_shader = [](const in::vertex& v) {
        const auto& p = v.position;
        return glm::vec4(0.8f * p.x - 0.6f * p.y, 0.6f * p.x + 0.8f * p.y, 0.5f + 0.25f * p.z, 1);
    };
    const auto speckle = [](const in::fragment<in::no_varyings>& f) {
        const auto words = in::philox4x32({static_cast<std::uint32_t>(f.x), static_cast<std::uint32_t>(f.y), 0, 0}, {});
        return static_cast<float>(in::normal_pair(words[0], words[1])[0]) + f.weights.x;
    };
    in::image<float> color(97, 61, -1.0f), depth(97, 61, in::empty_depth(in::depth_compare::less));
    in::draw(in::to_mesh(in::cube{}), vertex_shader, speckle, in::framebuffer<float>{color, depth});

    probe_result result{TEXT_OF(INSONIFY_ABI) " " TEXT_OF(INSONIFY_FLAGS), 0xcbf29ce484222325u, 0};
    for (std::size_t i = 0; i < color.size(); ++i) {
        for (const float value : {color.pixels()[i], depth.pixels()[i]})
            result.bytes = (result.bytes ^ std::bit_cast<std::uint32_t>(value)) * 0x100000001b3u;
        result.uncovered += !in::numeric::is_finite(depth.pixels()[i]);
    }
    return result;
}
