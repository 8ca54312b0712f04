// Numbers that cannot be right, in every field of poses, cameras, primitives and objects.
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

// Sizes are 0.0001 to 100000 metres, or bound by another member.
const std::vector<double> no_size{nan_value, infinity, -infinity, -1, 0, 2e5};
const std::vector<double> no_size_nor_none{nan_value, infinity, -infinity, -1, 2e5};
const std::vector<double> no_share = outside(0, 1);

}  // namespace

TEST_CASE("Each field of a camera is refused by name") {
    static_assert(members<in::camera>() == 6);
    walk<in::camera>("camera.", {}, [](const in::camera& c) { (void)in::camera_view(c); },
                     {{"eye", [](auto& o, double v) { o.eye.x = v; }, not_finite},
                      {"eye", [](auto& o, double v) { o.eye.z = v; }, not_finite},
                      {"target", [](auto& o, double v) { o.target.y = v; }, not_finite},
                      {"up", [](auto& o, double v) { o.up.x = v; }, not_finite},
                      FIELD(field_of_view, outside(0, 3.1416)),
                      FIELD(aspect, not_above_0),
                      FIELD(z_near, not_above_0)});
}

TEST_CASE("A map that is not finite, or flattens space, has no inverse") {
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
    walk<in::cube>("cube.", {}, built,
                   {{"size", [](auto& o, double v) { o.size.x = static_cast<float>(v); }, not_above_0},
                    {"size", [](auto& o, double v) { o.size.z = static_cast<float>(v); }, not_above_0}});
    walk<in::cylinder>(
        "", {}, built,
        {FIELD(radius, not_above_0), FIELD(length, not_above_0), FIELD(segments, outside_whole(3, 1 << 20))});
    walk<in::capsule>(
        "", {}, built,
        {FIELD(radius, not_above_0), FIELD(length, not_above_0), FIELD(segments, outside_whole(3, 8192))});
    walk<in::cone>("", {}, built,
                   {FIELD(radius, not_above_0), FIELD(height, not_above_0), FIELD(top_radius, below_0),
                    FIELD(segments, outside_whole(3, 1 << 20))});
    const auto ball = [](auto owner, const auto& good) {
        walk<std::remove_cvref_t<decltype(good)>>(
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
    walk<in::boulder>("boulder.", {}, built,
                      {{"size", [](auto& o, double v) { o.size.y = static_cast<float>(v); }, no_size},
                       FIELD(angularity, no_share),
                       FIELD(roughness, no_share),
                       FIELD(segments, outside_whole(2, 256))});
    walk<in::crate>("crate.", {}, built,
                    {{"size", [](auto& o, double v) { o.size.z = static_cast<float>(v); }, no_size},
                     FIELD(board, no_size),
                     FIELD(boards, outside_whole(1, 64)),
                     FIELD(gap, outside(0.01, 0.9)),
                     FIELD(damage, no_share)});
    walk<in::lobster_pot>("lobster_pot.", {}, built,
                          {FIELD(length, no_size), FIELD(width, no_size), FIELD(height, no_size), FIELD(bar, no_size),
                           FIELD(hoops, outside_whole(2, 16)), FIELD(mesh_size, no_size_nor_none),
                           FIELD(twine, no_size), FIELD(crushed, no_share), FIELD(segments, outside_whole(6, 256))});
    walk<in::open_pipe>(
        "open_pipe.", {}, built,
        {FIELD(diameter, no_size), FIELD(length, no_size), FIELD(wall, no_size), FIELD(flange, no_size_nor_none),
         FIELD(broken, no_size_nor_none), FIELD(segments, outside_whole(6, 8192))});
    walk<in::truncated_cone>("truncated_cone.", {}, built,
                             {FIELD(diameter, no_size), FIELD(top_diameter, no_size), FIELD(height, no_size),
                              FIELD(shoulder, no_size_nor_none), FIELD(boss_diameter, no_size_nor_none),
                              FIELD(boss_height, no_size_nor_none), FIELD(lugs, outside_whole(0, 8)),
                              FIELD(segments, outside_whole(6, 8192))});
    walk<in::tyre>("tyre.", {}, built,
                   {FIELD(diameter, no_size), FIELD(width, no_size), FIELD(rim_diameter, no_size), FIELD(wall, no_size),
                    FIELD(fill, no_share), FIELD(segments, outside_whole(6, 8192))});
    walk<in::wedge>("wedge.", {}, built,
                    {FIELD(length, no_size), FIELD(width, no_size), FIELD(height, no_size), FIELD(nose_height, no_size),
                     FIELD(nose_width, no_size), FIELD(tail_height, no_size), FIELD(ridge, no_size),
                     FIELD(side_slope, outside(0, 2))});
    static_assert(members<in::compound_part>() == 3);
    walk<in::compound_part>("compound_part.", {to_mesh(in::cube{}), {}, 1},
                            [](const in::compound_part& part) { (void)in::merge(in::compound{{part}}); },
                            {FIELD(reflectivity, below_0)});
}

TEST_CASE("Each field of a hull and of an aeroplane is refused by name") {
    const std::vector<double> no_angle = outside(-1.6, 1.6);
    walk<in::hull>(
        "hull.", {}, built,
        {FIELD(length, no_size), FIELD(beam, no_size), FIELD(depth, no_size), FIELD(bulwark, no_size_nor_none),
         FIELD(sheer, outside(0, 4)), FIELD(stern, {2, 9}), FIELD(plating, no_size),
         FIELD(house_length, outside(0, 0.5)), FIELD(house_position, outside(-0.35, 0.3)),
         FIELD(house_tiers, outside_whole(1, 4)), FIELD(hatches, outside_whole(0, 8)),
         FIELD(masts, outside_whole(0, 4)), FIELD(mast_height, no_size_nor_none), FIELD(break_gap, no_size_nor_none),
         FIELD(break_position, outside(-0.4, 0.4)), FIELD(break_yaw, no_angle), FIELD(break_roll, no_angle),
         FIELD(collapse, no_share), FIELD(segments, outside_whole(16, 1024))});
    walk<in::aeroplane>(
        "aeroplane.", {}, built,
        {FIELD(length, no_size), FIELD(span, no_size), FIELD(fuselage_diameter, no_size), FIELD(root_chord, no_size),
         FIELD(tip_chord, no_size), FIELD(sweep, outside(-0.5, 0.8)), FIELD(dihedral, outside(-0.2, 0.3)),
         FIELD(wing_position, outside(-0.1, 0.4)), FIELD(tail_span, no_size), FIELD(fin_height, no_size),
         FIELD(engines, outside_whole(0, 4)), FIELD(propeller_diameter, no_size_nor_none), FIELD(port_wing, no_share),
         FIELD(starboard_wing, no_share), FIELD(torn_off, no_size_nor_none), FIELD(tail_gap, no_size_nor_none),
         FIELD(tail_yaw, no_angle), FIELD(segments, outside_whole(8, 512))});
}
