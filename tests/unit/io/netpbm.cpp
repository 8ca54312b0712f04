// Netpbm files: round trips, the published formats byte by byte, and hostile headers.
#include <insonify/core/random.hpp>
#include <insonify/io/netpbm.hpp>

#include <cmath>
#include <string>

#include "../../catch.hpp"

namespace in = insonify;
using namespace std::string_literals;

namespace {

template <class Pixel>
std::string refusal(const std::string& bytes) {
    try {
        in::parse_netpbm<Pixel>(bytes, "hostile.pgm");
    } catch (const in::io_error& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("Written images read back as the same pixels") {
    const in::image<std::uint8_t> gray{{0, 10, 255}, {'#', ' ', '\n'}};
    const in::image<std::uint16_t> instances{{0, 1, 256}, {65535, 4660, 13}};
    const in::image<in::rgb8> color{{{1, 2, 3}, {255, 0, 9}}};
    const in::image<in::rgb<std::uint16_t>> deep{{{1, 2, 30000}}};
    const in::image<float> linear{{0.1f, -1e-42f}, {3e38f, std::numeric_limits<float>::infinity()}, {0, 1}};
    const in::image<in::rgb<float>> light{{{0.5f, 1, 2}}, {{-1, 0, 7}}};
    CHECK(in::parse_netpbm<std::uint8_t>(in::format_netpbm(gray)) == gray);
    CHECK(in::parse_netpbm<std::uint16_t>(in::format_netpbm(instances)) == instances);
    CHECK(in::parse_netpbm<in::rgb8>(in::format_netpbm(color)) == color);
    CHECK(in::parse_netpbm<in::rgb<std::uint16_t>>(in::format_netpbm(deep)) == deep);
    CHECK(in::parse_netpbm<float>(in::format_netpbm(linear)) == linear);
    CHECK(in::parse_netpbm<in::rgb<float>>(in::format_netpbm(light)) == light);
}

TEST_CASE("Files are written byte by byte as the formats say") {
    const in::image<std::uint8_t> gray{{1, 2, 3}};
    const in::image<std::uint16_t> instances{{0x1234}, {0xABCD}};
    const in::image<in::rgb8> color{{{1, 2, 3}}};
    const in::image<float> linear{{1}, {2}};
    CHECK(in::format_netpbm(gray) == "P5\n3 1\n255\n\x01\x02\x03");
    CHECK(in::format_netpbm(instances) == "P5\n1 2\n65535\n\x12\x34\xAB\xCD");
    CHECK(in::format_netpbm(color) == "P6\n1 1\n255\n\x01\x02\x03");
    CHECK(in::format_netpbm(linear) == "Pf\n1 2\n-1.0\n\x00\x00\x00\x40\x00\x00\x80\x3F"s);
}

TEST_CASE("Plain files, comments and all white space are read") {
    const in::image<std::uint8_t> expected{{0, 1}, {2, 15}};
    CHECK(in::parse_netpbm<std::uint8_t>("P2 2 2 15 0 1 2 15") == expected);
    CHECK(in::parse_netpbm<std::uint8_t>("P2\n# CREATOR: hand\r\n2\t2#size\n15\n0 1\v2\f15\n") == expected);
    CHECK(in::parse_netpbm<std::uint8_t>("P5#c\n2 #w\n2 15\n\x00\x01\x02\x0F"s) == expected);
    CHECK(in::parse_netpbm<in::rgb8>("P3 1 2 255\n1 2 3\n4 5 6\n") == in::image<in::rgb8>{{{1, 2, 3}}, {{4, 5, 6}}});
    CHECK(in::parse_netpbm<std::uint8_t>("P5 1 1 255\n#") == in::image<std::uint8_t>{{'#'}});
    CHECK(in::parse_netpbm<std::uint8_t>("P5 1 1 255\n7P5 1 1 255\n8") == in::image<std::uint8_t>{{'7'}});
}

TEST_CASE("Samples keep their values as integers and become fractions of maxval as floats") {
    CHECK(in::parse_netpbm<std::uint16_t>("P2 3 1 1000 0 500 1000") == in::image<std::uint16_t>{{0, 500, 1000}});
    CHECK(in::parse_netpbm<float>("P2 3 1 1000 0 500 1000") == in::image<float>{{0, 0.5f, 1}});
    CHECK(in::parse_netpbm<float>("P5 1 1 65535\n\xFF\xFF") == in::image<float>{{1}});
    CHECK(in::parse_netpbm<std::uint16_t>("P5 1 1 256\n\x01\x00"s) == in::image<std::uint16_t>{{256}});
    CHECK(in::parse_netpbm<in::rgb<float>>("P3 1 1 4 0 1 4") == in::image<in::rgb<float>>{{{0, 0.25f, 1}}});
}

TEST_CASE("Float maps are read in both byte orders, from the bottom up") {
    const in::image<float> expected{{2}, {1}};
    CHECK(in::parse_netpbm<float>("Pf\n1 2\n-1.0\n\x00\x00\x80\x3F\x00\x00\x00\x40"s) == expected);
    CHECK(in::parse_netpbm<float>("Pf\n1 2\n1.0\n\x3F\x80\x00\x00\x40\x00\x00\x00"s) == expected);
    CHECK(in::parse_netpbm<in::rgb<float>>("PF 1 1 -3\n\x00\x00\x80\x3F\x00\x00\x00\x40\x00\x00\x00\x00"s) ==
          in::image<in::rgb<float>>{{{1, 2, 0}}});
}

TEST_CASE("Headers with sizes that the file does not have are refused before memory is allocated") {
    CHECK(refusal<std::uint8_t>("") == "hostile.pgm: not a netpbm file");
    CHECK(refusal<std::uint8_t>("\x89PNG\r\n") == "hostile.pgm: not a netpbm file");
    CHECK_THAT(refusal<std::uint8_t>("P4 8 1\n1"), ContainsSubstring("format P4"));
    CHECK_THAT(refusal<std::uint8_t>("P53 1 255\n000"), ContainsSubstring("not a netpbm file"));
    CHECK_THAT(refusal<std::uint8_t>("P5"), ContainsSubstring("not a netpbm file"));
    CHECK_THAT(refusal<std::uint8_t>("P5 # only a comment"), ContainsSubstring("ends before the width"));
    CHECK_THAT(refusal<std::uint8_t>("P5 2"), ContainsSubstring("ends before the height"));
    CHECK_THAT(refusal<std::uint8_t>("P5 2 2"), ContainsSubstring("ends before the maxval"));
    for (const char* width :
         {"0", "-1", "+1", "1.5", "1e3", "0x10", "1073741825", "4294967297", "99999999999999999999", "\xFF"}) {
        CHECK_THAT(refusal<std::uint8_t>("P5 "s + width + " 1 255\n0"),
                   ContainsSubstring("width is '" + std::string(width)));
    }
    for (const char* maxval : {"0", "-5", "65536"}) {
        CHECK_THAT(refusal<std::uint16_t>("P5 1 1 "s + maxval + "\n0"), ContainsSubstring("expected 1 to 65535"));
    }
    for (const char* scale : {"0", "-0.0", "nan", "one", "1,0"}) {
        CHECK_THAT(refusal<float>("Pf 1 1 "s + scale + "\n0000"), ContainsSubstring("expected a number other than 0"));
    }
    for (const std::string format : {"P2", "P3", "P5", "P6"}) {
        CHECK_THAT(refusal<float>(format + " 1073741824 1073741824 65535\n0")
                       .append(refusal<in::rgb<float>>(format + " 1073741824 1073741824 255\n0")),
                   ContainsSubstring("1073741824 x 1073741824 pixels is longer than the file"));
    }
    CHECK_THAT(refusal<float>("Pf 1073741824 1073741824 1\n0000"), ContainsSubstring("longer than the file"));
    CHECK_THAT(refusal<std::uint8_t>("P5 2 2 255\n123"), ContainsSubstring("longer than the file"));
    CHECK_THAT(refusal<std::uint16_t>("P5 2 2 256\n1234567"), ContainsSubstring("longer than the file"));
    CHECK_THAT(refusal<std::uint8_t>("P2 2 2 255 1 2 3"), ContainsSubstring("longer than the file"));
    CHECK_THAT(refusal<std::uint8_t>("P2 2 2 255 1 200 3    "), ContainsSubstring("ends before the sample"));
    CHECK_THAT(refusal<std::uint8_t>("P5 1 1 255"), ContainsSubstring("no white space after the header"));
    CHECK_THAT(refusal<std::uint8_t>("P5 1 1 100\n\x65"), ContainsSubstring("sample is 101, expected 0 to 100"));
    CHECK_THAT(refusal<std::uint8_t>("P2 1 1 100 101"), ContainsSubstring("sample is '101', expected 0 to 100"));
}

TEST_CASE("A file that doesn't fit the pixel type is refused") {
    CHECK_THAT(refusal<std::uint8_t>("P6 1 1 255\n123"), ContainsSubstring("a colour image, expected gray"));
    CHECK_THAT(refusal<in::rgb8>("P5 1 1 255\n1"), ContainsSubstring("a gray image, expected colour"));
    CHECK_THAT(refusal<std::uint8_t>("P5 1 1 256\n12"), ContainsSubstring("maxval is 256, expected at most 255"));
    CHECK_THAT(refusal<std::uint8_t>("Pf 1 1 1\n1234"), ContainsSubstring("an image of floats"));
    CHECK_THROWS_AS(in::format_netpbm(in::image_view<const float>()), in::invalid_input);
}

TEST_CASE("No input makes the parser read out of bounds, or allocate more than the input's size justifies") {
    in::random_sequence draws(GENERATE(range(std::uint64_t{0}, std::uint64_t{200})));
    const std::string seeds[] = {"P5 3 2 255\n123456", "P2 3 2 9 1 2 3 4 5 6", "Pf 2 1 -1\n12345678"};
    std::string bytes = seeds[draws.below(3)];
    for (std::uint32_t i = draws.below(4); i > 0; --i)
        bytes[draws.below(static_cast<std::uint32_t>(bytes.size()))] = static_cast<char>(draws.below(128));
    if (draws.below(2) == 0) bytes.resize(draws.below(static_cast<std::uint32_t>(bytes.size())));
    const auto pixels = [&](auto type) -> std::size_t {
        try {
            return in::parse_netpbm<decltype(type)>(bytes).size();
        } catch (const in::io_error& error) {
            CHECK_THAT(error.what(), ContainsSubstring("netpbm data: "));
            return 0;
        }
    };
    CHECK(pixels(std::uint16_t{}) <= bytes.size());
    CHECK(pixels(float{}) <= bytes.size());
}
