// Readers of surveyed bathymetry: heightfields from Esri ASCII grids and lists of soundings.
//
// The parsers take text: `parse_esri_grid(read_file("bottom.asc"))`. For images of heights (16-bit PGM, PFM) use
// `read_netpbm` and `from_image`. Cells without data are NaN, which are holes of a heightfield; `fill_gaps` closes
// them.
//
// Source: Esri. ASCII Raster Format (ArcGIS documentation, "Esri ASCII raster format").
#pragma once

#include <insonify/geometry/bounds.hpp>
#include <insonify/seabed/detail/survey_reader.hpp>
#include <insonify/seabed/heightfield.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

namespace detail::inline INSONIFY_FLAGS {

/// A height within 1000 km; NaN for anything else, such as 1e10 or DBL_MAX for missing data.
inline float height_or_nan(double metres) {
    return metres > -1e6 && metres < 1e6 ? static_cast<float>(metres) : (std::numeric_limits<float>::quiet_NaN)();
}

inline void require_position(const survey_reader& text, double x, double y) {
    if (!(x >= -1e9 && x <= 1e9 && y >= -1e9 && y <= 1e9)) text.fail("a position is not within 1e9 metres");
}

/// Header of an Esri ASCII grid.
struct esri_header {
    double columns = 0, rows = 0, cell = 0, no_data = -9999;
    glm::dvec2 origin{0, 0};  ///< centre of the lower left cell
};

/// Reads a header up to the first height.
/// @throws io_error for an unknown keyword, or a value that is missing or out of range
inline esri_header read_esri_header(survey_reader& in) {
    esri_header h;
    bool has_x = false, has_y = false, corner_x = false, corner_y = false;
    for (;;) {
        const std::string_view key = in.peek();
        double height;
        const bool is_key = !key.empty() && ((key[0] >= 'a' && key[0] <= 'z') || (key[0] >= 'A' && key[0] <= 'Z')) &&
                            !insonify::detail::parse_number(key, height);  // nan is a height
        if (!is_key) break;
        in.word();
        const auto is = [&](std::string_view word) { return same_word(key, word); };
        if (is("ncols"))
            h.columns = in.finite("ncols");
        else if (is("nrows"))
            h.rows = in.finite("nrows");
        else if (is("cellsize"))
            h.cell = in.finite("cellsize");
        else if (is("xllcorner") || is("xllcenter"))
            h.origin.x = in.finite("xllcorner"), has_x = true, corner_x = is("xllcorner");
        else if (is("yllcorner") || is("yllcenter"))
            h.origin.y = in.finite("yllcorner"), has_y = true, corner_y = is("yllcorner");
        else if (is("nodata_value"))
            h.no_data = in.number("nodata_value");
        else
            in.fail(insonify::detail::quoted(key) + " is not a keyword of an Esri grid's header, such as ncols");
    }
    const auto is_whole = [](double n) {
        return n >= 2 && n <= (1 << 24) && n == static_cast<double>(static_cast<int>(n));
    };
    if (!is_whole(h.columns)) in.fail("ncols is missing or not an integer from 2 to 2^24");
    if (!is_whole(h.rows)) in.fail("nrows is missing or not an integer from 2 to 2^24");
    if (!has_x || !has_y) in.fail("xllcorner or yllcorner is missing, or a number has a decimal comma");
    if (!(h.cell > 0 && h.cell < 1e6)) in.fail("cellsize is missing, or not above 0 and below 10^6");
    h.origin += glm::dvec2(corner_x ? 0.5 * h.cell : 0, corner_y ? 0.5 * h.cell : 0);
    require_position(in, h.origin.x, h.origin.y);
    return h;
}

/// Soundings on a grid, and the vertices that they reach.
struct grid_soundings {
    struct sounding {
        std::int64_t column, row;  ///< of the nearest vertex
        double height;
    };
    std::vector<sounding> all;
    std::int64_t left = (std::numeric_limits<std::int64_t>::max)(), low = left, right = -left, high = -left;
    insonify::detail::ground_rect extent;  ///< of the positions

    void add(const glm::dvec2& at, double height, double spacing) {
        extent.include(at);
        const std::int64_t column = numeric::floor_to_int(at.x / spacing + 0.5),
                           row = numeric::floor_to_int(at.y / spacing + 0.5);
        left = (std::min)(left, column), right = (std::max)(right, column);
        low = (std::min)(low, row), high = (std::max)(high, row);
        all.push_back({column, row, height});
    }
    std::int64_t width() const { return (std::max)(right - left + 1, std::int64_t{2}); }
    std::int64_t height() const { return (std::max)(high - low + 1, std::int64_t{2}); }
};

inline grid_soundings read_soundings(survey_reader& in, double spacing, float scale) {
    grid_soundings found;
    for (std::string_view first; !(first = in.first_word()).empty(); in.skip_line()) {
        const std::size_t digit = first.find_first_not_of("+-.");  // after a sign and a point at most
        const bool is_number = digit <= 2 && first[digit] >= '0' && first[digit] <= '9';
        if (!is_number) {
            // Its rows of heights would be taken for positions.
            if (same_word(first, "ncols")) in.fail("this is an Esri ASCII grid: parse_esri_grid reads it");
            continue;
        }
        const survey_reader::field second = in.field_of_line(), third = in.field_of_line();
        if (second.separator != third.separator && !third.text.empty())
            in.fail("x, y and z are separated in two ways: are there decimal commas?");
        const double x = in.number(first, "an x"), y = in.number(second.text, "a y");
        if (third.text.empty() && third.separator != ' ') continue;  // an empty cell: no sounding
        const double z = in.number(third.text, "a z");
        require_position(in, x, y);
        if (numeric::abs(x) > 0x1p53 * spacing || numeric::abs(y) > 0x1p53 * spacing)
            in.fail("a position is 2^53 spacings away: take a larger spacing");
        found.add({x, y}, static_cast<double>(scale) * z, spacing);
    }
    return found;
}

/// Refuses soundings that make no grid of a useful size.
inline void require_extent(const survey_reader& in, const grid_soundings& s, double spacing) {
    if (s.all.empty()) in.fail("there are no soundings");
    if (std::none_of(s.all.begin(), s.all.end(),
                     [](const auto& one) { return numeric::is_finite(height_or_nan(one.height)); }))
        in.fail("no sounding has a z within 1000 km of 0");
    const double vertices = static_cast<double>(s.width()) * static_cast<double>(s.height());
    const auto count = static_cast<double>(s.all.size());
    // Bounds the memory that two distant soundings may cost.
    if (vertices > (std::min)(1024 * count, 67108864.0))
        in.fail("the soundings are too far apart, more than 1024 vertices for each or 2^26: take a larger spacing");
    // Longitudes and latitudes in degrees lie within a few spacings.
    const glm::dvec2 span = s.extent.upper - s.extent.lower;
    const bool is_point = span.x < spacing && span.y < spacing;
    const bool is_crowded = s.width() <= 4 && s.height() <= 4 && count > 16 * vertices;
    if (is_point || is_crowded)
        in.fail("all " + to_text(s.all.size()) + " soundings lie within " + to_text(static_cast<float>(span.x)) +
                " x " + to_text(static_cast<float>(span.y)) + " metres, at a spacing of " + to_text(spacing) +
                ": take a smaller spacing; positions in degrees have to be projected to metres first");
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// Reads an Esri ASCII grid: ncols, nrows, xllcorner or xllcenter, yllcorner or yllcenter, cellsize,
/// optionally nodata_value, then the heights row by row from the north. Vertices stand at the centres of its cells.
/// Positions and cellsize are metres: project grids in degrees first, for example to UTM.
/// @param scale  metres up per unit of the file; -1 for depths in metres
/// @param name   of the text, for errors
/// @throws io_error for a text that isn't such a grid, saying which line and why
/// @throws invalid_input for a scale that is not finite
inline heightfield parse_esri_grid(std::string_view text, float scale = 1, std::string_view name = "grid") {
    detail::require(numeric::is_finite(scale), "scale", scale, "a finite factor");
    detail::survey_reader in(text, name);
    const detail::esri_header header = detail::read_esri_header(in);
    // A height takes two characters at least: refuse headers of grids larger than the text before allocating.
    if (header.columns * header.rows > static_cast<double>(in.left() / 2 + 1))
        in.fail("the text is too short for ncols x nrows heights");
    heightfield field{.heights = image<float>(static_cast<int>(header.columns), static_cast<int>(header.rows)),
                      .origin = header.origin,
                      .spacing = header.cell};
    for (int j = field.heights.height() - 1; j >= 0; --j)
        for (float& h : field.heights.row(j)) {
            const double value = in.number("a height");
            h = value == header.no_data ? (std::numeric_limits<float>::quiet_NaN)()
                                        : detail::height_or_nan(static_cast<double>(scale) * value);
        }
    if (!in.word().empty()) in.fail("the text goes on after ncols x nrows heights: are there decimal commas?");
    return field;
}

/// Reads soundings, an `x y z` on each line, onto a grid: each vertex has the mean of the soundings that are nearest to
/// it, or NaN if there is none. x and y are metres: project longitudes and latitudes first, for example to UTM. Lines
/// end with LF, CR LF or CR. Lines that do not begin with a number or have an empty cell for z are skipped, and so is
/// the rest of a line after z. A z that is NaN or beyond 1000 km counts as missing. Other codes, such as -9999, are
/// taken as heights: remove those lines first.
/// @param spacing  metres between vertices, > 0 and < 10^6; vertices are multiples of it
/// @param scale    metres up per unit of z; -1 for depths in metres
/// @param name     of the text, for errors
/// @throws io_error for a text without soundings or with none but missing data, an Esri grid, a line of fewer than
///         three numbers or with decimal commas, soundings that span less than a spacing or crowd at a few vertices,
///         as those in degrees do, positions beyond 1e9 metres or 2^53 spacings, or soundings so far apart that there
///         are more than 1024 vertices for each, or more than 2^26
/// @throws invalid_input for a spacing out of its range or a scale that is not finite
inline heightfield parse_xyz(std::string_view text, double spacing, float scale = 1, std::string_view name = "xyz") {
    detail::require_positive_metres("spacing", spacing);
    detail::require(numeric::is_finite(scale), "scale", scale, "a finite factor");
    detail::survey_reader in(text, name);
    const detail::grid_soundings soundings = detail::read_soundings(in, spacing, scale);
    detail::require_extent(in, soundings, spacing);
    heightfield field{
        .heights = image<float>(static_cast<int>(soundings.width()), static_cast<int>(soundings.height())),
        .origin = {spacing * static_cast<double>(soundings.left), spacing * static_cast<double>(soundings.low)},
        .spacing = spacing};
    image<double> sums(field.heights.width(), field.heights.height(), 0.0);
    image<std::uint32_t> counts(field.heights.width(), field.heights.height(), 0u);
    for (const auto& s : soundings.all) {
        if (!numeric::is_finite(detail::height_or_nan(s.height))) continue;
        const int i = static_cast<int>(s.column - soundings.left), j = static_cast<int>(s.row - soundings.low);
        sums(i, j) += s.height;
        ++counts(i, j);
    }
    for (std::size_t k = 0; k < sums.size(); ++k)
        field.heights.pixels()[k] = counts.pixels()[k] > 0 ? static_cast<float>(sums.pixels()[k] / counts.pixels()[k])
                                                           : (std::numeric_limits<float>::quiet_NaN)();
    return field;
}

/// Closes gaps from their edges inwards: in each step, a missing vertex becomes the mean of those of the eight
/// adjacent ones that were known before.
/// @param reach  number of steps: how many vertices a gap is closed by from each side; the rest stays NaN
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
    const auto for_adjacent = [&](int i, int j, const auto& fn) {
        for (int y = (std::max)(j - 1, 0); y <= (std::min)(j + 1, height - 1); ++y)
            for (int x = (std::max)(i - 1, 0); x <= (std::min)(i + 1, width - 1); ++x) fn(x, y);
    };
    // Only vertices adjacent to those that have just become known can be filled in a step.
    image<std::uint8_t> is_candidate(width, height, std::uint8_t{0});
    std::vector<vertex> candidates;
    const auto add_around = [&](int i, int j) {
        for_adjacent(i, j, [&](int x, int y) {
            if (is_candidate(x, y) != 0 || numeric::is_finite(heights(x, y))) return;
            is_candidate(x, y) = 1;
            candidates.push_back({x, y, 0});
        });
    };
    for (int j = 0; j < height; ++j)
        for (int i = 0; i < width; ++i)
            if (numeric::is_finite(heights(i, j))) add_around(i, j);
    for (int step = 0; step < reach && !candidates.empty(); ++step) {
        for (vertex& v : candidates) {
            float sum = 0, count = 0;
            for_adjacent(v.i, v.j, [&](int x, int y) {
                if (numeric::is_finite(heights(x, y))) sum += heights(x, y), count += 1;
            });
            v.value = sum / count;
        }
        const std::vector<vertex> filled = std::exchange(candidates, {});
        for (const vertex& v : filled) heights(v.i, v.j) = v.value;
        for (const vertex& v : filled) add_around(v.i, v.j);
    }
    return field;
}

}  // namespace INSONIFY_FLAGS

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
