// The form of a ship's hull: its parameters, and the lines that plating, decks and fittings follow.
#pragma once

#include <insonify/geometry/objects/detail/lattice_noise.hpp>
#include <insonify/geometry/objects/detail/solids.hpp>

#include <algorithm>
#include <cstdint>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

enum class stern_type : std::uint8_t { cruiser, transom };

/// A ship standing upright on z = 0 with its keel, bow towards +x, midships at the origin: an open shell of plating on
/// frames, with decks, hatches, deckhouse, masts and funnel; whole, broken in two, or collapsed.
///
/// The default is a coaster. Proportions: H. Schneekluth, V. Bertram. Ship Design for Efficiency and Economy, 1998
/// (length / beam 4 to 7, beam / depth 1.6 to 2.5). Sheer and bulwark: International Convention on Load Lines, 1966
/// (regulation 38: standard sheer of 50 (L / 3 + 10) mm at the bow and half of that at the stern; regulation 25:
/// bulwarks of 1 m). A trawler measures some 25 x 6.8 x 3.4 m, a cargo steamer of 1910 some 100 x 14.5 x 7.5 m.
struct hull {
    float length = 45;   ///< over all, metres
    float beam = 8.2f;   ///< metres, length / 20 to length / 2
    float depth = 4;     ///< from keel to deck amidships, metres, beam / 5 to 2 beam
    float bulwark = 1;   ///< height above the deck, metres, at most half the depth
    float sheer = 1.5f;  ///< times the standard sheer, 0 to 4
    stern_type stern = stern_type::cruiser;
    /// Thickness in which plating is drawn, metres; from 1/2000 of the length to 1/16 of the beam. Real plates
    /// measure 10 mm, which neither a sonar nor a grid of pixels resolves.
    float plating = 0.12f;

    float house_length = 0.2f;     ///< of the deckhouse, share of the length; 0: none, at most 0.5
    float house_position = -0.3f;  ///< of its middle from midships, share of the length: -0.35 (aft) to 0.3
    int house_tiers = 2;           ///< 1 to 4, each 2.4 m high, at most half the depth and 0.08 length
    bool has_funnel = true;
    int hatches = 2;        ///< open, 0 to 8
    int masts = 2;          ///< 0 to 4, with two derricks each
    float mast_height = 9;  ///< above the deck, metres, at most the length

    float break_gap = 0;          ///< metres between the two halves of a broken ship; 0: in one piece
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
    using detail::require;
    detail::require_size("hull.length", h.length);
    const auto in_range = [](const char* name, float value, float least, float most, const char* expected) {
        require(value >= least && value <= most, name, value, expected);
    };
    in_range("hull.beam", h.beam, h.length / 20, h.length / 2, "length / 20 to length / 2");
    in_range("hull.depth", h.depth, h.beam / 5, 2 * h.beam, "beam / 5 to 2 beam");
    in_range("hull.bulwark", h.bulwark, 0, h.depth / 2, "0 to depth / 2");
    in_range("hull.sheer", h.sheer, 0, 4, "0 to 4");
    require(h.stern == stern_type::cruiser || h.stern == stern_type::transom, "hull.stern", static_cast<int>(h.stern),
            "cruiser or transom");
    in_range("hull.plating", h.plating, h.length / 2000, h.beam / 16, "length / 2000 to beam / 16");
    in_range("hull.house_length", h.house_length, 0, 0.5f, "0 to 0.5");
    in_range("hull.house_position", h.house_position, -0.35f, 0.3f, "-0.35 to 0.3");
    require(h.house_tiers >= 1 && h.house_tiers <= 4, "hull.house_tiers", h.house_tiers, "1 to 4");
    require(h.hatches >= 0 && h.hatches <= 8, "hull.hatches", h.hatches, "0 to 8");
    require(h.masts >= 0 && h.masts <= 4, "hull.masts", h.masts, "0 to 4");
    in_range("hull.mast_height", h.mast_height, h.length / 1000, h.length, "length / 1000 to length");
    in_range("hull.break_gap", h.break_gap, 0, h.length, "0 to length");
    in_range("hull.break_position", h.break_position, -0.4f, 0.4f, "-0.4 to 0.4");
    in_range("hull.break_yaw", h.break_yaw, -1.6f, 1.6f, "-1.6 to 1.6");
    in_range("hull.break_roll", h.break_roll, -1.6f, 1.6f, "-1.6 to 1.6");
    detail::require_share("hull.collapse", h.collapse);
    detail::require_segments("hull.segments", h.segments, 16, 1024);
}

}  // namespace INSONIFY_FLAGS

namespace detail::inline INSONIFY_FLAGS {

/// Positions on a hull: u runs from the stern (0) to the bow (1), w from the keel (0) to the bulwark's top (1), side is
/// +1 (port) or -1 (starboard).
class hull_lines {
  public:
    explicit hull_lines(const hull& h)
        : length_(static_cast<double>(h.length)),
          half_beam_(0.5 * static_cast<double>(h.beam)),
          depth_(static_cast<double>(h.depth)),
          bulwark_(static_cast<double>(h.bulwark)),
          plating_(static_cast<double>(h.plating)),
          collapse_(static_cast<double>(h.collapse)),
          is_transom_(h.stern == stern_type::transom),
          // The formula's constant scales with ships; for models and giants all of it follows the length.
          sheer_(static_cast<double>(h.sheer) * 0.05 * (length_ / 3 + (std::min)(10.0, length_ / 4))),
          key_(stream_key(h.seed, 0x68756C6C)) {}

    double length() const { return length_; }
    double half_beam() const { return half_beam_; }
    double depth() const { return depth_; }
    double plating() const { return plating_; }
    double collapse() const { return collapse_; }

    double deck_height(double u) const {
        const double fore = (std::max)(2 * u - 1, 0.0), aft = (std::max)(1 - 2 * u, 0.0);
        return depth_ + sheer_ * (fore * fore + 0.5 * aft * aft);
    }
    /// The bulwark rises by half towards the bow, as a forecastle's does.
    double top(double u) const {
        const double fore = (std::max)((u - 0.8) / 0.2, 0.0);
        return deck_height(u) + bulwark_ * (1 + 0.5 * fore * (2 - fore));
    }
    double deck_w(double u) const { return deck_height(u) / top(u); }

    /// Half the breadth outside the plating.
    double half_breadth(double u, double w) const {
        const auto taper = [](double t, double power) { return t > 0 ? 1 - numeric::pow(t, power) : 1.0; };
        const double r = is_transom_ ? 0.35 : 0.2, aft = (r - u) / r;
        const double deck_aft = aft <= 0      ? 1.0
                                : is_transom_ ? 1 - 0.28 * aft * aft
                                              : numeric::square_root(1 - 0.95 * aft * aft);
        const double deck = taper((u - 0.68) / 0.32, 2.2) * deck_aft;
        const double keel = taper((u - 0.55) / 0.45, 1.6) * taper((0.35 - u) / 0.35, 1.5);
        const double flare = numeric::pow(w, 1.4);
        const double plan = keel + (deck - keel) * flare;
        const double rise = w < 0.25 ? 1 - w / 0.25 : 0.0;
        const double bilge = 0.7 + 0.3 * numeric::square_root(1 - rise * rise);
        return (std::max)(half_beam_ * plan * bilge, 0.6 * plating_);
    }

    /// Outside of the plating; collapsed sides lean outwards.
    glm::dvec3 outer(double u, double w, double side) const { return at(u, w, side, half_breadth(u, w), w * top(u)); }
    /// Inside of the plating.
    glm::dvec3 inner(double u, double w, double side) const {
        const double breadth = half_breadth(u, w);
        return at(u, w, side, (std::max)(breadth - plating_, 0.35 * breadth), plating_ + w * (top(u) - plating_));
    }
    /// A point between the sides: `share` of the way from the middle line (0) to the plating's middle (1 or -1).
    glm::dvec3 between(double u, double w, double share, double height) const {
        const double side = share < 0 ? -1 : 1;
        const glm::dvec3 plate = at(u, w, side, half_breadth(u, w) - 0.5 * plating_, height);
        return {plate.x, (share < 0 ? -share : share) * plate.y, plate.z};
    }
    /// Up to which w the plating of a side stands.
    double standing(double u, double side) const {
        const double loss = 0.5 + 0.5 * noise({14 * u, 3 * side, 0.5}) + 0.35 * noise({45 * u, 5 * side, 1.5});
        const double ends = (std::max)((u - 0.82) / 0.18, (0.14 - u) / 0.14);
        const double held = 1 - 0.6 * (std::max)(ends, 0.0);  // bow and stern stand longest
        return 1 - collapse_ * held * (std::min)((std::max)(0.35 + 0.55 * loss, 0.0), 0.88);
    }
    double noise(const glm::dvec3& p) const { return lattice_noise(p, key_); }

  private:
    glm::dvec3 at(double u, double w, double side, double breadth, double height) const {
        const double rake = 0.45 * depth_, overhang = (is_transom_ ? 0.15 : 0.6) * depth_;
        const double stem = 0.5 * length_ - rake * (1 - w);
        const double stern = -0.5 * length_ + overhang * (1 - w) * (1 - w);
        const double share = height / depth_, lean = collapse_ * share * numeric::square_root(share);
        return {stern + u * (stem - stern), side * (breadth * (1 + 0.12 * collapse_ * share) + 0.22 * depth_ * lean),
                height * (1 - 0.3 * collapse_ * (std::min)(share, 1.0))};
    }

    double length_, half_beam_, depth_, bulwark_, plating_, collapse_;
    bool is_transom_;
    double sheer_;
    philox_key key_;
};

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
