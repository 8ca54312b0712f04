// Noise on every pixel type, with maps of parameters, on parts of images and in the caller's memory; extremes.
#include <insonify/core/thread_pool.hpp>
#include <insonify/filter/convert.hpp>
#include <insonify/filter/echo_noise.hpp>
#include <insonify/filter/histogram.hpp>
#include <insonify/filter/noise.hpp>
#include <insonify/filter/pipe.hpp>
#include <insonify/filter/poisson.hpp>
#include <insonify/filter/where.hpp>

#include <algorithm>
#include <cmath>

#include "../../catch.hpp"
#include "../../moments.hpp"

namespace in = insonify;

namespace {

using moments::correlation;

in::image<float> stripes(int width, int height) {
    in::image<float> out(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) out(x, y) = static_cast<float>((7 * x + 13 * y) % 257) / 256.0f;
    return out;
}

template <class T, class Get>
in::image<float> channel(const in::image<T>& source, Get get) {
    return source | [get](const T& color) { return static_cast<float>(get(color)); };
}

/// A user's filter in five lines: shifts values and wraps them at 1.
struct shifted {
    float by = 0.25f;
    using is_filter = std::true_type;
    float operator()(float v) const { return v + by > 1 ? v + by - 1 : v + by; }
};

}  // namespace

TEMPLATE_TEST_CASE("Noise on codes is the rounded noise on their float values", "", in::gaussian, in::speckle,
                   in::gaussian_speckle, in::salt_and_pepper, in::rayleigh, in::gamma_speckle, in::k_speckle,
                   in::rician, in::poisson) {
    const TestType noise{.seed = 5, .frame = 2};
    const auto codes = stripes(150, 40) | in::to_uint8;
    CHECK((codes | noise) == (codes | in::to_float | noise | in::to_uint8));
    const auto wide = stripes(150, 40) | in::to_uint16;
    CHECK((wide | noise) == (wide | in::to_float | noise | in::to_uint16));
}

TEMPLATE_TEST_CASE("Each channel of a colour has noise of its own, and the first that of a gray image", "",
                   in::gaussian, in::speckle, in::gaussian_speckle, in::salt_and_pepper, in::rayleigh,
                   in::gamma_speckle, in::k_speckle, in::rician, in::poisson) {
    const TestType noise{.seed = 6};
    const in::image<in::rgb<float>> colors(512, 256, {0.2f, 0.2f, 0.2f});
    const auto noisy = colors | noise;
    const auto r = channel(noisy, [](const auto& c) { return c.r; });
    const auto g = channel(noisy, [](const auto& c) { return c.g; });
    const auto b = channel(noisy, [](const auto& c) { return c.b; });
    CHECK(r == (in::image<float>(512, 256, 0.2f) | noise));
    CHECK(std::abs(correlation(r, g)) < 0.0125);
    CHECK(std::abs(correlation(g, b)) < 0.0125);
    CHECK(std::abs(correlation(r, b)) < 0.0125);

    const in::image<in::rgb8> codes(64, 8, {51, 102, 153});
    CHECK((codes | noise) == (codes | in::to_float | noise | in::to_uint8));
    const in::image<in::rgb<std::uint16_t>> wide(64, 8, {13107, 26214, 39321});
    CHECK((wide | noise) == (wide | in::to_float | noise | in::to_uint16));
}

TEMPLATE_TEST_CASE("Parts filtered with their origin have the noise of the whole image", "", in::gaussian, in::speckle,
                   in::gaussian_speckle, in::salt_and_pepper, in::rayleigh, in::gamma_speckle, in::k_speckle,
                   in::rician, in::poisson) {
    const TestType noise{.seed = 7};
    const auto source = stripes(1100, 9);
    const auto whole = source | noise;
    for (const auto [x, y, width, height] : {std::array{0, 0, 1100, 9},
                                             {1, 2, 3, 4},
                                             {511, 0, 2, 9},
                                             {513, 8, 587, 1},
                                             {7, 3, 1050, 2},
                                             {1099, 8, 1, 1}}) {
        const auto part = apply(source.view().part(x, y, width, height), noise, in::serial_executor{}, {x, y});
        CHECK(part == in::image<float>(whole.view().part(x, y, width, height)));
    }
}

TEST_CASE("Correlated noise doesn't depend on parts, rows or threads either") {
    const auto noise = in::gaussian{.correlation = {2, 3}, .seed = 1} |
                       in::gamma_speckle{.looks = 2, .correlation = {1, 2}, .seed = 1};
    const auto source = stripes(1030, 300);
    const auto whole = source | noise;
    in::thread_pool pool(3);
    CHECK(apply(source, noise, pool) == whole);
    const auto part = apply(source.view().part(500, 20, 40, 30), noise, in::serial_executor{}, {500, 20});
    CHECK(part == in::image<float>(whole.view().part(500, 20, 40, 30)));
    // Negative origins are allowed.
    const in::image<float> even(1030, 300, 0.4f);
    const auto moved = apply(even, noise, in::serial_executor{}, {-40, -7});
    CHECK(in::image<float>(moved.view().part(40, 7, 990, 293)) == (in::image<float>(990, 293, 0.4f) | noise));
}

TEST_CASE("Filters write into the caller's memory, and in place") {
    const auto source = stripes(700, 5);
    const auto look = in::speckle{.seed = 1} | shifted{} | in::to_uint8;
    in::image<std::uint8_t> codes(800, 7, 9);
    in::apply_into(source.view(), codes.view().part(50, 1, 700, 5), look);
    CHECK(in::image<std::uint8_t>(codes.view().part(50, 1, 700, 5)) == (source | look));
    CHECK(codes(49, 1) == 9);
    CHECK(codes(750, 5) == 9);
    CHECK_THROWS_AS(in::apply_into(source.view(), codes.view(), look), in::invalid_input);

    auto pixels = source;
    const auto grain = in::gaussian{.seed = 2} | in::equalize{} | shifted{.by = 0.1f};
    in::apply_in_place(pixels.view().part(100, 1, 300, 3), grain);
    CHECK(in::image<float>(pixels.view().part(100, 1, 300, 3)) == (source.view().part(100, 1, 300, 3) | grain));
    CHECK(pixels(99, 1) == source(99, 1));
    CHECK(pixels(400, 3) == source(400, 3));
    const auto before = pixels;
    in::apply_in_place(pixels.view(), in::filter_chain<>{});
    CHECK(pixels == before);
}

TEST_CASE("A parameter by pixel or by type applies to each pixel") {
    const auto source = stripes(600, 4);
    in::image<std::uint8_t> types(600, 4);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 600; ++x) types(x, y) = static_cast<std::uint8_t>((x / 3 + y) % 4);
    const std::vector<float> by_type{0, 0.01f, 0.3f};  // type 3 takes the last
    const auto map = types | [&](std::uint8_t t) { return by_type[(std::min)(std::size_t{t}, std::size_t{2})]; };

    const auto check = [&](auto with) {
        const auto one = source | with(in::parameter(map.view()));
        CHECK((source | with(in::parameter(types, by_type))) == one);
        for (std::size_t t = 0; t < 4; ++t) {
            const auto same = source | with(in::parameter(by_type[(std::min)(t, std::size_t{2})]));
            for (std::size_t i = 0; i < source.size(); ++i)
                if (types.pixels()[i] == t) REQUIRE(one.pixels()[i] == same.pixels()[i]);
        }
        const auto part =
            apply(source.view().part(50, 1, 530, 2), with(in::parameter(types.view().part(50, 1, 530, 2), by_type)),
                  in::serial_executor{}, {50, 1});
        CHECK(part == in::image<float>(one.view().part(50, 1, 530, 2)));
        CHECK_THROWS_AS((source | with(in::parameter(map.view().part(0, 0, 599, 4)))), in::invalid_input);
        CHECK_THROWS_AS((source | with(in::parameter(types.view().part(0, 0, 600, 3), by_type))), in::invalid_input);
    };
    check([](in::parameter p) { return in::gaussian{.variance = p, .seed = 3}; });
    check([](in::parameter p) { return in::speckle{.variance = p, .seed = 3}; });
    check([](in::parameter p) { return in::gaussian_speckle{.variance = p, .correlation = {1, 1}, .seed = 3}; });
    check([](in::parameter p) { return in::salt_and_pepper{.density = p, .seed = 3}; });
    check([](in::parameter p) { return in::rician{.steady = p, .seed = 3}; });
    const in::speckle held{.variance = 0.1f, .seed = 3};
    in::speckle source_of_move = held;
    const in::speckle moved = std::move(source_of_move);
    for (const in::speckle& filter : {source_of_move, moved}) CHECK((source | filter) == (source | held));

    in::image<float> bad = map;
    bad(599, 3) = -1;
    CHECK_THROWS_WITH((source | in::speckle{.variance = bad.view()}), ContainsSubstring("speckle.variance is -1"));
    CHECK_THROWS_AS(in::parameter(types, std::vector<float>{}), in::invalid_input);
}

TEST_CASE("Under a mask, a filter changes and measures the chosen pixels alone") {
    const auto source = stripes(600, 30);
    const auto mask = source | [](float v) -> std::uint8_t { return v > 0.3f && v < 0.6f ? 2 : 0; };
    const auto reference = stripes(40, 40) | shifted{};
    const in::match_binned match(reference);
    const auto out = source | in::where(mask, match);
    const auto chosen = in::pixels_where(mask, source);
    CHECK(in::pixels_where(mask, out) == (chosen | match));
    in::thread_pool pool(3);
    CHECK(in::apply(source, in::where(mask, in::equalize{}), pool) == (source | in::where(mask, in::equalize{})));
    const auto others = mask | [](std::uint8_t m) -> std::uint8_t { return m == 0; };
    CHECK(in::pixels_where(others, out) == in::pixels_where(others, source));

    const auto noisy = source | in::speckle{.seed = 1}, some = source | in::where(mask, in::speckle{.seed = 1});
    for (std::size_t i = 0; i < source.size(); ++i)
        REQUIRE(some.pixels()[i] == (mask.pixels()[i] != 0 ? noisy : source).pixels()[i]);

    CHECK((source | in::where(mask, in::speckle{.seed = 1} | in::equalize{})) ==
          (some | in::where(mask, in::equalize{})));
    const auto part = in::apply(source.view().part(20, 10, 500, 15),
                                in::where(mask.view().part(20, 10, 500, 15), in::speckle{.seed = 1}),
                                in::serial_executor{}, {20, 10});
    CHECK(part == in::image<float>(some.view().part(20, 10, 500, 15)));

    // A temporary mask is kept; had it been freed, the zeros would be in its memory.
    const auto copy_of_mask = [&] { return in::image<std::uint8_t>(mask); };
    const auto kept = in::where(copy_of_mask(), in::speckle{.seed = 1});
    const in::image<std::uint8_t> zeros(600, 30);
    CHECK((source | kept) == some);
    const auto chain = in::where(copy_of_mask(), in::speckle{.seed = 1} | in::equalize{});
    const in::image<std::uint8_t> more_zeros = zeros;
    CHECK((source | chain) == (source | in::where(mask, in::speckle{.seed = 1} | in::equalize{})));

    const auto constant = [&]() -> const in::image<std::uint8_t> { return mask; };
    const auto copied = in::where(constant(), in::speckle{.seed = 1});
    const in::image<std::uint8_t> again_zeros = zeros;
    CHECK((source | copied) == some);
    const auto move_only = [shift = std::make_unique<float>(0.25f)](float v) { return v + *shift; };
    static_assert(!std::is_copy_constructible_v<decltype(move_only)>);
    CHECK((source | in::where(mask, [shift = std::make_unique<float>(0.25f)](float v) { return v + *shift; })) ==
          (source | in::where(mask, [](float v) { return v + 0.25f; })));

    const in::image<std::uint8_t> none(600, 30);
    CHECK((source | in::where(none, match)) == source);
    CHECK((source | in::where(none, in::equalize{} | shifted{})) == source);
    CHECK(in::pixels_where(none, source).empty());
    CHECK_THROWS_AS((source | in::where(mask.view().part(0, 0, 599, 30), match)), in::invalid_input);
    CHECK_THROWS_AS((source | in::where(mask.view().part(0, 0, 599, 30), in::speckle{})), in::invalid_input);
}

TEST_CASE("Poisson on codes of 16 bits with 65535 photons: the codes are the counts") {
    const in::image<std::uint16_t> wide(300, 200, 1000);
    double mean = 0, square = 0;
    const auto counts = wide | in::poisson{.photons = 65535, .seed = 4};
    for (const std::uint16_t v : counts.pixels()) {
        mean += v / 6e4;
        square += (v - 1000.0) * (v - 1000.0) / 6e4;
    }
    CHECK(std::abs(mean - 1000) < 4 * std::sqrt(1000 / 6e4));
    CHECK(std::abs(square - 1000) < 4 * 1000 * std::sqrt(2 / 6e4));
}

TEST_CASE("Noise on codes reaches the lowest and the highest code") {
    const auto struck = in::image<std::uint16_t>(64, 64, 777) | in::salt_and_pepper{.density = 0.5f};
    CHECK(std::count(struck.pixels().begin(), struck.pixels().end(), 65535) > 800);
    CHECK(std::count(struck.pixels().begin(), struck.pixels().end(), 0) > 800);
    CHECK(std::count(struck.pixels().begin(), struck.pixels().end(), 777) > 1800);
    in::image<std::uint16_t> all(256, 256);
    for (std::size_t i = 0; i < all.size(); ++i) all.pixels()[i] = static_cast<std::uint16_t>(i);
    CHECK((all | in::gaussian{.variance = 0}) == all);
    CHECK((all | in::speckle{.variance = 0}) == all);
}

TEST_CASE("Salt and pepper each strike half of the density") {
    for (const float density : {0.0f, 1e-6f, 0.05f, 1.0f}) {
        const auto out = in::image<float>(1024, 1024, 0.5f) | in::salt_and_pepper{.density = density, .seed = 8};
        for (const float end : {0.0f, 1.0f}) {
            const auto found = static_cast<double>(std::count(out.pixels().begin(), out.pixels().end(), end));
            const double expected = 0.5 * static_cast<double>(density) * static_cast<double>(out.size());
            CHECK(std::abs(found - expected) <= 4 * std::sqrt(expected));
        }
    }
    CHECK(std::isnan((in::image<float>{{std::nanf("")}} | in::salt_and_pepper{.density = 1})(0, 0)));
    for (const float bad : {-0.1f, 1.1f, std::nanf("")})
        CHECK_THROWS_AS((in::image<float>(1, 1) | in::salt_and_pepper{.density = bad}), in::invalid_input);
}

TEMPLATE_TEST_CASE("Noise accepts images of no pixel, one pixel, one row and one column", "", in::gaussian, in::speckle,
                   in::gaussian_speckle, in::salt_and_pepper, in::rayleigh, in::gamma_speckle, in::k_speckle,
                   in::rician, in::poisson) {
    for (const auto [width, height] : {std::array{0, 0}, {0, 3}, {3, 0}, {1, 1}, {1, 700}, {70000, 1}}) {
        const auto out = in::image<float>(width, height, 0.5f) | TestType{};
        CHECK(out.width() == width);
        CHECK(out.height() == height);
        CHECK(std::all_of(out.pixels().begin(), out.pixels().end(), [](float v) { return v >= 0 && v <= 1; }));
    }
}

TEST_CASE("Poisson noise takes means from 1e-6 to 1e9, and infinite pixels become white") {
    const float inf = std::numeric_limits<float>::infinity();
    CHECK((in::image<float>{{0, -inf, 1e-6f}} | in::poisson{.photons = 1}) == in::image<float>{{0, 0, 0}});
    const auto white = in::image<float>{{inf, 1}} | in::poisson{.photons = 1e9f};
    CHECK(white(0, 0) == Approx(1).margin(2e-4));
    CHECK(white(1, 0) == Approx(1).margin(2e-4));
    const auto clipped = in::image<float>{{inf, -inf}};
    CHECK((clipped | in::gaussian{.variance = 0}) == in::image<float>{{1, 0}});
    // Noise a million times as wide as the range leaves only black and white.
    const auto wide = in::image<float>(64, 64, 0.5f) | in::gaussian{.variance = 1e12f};
    CHECK(std::count_if(wide.pixels().begin(), wide.pixels().end(), [](float v) { return v > 0 && v < 1; }) <= 1);
}

TEST_CASE("Filters accept a view of 32768 x 32768 pixels", "[.slow]") {
    in::image<std::uint8_t> large(32768, 32768, 128);
    in::thread_pool pool(2);
    const auto noise = in::gaussian{.seed = 1} | in::speckle{.seed = 1};
    in::apply_in_place(large.view(), noise, pool);
    for (const auto [x, y] : {std::array{0, 0}, {32700, 32700}, {12345, 31000}}) {
        const auto part = apply(in::image<std::uint8_t>(68, 68, 128), noise, in::serial_executor{}, {x, y});
        CHECK(part == in::image<std::uint8_t>(large.view().part(x, y, 68, 68)));
    }
    CHECK(in::histogram_of(large, 256, pool).total() == std::uint64_t{1} << 30);
    in::apply_in_place(large.view(), in::equalize{}, pool);
}
