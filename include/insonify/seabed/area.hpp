// Areas of the seabed as signed distances to their border: random patches, shapes, and images.
#pragma once

#include <insonify/core/image.hpp>
#include <insonify/seabed/detail/noise.hpp>

#include <variant>
#include <vector>

#include <glm/vec2.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

inline namespace INSONIFY_FLAGS {

/// Random patches: where a noise exceeds a threshold.
struct patches {
    float coverage = 0.5f;  ///< in [0, 1]: fraction of the area, over many patches
    float size = 12.0f;     ///< metres, > 0: scale of the patches
};

}  // namespace INSONIFY_FLAGS

/// Points within a radius of a centre.
struct disc {
    glm::dvec2 centre{0.0, 0.0};
    float radius = 5;  ///< metres, >= 0
};

/// Points within half a width of a path.
struct band {
    std::vector<glm::dvec2> path;  ///< at least one point
    float width = 4;               ///< metres, >= 0
};

/// The inside of a polygon, by the even-odd rule.
struct polygon {
    std::vector<glm::dvec2> corners;  ///< at least three
};

inline namespace INSONIFY_FLAGS {

/// Where an image, placed in the world like a heightfield, is above 1/2; interpolated between pixels and extended from
/// its edges. A step from 0 to 1 between two pixels counts as a border of one spacing in width.
struct stencil {
    image<float> coverage;
    glm::dvec2 origin{0.0, 0.0};  ///< of pixel (0, 0), metres
    double spacing = 1;           ///< metres, > 0
};

}  // namespace INSONIFY_FLAGS

/// Where a layer of `mixed` applies.
using area = std::variant<patches, disc, band, polygon, stencil>;

namespace detail::inline INSONIFY_FLAGS {

/// Distance from p to the segment from a to b, squared.
inline double square_distance(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
    const glm::dvec2 ab = b - a, ap = p - a;
    const double length = ab.x * ab.x + ab.y * ab.y;
    const double t = length > 0 ? (std::min)((std::max)((ap.x * ab.x + ap.y * ab.y) / length, 0.0), 1.0) : 0.0;
    const double x = ap.x - t * ab.x, y = ap.y - t * ab.y;
    return x * x + y * y;
}
inline double distance_to_path(const glm::dvec2& p, const std::vector<glm::dvec2>& path) {
    double square = square_distance(p, path[0], path[0]);
    for (std::size_t i = 1; i < path.size(); ++i) square = (std::min)(square, square_distance(p, path[i - 1], path[i]));
    return numeric::square_root(square);
}

/// Signed distance of a position from the border of an area, metres, positive inside.
inline double signed_distance(const disc& d, const glm::dvec2& p) {
    const glm::dvec2 off = p - d.centre;
    return static_cast<double>(d.radius) - numeric::square_root(off.x * off.x + off.y * off.y);
}
inline double signed_distance(const band& b, const glm::dvec2& p) {
    return 0.5 * static_cast<double>(b.width) - distance_to_path(p, b.path);
}
inline double signed_distance(const polygon& shape, const glm::dvec2& p) {
    bool odd = false;
    double square = square_distance(p, shape.corners.back(), shape.corners.front());
    for (std::size_t i = 0; i < shape.corners.size(); ++i) {
        const glm::dvec2 &a = shape.corners[i], &b = shape.corners[i + 1 < shape.corners.size() ? i + 1 : 0];
        square = (std::min)(square, square_distance(p, a, b));
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) odd = !odd;
    }
    const double distance = numeric::square_root(square);
    return odd ? distance : -distance;
}
inline double signed_distance(const stencil& s, const glm::dvec2& p) {
    struct place {
        int cell, next;
        double across;
    };
    const auto axis = [](double u, int pixels) {
        const double clamped = u > 0 ? (std::min)(u, static_cast<double>(pixels - 1)) : 0.0;
        const int cell = (std::min)(static_cast<int>(clamped), (std::max)(pixels - 2, 0));
        return place{cell, (std::min)(cell + 1, pixels - 1), clamped - cell};
    };
    const auto [x, right, u] = axis((p.x - s.origin.x) / s.spacing, s.coverage.width());
    const auto [y, up, v] = axis((p.y - s.origin.y) / s.spacing, s.coverage.height());
    const auto value = [&](int i, int j) { return static_cast<double>(s.coverage(i, j)); };
    const double low = value(x, y) + u * (value(right, y) - value(x, y));
    const double high = value(x, up) + u * (value(right, up) - value(x, up));
    return (low + v * (high - low) - 0.5) * s.spacing;
}

inline void validate(const disc& d) {
    require(d.radius >= 0 && d.radius < 1e9f, "disc.radius", d.radius, "metres, at least 0");
    require_position("disc.centre", d.centre);
}
inline void validate_points(const std::vector<glm::dvec2>& points, const char* name, std::size_t min_count) {
    require(points.size() >= min_count, std::string(name) + ".size()", points.size(), "more points");
    for (const glm::dvec2& p : points) require_position(name, p);
}
inline void validate(const band& b) {
    validate_points(b.path, "band.path", 1);
    require(b.width >= 0 && b.width < 1e9f, "band.width", b.width, "metres, at least 0");
}
inline void validate(const polygon& p) {
    validate_points(p.corners, "polygon.corners", 3);
}
inline void validate(const stencil& s) {
    require(!s.coverage.empty(), "stencil.coverage.size()", s.coverage.size(), "at least 1");
    require_positive_metres("stencil.spacing", s.spacing);
    require_position("stencil.origin", s.origin);
    for (const float value : s.coverage.pixels()) insonify::detail::require_finite("stencil.coverage", value);
}

/// Evaluates an `area` along rows.
class outline {
  public:
    /// @param border  metres, > 0: the finest detail of the outline
    /// @param ragged  metres: rms deviation of the outline from the shape
    /// @param layer   selects the random stream, so that outlines of one seed differ
    outline(area where, float border, float ragged, std::uint64_t seed, std::uint32_t layer)
        : shape_(std::move(where)), noise_(roughness_of(shape_, border, ragged), seed, stream::mask, layer) {
        if (const auto* p = std::get_if<patches>(&shape_)) {
            require_fraction("patches.coverage", p->coverage);
            // Divided by its rms slope, the noise approximates the distance to the border.
            scale_ = static_cast<float>(1 / noise_.rms_slope());
            offset_ = p->coverage <= 0 ? -unbounded
                      : p->coverage >= 1
                          ? unbounded
                          : scale_ * static_cast<float>(numeric::normal_quantile(static_cast<double>(p->coverage)));
        }
        std::visit(
            [](const auto& shape) {
                if constexpr (!std::is_same_v<std::remove_cvref_t<decltype(shape)>, patches>) validate(shape);
            },
            shape_);
    }

    /// Writes how far inside the area the positions of a stretch lie, metres, negative outside.
    void margins(const stretch& part, stretch_values& values) const {
        values.fill(0);
        noise_.add(part, values);
        std::visit(
            [&](const auto& shape) {
                for (std::size_t i = 0; i < part.count; ++i)
                    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(shape)>, patches>)
                        values[i] = offset_ + scale_ * values[i];
                    else
                        values[i] += static_cast<float>(signed_distance(shape, {part.x[i], part.y}));
            },
            shape_);
    }

  private:
    static constexpr float unbounded = 1e30f;  ///< offset beyond every value of the noise

    static roughness roughness_of(const area& where, float border, float ragged) {
        require(border >= 1e-3f && border < 1e6f, "layer.border", border, "metres from 0.001");
        require(ragged >= 0 && ragged <= 1e5f, "layer.ragged", ragged, "metres, 0 to 10^5");
        if (const auto* p = std::get_if<patches>(&where)) {
            require(p->size >= border && p->size < 1e6f, "patches.size", p->size, "metres, at least layer.border");
            return {.rms = 1, .longest = p->size, .shortest = border, .exponent = 3.6f};
        }
        const float longest = (std::max)(6 * ragged, border);
        return {.rms = ragged, .longest = longest, .shortest = border, .exponent = 3.6f};
    }

    area shape_;
    power_law_noise noise_;
    float scale_ = 1, offset_ = 0;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
