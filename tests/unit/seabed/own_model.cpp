// Users' own seabeds: usable wherever the library's are, with labels of their own.
#include <insonify/geometry/cube.hpp>
#include <insonify/seabed/blend.hpp>
#include <insonify/seabed/mixed.hpp>
#include <insonify/seabed/sample.hpp>
#include <insonify/seabed/sculpt.hpp>
#include <insonify/sonar/occlusion.hpp>
#include <insonify/sonar/overhead/render.hpp>
#include <insonify/sonar/side_scan/swath.hpp>
#include <insonify/sonar/speckle.hpp>

#include <cmath>

#include "../../catch.hpp"

namespace in = insonify;
namespace sb = insonify::seabed;

namespace {

/// Unbounded long waves with a label, a reflectivity and a speckle of their own.
struct dunes {
    static constexpr sb::type_properties kind{sb::user_type(3), "dunes", 0.8f, {.looks = 4}};
    double height = 0.2;

    void row(const sb::scanline& line, std::span<float> heights) const {
        for (std::size_t i = 0; i < heights.size(); ++i)
            heights[i] = static_cast<float>(height * std::sin(0.9 * line.x(i) + 0.2 * line.y)) *
                         sb::band_limit_gain(6.8, line.grid_spacing);
    }
    sb::height_range range() const { return {-height, height}; }
};

/// A level sheet.
struct ice {
    static constexpr sb::type_properties kind{sb::user_type(0), "ice", 0.9f, {}};
    void row(const sb::scanline&, std::span<float> heights) const { std::fill(heights.begin(), heights.end(), 0.0f); }
    sb::height_range range() const { return {0, 0}; }
};

/// Two labels of its own, in stripes across the track.
struct stripes {
    void row(const sb::scanline& line, std::span<float> heights, std::span<sb::type> types) const {
        std::fill(heights.begin(), heights.end(), 0.0f);
        for (std::size_t i = 0; i < types.size(); ++i)
            types[i] = sb::user_type(in::numeric::floor_to_int(line.x(i)) & 1 ? 1 : 0);
    }
    sb::height_range range() const { return {0, 0}; }
    std::vector<sb::type_properties> legend() const {
        return {{sb::user_type(0), "dark", 0.1f, {}}, {sb::user_type(1), "bright", 0.9f, {}}};
    }
};

/// A user's model that forwards to the library's ripples.
struct own_ripples {
    sb::ripples source;
    sb::type kind = sb::type::ripples;
    sb::any_sampler prepare() const { return source.prepare(); }
};

/// An unbounded slope that states no range.
struct endless_slope {
    static constexpr sb::type kind = sb::type::rock;
    void row(const sb::scanline& line, std::span<float> heights) const {
        for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = static_cast<float>(0.01 * line.x(i));
    }
};

/// A plateau at a level that its range may not hold.
struct plateau {
    static constexpr sb::type kind = sb::type::sand;
    float level = 0;
    sb::height_range stated;
    void row(const sb::scanline&, std::span<float> heights) const { std::fill(heights.begin(), heights.end(), level); }
    sb::height_range range() const { return stated; }
};

static_assert(sb::model<dunes> && sb::model<stripes> && sb::model<own_ripples> && sb::model<endless_slope>);

const in::overhead rig{.position = {120, -40}, .size = {160, 120}, .grazing = in::literals::operator""_deg(8ull)};

}  // namespace

TEST_CASE("An own seabed is drawn without bounds, with its label, its reflectivity and its name in the legend") {
    in::scene s;
    s.seabed = dunes{};
    in::overhead from = rig;
    for (const double x : {120.0, 1e6}) {
        from.position.x = x;
        const auto frame = in::render(s, from);
        const auto label = static_cast<std::uint8_t>(sb::user_type(3));
        for (const std::uint8_t seabed : frame.labels.seabed.pixels()) REQUIRE(seabed == label);
        REQUIRE(frame.labels.legend.size() == 1);
        CHECK(frame.labels.legend[0] == dunes::kind);
        float lowest = 1, highest = 0;
        for (const float v : frame.image.pixels()) lowest = (std::min)(lowest, v), highest = (std::max)(highest, v);
        CHECK(lowest < 0.5f * highest);
    }
}

TEST_CASE("The reflectivity of an own label scales the picture; the scene's entry takes precedence") {
    in::scene s;
    const in::overhead dim{.size = {64, 64}, .intensity = 1};
    const auto mean = [&] {
        double sum = 0;
        const auto picture = in::render(s, dim, in::render_options<in::shadow::none>{});
        for (const float v : picture.image.pixels()) sum += static_cast<double>(v);
        return sum;
    };
    s.seabed = sb::flat{.surface = {.rms = 0}, .kind = sb::type::sand};
    const double sand = mean();
    s.seabed = ice{};
    CHECK(mean() == Approx(2 * sand).epsilon(1e-5));
    s.bottom[sb::index_of(sb::user_type(0))] = {0.45f};
    CHECK(mean() == Approx(sand).epsilon(1e-6));
    s.bottom[sb::index_of(sb::user_type(0))] = {-2};
    CHECK_THROWS_WITH(mean(), ContainsSubstring("scene.bottom[64].reflectivity is -2"));
}

namespace {

/// Level ground of any label and properties.
struct painted {
    sb::type_properties kind;
    void row(const sb::scanline&, std::span<float> heights) const { std::fill(heights.begin(), heights.end(), 0.0f); }
    sb::height_range range() const { return {0, 0}; }
};

}  // namespace

TEST_CASE("A label has one set of properties in a scene, and those of the library's labels are the library's") {
    in::scene s;
    const auto draw = [&](const sb::any& bottom) {
        s.seabed = bottom;
        in::render(s, in::overhead{.size = {8, 8}});
    };
    const painted dim{{sb::user_type(0), "dim", 0.2f}}, bright{{sb::user_type(0), "bright", 0.9f}},
        other{{sb::user_type(1), "bright", 0.9f}};
    CHECK_NOTHROW(draw(sb::blend{.first = dim, .second = other}));
    CHECK_NOTHROW(draw(sb::blend{.first = dim, .second = dim}));
    CHECK_THROWS_WITH(draw(sb::blend{.first = dim, .second = bright}),
                      ContainsSubstring("type_properties.label of 'bright' is 64"));
    CHECK_THROWS_WITH(draw(painted{{sb::type::sand, "bright sand", 0.9f}}), ContainsSubstring("user_type(n)"));
    CHECK_NOTHROW(draw(painted{sb::properties_of(sb::type::sand)}));
}

TEST_CASE("An own model of the same function gives the same bytes as the library's") {
    in::scene mine, theirs;
    theirs.seabed = sb::ripples{.seed = 5};
    mine.seabed = own_ripples{{.seed = 5}};
    const auto a = in::render(mine, rig), b = in::render(theirs, rig);
    CHECK(a.image == b.image);
    CHECK(a.labels.seabed == b.labels.seabed);
    CHECK(a.labels.shadow == b.labels.shadow);
    const in::side_scan swath{.pings = 40, .range = 20, .bins = 256};
    CHECK(in::render(mine, swath).image == in::render(theirs, swath).image);
}

TEST_CASE("Own labels reach side-scan pictures, and speckle takes their law from the legend") {
    in::scene s;
    s.seabed = sb::blend{.first = dunes{.height = 0}, .second = sb::flat{.surface = {.rms = 0}}, .coverage = 1};
    const in::side_scan swath{.ping_spacing = 0.2f, .pings = 200, .first_range = 12, .range = 20, .bins = 200};
    const auto quiet = in::render(s, swath);
    CHECK(quiet.labels.legend.size() == 2);
    CHECK(quiet.labels.seabed(100, 100) == static_cast<std::uint8_t>(sb::user_type(3)));
    const auto noisy = in::with_speckle(quiet, {.along_track = 0, .across_track = 0});
    double sum = 0, square = 0;
    for (std::size_t i = 0; i < noisy.image.size(); ++i) {
        const double v = static_cast<double>(noisy.image.pixels()[i]) / static_cast<double>(quiet.image.pixels()[i]);
        sum += v, square += v * v;
    }
    const double mean = sum / 40000;
    CHECK(mean == Approx(1).epsilon(0.02));
    CHECK(square / 40000 / mean / mean - 1 == Approx(0.25).epsilon(0.05));  // four looks
}

TEST_CASE("A seabed of several own labels writes one to each pixel") {
    in::scene s;
    s.seabed = stripes{};
    const auto frame = in::render(s, in::overhead{.altitude = 4, .size = {128, 128}});
    int dark = 0, bright = 0;
    for (const std::uint8_t t : frame.labels.seabed.pixels()) {
        dark += t == static_cast<std::uint8_t>(sb::user_type(0));
        bright += t == static_cast<std::uint8_t>(sb::user_type(1));
    }
    CHECK(dark + bright == 128 * 128);
    CHECK(dark > 4000);
    CHECK(bright > 4000);
    CHECK(frame.labels.legend.size() == 2);
}

TEST_CASE("Own seabeds are layered, sculpted and sampled, and carry targets, as the library's do") {
    const sb::mixed bed{.base = stripes{}, .layers = {{dunes{}, sb::disc{{0, 0}, 5}}}};
    CHECK(sb::at(bed, 0, 0).kind == sb::user_type(3));
    CHECK(sb::at(bed, 30.5, 0).kind == sb::user_type(0));
    CHECK(bed.legend().size() == 3);
    const sb::sculpted levelled{.ground = dunes{}, .edits = {sb::flatten{.centre = {0, 0}, .radius = 2, .level = 1}}};
    CHECK(sb::at(levelled, 0, 0).height == Approx(1));
    CHECK(sb::at(levelled, 0, 0).kind == sb::user_type(3));
    const auto field = sb::sample(dunes{}, {.width = 8, .height = 8});
    CHECK(field.fallback == sb::user_type(3));
    REQUIRE(field.user_types.size() == 1);
    CHECK(sb::any(field).legend()[0].name == "dunes");
    in::scene s;
    s.seabed = dunes{};
    const auto pose = in::rest_on(s.seabed, to_mesh(in::cube{.size = {0.01f, 0.01f, 0.01f}}), {.position = {1, 2, 9}});
    CHECK(pose.position.z == Approx(0.2 * std::sin(1.3) + 0.005).margin(2e-3));
}

TEST_CASE("A seabed without a range is drawn in range modes and refused by overhead pictures") {
    in::scene s;
    s.seabed = endless_slope{};
    CHECK_NOTHROW(in::render(s, in::side_scan{.pings = 4, .range = 20, .bins = 64}));
    CHECK_THROWS_WITH(in::render(s, in::overhead{.size = {8, 8}}), ContainsSubstring("range() of the seabed is inf"));
    const double infinity = std::numeric_limits<double>::infinity(), none = std::numeric_limits<double>::quiet_NaN();
    s.seabed = plateau{0, {-infinity, 0}};
    CHECK_THROWS_WITH(in::render(s, in::overhead{.size = {8, 8}}), ContainsSubstring("range() of the seabed is -inf"));
    s.seabed = plateau{0, {none, none}};
    CHECK_THROWS_WITH(in::render(s, in::overhead{.size = {8, 8}}), ContainsSubstring("range() of the seabed is nan"));
}

TEST_CASE("A seabed that leaves the range that it states is refused") {
    const in::shadow::directional_light sun{.elevation = 0.3};
    const auto draw = [](const plateau& p) {
        in::scene s;
        s.seabed = p;
        in::render(s, in::overhead{.size = {8, 8}});
    };
    const auto occlude = [&](const plateau& p) {
        in::scene s;
        s.seabed = p;
        in::occlusion_of(s, sun, {.box = {{-1, -1, -1}, {1, 1, 1}}});
    };
    const auto record = [](const plateau& p) {
        in::scene s;
        s.seabed = p;
        in::render(s, in::side_scan{.altitude = 12, .pings = 4, .range = 20, .bins = 64});
    };
    for (const plateau& beyond : {plateau{0.5f, {-0.2, 0.2}}, plateau{-0.5f, {-0.2, 0.2}}, plateau{0.5f, {}}}) {
        CHECK_THROWS_WITH(draw(beyond), ContainsSubstring("a height of the seabed is " +
                                                          std::string(beyond.level < 0 ? "-" : "") + "0.5"));
        CHECK_THROWS_WITH(occlude(beyond), ContainsSubstring("expected heights within its range()"));
        CHECK_THROWS_WITH(record(beyond), ContainsSubstring("expected heights within its range()"));
    }
    for (const float level : {0.0f, 9.0f})  // below a range that is above the datum
        CHECK_THROWS_WITH(record({level, {10, 11}}), ContainsSubstring("its range(), 10 to 11"));
    const float infinite = std::numeric_limits<float>::infinity();
    CHECK_THROWS_WITH(draw({infinite, {-0.2, 0.2}}), ContainsSubstring("a height of the seabed is inf"));
    CHECK_THROWS_WITH(record({infinite, {-0.2, 0.2}}), ContainsSubstring("a height of the seabed is inf"));
    CHECK_THROWS_WITH(draw({0.5f, {-0.2, 0.25}}),
                      "a height of the seabed is 0.5, expected heights within its range(), -0.2 to 0.25");
    // Whose ends are exchanged: without heights in view, too.
    CHECK_THROWS_WITH(draw({0.5f, {1, 0}}), "range().lowest of the seabed is 1, expected at most range().highest, 0");
    CHECK_THROWS_WITH(draw({0, {1, 0}}), ContainsSubstring("range().lowest of the seabed is 1"));
    CHECK_THROWS_WITH(occlude({0, {1, 0}}), ContainsSubstring("range().lowest of the seabed is 1"));
    CHECK_NOTHROW(draw({0.3f, {-0.3, 0.3}}));  // float holds 0.3 a little above
    CHECK_NOTHROW(occlude({0.3f, {-0.3, 0.3}}));
    CHECK_NOTHROW(record({0.3f, {-0.3, 0.3}}));
}

TEST_CASE("A picture of a bottom so far below that it has too many vertices is refused before memory is taken") {
    in::scene s;
    s.seabed = plateau{-1000, {-1000, -1000}};
    CHECK_THROWS_WITH(in::render(s, in::overhead{.altitude = 4, .size = {512, 512}}),
                      ContainsSubstring("expected at most 2^28; bring `overhead.altitude` and the seabed's range()"));
    s.seabed = sb::flat{};
    CHECK_THROWS_WITH(in::render(s, in::overhead{.altitude = 1e30f, .size = {8, 8}}), ContainsSubstring("cell is"));
}

TEST_CASE("An own label that a seabed writes but does not list is refused: it would be drawn as sand") {
    struct unlisted : stripes {
        std::vector<sb::type_properties> legend() const { return {stripes::legend().front()}; }
    };
    constexpr auto said = "a label of the seabed is 65, expected one of the library's or one that its legend() lists";
    in::scene s;
    s.seabed = unlisted{};
    CHECK_THROWS_WITH(in::render(s, in::overhead{.size = {8, 8}}), said);
    CHECK_THROWS_WITH(in::render(s, in::side_scan{.pings = 4, .range = 20, .bins = 64}), said);
    CHECK_THROWS_WITH(sb::sample(unlisted{}, sb::grid{.spacing = 1, .width = 8, .height = 8}), said);
    struct contradictory : stripes {
        std::vector<sb::type_properties> legend() const {
            auto all = stripes::legend();
            all.push_back({sb::user_type(0), "pale", 0.7f, {}});
            return all;
        }
    };
    s.seabed = contradictory{};
    CHECK_THROWS_WITH(in::render(s, in::overhead{.size = {8, 8}}),
                      "type_properties.label of 'pale' is 64, expected another label: this is that of 'dark', with "
                      "other properties");
    s.seabed = sb::blend{.first = sb::mud{}, .second = stripes{}};
    CHECK_NOTHROW(in::render(s, in::overhead{.size = {8, 8}}));
}

TEST_CASE("`any` shares its model, returns it by type, and keeps it alive for samplers") {
    sb::any_sampler prepared;
    {
        sb::heightfield field{.heights = in::image<float>(4, 4, 2.0f)};
        const sb::any first = field, second = first;
        CHECK(first.get_if<sb::heightfield>() == second.get_if<sb::heightfield>());
        CHECK(first.get_if<sb::flat>() == nullptr);
        prepared = second.prepare();
    }
    CHECK(sb::at(prepared, 1, 1).height == 2);
    CHECK(sb::any().empty());
    CHECK(sb::any(sb::none{}).empty());
    CHECK(std::isnan(sb::at(sb::any(), 0, 0).height));
}

TEST_CASE("The registry has one row per label, and own labels begin at 64") {
    for (std::size_t i = 0; i < sb::built_in_types.size(); ++i) {
        CHECK(sb::index_of(sb::built_in_types[i].label) == i);
        for (std::size_t j = 0; j < i; ++j) CHECK(sb::built_in_types[i].name != sb::built_in_types[j].name);
    }
    CHECK(sb::index_of(sb::user_type(0)) == 64);
    CHECK(sb::index_of(sb::user_type(190)) == 254);
    CHECK_THROWS_AS(sb::user_type(191), in::invalid_input);
    CHECK_THROWS_AS(sb::user_type(-1), in::invalid_input);
}
