// Surfaces of revolution: builds cylinders, cones, spheres, and anything else that a lathe can turn.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/geometry/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Axis of a body of revolution.
enum class axis { x, y, z };

/// A point of the profile that is turned about the axis, and the unit normal there, both in the half plane
/// (distance from the axis, height along it); metres.
struct profile_point {
    double radius = 0;
    double height = 0;
    double normal_radius = 0;
    double normal_height = 0;
};

inline namespace INSONIFY_FLAGS {

/// Fewest segments of a regular polygon, at least 3, whose edges stay within `chord_error` of the circle around it:
/// n >= pi / acos(1 - e / r).
/// @param radius, chord_error  in the same unit, finite and positive
/// @throws invalid_input for other values, or if more than 2^20 segments were needed
inline int segments_for(float radius, float chord_error) {
    detail::require_positive("radius", radius);
    detail::require_positive("chord_error", chord_error);
    const double ratio = static_cast<double>(chord_error) / static_cast<double>(radius);
    if (ratio >= 0.5) return 3;  // a triangle's edges are r / 2 away

    // acos(1 - x) = atan2(sqrt(x (2 - x)), 1 - x) keeps its digits for small x.
    const double half_angle = numeric::atan2(numeric::square_root(ratio * (2 - ratio)), 1 - ratio);
    const double segments = numeric::pi / half_angle;
    detail::require(segments <= 0x1p20, "chord_error", chord_error, "reachable with 2^20 segments");
    // A whole ratio that rounding has raised must not add a segment.
    return static_cast<int>(numeric::floor_to_int(segments * (1 - 1e-12))) + 1;
}

}  // namespace INSONIFY_FLAGS

namespace detail::inline INSONIFY_FLAGS {

#if INSONIFY_BODIES
/// Appends an arc of a circle centred on the axis, `steps` + 1 points from `first` to `last`: turns, counted from the
/// lowest point (0) over the equator (1/4) to the highest (1/2).
inline void append_arc(dynamic_array<profile_point>& profile, double radius, double centre, double first, double last,
                       int steps) {
    for (int i = 0; i <= steps; ++i) {
        const auto [sine, cosine] = numeric::sin_cos_turns(first + (last - first) * i / steps);
        profile.push_back({radius * sine, centre - radius * cosine, sine, -cosine});
    }
}

#endif

/// Distance from the centre of a unit ball of `segments` by `rings` to the nearest of its faces, which is at the
/// equator. Faces are trapezoids, hence planar.
inline double nearest_face(int segments, int rings) {
    const double across = numeric::sin_cos_turns(0.5 / segments).cosine;  // of half a segment
    const double along = numeric::sin_cos_turns(0.25 / rings).cosine;     // of half a ring
    if (rings % 2 != 0) return across * along;  // the equator runs through the middle of a ring
    return across * along / numeric::square_root(along * along + across * across * (1 - along * along));
}

/// Fewest segments, from 6 to 8192, of a circle whose chords are within `deviation` of it.
inline int ring_segments_for(float radius, float deviation) {
    const int segments = segments_for(radius, deviation);
    require(segments <= 8192, "deviation", deviation, "reachable with 8192 segments");
    return (std::max)(segments, 6);
}

/// Fewest segments with which the faces of a ball stay within `deviation` of it.
/// @param rings_of  from segments to the rings from pole to pole
template <class RingsOf>
int round_segments_for(float radius, float deviation, const RingsOf& rings_of) {
    // A face deviates more than an edge of the circle does, and up to twice as much.
    int segments = segments_for(radius, deviation);
    const double nearest = 1 - static_cast<double>(deviation) / static_cast<double>(radius);
    while (segments <= 8192 && nearest_face(segments, rings_of(segments)) < nearest) ++segments;
    require(segments <= 8192, "deviation", deviation, "reachable with 8192 segments");
    return segments;
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_ONCE {

/// The profile turned about an axis. Two points in the same place with different normals make a sharp edge.
///
/// Vertices lie on the true surface, so the mesh is inscribed where it bulges and its error falls with segments^-2.
/// It is closed if the profile starts and ends on the axis; closed by index alone if it has no sharp edge and no tip.
///
/// @param profile   from low to high along the outside, so that triangles face away from the axis
/// @param segments  around the axis, 3 to 2^20
/// @throws invalid_input for another number of segments, more than 2^28 vertices, or a point that is not finite or
///         beyond the axis
INSONIFY_FUNCTION mesh revolve(std::span<const profile_point> profile, int segments, axis around = axis::z);

#if INSONIFY_BODIES
INSONIFY_FUNCTION mesh revolve(std::span<const profile_point> profile, int segments, axis around) {
    detail::require_range("segments", segments, 3, 1 << 20, "3 to 2^20");
    const auto count = static_cast<std::uint32_t>(segments);
    detail::require(profile.size() <= (std::size_t{1} << 28) / count, "profile.size()", profile.size(),
                    "at most 2^28 vertices in all");

    mesh out;
    // The components of a vector along the axis and across it follow each other cyclically: a rotation, not a mirror.
    const int along = static_cast<int>(around);
    const auto revolved = [&](double radius, double height, const numeric::sine_cosine& angle) {
        glm::vec3 v;
        v[along] = static_cast<float>(height);
        v[(along + 1) % 3] = static_cast<float>(radius * angle.cosine);
        v[(along + 2) % 3] = static_cast<float>(radius * angle.sine);
        return v;
    };
    const auto add_vertex = [&](const profile_point& p, const numeric::sine_cosine& angle) {
        out.positions.push_back(revolved(p.radius, p.height, angle));
        out.normals.push_back(revolved(p.normal_radius, p.normal_height, angle));
    };

    detail::dynamic_array<numeric::sine_cosine> angles(count), half_angles(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        angles[i] = numeric::sin_cos_turns(i / static_cast<double>(segments));
        half_angles[i] = numeric::sin_cos_turns((i + 0.5) / segments);
    }

    struct ring {
        std::uint32_t first;
        std::uint32_t step;  // 0: all segments share one vertex
        std::uint32_t operator()(std::uint32_t segment) const { return first + step * segment; }
    };
    ring below{};
    for (std::size_t k = 0; k < profile.size(); ++k) {
        const profile_point& p = profile[k];
        detail::require_not_negative("profile_point.radius", p.radius);
        detail::require(numeric::is_finite(p.height), "profile_point.height", p.height, "finite");
        const bool on_axis = p.radius == 0;
        const ring here{static_cast<std::uint32_t>(out.positions.size()), on_axis && p.normal_radius == 0 ? 0u : 1u};

        // A smooth pole is one vertex; the tip of a cone is one per segment, with the normal of that segment's middle.
        if (here.step == 0)
            add_vertex(p, {0, 1});
        else
            for (const auto& angle : on_axis ? half_angles : angles) add_vertex(p, angle);

        const bool joined = k > 0 && (profile[k - 1].radius != p.radius || profile[k - 1].height != p.height);
        const bool below_on_axis = k > 0 && profile[k - 1].radius == 0;
        for (std::uint32_t i = 0; joined && i < count; ++i) {
            const std::uint32_t j = i + 1 == count ? 0 : i + 1;
            if (!below_on_axis) out.triangles.emplace_back(below(i), below(j), here(on_axis ? i : j));
            if (!on_axis) out.triangles.emplace_back(below(i), here(j), here(i));
        }
        below = here;
    }
    return out;
}
#endif

}  // namespace INSONIFY_ONCE
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
