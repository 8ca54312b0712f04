// Samples a seabed model at the vertices of a grid, a row per task.
#pragma once

#include <insonify/core/executor.hpp>
#include <insonify/seabed/heightfield.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// Where to sample: vertex (i, j) at origin + spacing * (first + (i, j)), metres in the world. Parts of one grid share
/// their vertices to the last bit if they differ in `first` and not in the origin.
struct grid {
    glm::dvec2 origin{0.0, 0.0};
    double spacing = 0.02;      ///< metres between vertices, > 0 and < 10^6
    int width = 2, height = 2;  ///< vertices, at least 2
    bool band_limited = false;  ///< relief that the spacing can't resolve fades out instead of aliasing
    glm::ivec2 first{0, 0};
};

namespace detail::inline INSONIFY_FLAGS {

/// @param advice  for the message: how to reduce the number of vertices
/// @throws invalid_input for more vertices than a scene may sample: with their mesh, so many take 14 GB
inline void require_vertices(double count, std::string_view advice) {
    if (!(count <= 0x1p28)) refuse("vertices of the seabed", count, "at most 2^28; " + std::string(advice));
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// The grid whose vertices are multiples of the spacing and which covers [low, high]. Grids of one spacing share their
/// vertices where they overlap: to the last bit if the spacing is a sum of few powers of two, as 1/64 m is.
/// @throws invalid_input for a spacing that is not above 0 and below 10^6 m or is too fine for the corners, and for
/// corners beyond 1e9 metres, in the wrong order or more than 2^30 vertices apart
inline grid grid_over(glm::dvec2 low, glm::dvec2 high, double spacing) {
    detail::require_position("low", low);
    detail::require_position("high", high);
    detail::require_positive_metres("spacing", spacing);
    const auto axis = [&](double from, double to, const char* name) {
        detail::require(from <= to, name, to, "not below low");
        detail::require(-from <= 0x1p53 * spacing && to <= 0x1p53 * spacing, "spacing", spacing,
                        "at least 2^-53 of the distance to the origin");
        const std::int64_t first = numeric::floor_to_int(from / spacing);
        const std::int64_t last = (std::max)(-numeric::floor_to_int(-to / spacing), first + 1);
        detail::require(last - first < (1 << 30), name, to, "at most 2^30 vertices from low");
        return std::pair{static_cast<double>(first) * spacing, static_cast<int>(last - first + 1)};
    };
    const auto [x, width] = axis(low.x, high.x, "high.x");
    const auto [y, height] = axis(low.y, high.y, "high.y");
    return {.origin = {x, y}, .spacing = spacing, .width = width, .height = height};
}

/// The seabed's heights, and its labels where it has more than one, at the vertices of a grid.
///
/// The bits depend on the model and the positions of the vertices alone, not on the executor or on what else is in
/// the grid.
/// @param source  the library's or a user's own
/// @throws invalid_input for a grid smaller than 2 x 2, a corner beyond 1e9 metres or a spacing that is not above 0
/// and below 10^6 m, for parameters of the model out of their range, and for own labels that its legend lacks
template <model Model, executor_argument Executor = serial_executor>
heightfield sample(const Model& source, const grid& where, Executor&& ex = serial_executor{}) {
    constexpr insonify::detail::uninitialized uninitialized;
    const auto memory = insonify::detail::memory_of(ex);
    detail::require(where.width >= 2, "grid.width", where.width, "at least 2");
    detail::require(where.height >= 2, "grid.height", where.height, "at least 2");
    detail::require_positive_metres("grid.spacing", where.spacing);
    const glm::dvec2 origin = where.origin + where.spacing * glm::dvec2(where.first);
    detail::require_position("vertex (0, 0)", origin);
    detail::require_position("vertex (width - 1, height - 1)",
                             origin + where.spacing * glm::dvec2(where.width - 1, where.height - 1));
    heightfield result{.heights = image<float>(where.width, where.height, uninitialized, memory),
                       .origin = origin,
                       .spacing = where.spacing};
    const std::vector<type_properties> legend = legend_of(source);
    for (const type_properties& t : legend)
        if (index_of(t.label) >= type_count) result.user_types.push_back(t);
    if (const std::optional<type> only = only_type(source))
        result.fallback = *only;
    else
        result.types = image<type>(where.width, where.height, uninitialized, memory);

    const auto prepared = prepare(source);
    const detail::known_labels known(legend);
    ex.bulk(static_cast<std::size_t>(where.height), [&](std::size_t row) {
        const int j = static_cast<int>(row);
        const scanline line{.y = where.origin.y + where.spacing * (static_cast<double>(where.first.y) + j),
                            .origin = where.origin.x,
                            .spacing = where.spacing,
                            .first = where.first.x,
                            .grid_spacing = where.band_limited ? where.spacing : 0};
        const std::span<type> types = result.types.empty() ? std::span<type>{} : result.types.row(j);
        prepared.row(line, result.heights.row(j), types);
        known.require_all(types);
    });
    return result;
}

}  // namespace INSONIFY_FLAGS

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
