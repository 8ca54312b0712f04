// Every type of seabed at three grazing angles, beside real ones: seabed_gallery [seabeds.png [folder of real tiles]]
//
// Prints texture statistics of each tile, and of the real tiles if the folder exists.
#include <insonify/core/thread_pool.hpp>
#include <insonify/insonify.hpp>
#include <insonify/io/png.hpp>
#include <insonify/seabed/mixed.hpp>
#include <insonify/sonar/speckle.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "../common/pictures.hpp"
#include "../common/scale_bar.hpp"
#include "../common/text.hpp"
#include "../common/usage.hpp"
#include "texture.hpp"

namespace in = insonify;
namespace sb = insonify::seabed;
using namespace in::literals;

namespace {

constexpr int tile_width = 184, tile_height = 128, gap = 4, caption = 12;
constexpr int grazing_angles[] = {30, 15, 8};  // degrees, in the middle of a tile

struct entry {
    const char* name;
    double cell;  // metres per pixel
    sb::any seabed;
    const char* real;  // a tile of the folder that shows a similar bottom, and its crop
    int left, top;
};

std::vector<entry> entries() {
    const auto of = [](in::sediment s) { return sb::bottom_of(s, 3); };
    const sb::mixed sand_in_mud{
        .base = sb::mud{.density = 0, .kind = sb::type::sandy_mud},
        .layers = {{sb::flat{.surface = sb::roughness_of(in::sediment::coarse_sand), .kind = sb::type::coarse_sand},
                    sb::patches{.coverage = 0.6f, .size = 7}},
                   {sb::rippled(in::sediment::coarse_sand, {.wavelength = 0.9f, .steepness = 0.12f, .direction = 0.2f}),
                    sb::patches{.coverage = 0.4f, .size = 6}, 1.0f}},
        .seed = 4};
    return {
        {"flat medium sand", 0.04, of(in::sediment::medium_sand), "sassed_14.png", 150, 190},
        {"ripples", 0.04, sb::ripples{.wavelength = 1.1f, .steepness = 0.12f, .seed = 5}, "sassed_00.png", 0, 60},
        {"ripples that fork", 0.04, sb::ripples{.wavelength = 0.9f, .spread = 0.16f, .bandwidth = 0.13f, .seed = 6},
         "sassed_28.png", 90, 20},
        {"two ripple systems", 0.04,
         sb::ripples{.wavelength = 1.1f,
                     .steepness = 0.1f,
                     .direction = 0.35f,
                     .second = {.wavelength = 0.5f, .steepness = 0.06f, .direction = -0.9f},
                     .seed = 7},
         nullptr, 0, 0},
        {"sand, mud, ripples", 0.06, sand_in_mud, "sassed_10.png", 230, 0},
        {"mud with marks", 0.05, sb::mud{.seed = 8, .kind = sb::type::sandy_mud}, "sassed_02.png", 200, 60},
        {"mud, trawled", 0.1,
         sb::mud{.density = 0.05f, .trawls = {.density = 0.15f, .depth = 0.1f, .width = 0.8f}, .seed = 9}, nullptr, 0,
         0},
        {"cobble", 0.05, of(in::sediment::cobble), "sassed_04.png", 180, 40},
        {"rock", 0.07, sb::rock{.seed = 10}, nullptr, 0, 0},
    };
}

/// A tile of the bottom in ground range, its middle 18 m away at a given grazing angle.
in::image<float> tile_of(const sb::any& seabed, double cell, int degrees, in::thread_pool& pool) {
    const double distance = 18, half = 0.5 * tile_width * cell;
    in::scene scene;
    scene.seabed = seabed;
    const in::ground_range rig{.position = {-distance, 0},
                               .altitude = static_cast<float>(distance * std::tan(degrees * in::numeric::pi / 180)),
                               .ping_spacing = static_cast<float>(cell),
                               .pings = tile_height,
                               .first_range = static_cast<float>(distance - half),
                               .range = static_cast<float>(distance + half),
                               .bins = tile_width};
    const auto recorded = in::render(scene, rig, in::record_options<in::labels, in::lambert_backscatter>{}, pool);
    return in::with_speckle(recorded, {.seed = 11}, pool).image;
}

/// Gray values; white is 7 times the mean intensity, a typical setting of sonar operators.
in::image<float> shown(const in::image<float>& intensity) {
    double mean = 0;
    for (const float i : intensity.pixels()) mean += static_cast<double>(i) / static_cast<double>(intensity.size());
    return intensity | in::display{.white = static_cast<float>(7 * mean)};
}

void describe(const char* name, const char* view, const in::image<float>& picture) {
    const gallery::texture t = gallery::texture_of(picture);
    std::printf("%-30s %-9s %9.2f %8.2f %8.2f %8.2f %8.2f %11.2f %8.2f %8.0f %10.2f\n", name, view, t.deviation,
                t.skewness, t.across, t.along, t.contrast, t.homogeneity, t.slope, t.direction, t.anisotropy);
}

void paste(in::image<float>& sheet, int left, int top, const in::image<float>& tile) {
    for (int y = 0; y < tile_height; ++y)
        std::copy_n(tile.row(y).begin(), tile_width, sheet.row(top + y).begin() + left);
}

}  // namespace

int main(int argc, char** argv) try {
    examples::check_arguments(argc, argv, 0, 2, "seabed_gallery [seabeds.png [folder of real tiles]]");
    const std::string out = argc > 1 ? argv[1] : "seabeds.png";
    const std::string folder = argc > 2 ? argv[2] : EXAMPLES_REFERENCE "/sas_sassed";
    in::thread_pool pool;
    const std::vector<entry> all = entries();
    const auto real_path = [&](const entry& e) {
        const std::string path = e.real != nullptr ? folder + "/" + e.real : "";
        return std::filesystem::exists(path) ? path : std::string();
    };
    const bool has_real = std::any_of(all.begin(), all.end(), [&](const entry& e) { return !real_path(e).empty(); });
    const int columns = has_real ? 4 : 3;
    in::image<float> sheet(columns * (tile_width + gap) + gap,
                           caption + static_cast<int>(all.size()) * (tile_height + gap + caption) + gap, 0.1f);
    examples::write_text(sheet, gap + 2, 4, "sound travels from left to right", 1.0f);
    std::printf("%-30s %-9s %9s %8s %8s %8s %8s %11s %8s %8s %10s\n", "seabed", "view", "deviation", "skewness",
                "across", "along", "contrast", "homogeneity", "slope", "degrees", "anisotropy");
    int top = caption + gap;
    for (const entry& e : all) {
        int left = gap;
        for (const int degrees : grazing_angles) {
            const in::image<float> tile = shown(tile_of(e.seabed, e.cell, degrees, pool));
            paste(sheet, left, top, tile);
            const std::string view = std::to_string(degrees) + " deg";
            describe(e.name, view.c_str(), tile);
            examples::write_text(sheet, left + 2, top + tile_height + 3, std::string(e.name) + ", " + view, 1.0f);
            examples::draw_scale_bar(sheet, left + tile_width, top + tile_height, tile_width, tile_width * e.cell, 1.0f,
                                     0.1f);
            left += tile_width + gap;
        }
        if (const std::string path = real_path(e); !path.empty()) {
            const in::image<float> real = examples::read_gray(path);
            const in::image<float> cut(real.view().part(e.left, e.top, tile_width, tile_height));
            paste(sheet, left, top, cut);
            describe(e.real, "real", cut);
            examples::write_text(sheet, left + 2, top + tile_height + 3, "real: SASSED, NSWC Panama City", 1.0f);
        }
        top += tile_height + gap + caption;
    }
    in::write_png(out, sheet);
} catch (const std::exception& error) {
    std::fprintf(stderr, "seabed_gallery: %s\n", error.what());
    return 1;
}
