// Colour maps as tables of 256 colours: `image | colormap::copper`.
#pragma once

#include <insonify/core/image.hpp>
#include <insonify/core/quantize.hpp>
#include <insonify/filter/concept.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <type_traits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// The colour of each gray level. Floats in [0, 1] take the colour of the nearest level; NaN that of level 0.
struct color_table {
    std::array<rgb8, 256> colors;

    using is_filter = std::true_type;

    template <std::same_as<std::uint8_t> Level>
    INSONIFY_MEMBER constexpr rgb8 operator()(Level level) const {
        return colors[level];
    }
    template <std::same_as<float> Value>
    INSONIFY_MEMBER constexpr rgb8 operator()(Value value) const {
        return colors[quantize<std::uint8_t>(value)];
    }
    template <std::same_as<float> Value>
    INSONIFY_TAGGED void row(const Value* from, rgb8* to, int count, int, int) const {
        std::uint8_t codes[run_length];
        quantize_row(from, codes, count);
        for (int i = 0; i < count; ++i) to[i] = colors[codes[i]];
    }
};

inline namespace INSONIFY_FLAGS {

/// Tabulates `color(level)` for levels 0 to 255.
template <class Fn>
constexpr color_table tabulate_colors(Fn color) {
    color_table table{};
    for (int level = 0; level < 256; ++level) table.colors[static_cast<std::size_t>(level)] = color(level);
    return table;
}

}  // namespace INSONIFY_FLAGS

namespace detail::inline INSONIFY_FLAGS {

/// Piecewise linear through five colours at levels 0, 63.75, 127.5, 191.25 and 255; ties round up.
constexpr rgb8 between_colors(int level, const std::array<rgb8, 5>& colors) {
    const int quarter = (std::min)(4 * level / 255, 3), weight = 4 * level - 255 * quarter;  // of 255
    const rgb8 &a = colors[static_cast<std::size_t>(quarter)], &b = colors[static_cast<std::size_t>(quarter) + 1];
    const auto mix = [weight](int from, int to) {
        return static_cast<std::uint8_t>((2 * ((255 - weight) * from + weight * to) + 255) / 510);
    };
    return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

}  // namespace detail::inline INSONIFY_FLAGS

namespace colormap {

/// MATLAB's copper(256): red min(1, 1.25 t), green 0.7812 t, blue 0.4975 t at t = level / 255, each to the nearest of
/// 0 ... 255 in exact arithmetic, ties up.
inline constexpr color_table copper = tabulate_colors([](int level) {
    const int red = (5 * level + 2) / 4;
    return rgb8{static_cast<std::uint8_t>(red < 255 ? red : 255),
                static_cast<std::uint8_t>((7812 * level + 5000) / 10000),
                static_cast<std::uint8_t>((4975 * level + 5000) / 10000)};
});

/// Gray as colour, for files of three channels.
inline constexpr color_table gray = tabulate_colors([](int level) {
    const auto value = static_cast<std::uint8_t>(level);
    return rgb8{value, value, value};
});

/// Black through red and yellow to white: MATLAB's hot(256), whose red is full at 3/8, green at 6/8 of the way.
inline constexpr color_table hot = tabulate_colors([](int level) {
    const auto ramp = [](int i, int length) {
        return static_cast<std::uint8_t>(i <= 0 ? 0 : i < length ? (510 * i + length) / (2 * length) : 255);
    };
    return rgb8{ramp(level + 1, 96), ramp(level + 1 - 96, 96), ramp(level + 1 - 192, 64)};
});

/// The amber of side-scan displays and printed records: black, brown, amber and pale yellow, piecewise linear.
inline constexpr color_table amber = tabulate_colors([](int level) {
    return detail::between_colors(level, {{{0, 0, 0}, {74, 40, 8}, {158, 92, 16}, {230, 164, 48}, {255, 244, 200}}});
});

/// The blue of other waterfall displays: black, blue-green and white, piecewise linear.
inline constexpr color_table sea = tabulate_colors([](int level) {
    return detail::between_colors(level, {{{0, 0, 0}, {0, 40, 72}, {0, 104, 136}, {88, 184, 192}, {255, 255, 255}}});
});

/// Inverted gray, as on paper recorders.
inline constexpr color_table inverse_gray = tabulate_colors([](int level) {
    const auto value = static_cast<std::uint8_t>(255 - level);
    return rgb8{value, value, value};
});

}  // namespace colormap
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
