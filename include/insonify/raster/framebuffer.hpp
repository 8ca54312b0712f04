// Where a draw leaves its results. The type says which attachments there are; what is absent is not compiled.
#pragma once

#include <insonify/core/image_view.hpp>

#include <limits>

namespace insonify {
inline namespace INSONIFY_ABI {

/// Which of two surfaces a pixel shows.
enum class keep_depth {
    smaller,  ///< z = 0 at the camera, growing away from it
    larger,   ///< reversed z, or heights seen from above
};

/// What depth a draw finds in the target.
enum class depth_load {
    keep,   ///< what is there: earlier draws occlude this one
    clear,  ///< nothing: the target's depth is overwritten, without being read; see framebuffer for its color
};

inline namespace INSONIFY_FLAGS {

/// The depth of an empty pixel.
constexpr float empty_depth(keep_depth keep) {
    return keep == keep_depth::smaller ? std::numeric_limits<float>::infinity()
                                       : -std::numeric_limits<float>::infinity();
}

}  // namespace INSONIFY_FLAGS

/// Depth alone, correctly rounded: takes no fragment callable and compiles no shading.
struct depth_target {
    image_view<float> depth;
};

/// Depth alone, computed in float: off by a few units in the last place, at a third less time. For maps that are
/// looked up with a tolerance anyway.
struct quick_depth_target {
    image_view<float> depth;
};

/// Depth and one value per pixel. With Pixel = void the fragment callable stores what it wants by itself.
template <class Pixel>
struct framebuffer {
    image_view<Pixel> color;
    image_view<float> depth;
    bool clears_color = false;  ///< whether draws that clear depths write `background` where they show nothing
    Pixel background{};
};
template <>
struct framebuffer<void> {
    image_view<float> depth;
};

}  // namespace INSONIFY_ABI
}  // namespace insonify
