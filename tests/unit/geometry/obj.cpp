// OBJ import: accepted syntax, refused input, and triangulation of polygons.
#include <insonify/geometry/obj.hpp>
#include <insonify/geometry/topology.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <limits>
#include <string>

#include <glm/geometric.hpp>

#include "../../catch.hpp"

#if defined(__linux__)
#include <malloc.h>
#endif

namespace in = insonify;

namespace {

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::string refusal(std::string_view text) {
    try {
        in::read_obj(text, "a.obj");
    } catch (const in::io_error& e) {
        return e.what();
    }
    return "accepted";
}

glm::dvec3 area_of(const in::mesh& m) {
    glm::dvec3 sum(0);
    for (const glm::uvec3& t : m.triangles) {
        const glm::dvec3 a = m.positions[t.x];
        sum += 0.5 * glm::cross(glm::dvec3(m.positions[t.y]) - a, glm::dvec3(m.positions[t.z]) - a);
    }
    return sum;
}
double absolute_area_of(const in::mesh& m) {
    double sum = 0;
    for (const glm::uvec3& t : m.triangles) {
        const glm::dvec3 a = m.positions[t.x];
        sum += 0.5 * glm::length(glm::cross(glm::dvec3(m.positions[t.y]) - a, glm::dvec3(m.positions[t.z]) - a));
    }
    return sum;
}

// A polygon in the xy plane as OBJ text, tilted so that no coordinate plane is special.
template <class Point>
std::string polygon(int corners, Point point) {
    std::string text, face = "f";
    for (int i = 0; i < corners; ++i) {
        const glm::dvec2 p = point(i);
        text += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(0.5 * p.x - 0.25 * p.y) +
                "\n";
        face += " " + std::to_string(i + 1);
    }
    return text + face + "\n";
}
glm::dvec2 on_circle(int i, int count, double radius) {
    const double angle = 2 * in::numeric::pi * i / count;
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Ratio of processor times for texts of four times the size and of the size: about 4 if time is linear, 16 if it is
/// quadratic. Each is the minimum of three runs, so that other load does not count. Freed memory stays in the process,
/// since on virtual machines fresh pages cost more than parsing.
template <class Text>
double growth_of_time(const Text& text_of_size, int size) {
#if defined(__GLIBC__)
    ::mallopt(M_MMAP_THRESHOLD, 1 << 30);
    ::mallopt(M_TRIM_THRESHOLD, (std::numeric_limits<int>::max)());
#endif
    const auto fastest_of_three = [](const std::string& text) {
        std::clock_t ticks = std::numeric_limits<std::clock_t>::max();
        for (int i = 0; i < 3; ++i) {
            const std::clock_t start = std::clock();
            in::read_obj(text);
            ticks = std::min(ticks, std::clock() - start);
        }
        return static_cast<double>(ticks);
    };
    return fastest_of_three(text_of_size(4 * size)) / fastest_of_three(text_of_size(size));
}

std::string reference_directory() {
    if (const char* from_environment = std::getenv("INSONIFY_REFERENCE_DIR")) return from_environment;
#if defined(INSONIFY_REFERENCE_DIR)
    return INSONIFY_REFERENCE_DIR;
#else
    return "../shared/reference";
#endif
}

}  // namespace

TEST_CASE("A face is read the same in every spelling of its indices and lines") {
    const std::string face =
        GENERATE("f 1 2 3", "f -4 -3 -2", "f 1/7 2/8 3/9", "f 1/ 2/ 3/", "f 1// 2// 3//", "f 1/1/ 2/1/ 3/1/",
                 "f 1 2 3\r\n", "f\t1  2 \t3 \n", "f 1 2 3 # 4", "f 1 2 3#4", "f 1 \\\n2 3", "f 1 2\\\r\n 3",
                 "f 1 2 3\n\n\n", "f 1 2 3\r", "  f 1 2 3\nusemtl C:\\steel\\new", "f 1 2 3\n\xC3\xA9t\xC3\xA9 1 2\n");
    CAPTURE(face);
    const in::mesh m = in::read_obj(square + face);
    REQUIRE(m.triangles.size() == 1);
    CHECK(m.triangles[0] == glm::uvec3(0, 1, 2));
    CHECK(m.positions == std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
    CHECK(m.normals == std::vector<glm::vec3>(3, {0, 0, 1}));
}

TEST_CASE("Convex polygons with straight corners have no triangle without area, and normals of their own face") {
    const in::mesh wall = in::read_obj("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 0 2\nv 0 0 2\nf 1 2 3 4 5\n");
    REQUIRE(wall.triangles.size() == 3);
    CHECK(wall.normals == std::vector<glm::vec3>(5, {0, -1, 0}));
}

TEST_CASE("Numbers are read without the locale, at any length; coordinates past the third are ignored") {
    const in::mesh m = in::read_obj(
        "\xEF\xBB\xBFv +1.5 -2e-3 .25 0.5 0.5 0.5\nv 0.123456789012345678901234567890123 1E2 1. nonsense\n"
        "v 0 0 1e-60\nf 1 2 3");
    CHECK(m.positions ==
          std::vector<glm::vec3>{{1.5f, -2e-3f, 0.25f}, {0.12345678901234567f, 100.0f, 1.0f}, {0, 0, 0}});
}

TEST_CASE("Lines of other kinds are skipped, and unused positions are dropped") {
    // The case of assimp PR 1654: a line element before the face.
    const in::mesh m = in::read_obj("o 1\nv 0 0 0\nv 9 9 9\nv 1 1 1\nv 2 2 2\nl 1\np 1\ncurv2 1 2\nf 1 3 4");
    CHECK(m.positions.size() == 3);
    CHECK(m.triangles.size() == 1);
}

TEST_CASE("A text without a face is refused, and a file name among them points at load_obj") {
    const std::string text = GENERATE("", "# nothing", "v 1 2 3", "\\", "\\\n\\\r\n\\\r", "l 1 2\n", "P5 1 1 255\n0");
    CAPTURE(text);
    CHECK(refusal(text) == "a.obj: the text has no face, expected at least one line such as 'f 1 2 3'");
    const std::string path = GENERATE("spot.obj", "meshes/My Ship.OBJ", "C:\\meshes\\spot.obj ");
    CAPTURE(path);
    CHECK_THROWS_WITH(in::read_obj(path), ContainsSubstring("OBJ text: ") && ContainsSubstring("is a file name") &&
                                              ContainsSubstring("load_obj"));
    CHECK(refusal(std::string("\xFF\xFEv\0 \0", 6)) == "a.obj: the text is UTF-16: save it as UTF-8");
    CHECK(refusal(std::string("\xFE\xFF\0v\0 ", 6)) == "a.obj: the text is UTF-16: save it as UTF-8");
    // Several lines are a text, whatever the last one ends in.
    CHECK_THROWS_WITH(in::read_obj("# from\n# ship.obj"), ContainsSubstring("has no face"));
}

TEST_CASE("Each pair of position and normal is one vertex; missing and zero normals are computed") {
    const std::string normals = "vn 0 0 2\nvn 1 0 0\nvn 0 0 0\n";
    const in::mesh m = in::read_obj(square + normals + "f 1//1 2//1 3//1\nf 1//2 3//1 4//3\nf 1 3 4");
    CHECK(m.positions.size() == 8);  // 1//1 1//2 1, 2//1, 3//1 3, 4//3 4
    CHECK(m.normals[m.triangles[0].x] == glm::vec3(0, 0, 1));
    CHECK(m.normals[m.triangles[1].x] == glm::vec3(1, 0, 0));
    CHECK(m.normals[m.triangles[1].z] == glm::vec3(0, 0, 1));
    CHECK(m.normals[m.triangles[2].x] == glm::vec3(0, 0, 1));
    CHECK(m.triangles[0].z == m.triangles[1].y);
    CHECK(m.triangles[0].x != m.triangles[1].x);
    CHECK_NOTHROW(in::validate(m));
    // Alternating normals at one position make two vertices.
    CHECK(in::read_obj(square + normals + "f 1//1 2 3\nf 1//2 2 3\nf 1//1 3 4\nf 1//2 3 4").positions.size() == 5);
}

TEST_CASE("Texture coordinates divide a position along a seam, where its normal stays one") {
    const std::string coordinates = "vt 0.1 0\nvt 1 0\nvt 1 1 0.5\nvt 0.5\n", bent = "v 0 0 1\n";
    const std::string faces = "f 1/1 2/2 3/3\nf 1/4 3/3 4\nf 1/-1/ 4 5\n";
    const in::textured_mesh m = in::read_textured_obj(square + bent + coordinates + faces);
    const auto texture = [&](std::size_t t, int corner) { return m.texture_coordinates[m.shape.triangles[t][corner]]; };
    CHECK(m.texture_coordinates.size() == 6);  // 1/1 1/4, 2/2, 3/3, 4, 5
    CHECK(m.shape.positions.size() == 6);
    CHECK(texture(0, 0) == glm::vec2(0.1f, 0));
    CHECK(texture(0, 2) == glm::vec2(1, 1));
    CHECK(texture(1, 0) == glm::vec2(0.5f, 0));
    CHECK(texture(1, 2) == glm::vec2(0, 0));
    CHECK(m.shape.triangles[1].x == m.shape.triangles[2].x);

    const in::mesh plain = in::read_obj(square + bent + faces);
    CHECK(plain.positions.size() == 5);
    for (std::size_t t = 0; t < 3; ++t)
        for (int i = 0; i < 3; ++i) {
            CHECK(m.shape.positions[m.shape.triangles[t][i]] == plain.positions[plain.triangles[t][i]]);
            CHECK(m.shape.normals[m.shape.triangles[t][i]] == plain.normals[plain.triangles[t][i]]);
        }
    // Normals and texture coordinates divide independently.
    CHECK(in::read_textured_obj(square + coordinates + "vn 1 0 0\nvn 0 1 0\nf 1/1/1 2 3\nf 1/2/1 2 3\nf 1/1/2 2 3")
              .texture_coordinates.size() == 5);
}

TEST_CASE("Malformed texture coordinates are refused where they are read") {
    const std::string text = GENERATE("vt\nf 1 2 3", "vt x\nf 1 2 3", "vt 0 inf\nf 1 2 3", "f 1/1 2 3",
                                      "vt 0 0\nf 1/2 2 3", "vt 0 0\nf 1/0 2 3", "vt 0 0\nf 1/x 2 3");
    CAPTURE(text);
    CHECK_THROWS_WITH(in::read_textured_obj(square + text, "b.obj"), ContainsSubstring("b.obj:"));
    CHECK_NOTHROW(in::read_obj(square + text));
}

TEST_CASE("Malformed input is refused with the name of the text and the line") {
    CHECK(refusal("v 0 0 0\nv 1 1\n") == "a.obj:2: a vertex or normal has fewer than 3 numbers");
    CHECK(refusal("vn 0 0 x") == "a.obj:1: 'x' is not a number");
    CHECK(refusal(square + "f 1 2\n") == "a.obj:5: a face has 2 corners, expected at least 3");
    CHECK(refusal(square + "f 0 1 2").rfind("a.obj:5: position index '0' is none of 1 to 4", 0) == 0);
    CHECK_THROWS_AS(in::read_obj("f 1 2 3"), in::io_error);

    const std::string face = GENERATE(
        "f", "f 1", "f 1 2 5", "f -5 1 2", "f 1 2 0", "f 1 2 -0", "f 1 2 x", "f 1 2 3x", "f 1 2 3.0", "f 1//1 2 3",
        "f 1/1/1 2 3", "f 1//0 2 3", "f / 2 3", "f //1 2 3", "f 1 2 +3", "f 1/2/3/4 2 3", "f 1 2 99999999999999999999",
        "f 1 2 -9223372036854775808", "f 1 2 4294967297", "f 5 6 7\nv 1 2 3\nv 4 5 6\nv 7 8 9", "f 1 2 \xFF");
    CAPTURE(face);
    CHECK_THROWS_WITH(in::read_obj(square + face, "b.obj"), ContainsSubstring("b.obj:5: "));
}

TEST_CASE("Coordinates must be finite numbers that a float can hold") {
    const std::string number = GENERATE("nan", "NaN", "inf", "-inf", "infinity", "1e999", "-1e999", "1e39", "1,5",
                                        "0x10", "--1", "+-1", "1e", "e5", "+", "-", ".", "1.2.3");
    CAPTURE(number);
    CHECK_THROWS_AS(in::read_obj("v 0 0 " + number), in::io_error);
    CHECK_THROWS_AS(in::read_obj("vn " + number + " 0 0\n"), in::io_error);
    // Numbers too small for one are 0.
    for (const char* const tiny : {"1e-46", "-1e-400", "1E-999"})
        CHECK(in::read_obj("v 0 0 " + std::string(tiny) + "\nv 1 0 0\nv 0 1 0\nf 1 2 3").positions[0].z == 0);
}

TEST_CASE("An origin is subtracted from positions before they are rounded to float") {
    const glm::dvec3 origin{449000.25, 5411000.125, -31.5};
    // Steps of 1 cm, which a float at 5411 km can't hold.
    const std::string text =
        "v 449000.25 5411000.125 -31.5\nv 449000.26 5411000.125 -31.5\nv 449000.26 5411000.135 -31.49\n"
        "vt 0.25 0.75\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1";
    const in::textured_mesh textured = in::read_textured_obj(text, "map.obj", origin);
    for (const in::mesh& m : {in::read_obj(text, "map.obj", origin), textured.shape}) {
        CHECK(m.positions[0] == glm::vec3(0));
        CHECK(glm::distance(m.positions[2], glm::vec3(0.01f, 0.01f, 0.01f)) < 1e-9f);
        CHECK(m.normals[1] == glm::vec3(0, 0, 1));
    }
    CHECK(textured.texture_coordinates[0] == glm::vec2(0.25f, 0.75f));
    CHECK(in::read_obj(text).positions[1].y == in::read_obj(text).positions[2].y);
}

TEST_CASE("An origin must be finite and within 1e9 metres") {
    const double bad =
        GENERATE(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 2e9, -2e9);
    for (int i = 0; i < 3; ++i) {
        glm::dvec3 origin(0);
        origin[i] = bad;
        CHECK_THROWS_WITH(in::read_obj(square + "f 1 2 3", "a.obj", origin), ContainsSubstring("origin"));
    }
}

TEST_CASE("Line numbers count continued lines and every line ending") {
    CHECK(refusal("# \\\nv 0 \\\n0 0\r\n\r\nv x").rfind("a.obj:5:", 0) == 0);
    CHECK(refusal("\r\r\nv x").rfind("a.obj:3:", 0) == 0);
    CHECK(refusal("mtllib a\\\nb\nv x").rfind("a.obj:3:", 0) == 0);
}

TEST_CASE("A text truncated anywhere is read or refused, without a crash") {
    const std::string text = square + "vn 0 0 1\r\nf 1//1 \\\n 2//-1 3//1 4//1\n# end \\\nf -1 -2 -3\n";
    for (std::size_t length = 0; length <= text.size(); ++length) {
        try {
            in::validate(in::read_obj(std::string(text, 0, length)));
        } catch (const in::io_error&) {
        }
    }
}

TEST_CASE("Polygons are covered exactly, convex or concave, whichever corner comes first") {
    const double tilt = std::sqrt(1 + 0.25 + 0.0625);  // area of a plane z = x / 2 - y / 4 over its shadow
    const auto area = [&](const std::string& text) {
        const in::mesh m = in::read_obj(text);
        // Triangles that overlap or face backwards would make the two differ.
        CHECK(glm::length(area_of(m)) == Approx(absolute_area_of(m)));
        CHECK(area_of(m).z > 0);
        return absolute_area_of(m) / tilt;
    };
    SECTION("a regular polygon") {
        CHECK(area(polygon(100, [](int i) { return on_circle(i, 100, 1.0); })) ==
              Approx(50 * std::sin(2 * in::numeric::pi / 100)).epsilon(1e-4));
    }
    SECTION("an arrowhead, for which a fan is right from two of four corners only") {
        const int shift = GENERATE(0, 1, 2, 3);
        const glm::dvec2 corners[] = {{0, 0}, {2, -1}, {1, 0}, {2, 1}};
        CHECK(area(polygon(4, [&](int i) { return corners[(i + shift) % 4]; })) == Approx(1));
    }
    SECTION("a comb, with collinear corners and deep gaps") {
        const int shift = GENERATE(0, 1, 5, 11);
        // Ten teeth: up, across, down, across; then back along the bottom.
        const auto comb = [](int i) -> glm::dvec2 {
            if (i >= 40) return i == 40 ? glm::dvec2(19, -1) : glm::dvec2(0, -1);
            const double x = 2 * (i / 4) + (i % 4 >= 2 ? 1 : 0);
            return {x, i % 4 == 1 || i % 4 == 2 ? 5 : 0};
        };
        // The comb runs clockwise; read it backwards.
        CHECK(area(polygon(42, [&](int i) { return comb((41 - i + shift) % 42); })) == Approx(10 * 5 + 19));
    }
    SECTION("a star of 200 spikes") {
        const auto star = [](int i) { return on_circle(i, 400, i % 2 == 0 ? 1.0 : 0.3); };
        CHECK(area(polygon(400, star)) == Approx(400 * 0.5 * 0.3 * std::sin(2 * in::numeric::pi / 400)).epsilon(1e-4));
    }
}

TEST_CASE("A concave polygon is cut exactly up to 4096 corners, and refused beyond them") {
    // A zigzag below, a straight line above: 1.5 high on average.
    const auto saw = [](std::size_t corners) {
        std::vector<glm::vec3> out;
        for (std::size_t i = 0; i + 2 < corners; ++i) out.emplace_back(0.5f * static_cast<float>(i), i % 2 == 1, 0);
        out.emplace_back(out.back().x, 2, 0);
        out.emplace_back(0, 2, 0);
        return out;
    };
    SECTION("at the limit") {
        const std::vector<glm::vec3> corners = saw(4096);
        std::vector<glm::uvec3> triangles;
        in::triangulate(corners, triangles);
        CHECK(triangles.size() == 4094);
        double area = 0;
        bool any_clockwise = false;
        for (const glm::uvec3& t : triangles) {
            const glm::dvec3 a(corners[t.x]), b(corners[t.y]), c(corners[t.z]);
            const double twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
            any_clockwise = any_clockwise || twice < 0;
            area += 0.5 * twice;
        }
        CHECK(!any_clockwise);
        CHECK(area == 1.5 * 0.5 * 4093);
    }
    SECTION("beyond it") {
        const std::vector<glm::vec3> corners = saw(4097);
        std::vector<glm::uvec3> triangles;
        CHECK_THROWS_WITH(in::triangulate(corners, triangles),
                          "corners of a concave polygon is 4097, expected at most 4096: cut it");
        CHECK(triangles.empty());
        std::string text;
        for (const glm::vec3& p : corners) text += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " 0\n";
        text += "f";
        for (std::size_t i = 1; i <= corners.size(); ++i) text += " " + std::to_string(i);
        CHECK(refusal(text) == "a.obj:4098: a concave face has 4097 corners, expected at most 4096: cut it");
    }
    SECTION("convex ones have no limit") {
        std::vector<glm::vec3> corners;
        for (int i = 0; i < 6000; ++i) corners.emplace_back(glm::vec2(on_circle(i, 6000, 1.0)), 0);
        std::vector<glm::uvec3> triangles;
        in::triangulate(corners, triangles);
        CHECK(triangles.size() == 5998);
    }
}

TEST_CASE("A concave prism stays closed when its faces are cut") {
    // An L: the two caps are concave.
    std::string text;
    const glm::ivec2 outline[] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    for (const int z : {0, 1}) {
        for (const glm::ivec2& p : outline) {
            text += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(z) + "\n";
        }
    }
    text += "f 6 5 4 3 2 1\nf 7 8 9 10 11 12\nf 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n";
    const in::mesh m = in::read_obj(text);
    CHECK(in::inspect(m).closed());
    CHECK(in::inspect(m).euler_characteristic() == 2);
    CHECK(absolute_area_of(m) == Approx(2 * 3 + 8));
}

TEST_CASE("Self-intersecting and zero-area polygons give as many triangles as others") {
    CHECK(in::read_obj("v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4").triangles.size() == 2);
    CHECK(in::read_obj("v 0 0 0\nf 1 1 1 1 1 1").triangles.size() == 4);
    CHECK(in::read_obj("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 3 2 4 1").triangles.size() == 3);
}

TEST_CASE("Hostile input is parsed in linear time") {
    const double bound = 10;
    SECTION("a convex polygon with hundreds of thousands of corners") {
        const auto polygon = [](int corners) {
            std::string text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf";
            for (int i = 0; i < corners / 4; ++i) text += " 1 2 3 4";
            return text;
        };
        CHECK(growth_of_time(polygon, 250000) < bound);
    }
    SECTION("many jagged polygons at the limit of ear clipping") {
        const auto polygons = [](int count) {
            std::string text = square;
            for (int i = 0; i < count; ++i) {
                text += "\nf";
                for (int k = 0; k < 1024; ++k) text += " 1 3 2 4";
            }
            return text;
        };
        CHECK(growth_of_time(polygons, 1) < bound);
    }
    SECTION("one position with many normals") {
        const auto triangles = [](int count) {
            std::string text = square;
            for (int i = 0; i < count; ++i) text += "vn 0 0 1\nf 1//-1 2//-1 3//-1\n";
            return text;
        };
        CHECK(growth_of_time(triangles, 25000) < bound);
    }
    SECTION("a megabyte of backslashes, continuations, or one word") {
        const std::string face = square + "f 1 2 3\n";
        const auto backslashes = [&](int size) { return face + std::string(static_cast<std::size_t>(size), '\\'); };
        CHECK(growth_of_time(backslashes, 250000) < bound);
        const auto continued = [&](int lines) {
            std::string text = face;
            for (int i = 0; i < lines; ++i) text += "\\\n";
            return text;
        };
        CHECK(growth_of_time(continued, 125000) < bound);
        CHECK(refusal("v 0 0 " + std::string(1000000, 'x')).size() < 100);
    }
}

TEST_CASE("A file is read like its text, and a file that cannot be read is refused by name and reason") {
    const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
    const std::string path =
        (std::filesystem::temp_directory_path() / ("insonify_obj_" + std::to_string(now) + ".obj")).string();
    std::FILE* file = std::fopen(path.c_str(), "wb");
    REQUIRE(file != nullptr);
    const std::string text = square + "# " + std::string(200000, '-') + "\r\nf 1 2 3 4\nf 1 2 5";
    std::fwrite(text.data(), 1, text.size(), file);
    std::fclose(file);
    CHECK_THROWS_WITH(in::load_obj(path), ContainsSubstring(path + ":7: "));
    CHECK_THROWS_WITH(in::load_obj(path, glm::dvec3(2e9)), ContainsSubstring("origin"));
    CHECK_THROWS_WITH(in::load_textured_obj(path, glm::dvec3(2e9)), ContainsSubstring("origin"));
    std::remove(path.c_str());
    CHECK_THROWS_WITH(in::load_obj(path), ContainsSubstring(path) && ContainsSubstring("No such file"));
    CHECK_THROWS_AS(in::load_obj("."), in::io_error);
}

TEST_CASE("Spot, a public mesh, is a closed surface of one piece") {
    const std::string path = reference_directory() + "/meshes/spot.obj";
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (file == nullptr) {
        WARN("skipped: no " << path);
        return;
    }
    std::fclose(file);
    const in::mesh spot = in::load_obj(path);
    const in::topology t = in::inspect(spot);
    CHECK(t.vertices == 2930);
    CHECK(t.triangles == 5856);
    CHECK(t.closed());
    CHECK(t.euler_characteristic() == 2);

    const in::textured_mesh textured = in::load_textured_obj(path);
    CHECK(textured.texture_coordinates.size() == textured.shape.positions.size());
    CHECK(textured.texture_coordinates.size() > spot.positions.size());
    std::size_t differing = 0;
    for (std::size_t i = 0; i < spot.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k)
            differing += textured.shape.normals[textured.shape.triangles[i][k]] != spot.normals[spot.triangles[i][k]];
    CHECK(differing == 0);
}
