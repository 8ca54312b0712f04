// The library behind the playground page (page.html): one function that draws a scene, compiled to WebAssembly.
// tools/playground builds docs/playground/index.html from the two.
#include <string>

extern "C" [[noreturn]] void playground_fail(const char* message);  // throws a JavaScript error
#define INSONIFY_THROW(error) playground_fail((error).what())

#include <insonify/geometry/objects/boulder.hpp>
#include <insonify/geometry/objects/lobster_pot.hpp>
#include <insonify/geometry/objects/truncated_cone.hpp>
#include <insonify/geometry/objects/tyre.hpp>
#include <insonify/insonify.hpp>
#include <insonify/seabed/blend.hpp>
#include <insonify/sonar/side_scan/recording.hpp>
#include <insonify/sonar/speckle.hpp>

#include <cstdint>

namespace in = insonify;
using namespace in::literals;

namespace {

enum mode { overhead, slant_range, ground_range };
enum overlay { nothing, targets, shadows, bottom_types };

struct settings {
    int mode, bottom, target, look, overlay;
    int size, seed;
    float altitude, grazing, yaw, burial, speckle;  // metres, degrees, degrees, fraction of the height, looks
};

/// Metres that the picture shows across track.
float width_of(const settings& s) {
    return s.mode == overhead ? 2 * s.altitude * 1.2f : 4 * s.altitude;
}

in::seabed::any bottom_of(const settings& s) {
    const auto seed = static_cast<std::uint64_t>(s.seed);
    switch (s.bottom) {
        case 0: return in::seabed::flat{.seed = seed};
        case 1: return in::seabed::ripples{.wavelength = 0.6f, .steepness = 0.1f, .direction = 0.5f, .seed = seed};
        case 2: return in::seabed::mud{.seed = seed};
        case 3: return in::seabed::rock{.relief = 0.3f, .outcrop = 3, .block = 0.8f, .seed = seed};
        default:
            return in::seabed::blend{.first = in::seabed::ripples{.steepness = 0.1f, .seed = seed},
                                     .second = in::seabed::mud{.seed = seed}};
    }
}

void add_target(in::scene& scene, const settings& s, glm::dvec2 at) {
    const auto put = [&](const auto& shape, const char* name) {
        in::pose where{.position = {at.x, at.y, 0}, .yaw = s.yaw * 1_deg, .burial = s.burial};
        const in::mesh m = to_mesh(shape);
        scene.add(m, in::rest_on(scene.seabed, m, where), name);
    };
    switch (s.target) {
        case 1: put(in::cylinder{.radius = 0.27f, .length = 2.0f}, "cylinder"); break;
        case 2: put(in::truncated_cone{}, "truncated cone"); break;
        case 3: put(in::cube{.size = glm::vec3(0.8f)}, "cube"); break;
        case 4: put(in::sphere{.radius = 0.4f}, "sphere"); break;
        case 5: put(in::tyre{}, "tyre"); break;
        case 6: put(in::lobster_pot{}, "lobster pot"); break;
        case 7: put(in::boulder{}, "boulder"); break;
        default: break;
    }
}

/// Applies the colour map that the page selects.
in::image<in::rgb8> shown(const in::image<float>& gray, int look) {
    return look == 0 ? gray | in::colormap::copper : look == 1 ? gray | in::colormap::gray : gray | in::colormap::sea;
}

void paint_labels(in::image<in::rgb8>& picture, const in::labels& labels, int overlay) {
    const auto tint = [&](std::size_t i, in::rgb8 c) {
        in::rgb8& p = picture.pixels()[i];
        const auto half = [](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>((a + b) / 2); };
        p = {half(p.r, c.r), half(p.g, c.g), half(p.b, c.b)};
    };
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const bool is_target = labels.instance.pixels()[i] != in::labels::no_instance;
        const std::uint16_t shadow = labels.shadow.pixels()[i];
        if (is_target) tint(i, {255, 64, 64});
        if (overlay == shadows && !is_target && shadow != in::labels::no_shadow) tint(i, {64, 128, 255});
        if (overlay == bottom_types && !is_target && labels.seabed.pixels()[i] == 1) tint(i, {64, 220, 120});
    }
}

std::vector<std::uint8_t> pixels;

}  // namespace

extern "C" {

/// @param list  the members of `settings`, in their order
/// @return size x size pixels, RGBA
const std::uint8_t* draw(const double* list) {
    const auto whole = [&](int i) { return static_cast<int>(list[i]); };
    const auto real = [&](int i) { return static_cast<float>(list[i]); };
    const settings s{whole(0), whole(1), whole(2), whole(3), whole(4), whole(5),
                     whole(6), real(7),  real(8),  real(9),  real(10), real(11)};
    const auto seed = static_cast<std::uint64_t>(s.seed);
    in::scene scene;
    scene.seabed = bottom_of(s);
    const float width = width_of(s);

    in::image<float> gray;
    in::labels labels;
    if (s.mode == overhead) {
        add_target(scene, s, {-0.17 * static_cast<double>(width), 0});
        auto frame = in::render(scene, {.altitude = s.altitude,
                                        .field_of_view = static_cast<float>(2 * in::numeric::atan2(1.2, 1.0)),
                                        .size = {s.size, s.size},
                                        .grazing = s.grazing * 1_deg});
        gray = s.speckle > 0
                   ? frame.image | in::gamma_speckle{.looks = s.speckle, .of = in::echo::intensity, .seed = seed}
                   : frame.image;
        labels = std::move(frame.labels);
    } else {
        add_target(scene, s, {static_cast<double>(width) / 3, 0.5 * static_cast<double>(width)});
        const auto hear = [&](auto rig) {
            rig.altitude = s.altitude;
            rig.range = width;
            rig.bins = rig.pings = s.size;
            rig.ping_spacing = width / static_cast<float>(s.size);
            auto recording = in::render(scene, rig);
            if (s.speckle > 0) recording = in::with_speckle(std::move(recording), {.seed = seed});
            gray = recording.image | in::display{};
            labels = std::move(recording.labels);
        };
        if (s.mode == slant_range)
            hear(in::side_scan{});
        else
            hear(in::ground_range{});
    }
    in::image<in::rgb8> picture = shown(gray, s.look);
    if (s.overlay != nothing) paint_labels(picture, labels, s.overlay);
    pixels.resize(4 * picture.size());
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const in::rgb8& p = picture.pixels()[i];
        const std::uint8_t rgba[] = {p.r, p.g, p.b, 255};
        std::copy(rgba, rgba + 4, pixels.begin() + static_cast<std::ptrdiff_t>(4 * i));
    }
    return pixels.data();
}

}  // extern "C"
