// Composition, conversion, gray and colour.
#include <insonify/core/thread_pool.hpp>
#include <insonify/filter/colormap.hpp>
#include <insonify/filter/convert.hpp>
#include <insonify/filter/echo_noise.hpp>
#include <insonify/filter/gray.hpp>
#include <insonify/filter/match.hpp>
#include <insonify/filter/noise.hpp>
#include <insonify/filter/pipe.hpp>
#include <insonify/filter/poisson.hpp>
#include <insonify/filter/where.hpp>

#include <climits>
#include <cmath>

#include "../../catch.hpp"

namespace in = insonify;

namespace {

in::image<float> ramp(int width, int height) {
    in::image<float> out(width, height);
    float value = 0;
    for (float& pixel : out.pixels()) pixel = (value += 1) / static_cast<float>(out.size());
    return out;
}

/// Counts its calls, to observe when and how often a chain runs.
struct counting {
    int* calls;
    float operator()(float pixel) const {
        ++*calls;
        return pixel;
    }
};

/// Executor that makes its calls in reverse order.
struct backwards {
    template <class Fn>
    void bulk(std::size_t count, Fn&& fn) const {
        while (count > 0) fn(--count);
    }
};

}  // namespace

TEST_CASE("A chain touches no pixel until it is applied, and then each pixel once per stage") {
    int calls = 0;
    const auto chain = in::filter_chain<>{} | counting{&calls} | counting{&calls};
    CHECK(calls == 0);
    const auto out = ramp(5, 4) | chain;
    CHECK(calls == 40);
    CHECK(out == ramp(5, 4));
}

TEST_CASE("A chain gives the result of its stages applied one by one") {
    const in::image<float> source = ramp(300, 250);
    const in::image<float> reference = ramp(17, 3);
    const in::match_histogram match(reference);
    const in::speckle grain{.variance = 0.1f, .seed = 7};
    const auto invert = [](float v) { return 1 - v; };

    const auto look = match | grain | invert | in::colormap::copper;
    const in::image<in::rgb8> step_by_step = (((source | match) | grain) | invert) | in::colormap::copper;
    CHECK((source | look) == step_by_step);
    CHECK(look(source) == step_by_step);
    CHECK((source | (match | (grain | (invert | in::colormap::copper)))) == step_by_step);
    CHECK((source.view() | look) == step_by_step);
    CHECK((in::image<float>(source) | look) == step_by_step);

    SECTION("a measured stage behind others measures their result") {
        const auto late = invert | match;
        CHECK((source | late) == ((source | invert) | match));
    }
    SECTION("a function of the image may stand anywhere in a chain") {
        const auto mirror = [](in::image_view<const float> from) {
            in::image<float> to(from.width(), from.height());
            for (int y = 0; y < from.height(); ++y) {
                for (int x = 0; x < from.width(); ++x) to(x, y) = from(from.width() - 1 - x, y);
            }
            return to;
        };
        CHECK((source | mirror)(0, 0) == source(299, 0));
        CHECK((source | (grain | mirror | invert)) == (((source | grain) | mirror) | invert));
        CHECK((source | (mirror | grain)) == ((source | mirror) | grain));
    }
}

TEST_CASE("Conversions begin and join chains as all other filters do") {
    const in::image<std::uint8_t> codes{{0, 1, 128, 255}};
    const auto half = [](float value) { return 0.5f * value; };
    const auto there_and_back = in::to_float | in::to_uint8;
    CHECK((codes | there_and_back) == codes);
    CHECK((codes | (in::to_float | half | in::to_uint16)) == (codes | in::to_float | half | in::to_uint16));
    CHECK((codes | in::to_float | (half | in::to_uint8)) == (codes | in::to_float | half | in::to_uint8));
}

TEST_CASE("An image may be filtered by a function of a pixel, of a pixel and its coordinates, or of the image") {
    const in::image<float> source{{0, 0.25f}, {0.5f, 1}};
    CHECK((source | [](float v) { return v * 0.5f; }) == in::image<float>{{0, 0.125f}, {0.25f, 0.5f}});
    CHECK((source | [](float v, int x, int y) { return v + static_cast<float>(10 * x + 100 * y); }) ==
          in::image<float>{{0, 10.25f}, {100.5f, 111}});
    CHECK((source | [](const in::image<float>& i) { return in::image<int>(i.width() + 1, i.height()); }).width() == 3);
    CHECK((source | [](const auto& i) { return in::image<int>(1, i.height()); }).height() == 2);
    CHECK((source | [](float v) -> std::uint8_t { return v > 0.4f; }) == in::image<std::uint8_t>{{0, 0}, {1, 1}});
    CHECK((source | in::filter_chain<>{}) == source);
}

TEST_CASE("A moved-in image is filtered in its own memory") {
    in::image<float> source = ramp(64, 64);
    const float* const memory = source.pixels().data();
    const in::image<float> out = std::move(source) | (in::speckle{.seed = 1} | in::gaussian{.seed = 2});
    CHECK(out.pixels().data() == memory);
    CHECK(out == (ramp(64, 64) | in::speckle{.seed = 1} | in::gaussian{.seed = 2}));
}

TEST_CASE("A filtered part of a larger image is packed, and the source is unchanged") {
    const in::image<float> source = ramp(10, 10);
    const in::image<float> before = source;
    const auto part = source.view().part(3, 4, 5, 2);
    const auto out = part | [](float v) { return -v; };
    CHECK(out.width() == 5);
    CHECK(out(4, 1) == -source(7, 5));
    CHECK(source == before);
}

TEST_CASE("Results don't depend on the executor", "[threads]") {
    in::thread_pool pool(3);
    const in::image<float> source = ramp(1031, 517);
    const auto look = in::match_histogram(ramp(50, 50)) | in::speckle{.seed = 3} | in::gaussian{.seed = 3} |
                      in::rayleigh{.seed = 3} | in::gaussian_speckle{.seed = 3} | in::poisson{.seed = 3};
    const in::image<float> serial = source | look;
    CHECK(apply(source, look, pool) == serial);
    CHECK(apply(source.view(), look, backwards{}) == serial);
    CHECK(apply(in::image<float>(source), look, pool) == serial);
    CHECK(apply(source, look) == serial);
}

/// Sums each pixel and the 40 above it, and counts the rows of a run that it reads for that.
struct sum_downwards {
    static constexpr int height = 40;
    in::image_view<const float> source;
    std::int64_t& read;

    struct pass_of_sums {
        const sum_downwards& filter;
        int x = -1, y = -1;  // of the last run
        float sum[in::run_length] = {};

        int rows_above() const { return height; }
        void row(const float*, float* to, int count, int column, int row) {
            if (column != x || row != y + 1) {
                std::fill_n(sum, count, 0.0f);
                for (int i = row - height; i < row; ++i) add(count, column, i, 1);
            }
            add(count, column, row, 1);
            std::copy_n(sum, count, to);
            if (row >= height) add(count, column, row - height, -1);
            x = column, y = row;
        }
        float operator()(float, int column, int row) {
            float one;
            this->row(nullptr, &one, 1, column, row);
            return one;
        }
        void add(int count, int column, int row, float factor) {
            if (row < 0) return;
            filter.read += factor > 0;
            for (int i = 0; i < count; ++i) sum[i] += factor * filter.source(column + i, row);
        }
    };
    auto pass() const { return pass_of_sums{*this}; }
};

TEST_CASE("A pass that computes rows above its band gets tall bands, walked downwards run by run") {
    in::image<float> picture(2000, 240);
    for (int y = 0; y < 240; ++y)
        for (int x = 0; x < 2000; ++x) picture(x, y) = static_cast<float>((x + y) % 7);
    std::int64_t read = 0;
    const auto sums = picture | sum_downwards{picture, read};
    for (int y = 0; y < 240; ++y)
        for (int x = 0; x < 2000; x += 37) {
            float sum = 0;
            for (int i = (std::max)(0, y - 40); i <= y; ++i) sum += picture(x, i);
            REQUIRE(sums(x, y) == sum);
        }
    // Four runs of three bands, which are twice as high as the rows above them.
    CHECK(read == 4 * (240 + 2 * 40));
    read = 0;
    const in::image<std::uint8_t> all(2000, 240, 1);
    CHECK((picture | in::where(all.view(), sum_downwards{picture, read})) == sums);
    CHECK(read == 4 * (240 + 2 * 40));
}

TEST_CASE("An origin whose columns and rows an int cannot number is refused") {
    const in::image<float> gray(600, 4, 0.5f);
    for (const in::pixel_origin& origin : {in::pixel_origin{INT_MAX - 10, 0}, in::pixel_origin{0, INT_MIN}})
        CHECK_THROWS_WITH(in::apply(gray, in::gaussian{.correlation = {3, 3}}, in::serial_executor{}, origin),
                          ContainsSubstring(origin.x != 0 ? "origin.x is 2147483637" : "origin.y is -2147483648"));
}

TEST_CASE("Empty and thin images pass through a chain of measured, noise and color filters") {
    const auto look = in::match_histogram(ramp(5, 5)) | in::speckle{} | in::colormap::copper | in::to_gray{};
    CHECK((in::image<float>() | look).empty());
    CHECK((in::image<float>(0, 7) | look).height() == 7);
    CHECK((in::image<float>(1, 1) | look).size() == 1);
    CHECK((in::image<float>(70000, 1, 0.5f) | look).width() == 70000);
    CHECK((in::image<float>(1, 70000, 0.5f) | look).height() == 70000);
}

TEST_CASE("Concepts tell library filters from other callables, and reject pixel types that a filter does not take") {
    const auto lambda = [](float v) { return v; };
    STATIC_REQUIRE(in::detail::library_filter<in::speckle>);
    STATIC_REQUIRE_FALSE(in::detail::library_filter<decltype(lambda)>);
    STATIC_REQUIRE_FALSE(in::detail::stage<in::image<float>>);
    STATIC_REQUIRE_FALSE(in::detail::stage<int>);
    STATIC_REQUIRE(in::filter_for<in::speckle, float>);
    STATIC_REQUIRE_FALSE(in::filter_for<in::speckle, std::int8_t>);
    STATIC_REQUIRE_FALSE(in::filter_for<in::speckle, double>);
    STATIC_REQUIRE_FALSE(in::filter_for<in::speckle, in::rgb<double>>);
    STATIC_REQUIRE_FALSE(in::filter_for<in::to_gray, float>);
    STATIC_REQUIRE_FALSE(in::filter_for<in::match_histogram, in::rgb8>);
}

TEST_CASE("A callable that takes any picture gets a copy, never the pixels of a view") {
    in::image<float> source(3, 2, 0.5f);
    const auto marked = [](auto picture) {
        picture.pixels()[0] = 1;  // which views don't have
        return picture;
    };
    for (const in::image<float>& result : {source | marked, source.view() | marked}) CHECK(result(0, 0) == 1);
    CHECK(source == in::image<float>(3, 2, 0.5f));
}

TEST_CASE("A callable may return booleans") {
    const in::image<bool> bright = in::image<float>{{0.2f, 0.7f}} | [](float v) { return v > 0.5f; };
    CHECK_FALSE(bright(0, 0));
    CHECK(bright(1, 0));
}

TEST_CASE("Quantization rounds to nearest, ties up, and has an exact inverse") {
    CHECK(in::quantize<std::uint8_t>(0.5f) == 128);  // 127.5
    CHECK(in::quantize<std::uint8_t>(std::nextafter(0.5f, 0.0f)) == 127);
    CHECK(in::quantize<std::uint8_t>(-1.0f) == 0);
    CHECK(in::quantize<std::uint8_t>(1e30f) == 255);
    CHECK(in::quantize<std::uint8_t>(std::numeric_limits<float>::infinity()) == 255);
    CHECK(in::quantize<std::uint8_t>(std::nanf("")) == 0);
    CHECK(in::quantize<std::uint16_t>(0.5f) == 32768);  // 32767.5
    CHECK(in::quantize<std::uint16_t>(std::nextafter(1.0f, 0.0f)) == 65535);

    bool same = true;
    for (int code = 0; code < 65536; ++code) {
        const auto wide = static_cast<std::uint16_t>(code);
        same = same && in::quantize<std::uint16_t>(in::dequantize(wide)) == wide;
        const auto narrow = static_cast<std::uint8_t>(code & 255);
        same = same && in::quantize<std::uint8_t>(in::dequantize(narrow)) == narrow;
    }
    CHECK(same);

    const in::image<std::uint8_t> codes{{0, 1, 128, 255}};
    CHECK((codes | in::to_float | in::to_uint8) == codes);
    CHECK((in::image<float>{{0.25f}} | in::to_uint16) == in::image<std::uint16_t>{{16384}});
    CHECK((in::image<in::rgb8>{{{255, 0, 51}}} | in::to_float) == in::image<in::rgb<float>>{{{1, 0, 0.2f}}});
    CHECK((in::image<in::rgb<float>>{{{1, 0, 0.2f}}} | in::to_uint8) == in::image<in::rgb8>{{{255, 0, 51}}});
}

TEST_CASE("Gray has MATLAB's weights by default") {
    // rgb2gray of the pure colours and of white, as documented by MathWorks: 76, 150, 29 and 255.
    const in::image<in::rgb8> colors{{{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}, {0, 0, 0}}};
    CHECK((colors | in::to_gray{}) == in::image<std::uint8_t>{{76, 150, 29, 255, 0}});
    CHECK((colors | in::to_gray{.weights = in::octave_weights}) == (colors | in::to_gray{}));
    CHECK((colors | in::to_gray{.weights = in::paper_weights}) == in::image<std::uint8_t>{{76, 150, 29, 255, 0}});
    CHECK((colors | in::to_gray{.weights = in::rec601_weights}) == in::image<std::uint8_t>{{76, 150, 29, 255, 0}});
    CHECK((colors | in::to_gray{.weights = in::rec709_weights}) == in::image<std::uint8_t>{{54, 182, 18, 255, 0}});
    const auto light = in::image<in::rgb<float>>{{{0.5f, 0.25f, 1}}} | in::to_gray{};
    CHECK(static_cast<double>(light(0, 0)) ==
          Approx(0.5 * 0.298936021293775 + 0.25 * 0.587043074451121 + 0.114020904255103).epsilon(1e-7));
    CHECK_THROWS_AS((colors | in::to_gray{{0.5, 0.6, 0.1}}), in::invalid_input);
    CHECK_THROWS_AS((colors | in::to_gray{{-0.1, 0.6, 0.1}}), in::invalid_input);
    CHECK_THROWS_AS((colors | in::to_gray{{std::nan(""), 0.6, 0.1}}), in::invalid_input);
}

TEST_CASE("Copper is MATLAB's copper(256)") {
    const auto& colors = in::colormap::copper.colors;
    CHECK(colors[0] == in::rgb8{0, 0, 0});
    CHECK(colors[255] == in::rgb8{255, 199, 127});
    CHECK(colors[203].r == 254);
    CHECK(colors[204].r == 255);
    // min(1, gray(256) * diag([1.25 0.7812 0.4975])), in doubles as MATLAB has it: within half a level everywhere.
    for (std::size_t level = 0; level < 256; ++level) {
        const double t = static_cast<double>(level) / 255;
        CHECK(std::abs(colors[level].r - 255 * std::fmin(1, 1.25 * t)) <= 0.5 + 1e-9);
        CHECK(std::abs(colors[level].g - 255 * 0.7812 * t) <= 0.5 + 1e-9);
        CHECK(std::abs(colors[level].b - 255 * 0.4975 * t) <= 0.5 + 1e-9);
    }
}

TEST_CASE("A colour map takes floats, codes and users' tables") {
    const in::image<float> values{{0, 0.5f, 1, -3, 7, std::nanf("")}};
    CHECK((values | in::colormap::copper) == (values | in::to_uint8 | in::colormap::copper));
    CHECK((values | in::colormap::gray) ==
          in::image<in::rgb8>{{{0, 0, 0}, {128, 128, 128}, {255, 255, 255}, {0, 0, 0}, {255, 255, 255}, {0, 0, 0}}});
    const in::color_table red = in::tabulate_colors([](int level) {
        return in::rgb8{static_cast<std::uint8_t>(level), 0, 0};
    });
    CHECK((values | red)(1, 0) == in::rgb8{128, 0, 0});
}

TEST_CASE("Hot is MATLAB's hot(256), and all maps of echoes rise from dark to light") {
    const auto& hot = in::colormap::hot.colors;
    for (std::size_t i = 0; i < 256; ++i) {
        // r = (1:n) / n over the first n = fix(3/8 m), then ones; g the same, n later; b over the rest.
        const double k = static_cast<double>(i + 1);
        CHECK(std::abs(hot[i].r - 255 * std::fmin(1, k / 96)) <= 0.5 + 1e-9);
        CHECK(std::abs(hot[i].g - 255 * std::fmin(1, std::fmax(0, (k - 96) / 96))) <= 0.5 + 1e-9);
        CHECK(std::abs(hot[i].b - 255 * std::fmax(0, (k - 192) / 64)) <= 0.5 + 1e-9);
    }
    for (const in::color_table& map :
         {in::colormap::copper, in::colormap::gray, in::colormap::hot, in::colormap::amber, in::colormap::sea}) {
        const auto light = [&](std::size_t i) {
            return 0.299 * map.colors[i].r + 0.587 * map.colors[i].g + 0.114 * map.colors[i].b;
        };
        for (std::size_t i = 1; i < 256; ++i) REQUIRE(light(i) >= light(i - 1) - 0.7);  // rounding
        CHECK(light(255) > light(0) + 180);
    }
    CHECK(in::colormap::amber.colors[0] == in::rgb8{0, 0, 0});
    CHECK(in::colormap::amber.colors[255] == in::rgb8{255, 244, 200});
    CHECK(in::colormap::inverse_gray.colors[250] == in::rgb8{5, 5, 5});
}
