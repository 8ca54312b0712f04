// Lines of a ship's hull: the form that plating, decks and fittings follow.
#pragma once

#include <insonify/geometry/objects/detail/lattice_noise.hpp>
#include <insonify/geometry/objects/detail/solids.hpp>
#include <insonify/geometry/objects/hull_parameters.hpp>

#include <algorithm>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
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
          // The standard sheer of load lines, L/3 + 10; below 40 m the 10 becomes L/4, so that models keep the shape.
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
    /// Top of the bulwark, which rises by half towards the bow as on a forecastle.
    double top(double u) const {
        const double fore = (std::max)((u - 0.8) / 0.2, 0.0);
        return deck_height(u) + bulwark_ * (1 + 0.5 * fore * (2 - fore));
    }
    double deck_w(double u) const { return deck_height(u) / top(u); }

    /// Half the breadth, to the outside of the plating.
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
        const double toward_keel = w < 0.25 ? 1 - w / 0.25 : 0.0;
        const double bilge = 0.7 + 0.3 * numeric::square_root(1 - toward_keel * toward_keel);
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
    /// Height, as w, up to which the plating of a side still stands.
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
