// Surveys: parsing of valid and malformed text, filling of gaps, and added detail.
#include <insonify/io/netpbm.hpp>
#include <insonify/seabed/bathymetry.hpp>
#include <insonify/seabed/models.hpp>
#include <insonify/seabed/sample.hpp>

#include <cmath>
#include <limits>

#include "../../catch.hpp"

namespace in = insonify;
namespace sb = insonify::seabed;

namespace {

constexpr const char* grid =
    "ncols 3\nnrows 2\nxllcorner 1000\nyllcorner -50\ncellsize 2\nNODATA_value -9999\n"
    "1 2 3\n4 -9999 6.5\n";

bool missing(float height) {
    return !in::numeric::is_finite(height);
}

}  // namespace

TEST_CASE("Vertices of an Esri grid lie at the centres of its cells, north up; cells without data are holes") {
    const sb::heightfield field = sb::parse_esri_grid(grid);
    REQUIRE(field.heights.width() == 3);
    REQUIRE(field.heights.height() == 2);
    CHECK(field.origin == glm::dvec2(1001, -49));
    CHECK(field.spacing == 2);
    CHECK(field.heights(0, 1) == 1);
    CHECK(field.heights(2, 1) == 3);
    CHECK(field.heights(0, 0) == 4);
    CHECK(missing(field.heights(1, 0)));
    CHECK(field.heights(2, 0) == 6.5f);
    CHECK(field.height_at(1001, -47) == 1);
    CHECK(sb::parse_esri_grid(grid, -1).heights(2, 1) == -3);
}

TEST_CASE("An Esri grid may state the centre of its corner cell, with any letter case and any line ending") {
    const sb::heightfield field =
        sb::parse_esri_grid("NCOLS 2\r\nNROWS 2\r\nXLLCENTER 5\r\nYLLCENTER 7\r\nCELLSIZE 0.5\r\n1e0 +2\r\nnan 4");
    CHECK(field.origin == glm::dvec2(5, 7));
    CHECK(field.heights(0, 1) == 1);
    CHECK(field.heights(1, 1) == 2);
    CHECK(missing(field.heights(0, 0)));
    CHECK(field.heights(1, 0) == 4);
    for (const std::string first : {"nan", "inf", "-inf", "Infinity"}) {
        const auto without =
            sb::parse_esri_grid("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n" + first + " 4\n5 6");
        CHECK(missing(without.heights(0, 1)));
        CHECK(without.heights(1, 1) == 4);
    }
}

TEST_CASE("Text that is not an Esri grid is refused with the line and the reason") {
    const std::string head = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
    const auto read = [](const std::string& text) { return sb::parse_esri_grid(text, 1, "bottom.asc"); };
    CHECK_THROWS_WITH(read(""), ContainsSubstring("bottom.asc:1: ncols is missing"));
    CHECK_THROWS_WITH(read(head + "1 2 3"), ContainsSubstring("ends before a height"));
    CHECK_THROWS_WITH(read(head + "1 2\n3 x"), ContainsSubstring("bottom.asc:7: 'x' is not a number"));
    CHECK_THROWS_WITH(read(head + "1 2\n3 4 5"), ContainsSubstring("goes on after"));
    CHECK_THROWS_WITH(read("ncols 2\nnrows 2\ncellsize 1\n1 2 3 4"), ContainsSubstring("xllcorner"));
    CHECK_THROWS_WITH(read("ncols 2.5\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3 4"),
                      ContainsSubstring("ncols"));
    CHECK_THROWS_WITH(read("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0\n1 2 3 4"),
                      ContainsSubstring("cellsize"));
    CHECK_THROWS_WITH(read("ncols 2\nwidth 3\n"), ContainsSubstring("'width' is not a keyword"));
    CHECK_THROWS_WITH(read("ncols 16777216\nnrows 16777216\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2"),
                      ContainsSubstring("too short"));
    CHECK_THROWS_WITH(read("ncols 2\nnrows 2\nxllcorner 1e300\nyllcorner 0\ncellsize 1\n1 2 3 4"),
                      ContainsSubstring("1e9"));
}

TEST_CASE("Soundings in any order are gridded: averaged where there are several, missing where there are none") {
    const sb::heightfield field =
        sb::parse_xyz("x,y,depth\n10,20,3\n11,20,4\n# a remark\n10.4,19.6,5\n\n11;22;7;quality 3\n", 1, -1);
    REQUIRE(field.heights.width() == 2);
    REQUIRE(field.heights.height() == 3);
    CHECK(field.origin == glm::dvec2(10, 20));
    CHECK(field.heights(0, 0) == -4);
    CHECK(field.heights(1, 0) == -4);
    CHECK(field.heights(1, 2) == -7);
    CHECK(missing(field.heights(0, 1)));
    CHECK(missing(field.heights(0, 2)));
}

TEST_CASE("Soundings are read line by line, with any line ending") {
    CHECK_THROWS_WITH(sb::parse_xyz("0 0 1\n1 0\n2 0 3\n", 1, 1, "bottom.xyz"),
                      ContainsSubstring("bottom.xyz:2: a z is missing"));
    CHECK_THROWS_WITH(sb::parse_xyz("0 0 1\r1\r2 0 3\r", 1, 1, "bottom.xyz"),
                      ContainsSubstring("bottom.xyz:2: a y is missing"));
    CHECK_THROWS_WITH(sb::parse_xyz("0 0 1\r\n\r\n1 0\r\n2 0 3", 1, 1, "bottom.xyz"),
                      ContainsSubstring("bottom.xyz:3:"));
    const std::string line_end = GENERATE("\n", "\r\n", "\r");
    std::string text = "x y z" + line_end;
    for (int i = 0; i < 100; ++i) text += std::to_string(i) + " 0 " + std::to_string(2 * i) + " note" + line_end;
    const sb::heightfield field = sb::parse_xyz(text, 1);
    REQUIRE(field.heights.width() == 100);
    for (int i = 0; i < 100; ++i) CHECK(field.heights(i, 0) == 2.0f * static_cast<float>(i));
}

TEST_CASE("Text that is not a list of soundings is refused") {
    CHECK_THROWS_WITH(sb::parse_xyz("", 1), ContainsSubstring("no soundings"));
    CHECK_THROWS_WITH(sb::parse_xyz("0 0 nan\n1 0 NaN\n0 1 1e30", 1), ContainsSubstring("no sounding has a z"));
    // Rows of an Esri grid would pass for soundings.
    CHECK_THROWS_WITH(sb::parse_xyz("NCOLS 3\nnrows 2\n1 2 3\n4 5 6\n", 1), ContainsSubstring("parse_esri_grid"));
    CHECK_THROWS_WITH(sb::parse_xyz("1 2", 1), ContainsSubstring("ends before a z"));
    CHECK_THROWS_WITH(sb::parse_xyz("1 2 z", 1), ContainsSubstring("'z' is not a number"));
    CHECK_THROWS_WITH(sb::parse_xyz("0 0 1\n900000000 900000000 1", 1), ContainsSubstring("2^26"));
    CHECK_THROWS_WITH(sb::parse_xyz("0 0 1", 0), ContainsSubstring("spacing is 0"));
}

TEST_CASE("A sounding with an empty cell for z is skipped, and columns stay where they are") {
    const sb::heightfield field =
        sb::parse_xyz("x,y,depth,quality\n0,0,-12.5,1\n1,0,,1\n0,1,-12,1\n1,1, ,2\n2 ; 0 ; -3 ; 9\n", 1);
    CHECK(field.heights(0, 0) == -12.5f);
    CHECK(field.heights(0, 1) == -12);
    CHECK(field.heights(2, 0) == -3);
    CHECK(missing(field.heights(1, 0)));
    CHECK(missing(field.heights(1, 1)));
    CHECK_THROWS_WITH(sb::parse_xyz("0,,3\n", 1), ContainsSubstring("a y is missing"));
    // A line whose first cell is empty does not begin with a number.
    CHECK_FALSE(missing(sb::parse_xyz("0,0,1\n1,0,2\n,5,7,9\n", 1).heights(1, 0)));
    CHECK(sb::parse_xyz("0,0,1\n1,0,2\n,5,7,9\n", 1).heights.height() == 2);
}

TEST_CASE("Decimal commas are refused") {
    for (const char* const line : {"100,25;200,50;-12,30", "100,25 200,50 -12,30", "100;200,5;3", "1,5\t2,5\t3,5"}) {
        CAPTURE(line);
        CHECK_THROWS_WITH(sb::parse_xyz(line, 1), ContainsSubstring("xyz:1: ") && ContainsSubstring("decimal commas"));
    }
}

TEST_CASE("Lines of dashes or dots are no soundings, and the largest double in 15 digits marks missing data") {
    CHECK(sb::parse_xyz("---- soundings ----\n... x\n0 0 1\n1 0 -.5\n0 1 +2\n", 1).heights(1, 0) == -0.5f);
    const sb::heightfield field = sb::parse_esri_grid(
        "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -1.79769313486232e+308\n"
        "1 -1.79769313486232e+308\n1e-400 3\n");
    CHECK(missing(field.heights(1, 1)));
    CHECK(field.heights(0, 0) == 0);
}

TEST_CASE("Soundings or grids whose vertex indices exceed 2^53 are refused") {
    CHECK_THROWS_WITH(sb::parse_xyz("500000 500000 -5\n500001 500000 -7\n", 5e-14), ContainsSubstring("2^53"));
    CHECK_THROWS_WITH(sb::grid_over({5e5, 5e5}, {5e5 + 1, 5e5 + 1}, 5e-14), ContainsSubstring("spacing is 5e-14"));
}

TEST_CASE("Soundings in degrees, which share a few vertices, are refused") {
    const auto survey = [](double x, double y, double step, int side) {
        std::string text = "longitude latitude depth\n";
        for (int i = 0; i < side * side; ++i)
            text += std::to_string(x + step * (i % side)) + ' ' + std::to_string(y + step * (i / side)) + " 12\n";
        return text;
    };
    CHECK_THROWS_WITH(sb::parse_xyz(survey(10.6, 54.3, 1e-4, 30), 1, -1),
                      ContainsSubstring("all 900 soundings lie within 0.0029 x 0.0029 metres") &&
                          ContainsSubstring("projected to metres"));
    CHECK_THROWS_WITH(sb::parse_xyz(survey(10.6, 54.3, 0.1, 30), 1, -1), ContainsSubstring("projected to metres"));
    CHECK_THROWS_WITH(sb::parse_xyz("3 4 5\n", 1), ContainsSubstring("lie within 0 x 0 metres"));
    // The same numbers are metres of a small tank at a spacing of its size.
    CHECK(sb::parse_xyz(survey(10.6, 54.3, 0.1, 30), 0.1).heights.width() == 30);
    CHECK(sb::parse_xyz("0 0 1\n1 0 2\n0 1 3\n1 1 4\n", 1).heights.size() == 4);
}

TEST_CASE("A 16-bit image keeps its resolution, and its no-data value becomes NaN") {
    in::image<std::uint16_t> picture(2, 2);
    picture(0, 0) = 0, picture(1, 0) = 1, picture(0, 1) = 65535, picture(1, 1) = 300;
    const auto normalized = in::parse_netpbm<float>(in::format_netpbm(picture));
    const sb::heightfield field = sb::from_image(normalized, 0.5, 65535 * 0.01f, 0);
    CHECK(missing(field.heights(0, 1)));
    CHECK(field.heights(1, 1) == Approx(0.01));
    CHECK(field.heights(0, 0) == Approx(655.35));
    CHECK(field.heights(1, 0) == Approx(3.0));
}

TEST_CASE("Gaps are filled from their edges up to the given distance") {
    sb::heightfield field{.heights = in::image<float>(9, 9, 2.0f)};
    for (int j = 2; j < 7; ++j)
        for (int i = 2; i < 7; ++i) field.heights(i, j) = std::numeric_limits<float>::quiet_NaN();
    const auto holes = [](const sb::heightfield& f) {
        return std::count_if(f.heights.pixels().begin(), f.heights.pixels().end(), missing);
    };
    CHECK(holes(sb::fill_gaps(field, 0)) == 25);
    CHECK(holes(sb::fill_gaps(field, 1)) == 9);
    const sb::heightfield whole = sb::fill_gaps(field);
    CHECK(holes(whole) == 0);
    CHECK(whole.heights(4, 4) == 2);
    // Each from the known neighbours of the round before, in whatever order the grid is scanned.
    for (int j = 0; j < 9; ++j)
        for (int i = 0; i < 9; ++i)
            if (!missing(field.heights(i, j))) field.heights(i, j) = static_cast<float>(i + 2 * j);
    const sb::heightfield sloping = sb::fill_gaps(field);
    for (int j = 0; j < 9; ++j)
        for (int i = 0; i < 9; ++i) CHECK(sloping.heights(i, j) + sloping.heights(8 - i, 8 - j) == Approx(24));
    CHECK(sloping.heights(2, 2) == Approx((3 + 5 + 7 + 4 + 5) / 5.0));
    CHECK_THROWS_WITH(sb::fill_gaps(field, -1), ContainsSubstring("reach is -1"));
    CHECK_THROWS_WITH(sb::parse_xyz("0 0 1\n1 0 2\n", 1, std::nanf("")), ContainsSubstring("scale is nan"));
    sb::heightfield nothing{.heights = in::image<float>(3, 3, std::numeric_limits<float>::quiet_NaN())};
    CHECK(holes(sb::fill_gaps(nothing)) == 9);
}

TEST_CASE("Detail interpolates the survey's vertices smoothly and adds the given roughness") {
    sb::heightfield field{.heights = in::image<float>(40, 40), .origin = {100, 200}, .spacing = 2};
    for (int j = 0; j < 40; ++j)
        for (int i = 0; i < 40; ++i) field.heights(i, j) = std::sin(0.5f * static_cast<float>(i));
    const sb::detailed even{.field = field, .surface = {.rms = 0}};
    CHECK(sb::at(even, 100 + 2 * 7, 200 + 2 * 9).height == field.heights(7, 9));
    // Slopes are continuous at a vertex, unlike those of facets.
    const auto bend = [](const auto& f) {
        const auto at = [&](double x) { return static_cast<double>(sb::at(f, x, 231).height); };
        return std::abs(at(114.01) - 2 * at(114) + at(113.99)) / 0.01;
    };
    CHECK(bend(even) < 0.01);
    CHECK(bend(field) > 0.03);

    const sb::detailed rough{.field = field, .surface = {.rms = 0.05f, .longest = 1, .shortest = 0.1f}};
    const sb::grid area{.origin = {110, 210}, .spacing = 0.11, .width = 300, .height = 300};
    const auto with = sb::sample(rough, area).heights, without = sb::sample(even, area).heights;
    double square = 0;
    for (std::size_t k = 0; k < with.size(); ++k)
        square += std::pow(static_cast<double>(with.pixels()[k] - without.pixels()[k]), 2) / 90000;
    CHECK(std::sqrt(square) == Approx(0.05).epsilon(0.05));
}

TEST_CASE("Detail leaves holes where the survey has them, and no wider ones") {
    sb::heightfield field{.heights = in::image<float>(9, 9, 1.0f)};
    field.heights(4, 4) = std::numeric_limits<float>::quiet_NaN();
    const sb::detailed bed{.field = field, .surface = {.rms = 0}};
    CHECK(missing(sb::at(bed, 4, 4).height));
    CHECK(sb::at(bed, 2.5, 4.2).height == 1);
    CHECK(sb::at(bed, 6, 4).height == 1);
}
