// Each field of cameras, primitives and objects is refused by name where its value is out of range.
#include "../../refusals.hpp"

#include <insonify/geometry/camera.hpp>
#include <insonify/geometry/cone.hpp>
#include <insonify/geometry/cube.hpp>
#include <insonify/geometry/cylinder.hpp>
#include <insonify/geometry/objects/aeroplane.hpp>
#include <insonify/geometry/objects/boulder.hpp>
#include <insonify/geometry/objects/compound.hpp>
#include <insonify/geometry/objects/crate.hpp>
#include <insonify/geometry/objects/hull.hpp>
#include <insonify/geometry/objects/lobster_pot.hpp>
#include <insonify/geometry/objects/open_pipe.hpp>
#include <insonify/geometry/objects/truncated_cone.hpp>
#include <insonify/geometry/objects/tyre.hpp>
#include <insonify/geometry/objects/wedge.hpp>
#include <insonify/geometry/sphere.hpp>

namespace in = insonify;
using namespace refusals;

namespace {

const auto built = [](const auto& shape) { (void)to_mesh(shape); };

// Sizes are 0.0001 to 100000 metres, or limited by another member.
const std::vector<double> bad_size{nan_value, infinity, -infinity, -1, 0, 2e5};
const std::vector<double> bad_optional_size{nan_value, infinity, -infinity, -1, 2e5};
const std::vector<double> bad_fraction = outside(0, 1);

}  // namespace

TEST_CASE("Each field of a camera is refused by name") {
    static_assert(members<in::camera>() == 6);
    check_fields<in::camera>("camera.", {}, [](const in::camera& c) { (void)in::camera_view(c); },
                             {{"eye", [](auto& o, double v) { o.eye.x = v; }, not_finite},
                              {"eye", [](auto& o, double v) { o.eye.z = v; }, not_finite},
                              {"target", [](auto& o, double v) { o.target.y = v; }, not_finite},
                              {"up", [](auto& o, double v) { o.up.x = v; }, not_finite},
                              FIELD(field_of_view, outside(0, 3.1416)),
                              FIELD(aspect, not_above_0),
                              FIELD(z_near, not_above_0)});
}

TEST_CASE("inverse() refuses singular and non-finite maps") {
    for (const double value : {nan_value, infinity, 0.0}) {
        in::affine map;
        map.linear[1][1] = value;
        CHECK_THAT(refusal([&] { (void)in::inverse(map); }), ContainsSubstring("affine.linear"));
    }
    in::affine map;
    map.offset.y = nan_value;
    CHECK_THAT(refusal([&] { (void)in::inverse(map); }), ContainsSubstring("affine.offset"));
}

TEST_CASE("Each field of a primitive is refused by name") {
    static_assert(members<in::cylinder>() == 3 && members<in::capsule>() == 3 && members<in::cone>() == 4);
    static_assert(members<in::cube>() == 1 && members<in::sphere>() == 3 && members<in::hemisphere>() == 3);
    check_fields<in::cube>("cube.", {}, built,
                           {{"size", [](auto& o, double v) { o.size.x = static_cast<float>(v); }, not_above_0},
                            {"size", [](auto& o, double v) { o.size.z = static_cast<float>(v); }, not_above_0}});
    check_fields<in::cylinder>(
        "", {}, built,
        {FIELD(radius, not_above_0), FIELD(length, not_above_0), FIELD(segments, outside_whole(3, 1 << 20))});
    check_fields<in::capsule>(
        "", {}, built,
        {FIELD(radius, not_above_0), FIELD(length, not_above_0), FIELD(segments, outside_whole(3, 8192))});
    check_fields<in::cone>("", {}, built,
                           {FIELD(radius, not_above_0), FIELD(height, not_above_0), FIELD(top_radius, below_0),
                            FIELD(segments, outside_whole(3, 1 << 20))});
    const auto ball = [](auto owner, const auto& good) {
        check_fields<std::remove_cvref_t<decltype(good)>>(
            owner, good, built,
            {FIELD(radius, not_above_0),
             FIELD(segments, outside_whole(3, 8192)),
             {"aspect", [](auto& o, double v) { o.aspect.y = static_cast<float>(v); }, not_above_0}});
    };
    ball("sphere.", in::sphere{});
    ball("hemisphere.", in::hemisphere{});
}

TEST_CASE("Each field of a small object is refused by name") {
    static_assert(members<in::boulder>() == 5 && members<in::crate>() == 7 && members<in::lobster_pot>() == 9);
    static_assert(members<in::open_pipe>() == 7 && members<in::truncated_cone>() == 8 && members<in::tyre>() == 6);
    static_assert(members<in::wedge>() == 8);
    check_fields<in::boulder>("boulder.", {}, built,
                              {{"size", [](auto& o, double v) { o.size.y = static_cast<float>(v); }, bad_size},
                               FIELD(angularity, bad_fraction),
                               FIELD(roughness, bad_fraction),
                               FIELD(segments, outside_whole(2, 256))});
    check_fields<in::crate>("crate.", {}, built,
                            {{"size", [](auto& o, double v) { o.size.z = static_cast<float>(v); }, bad_size},
                             FIELD(board, bad_size),
                             FIELD(boards, outside_whole(1, 64)),
                             FIELD(gap, outside(0.01, 0.9)),
                             FIELD(damage, bad_fraction)});
    check_fields<in::lobster_pot>(
        "lobster_pot.", {}, built,
        {FIELD(length, bad_size), FIELD(width, bad_size), FIELD(height, bad_size), FIELD(bar, bad_size),
         FIELD(hoops, outside_whole(2, 16)), FIELD(mesh_size, bad_optional_size), FIELD(twine, bad_size),
         FIELD(crushed, bad_fraction), FIELD(segments, outside_whole(6, 256))});
    check_fields<in::open_pipe>(
        "open_pipe.", {}, built,
        {FIELD(diameter, bad_size), FIELD(length, bad_size), FIELD(wall, bad_size), FIELD(flange, bad_optional_size),
         FIELD(broken, bad_optional_size), FIELD(segments, outside_whole(6, 8192))});
    check_fields<in::truncated_cone>("truncated_cone.", {}, built,
                                     {FIELD(diameter, bad_size), FIELD(top_diameter, bad_size), FIELD(height, bad_size),
                                      FIELD(shoulder, bad_optional_size), FIELD(boss_diameter, bad_optional_size),
                                      FIELD(boss_height, bad_optional_size), FIELD(lugs, outside_whole(0, 8)),
                                      FIELD(segments, outside_whole(6, 8192))});
    check_fields<in::tyre>("tyre.", {}, built,
                           {FIELD(diameter, bad_size), FIELD(width, bad_size), FIELD(rim_diameter, bad_size),
                            FIELD(wall, bad_size), FIELD(fill, bad_fraction), FIELD(segments, outside_whole(6, 8192))});
    check_fields<in::wedge>("wedge.", {}, built,
                            {FIELD(length, bad_size), FIELD(width, bad_size), FIELD(height, bad_size),
                             FIELD(nose_height, bad_size), FIELD(nose_width, bad_size), FIELD(tail_height, bad_size),
                             FIELD(ridge, bad_size), FIELD(side_slope, outside(0, 2))});
    static_assert(members<in::compound_part>() == 3);
    check_fields<in::compound_part>("compound_part.", {to_mesh(in::cube{}), {}, 1},
                                    [](const in::compound_part& part) { (void)in::merge(in::compound{{part}}); },
                                    {FIELD(reflectivity, below_0)});
}

TEST_CASE("Each field of a hull and of an aeroplane is refused by name") {
    static_assert(members<in::hull>() == 21 && members<in::aeroplane>() == 20);
    const std::vector<double> bad_angle = outside(-1.6, 1.6);
    check_fields<in::hull>(
        "hull.", {}, built,
        {FIELD(length, bad_size), FIELD(beam, bad_size), FIELD(depth, bad_size), FIELD(bulwark, bad_optional_size),
         FIELD(sheer, outside(0, 4)), FIELD(stern, {2, 9}), FIELD(plating, bad_size),
         FIELD(house_length, outside(0, 0.5)), FIELD(house_position, outside(-0.35, 0.3)),
         FIELD(house_tiers, outside_whole(1, 4)), FIELD(hatches, outside_whole(0, 8)),
         FIELD(masts, outside_whole(0, 4)), FIELD(mast_height, bad_optional_size), FIELD(break_gap, bad_optional_size),
         FIELD(break_position, outside(-0.4, 0.4)), FIELD(break_yaw, bad_angle), FIELD(break_roll, bad_angle),
         FIELD(collapse, bad_fraction), FIELD(segments, outside_whole(16, 1024))});
    check_fields<in::aeroplane>(
        "aeroplane.", {}, built,
        {FIELD(length, bad_size), FIELD(span, bad_size), FIELD(fuselage_diameter, bad_size),
         FIELD(root_chord, bad_size), FIELD(tip_chord, bad_size), FIELD(sweep, outside(-0.5, 0.8)),
         FIELD(dihedral, outside(-0.2, 0.3)), FIELD(wing_position, outside(-0.1, 0.4)), FIELD(tail_span, bad_size),
         FIELD(fin_height, bad_size), FIELD(engines, outside_whole(0, 4)), FIELD(propeller_diameter, bad_optional_size),
         FIELD(port_wing, bad_fraction), FIELD(starboard_wing, bad_fraction), FIELD(torn_off, bad_optional_size),
         FIELD(tail_gap, bad_optional_size), FIELD(tail_yaw, bad_angle), FIELD(segments, outside_whole(8, 512))});
}
