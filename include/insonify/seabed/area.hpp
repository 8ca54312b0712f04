// Areas of the seabed as signed distances to their border: random patches, shapes, and images.
#pragma once

#include <insonify/core/image.hpp>
#include <insonify/core/linear.hpp>
#include <insonify/seabed/detail/noise.hpp>

#include <utility>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// Random patches: where a noise exceeds a threshold.
struct patches {
    float coverage = 0.5f;  ///< in [0, 1]: fraction of the area inside the outlines, over many patches
    float size = 12.0f;     ///< metres, > 0: scale of the patches
};

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
/// its edges.
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
    const double square = numeric::dot(ab, ab);
    const double t = square > 0 ? (std::min)((std::max)(numeric::dot(ap, ab) / square, 0.0), 1.0) : 0.0;
    const glm::dvec2 offset(ap.x - t * ab.x, ap.y - t * ab.y);
    return numeric::dot(offset, offset);
}
inline double distance_to_path(const glm::dvec2& p, const std::vector<glm::dvec2>& path) {
    double square = square_distance(p, path[0], path[0]);
    for (std::size_t i = 1; i < path.size(); ++i) square = (std::min)(square, square_distance(p, path[i - 1], path[i]));
    return numeric::square_root(square);
}

/// Signed distance of a position from the border of an area, metres, positive inside.
inline double signed_distance(const disc& d, const glm::dvec2& p) {
    return static_cast<double>(d.radius) - numeric::length(p - d.centre);
}
inline double signed_distance(const band& b, const glm::dvec2& p) {
    return 0.5 * static_cast<double>(b.width) - distance_to_path(p, b.path);
}
inline double signed_distance(const std::vector<glm::dvec2>& corners, const glm::dvec2& p) {
    bool odd = false;
    double square = square_distance(p, corners.back(), corners.front());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec2 &a = corners[i], &b = corners[i + 1 < corners.size() ? i + 1 : 0];
        square = (std::min)(square, square_distance(p, a, b));
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) odd = !odd;
    }
    const double distance = numeric::square_root(square);
    return odd ? distance : -distance;
}
inline double signed_distance(const polygon& shape, const glm::dvec2& p) {
    return signed_distance(shape.corners, p);
}
/// Signed distances of a stencil's pixels from its border, in pixels. Each pixel takes the nearest of the points where
/// the border crosses the lattice that its neighbours have found, in a sweep down and one up: Per-Erik Danielsson.
/// Euclidean Distance Mapping. Computer Graphics and Image Processing 14, 1980. Errors are within a quarter of a pixel
/// for a smooth border, half of one for a binary image.
inline image<float> border_distances(const image<float>& coverage) {
    constexpr float nowhere = 1e15f;
    const int width = coverage.width(), height = coverage.height();
    image<glm::vec2> crossing(width, height, glm::vec2(nowhere));
    const auto square_to = [](const glm::vec2& c, int x, int y) {
        const float right = c.x - static_cast<float>(x), up = c.y - static_cast<float>(y);
        return right * right + up * up;
    };
    const auto offer = [&](const glm::vec2& c, int x, int y) {
        if (square_to(c, x, y) < square_to(crossing(x, y), x, y)) crossing(x, y) = c;
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const auto& [i, j] : {std::pair(x + 1, y), std::pair(x, y + 1)}) {
                if (i == width || j == height) continue;
                const float here = coverage(x, y), there = coverage(i, j);
                if ((here > 0.5f) == (there > 0.5f)) continue;
                const float t = (0.5f - here) / (there - here);
                const glm::vec2 c(static_cast<float>(x) + t * static_cast<float>(i - x),
                                  static_cast<float>(y) + t * static_cast<float>(j - y));
                offer(c, x, y);
                offer(c, i, j);
            }
    const auto take = [&](int x, int y, int i, int j) {
        if (i >= 0 && i < width && j >= 0 && j < height) offer(crossing(i, j), x, y);
    };
    for (const int step : {1, -1})
        for (int n = 0, y = step > 0 ? 0 : height - 1; n < height; ++n, y += step) {
            for (int x = 0; x < width; ++x)
                for (const auto& [i, j] : {std::pair(x - 1, y), std::pair(x - 1, y - step), std::pair(x, y - step),
                                           std::pair(x + 1, y - step)})
                    take(x, y, i, j);
            for (int x = width - 1; x >= 0; --x) take(x, y, x + 1, y);
        }
    image<float> distances(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float distance = numeric::square_root(square_to(crossing(x, y), x, y));
            distances(x, y) = coverage(x, y) > 0.5f ? distance : -distance;
        }
    return distances;
}
/// `coverage` holds border_distances.
inline double signed_distance(const stencil& s, const glm::dvec2& p) {
    const image<float>& distances = s.coverage;
    const int right = distances.width() - 1, upper = distances.height() - 1;
    const grid_coordinate x((p.x - s.origin.x) / s.spacing, (std::max)(right, 1)),
        y((p.y - s.origin.y) / s.spacing, (std::max)(upper, 1));
    const auto value = [&](int i, int j) {
        return static_cast<double>(distances((std::min)(x.cell + i, right), (std::min)(y.cell + j, upper)));
    };
    const double low = value(0, 0) + x.across * (value(1, 0) - value(0, 0));
    const double high = value(0, 1) + x.across * (value(1, 1) - value(0, 1));
    return (low + y.across * (high - low)) * s.spacing;
}

inline void validate(const disc& d) {
    require(d.radius >= 0 && d.radius < 1e9f, "disc.radius", d.radius, "metres, at least 0 and below 10^9");
    require_position("disc.centre", d.centre);
}
inline void validate_points(const std::vector<glm::dvec2>& points, const char* name, std::size_t min_count) {
    require(points.size() >= min_count, std::string(name) + ".size()", points.size(),
            "at least " + std::to_string(min_count));
    for (const glm::dvec2& p : points) require_position(name, p);
}
inline void validate(const band& b) {
    validate_points(b.path, "band.path", 1);
    require(b.width >= 0 && b.width < 1e9f, "band.width", b.width, "metres, at least 0 and below 10^9");
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
class area_sampler {
  public:
    /// @param border  metres, > 0: the finest detail of the outline
    /// @param ragged  metres: rms deviation of the outline from the shape
    /// @param layer   selects the random stream, so that outlines of one seed differ
    area_sampler(area where, float border, float ragged, std::uint64_t seed, std::uint32_t layer)
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
        if (auto* const s = std::get_if<stencil>(&shape_)) s->coverage = border_distances(s->coverage);
    }

    /// Writes the signed distances of a stretch's positions, metres, positive inside.
    void signed_distances(const stretch& part, stretch_values& values) const {
        values.fill(0);
        stretch unlimited = part;  // outlines do not fade: without fine octaves they would enclose another area
        unlimited.grid_spacing = 0;
        noise_.add(unlimited, values);
        std::visit(
            [&](const auto& shape) {
                using shape_type = std::remove_cvref_t<decltype(shape)>;
                for (std::size_t i = 0; i < part.count; ++i) {
                    const glm::dvec2 p(part.x[i], part.y);
                    if constexpr (std::is_same_v<shape_type, patches>)
                        values[i] = offset_ + scale_ * values[i];
                    else
                        values[i] += static_cast<float>(signed_distance(shape, p));
                }
            },
            shape_);
    }

  private:
    static constexpr float unbounded = 1e30f;  ///< offset beyond every value of the noise

    static roughness roughness_of(const area& where, float border, float ragged) {
        require(border >= 1e-3f && border < 1e6f, "layer.border", border, "metres, at least 0.001 and below 10^6");
        require(ragged >= 0 && ragged <= 1e5f, "layer.ragged", ragged, "metres, 0 to 10^5");
        if (const auto* p = std::get_if<patches>(&where)) {
            require(p->size >= border && p->size < 1e6f, "patches.size", p->size,
                    "metres, at least layer.border and below 10^6");
            return {.rms = 1, .longest = p->size, .shortest = border, .exponent = 3.6f};
        }
        const float longest = (std::max)(6 * ragged, border);
        return {.rms = ragged, .longest = longest, .shortest = border, .exponent = 3.6f};
    }

    area shape_;  ///< a stencil's coverage is replaced by its border_distances
    power_law_noise noise_;
    float scale_ = 1, offset_ = 0;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
