// Axis-aligned boxes, for fitting cameras and culling.
#pragma once

#include <insonify/core/executor.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/geometry/mesh.hpp>

#include <algorithm>
#include <limits>

#include <glm/vec3.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify::inline INSONIFY_ABI {

/// The points p with lower <= p <= upper in each coordinate, in metres; by default none at all.
struct bounding_box {
    glm::dvec3 lower{std::numeric_limits<double>::infinity()};
    glm::dvec3 upper{-std::numeric_limits<double>::infinity()};

    bool empty() const { return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z); }
    /// Edge lengths; 0 for an empty box.
    glm::dvec3 size() const { return empty() ? glm::dvec3(0) : upper - lower; }
    /// @pre the box is not empty
    glm::dvec3 centre() const { return 0.5 * (lower + upper); }
    friend bool operator==(const bounding_box&, const bounding_box&) = default;
};

/// The smallest box around both.
inline bounding_box merge(bounding_box a, const bounding_box& b) {
    for (int i = 0; i < 3; ++i) {
        a.lower[i] = (std::min)(a.lower[i], b.lower[i]);
        a.upper[i] = (std::max)(a.upper[i], b.upper[i]);
    }
    return a;
}

/// The smallest box around both; a point with a NaN or infinite coordinate is passed over.
inline bounding_box include(const bounding_box& box, const glm::dvec3& point) {
    const bool finite = numeric::is_finite(point.x) && numeric::is_finite(point.y) && numeric::is_finite(point.z);
    return finite ? merge(box, {point, point}) : box;
}

/// The smallest box around all finite positions, whether a triangle uses them or not.
template <executor_argument E = serial_executor>
bounding_box bounds(const mesh& m, E&& ex = {}) {
    constexpr std::size_t grain = 65536;
    std::vector<bounding_box> parts((m.positions.size() + grain - 1) / grain);
    bulk_ranges(ex, m.positions.size(), grain, [&](std::size_t first, std::size_t last) {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        glm::vec3 lower(infinity), upper(-infinity);
        for (std::size_t i = first; i < last; ++i) {
            const glm::vec3& p = m.positions[i];
            if (!(numeric::is_finite(p.x) && numeric::is_finite(p.y) && numeric::is_finite(p.z))) continue;
            lower = {(std::min)(lower.x, p.x), (std::min)(lower.y, p.y), (std::min)(lower.z, p.z)};
            upper = {(std::max)(upper.x, p.x), (std::max)(upper.y, p.y), (std::max)(upper.z, p.z)};
        }
        parts[first / grain] = {lower, upper};
    });
    bounding_box box;
    for (const bounding_box& part : parts) box = merge(box, part);
    return box;
}

}  // namespace insonify::inline INSONIFY_ABI

INSONIFY_ARITHMETIC_END
