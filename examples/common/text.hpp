// Captions on pictures.
#pragma once

#include <insonify/core/image.hpp>

#if __has_include(<stb_easy_font.h>)
#include <stb_easy_font.h>
#else
#include <stb/stb_easy_font.h>
#endif

#include <string>
#include <vector>

namespace examples {

/// Writes a line of text, about 10 pixels high, with its upper left corner at (x, y), clipped to the image.
template <class Pixel>
void write_text(insonify::image<Pixel>& sheet, int x, int y, std::string text, const Pixel& color) {
    struct corner {
        float x, y, z;
        unsigned char color[4];
    };
    // stb's font has the characters of ASCII.
    for (char& c : text)
        if (c < ' ' || c > '~') c = '?';
    std::vector<corner> corners(4096);
    const int quads = stb_easy_font_print(0, 0, text.data(), nullptr, corners.data(),
                                          static_cast<int>(corners.size() * sizeof(corner)));
    for (std::size_t q = 0; q < static_cast<std::size_t>(quads); ++q) {
        const corner &from = corners[4 * q], &to = corners[4 * q + 2];
        for (int v = static_cast<int>(from.y); v < static_cast<int>(to.y); ++v)
            for (int u = static_cast<int>(from.x); u < static_cast<int>(to.x); ++u)
                if (x + u >= 0 && x + u < sheet.width() && y + v >= 0 && y + v < sheet.height())
                    sheet(x + u, y + v) = color;
    }
}

}  // namespace examples
