// Compares rendered bottoms with real ones: seabed_textures [folder of real tiles]
//
// Prints statistics of bottoms in slant range, by kind, and the distance of their means from those of real crops of the
// kind, in standard deviations over the crops. Fails if one exceeds the kind's tolerance. The real tiles are
// tone-mapped synthetic-aperture images; grain, grazing angle and display below were fitted to them.
#include <insonify/insonify.hpp>
#include <insonify/sonar/bottom_tone.hpp>
#include <insonify/sonar/side_scan/water_column.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <string>

#include "../common/pictures.hpp"
#include "../common/usage.hpp"
#include "texture.hpp"

namespace in = insonify;
namespace sb = insonify::seabed;

namespace {

constexpr int width = 184, height = 128, seeds = 4;
constexpr double cell = 0.04;  // metres per pixel; that of the real tiles is not published
constexpr double slant = 20, grazing_degrees = 16;
constexpr in::display shown{.white = 3, .exponent = 0.4f};
constexpr float grain = 0.96f;  // pixels, of single looks

struct crop {
    const char* tile;
    int left, top;
};

struct kind {
    const char* name;
    double tolerance;  // standard deviations
    std::vector<crop> real;
    sb::any (*bottom)(std::uint32_t seed);
    float volume;  // echo from within the bottom
    float noise;   // intensity; a bottom of level gain has about 0.5
    in::bottom_tone tone;
};

sb::any ripples(std::uint32_t seed) {
    return sb::ripples{.wavelength = 1.35f, .steepness = 0.13f, .spread = 0.08f, .bandwidth = 0.09f, .seed = seed};
}
sb::any mud(std::uint32_t seed) {
    return sb::mud{.density = 0.05f, .seed = seed, .kind = sb::type::sandy_mud};
}
sb::any sand(std::uint32_t seed) {
    return sb::flat{.surface = {.rms = 0.012f, .longest = 1}, .seed = seed};
}
sb::any rock(std::uint32_t seed) {
    return sb::rock{.relief = 0.16f, .outcrop = 3, .block = 0.8f, .smallest = 0.2f, .steepness = 0.6f, .seed = seed};
}

/// Drift with streaks along the track, decibels.
in::bottom_tone tone_of(float drift, float streaks) {
    return {.drift = drift,
            .drift_length = 1,
            .streaks = streaks,
            .streak_width = 0.3f,
            .streak_length = 6,
            .direction = static_cast<float>(in::numeric::pi / 2)};
}

const kind kinds[] = {
    {"ripples",
     1,
     {{"00", 40, 10},
      {"00", 150, 180},
      {"08", 230, 10},
      {"08", 230, 230},
      {"28", 10, 40},
      {"28", 140, 230},
      {"25", 200, 230}},
     ripples,
     0.2f,
     0.08f,
     tone_of(0.5f, 0)},
    {"mud",
     1,
     {{"02", 200, 60}, {"02", 300, 220}, {"06", 190, 20}, {"10", 0, 180}, {"10", 150, 150}, {"06", 300, 200}},
     mud,
     0.5f,
     0.025f,
     tone_of(0.8f, 1)},
    {"sand",
     1,
     {{"14", 150, 190}, {"14", 100, 270}, {"14", 190, 80}, {"16", 180, 240}, {"19", 20, 200}},
     sand,
     0.3f,
     0.025f,
     tone_of(1, 0.4f)},
    // No tile shows bare rock; the roughest bottoms take its place.
    {"rock",
     1.5,
     {{"12", 10, 20}, {"08", 0, 20}, {"08", 0, 200}, {"04", 200, 20}, {"00", 0, 270}},
     rock,
     0.3f,
     0.08f,
     tone_of(1, 0)}};

in::image<float> rendered(const kind& k, std::uint32_t seed) {
    const double sine = in::numeric::sin_cos(in::numeric::to_radians(grazing_degrees)).sine, half = 0.5 * width * cell;
    in::scene scene;
    scene.seabed = k.bottom(seed);
    const in::side_scan rig{.altitude = static_cast<float>(slant * sine),
                            .ping_spacing = static_cast<float>(cell),
                            .pings = height,
                            .first_range = static_cast<float>(slant - half),
                            .range = static_cast<float>(slant + half),
                            .bins = width};
    const in::sonar_equation equation{in::pulse{0.03f}, in::horizontal_beam{0.0015f}, in::level_gain{}};
    const in::facet_backscatter echo{.facets = 0, .volume = k.volume};
    auto recording = in::render(scene, rig, in::record_options<>{}.with(echo).with(equation));

    in::bottom_tone tone = k.tone;
    tone.seed = seed;
    recording = in::with_tone(std::move(recording), rig, tone);
    recording.image = std::move(recording.image) | in::water_column{.first_range = rig.first_range,
                                                                    .bin = static_cast<float>(rig.bin()),
                                                                    .noise = k.noise,
                                                                    .noise_range = static_cast<float>(slant)};
    in::seabed_speckle speckle{.elsewhere = {.looks = 1}, .along_track = grain, .across_track = grain, .seed = seed};
    for (in::speckle_law& law : speckle.bottom) law = {.looks = 1};
    recording = in::with_speckle(std::move(recording), speckle);
    return std::move(recording.image) | shown;
}

constexpr const char* names[] = {"deviation", "skewness",    "kurtosis", "across",    "along",
                                 "contrast",  "homogeneity", "slope",    "anisotropy"};
using row = std::array<double, std::size(names)>;

row statistics_of(const in::image<float>& picture) {
    const gallery::texture t = gallery::texture_of(picture);
    return {t.deviation, t.skewness, t.kurtosis, t.across, t.along, t.contrast, t.homogeneity, t.slope, t.anisotropy};
}

struct spread {
    row mean{}, deviation{};
};

spread spread_of(const std::vector<row>& rows) {
    spread s;
    const auto n = static_cast<double>(rows.size());
    for (std::size_t i = 0; i < s.mean.size(); ++i) {
        for (const row& r : rows) s.mean[i] += r[i] / n;
        for (const row& r : rows) s.deviation[i] += (r[i] - s.mean[i]) * (r[i] - s.mean[i]) / (n - 1);
        s.deviation[i] = std::sqrt(s.deviation[i]);
    }
    return s;
}

void print(const char* name, const char* what, const row& values) {
    std::printf("%-8s %-9s", name, what);
    for (const double v : values) std::printf("%12.2f", v);
    std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) try {
    examples::check_arguments(argc, argv, 0, 1, "seabed_textures [folder of real tiles]");
    const std::string folder = argc > 1 ? argv[1] : EXAMPLES_REFERENCE "/sas_sassed";
    if (!std::filesystem::exists(folder)) return std::printf("no real tiles in %s\n", folder.c_str()), 77;
    std::printf("%-18s", "");
    for (const char* name : names) std::printf("%12s", name);
    std::printf("\n");
    int beyond = 0;
    for (const kind& k : kinds) {
        std::vector<row> ours, theirs;
        for (std::uint32_t seed = 1; seed <= seeds; ++seed) ours.push_back(statistics_of(rendered(k, seed)));
        for (const crop& c : k.real) {
            const in::image<float> tile = examples::read_gray(folder + "/sassed_" + c.tile + ".png");
            theirs.push_back(statistics_of(in::image<float>(tile.view().part(c.left, c.top, width, height))));
        }
        const spread made = spread_of(ours), real = spread_of(theirs);
        row away{};
        for (std::size_t i = 0; i < away.size(); ++i) {
            away[i] = (made.mean[i] - real.mean[i]) / real.deviation[i];
            if (!(std::fabs(away[i]) <= k.tolerance)) ++beyond;
        }
        print(k.name, "rendered", made.mean);
        print(k.name, "real", real.mean);
        print(k.name, "spread", real.deviation);
        print(k.name, "away", away);
    }
    std::printf("%d of %d statistics lie beyond the tolerance of their kind\n", beyond,
                static_cast<int>(std::size(kinds) * std::size(names)));
    return beyond > 0 ? 1 : 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "seabed_textures: %s\n", error.what());
    return 1;
}
