// The options that pictures of every sonar have, and the default ones of a rig.
//
// `render_options` are those of overhead pictures, `record_options` those of side-scan pictures. They share a
// backscatter law, the spacing `cell` of the seabed's vertices, `with(law)` and `without_labels()`; each adds what its
// sonar alone has: shadow policy and rasterizer, or the parts of the sonar equation. They share no base class, because
// designated initializers cannot name members of a base. Code for any rig starts from the rig:
//
//     in::render(scene, rig, in::options_for(rig).with(law).without_labels())
#pragma once

#include <insonify/sonar/overhead/picture.hpp>
#include <insonify/sonar/side_scan/record_options.hpp>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {

/// Options of any sonar's pictures.
template <class O>
concept sonar_options = requires(const O& o) {
    { o.law } -> backscatter_law;
    { o.cell } -> std::convertible_to<double>;
    o.with(lambert{});
    o.without_labels();
};

inline namespace INSONIFY_FLAGS {

/// The default options of pictures by a rig.
inline render_options<> options_for(const overhead&) {
    return {};
}

/// The default options of recordings by a rig.
template <across_track Axis>
record_options<> options_for(const side_scan_rig<Axis>&) {
    return {};
}

}  // namespace INSONIFY_FLAGS

}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
