// Parameters of an aeroplane.
#pragma once

#include <insonify/geometry/objects/detail/solids.hpp>

#include <algorithm>
#include <cstdint>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// An aeroplane on its belly, nose towards +x, its lowest point at z = 0: fuselage with canopy, tapered wings with
/// dihedral, tailplane, fin, engines with propellers; whole, without wings, with its tail broken off, or on its back.
///
/// Sizes that are not given follow from the others in the default's proportions. It is a twin-engined bomber of the
/// 1940s of the size of a Junkers Ju 88 A-4, 14.4 m long with a span of 20 m; a single-engined fighter such as the
/// Spitfire Mk V is 9.1 m and 11.2 m, a Douglas C-47 19.4 m and 29 m (Jane's All the World's Aircraft, 1945). Taper and
/// tail sizes: D. P. Raymer. Aircraft Design: A Conceptual Approach, chapters 4 and 6.
struct aeroplane {
    float length = 14.4f;              ///< of the fuselage with a nose engine's spinner, metres
    float span = length * 20 / 14.4f;  ///< metres, length / 4 to 4 length, at least 1.2 fuselage_diameter
    float fuselage_diameter = length * 1.7f / 14.4f;  ///< mean of height and width, metres, length / 40 to length / 4
    float root_chord = length * 3.7f / 14.4f;         ///< metres, length / 20 to length / 2
    float tip_chord = root_chord * 1.5f / 3.7f;       ///< metres, length / 100 to root_chord
    float sweep = 0.08f;                              ///< of the leading edge, radians, -0.5 to 0.8
    float dihedral = 0.08f;                           ///< radians, -0.2 to 0.3
    float wing_position = 0.2f;  ///< of the root's leading edge ahead of the middle, share of the length, -0.1 to 0.4
    /// Of the tailplane, metres, 1.2 fuselage_diameter to the span.
    float tail_span = (std::max)(span * 0.37f, 1.2f * fuselage_diameter);
    float fin_height = length * 2.1f / 14.4f;  ///< above the fuselage, metres, length / 50 to length / 3
    int engines = 2;  ///< 0 to 4; of an odd number one sits in the nose, the others in the wings
    float propeller_diameter = length * 3.4f / 14.4f;  ///< metres, length / 50 to length; 0: without propellers

    float port_wing = 1;       ///< share of the half span that is left, 0 to 1
    float starboard_wing = 1;  ///< the same of the other
    /// Metres to the lost parts of the wings, which lie on the bottom, at most 10 lengths; 0: they are not there.
    float torn_off = 0;
    float tail_gap = 0;        ///< metres between the fuselage and a tail that broke off, at most 10 lengths; 0: whole
    float tail_yaw = 0.5f;     ///< radians that such a tail is turned by, -1.6 to 1.6
    bool is_inverted = false;  ///< lies on its back, on a fin that is crushed to a third
    int segments = 24;         ///< around the fuselage, 8 to 512; twice as many along it and along a wing
    std::uint64_t seed = 1;    ///< of torn edges
};

inline namespace INSONIFY_FLAGS {

/// @throws invalid_input for a value outside its range
inline void validate(const aeroplane& a) {
    using detail::require, detail::require_range;
    detail::require_size("aeroplane.length", a.length);
    const float l = a.length;
    require_range("aeroplane.span", a.span, l / 4, 4 * l, "length / 4 to 4 length");
    require_range("aeroplane.fuselage_diameter", a.fuselage_diameter, l / 40, l / 4, "length / 40 to length / 4");
    require_range("aeroplane.root_chord", a.root_chord, l / 20, l / 2, "length / 20 to length / 2");
    require_range("aeroplane.tip_chord", a.tip_chord, l / 100, a.root_chord, "length / 100 to root_chord");
    require_range("aeroplane.sweep", a.sweep, -0.5f, 0.8f, "-0.5 to 0.8 radians");
    require_range("aeroplane.dihedral", a.dihedral, -0.2f, 0.3f, "-0.2 to 0.3 radians");
    require_range("aeroplane.wing_position", a.wing_position, -0.1f, 0.4f, "-0.1 to 0.4");
    require_range("aeroplane.tail_span", a.tail_span, 1.2f * a.fuselage_diameter, a.span,
                  "1.2 fuselage diameters to the span");
    require_range("aeroplane.fin_height", a.fin_height, l / 50, l / 3, "length / 50 to length / 3");
    require_range("aeroplane.engines", a.engines, 0, 4, "0 to 4");
    require(a.propeller_diameter == 0 || (a.propeller_diameter >= l / 50 && a.propeller_diameter <= l),
            "aeroplane.propeller_diameter", a.propeller_diameter, "0, or length / 50 to length");
    detail::require_fraction("aeroplane.port_wing", a.port_wing);
    detail::require_fraction("aeroplane.starboard_wing", a.starboard_wing);
    require_range("aeroplane.torn_off", a.torn_off, 0, 10 * l, "0 to 10 lengths");
    require_range("aeroplane.tail_gap", a.tail_gap, 0, 10 * l, "0 to 10 lengths");
    require_range("aeroplane.tail_yaw", a.tail_yaw, -1.6f, 1.6f, "-1.6 to 1.6 radians");
    detail::require_segments("aeroplane.segments", a.segments, 8, 512);
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
