// Each field of seabeds, areas and edits is refused by name where its value is out of range.
#include "../../refusals.hpp"

#include <insonify/seabed/blend.hpp>
#include <insonify/seabed/detailed.hpp>
#include <insonify/seabed/mixed.hpp>
#include <insonify/seabed/models.hpp>
#include <insonify/seabed/sample.hpp>
#include <insonify/seabed/sculpt.hpp>
#include <insonify/seabed/tessellate.hpp>

namespace in = insonify;
namespace sb = insonify::seabed;
using namespace refusals;

namespace {

const auto prepare_any = [](const auto& model) { (void)sb::any(model).prepare(); };

constexpr double most = 1e6;  // metres

/// Rows for each coordinate of a member that is a position; messages name the member.
#define POSITION(member)                                                        \
    {#member, [](auto& o, double v) { o.member.x = v; }, outside(-1e9, 1e9)}, { \
#member, [](auto& o, double v) { o.member.y = v; }, outside(-1e9, 1e9)  \
    }

}  // namespace

TEST_CASE("Each field of a roughness is refused by name") {
    static_assert(members<sb::roughness>() == 4 && members<sb::flat>() == 3);
    check_fields<sb::roughness>("roughness.", {}, [](const sb::roughness& r) { prepare_any(sb::flat{.surface = r}); },
                                {FIELD(rms, outside(0, most)), FIELD(longest, outside(0, most)),
                                 FIELD(shortest, outside(1e-4, 1)), FIELD(exponent, outside(2, 4))});
}

TEST_CASE("Each field of ripples is refused by name") {
    static_assert(members<sb::ripples>() == 10 && members<sb::ripple_system>() == 6);
    check_fields<sb::ripples>(
        "ripples.", {}, prepare_any,
        {FIELD(wavelength, outside(1e-4, most)), FIELD(steepness, outside(0, 0.5)), FIELD(direction, not_an_angle),
         FIELD(spread, outside(0, 0.5)), FIELD(bandwidth, outside(0, 0.25)), FIELD(sharpness, outside(0, 0.9)),
         FIELD(second.wavelength, outside(1e-4, most)), FIELD(second.steepness, outside(0, 0.5)),
         FIELD(second.direction, not_an_angle), FIELD(second.spread, outside(0, 0.5)),
         FIELD(second.bandwidth, outside(0, 0.25)), FIELD(second.sharpness, outside(0, 0.9))});
}

TEST_CASE("Each field of mud, its trawl marks and rock is refused by name") {
    static_assert(members<sb::trawl_marks>() == 5);
    check_fields<sb::mud>(
        "mud.", {}, prepare_any,
        {FIELD(density, below_0), FIELD(size, outside(0, most)), FIELD(mound_height, outside(0, most)),
         FIELD(pock_depth, outside(0, most)), FIELD(pock_fraction, outside(0, 1))});
    check_fields<sb::trawl_marks>(
        "trawl_marks.", {.density = 0.05f}, [](const sb::trawl_marks& t) { prepare_any(sb::mud{.trawls = t}); },
        {FIELD(density, outside(0, 0.5)), FIELD(depth, outside(0, most)), FIELD(width, outside(0, most)),
         FIELD(directions, outside_whole(1, 8)), FIELD(length, outside(0, most))});
    check_fields<sb::rock>(
        "rock.", {}, prepare_any,
        {FIELD(relief, outside(0, most)), FIELD(outcrop, outside(1e-3, most)), FIELD(block, outside(0, most)),
         FIELD(smallest, outside(1e-3, 1.4)), FIELD(sizes, outside(0, 4)), FIELD(fracture, outside(0, 1)),
         FIELD(steepness, outside(0, most))});
}

TEST_CASE("Each field of blends, layers and areas is refused by name") {
    check_fields<sb::blend>(
        "blend.", {}, prepare_any,
        {FIELD(coverage, outside(0, 1)), FIELD(patch, outside(0, most)), FIELD(border, outside(1e-3, 12))});
    static_assert(members<sb::patches>() == 2 && members<sb::disc>() == 2 && members<sb::band>() == 2);
    static_assert(members<sb::polygon>() == 1);
    const auto within = [](const auto& area) { prepare_any(sb::mixed{.layers = {{.where = area}}}); };
    check_fields<sb::layer>("layer.", {}, [](const sb::layer& l) { prepare_any(sb::mixed{.layers = {l}}); },
                            {FIELD(border, outside(1e-3, most)), FIELD(ragged, outside(0, 1e5))});
    check_fields<sb::patches>("patches.", {}, within,
                              {FIELD(coverage, outside(0, 1)), FIELD(size, outside(0.6, most))});
    check_fields<sb::disc>("disc.", {}, within, {POSITION(centre), FIELD(radius, outside(0, 1e9))});
    check_fields<sb::band>("band.", {.path = {{0, 0}, {1, 1}}}, within,
                           {FIELD(width, outside(0, 1e9)),
                            {"path", [](auto& o, double v) { o.path[1].x = v; }, outside(-1e9, 1e9)},
                            {"path", [](auto& o, double v) { o.path[0].y = v; }, outside(-1e9, 1e9)}});
    check_fields<sb::polygon>("polygon.", {.corners = {{0, 0}, {1, 0}, {0, 1}}}, within,
                              {{"corners", [](auto& o, double v) { o.corners[2].y = v; }, outside(-1e9, 1e9)}});
    check_fields<sb::stencil>(
        "stencil.", {.coverage = in::image<float>(2, 2)}, within,
        {FIELD(spacing, outside(0, most)),
         FIELD(origin.x, outside(-1e9, 1e9)),
         FIELD(origin.y, outside(-1e9, 1e9)),
         {"coverage", [](auto& o, double v) { o.coverage(1, 1) = static_cast<float>(v); }, not_finite}});
    CHECK(refusal([] { prepare_any(sb::mixed{.layers = std::vector<sb::layer>(64)}); }) == "");
    CHECK_THAT(refusal([] { prepare_any(sb::mixed{.layers = std::vector<sb::layer>(65)}); }),
               ContainsSubstring("mixed.layers.size() is 65"));
    CHECK_THAT(refusal([&] { within(sb::band{}); }), ContainsSubstring("band.path"));
    CHECK_THAT(refusal([&] { within(sb::polygon{{{0, 0}, {1, 0}}}); }), ContainsSubstring("polygon.corners"));
    CHECK_THAT(refusal([&] { within(sb::stencil{}); }), ContainsSubstring("stencil.coverage"));
}

TEST_CASE("Each field of an edit is refused by name") {
    static_assert(members<sb::raise>() == 3 && members<sb::flatten>() == 3 && members<sb::smooth>() == 3);
    static_assert(members<sb::ramp>() == 5 && members<sb::heap>() == 4 && members<sb::moat>() == 6);
    const auto done = [](const auto& edit) { prepare_any(sb::sculpted{.edits = {edit}}); };
    const std::vector<double> height = outside(-most, most), size = outside(0, most);
    check_fields<sb::raise>("raise.", {}, done, {POSITION(centre), FIELD(radius, size), FIELD(height, height)});
    check_fields<sb::flatten>("flatten.", {}, done, {POSITION(centre), FIELD(radius, size), FIELD(level, height)});
    check_fields<sb::smooth>("smooth.", {}, done,
                             {POSITION(centre), FIELD(radius, size), FIELD(length, outside(1e-3, most))});
    check_fields<sb::ramp>(
        "ramp.", {}, done,
        {POSITION(from), POSITION(to), FIELD(width, size), FIELD(from_height, height), FIELD(to_height, height)});
    check_fields<sb::stamp>("stamp.", {.path = {{0, 0}}}, done,
                            {{"path", [](auto& o, double v) { o.path[0].x = v; }, not_finite},
                             FIELD(radius, size),
                             FIELD(height, height),
                             FIELD(every, size)});
    check_fields<sb::heap>(
        "heap.", {}, done,
        {POSITION(centre), FIELD(radius, size), FIELD(level, height), FIELD(slope, outside(1e-3, most))});
    check_fields<sb::moat>("moat.", {}, done,
                           {{"outline", [](auto& o, double v) { o.outline[1].y = v; }, not_finite},
                            FIELD(depth, size),
                            FIELD(width, size),
                            FIELD(current, not_an_angle),
                            FIELD(mound, size),
                            FIELD(tail, size)});
}

TEST_CASE("Each field of heightfields and grids is refused by name") {
    const sb::heightfield field{.heights = in::image<float>(3, 3)};
    const auto used = [](const sb::heightfield& h) {
        prepare_any(h);
        prepare_any(sb::detailed{.field = h});
        (void)sb::tessellate(h);
    };
    check_fields<sb::heightfield>(
        "heightfield.", field, used,
        {FIELD(origin.x, outside(-1e9, 1e9)), FIELD(origin.y, outside(-1e9, 1e9)), FIELD(spacing, outside(0, most))});
    CHECK_THAT(refusal([&] { used({.heights = in::image<float>(1, 3)}); }), ContainsSubstring("heights.width()"));
    for (const double value : not_above_0) {
        CHECK_THAT(refusal([&] { (void)sb::grid_over({0, 0}, {1, 1}, value); }), ContainsSubstring("spacing"));
        CHECK_THAT(refusal([&] { (void)sb::sample(sb::flat{}, {.spacing = value}); }), ContainsSubstring("spacing"));
    }
    for (const double value : outside(-1e9, 1e9)) {
        CHECK_THAT(refusal([&] { (void)sb::grid_over({0, value}, {1, 1}, 0.5); }), ContainsSubstring("low.y is"));
        CHECK_THAT(refusal([&] { (void)sb::grid_over({0, 0}, {value, 1}, 0.5); }), ContainsSubstring("high.x is"));
    }
    CHECK_THAT(refusal([] { (void)sb::grid_over({0, 2}, {1, 1}, 0.5); }), ContainsSubstring("high.y is 1"));
    CHECK_THAT(refusal([] {
                   (void)sb::sample(sb::mud{}, {.origin = {9e8, 0}, .spacing = 999999, .width = 200});
               }),
               ContainsSubstring("vertex (width - 1, height - 1).x is"));
}

TEST_CASE("A length refused for being too large names the limit") {
    CHECK(refusal([] {
              (void)sb::grid_over({0, 0}, {1, 1}, 1e6);
          }) == "spacing is 1e+06, expected metres above 0 and below 10^6");
    CHECK_THAT(refusal([] { prepare_any(sb::mud{.mound_height = 1e6f}); }), ContainsSubstring("below 10^6"));
    CHECK_THAT(refusal([] { prepare_any(sb::mud{.size = 2e6f}); }), ContainsSubstring("to 10^6"));
    CHECK_THAT(refusal([] { prepare_any(sb::mixed{.layers = {{.border = 1e6f}}}); }), ContainsSubstring("below 10^6"));
    const auto done = [](const auto& edit) { prepare_any(sb::sculpted{.edits = {edit}}); };
    CHECK_THAT(refusal([&] { done(sb::raise{.height = -1e6f}); }), ContainsSubstring("between -10^6 and 10^6"));
    CHECK_THAT(refusal([&] { done(sb::heap{.slope = 1e6f}); }), ContainsSubstring("below 10^6"));
}

TEST_CASE("at() refuses a position that is not within 1e9 metres") {
    struct position {
        double x = 0, y = 0;
    };
    for (const sb::any& bottom : {sb::any(sb::ripples{}), sb::any(sb::rock{}), sb::any(sb::flat{})})
        check_fields<position>("position.", {}, [&](const position& p) { (void)sb::at(bottom, p.x, p.y); },
                               {FIELD(x, outside(-1e9, 1e9)), FIELD(y, outside(-1e9, 1e9))});
}
