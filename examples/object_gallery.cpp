// Every built-in object as a side-scan sonar records it: object_gallery [objects.png]
//
// Slant range, starboard channel: the sonar is on the left, shadows fall to the right.
#include <insonify/core/thread_pool.hpp>
#include <insonify/geometry/objects/aeroplane.hpp>
#include <insonify/geometry/objects/boulder.hpp>
#include <insonify/geometry/objects/crate.hpp>
#include <insonify/geometry/objects/footprint.hpp>
#include <insonify/geometry/objects/hull.hpp>
#include <insonify/geometry/objects/lobster_pot.hpp>
#include <insonify/geometry/objects/open_pipe.hpp>
#include <insonify/geometry/objects/truncated_cone.hpp>
#include <insonify/geometry/objects/tyre.hpp>
#include <insonify/geometry/objects/wedge.hpp>
#include <insonify/insonify.hpp>
#include <insonify/io/png.hpp>
#include <insonify/seabed/sculpt.hpp>
#include <insonify/sonar/side_scan/recording.hpp>
#include <insonify/sonar/speckle.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/scale_bar.hpp"
#include "common/text.hpp"
#include "common/usage.hpp"

namespace in = insonify;
namespace sb = insonify::seabed;
using namespace in::literals;

namespace {

constexpr int tile = 208, gap = 4, caption = 14, columns = 5;

struct entry {
    const char* name;
    in::mesh shape;
    float degrees;       // of the object's x axis, from the direction of sound
    float across;        // metres that a tile shows
    float grazing = 14;  // degrees, in the middle of a tile
    in::pose placement{};
    float scour = 0;  // metres deep
};

in::image<float> tile_of(const entry& e, in::thread_pool& pool) {
    const double across = static_cast<double>(e.across), distance = 1.1 * across;
    in::pose placement = e.placement;
    placement.yaw += e.degrees * 1_deg;
    placement.position.x -= 0.15 * across;
    const sb::flat sand{.surface = sb::roughness_of(in::sediment::fine_sand), .kind = sb::type::sand};
    in::scene scene;
    scene.seabed = sand;
    if (e.scour > 0) {
        const float high = 0.8f * e.scour;
        scene.seabed = sb::sculpted{.ground = sand,
                                    .edits = {sb::moat{.outline = in::footprint(e.shape, placement, high),
                                                       .depth = e.scour,
                                                       .width = 5 * e.scour,
                                                       .current = 250_deg,
                                                       .mound = 0.7f * e.scour,
                                                       .tail = 0.35f * e.across}}};
    }
    scene.add(e.shape, in::rest_on(scene.seabed, e.shape, placement), e.name, {.reflectivity = 1.8f});

    const double altitude = distance * std::tan(static_cast<double>(e.grazing) * in::numeric::pi / 180);
    const auto slant = [&](double ground) { return static_cast<float>(std::hypot(ground, altitude)); };
    const in::side_scan rig{.position = {-distance, -0.5 * across},
                            .altitude = static_cast<float>(altitude),
                            .ping_spacing = e.across / tile,
                            .pings = tile,
                            .first_range = slant(distance - 0.5 * across),
                            .range = slant(distance + 0.5 * across),
                            .bins = tile};
    const auto recorded = in::render(scene, rig, in::record_options<in::labels, in::lambert_backscatter>{}, pool);
    in::seabed_speckle look{.seed = 5};
    for (in::speckle_law& law : look.bottom) law = {.looks = 4};
    look.elsewhere = {.looks = 3};
    return in::with_speckle(recorded, look, pool).image;
}

/// Gray values in decibels over 36 dB; white is 23 dB above the median. 32 levels keep the file short.
in::image<float> shown(in::image<float> intensity) {
    std::vector<float> sorted(intensity.pixels().begin(), intensity.pixels().end());
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    auto gray = std::move(intensity) | in::decibel_display{.white = 200 * std::max(*middle, 1e-12f), .range = 36};
    for (float& g : gray.pixels()) g = std::round(31 * g) / 31;
    return gray;
}

std::vector<entry> entries();

}  // namespace

int main(int argc, char** argv) try {
    examples::check_arguments(argc, argv, 0, 1, "object_gallery [objects.png]");
    const std::string out = argc > 1 ? argv[1] : "objects.png";
    in::thread_pool pool;
    const std::vector<entry> all = entries();
    const int rows = (static_cast<int>(all.size()) + columns - 1) / columns;
    constexpr in::rgb<std::uint8_t> ink{230, 230, 230}, paper{15, 15, 15};
    in::image<in::rgb<std::uint8_t>> sheet(columns * (tile + gap) + gap, caption + rows * (tile + gap + caption) + gap,
                                           paper);
    examples::write_text(sheet, gap + 2, 4, "slant range from left to right: the sonar is on the left", ink);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const int left = gap + static_cast<int>(i % columns) * (tile + gap);
        const int top = caption + gap + static_cast<int>(i / columns) * (tile + gap + caption);
        const auto colored = shown(tile_of(all[i], pool)) | in::colormap::copper;
        for (int y = 0; y < tile; ++y) std::copy_n(colored.row(y).begin(), tile, sheet.row(top + y).begin() + left);
        char text[96];
        std::snprintf(text, sizeof text, "%s, %.0f deg", all[i].name, static_cast<double>(all[i].degrees));
        examples::write_text(sheet, left + 2, top + tile + 3, text, ink);
        examples::draw_scale_bar(sheet, left + tile, top + tile, tile, static_cast<double>(all[i].across), ink, paper);
    }
    in::write_png(out, sheet);
} catch (const std::exception& error) {
    std::fprintf(stderr, "object_gallery: %s\n", error.what());
    return 1;
}

namespace {

std::vector<entry> entries() {
    using namespace insonify;
    const hull coaster;
    const hull trawler{.length = 25,
                       .beam = 6.8f,
                       .depth = 3.4f,
                       .stern = stern_type::transom,
                       .house_length = 0.26f,
                       .house_position = 0.12f,
                       .hatches = 2,
                       .masts = 1,
                       .mast_height = 7};
    const hull steamer{.length = 100,
                       .beam = 14.5f,
                       .depth = 7.5f,
                       .bulwark = 1.2f,
                       .sheer = 1.3f,
                       .plating = 0.2f,
                       .house_length = 0.16f,
                       .house_position = -0.02f,
                       .house_tiers = 3,
                       .hatches = 4,
                       .mast_height = 18};
    const auto with = [](auto object, auto change) {
        change(object);
        return to_mesh(object);
    };
    const aeroplane bomber;
    const aeroplane fighter{.length = 9.1f,
                            .span = 11.2f,
                            .fuselage_diameter = 1.15f,
                            .root_chord = 2.5f,
                            .tip_chord = 1.1f,
                            .wing_position = 0.16f,
                            .tail_span = 3.3f,
                            .fin_height = 1.2f,
                            .engines = 1,
                            .propeller_diameter = 3.2f};
    const aeroplane transport{.length = 28.6f,
                              .span = 35.8f,
                              .fuselage_diameter = 3.0f,
                              .root_chord = 5.2f,
                              .tip_chord = 1.9f,
                              .tail_span = 13.5f,
                              .fin_height = 4.2f,
                              .engines = 4,
                              .propeller_diameter = 4};
    // A compound: an anchor block of concrete with a chain of rings beside it.
    compound mooring;
    mooring.add(cube{.size = {1.4f, 1.4f, 0.6f}}, {.position = {0, 0, 0.3}}, 0.6f);
    for (int i = 0; i < 9; ++i)
        mooring.add(tyre{.diameter = 0.42f, .width = 0.1f, .rim_diameter = 0.2f, .wall = 0.03f},
                    {.position = {0.95 + 0.36 * i, 0.1 * i * i * 0.5, 0.05 + (i % 2 == 0 ? 0 : 0.16)},
                     .roll = i % 2 == 0 ? 0.0f : 80_deg});

    return {
        {"coaster", to_mesh(coaster), 90, 75},
        {"coaster", to_mesh(coaster), 35, 75, 20},
        {"coaster", to_mesh(coaster), 0, 75, 20},
        {"trawler", to_mesh(trawler), 120, 45, 20},
        {"cargo steamer", to_mesh(steamer), 70, 150},

        {"ship in two", with(coaster, [](hull& h) { h.break_gap = 8; }), 75, 75, 18, {}, 0.8f},
        {"decayed ship", with(coaster, [](hull& h) { h.collapse = 0.35f; }), 105, 75, 14, {}, 1},
        {"collapsed ship", with(coaster, [](hull& h) { h.collapse = 0.75f; }), 60, 75, 18},
        {"remains of a ship", with(coaster, [](hull& h) { h.collapse = 1; }), 80, 75, 14, {}, 0.6f},
        {"heeled over", with(coaster, [](hull& h) { h.masts = 0; }), 80, 75, 14, {.roll = -38_deg}},

        {"bomber", to_mesh(bomber), 60, 32, 24},
        {"bomber", to_mesh(bomber), 150, 32, 24},
        {"bomber", to_mesh(bomber), 90, 32, 24},
        {"fighter", to_mesh(fighter), 40, 18, 24},
        {"four engines", to_mesh(transport), 45, 56, 24},

        {"wing missing", with(bomber, [](aeroplane& a) { a.port_wing = 0.15f; }), 230, 32, 24},
        {"wings torn off",
         with(bomber, [](aeroplane& a) { a.port_wing = 0.45f, a.starboard_wing = 0.35f, a.torn_off = 3; }), 30, 36, 24},
        {"tail broken off", with(bomber, [](aeroplane& a) { a.tail_gap = 2.5f; }), 60, 32, 24},
        {"on its back", with(bomber, [](aeroplane& a) { a.is_inverted = true; }), 45, 32, 24},
        {"fighter, no wings", with(fighter, [](aeroplane& a) { a.port_wing = a.starboard_wing = 0; }), 70, 18, 20},

        {"truncated cone", to_mesh(truncated_cone{}), 0, 4},
        {"truncated cone, scour", to_mesh(truncated_cone{}), 0, 5, 14, {.burial = 0.1f}, 0.15f},
        {"wedge", to_mesh(wedge{}), 0, 4},
        {"wedge", to_mesh(wedge{}), 110, 4},
        {"mooring compound", to_mesh(mooring), 20, 8, 20},

        {"tyre", to_mesh(tyre{}), 0, 2.5f, 20},
        {"lorry tyre, filled",
         to_mesh(tyre{.diameter = 1.076f, .width = 0.315f, .rim_diameter = 0.572f, .wall = 0.02f, .fill = 0.7f}), 0, 4,
         20},
        {"pipe", to_mesh(open_pipe{}), 75, 20},
        {"culvert, broken", to_mesh(open_pipe{.diameter = 1, .length = 2.5f, .wall = 0.1f, .broken = 0.8f}), 210, 6},
        {"flanged pipe", to_mesh(open_pipe{.diameter = 0.5f, .length = 4, .wall = 0.03f, .flange = 0.12f}), 50, 7},

        {"rounded boulder", to_mesh(boulder{.angularity = 0.1f, .seed = 3}), 0, 5},
        {"angular boulder", to_mesh(boulder{.size = {2.2f, 1.7f, 1.3f}, .angularity = 0.8f, .seed = 4}), 20, 8},
        {"crate", to_mesh(crate{}), 30, 4, 20},
        {"open crate, damaged", to_mesh(crate{.is_open = true, .damage = 0.35f, .seed = 2}), 60, 4, 24},
        {"lobster pot", to_mesh(lobster_pot{}), 80, 3, 20},

        {"lobster pot, no net", to_mesh(lobster_pot{.mesh_size = 0}), 30, 3, 20},
        {"crushed pot", to_mesh(lobster_pot{.crushed = 0.6f}), 60, 3, 20},
        {"pipe, scour", to_mesh(open_pipe{}), 80, 20, 14, {.burial = 0.15f}, 0.25f},
        {"boulder, scour", to_mesh(boulder{.size = {2.2f, 1.7f, 1.3f}, .seed = 9}), 0, 12, 14, {}, 0.3f},
        {"bomber, scour", to_mesh(bomber), 120, 40, 20, {.burial = 0.3f}, 0.5f},
    };
}

}  // namespace
