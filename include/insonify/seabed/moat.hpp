// Scour around an object: a moat along its outline and a mound of sediment down-current.
//
// Sources: Richard J. S. Whitehouse. Scour at Marine Structures: A Manual for Practical Applications, 1998 (scour is
// deepest up-current, and half of that in the lee). G. F. Caston. Wreck marks: indicators of net sand transport. Marine
// Geology 33, 1979 (tails of sand down-current of wrecks). Around piles in sand the depth reaches 1.38 diameters (R. J.
// S. Whitehouse and others. The nature of scour development and scour protection at offshore windfarm foundations.
// Marine Pollution Bulletin 62, 2011).
#pragma once

#include <insonify/core/linear.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/seabed/area.hpp>

#include <algorithm>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace seabed {

/// Scour by a current around a footprint, such as that of a target: `moat{.outline = footprint(mesh, pose, height)}`,
/// with geometry/objects/footprint.hpp. Inside of the outline it ends at width / 2, so that the ground below the middle
/// of a wide target keeps its height. Place targets first, by `rest_on` of the ground without the moat.
struct moat {
    std::vector<glm::dvec2> outline{
        {-1, -1}, {1, -1}, {1, 1}, {-1, 1}};  ///< of the target on the ground, 3 to 4096 corners
    float depth = 0.3f;                       ///< metres, >= 0, on the upstream side; half of it in the lee
    float width = 1.5f;                       ///< metres, > 0: from the outline to the end of the moat
    float current = 0;                        ///< radians from +x: where it flows to
    float mound = 0.15f;                      ///< height of the deposit down-current, metres, >= 0
    float tail = 6;                           ///< its length, metres, >= 0; 0: none
};

namespace detail::inline INSONIFY_FLAGS {

inline void validate(const moat& m) {
    validate_points(m.outline, "moat.outline", 3);
    require(m.outline.size() <= 4096, "moat.outline.size()", m.outline.size(), "at most 4096");
    require_metres("moat.depth", m.depth);
    require_positive_metres("moat.width", m.width);
    require_metres("moat.mound", m.mound);
    require_metres("moat.tail", m.tail);
    insonify::detail::require_angle("moat.current", m.current);
}

/// Upper bound of a moat's distance from the corners of its outline.
inline double moat_reach(const moat& m) {
    // The tail is as wide as the outline, whose corners may all lie to one side of it.
    double reach = 0;
    for (const glm::dvec2& p : m.outline) reach = (std::max)(reach, numeric::length(p - m.outline.front()));
    return reach + static_cast<double>(m.width) + static_cast<double>(m.tail);
}

/// Change of the ground's height at a position, metres.
inline double moat_change(const moat& m, const glm::dvec2& p) {
    const numeric::sine_cosine flow = numeric::sin_cos(static_cast<double>(m.current));
    // Along the current and across it, of the outline and of the position, from the outline's mean corner.
    glm::dvec2 centre(0, 0);
    for (const glm::dvec2& c : m.outline) centre += c / static_cast<double>(m.outline.size());
    const auto to_current_frame = [&](const glm::dvec2& q) {
        const glm::dvec2 offset = q - centre;
        return glm::dvec2(offset.x * flow.cosine + offset.y * flow.sine, offset.y * flow.cosine - offset.x * flow.sine);
    };
    double lee_end = 0, left = 0, right = 0;
    for (const glm::dvec2& c : m.outline) {
        const glm::dvec2 q = to_current_frame(c);
        lee_end = (std::max)(lee_end, q.x);
        left = (std::min)(left, q.y);
        right = (std::max)(right, q.y);
    }

    const double width = static_cast<double>(m.width), outside = -signed_distance(m.outline, p);
    const glm::dvec2 at = to_current_frame(p);
    const double away = numeric::length(at);
    const double facing = away > 0 ? 0.75 - 0.25 * at.x / away : 0.75;
    double change =
        -static_cast<double>(m.depth) * facing * biweight(outside > 0 ? outside / width : 2 * outside / width);

    if (m.tail > 0) {
        // A ridge behind the moat, as wide as the outline is across the current.
        const double length = static_cast<double>(m.tail), along = (at.x - lee_end - 0.5 * width) / length;
        const double half = 0.5 * (right - left), side = numeric::abs(at.y - 0.5 * (left + right));
        if (along > 0 && along < 1)
            change += static_cast<double>(m.mound) * 6.75 * along * (1 - along) * (1 - along) *
                      biweight(side / (half + 0.5 * width));
    }
    return change;
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace seabed
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
