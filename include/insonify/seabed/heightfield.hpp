// Heightfields: regular grids of sampled or measured heights, with labels.
#pragma once

#include <insonify/core/image.hpp>
#include <insonify/core/linear.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/seabed/detail/interpolation.hpp>
#include <insonify/seabed/model.hpp>

#include <array>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

namespace detail::inline INSONIFY_FLAGS {

/// The plane at a point: its height, and its rise per cell in x and in y, metres.
struct facet {
    double height, rise_x, rise_y;
};

/// The triangle of a heightfield over (u, v), in cells from vertex (0, 0).
inline facet facet_at(image_view<const float> heights, double u, double v) {
    const grid_coordinate x(u, heights.width() - 1), y(v, heights.height() - 1);
    const double corner = static_cast<double>(heights(x.cell, y.cell));
    const double opposite = static_cast<double>(heights(x.cell + 1, y.cell + 1));
    // The diagonal runs from this corner to the opposite one, with the right vertex below it and the upper above.
    const bool lower = x.across >= y.across;
    const double side = static_cast<double>(lower ? heights(x.cell + 1, y.cell) : heights(x.cell, y.cell + 1));
    const double rise_x = lower ? side - corner : opposite - side;
    const double rise_y = lower ? opposite - side : side - corner;
    double height = corner + x.across * rise_x + y.across * rise_y;
    if (!numeric::is_finite(height)) {
        // A vertex without data counts only where its weight is above 0: the gap's border has heights.
        const auto part = [](double share, double of) { return share > 0 ? share * of : 0.0; };
        const double larger = (std::max)(x.across, y.across), smaller = (std::min)(x.across, y.across);
        height = part(1 - larger, corner) + part(larger - smaller, side) + part(smaller, opposite);
    }
    return {numeric::is_finite(height) ? height : (std::numeric_limits<double>::quiet_NaN)(), rise_x, rise_y};
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

class heightfield_sampler;

}  // namespace INSONIFY_FLAGS

/// Heights at the vertices of a square grid; vertex (i, j) lies at origin + spacing * (i, j), so that y, along track,
/// grows with the row: viewed as an image, the array has forward at the bottom (`from_image` flips it).
///
/// The surface is that of the drawn mesh: the diagonal from vertex (i, j) to (i + 1, j + 1) divides each cell into two
/// plane triangles. Heights outside are those of the nearest edge. A vertex that is NaN or infinite has no data:
/// queries within its triangles return NaN, and the mesh leaves them out.
struct heightfield {
    image<float> heights{};       ///< metres above the datum, at least 2 x 2 vertices
    image<type> types{};          ///< one per vertex; empty: all are `fallback`
    glm::dvec2 origin{0.0, 0.0};  ///< world position of vertex (0, 0), metres
    double spacing = 1;           ///< metres between vertices, > 0 and < 10^6
    type fallback = type::sand;
    /// Properties of users' labels; those of the library are in its registry.
    std::vector<type_properties> user_types{};

    /// Height of the drawn surface at a world position, metres. @pre the heightfield is valid, here and below
    INSONIFY_MEMBER float height_at(double x, double y) const { return static_cast<float>(facet_at(x, y).height); }

    /// Unit normal of the triangle at a world position; outside, that of the nearest one. NaN where there is no data,
    /// and on the border of a gap.
    INSONIFY_TAGGED glm::vec3 normal_at(double x, double y) const {
        const detail::facet f = facet_at(x, y);
        const glm::dvec3 normal(-f.rise_x, -f.rise_y, spacing);
        return glm::vec3(normal / numeric::length(normal));
    }

    /// Type at the nearest vertex.
    INSONIFY_MEMBER type type_at(double x, double y) const {
        if (types.empty()) return fallback;
        return types(detail::grid_coordinate((x - origin.x) / spacing + 0.5, types.width()).cell,
                     detail::grid_coordinate((y - origin.y) / spacing + 0.5, types.height()).cell);
    }

    /// The sampler refers to the heightfield, which has to outlive it.
    /// @throws invalid_input as `validate`
    INSONIFY_TAGGED heightfield_sampler prepare() const;
    INSONIFY_MEMBER std::optional<type> only_type() const {
        return types.empty() ? std::optional(fallback) : std::nullopt;
    }
    INSONIFY_TAGGED std::vector<type_properties> legend() const;

    INSONIFY_MEMBER detail::facet facet_at(double x, double y) const {
        return detail::facet_at(heights, (x - origin.x) / spacing, (y - origin.y) / spacing);
    }
};

inline namespace INSONIFY_FLAGS {

/// @throws invalid_input for fewer than 2 x 2 vertices, types of another size, an origin beyond 1e9 m or a spacing that
/// is not above 0 and below 10^6 m
inline void validate(const heightfield& h) {
    detail::require(h.heights.width() >= 2, "heightfield.heights.width()", h.heights.width(), "at least 2");
    detail::require(h.heights.height() >= 2, "heightfield.heights.height()", h.heights.height(), "at least 2");
    if (!h.types.empty()) {
        constexpr std::string_view what = "that of the heights, or no types at all";
        detail::require_equal("heightfield.types.width()", h.types.width(), h.heights.width(), what);
        detail::require_equal("heightfield.types.height()", h.types.height(), h.heights.height(), what);
    }
    detail::require_positive_metres("heightfield.spacing", h.spacing);
    detail::require_position("heightfield.origin", h.origin);
}

/// Evaluates a `heightfield` between its vertices.
class heightfield_sampler {
  public:
    explicit heightfield_sampler(const heightfield& h) : field_(&h) { validate(h); }

    void row(const scanline& line, std::span<float> heights, std::span<type> types) const {
        for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = field_->height_at(line.x(i), line.y);
        for (std::size_t i = 0; i < types.size(); ++i) types[i] = field_->type_at(line.x(i), line.y);
    }

    /// The range of all vertices.
    height_range range() const {
        height_range all;
        for (const float height : field_->heights.pixels()) {
            const auto h = static_cast<double>(height);
            if (numeric::is_finite(height)) all = merge(all, {h, h});
        }
        return all;
    }

  private:
    const heightfield* field_;
};

}  // namespace INSONIFY_FLAGS

inline heightfield_sampler heightfield::prepare() const {
    return heightfield_sampler(*this);
}
inline std::vector<type_properties> heightfield::legend() const {
    std::array<bool, 256> occurs{};
    if (types.empty()) occurs[index_of(fallback)] = true;
    for (const type t : types.pixels()) occurs[index_of(t)] = true;
    std::vector<type_properties> all = user_types;
    for (const type_properties& own : user_types) occurs[index_of(own.label)] = false;
    for (std::size_t i = 0; i < label_count; ++i)
        if (occurs[i]) all.push_back(properties_of(static_cast<type>(i)));
    return all;
}

inline namespace INSONIFY_FLAGS {

/// A heightfield from an image of heights: one vertex per pixel, height = scale * pixel, the top row at the largest y,
/// vertex (0, 0) at the world's origin.
///
/// An image of 8 bits has 256 heights: over 1 m of relief its steps are 4 mm high and show as contour lines at grazing
/// light. Use 16 bits or more, or smooth the pixels first.
/// @param spacing  metres between pixels, > 0 and < 10^6
/// @param scale    metres per unit of a pixel
/// @param no_data  the value of pixels without data, often 0; NaN pixels never have data
/// @throws invalid_input for a picture smaller than 2 x 2, a spacing out of its range or a scale that is not finite
inline heightfield from_image(image_view<const float> picture, double spacing, float scale = 1,
                              float no_data = std::numeric_limits<float>::quiet_NaN()) {
    detail::require(picture.width() >= 2, "picture.width()", picture.width(), "at least 2");
    detail::require(picture.height() >= 2, "picture.height()", picture.height(), "at least 2");
    detail::require_positive_metres("spacing", spacing);
    detail::require(numeric::is_finite(scale), "scale", scale, "a finite factor");
    heightfield result{.heights = image<float>(picture.width(), picture.height()), .spacing = spacing};
    for (int j = 0; j < picture.height(); ++j) {
        const auto from = picture.row(picture.height() - 1 - j);
        std::transform(from.begin(), from.end(), result.heights.row(j).begin(),
                       [=](float p) { return p == no_data ? std::numeric_limits<float>::quiet_NaN() : scale * p; });
    }
    return result;
}

}  // namespace INSONIFY_FLAGS

}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
