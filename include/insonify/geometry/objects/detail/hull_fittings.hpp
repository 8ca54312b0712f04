// Fittings of a ship: deckhouse, funnel, masts, boilers, and the debris they leave.
#pragma once

#include <insonify/geometry/objects/detail/hull_structure.hpp>

#include <algorithm>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// Where the deckhouse stands.
inline stretch_of_hull house_of(const hull& h) {
    const double middle = 0.5 + static_cast<double>(h.house_position), half = 0.5 * static_cast<double>(h.house_length);
    return {(std::max)(middle - half, 0.07), (std::min)(middle + half, 0.85)};
}
inline double tier_height(const hull& h) {
    return (std::min)({2.4, 0.5 * static_cast<double>(h.depth), 0.08 * static_cast<double>(h.length)});
}

/// A tier of the deckhouse, or its roof, between two heights.
/// @param share     of the half breadth that it takes
/// @param overhang  metres beyond that on all sides
inline void append_tier(mesh& into, const hull_lines& lines, const stretch_of_hull& ends, double share, double overhang,
                        double low, double high) {
    std::vector<section> sections;
    for (int i = 0; i <= 4; ++i) {
        const double u = ends.from + (ends.to - ends.from) * i / 4.0, w = lines.deck_w(u);
        const glm::dvec3 on(overhang * (i == 0 ? -1 : i == 4 ? 1 : 0), 0, 0), out(0, overhang, 0);
        const glm::dvec3 port = lines.between(u, w, share, lines.depth()) + on + out;
        const glm::dvec3 starboard = lines.between(u, w, -share, lines.depth()) + on - out;
        sections.push_back({{starboard.x, starboard.y, low},
                            {port.x, port.y, low},
                            {port.x, port.y, high},
                            {starboard.x, starboard.y, high}});
    }
    append_loft(into, sections);
}

/// A lifeboat on either side, inside the ship's side.
inline void append_lifeboats(mesh& into, const hull_lines& lines, double u, double size, double height) {
    const double rail = lines.half_breadth(u, 1) - 1.2 * size;
    if (!(rail > 1.5 * size)) return;
    for (const double side : {-1.0, 1.0}) {
        glm::dvec3 at = lines.between(u, 1, 0, height);
        at.y = side * rail;
        std::vector<section> boat;
        for (int i = 0; i <= 6; ++i) {
            const double t = i / 3.0 - 1, wide = size * numeric::square_root(1 - 0.94 * t * t);
            boat.push_back(circle(at + glm::dvec3(3.4 * t * size, 0, 0), {0, wide, 0}, {0, 0, 0.7 * wide}, 8));
        }
        append_loft(into, boat);
    }
}

/// The deckhouse: tiers, each smaller than the one below and under an overhanging roof, with lifeboats and a funnel.
inline void append_house(mesh& into, const hull& h, const hull_lines& lines, const stretch_of_hull& part) {
    if (h.house_length <= 0) return;
    const stretch_of_hull whole = house_of(h);
    // Upper tiers fall first.
    const int tiers = (std::min)(h.house_tiers, static_cast<int>((1 - lines.collapse()) * (h.house_tiers + 1)));
    const double tier = tier_height(h), roof = 0.8 * lines.plating();
    const double base = lines.deck_height(0.5 * (whole.from + whole.to)), settled = 1 - 0.35 * lines.collapse();
    for (int k = 0; k < tiers; ++k) {
        const double shrink = 0.14 * k * (whole.to - whole.from);
        const stretch_of_hull ends{(std::max)(whole.from + 1.6 * shrink, part.from + 0.003 * k),
                                   (std::min)(whole.to - 0.4 * shrink, part.to - 0.003 * k)};
        if (ends.to - ends.from < 0.01) continue;
        const double share = 0.86 - 0.13 * k, low = base + tier * k - (k == 0 ? 0.3 * tier : 0.1 * roof),
                     high = base + tier * (k + 1);
        append_tier(into, lines, ends, share, 0, settled * low, settled * (high - 0.5 * roof));
        append_tier(into, lines, ends, share, (std::min)(0.25 * tier, 0.1 * lines.half_beam()), settled * (high - roof),
                    settled * high);
    }
    const double boat_u = whole.from + 0.35 * (whole.to - whole.from);
    if (tiers > 1 && lines.collapse() < 0.3 && part.contains(boat_u))
        append_lifeboats(into, lines, boat_u, 0.34 * tier, settled * (base + 1.25 * tier));
    const double funnel_u = whole.from + 0.3 * (whole.to - whole.from);
    if (h.has_funnel && lines.collapse() < 0.4 && part.contains(funnel_u) && tiers > 0) {
        const glm::dvec3 foot = lines.between(funnel_u, 1, 0, base + 0.2 * tier);
        const double up = tier * (tiers + 0.9), radius = 0.16 * lines.half_beam();
        append_bar(into, foot, foot + glm::dvec3(-0.12 * up, 0, up), 1.15 * radius, radius, 16);
    }
}

/// Collapse above which masts lie over the side.
inline constexpr float masts_fall = 0.35f;

/// A mast with two derricks, or one that has fallen over the side.
inline void append_mast(mesh& into, const hull& h, const hull_lines& lines, double u, double side) {
    const double high = static_cast<double>(h.mast_height);
    const double thick = (std::max)(0.016 * high, 0.7 * lines.plating());
    const double deck = lines.deck_height(u);
    if (h.collapse > masts_fall) {
        const glm::dvec3 foot = lines.between(u, 0.5, 0, 0.4 * deck);
        const glm::dvec3 tip = foot + glm::dvec3(0.35 * high, side * 0.9 * high, 0);
        append_bar(into, foot, {tip.x, tip.y, 1.2 * thick}, thick, 0.5 * thick, 8);
        return;
    }
    const glm::dvec3 foot = lines.between(u, 0.5, 0, 0.3 * deck), top(foot.x, 0, deck + high);
    append_bar(into, foot, top, thick, 0.5 * thick, 8);
    // Within the ship's side, and short of her stem.
    const double reach = (std::min)(0.6 * high, 0.1 * lines.length()),
                 aside = (std::min)(0.13 * high, 0.5 * lines.half_beam());
    const glm::dvec3 hinge(foot.x, 0, deck + 0.15 * high);
    for (const double end : {-1.0, 1.0}) {
        const glm::dvec3 boom = hinge + glm::dvec3(end * reach, end * aside, 0.22 * high);
        append_bar(into, hinge, boom, 0.5 * thick, 0.35 * thick, 6);
    }
    // The mast house with its winches.
    const double house = 0.22 * lines.half_beam(), high_house = 0.35 * tier_height(h);
    append_box(into, foot + glm::dvec3(-house, -1.4 * house, deck - foot.z - 0.5 * lines.plating()),
               foot + glm::dvec3(house, 1.4 * house, deck - foot.z + high_house));
    for (const double end : {-1.0, 1.0}) {
        const glm::dvec3 drum = foot + glm::dvec3(1.5 * end * house, 0, deck - foot.z + 0.6 * high_house);
        append_bar(into, drum - glm::dvec3(0, house, 0), drum + glm::dvec3(0, house, 0), 0.45 * high_house,
                   0.45 * high_house, 8);
    }
    // Crosstrees.
    const glm::dvec3 cross(foot.x, 0, deck + 0.72 * high), arm(0, aside, 0);
    append_bar(into, cross - arm, cross + arm, 0.4 * thick, 0.4 * thick, 5);
}

/// Boilers and engine, which remain standing in a collapsed ship.
inline void append_machinery(mesh& into, const hull& h, const hull_lines& lines, const stretch_of_hull& part) {
    const stretch_of_hull room = house_of(h);
    const double u = 0.5 * (room.from + room.to), radius = 0.26 * lines.half_beam(), size = 1.5 * radius;
    if (!part.contains(u) || !part.contains(u - 0.05)) return;
    for (const double side : {-1.0, 1.0}) {
        const glm::dvec3 centre =
            lines.between(u, 0.4, 0, lines.plating() + 1.02 * radius) + glm::dvec3(0, 1.15 * side * radius, 0);
        append_bar(into, centre - glm::dvec3(size, 0, 0), centre + glm::dvec3(size, 0, 0), radius, radius, 20);
    }
    const glm::dvec3 engine = lines.between(u - 0.05, 0.4, 0, 0.8 * lines.plating());
    append_box(into, engine - glm::dvec3(0.8 * radius, 0.4 * radius, 0),
               engine + glm::dvec3(0.8 * radius, 0.4 * radius, 2.1 * radius));
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 at = engine + glm::dvec3(0.5 * radius * (i - 1), 0, 2 * radius);
        append_bar(into, at, at + glm::dvec3(0, 0, 0.5 * radius), 0.2 * radius, 0.2 * radius, 10);
    }
}

/// Plates and beams that lie in and beside a collapsed ship.
inline void append_debris(mesh& into, const hull_lines& lines, const stretch_of_hull& part, int pieces,
                          random_sequence& random) {
    for (int i = 0; i < pieces; ++i) {
        const double u = random.uniform(0.03, 0.97), side = random.uniform() < 0.5 ? -1 : 1;
        const double away = random.uniform(0.15, 1.9), turns = random.uniform(), tilt = random.uniform(0.02, 0.3);
        const double size = lines.half_beam() * random.uniform(0.04, 0.24), shape = random.uniform(0.06, 0.5);
        if (!part.contains(u)) continue;
        const auto [sine, cosine] = numeric::sin_cos_turns(turns);
        const glm::dvec3 along(size * cosine, size * sine, size * tilt),
            over(-shape * size * sine, shape * size * cosine, 0);
        const glm::dvec3 middle =
            lines.between(u, 0.4, 0, 0) +
            glm::dvec3(0, side * away * lines.half_beam(), size * tilt + (away < 0.8 ? 1.2 : 0.05) * lines.plating());
        const glm::dvec3 up(0, 0, (std::max)(0.6 * lines.plating(), 0.05 * size));
        append_block(into,
                     {{middle - along - over, middle + along - over, middle + along + over, middle - along + over}},
                     {{middle - along - over + up, middle + along - over + up, middle + along + over + up,
                       middle - along + over + up}});
    }
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
