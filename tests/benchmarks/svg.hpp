// SVG elements for the charts in docs/.
#pragma once

#include <cstdio>
#include <string>

namespace svg {

inline std::string number(double value, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

/// Text at a position; `more` is further attributes, as " font-weight='bold'".
inline std::string text(const std::string& x, const std::string& y, const std::string& what,
                        const std::string& more = {}) {
    return "<text x='" + x + "' y='" + y + "'" + more + ">" + what + "</text>\n";
}
inline std::string text(double x, double y, const std::string& what, const std::string& more = {}) {
    return text(number(x, 1), number(y, 1), what, more);
}

inline std::string rectangle(const std::string& x, const std::string& y, const std::string& width,
                             const std::string& height, const std::string& fill) {
    return "<rect x='" + x + "' y='" + y + "' width='" + width + "' height='" + height + "' fill='" + fill + "'/>\n";
}

inline std::string line(double x0, double y0, double x1, double y1, const std::string& stroke,
                        const std::string& more = {}) {
    return "<line x1='" + number(x0, 1) + "' y1='" + number(y0, 1) + "' x2='" + number(x1, 1) + "' y2='" +
           number(y1, 1) + "' stroke='" + stroke + "'" + more + "/>\n";
}

inline std::string circle(double x, double y, double radius, const std::string& fill, const std::string& more = {}) {
    return "<circle cx='" + number(x, 1) + "' cy='" + number(y, 1) + "' r='" + number(radius, 1) + "' fill='" + fill +
           "'" + more + "/>\n";
}

/// A white page of the given size in pixels.
inline std::string page(int width, int height, const std::string& body) {
    const std::string w = std::to_string(width), h = std::to_string(height);
    return "<svg xmlns='http://www.w3.org/2000/svg' width='" + w + "' height='" + h + "' viewBox='0 0 " + w + " " + h +
           "' font-family='sans-serif' font-size='13'>\n<rect width='100%' height='100%' " + "fill='white'/>\n" + body +
           "</svg>\n";
}

}  // namespace svg
