// Lobster pots: frames of bars under a net.
#pragma once

#include <insonify/geometry/creases.hpp>
#include <insonify/geometry/objects/detail/solids.hpp>

#include <algorithm>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// A D-shaped creel along x, standing on z = 0: a slatted base, arched hoops over it, bars from hoop to hoop, the rings
/// of two entrances, and a net of bars. The D shape with two entrances in its sides, diagonally opposite each other, is
/// the usual one (Seafish Gear Database, Pots and Traps - Lobster); the default size is the common 36 by 22 by 16
/// inches of makers' catalogues.
struct lobster_pot {
    float length = 0.91f;     ///< metres
    float width = 0.56f;      ///< metres
    float height = 0.41f;     ///< metres
    float bar = 0.016f;       ///< diameter of the frame, metres, 1/1000 of the largest to 1/8 of the least size
    int hoops = 4;            ///< 2 to 16
    float mesh_size = 0.07f;  ///< spacing of the twines, metres, 1/64 of the largest size to that size; 0: no net
    float twine = 0.005f;     ///< diameter of the net's bars, metres, 1/2000 of the largest size to `bar`
    float crushed = 0;        ///< 0: upright, 1: hoops bent over until about a quarter of the height is left
    int segments = 12;        ///< straight pieces of a hoop, 6 to 256
};

namespace detail::inline INSONIFY_FLAGS {

/// A point of the arch, from one foot (0) over the top (1/2) to the other (1): upright sides, then half an ellipse.
inline glm::dvec3 arch_point(const lobster_pot& p, double x, double t, double inset) {
    const double half = 0.5 * static_cast<double>(p.width) - inset;
    const double base = inset, top = static_cast<double>(p.height) - inset;
    const double spring = base + 0.35 * (top - base);  // where the curve begins
    double y = 0, z = 0;
    if (t < 0.15 || t > 0.85) {
        y = t < 0.5 ? -half : half;
        z = base + (spring - base) * (t < 0.5 ? t : 1 - t) / 0.15;
    } else {
        const auto [sine, cosine] = numeric::sin_cos_turns((t - 0.15) / 0.7 * 0.5);
        y = -half * cosine;
        z = spring + (top - spring) * sine;
    }
    // A crushed pot leans over: what it loses in height it gains to the side.
    const double crushed = static_cast<double>(p.crushed);
    return {x, y + 0.8 * crushed * (z - base), base + (z - base) * (1 - 0.8 * crushed)};
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// @throws invalid_input for a value outside its range
inline void validate(const lobster_pot& p) {
    detail::require_size("lobster_pot.length", p.length);
    detail::require_size("lobster_pot.width", p.width);
    detail::require_size("lobster_pot.height", p.height);
    const float largest = (std::max)((std::max)(p.length, p.width), p.height);
    const float least = (std::min)((std::min)(p.length, p.width), p.height);
    detail::require(p.bar >= 1e-3f * largest && p.bar <= 0.125f * least, "lobster_pot.bar", p.bar,
                    "1/1000 of the largest to 1/8 of the least size");
    detail::require_range("lobster_pot.hoops", p.hoops, 2, 16, "2 to 16");
    detail::require(p.mesh_size == 0 || (p.mesh_size >= largest / 64 && p.mesh_size <= largest),
                    "lobster_pot.mesh_size", p.mesh_size, "0, or 1/64 to 1 of the largest size");
    detail::require(p.twine >= 5e-4f * largest && p.twine <= p.bar, "lobster_pot.twine", p.twine,
                    "1/2000 of the largest size to the bar's diameter");
    detail::require_fraction("lobster_pot.crushed", p.crushed);
    detail::require_segments("lobster_pot.segments", p.segments, 6, 256);
}

/// The parts as one mesh.
/// @throws invalid_input as `validate` does
inline mesh to_mesh(const lobster_pot& p) {
    validate(p);
    using detail::append_bar, detail::arch_point;
    const double radius = 0.5 * static_cast<double>(p.bar), half = 0.5 * static_cast<double>(p.length);
    const double side = 0.5 * static_cast<double>(p.width) - radius, inner = half - radius;
    mesh body;

    // The base: slats across, two runners along. Bars end inside one another, never in the same circle.
    detail::append_box(body, {-half, -side - radius, 0}, {half, -side + radius, 1.9 * radius});
    detail::append_box(body, {-half, side - radius, 0}, {half, side + radius, 1.9 * radius});
    const int slats = 5;
    for (int i = 0; i < slats; ++i) {
        const double x = -half + 2 * radius + (2 * half - 4 * radius) * i / (slats - 1.0);
        // Narrower than the pitch of 3 radii at the thickest bar, so that adjacent slats share no edge.
        detail::append_box(body, {x - 1.4 * radius, -side, 0.2 * radius}, {x + 1.4 * radius, side, 1.7 * radius});
    }

    std::vector<glm::dvec3> path;
    const auto add_arch = [&](double x, double inset, double thick, int corners) {
        path.clear();
        for (int k = 0; k <= p.segments; ++k)
            path.push_back(arch_point(p, x, static_cast<double>(k) / p.segments, inset));
        detail::append_bent_bar(body, path, thick, corners);
    };
    for (int i = 0; i < p.hoops; ++i) add_arch(-inner + 2 * inner * i / (p.hoops - 1.0), radius, radius, 6);
    for (const double t : {0.15, 0.5, 0.85}) {
        const glm::dvec3 a = arch_point(p, -half, t, 1.3 * radius), b = arch_point(p, half, t, 1.3 * radius);
        append_bar(body, a, b, 0.8 * radius, 0.8 * radius);
    }

    // Entrances: rings in the two long sides.
    for (const double end : {-1.0, 1.0}) {
        const glm::dvec3 middle = arch_point(p, 0.25 * end * half * 2 * 0.9, end < 0 ? 0.24 : 0.76, 3 * radius);
        const double eye = 0.2 * (std::min)(half, static_cast<double>(p.height));
        path.clear();
        for (int k = 0; k <= 8; ++k) {
            const auto [sine, cosine] = numeric::sin_cos_turns(0.96 * k / 8.0);
            path.push_back(
                middle + glm::dvec3(eye * cosine, 0.3 * eye * end * sine, eye * sine * (p.crushed < 0.5f ? 0.8 : 0.3)));
        }
        detail::append_bent_bar(body, path, 0.5 * radius, 5);
    }

    if (p.mesh_size > 0) {
        const double thin = 0.5 * static_cast<double>(p.twine), inset = radius;
        const int rows = static_cast<int>(2 * half / static_cast<double>(p.mesh_size));
        for (int i = 1; i < rows; ++i) add_arch(-half + 2 * half * (i + 0.013) / rows, inset, thin, 3);
        const double around = 2 * static_cast<double>(p.height) + static_cast<double>(p.width);
        const int lines = static_cast<int>(0.85 * around / static_cast<double>(p.mesh_size));
        for (int i = 1; i < lines; ++i) {
            const double t = (i + 0.017) / lines;
            append_bar(body, arch_point(p, -0.995 * half, t, inset), arch_point(p, 0.995 * half, t, inset), thin, thin,
                       3);
        }
    }
    return with_creases(body, 1.2f);
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
