// Parameters of a ship's hull.
#pragma once

#include <insonify/geometry/objects/detail/solids.hpp>

#include <cstdint>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Form of the stern: rounded above the rudder, or a flat transom.
enum class stern_type : std::uint8_t { cruiser, transom };

/// A ship standing upright on z = 0 with its keel, bow towards +x, midships at the origin: an open shell of plating on
/// frames, with decks, hatches, deckhouse, masts and funnel; whole, broken in two, or collapsed.
///
/// The default is a coaster. Sizes that are not given follow from the others in its proportions. Proportions: H.
/// Schneekluth, V. Bertram. Ship Design for Efficiency and Economy, 1998 (length / beam 4 to 7, beam / depth 1.6
/// to 2.5). Sheer and bulwark: International Convention on Load Lines, 1966 (regulation 38: standard sheer of 50 (L / 3
/// + 10) mm at the bow and half of that at the stern; regulation 25: bulwarks of 1 m). A trawler measures some 25 x 6.8
/// x 3.4 m, a cargo steamer of 1910 some 100 x 14.5 x 7.5 m.
struct hull {
    float length = 45;                ///< over all, metres
    float beam = length * 8.2f / 45;  ///< metres, length / 20 to length / 2
    float depth = beam * 4 / 8.2f;    ///< from keel to deck amidships, metres, beam / 5 to 2 beam
    float bulwark = depth / 4;        ///< height above the deck, metres, at most half the depth
    float sheer = 1.5f;               ///< times the standard sheer, 0 to 4
    stern_type stern = stern_type::cruiser;
    /// Modelled thickness of the plating, metres; from 1/2000 of the length to 1/16 of the beam. Real plates
    /// measure 10 mm, which neither a sonar nor a grid of pixels resolves.
    float plating = length / 375;

    float house_length = 0.2f;     ///< of the deckhouse, share of the length; 0: none, at most 0.5
    float house_position = -0.3f;  ///< of its middle from midships, share of the length: -0.35 (aft) to 0.3
    int house_tiers = 2;           ///< 1 to 4, each 2.4 m high, at most half the depth and 0.08 length
    bool has_funnel = true;
    int hatches = 2;                 ///< open, 0 to 8; fewer where the deck has no room
    int masts = 2;                   ///< 0 to 4, with two derricks each
    float mast_height = length / 5;  ///< above the deck, metres, length / 1000 to length

    float break_gap = 0;  ///< metres between the two halves of a broken ship, at most the length; 0: in one piece
    float break_position = 0.1f;  ///< from midships, share of the length, -0.4 to 0.4
    float break_yaw = 0.3f;       ///< radians that the bow half is turned by, -1.6 to 1.6
    float break_roll = -0.25f;    ///< radians that the bow half is rolled by, -1.6 to 1.6
    float collapse = 0;           ///< 0: intact; 1: sides fallen out, decks and house gone, frames and boilers left
    int segments = 64;            ///< stations along the length, 16 to 1024; a sixth as many up a side
    std::uint64_t seed = 1;       ///< of edges and losses
};

inline namespace INSONIFY_FLAGS {

/// @throws invalid_input for a value outside its range
inline void validate(const hull& h) {
    using detail::require, detail::require_range;
    detail::require_size("hull.length", h.length);
    require_range("hull.beam", h.beam, h.length / 20, h.length / 2, "length / 20 to length / 2");
    require_range("hull.depth", h.depth, h.beam / 5, 2 * h.beam, "beam / 5 to 2 beam");
    require_range("hull.bulwark", h.bulwark, 0, h.depth / 2, "0 to depth / 2");
    require_range("hull.sheer", h.sheer, 0, 4, "0 to 4");
    require(h.stern == stern_type::cruiser || h.stern == stern_type::transom, "hull.stern", static_cast<int>(h.stern),
            "cruiser or transom");
    require_range("hull.plating", h.plating, h.length / 2000, h.beam / 16, "length / 2000 to beam / 16");
    require_range("hull.house_length", h.house_length, 0, 0.5f, "0 to 0.5");
    require_range("hull.house_position", h.house_position, -0.35f, 0.3f, "-0.35 to 0.3");
    require_range("hull.house_tiers", h.house_tiers, 1, 4, "1 to 4");
    require_range("hull.hatches", h.hatches, 0, 8, "0 to 8");
    require_range("hull.masts", h.masts, 0, 4, "0 to 4");
    require_range("hull.mast_height", h.mast_height, h.length / 1000, h.length, "length / 1000 to length");
    require_range("hull.break_gap", h.break_gap, 0, h.length, "0 to length");
    require_range("hull.break_position", h.break_position, -0.4f, 0.4f, "-0.4 to 0.4");
    require_range("hull.break_yaw", h.break_yaw, -1.6f, 1.6f, "-1.6 to 1.6");
    require_range("hull.break_roll", h.break_roll, -1.6f, 1.6f, "-1.6 to 1.6");
    detail::require_fraction("hull.collapse", h.collapse);
    detail::require_segments("hull.segments", h.segments, 16, 1024);
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
