// An object where the rig sees it, and which pixels it may concern.
#pragma once

#include <insonify/geometry/bounds.hpp>
#include <insonify/geometry/shared_mesh.hpp>
#include <insonify/raster/detail/assembly.hpp>
#include <insonify/sonar/overhead/rig.hpp>

#include <algorithm>
#include <limits>

INSONIFY_ARITHMETIC_BEGIN

namespace insonify {
inline namespace INSONIFY_ABI {
namespace detail::inline INSONIFY_FLAGS {

/// An object in the rig's frame.
struct placed_mesh {
    mesh_view shape;
    bounding_box box;  ///< of the shape, in its own frame
    affine to_rig;
    surface_kind kind = surface_kind::open;
    const regular_grid* grid = nullptr;  ///< see shared_mesh
};

/// Which pixels may show an object, or something in its shadow that lies no lower than `lowest`, in the rig's frame:
/// all of them, if floats, in which it is drawn, don't hold its place to a pixel.
inline pixel_box shadowed_pixels(const overhead_geometry& view, const placed_mesh& caster, double lowest) {
    const overhead& rig = view.rig();
    const glm::dvec3& to_light = view.light().to_light();
    const auto altitude = static_cast<double>(rig.altitude);
    glm::dvec2 first(std::numeric_limits<double>::infinity()), last = -first;
    for (int corner = 0; corner < 8 && !caster.box.empty(); ++corner) {
        const glm::dvec3 from = caster.box.corner(corner), at = transform_point(caster.to_rig, from);
        double largest = altitude;  // of what is summed up to place it
        for (int axis = 0; axis < 3; ++axis) {
            largest = (std::max)(largest, numeric::magnitude(caster.to_rig.offset[axis]));
            for (int i = 0; i < 3; ++i)
                largest = (std::max)(largest, numeric::magnitude(caster.to_rig.linear[i][axis] * from[i]));
        }
        const double error = 0x1p-19 * largest;  // a dozen roundings to float
        // What all of these points surround, their pictures do.
        const double fall = (std::max)(at.z - lowest, 0.0) / to_light.z;
        for (const glm::dvec3& p : {at, at - fall * to_light}) {
            const double down = altitude - p.z,
                         aside = (std::max)(numeric::magnitude(p.x), numeric::magnitude(p.y)) / down;
            const bool is_known = down > 0 && (1 + aside) * error < view.ray_step() * down;
            if (!is_known) return {0, 0, rig.size.x - 1, rig.size.y - 1};
            const glm::dvec2 pixel = view.pixel(p);
            first = glm::dvec2((std::min)(first.x, pixel.x - 1), (std::min)(first.y, pixel.y - 1));
            last = glm::dvec2((std::max)(last.x, pixel.x + 1), (std::max)(last.y, pixel.y + 1));
        }
    }
    const auto held = [](double pixel, int size) {
        return static_cast<int>((std::min)((std::max)(pixel, -1.0), static_cast<double>(size)));
    };
    return {held(first.x, rig.size.x), held(first.y, rig.size.y), held(last.x, rig.size.x), held(last.y, rig.size.y)};
}

/// Which pixels may show an object.
inline pixel_box shown_pixels(const overhead_geometry& view, const placed_mesh& object) {
    return shadowed_pixels(view, object, std::numeric_limits<double>::infinity());  // no shadow falls so high
}

}  // namespace detail::inline INSONIFY_FLAGS
}  // namespace INSONIFY_ABI
}  // namespace insonify

INSONIFY_ARITHMETIC_END
