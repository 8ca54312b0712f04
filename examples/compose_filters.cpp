// Filters on a user's picture: compose_filters in.png out.png [reference picture]
//
// Histogram matching, speckle, a lambda and the colour map fuse into one pass over the pixels.
#include <insonify/filter/colormap.hpp>
#include <insonify/filter/match.hpp>
#include <insonify/filter/noise.hpp>
#include <insonify/filter/pipe.hpp>
#include <insonify/io/png.hpp>

#include <cstdio>

#include "common/pictures.hpp"
#include "common/usage.hpp"

namespace in = insonify;

int main(int argc, char** argv) try {
    examples::check_arguments(argc, argv, 2, 3, "compose_filters in.png out.png [reference picture]");
    const in::image<float> picture = examples::read_gray(argv[1]);
    const in::image<float> reference = argc > 3 ? examples::read_gray(argv[3]) : picture;

    // Any function of a pixel is a filter: here, pixels get a little darker from left to right.
    const auto fade = [width = picture.width()](float v, int x, int) {
        return v * (1.0f - 0.3f * static_cast<float>(x) / static_cast<float>(width));
    };
    const auto look = in::match_histogram(reference) | in::speckle{.variance = 0.05f, .seed = 1} | fade;
    in::write_png(argv[2], picture | look | in::colormap::copper);
} catch (const std::exception& error) {
    std::fprintf(stderr, "compose_filters: %s\n", error.what());
    return 1;
}
