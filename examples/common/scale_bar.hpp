// A scale bar on a picture.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "text.hpp"

namespace examples {

/// The longest of 1, 2 and 5 times a power of ten that is no longer than `metres`.
inline double round_length(double metres) {
    const double decade = std::pow(10.0, std::floor(std::log10(metres)));
    return decade * (metres >= 5 * decade ? 5 : metres >= 2 * decade ? 2 : 1);
}

/// Draws a bar of a round length, at most a third of the tile, and its metres into the tile's lower right corner.
///
/// @param right, bottom  one past the tile's last column and row
/// @param width, metres  the tile's width in pixels, at least that of the label, and in metres
template <class Pixel>
void draw_scale_bar(insonify::image<Pixel>& sheet, int right, int bottom, int width, double metres, const Pixel& ink,
                    const Pixel& paper) {
    constexpr int margin = 3, height = 16, glyph = 6;
    const double length = round_length(metres / 3);
    char label[32];
    std::snprintf(label, sizeof label, "%g m", length);
    const int bar = static_cast<int>(std::lround(width * length / metres));
    const int text = glyph * static_cast<int>(std::char_traits<char>::length(label));
    const int left = right - std::max(bar, text) - 2 * margin, top = bottom - height;
    for (int y = top; y < bottom; ++y) std::fill_n(sheet.row(y).begin() + left, right - left, paper);
    for (int y = bottom - 4; y < bottom - 2; ++y) std::fill_n(sheet.row(y).begin() + left + margin, bar, ink);
    write_text(sheet, left + margin, top + 2, label, ink);
}

}  // namespace examples
