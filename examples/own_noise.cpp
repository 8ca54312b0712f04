// A user's noise filter, seeded by pixel: dropouts along rows, the same in any tile, crop or thread.
#include <insonify/core/thread_pool.hpp>
#include <insonify/insonify.hpp>
#include <insonify/io/png.hpp>

namespace in = insonify;

/// Some pixels lose part of their signal, some rows all of it.
struct dropouts {
    float pixels = 0.2f;  ///< in [0, 1]: fraction of the pixels that become darker
    float rows = 0.02f;   ///< in [0, 1]: fraction of the rows that are lost
    std::uint64_t seed = 1;

    auto pass() const {
        // A random number is a function of the key (seed, stream) and of a counter: here the position.
        const in::philox_key by_pixel = in::stream_key(seed, 0x6F776E31), by_row = in::stream_key(seed, 0x6F776E32);
        return [=, *this](float value, int x, int y) {
            const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(y);
            const auto words = in::philox4x32({column, row, 0, 0}, by_pixel);
            const double of_row = in::uniform_open(in::philox4x32({row, 0, 0, 0}, by_row)[0]);
            if (of_row < static_cast<double>(rows)) return 0.0f;
            if (!(in::uniform_open(words[0]) < static_cast<double>(pixels))) return value;
            return value * static_cast<float>(in::uniform_open(words[1]));
        };
    }
};

int main() {
    in::scene scene;
    scene.seabed = in::seabed::ripples{.seed = 4};
    const auto picture = in::render(scene, in::overhead{.altitude = 4, .size = {512, 512}}).image;
    in::thread_pool pool(4);
    const auto look = dropouts{.seed = 9} | in::speckle{.variance = 0.05f} | in::colormap::copper;
    const auto serial = in::apply(picture, look), parallel = in::apply(picture, look, pool);
    in::write_png("dropouts.png", parallel);
    return serial == parallel ? 0 : 1;  // the same bytes
}
