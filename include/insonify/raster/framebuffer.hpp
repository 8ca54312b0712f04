// Render targets of a draw. The type states the attachments; no code is compiled for absent ones.
#pragma once

#include <insonify/core/image_view.hpp>

namespace insonify {
inline namespace INSONIFY_ABI {

/// Depth alone: the draw takes no fragment shader.
struct depth_target {
    image_view<float> depth;
};

/// Depth and one value per pixel. With Pixel = void the fragment shader stores its results itself.
template <class Pixel>
struct framebuffer {
    image_view<Pixel> color;
    image_view<float> depth;
    bool clears_color = false;  ///< whether `depth_load::clear` also sets the color of all pixels to `background`
    Pixel background{};
};
/// Depth, for fragment shaders that store their results themselves.
template <>
struct framebuffer<void> {
    image_view<float> depth;
};

}  // namespace INSONIFY_ABI
}  // namespace insonify
