// Images and views of them.
#include <insonify/core/image.hpp>

#include <array>
#include <limits>

#include "../../catch.hpp"

namespace in = insonify;

TEST_CASE("An image has the given size and fill value") {
    const in::image<float> filled(3, 2, 0.5f);
    CHECK(filled.width() == 3);
    CHECK(filled.height() == 2);
    CHECK(filled.size() == 6);
    for (const float value : filled.pixels()) CHECK(value == 0.5f);

    CHECK(in::image<int>().empty());
    CHECK(in::image<int>(0, 7).empty());
    CHECK(in::image<int>(7, 0).size() == 0);
    CHECK(in::image<in::rgb8>(1, 1)(0, 0) == in::rgb8{0, 0, 0});
}

TEST_CASE("Rows lie one after the other from the top, columns from the left") {
    const in::image<int> table{{0, 1, 2}, {10, 11, 12}};
    CHECK(table.width() == 3);
    CHECK(table.height() == 2);
    CHECK(table(2, 1) == 12);
    CHECK(table.row(1)[0] == 10);
    CHECK(table.pixels()[3] == 10);
    CHECK(table == in::image<int>{{0, 1, 2}, {10, 11, 12}});
    CHECK(table != in::image<int>{{0, 1, 2}, {10, 11, 13}});
}

TEST_CASE("An image refuses sizes out of range and rows of different lengths, and names the value") {
    CHECK_THROWS_AS(in::image<char>(-1, 1), in::invalid_input);
    CHECK_THROWS_AS(in::image<char>(1, (1 << 30) + 1), in::invalid_input);
    CHECK_THROWS_AS(in::image<char>(1 << 30, 1 << 30), in::invalid_input);
    CHECK_THROWS_AS((in::image<int>{{0, 1}, {2}}), in::invalid_input);
    CHECK_THROWS_WITH(in::image<char>(-5, 1), ContainsSubstring("width is -5") && ContainsSubstring("0 to 2^30"));
    CHECK_THROWS_WITH((in::image<int>{{0, 1}, {2}}), ContainsSubstring("row length is 1"));
}

TEST_CASE("An image that was moved from is empty") {
    in::image<int> from(4, 3, 7), to;
    to = std::move(from);
    const in::image<int> last = std::move(to);
    CHECK((last.width() == 4 && last.height() == 3 && last(3, 2) == 7));
    for (const in::image<int>* const moved : {&from, &to}) {
        CHECK((moved->width() == 0 && moved->height() == 0));
        CHECK(moved->view().empty());
    }
}

TEST_CASE("A view shares the pixels of its image") {
    in::image<int> table{{0, 1, 2}, {10, 11, 12}};
    const in::image_view<int> view = table;
    view(1, 1) = 99;
    view.row(0)[2] = 77;
    CHECK(table == in::image<int>{{0, 1, 77}, {10, 99, 12}});

    const in::image_view<const int> constant = view;
    CHECK(constant.data() == view.data());
    CHECK(constant(1, 1) == 99);
}

TEST_CASE("A part of a view keeps the stride and shows the pixels at its offset") {
    in::image<int> table{{0, 1, 2, 3}, {10, 11, 12, 13}, {20, 21, 22, 23}};
    const auto part = table.view().part(1, 1, 2, 2);
    CHECK(part.stride() == 4);
    CHECK(part.size() == 4);
    CHECK(in::image<int>(part) == in::image<int>{{11, 12}, {21, 22}});
    CHECK(in::image<int>(part.part(1, 0, 1, 2)) == in::image<int>{{12}, {22}});
    CHECK(table.view().part(4, 3, 0, 0).empty());
    const in::image<int> no_rows(7, 0);
    CHECK(no_rows.view().part(3, 0, 2, 0).data() == no_rows.view().data());

    CHECK_THROWS_AS(table.view().part(1, 1, 4, 1), in::invalid_input);
    CHECK_THROWS_AS(table.view().part(1, 1, 1, 3), in::invalid_input);
    CHECK_THROWS_AS(table.view().part(-1, 0, 1, 1), in::invalid_input);
    CHECK_THROWS_AS(table.view().part(0, 5, 0, 0), in::invalid_input);
    CHECK_THROWS_AS(table.view().part(1, 0, (std::numeric_limits<int>::max)(), 1), in::invalid_input);
}

TEST_CASE("A view of foreign memory refuses a stride shorter than its rows, and may be empty without memory") {
    std::array<float, 6> memory{0, 1, 2, 3, 4, 5};
    CHECK(in::image_view<float>(memory.data(), 2, 2, 3)(1, 1) == 4);
    CHECK_THROWS_WITH(in::image_view<float>(memory.data(), 3, 2, 2), ContainsSubstring("stride is 2"));
    CHECK_THROWS_AS(in::image_view<float>(memory.data(), -1, 2), in::invalid_input);
    CHECK_THROWS_AS(in::image_view<float>(memory.data(), 1, -2), in::invalid_input);
    CHECK(in::image_view<float>().empty());
}

TEST_CASE("Mapping pixels keeps the size and takes the type that the function returns") {
    const in::image<int> table{{0, 1}, {2, 3}, {4, 5}};
    const auto halves = in::map_pixels(table, [](int value) { return 0.5 * value; });
    static_assert(std::is_same_v<decltype(halves), const in::image<double>>);
    CHECK(halves == in::image<double>{{0, 0.5}, {1, 1.5}, {2, 2.5}});

    const auto column = in::map_pixels(table.view().part(1, 0, 1, 3), [](int value) { return value; });
    CHECK(column == in::image<int>{{1}, {3}, {5}});
}
