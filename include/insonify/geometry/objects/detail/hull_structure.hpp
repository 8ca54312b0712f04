// The steel of a ship's hull: plating, frames, bulkheads, decks with their hatches.
#pragma once

#include <insonify/geometry/objects/detail/hull_form.hpp>

#include <algorithm>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// A stretch of a hull's length.
struct stretch_of_hull {
    double from = 0, to = 1;
    bool contains(double u) const { return u >= from && u <= to; }
};

/// The shell between two stations, open above, with ragged edges where the ship is broken.
inline void append_plating(mesh& into, const hull_lines& lines, const stretch_of_hull& part, int segments) {
    const int stations = (std::max)(static_cast<int>(segments * (part.to - part.from)), 6);
    const int rows = (std::max)(segments / 6, 6);
    std::vector<section> sections;
    for (int k = 0; k <= stations; ++k) {
        const double t = static_cast<double>(k) / stations, u = part.from + (part.to - part.from) * t;
        const bool tears_aft = k == 0 && part.from > 0, tears_fore = k == stations && part.to < 1;
        section ring;
        const auto add = [&](double side, int row, bool is_outer) {
            const double w = lines.standing(u, side) * row / rows;
            glm::dvec3 p = is_outer ? lines.outer(u, w, side) : lines.inner(u, w, side);
            if (tears_aft || tears_fore) {
                const double torn =
                    0.025 * lines.length() * (0.5 + 0.5 * lines.noise({9 * w, 4 * side, tears_aft ? 8 : 6}));
                p.x += tears_fore ? torn : -torn;
            }
            ring.push_back(p);
        };
        for (int row = rows; row >= 0; --row) add(-1, row, true);
        for (int row = 0; row <= rows; ++row) add(1, row, true);
        for (int row = rows; row >= 0; --row) add(1, row, false);
        for (int row = 0; row <= rows; ++row) add(-1, row, false);
        sections.push_back(std::move(ring));
    }
    append_loft(into, sections);
}

/// A wall across the hull from the keel up to `highest`, w.
inline void append_bulkhead(mesh& into, const hull_lines& lines, double u, double highest) {
    std::vector<section> sections;
    for (int i = 0; i <= 8; ++i) {
        const double low = 0.03, w = low + (highest - low) * i / 8, height = w * lines.top(u);
        const glm::dvec3 port = lines.between(u, w, 1, height), starboard = lines.between(u, w, -1, height);
        const glm::dvec3 thick(0.5 * lines.plating(), 0, 0);
        sections.push_back({starboard - thick, port - thick, port + thick, starboard + thick});
    }
    append_loft(into, sections);
}

/// A rib inside the plating of one side, up to `highest`, w.
inline void append_frame(mesh& into, const hull_lines& lines, double u, double side, double highest, double size) {
    std::vector<section> sections;
    for (int i = 0; i <= 6; ++i) {
        const double w = 0.02 + (highest - 0.02) * i / 6;
        const glm::dvec3 plate = lines.between(u, w, side, lines.plating() + w * (lines.top(u) - lines.plating()));
        const glm::dvec3 inward(0, -side * (std::min)(size + lines.plating(), 0.8 * numeric::abs(plate.y)), 0),
            along(0.4 * size, 0, 0);
        sections.push_back({plate - along, plate + along, plate + along + inward, plate - along + inward});
    }
    append_loft(into, sections);
}

/// Part of a deck: between two stations, and between two fractions of the half breadth, port positive.
struct deck_plate {
    double from, to, starboard = -1, port = 1;
    bool is_split_off = false;  ///< lies 0.3 plating lower, so that it shares no edge with adjacent plates
};

inline void append_deck(mesh& into, const hull_lines& lines, const deck_plate& plate, int segments) {
    const int steps = (std::max)(static_cast<int>(segments * (plate.to - plate.from)), 1);
    std::vector<section> sections;
    for (int k = 0; k <= steps; ++k) {
        const double u = plate.from + (plate.to - plate.from) * k / steps;
        section ring;
        const auto add = [&](double t, double drop) {
            const double share = plate.starboard + (plate.port - plate.starboard) * t;
            // Camber: 1/50 of the breadth, the usual parabola.
            const double camber = 0.04 * lines.half_beam() * (1 - share * share);
            const double split = plate.is_split_off ? 0.3 * lines.plating() : 0.0;
            ring.push_back(lines.between(u, lines.deck_w(u), share, lines.deck_height(u) + camber - drop - split));
        };
        for (int i = 0; i <= 4; ++i) add(i / 4.0, lines.plating());
        for (int i = 4; i >= 0; --i) add(i / 4.0, 0);
        sections.push_back(std::move(ring));
    }
    append_loft(into, sections);
}

/// The coaming of a hatch: four bars around it that stand on the deck and carry the covers.
inline void append_coaming(mesh& into, const hull_lines& lines, const deck_plate& opening, double height) {
    const double thick = 0.8 * lines.plating(), u[2] = {opening.from, opening.to};
    const auto corner = [&](double at, double share, double up) {
        return lines.between(at, lines.deck_w(at), share, lines.deck_height(at) + up);
    };
    const double below = -0.6 * lines.plating();
    for (const double share : {opening.starboard, opening.port}) {
        const glm::dvec3 out(0, share > 0 ? thick : -thick, 0);
        const glm::dvec3 a = corner(u[0], share, below), b = corner(u[1], share, below);
        const glm::dvec3 up(0, 0, height);
        append_block(into, {{a, a + out, a + out + up, a + up}}, {{b, b + out, b + out + up, b + up}});
    }
    for (const double at : u) {
        const glm::dvec3 along(at == u[0] ? -thick : thick, 0, 0), up(0, 0, 0.97 * height);
        const glm::dvec3 a = corner(at, opening.starboard - 0.02, below), b = corner(at, opening.port + 0.02, below);
        append_block(into, {{a, a + along, a + along + up, a + up}}, {{b, b + along, b + along + up, b + up}});
    }
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
