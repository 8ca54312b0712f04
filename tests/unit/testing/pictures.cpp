// Pictures in unit tests: comparisons, golden files, and the files that a failure writes.
#include <insonify/testing.hpp>
#include <insonify/testing/catch2.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <sstream>
#include <utility>

#include "../../catch.hpp"

namespace in = insonify;
using namespace std::string_literals;
using std::filesystem::exists;

namespace {

in::image<float> slope(int width, int height) {
    in::image<float> picture(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) picture(x, y) = 0.125f * static_cast<float>(x + y);
    return picture;
}

void remove_all(const std::string& stem) {
    for (const char* ending : {".pfm", ".pgm", ".ppm", ".found.pfm", ".found.pgm", ".difference.ppm"})
        std::remove((stem + ending).c_str());
}

}  // namespace

TEST_CASE("Equal pictures agree, of any pixel type") {
    CHECK(in::compare_pictures(slope(5, 3), slope(5, 3)));
    const in::image<std::uint16_t> ids(4, 4, std::uint16_t{7});
    CHECK(in::compare_pictures(ids, ids));
    const in::image<in::rgb8> colours(4, 4, in::rgb8{1, 2, 3});
    CHECK(in::compare_pictures(colours, colours));
}

TEST_CASE("A difference is reported with its place, its values and the number of wrong pixels") {
    in::image<float> found = slope(5, 3);
    found(3, 1) += 0.25f;
    found(0, 0) += 0.125f;
    const auto result = in::compare_pictures(found, slope(5, 3), {.value = 0.1});
    CHECK_FALSE(result);
    CHECK(result.wrong == 2);
    CHECK(result.x == 3);
    CHECK(result.y == 1);
    CHECK(result.largest == 0.25);
    CHECK(result.message ==
          "2 of 15 pixels differ by more than 0.1 (0 of them may); the most at x = 3, y = 1: 0.75, expected 0.5, "
          "off by 0.25");
    found(3, 1) = 0.1f;  // in the digits of a float
    CHECK(in::compare_pictures(found, slope(5, 3)).message.ends_with(": 0.1, expected 0.5, off by 0.4"));
}

TEST_CASE("A tolerance includes its own value, for pixels and for the fraction of them") {
    in::image<float> found = slope(4, 5);
    found(1, 1) += 0.5f;
    CHECK(in::compare_pictures(found, slope(4, 5), {.value = 0.5}));
    CHECK_FALSE(in::compare_pictures(found, slope(4, 5), {.value = 0.499}));
    CHECK(in::compare_pictures(found, slope(4, 5), {.share = 0.05}));
    CHECK_FALSE(in::compare_pictures(found, slope(4, 5), {.share = 0.049}));
    in::image<float> many(100, 1, 0.0f);  // 0.29 * 100 is below 29
    std::fill_n(many.pixels().begin(), 29, 1.0f);
    CHECK(in::compare_pictures(many, in::image<float>(100, 1, 0.0f), {.share = 0.29}));
}

TEST_CASE("Colours differ by their worst channel") {
    const in::image<in::rgb8> black(2, 2, in::rgb8{0, 0, 0});
    in::image<in::rgb8> found = black;
    found(1, 0) = {1, 9, 2};
    CHECK(in::compare_pictures(found, black).largest == 9);
    CHECK(in::compare_pictures(found, black).message.find("(1 9 2), expected (0 0 0)") != std::string::npos);
}

TEST_CASE("NaN equals NaN alone, and infinities equal themselves") {
    const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
    const in::image<float> nothing(2, 2, nan), zero(2, 2, 0.0f), endless(2, 2, infinity);
    CHECK(in::compare_pictures(nothing, nothing));
    CHECK(in::compare_pictures(endless, endless));
    CHECK_FALSE(in::compare_pictures(nothing, zero, {.value = 1e30}));
    CHECK_FALSE(in::compare_pictures(zero, nothing, {.value = 1e30}));
    CHECK_FALSE(in::compare_pictures(endless, nothing, {.value = 1e30}));
    CHECK_FALSE(in::compare_pictures(endless, zero, {.value = 1e30}));
}

TEST_CASE("A difference beyond the largest float is reported as a number") {
    const in::image<float> low(1, 1, -0x1p127f), high(1, 1, 0x1p127f);
    CHECK(in::compare_pictures(low, high).message.ends_with("off by 3.402823669209385e+38"));
}

TEST_CASE("Sizes must agree, and tolerances be in range") {
    const auto result = in::compare_pictures(slope(5, 3), slope(3, 5), {.share = 1});
    CHECK_FALSE(result);
    CHECK(result.message == "the picture has 5 x 3 pixels, expected 3 x 5 pixels");
    CHECK(in::compare_pictures(in::image<float>(), in::image<float>()));
    CHECK_THROWS_AS(in::compare_pictures(slope(2, 2), slope(2, 2), {.value = -1}), in::invalid_input);
    CHECK_THROWS_AS(in::compare_pictures(slope(2, 2), slope(2, 2), {.value = std::nan("")}), in::invalid_input);
    CHECK_THROWS_AS(in::compare_pictures(slope(2, 2), slope(2, 2), {.share = 1.5}), in::invalid_input);
}

TEST_CASE("A difference picture is gray where pixels agree, red where they are brighter, blue where darker") {
    in::image<float> found = slope(4, 1);
    found(0, 0) += 1;
    found(1, 0) -= 0.1f;
    const auto picture = in::difference_picture(found, slope(4, 1));
    CHECK(picture(0, 0) == in::rgb8{255, 0, 0});
    CHECK(picture(1, 0) == in::rgb8{0, 0, 97});
    CHECK(picture(2, 0) == in::rgb8{56, 56, 56});
    CHECK(picture(3, 0) == in::rgb8{85, 85, 85});
}

TEST_CASE("A difference picture is red where a value is NaN or infinite, and black where nothing is bright") {
    const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
    const in::image<float> found{{nan, infinity, 0, 0}}, expected{{0, -infinity, nan, 0}};
    const auto picture = in::difference_picture(found, expected);
    for (int x = 0; x < 3; ++x) CHECK(picture(x, 0) == in::rgb8{255, 0, 0});
    CHECK(picture(3, 0) == in::rgb8{0, 0, 0});
    CHECK_THROWS_WITH(in::difference_picture(slope(2, 2), slope(3, 2)), ContainsSubstring("width of the picture is 2"));
    CHECK_THROWS_WITH(in::difference_picture(slope(2, 2), slope(2, 3)),
                      ContainsSubstring("height of the picture is 2"));
}

#if defined(__unix__)
TEST_CASE("INSONIFY_UPDATE_GOLDEN asks for new golden pictures unless it is empty or 0") {
    const char* const name = "INSONIFY_UPDATE_GOLDEN";
    const char* const before = std::getenv(name);
    const std::string kept = before != nullptr ? before : "";
    ::unsetenv(name);
    CHECK_FALSE(in::golden_update_requested());
    for (const auto& [value, asks] : {std::pair{"", false}, {"0", false}, {"1", true}, {"yes", true}}) {
        ::setenv(name, value, 1);
        CHECK(in::golden_update_requested() == asks);
    }
    before != nullptr ? ::setenv(name, kept.c_str(), 1) : ::unsetenv(name);
}
#endif

TEST_CASE("Golden pictures are written on demand, then compared; a failure leaves the picture and its difference") {
    remove_all("golden_slope");
    in::golden_pictures golden{.update = false};
    const auto missing = golden.compare("golden_slope", slope(6, 4));
    CHECK_FALSE(missing);
    CHECK(missing.message.find("there is no golden picture ./golden_slope.pfm") == 0);
    CHECK(missing.message.find("INSONIFY_UPDATE_GOLDEN=1") != std::string::npos);
    CHECK(exists("golden_slope.found.pfm"));

    remove_all("golden_slope");
    golden.update = true;
    CHECK(golden.compare("golden_slope", slope(6, 4)));
    golden.update = false;
    CHECK(golden.compare("golden_slope", slope(6, 4)));
    CHECK_FALSE(exists("golden_slope.difference.ppm"));

    in::image<float> other = slope(6, 4);
    other(5, 3) = 0;
    const auto result = golden.compare("golden_slope", other);
    CHECK_FALSE(result);
    CHECK(result.message.find("golden_slope: 1 of 24 pixels") == 0);
    CHECK(result.message.find("see ./golden_slope.found.pfm and ./golden_slope.difference.ppm") != std::string::npos);
    CHECK(in::read_netpbm<float>("golden_slope.found.pfm") == other);
    CHECK(in::read_netpbm<in::rgb8>("golden_slope.difference.ppm")(5, 3) == in::rgb8{0, 0, 255});
    CHECK(in::read_netpbm<float>("golden_slope.pfm") == slope(6, 4));

    for (const char* ending : {".found.pfm", ".difference.ppm"}) std::remove(("golden_slope"s + ending).c_str());
    std::filesystem::create_directory("golden_failures");
    golden.failures = "golden_failures";
    CHECK_FALSE(golden.compare("golden_slope", other));
    CHECK(exists("golden_failures/golden_slope.found.pfm"));
    CHECK(exists("golden_failures/golden_slope.difference.ppm"));
    CHECK_FALSE(exists("golden_slope.found.pfm"));
    std::filesystem::remove_all("golden_failures");
    remove_all("golden_slope");
}

TEST_CASE("Matchers describe the expectation and the mismatch") {
    const auto expected = slope(4, 4);
    CHECK_THAT(expected, in::matches(in::is_picture(expected)));
    in::image<float> other = expected;
    other(2, 2) = 9;
    const auto matcher = in::is_picture(expected, {.value = 0.5});
    std::ostringstream why, what;
    CHECK_FALSE(matcher.MatchAndExplain(other, &why));
    matcher.DescribeTo(&what);
    CHECK(what.str() == "is the expected picture");
    what.str("");
    matcher.DescribeNegationTo(&what);
    CHECK(what.str() == "is not the expected picture");
    what.str("");
    PrintTo(expected, &what);
    CHECK(what.str() == "a picture of 4 x 4 pixels");
    CHECK(why.str().find("x = 2, y = 2: 9, expected 0.5") != std::string::npos);
    const auto for_catch = in::matches(matcher);
    CHECK_FALSE(for_catch.match(other));
    CHECK(for_catch.toString().find("is the expected picture: 1 of 16 pixels") == 0);

    const in::golden_pictures golden{.update = true};
    CHECK_THAT(expected, in::matches(golden.is("golden_matched")));
    remove_all("golden_matched");
}
