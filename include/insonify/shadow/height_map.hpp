// Height maps of casters: for every ray of a parallel light, the height of the first surface that it meets.
//
// A height map is an image over the light's sheared frame (light.hpp), drawn by the rasterizer with height as depth.
// The resolution that it needs is the picture's ground sampling, at every elevation.
#pragma once

#include <insonify/core/detail/dynamic_array.hpp>
#include <insonify/core/image.hpp>
#include <insonify/geometry/bounds.hpp>
#include <insonify/geometry/transform.hpp>
#include <insonify/raster/draw.hpp>
#include <insonify/shadow/light.hpp>

#include <algorithm>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace shadow::inline INSONIFY_FLAGS {

/// Vertex shader of height maps: from a mesh's coordinates to clip space, with w = 1.
struct map_vertex_shader {
    glm::mat3 axes;
    glm::vec3 start;

    glm::vec4 operator()(const vertex& v) const { return glm::vec4(numeric::product(axes, v.position) + start, 1.0f); }
    /// See vertex_lane_shader.
    template <class Floats>
    INSONIFY_INLINE void operator()(Floats (&clip)[4], Floats*, const Floats (&position)[3],
                                    const Floats (&)[3]) const {
        numeric::product(clip, axes, position);
        for (int i = 0; i < 3; ++i) clip[i] = clip[i] + start[i];
        clip[3] = Floats{} + 1.0f;
    }
};

/// The bounds, in the light's frame (u, v, z), of a box's eight corners.
inline bounding_box extent_of(const bounding_box& box, const affine& to_world, const light_frame& frame) {
    bounding_box extent;
    for (int i = 0; i < 8; ++i) extent = include(extent, frame(transform_point(to_world, box.corner(i))));
    return extent;
}

/// Heights of casters over a grid of rays.
class height_map {
  public:
    /// An empty map: nothing casts, everything is lit.
    height_map() : frame_(directional_light{}) {}

    /// @param frame    of the light
    /// @param extent   u and v of the rays, and z, range of heights; casters outside it are clipped
    /// @param texel    metres between rays along u and v; grows if the map would have more than `largest` texels a side
    /// @throws invalid_input for a texel that isn't finite and positive or a `largest` outside [1, 32768]
    height_map(const light_frame& frame, const bounding_box& extent, double texel, int largest = 8192)
        : frame_(frame), origin_(extent.lower) {
        insonify::detail::require_positive("texel", texel);
        insonify::detail::require(largest >= 1 && largest <= 32768, "largest", largest, "1 to 32768");
        if (extent.empty()) return;
        const glm::dvec3 size = extent.size();
        texel_ = (std::max)(texel, (std::max)(size.x, size.y) / (largest - 0.5));
        const auto texels = [&](double length) {
            return (std::min)(largest, static_cast<int>(numeric::floor_to_int(length / texel_)) + 1);
        };
        // A little room below and above, so that rounding can't clip the highest caster away.
        const double room = 1e-3 * size.z + 1e-6;
        floor_ = extent.lower.z - room;
        relief_ = size.z + 2 * room;
        heights_ = image<float>(texels(size.x), texels(size.y), empty_depth(depth_compare::greater));
    }

    /// Draws a mesh into the map as a caster; several meshes may share a map.
    /// @param to_world  from the mesh's frame to the one in which the light is described
    /// @throws invalid_input for an index without a position
    template <executor_argument E = serial_executor>
    draw_stats cast(const mesh_view& m, const affine& to_world, E&& ex = {}) {
        if (heights_.empty()) return {};
        return draw(m, vertex_shader_for(to_world), depth_target{heights_},
                    draw_options<depth_precision::quick>{.compare = depth_compare::greater}, ex);
    }

    const light_frame& frame() const { return frame_; }
    bool empty() const { return heights_.empty(); }
    int columns() const { return heights_.width(); }
    int rows() const { return heights_.height(); }
    double texel() const { return texel_; }  ///< metres between rays along u and v

    /// A point of the frame on the map: continuous column and row (texel (i, j) has its centre at (i + 1/2, j + 1/2)),
    /// and its height as the map stores heights.
    glm::vec3 on_map(const glm::dvec3& uvz) const {
        return glm::vec3((uvz.x - origin_.x) / texel_, (uvz.y - origin_.y) / texel_, (uvz.z - floor_) / relief_);
    }
    /// A slope dz / du in stored heights per texel.
    float on_map(double slope) const { return static_cast<float>(slope * (texel_ / relief_)); }
    /// Stored height of the first surface that a texel's ray meets; minus infinity if there is none.
    float operator()(int column, int row) const { return heights_(column, row); }

  private:
    /// Vertex shader that maps a mesh onto the map. Mesh to clip space is one affine map, composed in double and
    /// narrowed last, when its numbers are small. Row 0 is where v is smallest, so triangles appear mirrored.
    map_vertex_shader vertex_shader_for(const affine& to_world) const {
        const glm::dvec2 scale{2 / (texel_ * columns()), 2 / (texel_ * rows())};
        const auto to_clip = [&](const glm::dvec3& uvz) {
            return glm::dvec3((uvz.x - origin_.x) * scale.x - 1, 1 - (uvz.y - origin_.y) * scale.y,
                              (uvz.z - floor_) / relief_);
        };
        const glm::dvec3 zero = to_clip(frame_(to_world.offset));
        glm::mat3 axes;
        for (int i = 0; i < 3; ++i) axes[i] = glm::vec3(to_clip(frame_(to_world.offset + to_world.linear[i])) - zero);
        return {axes, glm::vec3(zero)};
    }

    light_frame frame_;
    glm::dvec2 origin_{};            ///< (u, v) of the first texel's corner, metres
    double texel_ = 1;               ///< metres along u and v
    double floor_ = 0, relief_ = 1;  ///< lowest height that it resolves, and the range above it, metres
    image<float> heights_;
};

}  // namespace shadow::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
