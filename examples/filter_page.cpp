// Noise, histogram and color filters on one page: filter_page out.png [picture [reference picture]]
//
// Each under its name: the filtered picture, and beside it its histogram, dark levels below and light ones above, in
// front of the unfiltered picture's histogram in gray. Without pictures, a cylinder on rippled sand, with a scale bar.
#include <insonify/filter/poisson.hpp>
#include <insonify/insonify.hpp>
#include <insonify/io/png.hpp>

#include <cmath>
#include <cstdio>

#include "common/pictures.hpp"
#include "common/scale_bar.hpp"
#include "common/text.hpp"
#include "common/usage.hpp"

namespace in = insonify;
using namespace in::literals;

namespace {

constexpr int tile = 120, chart = 72, gap = 8, caption = 16, columns = 5;
constexpr float altitude = 2.2f;
constexpr in::rgb8 paper{24, 26, 30}, ink{225, 225, 225}, before{70, 76, 86}, bars{232, 168, 64};

in::image<float> scene_picture() {
    in::scene scene;
    scene.seabed = in::seabed::ripples{.wavelength = 0.9f, .steepness = 0.08f, .direction = 0.5f, .seed = 7};
    scene.add(in::cylinder{.radius = 0.35f, .length = 2}, {.position = {-0.4, 0.3, 0.35}, .yaw = 60_deg}, "cylinder");
    const in::overhead rig{.altitude = altitude, .size = {tile, tile}, .grazing = 14_deg};
    // Dim and slightly grainy, as recordings are: speckle would clip on bright pixels of a picture in [0, 1].
    return in::render(scene, rig).image | [](float v) { return 0.05f + 0.55f * v; } | in::gamma_speckle{.looks = 60};
}

/// The middle of a picture, as large as a tile.
in::image<float> middle_of(const in::image<float>& picture) {
    const int width = (std::min)(tile, picture.width()), height = (std::min)(tile, picture.height());
    return in::image<float>(
        picture.view().part((picture.width() - width) / 2, (picture.height() - height) / 2, width, height));
}

class page {
  public:
    /// @param metres  along a side of the picture, 0 if unknown
    page(in::image<float> picture, int cells, double metres)
        : picture_(std::move(picture)),
          sheet_(columns * (tile + chart + gap) + gap,
                 caption + gap + (cells + columns - 1) / columns * (tile + caption + gap) + gap, paper),
          metres_(metres) {
        examples::write_text(sheet_, gap, gap,
                             "Beside each picture its histogram, dark levels below; a bar as long as the space is wide "
                             "is an eighth of the pixels. Gray: before the filter.",
                             ink);
        if (metres_ > 0)
            examples::write_text(sheet_, sheet_.width() - 190, gap, "sound travels from left to right", ink);
    }

    void add(const std::string& name, const in::image<float>& result, const in::color_table& colors) {
        const int left = gap + cell_ % columns * (tile + chart + gap),
                  top = caption + 2 * gap + cell_ / columns * (tile + caption + gap);
        ++cell_;
        examples::write_text(sheet_, left, top, name, ink);
        const in::image<in::rgb8> colored = result | colors;
        for (int y = 0; y < colored.height(); ++y)
            std::copy_n(colored.row(y).begin(), colored.width(), sheet_.row(top + caption + y).begin() + left);
        if (metres_ > 0 && cell_ == 1)
            examples::draw_scale_bar(sheet_, left + tile, top + caption + tile, tile, metres_, ink, paper);
        draw(picture_, left + tile, top + caption, before);
        draw(result, left + tile, top + caption, bars);
    }
    template <class Filter>
    void add(const std::string& name, const Filter& filter) {
        add(name, picture_ | filter, in::colormap::gray);
    }

    const in::image<in::rgb8>& sheet() const { return sheet_; }

  private:
    /// A histogram, its darkest bin at the bottom; a bar as wide as the chart is an eighth of the pixels.
    void draw(const in::image<float>& picture, int left, int top, const in::rgb8& color) {
        constexpr int bins = tile / 2;
        const in::histogram counted = in::histogram_of(picture, bins);
        for (int bin = 0; bin < bins; ++bin) {
            const double share = static_cast<double>(counted.counts[static_cast<std::size_t>(bin)]) /
                                 static_cast<double>(picture.size());
            const int length = (std::min)(chart, static_cast<int>(8 * share * chart + 0.5));
            const int y = top + tile - 2 * (bin + 1);
            std::fill_n(sheet_.row(y).begin() + left, length, color);
            if (color == before) std::fill_n(sheet_.row(y + 1).begin() + left, length, color);
        }
    }

    in::image<float> picture_;
    in::image<in::rgb8> sheet_;
    double metres_;
    int cell_ = 0;
};

}  // namespace

int main(int argc, char** argv) try {
    examples::check_arguments(argc, argv, 1, 3, "filter_page out.png [picture [reference picture]]");
    const in::image<float> picture = argc > 2 ? middle_of(examples::read_gray(argv[2])) : scene_picture();
    const in::image<float> reference =
        argc > 3 ? examples::read_gray(argv[3]) : in::image<float>(512, 512, 0.3f) | in::gamma_speckle{.looks = 3};
    const in::image<std::uint8_t> dark = picture | [](float v) -> std::uint8_t { return v < 0.15f; };
    constexpr in::correlation_length grain{2, 2};

    // From an altitude, a field of view of `overhead` degrees shows 2 altitude tan(field of view / 2) metres.
    const double across =
        2.0 * static_cast<double>(altitude) * std::tan(static_cast<double>(in::overhead{}.field_of_view) / 2);
    page all(picture, 25, argc > 2 ? 0 : across);
    all.add("before", in::filter_chain<>{});
    all.add("gaussian", in::gaussian{.variance = 0.01f});
    all.add("gaussian, correlated", in::gaussian{.variance = 0.01f, .correlation = grain});
    all.add("speckle (uniform)", in::speckle{.variance = 0.05f});
    all.add("gaussian_speckle", in::gaussian_speckle{.variance = 0.05f});
    all.add("salt_and_pepper", in::salt_and_pepper{});
    all.add("poisson, 255 photons", in::poisson{});
    all.add("poisson, 20 photons", in::poisson{.photons = 20});
    all.add("rayleigh", in::rayleigh{});
    all.add("rayleigh, correlated", in::rayleigh{.correlation = grain});
    all.add("gamma_speckle, 4 looks", in::gamma_speckle{.looks = 4});
    all.add("k_speckle, shape 1", in::k_speckle{.shape = 1});
    all.add("rician, steady 4", in::rician{.steady = 4});
    all.add("equalize", in::equalize{});
    all.add("match_binned, 16 bins", in::match_binned(reference, 16));
    all.add("match_histogram", in::match_histogram(reference));
    all.add("match where it is dark", in::where(dark, in::match_histogram(reference)));
    all.add("gaussian by a map", in::gaussian{.variance = {dark, {0.03f, 0}}});
    const auto look = in::match_histogram(reference) | in::gamma_speckle{.looks = 8};
    all.add("match | 8 looks", look);
    all.add("hot", picture | look, in::colormap::hot);
    all.add("match | 8 looks | copper", picture | look, in::colormap::copper);
    all.add("amber", picture | look, in::colormap::amber);
    all.add("sea", picture | look, in::colormap::sea);
    all.add("gray", picture | look, in::colormap::gray);
    all.add("inverse_gray", picture | look, in::colormap::inverse_gray);
    in::write_png(argv[1], all.sheet());
} catch (const std::exception& error) {
    std::fprintf(stderr, "filter_page: %s\n", error.what());
    return 1;
}
