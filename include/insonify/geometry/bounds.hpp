// Axis-aligned boxes, for fitting cameras and culling.
#pragma once

#include <insonify/core/linear.hpp>
#include <insonify/core/simd/dispatch.hpp>
#include <insonify/core/simd/lanes.hpp>
#include <insonify/core/simd/transpose.hpp>
#include <insonify/geometry/mesh.hpp>
#include <insonify/geometry/transform.hpp>

#include <algorithm>
#include <limits>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// The points p with lower <= p <= upper in each coordinate, in metres; empty by default.
struct bounding_box {
    glm::dvec3 lower{std::numeric_limits<double>::infinity()};
    glm::dvec3 upper{-std::numeric_limits<double>::infinity()};

    INSONIFY_MEMBER bool empty() const { return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z); }
    /// Edge lengths; 0 for an empty box.
    INSONIFY_MEMBER glm::dvec3 size() const { return empty() ? glm::dvec3(0) : upper - lower; }
    /// @pre the box is not empty
    INSONIFY_MEMBER glm::dvec3 centre() const { return 0.5 * (lower + upper); }
    /// Corner `i` of eight: bit k selects the upper end along axis k.
    INSONIFY_MEMBER glm::dvec3 corner(int i) const {
        return {(i & 1) != 0 ? upper.x : lower.x, (i & 2) != 0 ? upper.y : lower.y, (i & 4) != 0 ? upper.z : lower.z};
    }
    friend bool operator==(const bounding_box&, const bounding_box&) = default;
};

namespace detail::inline INSONIFY_FLAGS {

/// A rectangle of the ground along the world's axes, metres; by default empty.
struct ground_rect {
    glm::dvec2 lower{std::numeric_limits<double>::infinity()};
    glm::dvec2 upper{-std::numeric_limits<double>::infinity()};

    /// Extends the rectangle by the square of half-width `margin` around a position.
    void include(const glm::dvec2& p, double margin = 0) {
        lower = {(std::min)(lower.x, p.x - margin), (std::min)(lower.y, p.y - margin)};
        upper = {(std::max)(upper.x, p.x + margin), (std::max)(upper.y, p.y + margin)};
    }
};

/// The smallest box around positions, if all of them are finite.
struct bounds_kernel {
    const glm::vec3* positions;
    std::size_t count;
    glm::vec3 &lower, &upper;
    bool& is_finite;

    template <int N>
    INSONIFY_INLINE void run() const {
        // N positions fill three vectors, each lane of which holds the same coordinate in every iteration.
        constexpr int together = is_packed<glm::vec3> ? N : 1;
        const std::size_t whole = count / together * together;
        is_finite = scan<together>(0, whole) && scan<1>(whole, count);
    }

  private:
    template <int N>
    INSONIFY_INLINE bool scan(std::size_t first, std::size_t last) const {
        using floats = lanes<float, N>;
        constexpr float infinity = std::numeric_limits<float>::infinity();
        floats low[3], high[3], zero{};
        for (int v = 0; v < 3; ++v) {
            low[v] = floats{} + infinity;
            high[v] = floats{} - infinity;
        }
        for (std::size_t i = first; i < last; i += N)
            unroll<3>([&](int v) INSONIFY_INLINE_LAMBDA {
                floats some;
                load(some, &positions[i].x + v * N);
                low[v] = some < low[v] ? some : low[v];
                high[v] = some > high[v] ? some : high[v];
                zero = zero + some * 0.0f;  // NaN unless all are finite
            });
        for (int v = 0; v < 3; ++v)
            for (int k = 0; k < N; ++k) {
                const int axis = (v * N + k) % 3;
                lower[axis] = (std::min)(lower[axis], lane(low[v], k));
                upper[axis] = (std::max)(upper[axis], lane(high[v], k));
            }
        return !any(lanes<std::int32_t, N>(zero != 0.0f));
    }
};

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// The smallest box around both.
inline bounding_box merge(bounding_box a, const bounding_box& b) {
    for (int i = 0; i < 3; ++i) {
        a.lower[i] = (std::min)(a.lower[i], b.lower[i]);
        a.upper[i] = (std::max)(a.upper[i], b.upper[i]);
    }
    return a;
}

/// The smallest box around a box and a point; a point with a NaN or infinite coordinate is skipped.
inline bounding_box include(const bounding_box& box, const glm::dvec3& point) {
    return numeric::is_finite(point) ? merge(box, {point, point}) : box;
}

/// The smallest box around the corners of a box after `map`.
inline bounding_box transformed(const bounding_box& box, const affine& map) {
    bounding_box around;
    for (int i = 0; i < 8; ++i) around = include(around, transform_point(map, box.corner(i)));
    return around;
}

/// The smallest box around all finite positions, including those that no triangle uses.
inline bounding_box bounds(const mesh_view& m) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    glm::vec3 lower(infinity), upper(-infinity);
    bool all_finite = true;
    dispatch(detail::bounds_kernel{m.positions.data(), m.positions.size(), lower, upper, all_finite}, best_isa());
    if (all_finite) return {glm::dvec3(lower), glm::dvec3(upper)};
    bounding_box box;
    for (const glm::vec3& p : m.positions) box = include(box, glm::dvec3(p));
    return box;
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
