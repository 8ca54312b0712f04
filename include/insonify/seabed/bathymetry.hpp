// Readers of surveyed bathymetry: heightfields from Esri ASCII grids and lists of soundings.
//
// The parsers take text: `parse_esri_grid(read_file("bottom.asc"))`. For images of heights (16-bit PGM, PFM) use
// `read_netpbm` and `from_image`. Cells without data are NaN, which are holes of a heightfield; `fill_gaps` closes
// them.
//
// Source: Esri. ASCII Raster Format (ArcGIS documentation, "Esri ASCII raster format").
#pragma once

#include <insonify/seabed/heightfield.hpp>

#include <algorithm>
#include <charconv>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

namespace detail::inline INSONIFY_FLAGS {

/// Splits a text into words and numbers; errors name the line.
class survey_reader {
  public:
    survey_reader(std::string_view text, std::string_view name) : text_(text), name_(name) {
        if (text_.substr(0, 3) == "\xEF\xBB\xBF") at_ = 3;  // byte order mark
    }

    /// The next word, on this line or a later one; empty at the end. Commas and semicolons separate words like blanks.
    std::string_view word() {
        for (; at_ < text_.size() && is_blank(text_[at_]); ++at_) line_ += ends_line(at_) ? 1u : 0u;
        return word_here();
    }
    /// The next word of this line; empty at its end.
    std::string_view word_of_line() {
        while (at_ < text_.size() && is_blank(text_[at_]) && !is_line_break(text_[at_])) ++at_;
        return word_here();
    }
    std::string_view peek() {
        const std::size_t at = at_, line = line_;
        const std::string_view next = word();
        at_ = at, line_ = line;
        return next;
    }
    void skip_line() {
        while (at_ < text_.size() && !is_line_break(text_[at_])) ++at_;
    }

    /// @param what  for the error
    double number(const char* what) { return number(word(), what); }
    double number(std::string_view digits, const char* what) const {
        if (digits.empty())
            fail((at_ < text_.size() ? "the line ends before " : "the text ends before ") + std::string(what));
        double value = 0;
        if (insonify::detail::parse_number(digits, value) != insonify::detail::number_text::fine)
            fail(insonify::detail::quoted(digits) + " is not a number, expected " + what);
        return value;
    }
    double finite(const char* what) {
        const double value = number(what);
        if (!numeric::is_finite(value)) fail(std::string(what) + " is not finite");
        return value;
    }

    std::size_t left() const { return text_.size() - at_; }

    [[noreturn]] void fail(const std::string& reason) const {
        insonify::detail::raise(io_error(std::string(name_) + ":" + insonify::detail::to_text(line_) + ": " + reason));
    }

  private:
    std::string_view word_here() {
        const std::size_t begin = at_;
        while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
        return text_.substr(begin, at_ - begin);
    }
    static bool is_line_break(char c) { return c == '\n' || c == '\r'; }
    /// LF, CR LF and CR each end one line.
    bool ends_line(std::size_t at) const {
        return text_[at] == '\n' || (text_[at] == '\r' && text_.substr(at + 1, 1) != "\n");
    }
    static bool is_blank(char c) { return (c >= '\t' && c <= '\r') || c == ' ' || c == ',' || c == ';'; }

    std::string_view text_, name_;
    std::size_t at_ = 0, line_ = 1;
};

/// A height within 1000 km; NaN for anything else, such as codes for missing data.
inline float height_or_nothing(double metres) {
    return metres > -1e6 && metres < 1e6 ? static_cast<float>(metres) : (std::numeric_limits<float>::quiet_NaN)();
}

inline void require_position(const survey_reader& text, double x, double y) {
    if (!(x >= -1e9 && x <= 1e9 && y >= -1e9 && y <= 1e9)) text.fail("a position is not within 1e9 metres");
}

inline bool same_word(std::string_view a, std::string_view b) {
    const auto low = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return low(x) == low(y); });
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Reads an Esri ASCII grid: ncols, nrows, xllcorner or xllcenter, yllcorner or yllcenter, cellsize, maybe
/// nodata_value, then the heights row by row from the north. Vertices stand at the centres of its cells.
/// @param scale  metres up per unit of the file; -1 for depths in metres
/// @param name   of the text, for errors
/// @throws io_error for a text that isn't such a grid, saying which line and why
inline heightfield parse_esri_grid(std::string_view text, float scale = 1, std::string_view name = "grid") {
    detail::require(numeric::is_finite(scale), "scale", scale, "a finite factor");
    detail::survey_reader in(text, name);
    double columns = 0, rows = 0, cell = 0, x = 0, y = 0, no_data = -9999;
    bool has_x = false, has_y = false, corner_x = false, corner_y = false;
    for (;;) {
        const std::string_view key = in.peek();
        const bool is_key = !key.empty() && ((key[0] >= 'a' && key[0] <= 'z') || (key[0] >= 'A' && key[0] <= 'Z')) &&
                            !detail::same_word(key, "nan");
        if (!is_key) break;
        in.word();
        const auto is = [&](std::string_view word) { return detail::same_word(key, word); };
        if (is("ncols"))
            columns = in.finite("ncols");
        else if (is("nrows"))
            rows = in.finite("nrows");
        else if (is("cellsize"))
            cell = in.finite("cellsize");
        else if (is("xllcorner") || is("xllcenter"))
            x = in.finite("xllcorner"), has_x = true, corner_x = is("xllcorner");
        else if (is("yllcorner") || is("yllcenter"))
            y = in.finite("yllcorner"), has_y = true, corner_y = is("yllcorner");
        else if (is("nodata_value"))
            no_data = in.number("nodata_value");
        else
            in.fail("'" + std::string(key.substr(0, 40)) +
                    "' is not a keyword of an Esri grid's header, such as ncols");
    }
    const auto whole = [](double n) {
        return n >= 2 && n <= (1 << 24) && n == static_cast<double>(static_cast<int>(n));
    };
    if (!whole(columns)) in.fail("ncols is missing or not an integer from 2 to 2^24");
    if (!whole(rows)) in.fail("nrows is missing or not an integer from 2 to 2^24");
    if (!has_x || !has_y) in.fail("xllcorner or yllcorner is missing");
    if (!(cell > 0 && cell < 1e6)) in.fail("cellsize is missing or not above 0");
    // A height takes two characters at least: refuse headers of grids larger than the text before allocating.
    if (columns * rows > static_cast<double>(in.left() / 2 + 1))
        in.fail("the text is too short for ncols x nrows heights");
    const glm::dvec2 origin(x + (corner_x ? 0.5 * cell : 0), y + (corner_y ? 0.5 * cell : 0));
    detail::require_position(in, origin.x, origin.y);

    heightfield field{
        .heights = image<float>(static_cast<int>(columns), static_cast<int>(rows)), .origin = origin, .spacing = cell};
    for (int j = field.heights.height() - 1; j >= 0; --j)
        for (float& h : field.heights.row(j)) {
            const double value = in.number("a height");
            h = value == no_data ? (std::numeric_limits<float>::quiet_NaN)()
                                 : detail::height_or_nothing(static_cast<double>(scale) * value);
        }
    if (!in.word().empty()) in.fail("the text goes on after ncols x nrows heights");
    return field;
}

/// Reads soundings, an `x y z` on each line, onto a grid: each vertex has the mean of the soundings that are nearest to
/// it, or NaN if there is none. Lines end with LF, CR LF or CR. Lines that do not begin with a number are skipped, and
/// so is the rest of a line after z.
/// @param spacing  metres between vertices, > 0; vertices are multiples of it
/// @param scale    metres up per unit of z; -1 for depths in metres
/// @param name     of the text, for errors
/// @throws io_error for a text without soundings, an Esri grid, a line of fewer than three numbers, or soundings so far
/// apart that there are more than 1024 vertices for each, or more than 2^26
inline heightfield parse_xyz(std::string_view text, double spacing, float scale = 1, std::string_view name = "xyz") {
    detail::require(spacing > 0 && spacing < 1e6, "spacing", spacing, "metres above 0");
    detail::require(numeric::is_finite(scale), "scale", scale, "a finite factor");
    detail::survey_reader in(text, name);
    struct sounding {
        std::int64_t column, row;
        double height;
    };
    std::vector<sounding> soundings;
    std::int64_t left = (std::numeric_limits<std::int64_t>::max)(), low = left, right = -left, high = -left;
    for (std::string_view first; !(first = in.word()).empty(); in.skip_line()) {
        const bool is_number =
            (first[0] >= '0' && first[0] <= '9') || first[0] == '-' || first[0] == '+' || first[0] == '.';
        if (!is_number) {
            // Its rows of heights would be taken for positions.
            if (detail::same_word(first, "ncols")) in.fail("this is an Esri ASCII grid: parse_esri_grid reads it");
            continue;
        }
        const double x = in.number(first, "an x"), y = in.number(in.word_of_line(), "a y"),
                     z = in.number(in.word_of_line(), "a z");
        detail::require_position(in, x, y);
        const std::int64_t column = numeric::floor_to_int(x / spacing + 0.5),
                           row = numeric::floor_to_int(y / spacing + 0.5);
        left = (std::min)(left, column), right = (std::max)(right, column);
        low = (std::min)(low, row), high = (std::max)(high, row);
        soundings.push_back({column, row, static_cast<double>(scale) * z});
    }
    if (soundings.empty()) in.fail("there are no soundings");
    const std::int64_t width = (std::max)(right - left + 1, std::int64_t{2}),
                       height = (std::max)(high - low + 1, std::int64_t{2});
    // Bounds the memory that two distant soundings may cost.
    const double max_vertices = (std::min)(1024.0 * static_cast<double>(soundings.size()), 67108864.0);
    if (static_cast<double>(width) * static_cast<double>(height) > max_vertices)
        in.fail("the soundings are too far apart, more than 1024 vertices for each or 2^26: take a larger spacing");

    heightfield field{.heights = image<float>(static_cast<int>(width), static_cast<int>(height)),
                      .origin = {spacing * static_cast<double>(left), spacing * static_cast<double>(low)},
                      .spacing = spacing};
    image<double> sums(field.heights.width(), field.heights.height(), 0.0);
    image<std::uint32_t> counts(field.heights.width(), field.heights.height(), 0u);
    for (const sounding& s : soundings) {
        const float known = detail::height_or_nothing(s.height);
        if (!numeric::is_finite(known)) continue;
        const int i = static_cast<int>(s.column - left), j = static_cast<int>(s.row - low);
        sums(i, j) += s.height;
        ++counts(i, j);
    }
    for (std::size_t k = 0; k < sums.size(); ++k)
        field.heights.pixels()[k] = counts.pixels()[k] > 0 ? static_cast<float>(sums.pixels()[k] / counts.pixels()[k])
                                                           : (std::numeric_limits<float>::quiet_NaN)();
    return field;
}

/// Closes gaps from their edges inwards: in each step, a missing vertex becomes the mean of those of its eight
/// neighbours that were known before.
/// @param reach  number of steps: vertices that a gap is closed by from each side; the rest stays NaN
/// @throws invalid_input as `validate`, and for a reach below 0
inline heightfield fill_gaps(heightfield field, int reach = 1 << 30) {
    validate(field);
    detail::require(reach >= 0, "reach", reach, "at least 0");
    image<float>& heights = field.heights;
    const int width = heights.width(), height = heights.height();
    struct vertex {
        int i, j;
        float value;
    };
    std::vector<vertex> missing;
    for (int j = 0; j < height; ++j)
        for (int i = 0; i < width; ++i)
            if (!numeric::is_finite(heights(i, j))) missing.push_back({i, j, 0});
    for (int step = 0; step < reach && !missing.empty(); ++step) {
        std::vector<vertex> filled, others;
        for (const vertex& v : missing) {
            float sum = 0, count = 0;
            for (int j = (std::max)(v.j - 1, 0); j <= (std::min)(v.j + 1, height - 1); ++j)
                for (int i = (std::max)(v.i - 1, 0); i <= (std::min)(v.i + 1, width - 1); ++i)
                    if (numeric::is_finite(heights(i, j))) sum += heights(i, j), count += 1;
            if (count > 0)
                filled.push_back({v.i, v.j, sum / count});
            else
                others.push_back(v);
        }
        if (filled.empty()) break;
        for (const vertex& v : filled) heights(v.i, v.j) = v.value;
        missing = std::move(others);
    }
    return field;
}

}  // namespace INSONIFY_FLAGS

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
