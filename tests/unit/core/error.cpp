// Errors: their text and their types.
#include <insonify/core/error.hpp>

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include "../../catch.hpp"

namespace in = insonify;

TEST_CASE("An error names the argument, its value in the fewest digits, and what was expected") {
    using in::detail::to_text;
    CHECK(to_text(0.1f) == "0.1");
    CHECK(to_text(-0.25) == "-0.25");
    CHECK(to_text(std::numeric_limits<std::int64_t>::min()) == "-9223372036854775808");
    CHECK(to_text(true) == "true");
    CHECK(to_text(std::numeric_limits<double>::quiet_NaN()) == "nan");
    CHECK(to_text(-std::numeric_limits<float>::infinity()) == "-inf");
    CHECK(to_text(std::numeric_limits<double>::lowest()) == "-1.7976931348623157e+308");

    CHECK_NOTHROW(in::detail::require(true, "variance", 0.1, "at least 0"));
    CHECK_THROWS_WITH(in::detail::require(false, "variance", -0.1, "at least 0"),
                      "variance is -0.1, expected at least 0");
    CHECK_NOTHROW(in::detail::require_equal("right.height()", 3, 3, "that of the left"));
    CHECK_THROWS_WITH(in::detail::require_equal("right.height()", 2, 3, "that of the left"),
                      "right.height() is 2, expected 3, that of the left");
}

TEST_CASE("Numbers beyond those of a double are read as 0 or infinite, however they are written") {
    const auto read = [](const std::string& text) {
        double value = -1;
        REQUIRE(in::detail::parse_number(text, value));
        return value;
    };
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const std::string zeros(400, '0');
    CHECK(read("1e-400") == 0);
    CHECK(read("-1E+400") == -infinity);
    CHECK(read("1" + zeros) == infinity);
    CHECK(read("-1" + zeros + ".5e-5") == -infinity);
    CHECK(read("0." + zeros + "1") == 0);
    CHECK(read("0." + zeros + "1e5") == 0);
    CHECK(read("3e999999999999999999999") == infinity);
    CHECK(read("3e-999999999999999999999") == 0);
    CHECK(read("+0.5") == 0.5);
    for (const char* const wrong : {"", "+", "1x", "+-1", " 1", "0x1", "1e", "nan()", "nan(12)"}) {
        double value = 0;
        CAPTURE(wrong);
        CHECK_FALSE(in::detail::parse_number(wrong, value));
    }
}

TEST_CASE("Both errors derive from exceptions of the standard library") {
    CHECK_THROWS_AS(in::detail::throw_error(in::invalid_input("x")), std::invalid_argument);
    CHECK_THROWS_AS(in::detail::throw_error(in::io_error("x")), std::runtime_error);
}
