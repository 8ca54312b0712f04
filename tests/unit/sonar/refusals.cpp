// Each field of scenes, rigs, pings, equations, lights, looks and options is refused by name where its value is out of
// range.
#include "../../refusals.hpp"

#include <insonify/all.hpp>

#include <initializer_list>
#include <span>

namespace in = insonify;
using namespace refusals;

namespace {

in::scene small_scene() {
    in::scene s;
    s.seabed = in::seabed::flat{.surface = {.rms = 0}};
    s.add(in::cube{}, {.position = {0, 0, 0.5}}, "cube");
    return s;
}
constexpr in::overhead small_rig{.altitude = 4, .size = {8, 6}};
const in::side_scan small_side_scan{.altitude = 4, .ping_spacing = 0.5f, .pings = 2, .range = 8, .bins = 8};
const std::initializer_list<field<in::speckle_law>> speckle_fields{FIELD(looks, outside_whole(1, 64)),
                                                                   FIELD(texture, {nan_value, infinity, -1, 0.001}),
                                                                   FIELD(steady, outside(0, 1e6))};

}  // namespace

TEST_CASE("render() refuses each field of an overhead rig by name") {
    static_assert(members<in::overhead>() == 11);
    const auto use = [](const in::overhead& rig) { (void)in::render(small_scene(), rig); };
    check_fields<in::overhead>(
        "overhead.", small_rig, use,
        {FIELD(position.x, not_finite), FIELD(position.y, not_finite), FIELD(altitude, not_above_0),
         FIELD(yaw, not_an_angle), FIELD(field_of_view, outside(0, 3.1399)), FIELD(size.x, outside_whole(1, 32768)),
         FIELD(size.y, outside_whole(1, 32768)), FIELD(grazing, outside(0, 1.571)), FIELD(light_azimuth, not_an_angle),
         FIELD(light_distance, {nan_value, -infinity, -1, 0, 1.1e15}), FIELD(intensity, below_0), FIELD(sky, below_0),
         FIELD(ambient, below_0)});
}

TEST_CASE("render() and record() refuse each field of a side-scan rig by name") {
    static_assert(members<in::side_scan>() == 9);
    const auto rendered = [](const auto& rig) { (void)in::render(small_scene(), rig); };
    const auto recorded = [](const auto& rig) {
        const in::ping track[2]{};
        (void)in::record(small_scene(), track, rig);
    };
    const std::initializer_list<field<in::side_scan>> fields{
        FIELD(position.x, not_finite), FIELD(position.y, not_finite),    FIELD(altitude, not_finite),
        FIELD(yaw, not_an_angle),      FIELD(ping_spacing, not_above_0), FIELD(pings, outside_whole(1, 1 << 20)),
        FIELD(first_range, below_0),   FIELD(range, outside(0, 1e5)),    FIELD(bins, outside_whole(1, 1 << 20)),
        FIELD(side, {2, 255})};
    check_fields("side_scan.", small_side_scan, rendered, fields);
    check_fields("side_scan.", small_side_scan, recorded, fields);
    check_fields<in::ground_range>(
        "ground_range.", {.altitude = 4, .ping_spacing = 0.5f, .pings = 2, .range = 8, .bins = 8}, rendered,
        {FIELD(position.y, not_finite), FIELD(yaw, not_an_angle), FIELD(bins, outside_whole(1, 1 << 20))});
}

TEST_CASE("record() refuses each field of a ping by name") {
    static_assert(members<in::ping>() == 4);
    const auto use = [](const in::ping& p) { (void)in::record(small_scene(), std::span(&p, 1), small_side_scan); };
    check_fields<in::ping>("track[0].", {}, use,
                           {FIELD(position.x, not_finite), FIELD(position.y, not_finite), FIELD(position.z, not_finite),
                            FIELD(yaw, not_an_angle), FIELD(pitch, outside(-1.397, 1.397)), FIELD(roll, not_an_angle)});
}

TEST_CASE("Every view of a scene refuses each field of a pose and a material by name") {
    static_assert(members<in::pose>() == 6 && members<in::material>() == 1 && members<in::target>() == 4);
    const std::initializer_list<field<in::pose>> pose{FIELD(position.x, not_finite), FIELD(position.y, not_finite),
                                                      FIELD(position.z, not_finite), FIELD(yaw, not_an_angle),
                                                      FIELD(pitch, not_an_angle),    FIELD(roll, not_an_angle),
                                                      FIELD(scale, not_above_0),     FIELD(burial, not_finite)};
    const auto view = GENERATE(0, 1, 2);
    const auto seen = [&](const in::scene& s) {
        if (view == 0) (void)in::render(s, small_rig);
        if (view == 1) (void)in::render(s, small_side_scan);
        if (view == 2) (void)in::occlusion_of(s, in::light_of(small_rig), {.box = {{-1, -1, 0}, {1, 1, 1}}});
    };
    in::scene s = small_scene();
    check_fields<in::pose>(
        "scene.targets[0].placement.", {},
        [&](const in::pose& p) {
            s.targets[0].placement = p;
            seen(s);
        },
        pose);
    check_fields<in::pose>(
        "pose.", {}, [&](const in::pose& p) { (void)in::rest_on(s.seabed, to_mesh(in::cube{}), p); }, pose);
    s = small_scene();
    check_fields<in::material>("scene.targets[0].surface.", {},
                               [&](const in::material& m) {
                                   s.targets[0].surface = m;
                                   seen(s);
                               },
                               {FIELD(reflectivity, below_0)});
    s = small_scene();
    check_fields<in::material>("scene.bottom[3].", {},
                               [&](const in::material& m) {
                                   s.bottom[3] = m;
                                   seen(s);
                               },
                               {FIELD(reflectivity, {nan_value, infinity, -infinity, -2})});
}

TEST_CASE("Each field of a seabed's own properties is refused by name") {
    static_assert(members<in::seabed::type_properties>() == 4 && members<in::speckle_law>() == 3);
    struct shelf {
        in::seabed::type_properties kind{in::seabed::user_type(0), "shelf"};
        struct sampler {
            void row(const in::seabed::scanline&, std::span<float> heights) const {
                std::fill(heights.begin(), heights.end(), 0.0f);
            }
            in::seabed::height_range range() const { return {0, 0}; }
        };
        sampler prepare() const { return {}; }
    };
    in::scene s = small_scene();
    const in::seabed::type_properties good{in::seabed::user_type(0), "shelf"};
    check_fields<in::seabed::type_properties>("type_properties.", good,
                                              [&](const in::seabed::type_properties& kind) {
                                                  s.seabed = shelf{kind};
                                                  (void)in::render(s, small_rig);
                                              },
                                              {FIELD(reflectivity, below_0), FIELD(label, {0, 3})});
    check_fields<in::speckle_law>(
        "speckle_law.", {},
        [&](const in::speckle_law& law) {
            in::seabed::type_properties kind = good;
            kind.speckle = law;
            s.seabed = shelf{kind};
            (void)in::with_speckle(in::render(s, small_side_scan));
        },
        speckle_fields);
}

TEST_CASE("record() refuses each field of a sonar equation by name") {
    static_assert(members<in::source_level>() == 1 && members<in::absorption>() == 1 && members<in::pulse>() == 1);
    static_assert(members<in::vertical_beam>() == 3 && members<in::horizontal_beam>() == 1);
    static_assert(members<in::noise_floor>() == 1 && members<in::time_varied_gain>() == 3);
    static_assert(members<in::level_gain>() == 1 && members<in::spreading_loss>() == 0);
    const auto use = [](const auto& part) {
        (void)in::render(small_scene(), small_side_scan, in::record_options<>{}.with(in::sonar_equation{part}));
    };
    check_fields<in::source_level>("source_level.", {}, use, {FIELD(decibels, outside(-300, 300))});
    check_fields<in::absorption>("absorption.", {}, use, {FIELD(decibels_per_km, outside(0, 3000))});
    const std::vector<double> no_beamwidth{nan_value, infinity, -infinity, -1, 0, 6.3};
    check_fields<in::vertical_beam>(
        "vertical_beam.", {}, use,
        {FIELD(beamwidth, no_beamwidth), FIELD(tilt, outside(-in::numeric::pi, in::numeric::pi)),
         FIELD(side_lobes, below_0)});
    check_fields<in::horizontal_beam>("horizontal_beam.", {}, use, {FIELD(beamwidth, no_beamwidth)});
    check_fields<in::pulse>("pulse.", {}, use, {FIELD(length, below_0)});
    check_fields<in::noise_floor>("noise_floor.", {}, use, {FIELD(intensity, below_0)});
    check_fields<in::time_varied_gain>("time_varied_gain.", {}, use,
                                       {FIELD(spreading, outside(0, 60)), FIELD(absorption_per_km, outside(0, 3000)),
                                        FIELD(decibels, outside(-300, 300))});
    check_fields<in::level_gain>("level_gain.", {}, use, {FIELD(steepest, outside(0, 1.5708))});
}

TEST_CASE("Both sonars refuse a backscatter law that is negative or not finite at some angle") {
    for (const float wrong : {-1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        const auto law = [=](float s) { return s > 0.7f && s < 0.75f ? wrong : s; };
        const auto message = ContainsSubstring("law(0.703125) is " + in::detail::to_text(wrong) + ", expected finite");
        CHECK_THROWS_WITH(in::render(small_scene(), small_rig, in::render_options<>{}.with(law)), message);
        CHECK_THROWS_WITH(in::render(small_scene(), small_side_scan, in::record_options<>{}.with(law)), message);
    }
}

TEST_CASE("Both sonars refuse each field of a backscatter law by name") {
    static_assert(members<in::facet_backscatter>() == 3);
    const std::initializer_list<field<in::facet_backscatter>> fields{FIELD(facets, below_0), FIELD(slope, not_above_0),
                                                                     FIELD(volume, below_0)};
    check_fields<in::facet_backscatter>(
        "facet_backscatter.", {},
        [](const in::facet_backscatter& law) {
            (void)in::render(small_scene(), small_rig, in::render_options<>{}.with(law));
        },
        fields);
    check_fields<in::facet_backscatter>(
        "facet_backscatter.", {},
        [](const in::facet_backscatter& law) {
            (void)in::render(small_scene(), small_side_scan, in::record_options<>{}.with(law));
        },
        fields);
}

TEST_CASE("Options of pictures and recordings are refused by name") {
    static_assert(members<in::render_options<>>() == 7 && members<in::record_options<>>() == 3);
    for (const bool has_bottom : {true, false})
        check_fields<in::render_options<>>(
            "", {},
            [&](const in::render_options<>& o) {
                in::scene s = small_scene();
                if (!has_bottom) s.seabed = in::seabed::none{};
                (void)in::render(s, small_rig, o);
                (void)in::visible_triangles(s, small_rig, o);
            },
            {FIELD(cell, below_0), FIELD(reach, below_0), FIELD(subpixel_bits, outside_whole(4, 16)),
             FIELD(tile, {0, -1, 4, 24, 512})});
    for (const bool has_bottom : {true, false})
        check_fields<in::record_options<>>("", {},
                                           [&](const in::record_options<>& o) {
                                               in::scene s = small_scene();
                                               if (!has_bottom) s.seabed = in::seabed::none{};
                                               (void)in::render(s, small_side_scan, o);
                                           },
                                           {FIELD(cell, {nan_value, infinity, -infinity, -1, 1e-300, 1e-9, 1e-6})});
}

TEST_CASE("Shadow policies refuse each field by name") {
    static_assert(members<in::shadow::map>() == 2 && members<in::shadow::pcf>() == 3);
    static_assert(members<in::shadow::penumbra>() == 2 && members<in::shadow::exact>() == 0);
    const auto use = [](const auto& policy) {
        (void)in::render(small_scene(), small_rig, in::render_options<>{}.with(policy));
    };
    check_fields<in::shadow::map>("", {}, use,
                                  {FIELD(texels_per_pixel, not_above_0), FIELD(largest, outside_whole(1, 32768))});
    check_fields<in::shadow::pcf>("", {}, use,
                                  {FIELD(texels_per_pixel, not_above_0), FIELD(largest, outside_whole(1, 32768)),
                                   FIELD(radius, outside_whole(0, 8))});
    check_fields<in::shadow::penumbra>("", {}, use,
                                       {FIELD(diameter, outside(0, 1)), FIELD(samples, outside_whole(1, 1024))});
}

TEST_CASE("Lights and the bounds of occlusion are refused by name") {
    static_assert(members<in::shadow::directional_light>() == 2 && members<in::shadow::point_light>() == 1);
    static_assert(members<in::occlusion_bounds>() == 3);
    const in::occlusion_bounds around{.box = {{-1, -1, 0}, {1, 1, 1}}};
    const auto under = [&](const auto& light) { (void)in::occlusion_of(small_scene(), light, around); };
    check_fields<in::shadow::directional_light>("", {}, under,
                                                {FIELD(azimuth, not_an_angle), FIELD(elevation, outside(0, 1.571))});
    check_fields<in::shadow::point_light>("point_light.", {{3, 2, 4}}, under,
                                          {{"position", [](auto& o, double v) { o.position.x = v; }, not_finite},
                                           {"position", [](auto& o, double v) { o.position.y = v; }, not_finite},
                                           {"position", [](auto& o, double v) { o.position.z = v; }, not_finite}});
    check_fields<in::occlusion_bounds>(
        "occlusion_bounds.", around,
        [](const in::occlusion_bounds& b) { (void)in::occlusion_of(small_scene(), in::light_of(small_rig), b); },
        {{"box", [](auto& o, double v) { o.box.lower.x = v; }, not_finite},
         {"box", [](auto& o, double v) { o.box.upper.z = v; }, not_finite},
         FIELD(cell, {nan_value, infinity, -infinity, -1, 1e300}),
         FIELD(reach, {nan_value, infinity, -infinity, -1, 1e300})});
    for (const double tiny : {1e-9, 1e-300})
        CHECK_THROWS_WITH(in::occlusion_of(small_scene(), in::light_of(small_rig), {.box = around.box, .cell = tiny}),
                          ContainsSubstring("enlarge `occlusion_bounds.cell`"));
}

TEST_CASE("with_speckle() refuses each field of a speckle by name") {
    static_assert(members<in::seabed_speckle>() == 6);
    const auto heard = in::render(small_scene(), small_side_scan);
    const auto use = [&](const in::seabed_speckle& s) { (void)in::with_speckle(heard, s); };
    check_fields<in::seabed_speckle>("seabed_speckle.", {}, use,
                                     {FIELD(along_track, outside(0, 16)), FIELD(across_track, outside(0, 16)),
                                      FIELD(texture_length, outside(1, 1024))});
    check_fields<in::speckle_law>(
        "speckle_law.", {}, [&](const in::speckle_law& l) { use({.elsewhere = l}); }, speckle_fields);
    check_fields<in::speckle_law>(
        "speckle_law.", {},
        [&](const in::speckle_law& l) {
            in::seabed_speckle s;
            s.bottom[0] = l;
            use(s);
        },
        speckle_fields);
    const auto refused = [&](in::ping_numbers rows) {
        return refusal([&] {
            (void)in::with_speckle(heard.image.view(), heard.labels.seabed.view(), in::seabed_speckle{}, rows);
        });
    };
    CHECK_THAT(refused({.step = 2}), ContainsSubstring("ping_numbers.step"));
    CHECK_THAT(refused({.first = std::numeric_limits<std::int64_t>::max()}), ContainsSubstring("ping_numbers.first"));
    const auto both = in::render_swath(small_scene(), small_side_scan);
    for (const int columns : {-1, 17}) {
        auto bad = both;
        bad.rows.port_columns = columns;
        CHECK_THAT(refusal([&] { (void)in::with_speckle(bad); }), ContainsSubstring("rows.port_columns"));
    }
    auto unlabelled = both;
    unlabelled.labels.seabed = in::image<std::uint8_t>(16, 1);
    CHECK_THAT(refusal([&] { (void)in::with_speckle(unlabelled); }), ContainsSubstring("labels.seabed.size() is 16"));
    unlabelled.labels.seabed = {};
    CHECK_THAT(refusal([&] { (void)in::with_speckle(unlabelled); }), ContainsSubstring("labels.seabed.size() is 0"));
}

TEST_CASE("A gap between two pictures leaves room for their columns") {
    const in::image<float> picture(6, 4);
    CHECK(in::side_by_side(picture, picture, 3).width() == 15);
    for (const int gap : {-1, std::numeric_limits<int>::max(), std::numeric_limits<int>::max() - 11})
        CHECK_THROWS_WITH(in::side_by_side(picture, picture, gap), ContainsSubstring("gap is"));
}

TEST_CASE("Filters of recordings refuse each field by name") {
    const in::image<float> heard(6, 4, 0.5f);
    const auto use = [&](const auto& filter) { (void)(heard | filter); };
    static_assert(members<in::range_gain_error>() == 4 && members<in::ping_banding>() == 6);
    check_fields<in::range_gain_error>(
        "range_gain_error.", {}, use,
        {FIELD(rms, outside(0, 60)), FIELD(length, outside(1, 1e9)), FIELD(slope, outside(-60, 60))});
    check_fields<in::ping_banding>("ping_banding.", {}, use,
                                   {FIELD(drift, outside(0, 60)), FIELD(length, outside(1, 1e9)),
                                    FIELD(jitter, outside(0, 60)), FIELD(step, {0, 2, -2})});
    CHECK_THAT(refusal([&] { use(in::ping_banding{.first_ping = (std::int64_t{1} << 61) + 1}); }),
               ContainsSubstring("ping_banding.first_ping"));
    static_assert(members<in::water_column>() == 13);
    check_fields<in::water_column>(
        "water_column.", {}, use,
        {FIELD(first_range, below_0), FIELD(bin, not_above_0), FIELD(noise, below_0), FIELD(noise_range, not_above_0),
         FIELD(spreading, outside(0, 60)), FIELD(absorption_per_km, outside(0, 3000)), FIELD(volume, below_0),
         FIELD(surface, below_0), FIELD(surface_range, not_above_0), FIELD(surface_tail, not_above_0),
         FIELD(waves, below_0), FIELD(wave_length, outside(1, 1e9))});
    static_assert(members<in::display>() == 2 && members<in::decibel_display>() == 2);
    static_assert(members<in::automatic_display>() == 3);
    check_fields<in::display>("display.", {}, use, {FIELD(white, not_above_0), FIELD(exponent, outside(0, 4))});
    check_fields<in::decibel_display>("decibel_display.", {}, use,
                                      {FIELD(white, not_above_0), FIELD(range, outside(0, 400))});
    check_fields<in::automatic_display>(
        "automatic_display.", {}, use,
        {FIELD(scale, {3, 99}), FIELD(black_fraction, outside(0, 0.49)), FIELD(white_fraction, outside(0, 0.49))});
}

TEST_CASE("with_tone() refuses each field of a tone by name") {
    static_assert(members<in::bottom_tone>() == 11);
    const auto heard = in::render(small_scene(), small_side_scan);
    check_fields<in::bottom_tone>(
        "bottom_tone.", {.drift = 1, .streaks = 1, .patches = 1},
        [&](const in::bottom_tone& t) { (void)in::with_tone(heard, small_side_scan, t); },
        {FIELD(drift, outside(0, 30)), FIELD(drift_length, outside(0, 1e9)), FIELD(octaves, outside_whole(1, 8)),
         FIELD(streaks, outside(0, 30)), FIELD(streak_width, outside(0, 1e9)), FIELD(streak_length, outside(0, 1e9)),
         FIELD(direction, not_an_angle), FIELD(patches, outside(-30, 30)), FIELD(patch_size, outside(0, 1e9)),
         FIELD(patch_coverage, outside(0.01, 0.99))});
    check_fields<in::side_scan>(
        "side_scan.", small_side_scan, [&](const in::side_scan& rig) { (void)in::with_tone(heard, rig, {.drift = 1}); },
        {FIELD(altitude, not_finite), FIELD(ping_spacing, not_above_0), FIELD(range, outside(0, 1e5))});
    CHECK_THAT(refusal([&] { (void)in::level_of({}, {nan_value, 0}); }), ContainsSubstring("position.x"));
    CHECK_THAT(refusal([&] { (void)in::level_of({}, {0, infinity}); }), ContainsSubstring("position.y"));
}

TEST_CASE("to_ground_range() refuses rigs and altitudes by name") {
    const auto heard = in::render(small_scene(), small_side_scan);
    const in::ground_range to{.altitude = 4, .pings = 2, .range = 8, .bins = 8};
    const std::initializer_list<field<in::side_scan>> fields{FIELD(altitude, not_finite), FIELD(first_range, below_0),
                                                             FIELD(range, outside(0, 1e5))};
    check_fields(
        "side_scan.", small_side_scan, [&](const in::side_scan& from) { (void)in::to_ground_range(heard, from, to); },
        fields);
    check_fields<in::ground_range>(
        "ground_range.", to,
        [&](const in::ground_range& rig) { (void)in::to_ground_range(heard, small_side_scan, rig); },
        {FIELD(altitude, not_finite), FIELD(first_range, below_0), FIELD(range, outside(0, 1e5))});
    for (const double value : not_finite) {
        const double altitudes[2]{4, value};
        CHECK_THAT(refusal([&] { (void)in::to_ground_range(heard, small_side_scan, to, altitudes); }),
                   ContainsSubstring("altitudes"));
    }
}

TEST_CASE("settings_for() refuses budgets and probes by name") {
    static_assert(members<in::accuracy::budget>() == 4 && members<in::accuracy::probe>() == 4);
    const in::seabed::any bottom = small_scene().seabed;
    const auto use = [&](const in::accuracy::budget& b, const in::accuracy::probe& how) {
        (void)in::accuracy::settings_for(b, bottom, small_rig, how);
    };
    check_fields<in::accuracy::budget>("budget.", {}, [&](const auto& b) { use(b, {.chips = 1, .pixels = 8}); },
                                       {FIELD(shadow_edge, {nan_value, -1, 0}), FIELD(silhouette, {nan_value, -1, 0}),
                                        FIELD(height, {nan_value, -1, 0}), FIELD(intensity, {nan_value, -1, 0})});
    check_fields<in::accuracy::probe>("probe.", {.chips = 1, .pixels = 8}, [&](const auto& p) { use({}, p); },
                                      {FIELD(chips, outside_whole(1, 1024)), FIELD(pixels, outside_whole(1, 2048)),
                                       FIELD(finest, outside(1, 8)), FIELD(usable_fraction, outside(0, 1))});
}

TEST_CASE("An overhead camera below the lowest seabed height is refused (a wrong datum)") {
    in::scene s;
    s.seabed =
        in::seabed::heightfield{.heights = in::image<float>(40, 40, 42.0f), .origin = {-10, -10}, .spacing = 0.5};
    CHECK_THROWS_WITH(in::render(s, in::overhead{.altitude = 5, .size = {8, 8}}),
                      ContainsSubstring("overhead.altitude is 5, expected above the seabed's lowest height, 42"));
    CHECK_NOTHROW(in::render(s, in::overhead{.altitude = 47, .size = {8, 8}}));
}
