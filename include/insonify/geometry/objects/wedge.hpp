// Low wedges that lie on the bottom: ground mines of the Rockan kind.
#pragma once

#include <insonify/geometry/creases.hpp>
#include <insonify/geometry/objects/detail/solids.hpp>

#include <array>
#include <vector>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// A wedge standing on z = 0, nose towards +x: flat below, highest near its tail, with sloping sides. Such a shape
/// reflects sound away from a sonar at most aspects.
///
/// The defaults are the size published for the GMI 100 Rockan, 1.02 m long, 0.80 m wide and 0.385 m high (Jane's
/// Underwater Warfare Systems); the slopes are estimates from photographs.
struct wedge {
    float length = 1.02f;       ///< metres
    float width = 0.8f;         ///< at the tail, metres, at least length / 10000
    float height = 0.385f;      ///< at the ridge, metres, at least 1/10000 of length and width
    float nose_height = 0.06f;  ///< metres, height / 10000 to height
    float nose_width = 0.46f;   ///< metres, width / 10000 to width
    float tail_height = 0.2f;   ///< metres, height / 10000 to height
    float ridge = 0.2f;         ///< metres from the tail to the ridge, 1/10000 to half of the length
    float side_slope = 0.35f;   ///< inward per upward metre of the sides, >= 0; the ridge keeps a tenth of the width
};

namespace detail::inline INSONIFY_FLAGS {

/// Length position, half width and height of the wedge's four cross sections.
struct wedge_station {
    double x, half_width, height;
};
inline std::array<wedge_station, 4> stations_of(const wedge& w) {
    const double length = static_cast<double>(w.length), wide = 0.5 * static_cast<double>(w.width);
    const double nose = 0.5 * static_cast<double>(w.nose_width), high = static_cast<double>(w.height);
    const double ridge = static_cast<double>(w.ridge), low = static_cast<double>(w.nose_height);
    // The sides run parallel to two thirds of the length; the nose narrows from there.
    const double bend = 2.0 / 3 * length;
    const double bend_height = high + (low - high) * (bend - ridge) / (length - ridge);
    return {{{-0.5 * length, wide, static_cast<double>(w.tail_height)},
             {-0.5 * length + ridge, wide, high},
             {-0.5 * length + bend, wide, bend_height},
             {0.5 * length, nose, low}}};
}

}  // namespace detail::inline INSONIFY_FLAGS

inline namespace INSONIFY_FLAGS {

/// @throws invalid_input for a value outside its range
inline void validate(const wedge& w) {
    using namespace detail;
    require_size("wedge.length", w.length);
    require_size("wedge.width", w.width);
    require_size("wedge.height", w.height);
    const float larger = w.length > w.width ? w.length : w.width;
    require_thickness("wedge.width", w.width, larger);
    require_thickness("wedge.height", w.height, larger > w.height ? larger : w.height);
    require_thickness("wedge.nose_height", w.nose_height, w.height);
    require_thickness("wedge.tail_height", w.tail_height, w.height);
    require_thickness("wedge.nose_width", w.nose_width, w.width);
    require(w.ridge >= 1e-4f * w.length && w.ridge <= 0.5f * w.length, "wedge.ridge", w.ridge,
            "1/10000 to half of the length");
    require(w.side_slope >= 0 && w.side_slope * w.height <= 0.45f * w.width &&
                w.side_slope * w.nose_height <= 0.45f * w.nose_width,
            "wedge.side_slope", w.side_slope, "0 or more, leaving at least a tenth of width and nose_width at the top");
}

/// 28 triangles, flat.
/// @throws invalid_input as `validate` does
inline mesh to_mesh(const wedge& w) {
    validate(w);
    std::vector<detail::section> sections;
    for (const auto& [x, half, height] : detail::stations_of(w)) {
        const double top = half - static_cast<double>(w.side_slope) * height;
        sections.push_back({{x, -half, 0}, {x, half, 0}, {x, top, height}, {x, -top, height}});
    }
    mesh body;
    detail::append_loft(body, sections);
    return with_creases(body, 0);
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
